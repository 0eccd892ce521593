"""Restoring moments of a body over the segments of a motion: times of uplift, and decay of impacts to rest."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.taylor import first_fall, shifted, value

NO_MORE: Mapping[int, float] = MappingProxyType({1: 0.0, -1: 0.0})


@dataclass(frozen=True)
class Push:
    """Ground acceleration / gravity, as polynomials of the segments."""

    step: float  # duration of a segment [s]
    horizontal: FloatArray  # a_x / g [-]; shape (n, degree + 1)
    vertical: FloatArray  # a_z / g [-]; shape (n, degree + 1)


class RestoringMoments:
    """Restoring moments of a body over segments.

    `more` contains constant moments of restraints by side / (m g R) [-].
    """

    def __init__(
        self, parameters: RockingParameters, push: Push, *, linear: bool, more: Mapping[int, float] = NO_MORE
    ) -> None:
        self.push = push
        self.linear = linear
        self.more = more
        alphas = {sign: parameters.side(sign).slenderness_angle for sign in (1, -1)}
        self._sines = {sign: alpha if linear else math.sin(alpha) for sign, alpha in alphas.items()}
        self._cosines = {sign: 1.0 if linear else math.cos(alpha) for sign, alpha in alphas.items()}
        self.moments = {}
        for sign, sine in self._sines.items():
            moment = push.vertical * sine + push.horizontal * (sign * self._cosines[sign])  # Eq. 24
            moment[:, 0] += sine + more[sign]
            self.moments[sign] = moment
        lower_bounds = {sign: m[:, 0] + np.minimum(m[:, 1:], 0.0).sum(axis=1) for sign, m in self.moments.items()}
        self._candidates = np.flatnonzero((lower_bounds[1] <= 0.0) | (lower_bounds[-1] <= 0.0))
        self._stops = np.append(
            np.flatnonzero(_jumps(push.horizontal) | _jumps(push.vertical)) + 1, len(push.horizontal)
        )

    def held(self, sign: int, stretch: int, tau: float) -> float:
        """Return the restoring moment on a side / (m g R) [-]; positive as long as there is no uplift."""
        return value(self.moments[sign][stretch].tolist(), tau)

    def next_uplift(self, stretch: int, tau: float) -> tuple[int, float, int] | None:
        """Return the next uplift: segment, time within the segment, and side; None without uplift."""
        for k in self._candidates[np.searchsorted(self._candidates, stretch) :].tolist():
            start = tau if k == stretch else 0.0
            right, left = self._release(1, k, start), self._release(-1, k, start)
            if right < left:
                return k, right, 1
            if left < right:
                return k, left, -1
            if right <= 1.0:  # both sides lift at once if the downward acceleration of the ground exceeds g
                pushed = value(self.push.horizontal[k].tolist(), right)
                if pushed:
                    return k, right, -1 if pushed > 0.0 else 1
        return None

    def until_jump(self, stretch: int) -> int:
        """Return the number of segments up to the end of the motion, or up to a jump of the record to rest."""
        return int(self._stops[np.searchsorted(self._stops, stretch, side="right")]) - stretch

    def window(self, stretch: int, tau: float, stretches: int) -> tuple[dict[int, float], float, float] | None:
        """Return bounds of the restoring moments from an instant to the end of the last segment; None if uplift."""
        # smallest restoring moment on each side [-], bound on the total variation of the logarithm of the moments [-],
        # and bound on the change of the moments with the rotation [1/rad]
        rows = slice(stretch, stretch + stretches)
        x_min, x_max, x_variation = _extent(self.push.horizontal[rows], tau)
        z_min, z_max, z_variation = _extent(self.push.vertical[rows], tau)
        min_moments = {
            sign: (1.0 + z_min) * self._sines[sign]
            + min(sign * x_min, sign * x_max) * self._cosines[sign]
            + self.more[sign]
            for sign in (1, -1)
        }
        if not (min_moments[1] > 0.0 and min_moments[-1] > 0.0):
            return None
        variation = x_variation * max(self._cosines[k] / min_moments[k] for k in min_moments)  # Eq. 38
        variation += z_variation * max(self._sines[k] / min_moments[k] for k in min_moments)
        steepness = max(abs(1.0 + z_min), abs(1.0 + z_max)) + max(abs(x_min), abs(x_max))  # Eq. 39
        return min_moments, variation, steepness

    def _release(self, sign: int, stretch: int, start: float) -> float:
        moment = self.moments[sign][stretch].tolist()
        if value(moment, start) < 0.0:
            return start
        tail = shifted(moment, start, 1.0 - start)
        if len(tail) == 2:
            if not tail[0] + tail[1] < 0.0:
                return 2.0
            return start + (1.0 - start) * min(max(-tail[0] / tail[1], 0.0), 1.0)
        tail[0] = max(tail[0], 5e-324)
        fall = first_fall(tail)
        return 2.0 if fall is None else start + fall * (1.0 - start)


def _extent(rows: FloatArray, tau: float) -> tuple[float, float, float]:
    """Return minimum, maximum and variation of a motion over segments, from tau in the first. Exact for lines."""
    if rows.shape[1] == 2:
        values = np.concatenate([[value(rows[0].tolist(), tau)], rows.sum(axis=1)])
        return (float(values.min()), float(values.max()), float(np.abs(np.diff(values)).sum()))
    lower = rows[:, 0] + np.minimum(rows[:, 1:], 0.0).sum(axis=1)
    upper = rows[:, 0] + np.maximum(rows[:, 1:], 0.0).sum(axis=1)
    jumps = np.abs(rows[1:, 0] - rows[:-1].sum(axis=1)).sum()
    return (float(lower.min()), float(upper.max()), float(np.abs(rows[:, 1:]).sum() + jumps))


def _jumps(lines: FloatArray) -> np.ndarray:
    """Return True for every jump of a record between two segments. In smooth motions, jumps count as variation."""
    if lines.shape[1] > 2:
        return np.zeros(len(lines) - 1, dtype=bool)
    gap = np.abs(lines[:-1].sum(axis=1) - lines[1:, 0])
    return np.asarray(gap > 1e-14 * np.abs(lines[:, 0]).max(initial=0.0))


_LONGEST_WINDOW = 40.0
_HEIGHTS = 0.1  # bound on the part of the logarithm of the gain that is due to the rocking amplitudes
NOTHING = 1e-9  # lower values of speed / (p alpha) count as rest


def comes_to_rest(  # noqa: PLR0917 - the state in the order of the engine
    parameters: RockingParameters,
    ground: RestoringMoments,
    sign: int,
    after: float,
    stretch: int,
    tau: float,
    rest_speed: float,
) -> bool:
    """Return True if it is proven that the next impacts decay to rest before the body can rise again."""
    # The half cycles do not overlap in time, so that the total variation of the moments bounds the gain of speed.
    # The sum of the durations is a geometric series. The proof is in docs/theory/rest.md.
    # after: speed after the impact [rad/s]
    # rest_speed: largest speed / (p alpha) for which rest is checked [-]; always checked below `NOTHING`
    side = parameters.side(sign)
    unit = side.frequency_parameter * side.slenderness_angle
    held = ground.held(sign, stretch, tau)
    if after <= NOTHING * unit and held > 0.0:
        return True
    other, across = parameters.side(-sign), ground.held(-sign, stretch, tau)
    if not (after <= rest_speed * unit and held > 0.0 and across > 0.0):
        return False
    # times in units of segments; the half cycles under the present moments give an estimate of the time to rest
    step = ground.push.step
    p2, p2_other = ((k.frequency_parameter * step) ** 2 for k in (side, other))
    r, q = parameters.largest(sign), parameters.largest(-sign)
    speed, lost = after * step, 1.0 - r * q
    flights, rate = 2.0 * speed * (p2_other * across + q * p2 * held), p2 * held * (p2_other * across) * lost  # Eq. 37
    if not flights < _LONGEST_WINDOW * rate:
        return False
    remaining, guess = 1.0 - tau, 1.5 * (flights / rate)
    stretches = min(int(guess - remaining) + 2, ground.until_jump(stretch)) if guess > remaining else 1
    window = ground.window(stretch, tau, stretches)
    if window is None:
        return False
    lows, variation, steepness = window
    low, low_ = lows[sign], lows[-sign]
    x = 0.5 * (variation + _HEIGHTS)
    gain = 1.0 + x + x * x  # upper bound of exp(x) up to x = 1
    heights = steepness * (speed * gain) ** 2 / min(p2 * low * low, p2_other * low_ * low_)  # Eq. 40
    is_small = 2.2 * heights * (1.0 + q * q) <= _HEIGHTS * (1.0 - (r * q) ** 2) and heights <= 0.3
    if not (x <= 1.0 and is_small):
        return False
    total = 2.0 * speed * gain * (1.0 / (p2 * low) + q / (p2_other * low_)) / (lost * (1.0 - heights))  # Eq. 16
    return bool(total <= remaining + (stretches - 1))
