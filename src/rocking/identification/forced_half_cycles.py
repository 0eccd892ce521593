"""Half cycles of a body that the ground shakes, many at once, each integrated from a state of its own.

All are mirrored, so that rotations are positive; the ground is given by its acceleration [m/s2].
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray, g
from rocking.dynamics.plane.equations import angular_acceleration, reactions
from rocking.motions.motion import GroundMotion

_LONGEST = 0.03  # step, as p times time
_FINER = 2  # steps in one of these where feet may slide


@dataclass(frozen=True, eq=False)
class Flights:
    """Rotations at equal steps, each from its beginning."""

    step: FloatArray  # k [s]
    rotation: FloatArray  # n, k [rad]
    velocity: FloatArray  # n, k [rad/s]
    demand: FloatArray  # n - 1, k: friction that holds the feet [-]

    @classmethod
    def of(
        cls,
        motion: GroundMotion,
        state: tuple[FloatArray, FloatArray, FloatArray],
        body: tuple[FloatArray, FloatArray, FloatArray],
        sign: FloatArray,
        length: FloatArray,
        friction: float | None = None,
    ) -> "Flights":
        """Follow them; state: when [s], rotation and angular velocity; body: alpha [rad], p [rad/s] and R [m]."""
        start, first, turning = state
        alpha, p, size = body
        count = max(4, int(np.ceil(float((length * p).max()) / _LONGEST))) * (1 if friction is None else _FINER)
        step = length / count
        times = start + step * np.arange(count + 1)[:, None]
        push = _within_steps(motion.acceleration, motion.time_step, times, step) * sign / g
        weight = np.ones_like(push[:, :, :1])
        if motion.vertical is not None:
            weight = 1.0 + _within_steps(motion.vertical, motion.time_step, times, step) / g
        feet = _Feet(alpha, p, size, friction)
        rotations, velocities = np.empty((count + 1, start.size)), np.empty((count + 1, start.size))
        rotations[0], velocities[0] = first, turning
        for n in range(count):
            rotations[n + 1], velocities[n + 1] = feet.stepped(rotations[n], velocities[n], step, push[n], weight[n])
        before, after = rotations[:-1], velocities[:-1]
        turning = angular_acceleration(before, 1.0, alpha, p, push[:, 0], weight[:, 0])
        along, across = feet.forces(before, after, turning, push[:, 0], weight[:, 0])
        return cls(step, rotations, velocities, np.abs(along) / np.maximum(across, 1e-9))

    def at(self, since: FloatArray, which: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return rotation and angular velocity at times since the beginnings of some of them."""
        step = self.step[which]
        n = np.clip((since / step).astype(np.int64), 0, len(self.rotation) - 2)
        x = since / step - n
        y0, y1 = self.rotation[n, which], self.rotation[n + 1, which]
        v0, v1 = step * self.velocity[n, which], step * self.velocity[n + 1, which]
        c2, c3 = 3.0 * (y1 - y0) - 2.0 * v0 - v1, 2.0 * (y0 - y1) + v0 + v1
        return y0 + x * (v0 + x * (c2 + x * c3)), (v0 + x * (2.0 * c2 + x * 3.0 * c3)) / step

    def ends(self) -> tuple[FloatArray, FloatArray]:
        """Return how long they last and the speed with which they end; NaN of one that goes on."""
        below = (self.rotation[1:] <= 0.0) & (self.velocity[1:] < 0.0)
        ended, which = below.any(axis=0), np.arange(self.step.size)
        n = np.where(ended, below.argmax(axis=0), 0)
        low, high = n * self.step, (n + 1) * self.step
        y0, y1 = self.rotation[n, which], self.rotation[n + 1, which]
        time = low + self.step * np.clip(y0 / np.where(y0 == y1, 1.0, y0 - y1), 0.0, 1.0)
        for _ in range(4):
            y, v = self.at(time, which)
            time = np.clip(time - y / np.where(v == 0.0, -1.0, v), low, high)
        speed = -self.at(time, which)[1]
        ended &= speed > 0.0
        return np.where(ended, time, np.nan), np.where(ended, speed, np.nan)


