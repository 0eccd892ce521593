"""Axes of the motion: its time and its strength, also in terms of the body."""

from dataclasses import replace

import numpy as np

from rocking import plausibility
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.axis import AMPLITUDE, TIME, VELOCITY, Axis
from rocking.studies.case import Case
from rocking.studies.motion_measures import main_period, peak_velocity
from rocking.studies.question import Question


class _TimeAxis(Axis):
    """Something that stretches the motion in time."""

    sets, stage = "the time of the motion", TIME


class Period(_TimeAxis):
    """Period of a pulse."""

    name, unit, words = "period", "s", "period T_p of the pulse"

    def _fits(self, question: Question) -> None:
        """Refuse a motion without a period."""
        super()._fits(question)
        main_period(question.motion)

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the pulse stretched to the period."""
        return replace(case, stretch=values / main_period(case.question.motion))


class FrequencyRatio(Period):
    """Circular frequency of a pulse over the frequency parameter of the body."""

    name, unit, words = "frequency_ratio", "1", "omega_p / p, frequency of the pulse over that of the body"

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the pulse stretched to the frequency."""
        return super()._changed(case, 2.0 * np.pi / (values * case.frequency_parameter))


class Duration(_TimeAxis):
    """Duration of any motion, which is stretched in time to it."""

    name, unit, words = "duration", "s", "duration of the motion, stretched in time"

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the motion stretched to the duration."""
        return replace(case, stretch=values / case.question.motion.duration)


class _AmplitudeAxis(Axis):
    """Something that scales the motion."""

    sets, stage = "the amplitude of the motion", AMPLITUDE

    def _fits(self, question: Question) -> None:
        """Refuse a motion that is zero throughout."""
        if not question.motion.peak > 0.0:
            raise InvalidValueError(f"the amplitude of {question.motion.name!r} cannot be set: it is zero throughout")

    def _factors(self, case: Case, values: FloatArray) -> FloatArray:
        """Return the factors on the motion, which are the values themselves."""
        return values

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the motion scaled."""
        return replace(case, scale=self._factors(case, values), amplitude_is_set=True)


class Scale(_AmplitudeAxis):
    """Factor on the motion."""

    name, unit, words, low, high = "scale", "1", "factor on the motion", -1e6, 1e6

    def _fits(self, question: Question) -> None:
        """Doubt a motion that is stronger than any recorded."""
        super()._fits(question)
        plausibility.warn(plausibility.of_scaled([question.motion], self.values))


class PeakAcceleration(_AmplitudeAxis):
    """Peak ground acceleration."""

    name, unit, words, high = "pga", "m/s2", "peak ground acceleration", 1e6

    def _fits(self, question: Question) -> None:
        """Doubt a motion that is stronger than any recorded."""
        super()._fits(question)
        plausibility.warn(plausibility.of_acceleration(float(self.values.max())))

    def _factors(self, case: Case, values: FloatArray) -> FloatArray:
        """Return the PGA over that of the motion."""
        return values / case.question.motion.peak


class AmplitudeRatio(_AmplitudeAxis):
    """Peak ground acceleration over the one that lifts the body."""

    name, unit, high = "amplitude_ratio", "1", 1e6
    words = "a_p / (g tan alpha), or a_p / (g alpha) in the linear equations"

    def _factors(self, case: Case, values: FloatArray) -> FloatArray:
        """Return the PGA over that of the motion."""
        return values * case.uplift_acceleration / case.question.motion.peak


class PeakVelocity(_AmplitudeAxis):
    """Peak ground velocity: it scales the motion, or stretches it in time if another axis scales it."""

    name, unit, sets, stage, high = "pgv", "m/s", "the velocity of the motion", VELOCITY, 1e6
    words = "peak ground velocity, by scaling the motion, or by stretching its time where the other axis scales it"

    def check_beside(self, other: Axis) -> None:
        """Refuse a scale of zero, at which no stretching gives a velocity."""
        if isinstance(other, Scale):
            _refuse_zero(other.values)

    def _changed(self, case: Case, values: FloatArray) -> Case:
        """Return the case with the velocity of the ground: acceleration times time."""
        now = peak_velocity(case.question.motion)
        if case.amplitude_is_set:
            _refuse_zero(case.scale)
            return replace(case, stretch=values / (np.abs(case.scale) * now))
        return super()._changed(case, values / (now * case.stretch))


def _refuse_zero(scales: FloatArray) -> None:
    if not np.all(scales):
        raise InvalidValueError(
            "pgv cannot be set where the scale is 0: a motion scaled to nothing has no velocity; leave 0 out"
        )
