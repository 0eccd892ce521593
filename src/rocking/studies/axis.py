"""An axis of a map: a parameter of the body or the motion, its values, and how it changes a case."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from rocking import checks, plausibility
from rocking.bodies import Block
from rocking.conventions import FEET, FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution
from rocking.errors import InvalidValueError
from rocking.motions import peak_ground_velocity
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Motion, Pulse, Ricker, Sinusoids
from rocking.studies.question import Question
from rocking.studies.variations import Case

BODY, RESTITUTION, TIME, AMPLITUDE, VELOCITY = range(5)
"""Stages in which axes are applied, in this order."""


@dataclass(frozen=True, eq=False)
class Axis(ABC):
    """A parameter of a map and its values: increasing, finite, within the range of the axis."""

    values: FloatArray

    name: ClassVar[str]
    unit: ClassVar[str]
    words: ClassVar[str]  # what it means
    sets: ClassVar[str]  # what it decides; two axes of a map cannot decide the same thing
    stage: ClassVar[int]  # when it is applied
    low: ClassVar[float] = 0.0
    high: ClassVar[float] = 1e9
    low_is_allowed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        values = np.atleast_1d(checks.real_array(self.name, self.values, self.unit)).copy()
        if values.ndim != 1 or not values.size:
            raise InvalidValueError(f"{self.name} must be a row of numbers, got shape {values.shape}")
        above = values >= self.low if self.low_is_allowed else values > self.low
        bad = np.flatnonzero(~(above & (values <= self.high)))
        if bad.size:
            bracket = "[" if self.low_is_allowed else "("
            raise InvalidValueError(
                f"{self.name} must be in {bracket}{self.low:g}, {self.high:g}] {self.unit}, "
                f"got {values[bad[0]]:g} at index {bad[0]}; wrong unit?"
            )
        if np.any(np.diff(values) <= 0.0):
            raise InvalidValueError(f"{self.name} must increase from value to value")
        values.setflags(write=False)
        object.__setattr__(self, "values", values)

    @abstractmethod
    def applied(self, case: Case, values: FloatArray) -> Case:
        """Return a case with this parameter changed, to a value for each of its variations."""

    def check(self, question: Question) -> None:
        """Refuse a question that has no such parameter."""
        if self.stage == TIME:
            question.check_stretching(self.name)

    def check_beside(self, other: "Axis") -> None:  # noqa: B027 - most axes fit any other
        """Refuse another axis whose values this one cannot go with."""

    @property
    def attributes(self) -> dict[str, str]:
        """Unit and meaning, for a coordinate of a dataset."""
        return {"units": self.unit, "long_name": self.words}


_SAMPLES = 4096


def main_period(motion: Motion) -> float:
    """Return the period T_p of a pulse; of a sum of sinusoids that of the first [s].

    >>> from rocking.motions.pulses import sine
    >>> round(main_period(sine(2.0, 0.5)), 12)
    0.5
    """
    if isinstance(motion, Ricker):
        return motion.period
    frequency = abs(motion.waves[0][1]) if isinstance(motion, Sinusoids) else 0.0
    if frequency == 0.0:
        raise InvalidValueError(
            f"the period of a pulse cannot vary for {motion.name!r}, which has none; "
            "the axes scale, pga, pgv and duration take any motion"
        )
    return 2.0 * math.pi / frequency


def peak_velocity(motion: Motion) -> float:
    """Return the largest velocity of the ground in either direction [m/s].

    >>> import math
    >>> from rocking.motions.pulses import sine
    >>> round(peak_velocity(sine(math.pi, 1.0)), 12)
    1.0
    """
    if isinstance(motion, GroundMotion):
        return peak_ground_velocity(motion)
    times = np.linspace(0.0, motion.duration, _SAMPLES + 1)
    turns = _zeros_of_acceleration(motion, times)
    return float(np.abs(motion.velocity(np.concatenate([times, turns]))).max())


def _zeros_of_acceleration(motion: Pulse, times: FloatArray) -> FloatArray:
    signs = np.sign(motion.acceleration_inside(times))
    places = np.flatnonzero(signs[:-1] * signs[1:] < 0.0)
    low, high = times[places], times[places + 1]
    for _ in range(60):
        middle = 0.5 * (low + high)
        left = np.sign(motion.acceleration_inside(middle)) == signs[places]
        low, high = np.where(left, middle, low), np.where(left, high, middle)
    return low


class _BodyAxis(Axis):
    """A dimension of the body."""

    stage = BODY

    def applied(self, case: Case, values: FloatArray) -> Case:
        return replace(case, geometry={**case.geometry, self.name: values})


class _BlockAxis(_BodyAxis):
    """A dimension that only a block has."""

    def check(self, question: Question) -> None:
        if not isinstance(question.body, Block):
            raise InvalidValueError(f"{self.name} varies only for a Block, got {question.body!r:.60}")


class SemiDiagonal(_BodyAxis):
    """Size: the body with all its lengths scaled."""

    name, unit, words, sets = "semi_diagonal", "m", "semi-diagonal R; the body with all lengths scaled", "size"


class SlendernessAngle(_BlockAxis):
    """Slenderness angle of a block; the semi-diagonal stays unless the other axis is a dimension."""

    name, unit, words, sets = "slenderness_angle", "rad", "slenderness angle alpha of the block", "slenderness"
    high = 0.5 * np.pi


class SlendernessRatio(_BlockAxis):
    """Slenderness ratio h/b of a block; the semi-diagonal stays unless the other axis is a dimension."""

    name, unit, words, sets = "slenderness_ratio", "1", "slenderness ratio h/b of the block", "slenderness"

    def applied(self, case: Case, values: FloatArray) -> Case:
        return replace(case, geometry={**case.geometry, "slenderness_angle": np.arctan(1.0 / values)})


class Width(_BlockAxis):
    """Width of a block; the height stays unless the other axis changes it."""

    name, unit, words, sets = "width", "m", "width of the block", "width"


class Height(_BlockAxis):
    """Height of a block; the width stays unless the other axis changes it."""

    name, unit, words, sets = "height", "m", "height of the block", "height"


class RestitutionAxis(Axis):
    """A coefficient of restitution, the same for both sides."""

    name, unit, words = "restitution", "1", "coefficient of restitution, ratio of velocities"
    sets, stage, high, low_is_allowed = "restitution", RESTITUTION, 1.0, True

    def check(self, question: Question) -> None:
        if not isinstance(question.law, ConstantRestitution):
            raise InvalidValueError(
                f"restitution is an axis: leave the law of impact out, got {type(question.law).__name__}"
            )

    def applied(self, case: Case, values: FloatArray) -> Case:
        body = case.question.body
        inertia = [body.side(foot).moment_of_inertia for foot in FEET]
        most = np.sqrt(min(inertia) / max(inertia)) * (1.0 + 1e-9)  # Eq. 29
        allowed = np.where(values <= most, values, np.nan)
        return replace(case, sides={**case.sides, "r_right": allowed, "r_left": allowed})


class _TimeAxis(Axis):
    """Something that stretches the motion in time."""

    sets, stage = "the time of the motion", TIME


class Period(_TimeAxis):
    """Period of a pulse."""

    name, unit, words = "period", "s", "period T_p of the pulse"

    def check(self, question: Question) -> None:
        super().check(question)
        main_period(question.motion)

    def applied(self, case: Case, values: FloatArray) -> Case:
        return replace(case, stretch=values / main_period(case.question.motion))


class FrequencyRatio(Period):
    """Circular frequency of a pulse over the frequency parameter of the body."""

    name, unit, words = "frequency_ratio", "1", "omega_p / p, frequency of the pulse over that of the body"

    def applied(self, case: Case, values: FloatArray) -> Case:
        return super().applied(case, 2.0 * np.pi / (values * case.frequency_parameter))


class Duration(_TimeAxis):
    """Duration of any motion, which is stretched in time to it."""

    name, unit, words = "duration", "s", "duration of the motion, stretched in time"

    def applied(self, case: Case, values: FloatArray) -> Case:
        return replace(case, stretch=values / case.question.motion.duration)


class _AmplitudeAxis(Axis):
    """Something that scales the motion."""

    sets, stage = "the amplitude of the motion", AMPLITUDE

    def check(self, question: Question) -> None:
        if not question.motion.peak > 0.0:
            raise InvalidValueError(f"the amplitude of {question.motion.name!r} cannot be set: it is zero throughout")

    def _factors(self, case: Case, values: FloatArray) -> FloatArray:
        return values

    def applied(self, case: Case, values: FloatArray) -> Case:
        return replace(case, scale=self._factors(case, values), amplitude_is_set=True)


class Scale(_AmplitudeAxis):
    """Factor on the motion."""

    name, unit, words, low, high = "scale", "1", "factor on the motion", -1e6, 1e6

    def check(self, question: Question) -> None:
        super().check(question)
        plausibility.warn(plausibility.of_scaled([question.motion], self.values))


class PeakAcceleration(_AmplitudeAxis):
    """Peak ground acceleration."""

    name, unit, words, high = "pga", "m/s2", "peak ground acceleration", 1e6

    def check(self, question: Question) -> None:
        super().check(question)
        plausibility.warn(plausibility.of_acceleration(float(self.values.max())))

    def _factors(self, case: Case, values: FloatArray) -> FloatArray:
        return values / case.question.motion.peak


class AmplitudeRatio(_AmplitudeAxis):
    """Peak ground acceleration over the one that lifts the body."""

    name, unit, high = "amplitude_ratio", "1", 1e6
    words = "a_p / (g tan alpha), or a_p / (g alpha) in the linear equations"

    def _factors(self, case: Case, values: FloatArray) -> FloatArray:
        return values * case.uplift_acceleration / case.question.motion.peak


class PeakVelocity(_AmplitudeAxis):
    """Peak ground velocity: it scales the motion, or stretches it in time if another axis scales it."""

    name, unit, sets, stage, high = "pgv", "m/s", "the velocity of the motion", VELOCITY, 1e6
    words = "peak ground velocity, by scaling the motion, or by stretching its time where the other axis scales it"

    def check_beside(self, other: Axis) -> None:
        if isinstance(other, Scale):
            _refuse_zero(other.values)

    def applied(self, case: Case, values: FloatArray) -> Case:
        now = peak_velocity(case.question.motion)
        if case.amplitude_is_set:
            _refuse_zero(case.scale)
            return replace(case, stretch=values / (np.abs(case.scale) * now))
        return super().applied(case, values / (now * case.stretch))


def _refuse_zero(scales: FloatArray) -> None:
    if not np.all(scales):
        raise InvalidValueError(
            "pgv cannot be set where the scale is 0: a motion scaled to nothing has no velocity; leave 0 out"
        )


_ALL: tuple[type[Axis], ...] = (
    FrequencyRatio, AmplitudeRatio, Scale, PeakAcceleration, PeakVelocity, Period, Duration,
    SemiDiagonal, SlendernessRatio, SlendernessAngle, Width, Height, RestitutionAxis,
)  # fmt: skip


def axes() -> dict[str, type[Axis]]:
    """Return every axis by name.

    Returns
    -------
    dict of str to type
        Name to class.

    Examples
    --------
    >>> sorted(axes())[:3]
    ['amplitude_ratio', 'duration', 'frequency_ratio']
    """
    return {kind.name: kind for kind in _ALL}


def axis_of(axis: Any) -> Axis:
    """Return an axis, or the one of a name and values.

    >>> axis_of(("pga", [1.0, 2.0])).unit
    'm/s2'
    """
    if isinstance(axis, Axis):
        return axis
    if not isinstance(axis, Sequence) or isinstance(axis, str) or len(axis) != 2 or not isinstance(axis[0], str):
        raise InvalidValueError(f'an axis is written as ("scale", values), got {axis!r:.60}')
    known = axes()
    name = checks.spelling(axis[0], known)
    if name not in known:
        there, near = ", ".join(sorted(known)), checks.nearest(name, known)
        raise InvalidValueError(f"no axis named {name!r}; there are {there}{near}")
    return known[name](axis[1])
