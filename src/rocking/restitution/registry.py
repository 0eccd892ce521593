"""Restitution models by name, a new one in one line here or by one call of `register`; the coefficient of a body."""

import inspect
import numbers
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, FEET, Foot
from rocking.errors import InvalidValueError, UnknownModelError
from rocking.restitution._implied import energy_bound
from rocking.restitution._model import RestitutionModel
from rocking.restitution.calibrated import Calibrated
from rocking.restitution.contact_bed import ContactBedModel
from rocking.restitution.distributed_impulse import DistributedImpulse
from rocking.restitution.fixed import Fixed
from rocking.restitution.horizontal_momentum import HorizontalMomentum
from rocking.restitution.housner import Housner
from rocking.restitution.ked import Ked
from rocking.restitution.plastic_winkler import PlasticWinkler
from rocking.restitution.shifted_impulse import ShiftedImpulse

BOUND_ROUNDING = 1e-9
"""A coefficient may exceed its energy bound by this, relative to the bound: rounding of I_O and r together."""

_MODELS: dict[str, type[RestitutionModel]] = {
    kind.name: kind
    for kind in (
        Housner, Ked, HorizontalMomentum, ShiftedImpulse, DistributedImpulse, PlasticWinkler, ContactBedModel,
        Calibrated, Fixed,
    )
}  # fmt: skip


def models() -> dict[str, type[RestitutionModel]]:
    """Return every registered restitution model.

    Returns
    -------
    dict of str to type
        Name to class; a copy.

    Examples
    --------
    >>> import rocking as rk
    >>> rk.restitution.models()["ked"].__name__
    'Ked'
    """
    return dict(_MODELS)


def register(kind: type[RestitutionModel]) -> type[RestitutionModel]:
    """Register a model class under its name, so that it can be asked for by name; usable as a decorator.

    Parameters
    ----------
    kind : type
        Subclass of `RestitutionModel` with a name.

    Returns
    -------
    type
        The class itself.

    Raises
    ------
    InvalidValueError
        If it is no such class, has no name, or another model has that name.
    """
    return put(kind)


def put(kind: type[RestitutionModel], over: Sequence[type[RestitutionModel]] = ()) -> type[RestitutionModel]:
    """Register a model class, in the place of one of those that it may be put over."""
    candidate: object = kind
    if not (inspect.isclass(candidate) and issubclass(candidate, RestitutionModel)):
        raise InvalidValueError(
            "a restitution model is a subclass of RestitutionModel, got {value}", parameter="kind", value=kind
        )
    name: object = getattr(kind, "name", None)
    if not isinstance(name, str) or not name:
        raise InvalidValueError("{type} needs a class attribute name = '...'", type=kind.__name__)
    check_complete(kind)
    if name in _MODELS and _MODELS[name] not in {kind, *over}:
        raise InvalidValueError(
            "a restitution model named {name!r} exists already: {type}", name=name, type=_MODELS[name].__name__
        )
    _MODELS[name] = kind
    return kind


def check_complete(kind: type[RestitutionModel]) -> None:
    """Refuse a class of models that lacks a method."""
    lacking = sorted(kind.__abstractmethods__)
    if lacking:
        raise InvalidValueError(
            "the model {type} has no method {methods}; a model has {method}, which returns the coefficient of a body "
            "that lands on a foot", type=kind.__name__, methods=", ".join(lacking), method=_METHOD,
        )  # fmt: skip


_METHOD = "raw_coefficient(self, body, onto)"


def withdraw(kind: type[RestitutionModel]) -> None:
    """Let a model no longer be asked for by its name."""
    if _MODELS.get(kind.name) is kind:
        _MODELS.pop(kind.name, None)


