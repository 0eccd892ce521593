"""What holds a body down, stretch by stretch: when it is lifted, and when impacts that die out bring it to rest."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.taylor import first_fall, shifted, value


@dataclass(frozen=True)
class Push:
    """Ground accelerations over gravity, as polynomials of the stretches."""

    step: float  # duration of a stretch [s]
    horizontal: FloatArray  # a_x / g [-]; shape (n, degree + 1)
    vertical: FloatArray  # a_z / g [-]; shape (n, degree + 1)


class RestoringMoments:
    """What holds a body down, stretch by stretch."""

    def __init__(self, parameters: RockingParameters, push: Push, *, linear: bool) -> None:
        self.push = push
        self.linear = linear
        alphas = {sign: parameters.side(sign).slenderness_angle for sign in (1, -1)}
        self._sines = {sign: alpha if linear else math.sin(alpha) for sign, alpha in alphas.items()}
        self._cosines = {sign: 1.0 if linear else math.cos(alpha) for sign, alpha in alphas.items()}
        self.moments = {}
        for sign, sine in self._sines.items():
            moment = push.vertical * sine + push.horizontal * (sign * self._cosines[sign])  # Eq. 24
            moment[:, 0] += sine
            self.moments[sign] = moment
        low = {side: m[:, 0] + np.minimum(m[:, 1:], 0.0).sum(axis=1) for side, m in self.moments.items()}
        self._candidates = np.flatnonzero((low[1] <= 0.0) | (low[-1] <= 0.0))
        self._stops = np.append(
            np.flatnonzero(_jumps(push.horizontal) | _jumps(push.vertical)) + 1, len(push.horizontal)
        )

    def held(self, sign: int, stretch: int, tau: float) -> float:
        """Return the holding moment on a side, over m g R; above zero where the body is held [-]."""
        return value(self.moments[sign][stretch].tolist(), tau)

    def next_uplift(self, stretch: int, tau: float) -> tuple[int, float, int] | None:
        """Return when the body is next lifted, and the side on which it then stands; None if it never is."""
        for k in self._candidates[np.searchsorted(self._candidates, stretch) :].tolist():
            start = tau if k == stretch else 0.0
            right, left = self._release(1, k, start), self._release(-1, k, start)
            if right < left:
                return k, right, 1
            if left < right:
                return k, left, -1
            if right <= 1.0:  # both at once: the ground falls faster than the body would
                pushed = value(self.push.horizontal[k].tolist(), right)
                if pushed:
                    return k, right, -1 if pushed > 0.0 else 1
        return None

    def until_jump(self, stretch: int) -> int:
        """Return how many stretches there are up to the end, or to where a record jumps to rest."""
        return int(self._stops[np.searchsorted(self._stops, stretch, side="right")]) - stretch

    def window(self, stretch: int, tau: float, stretches: int) -> tuple[dict[int, float], float, float] | None:
        """Return what holds the body down from an instant to the end of some stretches; None if a side is not held."""
        # least holding moment on each side [-], a bound on the total variation of the logarithm of the holding moments
        # [-], and one on their change with the rotation [1/rad]
        rows = slice(stretch, stretch + stretches)
        x_least, x_most, x_variation = _extent(self.push.horizontal[rows], tau)
        z_least, z_most, z_variation = _extent(self.push.vertical[rows], tau)
        low = {
            sign: (1.0 + z_least) * self._sines[sign] + min(sign * x_least, sign * x_most) * self._cosines[sign]
            for sign in (1, -1)
        }
        if not (low[1] > 0.0 and low[-1] > 0.0):
            return None
        variation = x_variation * max(self._cosines[k] / low[k] for k in low)  # Eq. 38
        variation += z_variation * max(self._sines[k] / low[k] for k in low)
        steepness = max(abs(1.0 + z_least), abs(1.0 + z_most)) + max(abs(x_least), abs(x_most))  # Eq. 39
        return low, variation, steepness

    def _release(self, sign: int, stretch: int, start: float) -> float:
        moment = self.moments[sign][stretch].tolist()
        if value(moment, start) < 0.0:
            return start
        rest = shifted(moment, start, 1.0 - start)
        if len(rest) == 2:
            if not rest[0] + rest[1] < 0.0:
                return 2.0
            return start + (1.0 - start) * min(max(-rest[0] / rest[1], 0.0), 1.0)
        rest[0] = max(rest[0], 5e-324)
        fall = first_fall(rest)
        return 2.0 if fall is None else start + fall * (1.0 - start)


def _extent(rows: FloatArray, tau: float) -> tuple[float, float, float]:
    """Least, most and variation of a motion over stretches, the first from tau on; exact for straight lines."""
    if rows.shape[1] == 2:
        values = np.concatenate([[value(rows[0].tolist(), tau)], rows.sum(axis=1)])
        return (float(values.min()), float(values.max()), float(np.abs(np.diff(values)).sum()))
    least = rows[:, 0] + np.minimum(rows[:, 1:], 0.0).sum(axis=1)
    most = rows[:, 0] + np.maximum(rows[:, 1:], 0.0).sum(axis=1)
    jumps = np.abs(rows[1:, 0] - rows[:-1].sum(axis=1)).sum()
    return (float(least.min()), float(most.max()), float(np.abs(rows[:, 1:]).sum() + jumps))


def _jumps(lines: FloatArray) -> np.ndarray:
    """Where records jump between two stretches; smooth motions count their jumps as variation."""
    if lines.shape[1] > 2:
        return np.zeros(len(lines) - 1, dtype=bool)
    gap = np.abs(lines[:-1].sum(axis=1) - lines[1:, 0])
    return np.asarray(gap > 1e-14 * np.abs(lines[:, 0]).max(initial=0.0))


_LONGEST_WINDOW = 40.0
_HEIGHTS = 0.1  # what the heights of flights to rest may add to the logarithm of their gain
NOTHING = 1e-9  # speed over p alpha that is none: a body that the ground holds, and that is no faster, is at rest


def comes_to_rest(  # noqa: PLR0917 - the state, in the order of the engine
    parameters: RockingParameters,
    ground: RestoringMoments,
    sign: int,
    after: float,
    stretch: int,
    tau: float,
    rest_speed: float,
) -> bool:
    """Return whether the impacts to come provably add up to rest before the body could rise again."""
    # Flights take disjoint times, so that the speed gained by moments that change is bounded by their total variation;
    # the sum of the flights is a geometric series. The proof is in docs/theory/rest.md. after: speed after the impact
    # [rad/s]; rest_speed: speed over p alpha above which the question is not asked; below `NOTHING` it always is [-].
    side = parameters.side(sign)
    unit = side.frequency_parameter * side.slenderness_angle
    held = ground.held(sign, stretch, tau)
    if after <= NOTHING * unit and held > 0.0:
        return True
    other, across = parameters.side(-sign), ground.held(-sign, stretch, tau)
    if not (after <= rest_speed * unit and held > 0.0 and across > 0.0):
        return False
    # all in units of stretches; the flights under the moments of now, as a guess of the time they take
    step = ground.push.step
    one, two = ((k.frequency_parameter * step) ** 2 for k in (side, other))
    r, q = parameters.largest(sign), parameters.largest(-sign)
    speed, lost = after * step, 1.0 - r * q
    flights, rate = 2.0 * speed * (two * across + q * one * held), one * held * (two * across) * lost  # Eq. 37
    if not flights < _LONGEST_WINDOW * rate:
        return False
    left, guess = 1.0 - tau, 1.5 * (flights / rate)
    stretches = min(int(guess - left) + 2, ground.until_jump(stretch)) if guess > left else 1
    window = ground.window(stretch, tau, stretches)
    if window is None:
        return False
    lows, variation, steepness = window
    low, low_ = lows[sign], lows[-sign]
    x = 0.5 * (variation + _HEIGHTS)
    gain = 1.0 + x + x * x  # more than exp(x) up to x = 1
    heights = steepness * (speed * gain) ** 2 / min(one * low * low, two * low_ * low_)  # Eq. 40
    small = 2.2 * heights * (1.0 + q * q) <= _HEIGHTS * (1.0 - (r * q) ** 2) and heights <= 0.3
    if not (x <= 1.0 and small):
        return False
    total = 2.0 * speed * gain * (1.0 / (one * low) + q / (two * low_)) / (lost * (1.0 - heights))  # Eq. 16
    return bool(total <= left + (stretches - 1))
