"""Bodies of a prediction: distributions of uncertain inputs, sampling, and outcomes under each motion."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Self

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray, g
from rocking.decision.prediction.model_error import model_error_of
from rocking.decision.prediction.placement import STEEPEST, level_default
from rocking.errors import InvalidValueError
from rocking.messages import Amount, Message, Range
from rocking.motions.components import Components, components_of
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.summary import GROUND, support_of

_WAYS = ({"low", "high"}, {"mean", "deviation"}, {"median", "dispersion"}, {"values"})
_Ends = tuple[float, float]
_HINT = (
    "a number, a pair (low, high), a list of three or more numbers, or a table with low and high, mean and deviation, "
    "median and dispersion, or values"
)


@dataclass(frozen=True, eq=False)
class Uncertain:
    """A fixed number or a distribution."""

    text: str
    quantile: Callable[[FloatArray], FloatArray]  # inverse of the cumulative distribution
    fixed: bool = False  # True for a fixed number

    @property
    def median(self) -> float:
        """Median; for an even number of values, the mean of the middle two."""
        return float(self.quantile(np.array([0.5 - 1e-12, 0.5])).mean())

    @classmethod
    def of(cls, name: str, stated: Any, low: float, high: float, unit: str = "-") -> "Uncertain":
        """Return a stated input; `low` and `high` are the allowed range, which truncates distributions.

        >>> friction = Uncertain.of("friction", (0.4, 0.8), 0.0, 10.0)
        >>> friction.text, friction.quantile(np.array([0.25])).tolist()
        ('uniform, 0.4 to 0.8', [0.5])
        """
        ends, shown_unit = (low, high), "" if unit == "-" else unit
        if isinstance(stated, Mapping):
            return cls._of_table(name, stated, ends, shown_unit)
        if callable(getattr(stated, "ppf", None)):
            return cls._of_ppf(name, stated, ends, shown_unit)
        if isinstance(stated, (Sequence, np.ndarray)) and not isinstance(stated, str):
            return (cls._of_range if len(stated) == 2 else cls._of_sample)(name, stated, ends, shown_unit)
        if isinstance(stated, (str, bool)) or stated is None:
            raise InvalidValueError(parameter=name, allowed=_HINT, value=stated)
        value = checks.within(name, stated, low, high)
        return cls(str(Amount(value, shown_unit)), lambda u: np.full(u.shape, value), fixed=True)

    @classmethod
    def _of_table(cls, name: str, stated: Mapping[str, Any], ends: _Ends, unit: str) -> "Uncertain":
        if set(stated) not in _WAYS:
            raise InvalidValueError(
                "{parameter} must be {allowed}, got {keys}", parameter=name, allowed=_HINT, value=stated,
                keys=", ".join(map(str, stated)) or "an empty table",
            )  # fmt: skip
        if "low" in stated:
            return cls._of_range(name, (stated["low"], stated["high"]), ends, unit)
        if "values" in stated:
            return cls._of_sample(name, stated["values"], ends, unit)
        return cls._of_curve(name, stated, ends, unit)

    @classmethod
    def _of_range(cls, name: str, stated: Any, ends: _Ends, unit: str) -> "Uncertain":
        low, high = (
            checks.within(f"{name} {end}", value, *ends) for end, value in zip(("from", "to"), stated, strict=True)
        )
        if not low < high:
            raise InvalidValueError(
                "{parameter} must be a range from low to high, got {low:g} to {high:g}", parameter=name, low=low,
                high=high,
            )  # fmt: skip
        text = Message("uniform, {low} to {high}", {"low": Amount(low), "high": Amount(high, unit)})
        return cls(text, lambda u: low + u * (high - low))

    @classmethod
    def _of_sample(cls, name: str, stated: Any, ends: _Ends, unit: str) -> "Uncertain":
        numbers = (
            list(stated) if isinstance(stated, (Sequence, np.ndarray)) and not isinstance(stated, str) else [stated]
        )
        values = np.sort([checks.within(f"each value of {name}", value, *ends) for value in numbers])
        if values.size < 2:
            raise InvalidValueError(
                "{parameter} as a sample must have two or more values, got {count}", parameter=name, count=values.size
            )
        text = Message(
            "one of {size} values from {low} to {high}, equally likely",
            {"size": values.size, "low": Amount(float(values[0])), "high": Amount(float(values[-1]), unit)},
        )
        return cls(text, lambda u: values[np.minimum((u * values.size).astype(np.int64), values.size - 1)])

    @classmethod
    def _of_curve(cls, name: str, stated: Mapping[str, Any], ends: _Ends, unit: str) -> "Uncertain":
        from scipy.special import ndtr, ndtri

        logarithmic = "median" in stated
        kinds = ("median", "dispersion") if logarithmic else ("mean", "deviation")
        middle, spread = checks.within(f"{name} {kinds[0]}", stated[kinds[0]], *ends), stated[kinds[1]]
        spread = checks.positive(f"{name} {kinds[1]}", spread)
        text = Message("normal, {mean} +- {deviation}", {"mean": Amount(middle), "deviation": Amount(spread, unit)})
        scaled = np.array([*ends, middle])
        if logarithmic:
            facts = {"median": Amount(middle, unit), "dispersion": Amount(spread)}
            text = Message("lognormal, median {median}, dispersion {dispersion}", facts)
            with np.errstate(divide="ignore", invalid="ignore"):
                scaled = np.log(np.maximum(scaled, 0.0))
        low, high = ndtr((scaled[:2] - scaled[2]) / spread).tolist()
        if not high - low >= 0.5:
            raise InvalidValueError(
                "{parameter}: most of {distribution} is outside {limits}", parameter=name, distribution=text,
                limits=Range(*ends).limits(), hint="check the unit",
            )  # fmt: skip

        def quantile(u: FloatArray) -> FloatArray:
            values = scaled[2] + spread * ndtri(low + u * (high - low))
            return np.asarray(np.clip(np.exp(values) if logarithmic else values, *ends))

        return cls(text, quantile)

    @classmethod
    def _of_ppf(cls, name: str, stated: Any, ends: _Ends, unit: str) -> "Uncertain":
        low, high = np.asarray(stated.ppf(np.array([1e-6, 1.0 - 1e-6])), dtype=np.float64).tolist()
        if not ends[0] <= low <= high <= ends[1]:
            raise InvalidValueError(
                "{parameter} must be within {limits}, got {low:g} to {high:g}", parameter=name, allowed=Range(*ends),
                limits=Range(*ends).limits(), low=low, high=high,
            )  # fmt: skip
        facts = {"low": Amount(low, digits=".4g"), "high": Amount(high, unit, ".4g")}
        text = Message("distribution with nearly all values from {low} to {high}", facts)
        return cls(text, lambda u: np.clip(np.asarray(stated.ppf(u), dtype=np.float64), *ends))


MEASURED, COMPLEMENTARITY = ("measured", "calibrated"), "complementarity"
"""Names of restitutions: sampled from published measurements, and only from the contact laws at the corners."""

FRICTION = ((0.3, 0.8), 0.01, 10.0, "-")
CENTRE = ((0.97, 1.03), 0.5, 1.5, "-")
FRICTION_REASON = Message(
    "dry stone, concrete, wood and metal: for the same pair of materials, EN 12812 and BS 5975 differ as much as the "
    "ends of this range"
)
CENTRE_REASON = Message("factor on the height of the centre of mass: the density of a body is rarely uniform")
AZIMUTH_REASON = Message("the orientation of the body to the two components is unknown")
DENSITY_REASON = Message(
    "a factor on the density does not change the rotation; the input 'centre' represents non-uniform density"
)


def with_reason(choice: str, reason: str) -> str:
    """Return the assumption on an input with its reason."""
    return Message("{choice} ({reason})", {"choice": choice, "reason": reason})


def as_measured(text: str, *, extrapolated: bool) -> str:
    """Return the text of a coefficient of restitution from the measurements."""
    outside = Message("{words}, outside the range of measured slenderness", {"words": text})
    return outside if extrapolated else text


MEASURED_REASON = Message("the published measurements, with the scatter between bodies")

Usual = tuple[Any, float, float, str]
"""Default of an input, its smallest and largest allowed value, and its unit."""


@dataclass(frozen=True, eq=False)
class BodyOutcomes:
    """Outcomes of bodies under one motion, one entry per body."""

    uplift: FloatArray  # 1 with uplift, 0 without, NaN without a result
    sliding: FloatArray  # sliding distance [m]
    overturning: FloatArray  # 1 with overturning, 0 without, NaN without a result
    peak: FloatArray  # absolute peak rotation [rad]
    direction: FloatArray | None = None  # direction of overturning of a 3D body, from x to y [rad]


class SampledBodies(ABC):
    """A body for an engine: samples from the unit cube, and outcomes."""

    kind: str = "natural"  # class of bodies with a common prior of the model error
    slope: float = 1.0  # calibration slope of the probability of overturning [-]
    widths_of: Mapping[str, int] = {}  # number of dimensions of an input in the unit cube; default: 1
    reasons: Mapping[str, str] = {}  # reasons of the defaults, by input
    never_sampled: Mapping[str, str] = MappingProxyType({})  # reasons for quantities that are not sampled, by name

    def __init__(self, motions: Any, inputs: Mapping[str, Any]) -> None:
        self.motions, self.names, self._turns = motion_sequence(motions), [], False
        for k in range(len(self.motions)):
            along, across, _ = ground_components(self.motions[k])
            self.names.append(along.name)
            self._turns |= across is not None
        self.stated, self.inputs = dict(inputs), dict[str, Uncertain]()
        self.assumed: dict[str, str] = {}  # reason by input; empty for a sentence that does not belong to an input

    def _level(self, width: float) -> Usual:
        """Return the default slope of the support in each direction, by its name or the width of the base [m]."""
        default, reason = level_default(self.stated.get("level"), width)
        if default is not None:
            self.stated["level"], self.reasons = None, {**self.reasons, "level": reason}
        return default, -STEEPEST, STEEPEST, "rad"

    def _set_inputs(self, usual: Mapping[str, Usual]) -> None:
        """Set the stated inputs, and the defaults of the others with their reasons."""
        for name, (default, low, high, unit) in usual.items():
            stated = self.stated.get(name)
            self.inputs[name] = Uncertain.of(name, default if stated is None else stated, low, high, unit)
            if stated is None:
                self.assumed[name] = with_reason(self.inputs[name].text, self.reasons[name])
        plausibility.warn(plausibility.of_friction(self.inputs["friction"].median))

    def _set_model_error(self) -> None:
        """Set the factors of the model error, by default those of the class of the body."""
        error = model_error_of(self.stated.get("model_error"), self.kind)
        if error is None:
            self.inputs["model_error"] = Uncertain(Message("off"), lambda levels: np.ones(levels.shape), fixed=True)
            return
        self.inputs["model_error"], self.slope = Uncertain(error.text, error.factors), error.slope
        if self.stated.get("model_error") is None:
            self.assumed["model_error"] = with_reason(error.text, error.source)

    @abstractmethod
    def _set_restitution(self, stated: Any) -> None:
        """Set the law of impacts, and the distribution of its parameter as the first input."""

    def with_restitution(self, stated: Any) -> Self:
        """Return a copy with another restitution; shapes are shared."""
        other = copy(self)
        other.inputs = {name: uncertain for name, uncertain in self.inputs.items() if name != "restitution"}
        other.assumed = dict(self.assumed)
        other._set_restitution(stated)
        return other

    @property
    def widths(self) -> dict[str, int]:
        """Dimensions of each uncertain input in the unit cube."""
        return {name: self.widths_of.get(name, 1) for name, uncertain in self.inputs.items() if not uncertain.fixed}

    @property
    def not_sampled(self) -> dict[str, str]:
        """Reasons of quantities with one value in all histories: fixed inputs, and inputs without a distribution."""
        reason = Message("given")
        fixed = {
            name: with_reason(uncertain.text, reason) for name, uncertain in self.inputs.items() if uncertain.fixed
        }
        return {**fixed, **self.never_sampled}

    def probabilities(self, draws: FloatArray) -> dict[str, FloatArray]:
        """Return the columns of each input; 0.5 for fixed inputs."""
        columns, column, widths = {}, 0, self.widths
        for name in self.inputs:
            width = widths.get(name, 0)
            middle = np.full((len(draws), self.widths_of.get(name, 1)), 0.5)
            columns[name] = draws[:, column : column + width] if width else middle
            column += width
        return columns

    def values(self, draws: FloatArray) -> dict[str, FloatArray]:
        """Return the values of samples from the unit cube, by input; one row per body."""
        levels = self.probabilities(draws)
        return {name: uncertain.quantile(levels[name]) for name, uncertain in self.inputs.items()}

    @abstractmethod
    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> BodyOutcomes:
        """Return the outcomes of bodies under a motion times a factor."""


class _ScaledToPeak(Sequence[Any]):
    """Motions of a set, scaled to a peak ground acceleration on access."""

    def __init__(self, motions: Any, pga: float) -> None:
        self._motions, self._pga = motions, checks.positive("pga", pga, "m/s2")

    def __len__(self) -> int:
        return len(self._motions)

    def __getitem__(self, index: Any) -> Any:
        motion = self._motions[index]
        x, y, z = ground_components(motion)
        components = Components(x, y, z)
        if (support := support_of(components)) != GROUND:
            raise InvalidValueError(
                "pga applies to ground motions, but {motion!r:.80} is the motion of {support}", motion=x.name,
                support=support, hint="put scale:pga before floor in the steps of the record",
            )  # fmt: skip
        if not components.peak > 0.0:
            raise InvalidValueError(
                "motion {motion!r:.80} is zero throughout and cannot be scaled to a PGA", motion=x.name
            )
        scaled = components.each(lambda component: _to_peak(component, self._pga, components.peak))
        return scaled.x if y is None and z is None else scaled


def _to_peak(component: Any, pga: float, peak: float) -> Any:
    """Return a component times the factor that scales the stronger horizontal component to a peak [m/s2]."""
    if isinstance(component, Pulse):
        return component.scaled(pga / peak)
    vertical = None if component.vertical is None else component.vertical * (pga / peak)
    step = f"multiplied by {pga / peak!r} so that PGA is {pga:g} m/s2 ({pga / g:.4g} g)"
    return component.changed(step, acceleration=component.acceleration * (pga / peak), vertical=vertical)


def motion_sequence(motions: Any, pga: float | None = None) -> Any:
    """Return an indexable sequence of motions, optionally scaled to a peak ground acceleration `pga` [m/s2]."""
    if isinstance(motions, (Mapping, GroundMotion, Pulse)) or not hasattr(motions, "__getitem__"):
        motions = [motions]
    if isinstance(motions, str) or not motions:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {given}", parameter="motions",
            allowed="one or more records, pulses, or mappings with x and y", value=motions,
            given=checks.given("motions", motions),
        )  # fmt: skip
    return motions if pga is None else _ScaledToPeak(motions, pga)


def ground_components(motion: Any) -> tuple[Any, Any, Any]:
    """Return the components x, y and z of a motion; None for a missing y or z."""
    kinds = (Mapping, Components, GroundMotion, Pulse)
    checks.of_kind("motions", motion, kinds, "records, pulses, or mappings with x and y")
    x, y, z = components_of(motion) if isinstance(motion, (Mapping, Components)) else (motion, None, None)
    if x is None:
        raise InvalidValueError("component x is missing")
    if y is not None and not (isinstance(x, GroundMotion) and isinstance(y, GroundMotion)):
        raise InvalidValueError("components x and y must be records; sample pulses first")
    return x, y, z