def model(which: str | RestitutionModel, *, eta: float = 1.0, **parameters: Any) -> RestitutionModel:
    """Return a restitution model by name, with its parameters and an interface factor.

    Parameters
    ----------
    which : str or RestitutionModel
        Name, name with parameters (``"shifted-impulse:k=0.6"``, ``"0.98*ked"``), or a model object.
    eta : float
        Interface factor in (0, 1] [-].
    **parameters
        The model's parameters: ``k``, ``q`` or ``r``.

    Returns
    -------
    RestitutionModel
        The model.

    Raises
    ------
    UnknownModelError
        If the name or a parameter is unknown, or a required parameter is missing.
    InvalidValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> model("0.98*shifted-impulse:k=0.6").label
    '0.98*shifted-impulse:k=0.6'
    """
    eta = _factor(eta)
    if isinstance(which, str):
        found, factor = _parsed(which, parameters)
        eta *= factor
    elif isinstance(which, RestitutionModel):
        if parameters:
            raise UnknownModelError(
                "a model object takes no further parameters, got {names}", names=", ".join(parameters)
            )
        found = which
    else:
        raise UnknownModelError(
            "a restitution model is a name or a RestitutionModel object, got {type}", type=of_no_kind(which)
        )
    if eta == 1.0:
        return found
    from rocking.restitution.interface import Interface

    return Interface(found, eta=eta)


def _factor(eta: Any) -> float:
    return checks.within("eta", eta, 0.0, 1.0, open_low=True, hint="the interface factor can only lose energy")


def _parsed(words: str, parameters: dict[str, Any]) -> tuple[RestitutionModel, float]:
    factor, star, rest = words.partition("*")
    eta = _factor(number("eta", factor)) if star else 1.0
    name, _, tail = (rest if star else words).strip().partition(":")
    given = parameters_in(tail, words, parameters)
    name = checks.spelling(name, _MODELS)
    if name not in _MODELS:
        raise UnknownModelError(
            "no restitution model named {name!r}; there are {names}", name=name, names=", ".join(list(_MODELS)),
            hint=checks.nearest(name, _MODELS),
        )  # fmt: skip
    return built(_MODELS[name], name, given), eta


