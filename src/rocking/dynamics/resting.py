"""At rest: when the ground next lifts a body, and when impacts that die out have brought it there."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.rocker import Rocker, RockingSide
from rocking.dynamics.taylor import first_fall, shifted, value

_LONGEST_WINDOW = 40.0
NOTHING = 1e-9
"""Speed over p alpha that is none: a body that the ground holds, and that is no faster, is at rest."""


@dataclass(frozen=True)
class Push:
    """Ground accelerations over gravity, as polynomials of the stretches.

    Parameters
    ----------
    step : float
        Duration of a stretch [s].
    horizontal : ndarray, shape (n, degree + 1)
        a_x / g [-].
    vertical : ndarray, shape (n, degree + 1)
        a_z / g [-].
    """

    step: float
    horizontal: FloatArray
    vertical: FloatArray

    def at_end(self, series: FloatArray) -> FloatArray:
        """Return the values at the ends of the stretches.

        Parameters
        ----------
        series : ndarray
            Either component.

        Returns
        -------
        ndarray, shape (n,)
            The values [-].
        """
        return np.asarray(series.sum(axis=1))


class Ground:
    """What holds a body down, stretch by stretch.

    Parameters
    ----------
    rocker : Rocker
        The body.
    push : Push
        The motion.
    linear : bool
        Slender-linear equations.
    """

    def __init__(self, rocker: Rocker, push: Push, *, linear: bool) -> None:
        self.push = push
        self.linear = linear
        self.moments = {side: self._holding(rocker.side(side), side) for side in (1, -1)}
        low = {side: m[:, 0] + np.minimum(m[:, 1:], 0.0).sum(axis=1) for side, m in self.moments.items()}
        self._candidates = np.flatnonzero((low[1] <= 0.0) | (low[-1] <= 0.0))

    def _holding(self, side: RockingSide, sign: int) -> FloatArray:
        alpha = side.slenderness_angle
        sine, cosine = (alpha, 1.0) if self.linear else (math.sin(alpha), math.cos(alpha))
        moment = self.push.vertical * sine + self.push.horizontal * (sign * cosine)
        moment[:, 0] += sine
        return moment

    def held(self, sign: int, stretch: int, tau: float) -> float:
        """Return the holding moment on a side, over m g R.

        Parameters
        ----------
        sign : int
            The side.
        stretch : int
            Number of the stretch.
        tau : float
            Time within it, from 0 to 1.

        Returns
        -------
        float
            Above zero where the body is held [-].
        """
        return value(self.moments[sign][stretch].tolist(), tau)

    def next_uplift(self, stretch: int, tau: float) -> tuple[int, float, int] | None:
        """Return when the body is next lifted.

        Parameters
        ----------
        stretch : int
            Number of the stretch in which it rests.
        tau : float
            Time within it, from 0 to 1.

        Returns
        -------
        stretch : int
            Number of the stretch.
        tau : float
            Time within it.
        side : int
            Side on which it then stands; None instead of all three if the ground never lifts it.
        """
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


@dataclass
class Window:
    """Least and largest holding moments over some time, and how fast they can change with the rotation."""

    low: dict[int, float]
    high: dict[int, float]
    steepness: float


def comes_to_rest(  # noqa: PLR0917 - the state, in the order of the engine
    rocker: Rocker, ground: Ground, sign: int, after: float, stretch: int, tau: float, rest_speed: float
) -> bool:
    """Return whether the impacts to come provably add up to rest before the body could rise again.

    Each flight is bounded by those under the least and the largest holding moment of the time that all of them take;
    the sum of the flights is a geometric series.

    Parameters
    ----------
    rocker : Rocker
        The body.
    ground : Ground
        What holds it.
    sign : int
        Side on which it has just landed.
    after : float
        Speed after the impact [rad/s].
    stretch : int
        Number of the stretch.
    tau : float
        Time within it.
    rest_speed : float
        Speed over p alpha above which the question is not asked; below `NOTHING` it always is [-].

    Returns
    -------
    bool
        True if it comes to rest.
    """
    side = rocker.side(sign)
    unit = side.frequency_parameter * side.slenderness_angle
    held = ground.held(sign, stretch, tau)
    if after <= NOTHING * unit and held > 0.0:
        return True
    other, across = rocker.side(-sign), ground.held(-sign, stretch, tau)
    if not (after <= rest_speed * unit and held > 0.0 and across > 0.0):
        return False
    # the flights under the moments of now, as a guess of the time they take
    here, there = side.frequency_parameter**2 * held, other.frequency_parameter**2 * across
    r_here, r_there = (k.coefficient * rocker.law.largest for k in (side, other))
    step = ground.push.step
    flights, steps = 2.0 * after * (there + r_there * here), here * there * (1.0 - r_here * r_there) * step
    if not flights < _LONGEST_WINDOW * steps:
        return False
    left, guess, (count, terms) = 1.0 - tau, 1.5 * flights / steps, ground.push.horizontal.shape
    stretches = min(int(guess - left) + 2, count - stretch) if terms == 2 and guess > left else 1
    window = _window(rocker, ground, stretch, tau, stretches)
    return window is not None and bool(_time_to_rest(rocker, sign, after, window) <= (left + (stretches - 1)) * step)


def _window(rocker: Rocker, ground: Ground, stretch: int, tau: float, stretches: int) -> Window | None:
    push, rows = ground.push, slice(stretch, stretch + stretches)
    if push.horizontal.shape[1] == 2:
        x = [value(push.horizontal[stretch].tolist(), tau), *push.at_end(push.horizontal[rows]).tolist()]
        z = [value(push.vertical[stretch].tolist(), tau), *push.at_end(push.vertical[rows]).tolist()]
    else:
        row = push.horizontal[stretch]
        x = [row[0] + np.minimum(row[1:], 0.0).sum(), row[0] + np.maximum(row[1:], 0.0).sum()]
        z = [0.0]
    low_weight, high_weight = 1.0 + min(z), 1.0 + max(z)
    low, high = {}, {}
    for sign in (1, -1):
        alpha = rocker.side(sign).slenderness_angle
        sine, cosine = (alpha, 1.0) if ground.linear else (math.sin(alpha), math.cos(alpha))
        low[sign] = low_weight * sine + min(sign * min(x), sign * max(x)) * cosine
        high[sign] = high_weight * sine + max(sign * min(x), sign * max(x)) * cosine
    if not (low[1] > 0.0 and low[-1] > 0.0):
        return None
    return Window(low, high, abs(high_weight) + max(abs(min(x)), abs(max(x))))


def _time_to_rest(rocker: Rocker, sign: int, after: float, window: Window) -> float:
    low, high = dict(window.low), dict(window.high)
    here, there = rocker.side(sign), rocker.side(-sign)
    r_here, r_there = (side.coefficient * rocker.law.largest for side in (here, there))
    speed = after
    for k in (sign, -sign):
        p2 = rocker.side(k).frequency_parameter ** 2
        change = speed * speed / (p2 * low[k]) * window.steepness
        if not change < 0.5 * low[k]:
            return math.inf
        low[k] -= change
        high[k] += change
        speed *= r_there * math.sqrt(high[k] / low[k])
    gain_here, gain_there = math.sqrt(high[sign] / low[sign]), math.sqrt(high[-sign] / low[-sign])
    ratio = r_here * r_there * gain_here * gain_there
    if not ratio < 1.0:
        return math.inf
    first = 1.0 / (here.frequency_parameter**2 * low[sign])
    second = r_there * gain_here / (there.frequency_parameter**2 * low[-sign])
    return 2.0 * after * (first + second) / (1.0 - ratio)
