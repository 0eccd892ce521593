"""The restitutions that a study is repeated with, each under a name of its own."""

from collections.abc import Mapping, Sequence
from typing import Any

from rocking import checks
from rocking.conventions import FEET, Foot
from rocking.dynamics.impact_laws import DrawnRestitution, ImpactLaw
from rocking.dynamics.parameters import cut_words
from rocking.errors import InvalidValueError
from rocking.restitution import RestitutionModel, model


def named_choices(restitutions: Any) -> dict[str, Any]:
    """Return choices of restitution by name.

    restitutions: models or their names, coefficients [-], pairs by side, laws of impact; names are made for a sequence.

    >>> named_choices(["housner", 0.9, {"left": 0.8, "right": 0.9}])
    {'housner': 'housner', '0.9': 0.9, 'left 0.8, right 0.9': {'left': 0.8, 'right': 0.9}}
    """
    if isinstance(restitutions, Mapping):
        pairs = [(str(name), choice) for name, choice in restitutions.items()]
        if set(restitutions) == set(FEET):
            raise InvalidValueError("restitutions are named left and right: is this one choice? Put it into a list")
        for _, choice in pairs:
            label_of(choice)
    elif isinstance(restitutions, Sequence) and not isinstance(restitutions, str):
        pairs = [(label_of(choice), choice) for choice in restitutions]
    else:
        raise InvalidValueError(f"restitutions must be a list or a dict of choices, got {restitutions!r:.60}")
    if len(pairs) < 2:
        raise InvalidValueError(f"restitutions must be at least two, to be compared with one another, got {len(pairs)}")
    names = [name for name, _ in pairs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InvalidValueError(f"two restitutions have the name {twice!r}: give them as {{name: choice}}")
    return dict(pairs)


def label_of(choice: Any) -> str:
    """Return the name of a choice of restitution."""
    if isinstance(choice, (str, RestitutionModel)):
        return model(choice).label
    if isinstance(choice, DrawnRestitution):
        return _drawn(choice)
    if isinstance(choice, ImpactLaw):
        return type(choice).__name__ + _times(getattr(choice, "times", 1.0))
    if isinstance(choice, Mapping):
        if set(choice) != set(FEET):
            raise InvalidValueError(f'restitution by side is {{"left": r, "right": r}}, got {choice!r:.60}')
        return ", ".join(f"{foot} {checks.number(f'restitution[{foot!r}]', choice[foot]):.6g}" for foot in FEET)
    return f"{checks.number('restitution', choice):.6g}"


def _drawn(law: DrawnRestitution) -> str:
    each = "history" if law.per_history else "impact"
    found = [f"{middle:.4g} [{low:.4g}, {high:.4g}]" for low, middle, high in (_middle(law, foot) for foot in FEET)]
    sides = found[0] if law.factors.ndim == 1 else f"left {found[0]}, right {found[1]}"
    cut = cut_words(dict(zip(FEET, law.cut, strict=True)))
    return f"drawn per {each}, {sides}, seed {law.seed}{_times(law.times)}{cut}"


def _middle(law: DrawnRestitution, onto: Foot) -> list[float]:
    return [law.quantile(probability, onto) for probability in (0.025, 0.5, 0.975)]


def _times(base: Any) -> str:
    return "" if isinstance(base, (int, float)) and base == 1.0 else f" times {label_of(base)}"
