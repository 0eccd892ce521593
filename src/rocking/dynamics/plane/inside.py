"""States inside the steps of a response: where a body falls within a step, or the steps are long."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.trajectory import Trajectory
from rocking.dynamics.settings import Settings
from rocking.dynamics.taylor import series, shifted, slope, value
from rocking.motions.segments import Segments
from rocking.outcome import Outcome

LONG = 0.1
"""An interval is long if p times its length is above this [-]; below, the curve between its ends holds to 1e-11."""

_ORDER = 16
# what the first power beyond a quintic may add within a part, over the angle
_TOLERANCE = 1e-11
_MOST_PARTS = 100_000
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Known:
    """A state that is known, and where to go from there."""

    time: float  # when [s]
    side: int  # +1 or -1: the side on which the body stands from then on
    rotation: float  # rotation, velocity: theta [rad] and theta' [rad/s]
    velocity: float
    until: float  # where to end, at most at the end of the same stretch [s]


@dataclass(frozen=True)
class Inside:
    """What moves, and on what."""

    segments: Segments  # the motion [m/s2]
    parameters: RockingParameters  # the body
    settings: Settings  # gravity and equations
    scale: float  # factor on the motion [-]

    def added(
        self, trajectory: Trajectory, time: FloatArray, before: FloatArray, after: FloatArray
    ) -> list[tuple[float, float, float]]:
        """Return the states to be added to those at samples and events.

        time: times of samples and events, in order [s]; before, after: theta [rad] and theta' [rad/s] just before and
        just after each. Returns time [s], theta [rad], theta' [rad/s]: within long intervals; when the body passes over
        its foot for good; and after the last sample, until it lies.
        """
        fall, step = trajectory.overturning_time, self.segments.step
        length, turned = np.diff(time), after[:-1, 0] + before[1:, 0]
        turned = np.where(turned != 0.0, turned, after[:-1, 1] - before[1:, 1])  # from impact to impact
        quickest = max(self.parameters.right.frequency_parameter, self.parameters.left.frequency_parameter)
        falls = (time[:-1] < fall - _ROUNDING * step) & (time[1:] > fall + _ROUNDING * step)
        found: list[tuple[float, float, float]] = []
        for i in np.flatnonzero((turned != 0.0) & (falls | (quickest * length > LONG))).tolist():
            start = Known(
                float(time[i]), 1 if turned[i] > 0.0 else -1, float(after[i, 0]), float(after[i, 1]), float(time[i + 1])
            )
            states = self._states(start, fall, to_the_ground=False)
            found += [state for state in states if state[0] < time[i + 1] - _ROUNDING * step]
        if trajectory.outcome is Outcome.OVERTURNED and not np.isfinite(trajectory.rotation[-1]):
            last = float(time[-1])
            until = (math.floor(last / step + 1e-9) + 1.0) * step
            start = Known(last, trajectory.side, float(after[-1, 0]), float(after[-1, 1]), until)
            found += self._states(start, fall, to_the_ground=True)
        return found

    def _states(self, known: Known, fall: float, *, to_the_ground: bool) -> list[tuple[float, float, float]]:
        """Return states so near to each other that quintics join them."""
        alpha = self.parameters.side(known.side).slenderness_angle
        time, u, rate = known.time, alpha - known.side * known.rotation, -known.side * known.velocity
        found: list[tuple[float, float, float]] = []
        shortest = _ROUNDING * self.segments.step
        while known.until - time > shortest and len(found) < _MOST_PARTS:
            left = (fall if time < fall - shortest and fall < known.until else known.until) - time
            terms = self._series(time, left, known.side, u, rate)
            part = _part(terms, alpha)
            time += part * left
            u, rate = value(terms, part), slope(terms, part) / left
            found.append((time, known.side * (alpha - u), -known.side * rate))
            if to_the_ground and alpha - u >= 0.5 * math.pi and not time < fall - shortest:
                break
        return found

    def _series(self, time: float, left: float, side: int, u: float, rate: float) -> list[float]:
        segments, g = self.segments, self.settings.gravity
        stretch = min(int((time + 0.5 * left) / segments.step), segments.count - 1)
        at, width = time / segments.step - stretch, left / segments.step
        push = shifted((self.scale / g * segments.horizontal[stretch]).tolist(), at, width)
        weight = [0.0]
        if segments.vertical is not None:
            weight = shifted((self.scale / g * segments.vertical[stretch]).tolist(), at, width)
        weight[0] += 1.0
        kappa = (self.parameters.side(side).frequency_parameter * left) ** 2
        linear = self.settings.linear
        return series(u, rate * left, kappa, [side * c for c in push], weight, _ORDER, linear=linear)


def _part(terms: list[float], alpha: float) -> float:
    """Return the part over which what a quintic leaves out stays small."""
    part = 1.0
    for k in range(6, len(terms)):
        if abs(terms[k]) * part**k > _TOLERANCE * alpha:
            part = (_TOLERANCE * alpha / abs(terms[k])) ** (1.0 / k)
    return part
