"""What is known before a measurement: the body within its errors, the floor, how impacts may differ."""

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot, IntArray
from rocking.errors import InvalidValueError
from rocking.identification import state_space
from rocking.identification.state_space import SHARED, Model

LEVEL: Final = math.radians(0.3)
"""Standard deviation of the tilt of a floor that nobody levelled [rad]."""

UNKNOWN_FREQUENCIES: Final = (1.3, 2.0, 3.1, 4.8, 7.4, 11.5)
"""Frequency parameters with which a body of which nothing is known is tried [rad/s]."""

_UNKNOWN = (0.25, 0.22, 0.5)  # deviation of ln p about one of these; slenderness angle, deviation of its logarithm


@dataclass(frozen=True)
class Knowledge:
    """What is known; deviations are standard deviations, zero where something is certain."""

    body: Body | None
    size_error: float  # of a length of the body, relative
    tilt: float  # [rad]
    tilt_error: float
    asymmetry: float  # deviation of ln r landing right less ln r landing left
    trend: bool
    damping: bool
    first: Foot  # on which the body stands after the first impact

    @classmethod
    def of(
        cls, body: Any, size_error: Any, tilt: Any, asymmetry: Any, *, trend: bool, damping: bool, first: Any
    ) -> "Knowledge":
        """Return what was said, checked."""
        if body is not None and not isinstance(body, Body):
            raise InvalidValueError(
                f"body must be a Block, Section or MassPoints, got {body!r:.60}; in_plane() of a solid"
            )
        angle, error = (0.0, tilt) if np.ndim(tilt) == 0 else tilt
        return cls(
            body,
            checks.within("size_error", size_error, 0.0, 0.2),
            checks.within("tilt", angle, -0.1, 0.1, unit="rad"),
            checks.within("standard deviation of tilt", error, 0.0, 0.1, unit="rad"),
            checks.within("asymmetry", asymmetry, 0.0, 1.0),
            trend,
            damping,
            checks.foot("first", first),
        )

    @property
    def frequencies(self) -> tuple[tuple[float, float], ...]:
        """Means and standard deviations of ln p from which to begin."""
        if self.body is None:
            return tuple((math.log(p), _UNKNOWN[0]) for p in UNKNOWN_FREQUENCIES)
        p = [self.body.side(foot).frequency_parameter for foot in ("right", "left")]
        return ((0.5 * math.log(p[0] * p[1]), 0.5 * self.size_error),)

    @property
    def slenderness_angles(self) -> tuple[float, float]:
        """Over the right and the left foot [rad]."""
        if self.body is None:
            return _UNKNOWN[1], _UNKNOWN[1]
        return self.body.side("right").slenderness_angle, self.body.side("left").slenderness_angle

    @property
    def alternation(self) -> float:
        """How much ln y may differ from impact to impact because the sides do, as a standard deviation."""
        right, left = self.slenderness_angles
        floor = math.hypot(self.tilt, self.tilt_error) / min(right, left)
        return max(math.hypot(0.5 * self.asymmetry, floor, math.log(right / left)), 0.01)

    def sides(self, count: int) -> IntArray:
        """Return on which side the body stands in each half cycle: 0 right, 1 left."""
        return (np.arange(count) + (self.first == "left")) % 2

    def model(self, sides: IntArray, start: float, speeds: FloatArray, frequency: tuple[float, float]) -> Model:
        """Return the model of a path; start, speeds: about when it begins, and ln of its speeds; frequency: of ln p."""
        mean, deviation = np.zeros(len(SHARED)), np.zeros(len(SHARED))
        p = np.array([math.exp(frequency[0])] * 2)
        slender = math.sqrt(2.0) * self.size_error
        if self.body is None:
            slender = _UNKNOWN[2]
            frequency = (frequency[0], 3.0 * _UNKNOWN[0])
        else:
            p = np.array([self.body.side(foot).frequency_parameter for foot in ("right", "left")])
        mean[state_space.START], deviation[state_space.START] = start, 1.0
        mean[state_space.SPEED], deviation[state_space.SPEED] = speeds[0], 2.0
        mean[state_space.MEAN], deviation[state_space.MEAN] = -0.1, 0.2
        deviation[state_space.HALF] = 0.5 * self.asymmetry
        deviation[state_space.FREQUENCY] = frequency[1]
        mean[state_space.TILT], deviation[state_space.TILT] = self.tilt, self.tilt_error
        deviation[state_space.SLENDERNESS] = slender
        deviation[state_space.TREND] = 0.05 if self.trend else 0.0
        deviation[state_space.DAMPING] = 0.02 if self.damping else 0.0
        middle = float(speeds[:-1].mean())  # of the impacts: their mean is that of the coefficient with a trend too
        return Model(sides, self.slenderness_angles, (float(p[0]), float(p[1])), mean, deviation, middle)