class _Feet:
    """Feet that slide where the ground would have to hold them with more than the friction; they begin at rest."""

    def __init__(self, alpha: FloatArray, p: FloatArray, size: FloatArray, friction: float | None) -> None:
        self.alpha, self.p, self.size, self.friction = alpha, p, size, friction
        self.inertia = size * (g / p**2 - size)  # about the centre of mass, over the mass
        self.speed = np.zeros_like(p)

    def stepped(
        self, y: FloatArray, v: FloatArray, step: FloatArray, push: FloatArray, weight: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return rotation and angular velocity a step later; push, weight: at its begin, middle and end."""

        def held(y: FloatArray, v: FloatArray, j: int) -> FloatArray:
            return angular_acceleration(y, 1.0, self.alpha, self.p, push[j], weight[j])

        if self.friction is None:
            return _stepped(y, v, step, held)
        along, across = self.forces(y, v, held(y, v, 0), push[0], weight[0])
        slides = (self.speed != 0.0) | (np.abs(along) > self.friction * across)
        direction = np.where(self.speed != 0.0, np.sign(self.speed), -np.sign(along))
        ratio = -self.friction * direction

        def turning(y: FloatArray, v: FloatArray, j: int) -> FloatArray:
            sine, cosine = np.sin(self.alpha - y), np.cos(self.alpha - y)
            lever = sine + ratio * cosine
            free = -self.size * lever * (g * weight[j] - self.size * cosine * v**2)
            return np.where(slides, free / (self.inertia + self.size**2 * sine * lever), held(y, v, j))  # Eq. 285

        along, across = self.forces(y, v, turning(y, v, 0), push[1], weight[1])
        changed = self.speed + step * (ratio * across - along)
        self.speed = np.where(slides & (changed * direction > 0.0), changed, 0.0)
        return _stepped(y, v, step, turning)

    def forces(
        self, y: FloatArray, v: FloatArray, turning: FloatArray, push: FloatArray, weight: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return forces of the ground over the mass, along and across it, on a foot that goes on as it does."""
        horizontal, vertical = reactions(y, v, turning, 1.0, self.alpha, self.size, g * push, g * weight)
        return horizontal, vertical


def _stepped(
    y: FloatArray, v: FloatArray, step: FloatArray, acceleration: Callable[[FloatArray, FloatArray, int], FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return both after a step of order 4; acceleration: of both, and 0, 1, 2 for begin, middle and end."""
    half = 0.5 * step
    a = acceleration(y, v, 0)
    v2 = v + half * a
    b = acceleration(y + half * v, v2, 1)
    v3 = v + half * b
    c = acceleration(y + half * v2, v3, 1)
    v4 = v + step * c
    d = acceleration(y + step * v3, v4, 2)
    return y + step / 6.0 * (v + 2.0 * (v2 + v3) + v4), v + step / 6.0 * (a + 2.0 * (b + c) + d)


def _within_steps(acceleration: FloatArray, time_step: float, times: FloatArray, step: FloatArray) -> FloatArray:
    """Return the acceleration at beginning, middle and end of steps: a straight line with its first two moments.

    Straight lines between samples have corners, which would take two orders from a method of order 4.
    """
    slope = np.diff(acceleration) / time_step
    gained = np.concatenate([[0.0], np.cumsum(0.5 * time_step * (acceleration[1:] + acceleration[:-1]))])
    within = time_step * gained[:-1] + time_step**2 * (acceleration[:-1] / 3.0 + acceleration[1:] / 6.0)
    moved, end = np.concatenate([[0.0], np.cumsum(within)]), time_step * slope.size
    inside = np.clip(times, 0.0, end)
    n = np.minimum((inside / time_step).astype(np.int64), slope.size - 1)
    x = inside - n * time_step
    velocity = gained[n] + x * (acceleration[n] + 0.5 * x * slope[n])
    displacement = moved[n] + x * (gained[n] + x * (0.5 * acceleration[n] + x * slope[n] / 6.0))
    displacement += np.maximum(times - end, 0.0) * gained[-1]
    mean = np.diff(velocity, axis=0) / step
    rise = 3.0 * (velocity[1:] + velocity[:-1] - 2.0 * np.diff(displacement, axis=0) / step) / step  # Eq. 282
    return np.stack([mean - rise, mean, mean + rise], axis=1)


_NOISES = 6.0  # least rotation over the noise
_FEWEST = 7  # samples
_STEEP = 0.6  # of the speed before: slower across zero it rested in between


@dataclass(frozen=True, eq=False)
class Excursions:
    """Where the rotation is beyond its noise."""

    first: IntArray  # sample
    last: IntArray
    sign: FloatArray  # 1 on the right foot, -1 on the left
    begin: FloatArray  # when the impact before it is [s], or its first sample
    end: FloatArray  # when the impact after it is [s], or its last sample
    joined: BoolArray  # to the one before, by an impact

    def kept(self, which: BoolArray) -> "Excursions":
        """Return some of them: what was joined to one that is not kept begins by itself."""
        joined = self.joined & np.concatenate([[False], which[:-1]])
        kept = {name: values[which] for name, values in vars(self).items()}
        return Excursions(**(kept | {"joined": joined[which]}))

    def parted(self, which: BoolArray, time: FloatArray) -> "Excursions":
        """Return them with some no longer joined to the one before."""
        begin, end = np.where(which, time[self.first], self.begin), self.end.copy()
        end[np.flatnonzero(which) - 1] = time[self.last[np.flatnonzero(which) - 1]]
        return replace(self, begin=begin, end=end, joined=self.joined & ~which)

    def alone(self) -> BoolArray:
        """Return which are joined to none."""
        return np.asarray(~(self.joined | np.append(self.joined[1:], False)))


def excursions_of(time: FloatArray, rotation: FloatArray, share: float) -> Excursions:
    """Return them of a rotation that is zero at rest; share: least rotation over the range."""
    noise = float(np.median(np.abs(np.diff(rotation, 2)))) / (0.6745 * np.sqrt(6.0))
    least = max(_NOISES * noise, share * float(np.ptp(rotation)))
    side = np.where(np.abs(rotation) > least, np.sign(rotation), 0.0)
    cuts = np.flatnonzero(np.diff(side) != 0.0) + 1
    first, last = np.concatenate([[0], cuts]), np.concatenate([cuts, [side.size]]) - 1
    long = (side[first] != 0.0) & (last - first + 1 >= _FEWEST)
    first, last = first[long], last[long]
    begin, end, joined = time[first].copy(), time[last].copy(), np.zeros(first.size, dtype=np.bool_)
    for n in range(1, first.size):
        a, b = last[n - 1], first[n]
        if side[a] * side[b] > 0.0 or np.any(side[a + 1 : b] != 0.0):
            continue
        slope = (rotation[b] - rotation[a]) / (time[b] - time[a])
        near = slice(max(a - max(3, b - a), int(first[n - 1])), a + 1)
        before = np.polyfit(time[near] - time[a], rotation[near], 1)[0]
        if slope * before > 0.0 and abs(slope) > _STEEP * abs(before):
            joined[n] = True
            begin[n] = end[n - 1] = time[a] - rotation[a] / slope
    return Excursions(first, last, side[first], begin, end, joined)
