"""What a prediction asks of a body: what is not known exactly, drawn, and what becomes of it under each motion."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError
from rocking.messages import Amount, Message, Range
from rocking.motions.components import Components, components_of
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.summary import GROUND, support_of

_WAYS = ({"low", "high"}, {"mean", "deviation"}, {"median", "dispersion"}, {"values"})
_Ends = tuple[float, float]
_HINT = (
    "a number, a pair (low, high), a sample of more numbers, or one of the tables low and high, mean and deviation, "
    "median and dispersion, values"
)


@dataclass(frozen=True, eq=False)
class Uncertain:
    """A number that is known, or its distribution."""

    words: str
    quantile: Callable[[FloatArray], FloatArray]  # values that are not exceeded with probabilities
    fixed: bool = False  # whether it is one number

    @property
    def median(self) -> float:
        """Median; of an even number of values the mean of the middle two."""
        return float(self.quantile(np.array([0.5 - 1e-12, 0.5])).mean())

    @classmethod
    def of(cls, name: str, given: Any, low: float, high: float, unit: str = "-") -> "Uncertain":
        """Return what was given; low, high: least and largest value that make sense, where distributions are cut.

        >>> found = Uncertain.of("friction", (0.4, 0.8), 0.0, 10.0)
        >>> found.words, found.quantile(np.array([0.25])).tolist()
        ('from 0.4 to 0.8, all alike', [0.5])
        """
        ends, told = (low, high), "" if unit == "-" else unit
        if isinstance(given, Mapping):
            return cls._of_table(name, given, ends, told)
        if callable(getattr(given, "ppf", None)):
            return cls._of_ppf(name, given, ends, told)
        if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str):
            return (cls._of_range if len(given) == 2 else cls._of_sample)(name, given, ends, told)
        if isinstance(given, (str, bool)) or given is None:
            raise InvalidValueError(parameter=name, allowed=_HINT, value=given)
        value = checks.within(name, given, low, high)
        return cls(str(Amount(value, told)), lambda u: np.full(u.shape, value), fixed=True)

    @classmethod
    def _of_table(cls, name: str, given: Mapping[str, Any], ends: _Ends, unit: str) -> "Uncertain":
        if set(given) not in _WAYS:
            raise InvalidValueError(
                "{parameter} must be {allowed}, got {keys}", parameter=name, allowed=_HINT, value=given,
                keys=", ".join(map(str, given)) or "an empty table",
            )  # fmt: skip
        if "low" in given:
            return cls._of_range(name, (given["low"], given["high"]), ends, unit)
        if "values" in given:
            return cls._of_sample(name, given["values"], ends, unit)
        return cls._of_curve(name, given, ends, unit)

    @classmethod
    def _of_range(cls, name: str, given: Any, ends: _Ends, unit: str) -> "Uncertain":
        least, most = (
            checks.within(f"{name} {end}", value, *ends) for end, value in zip(("from", "to"), given, strict=True)
        )
        if not least < most:
            raise InvalidValueError(
                "{parameter} must be a range from low to high, got {low:g} to {high:g}", parameter=name, low=least,
                high=most,
            )  # fmt: skip
        words = Message("from {low} to {high}, all alike", {"low": Amount(least), "high": Amount(most, unit)})
        return cls(words, lambda u: least + u * (most - least))

    @classmethod
    def _of_sample(cls, name: str, given: Any, ends: _Ends, unit: str) -> "Uncertain":
        several = list(given) if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str) else [given]
        values = np.sort([checks.within(f"each value of {name}", value, *ends) for value in several])
        if values.size < 2:
            raise InvalidValueError(
                "{parameter} as a sample takes two values or more, got {count}", parameter=name, count=values.size
            )
        words = Message(
            "one of {size} values from {low} to {high}, each as likely",
            {"size": values.size, "low": Amount(float(values[0])), "high": Amount(float(values[-1]), unit)},
        )
        return cls(words, lambda u: values[np.minimum((u * values.size).astype(np.int64), values.size - 1)])

    @classmethod
    def _of_curve(cls, name: str, given: Mapping[str, Any], ends: _Ends, unit: str) -> "Uncertain":
        from scipy.special import ndtr, ndtri

        logarithmic = "median" in given
        kinds = ("median", "dispersion") if logarithmic else ("mean", "deviation")
        middle, spread = checks.within(f"{name} {kinds[0]}", given[kinds[0]], *ends), given[kinds[1]]
        spread = checks.positive(f"{name} {kinds[1]}", spread)
        words = Message("normal, {mean} +- {deviation}", {"mean": Amount(middle), "deviation": Amount(spread, unit)})
        scaled = np.array([*ends, middle])
        if logarithmic:
            facts = {"median": Amount(middle, unit), "dispersion": Amount(spread)}
            words = Message("lognormal, median {median}, dispersion {dispersion}", facts)
            with np.errstate(divide="ignore", invalid="ignore"):
                scaled = np.log(np.maximum(scaled, 0.0))
        low, high = ndtr((scaled[:2] - scaled[2]) / spread).tolist()
        if not high - low >= 0.5:
            raise InvalidValueError(
                "{parameter}: most of {distribution} is outside {limits}", parameter=name, distribution=words,
                limits=Range(*ends).limits(), hint="in other units?",
            )  # fmt: skip

        def quantile(u: FloatArray) -> FloatArray:
            found = scaled[2] + spread * ndtri(low + u * (high - low))
            return np.asarray(np.clip(np.exp(found) if logarithmic else found, *ends))

        return cls(words, quantile)

    @classmethod
    def _of_ppf(cls, name: str, given: Any, ends: _Ends, unit: str) -> "Uncertain":
        low, high = np.asarray(given.ppf(np.array([1e-6, 1.0 - 1e-6])), dtype=np.float64).tolist()
        if not ends[0] <= low <= high <= ends[1]:
            raise InvalidValueError(
                "{parameter} must be within {limits}, got {low:g} to {high:g}", parameter=name, allowed=Range(*ends),
                limits=Range(*ends).limits(), low=low, high=high,
            )  # fmt: skip
        facts = {"low": Amount(low, digits=".4g"), "high": Amount(high, unit, ".4g")}
        words = Message("of a distribution, nearly all from {low} to {high}", facts)
        return cls(words, lambda u: np.clip(np.asarray(given.ppf(u), dtype=np.float64), *ends))


MEASURED, COMPLEMENTARITY = ("measured", "calibrated"), "complementarity"
"""Restitution by what the published measurements say of a body, drawn; by the laws of contact at the corners alone."""

FRICTION = ((0.3, 0.8), 0.01, 10.0, "-")
CENTRE = ((0.97, 1.03), 0.5, 1.5, "-")
FRICTION_WHY = Message(
    "dry stone, concrete, wood and metal: EN 12812 and BS 5975 differ by as much for one pair of them"
)
CENTRE_WHY = Message("factor on the height of the centre: what is inside is rarely homogeneous")
AZIMUTH_WHY = Message("which way round the body stands to the two components is not known")
DENSITY_WHY = Message("a factor on it changes no rotation; the factor centre stands for density that differs by place")


def because(choice: str, reason: str) -> str:
    """Return what was assumed of an input, and why."""
    return Message("{choice} ({reason})", {"choice": choice, "reason": reason})


def as_measured(words: str, *, extrapolated: bool) -> str:
    """Return the words for a coefficient of restitution that the measurements give."""
    outside = Message("{words}, outside of the slendernesses that were measured", {"words": words})
    return outside if extrapolated else words


MEASURED_WHY = Message("the published measurements, with the scatter of single bodies")

Usual = tuple[Any, float, float, str]
"""What an input is where nobody says otherwise, its least and largest value that make sense, and its unit."""


@dataclass(frozen=True, eq=False)
class Endings:
    """What became of bodies under one motion, one entry a body."""

    uplift: FloatArray  # 1 where it rocked, 0 where not, NaN without a result
    sliding: FloatArray  # how far it slid [m]
    overturning: FloatArray  # 1 where it overturned
    peak: FloatArray  # largest rotation, without its sign [rad]
    direction: FloatArray | None = None  # of a body in space, in which it leant when it fell, from x to y [rad]


class SampledBodies(ABC):
    """A body on an engine: what is drawn for it from the unit cube, and what becomes of it."""

    widths_of: Mapping[str, int] = {}  # how many numbers an input takes, if not one
    why: Mapping[str, str] = {}  # why inputs are what they are where nobody says otherwise
    never_sampled: Mapping[str, str] = MappingProxyType({})  # by name what is one value in all histories, and why

    def __init__(self, motions: Any, given: Mapping[str, Any]) -> None:
        self.motions, self.names, self._turns = several(motions), [], False
        for k in range(len(self.motions)):
            along, across, _ = parts(self.motions[k])
            self.names.append(along.name)
            self._turns |= across is not None
        self.given, self.inputs = given, dict[str, Uncertain]()
        self.assumed: dict[str, str] = {}  # by the name of an input the reason, or by a sentence nothing

    def _take(self, usual: Mapping[str, Usual]) -> None:
        """Take what is given of inputs, and say what was assumed of the others."""
        for name, (otherwise, low, high, unit) in usual.items():
            told = self.given.get(name)
            self.inputs[name] = Uncertain.of(name, otherwise if told is None else told, low, high, unit)
            if told is None:
                self.assumed[name] = because(self.inputs[name].words, self.why[name])
        plausibility.warn(plausibility.of_friction(self.inputs["friction"].median))

    @property
    def widths(self) -> dict[str, int]:
        """How many numbers from 0 to 1 each input takes that is not known."""
        return {name: self.widths_of.get(name, 1) for name, each in self.inputs.items() if not each.fixed}

    @property
    def not_sampled(self) -> dict[str, str]:
        """What is one value in all histories: inputs that are known, and what has no distribution."""
        given = Message("given")
        known = {name: because(each.words, given) for name, each in self.inputs.items() if each.fixed}
        return {**known, **self.never_sampled}

    def probabilities(self, draws: FloatArray) -> dict[str, FloatArray]:
        """Return the columns of each input; one half of what is fixed, whatever it then means."""
        found, at, widths = {}, 0, self.widths
        for name in self.inputs:
            width = widths.get(name, 0)
            fixed = np.full((len(draws), self.widths_of.get(name, 1)), 0.5)
            found[name] = draws[:, at : at + width] if width else fixed
            at += width
        return found

    def values(self, draws: FloatArray) -> dict[str, FloatArray]:
        """Return what draws from the unit cube mean, by input; one row a body."""
        levels = self.probabilities(draws)
        return {name: each.quantile(levels[name]) for name, each in self.inputs.items()}

    @abstractmethod
    def run(self, draws: FloatArray, motion: int, factor: FloatArray, threads: int | None) -> Endings:
        """Return what becomes of bodies under a motion times a factor."""


class _ScaledToPeak(Sequence[Any]):
    """Motions of a set, scaled to a peak ground acceleration when they are asked for."""

    def __init__(self, motions: Any, pga: float) -> None:
        self._motions, self._pga = motions, checks.positive("pga", pga, "m/s2")

    def __len__(self) -> int:
        return len(self._motions)

    def __getitem__(self, index: Any) -> Any:
        motion = self._motions[index]
        x, y, z = parts(motion)
        whole = Components(x, y, z)
        if (support := support_of(whole)) != GROUND:
            raise InvalidValueError(
                "pga is of the ground, and {motion!r:.80} is the motion of {support}", motion=x.name, support=support,
                hint="put scale:pga before floor in the steps of the record",
            )  # fmt: skip
        if not whole.peak > 0.0:
            raise InvalidValueError(
                "motion {motion!r:.80} is zero throughout and cannot be scaled to a PGA", motion=x.name
            )
        scaled = whole.each(lambda part: _to_peak(part, self._pga, whole.peak))
        return scaled.x if y is None and z is None else scaled


def _to_peak(part: Any, pga: float, peak: float) -> Any:
    """Return a component multiplied by the factor that brings the stronger horizontal one to a peak [m/s2]."""
    if isinstance(part, Pulse):
        return part.scaled(pga / peak)
    vertical = None if part.vertical is None else part.vertical * (pga / peak)
    what = f"multiplied by {pga / peak!r} so that PGA is {pga:g} m/s2 ({pga / g:.4g} g)"
    return part.changed(what, acceleration=part.acceleration * (pga / peak), vertical=vertical)


def several(motions: Any, pga: float | None = None) -> Any:
    """Return motions by number: one, several, or a set that makes them when they are asked for; pga: scaled to it."""
    if isinstance(motions, (Mapping, GroundMotion, Pulse)) or not hasattr(motions, "__getitem__"):
        motions = [motions]
    if isinstance(motions, str) or not motions:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {given}", parameter="motions",
            allowed="one or more records, pulses or pairs x and y", value=motions,
            given=checks.given("motions", motions),
        )  # fmt: skip
    return motions if pga is None else _ScaledToPeak(motions, pga)


def parts(motion: Any) -> tuple[Any, Any, Any]:
    """Return what moves the ground along x, across it and upwards."""
    checks.of_kind("motions", motion, (Mapping, Components, GroundMotion, Pulse), "records, pulses or pairs x and y")
    x, y, z = components_of(motion) if isinstance(motion, (Mapping, Components)) else (motion, None, None)
    if x is None:
        raise InvalidValueError("a motion of components has one along x, got none")
    if y is not None and not (isinstance(x, GroundMotion) and isinstance(y, GroundMotion)):
        raise InvalidValueError("two components are two records; sample the pulses first")
    return x, y, z
