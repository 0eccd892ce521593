"""Registry of restitution models by name, and the coefficient of a body."""

import inspect
import numbers
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.bodies import Body, Frame
from rocking.conventions import DEFAULT_RESTITUTION, FEET, FRAME_RESTITUTION, Foot
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
"""Allowed relative excess of a coefficient over its energy bound, for rounding of I_O and r."""

_MODELS: dict[str, type[RestitutionModel]] = {
    kind.name: kind
    for kind in (
        Housner, Ked, HorizontalMomentum, ShiftedImpulse, DistributedImpulse, PlasticWinkler, ContactBedModel,
        Calibrated, Fixed,
    )
}  # fmt: skip


def models() -> dict[str, type[RestitutionModel]]:
    """Return the registered restitution models.

    Returns
    -------
    dict of str to type
        Classes by name, as a copy.

    Examples
    --------
    >>> import rocking as rk
    >>> rk.restitution.models()["ked"].__name__
    'Ked'
    """
    return dict(_MODELS)


def register(kind: type[RestitutionModel]) -> type[RestitutionModel]:
    """Register a model class under its name. This function can be used as a decorator.

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
        If the class is not a model, if it has no name, or if its name is in use.
    """
    return put(kind)


def put(kind: type[RestitutionModel], over: Sequence[type[RestitutionModel]] = ()) -> type[RestitutionModel]:
    """Register a model class. `over` contains classes that it may replace."""
    candidate: object = kind
    if not (inspect.isclass(candidate) and issubclass(candidate, RestitutionModel)):
        raise InvalidValueError(
            "a restitution model must be a subclass of RestitutionModel, got {value}", parameter="kind", value=kind
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
    """Raise an error for a model class without a required method."""
    lacking = sorted(kind.__abstractmethods__)
    if lacking:
        raise InvalidValueError(
            "the model {type} has no method {methods}; define {method}, which returns the coefficient of a body for "
            "landing on a foot", type=kind.__name__, methods=", ".join(lacking), method=_METHOD,
        )  # fmt: skip


_METHOD = "raw_coefficient(self, body, foot)"


def withdraw(kind: type[RestitutionModel]) -> None:
    """Remove a model from the registry."""
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
        Parameters of the model: ``k``, ``q`` or ``r``.

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
        base, factor = _parsed(which, parameters)
        eta *= factor
    elif isinstance(which, RestitutionModel):
        if parameters:
            raise UnknownModelError(
                "a model object accepts no further parameters, got {names}", names=", ".join(parameters)
            )
        base = which
    else:
        raise UnknownModelError(
            "a restitution model must be a name or a RestitutionModel object, got {type}", type=of_no_kind(which)
        )
    if eta == 1.0:
        return base
    from rocking.restitution.interface import Interface

    return Interface(base, eta=eta)


def _factor(eta: Any) -> float:
    return checks.within("eta", eta, 0.0, 1.0, open_low=True, hint="the interface factor can only lose energy")


def _parsed(text: str, parameters: dict[str, Any]) -> tuple[RestitutionModel, float]:
    factor, star, remainder = text.partition("*")
    eta = _factor(number("eta", factor)) if star else 1.0
    name, _, tail = (remainder if star else text).strip().partition(":")
    values = parameters_in(tail, text, parameters)
    name = checks.spelling(name, _MODELS)
    if name not in _MODELS:
        raise UnknownModelError(
            "unknown restitution model {name!r}; models: {names}", name=name, names=", ".join(list(_MODELS)),
            hint=checks.nearest(name, _MODELS),
        )  # fmt: skip
    return built(_MODELS[name], name, values), eta


def parameters_in(text: str, label: str, others: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters in the text after a name, together with other parameters."""
    values = dict(others)
    for item in filter(None, text.split(",")):
        key, equals, value = item.partition("=")
        if not equals:
            raise UnknownModelError(
                "write parameters as name:k=0.6, and a model of your own as my_file.py:MyModel, got {model!r}",
                model=label, hint=checks.number_hint(label),
            )  # fmt: skip
        if key.strip() in values:
            raise UnknownModelError("{key} appears twice for model {model!r}", key=key.strip(), model=label)
        values[key.strip()] = number(key.strip(), value)
    return values


def built(kind: type[RestitutionModel], name: str, values: dict[str, Any]) -> RestitutionModel:
    """Return a model with its parameters."""
    check_complete(kind)
    try:
        return kind(**values)
    except TypeError as error:
        names = ", ".join(getattr(kind, "__dataclass_fields__", {}))
        raise UnknownModelError(
            "model {model!r} accepts {names}, got {stated}" if names
            else "model {model!r} accepts no parameters, got {stated}",
            model=name, names=names, stated=", ".join(values) or "none",
        ) from error  # fmt: skip


def number(name: str, text: str) -> float:
    """Return the number in the text of a parameter."""
    try:
        return float(text)
    except ValueError as error:
        raise InvalidValueError(
            parameter=name, allowed="a number", value=text, hint=checks.number_hint(text)
        ) from error


def of_no_kind(restitution: object) -> str:
    """Return a description of an object that is not a restitution, with its missing members."""
    kind = restitution if isinstance(restitution, type) else type(restitution)
    if kind is restitution:
        return f"the class {kind.__name__}; use an object, {kind.__name__}()"
    if isinstance(restitution, (str, int, float, complex, list, tuple, dict, set, np.ndarray)) or restitution is None:
        return f"{restitution!r:.60}"
    if hasattr(kind, "factor"):
        return f"a {kind.__name__} object, a law that varies from impact to impact, without a single coefficient"
    if not hasattr(kind, "raw_coefficient"):
        return (
            f"a {kind.__name__} object without method raw_coefficient; a model of your own must be a subclass of "
            f"RestitutionModel with {_METHOD}, and a law of the impact velocity a subclass of dynamics.ImpactLaw"
        )
    return f"a {kind.__name__} object, which is not a subclass of RestitutionModel"


def coefficients_of(restitution: Any, body: Body) -> tuple[dict[Foot, float], str]:
    """Return the coefficients for landing left and right [-], and their label."""
    if isinstance(body, Frame) and isinstance(restitution, str) and restitution == DEFAULT_RESTITUTION:
        return {foot: Housner().coefficient(body, foot) for foot in FEET}, FRAME_RESTITUTION
    if isinstance(restitution, (str, RestitutionModel)):
        resolved = model(restitution)
        return {foot: resolved.coefficient(body, foot) for foot in FEET}, resolved.label
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
    r = checks.within(name, value, 0.0, 10.0, hint="a ratio of velocities, not a percentage")
    plausibility.warn(plausibility.of_coefficient(r))
    return r


def energy_refusal(foot: Foot, bound: float, largest: float) -> InvalidValueError:
    """Return the error for a coefficient [-] above the energy bound of a side."""
    return InvalidValueError(
        "the coefficient of restitution onto the {foot} foot must be in [0, {most:.6g}], got "
        "{largest:.6g}: the impact would create energy",
        foot=foot,
        most=bound,
        largest=largest,
    )


def coefficient_of_restitution(
    body: Body,
    restitution: str | RestitutionModel | float | Mapping[str, float] = DEFAULT_RESTITUTION,
    *,
    foot: Foot = "right",
    eta: float = 1.0,
    **parameters: Any,
) -> float:
    """Return the coefficient of restitution of a body.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints. For a Solid see `rocking.restitution.space.edge_coefficient`.
    restitution : str, RestitutionModel, float or mapping
        As for `simulate`: name of a model (see `rocking.restitution.models`), a model object, a coefficient, or
        ``{"left": r, "right": r}`` with one coefficient per foot. A law such as `SpeedRestitution` varies from impact
        to impact and has no single coefficient.
    foot : {"left", "right"}
        The foot on which the body lands.
    eta : float
        Interface factor in (0, 1] that multiplies the coefficient [-].
    **parameters
        Parameters of a model given by name: ``k``, ``q`` or ``r``.

    Returns
    -------
    float
        theta_dot_after / theta_dot_before [-]; zero for a body that stops at the impact.

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
    >>> rk.coefficient_of_restitution(block, {"left": 0.85, "right": 0.9}, foot="left")
    0.85

    The coefficient of an asymmetric body depends on the foot:

    >>> cabinet = rk.Block(width=0.8, height=2.0, centre=(0.3, 0.8))
    >>> [round(rk.coefficient_of_restitution(cabinet, "housner", foot=foot), 4) for foot in ("left", "right")]
    [0.7818, 0.6825]
    """
    if isinstance(body, Frame) and isinstance(restitution, str) and restitution == DEFAULT_RESTITUTION:
        restitution = Housner.name
    if isinstance(restitution, (str, RestitutionModel)):
        return model(restitution, eta=eta, **parameters).coefficient(body, foot)
    if parameters:
        raise UnknownModelError("a coefficient accepts no parameters, got {names}", names=", ".join(parameters))
    foot = checks.foot("foot", foot)
    checks.of_kind("body", body, Body, "a Block, Section or MassPoints")
    coefficients, _ = coefficients_of(restitution, body)
    r, bound = coefficients[foot], energy_bound(body, foot)
    if r > bound * (1.0 + BOUND_ROUNDING):
        raise energy_refusal(foot, bound, r)
    return _factor(eta) * r