def parameters_in(text: str, words: str, beside: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters that are written behind a name, and those given beside it."""
    given = dict(beside)
    for item in filter(None, text.split(",")):
        key, equals, value = item.partition("=")
        if not equals:
            raise UnknownModelError(
                "write parameters as name:k=0.6, and a model of your own as my_file.py:MyModel, got {model!r}",
                model=words, hint=checks.number_hint(words),
            )  # fmt: skip
        if key.strip() in given:
            raise UnknownModelError("{key} is given twice for model {model!r}", key=key.strip(), model=words)
        given[key.strip()] = number(key.strip(), value)
    return given


def built(kind: type[RestitutionModel], name: str, given: dict[str, Any]) -> RestitutionModel:
    """Return a model with its parameters."""
    check_complete(kind)
    try:
        return kind(**given)
    except TypeError as error:
        names = ", ".join(getattr(kind, "__dataclass_fields__", {}))
        raise UnknownModelError(
            "model {model!r} takes the parameter {names}, got {stated}" if names
            else "model {model!r} takes no parameters, got {stated}",
            model=name, names=names, stated=", ".join(given) or "none",
        ) from error  # fmt: skip


def number(name: str, words: str) -> float:
    """Return the number that a parameter was given in words."""
    try:
        return float(words)
    except ValueError as error:
        raise InvalidValueError(
            parameter=name, allowed="a number", value=words, hint=checks.number_hint(words)
        ) from error


def of_no_kind(restitution: object) -> str:
    """Return what an object is that is no restitution, and what it lacks to be one."""
    kind = restitution if isinstance(restitution, type) else type(restitution)
    if kind is restitution:
        return f"the class {kind.__name__}: create an object, {kind.__name__}()"
    if isinstance(restitution, (str, int, float, complex, list, tuple, dict, set, np.ndarray)) or restitution is None:
        return f"{restitution!r:.60}"
    if hasattr(kind, "factor"):
        return f"a {kind.__name__} object, a law that changes from impact to impact: it has no single coefficient"
    if not hasattr(kind, "raw_coefficient"):
        return (
            f"a {kind.__name__} object, which has no method raw_coefficient; a model of your own is a subclass of "
            f"RestitutionModel with {_METHOD}"
        )
    return f"a {kind.__name__} object, which is not a subclass of RestitutionModel"


def coefficients_of(restitution: Any, body: Body) -> tuple[dict[Foot, float], str]:
    """Return the coefficients for landing left and right, and their label [-]."""
    if isinstance(restitution, (str, RestitutionModel)):
        found = model(restitution)
        return {foot: found.coefficient(body, foot) for foot in FEET}, found.label
    if isinstance(restitution, Mapping):
        if set(restitution) != set(FEET):
            raise InvalidValueError(
                "{parameter} by side is {allowed}, got {value}", parameter="restitution",
                allowed='{"left": r, "right": r}', value=restitution,
            )  # fmt: skip
        pair: dict[Foot, float] = {foot: _coefficient(f"restitution[{foot!r}]", restitution[foot]) for foot in FEET}
        return pair, f"left {pair['left']:.6g}, right {pair['right']:.6g}"
    r = _coefficient("restitution", restitution)
    return dict.fromkeys(FEET, r), f"{r:.6g}"


def _coefficient(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (numbers.Real, np.ndarray)):
        allowed = (
            'a model, its name, a coefficient, or {"left": r, "right": r}' if name == "restitution" else "a number"
        )
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {shown}", parameter=name, allowed=allowed, value=value,
            shown=of_no_kind(value),
        )  # fmt: skip
    r = checks.within(name, value, 0.0, 10.0, hint="a ratio of velocities; a percentage?")
    plausibility.warn(plausibility.of_coefficient(r))
    return r


def energy_refusal(onto: Foot, most: float, largest: float) -> InvalidValueError:
    """Return the refusal of a coefficient [-] above the energy bound of a side."""
    return InvalidValueError(
        "the coefficient of restitution onto the {foot} foot must be in [0, {most:.6g}], got "
        "{largest:.6g}: the impact would create energy",
        foot=onto,
        most=most,
        largest=largest,
    )


def coefficient_of_restitution(
    body: Body,
    restitution: str | RestitutionModel | float | Mapping[str, float] = DEFAULT_RESTITUTION,
    *,
    onto: Foot = "right",
    eta: float = 1.0,
    **parameters: Any,
) -> float:
    """Return the coefficient of restitution of a body.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints. For a Solid see `rocking.restitution.space.edge_coefficient`.
    restitution : str, RestitutionModel, float or mapping
        As for `simulate`: name of a model (see `rocking.restitution.models`), a model object, which may be your own, a
        coefficient, or ``{"left": r, "right": r}`` with one coefficient for each foot. A law such as
        `SpeedRestitution` changes from impact to impact and has no single coefficient.
    onto : {"left", "right"}
        The foot on which the body lands.
    eta : float
        Interface factor in (0, 1] that multiplies the coefficient [-].
    **parameters
        Parameters of the model that is named: ``k``, ``q`` or ``r``.

    Returns
    -------
    float
        theta_dot_after / theta_dot_before; zero where the body stops instead of stepping on [-].

    Raises
    ------
    UnknownModelError
        If the model or a parameter is unknown.
    InvalidValueError
        If a value is outside its range, or a given coefficient would create energy.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0)
    >>> round(rk.coefficient_of_restitution(block, "ked"), 8)
    0.94736684
    >>> round(rk.coefficient_of_restitution(block, "shifted-impulse", k=0.6), 8)
    0.94610778
    >>> rk.coefficient_of_restitution(block, 0.9)
    0.9
    >>> rk.coefficient_of_restitution(block, {"left": 0.85, "right": 0.9}, onto="left")
    0.85

    The coefficient of an asymmetric body depends on the foot:

    >>> cabinet = rk.Block(width=0.8, height=2.0, centre=(0.3, 0.8))
    >>> [round(rk.coefficient_of_restitution(cabinet, "housner", onto=foot), 4) for foot in ("left", "right")]
    [0.7818, 0.6825]
    """
    if isinstance(restitution, (str, RestitutionModel)):
        return model(restitution, eta=eta, **parameters).coefficient(body, onto)
    if parameters:
        raise UnknownModelError("a coefficient takes no parameters, got {names}", names=", ".join(parameters))
    onto = checks.foot("onto", onto)
    checks.of_kind("body", body, Body, "a Block, Section or MassPoints")
    coefficients, _ = coefficients_of(restitution, body)
    r, most = coefficients[onto], energy_bound(body, onto)
    if r > most * (1.0 + BOUND_ROUNDING):
        raise energy_refusal(onto, most, r)
    return _factor(eta) * r
