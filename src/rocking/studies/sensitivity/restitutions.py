"""The restitutions that a study is repeated with, each under a name of its own."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rocking import checks
from rocking.conventions import FEET, FloatArray, Foot
from rocking.dynamics.content import full_name
from rocking.dynamics.impact_laws import ConstantRestitution, DrawnRestitution, ImpactLaw, RandomRestitution
from rocking.dynamics.parameters import COMPLEMENTARITY, cut_words
from rocking.dynamics.rows import Rows, drawn_rows
from rocking.errors import InvalidValueError
from rocking.restitution import RestitutionModel, model
from rocking.studies.histories import Histories, described_law


def named_restitutions(restitutions: Any) -> dict[str, Any]:
    """Return restitutions by name: models, coefficients [-], pairs by side, laws; names are made for a sequence."""
    if isinstance(restitutions, Mapping):
        pairs = [(str(name), choice) for name, choice in restitutions.items()]
        if set(restitutions) == set(FEET):
            raise InvalidValueError("restitutions are named left and right: is this one choice? Put it into a list")
        for _, choice in pairs:
            label_of(choice)
    elif isinstance(restitutions, Sequence) and not isinstance(restitutions, str):
        pairs = [(label_of(choice), choice) for choice in restitutions]
    else:
        raise InvalidValueError(parameter="restitutions", allowed="a list or a dict of choices", value=restitutions)
    if len(pairs) < 2:
        raise InvalidValueError(
            parameter="restitutions", allowed="at least two, to be compared with one another", value=len(pairs)
        )
    names = [name for name, _ in pairs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InvalidValueError("two restitutions have the name {name!r}: give them as {{name: choice}}", name=twice)
    return dict(pairs)


def label_of(choice: Any) -> str:
    """Return the name of a choice of restitution; None goes with friction."""
    if choice is None:
        return COMPLEMENTARITY
    if isinstance(choice, (str, RestitutionModel)):
        return model(choice).label
    if isinstance(choice, DrawnRestitution):
        return _drawn(choice)
    if isinstance(choice, ImpactLaw):
        return type(choice).__name__ + _times(getattr(choice, "times", 1.0))
    if isinstance(choice, Mapping):
        if set(choice) != set(FEET):
            raise InvalidValueError(
                'restitution by side is {{"left": r, "right": r}}, got {value}', parameter="restitution", value=choice
            )
        return ", ".join(f"{foot} {checks.number(f'restitution[{foot!r}]', choice[foot]):.6g}" for foot in FEET)
    return f"{checks.number('restitution', choice):.6g}"


def _drawn(law: DrawnRestitution) -> str:
    each = "history" if law.per_history else "impact"
    quantiles = [[law.quantile(probability, foot) for probability in (0.025, 0.5, 0.975)] for foot in FEET]
    of_feet = [f"{middle:.4g} [{low:.4g}, {high:.4g}]" for low, middle, high in quantiles]
    sides = of_feet[0] if law.factors.ndim == 1 else f"left {of_feet[0]}, right {of_feet[1]}"
    cut = cut_words(dict(zip(FEET, law.cut, strict=True)))
    return f"drawn per {each}, {sides}, seed {law.seed}{_times(law.times)}{cut}"


def _times(base: Any) -> str:
    return "" if isinstance(base, (int, float)) and base == 1.0 else f" times {label_of(base)}"


_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_FIRST, _SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)


class SampledRestitution(DrawnRestitution):
    """A coefficient drawn once for every history: all its impacts share the draw, as if r were uncertain, not random.

    The draw depends on the seed and on the number of the history, on nothing else. Many histories at once draw before
    they run, so that either engine serves; a single response with it runs on the reference engine. For a new draw at
    every impact take `RandomRestitution`. Draws that would create energy are cut off, for each side at its own bound,
    and both sides draw with the same number: see `rocking.dynamics.impact_laws.DrawnRestitution`.

    Parameters
    ----------
    factors, seed, times, cut
        As of `RandomRestitution`.

    Raises
    ------
    InvalidValueError
        If the quantiles decrease or are outside [0, 1], or by side [0, 10], or the seed is not a whole number from 0 to
        2^64 - 1.

    Examples
    --------
    >>> law = SampledRestitution.normal(0.9, 0.02, seed=1)
    >>> bool(law.factor(1.0, 5, 0) == law.factor(2.0, 5, 3) == law.draws([5])[0])
    True
    """

    per_history: ClassVar[bool] = True

    @classmethod
    def of_law(cls, law: RandomRestitution) -> "SampledRestitution":
        """Return the same distribution, drawn once for every history instead of at every impact.

        Parameters
        ----------
        law : RandomRestitution
            The law that draws for every impact.

        Returns
        -------
        SampledRestitution
            With the quantiles, the seed and the base of that law.

        Raises
        ------
        InvalidValueError
            If it is no such law.
        """
        checks.of_kind("law", law, RandomRestitution, "a RandomRestitution")
        return cls(law.factors, law.seed, law.times, law.cut)

    def content(self) -> dict[str, Any]:
        """Return the seed and the hashes of the tables; of a dataclass of your own, its fields."""
        return self._tables() if type(self) is SampledRestitution else super().content()

    def draws(self, numbers: Any, foot: Foot | None = None, share: Any = 1.0) -> FloatArray:
        """Return the draws of many histories, to the last bit those of `draw`.

        Parameters
        ----------
        numbers : array_like of int
            Numbers of histories.
        foot : {"left", "right"}, optional
            The foot on which they land, which a law of two tables needs.
        share : float or array_like
            Probability of the lowest part of the distribution, from which they are [-].

        Returns
        -------
        ndarray
            Coefficients or factors [-].
        """
        u, table = share * uniforms(self.seed, numbers), self.table(foot)  # Eq. 41
        above = np.clip(np.searchsorted(self.at, u, side="right"), 1, self.at.size - 1)  # of no body the share is NaN
        low, high = table[above - 1], table[above]
        return np.asarray(low + (high - low) * ((u - self.at[above - 1]) / (self.at[above] - self.at[above - 1])))


@dataclass(frozen=True, eq=False)
class SampledHistories(Histories):
    """Histories whose coefficients are multiplied by a draw for each, keyed by its number."""

    base: Histories  # the histories; with r = 1 on both sides the draw is the coefficient itself
    draw: SampledRestitution  # the distribution; what it multiplies is in the rows of the base

    @classmethod
    def of(cls, base: Histories, draw: SampledRestitution) -> "SampledHistories":
        """Return histories with the draws, which multiply the coefficients of the base."""
        given: object = base
        if not isinstance(given, Histories) or not isinstance(draw, SampledRestitution):
            raise InvalidValueError(
                "give Histories and a SampledRestitution, got {histories!r:.40} and {sample!r:.40}", histories=base,
                sample=draw,
            )  # fmt: skip
        if isinstance(given, SampledHistories):
            raise InvalidValueError("these histories draw their coefficients already; give the ones they are made from")
        law = ConstantRestitution() if isinstance(base.law, SampledRestitution) else base.law
        return cls(base.motions, base, draw, law=law, settings=base.settings, engine=base.engine)

    @property
    def count(self) -> int:
        return self.base.count

    @property
    def together(self) -> int:
        """Histories of one motion that stand in a row."""
        return self.base.together

    def rows(self, first: int, last: int) -> Rows:
        """Return those of the base, with the coefficients times the draws."""
        return drawn_rows(self.base.rows(first, last), self.draw)

    def content(self) -> dict[str, Any]:
        """Return the content of the base, and the distribution with its seed."""
        base = {"class": full_name(type(self.base)), "content": self.base.content()}
        return {"base": base, "draw": described_law(self.draw)}


def sampled(histories: Histories) -> Histories:
    """Return histories that the fast engine can take, where their law is a draw for every history."""
    return SampledHistories.of(histories, histories.law) if isinstance(histories.law, SampledRestitution) else histories


def uniforms(seed: int, numbers: Any, impact: int = 0) -> FloatArray:
    """Return numbers in [0, 1) by seed, history and impact: `impact_laws.uniform` of many, to the last bit."""
    keys = np.atleast_1d(np.asarray(numbers))
    if keys.dtype.kind not in "iu":
        raise InvalidValueError(
            "{parameter} must be whole numbers of histories, got {dtype} {numbers!r:.40}", parameter="numbers",
            dtype=keys.dtype, numbers=numbers,
        )  # fmt: skip
    place = np.uint64(int(checks.within("impact", impact, 0, 2**53)))
    words = _mixed(_mixed(_mixed(np.full(1, seed, np.uint64)) + keys.astype(np.uint64)) + place)  # Eq. 43
    return np.asarray((words >> np.uint64(11)).astype(np.float64) * 2.0**-53)


def _mixed(z: Any) -> Any:
    """Splitmix64 of words of 64 bits, which overflow as they should."""
    z = z + _GOLDEN
    z = (z ^ (z >> np.uint64(30))) * _FIRST
    z = (z ^ (z >> np.uint64(27))) * _SECOND
    return z ^ (z >> np.uint64(31))
