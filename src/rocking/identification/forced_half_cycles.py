"""Half cycles of a body under ground motion. Many half cycles are integrated together, each from its own state.

All half cycles are mirrored, so that rotations are positive; the ground acceleration is in m/s2.
"""

from dataclasses import dataclass, replace

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray, g
from rocking.dynamics.plane.equations import angular_acceleration, reactions
from rocking.dynamics.plane_frictional.batch import module
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.identification.measurement import white_noise
from rocking.motions.motion import GroundMotion

_LONGEST = 0.03  # largest time step x p [-]
Sliding = tuple[FloatArray, FloatArray, FloatArray]
"""Per half cycle: coefficient of friction, start velocity of the foot [m/s], and sine of the tilt of the floor.

Without sliding, a tilted floor only changes alpha. Friction acts along the floor.
"""


@dataclass(frozen=True, eq=False)
class Flights:
    """Rotations of half cycles at equal time steps, each half cycle from its own start."""

    step: FloatArray  # time step, shape (k,) [s]
    rotation: FloatArray  # rotation, shape (n, k) [rad]
    velocity: FloatArray  # angular velocity, shape (n, k) [rad/s]
    slip: FloatArray  # speed of the foot along the ground, shape (n, k) [m/s]
    engine_input: tuple[FloatArray, FloatArray, FloatArray]  # bodies; a_x and g + a_z at start and end of time steps

    @classmethod
    def integrated(
        cls,
        motion: GroundMotion,
        state: tuple[FloatArray, FloatArray, FloatArray],
        body: tuple[FloatArray, FloatArray, FloatArray],
        sign: FloatArray,
        length: FloatArray,
        sliding: Sliding | None = None,
    ) -> "Flights":
        """Return the half cycles of states (time [s], rotation, velocity) and bodies (alpha, p [rad/s], R [m])."""
        start, first, turning = state
        alpha, p, size = body
        count = max(4, int(np.ceil(float((length * p).max()) / _LONGEST)))
        step = length / count
        times = start + step * np.arange(count + 1)[:, None]
        push = _within_steps(motion.acceleration, motion.time_step, times, step) * sign / g
        weight = np.ones_like(push[:, :, :1])
        if motion.vertical is not None:
            weight = 1.0 + _within_steps(motion.vertical, motion.time_step, times, step) / g
        friction, slip, lean = sliding or (NEVER_SLIDES, np.zeros_like(p), np.zeros_like(p))
        bodies = np.stack(np.broadcast_arrays(alpha + np.arcsin(lean), p, size, friction, step))
        ends = (np.broadcast_to(g * acceleration, push.shape)[:, ::2] for acceleration in (push - lean, weight))
        push, weight = (np.ascontiguousarray(acceleration) for acceleration in ends)
        zeros = np.zeros((count + 1, start.size))
        return cls(step, zeros + first, zeros, zeros, (bodies, push, weight)).restarted(turning, slip)

    def restarted(self, turning: FloatArray, slip: FloatArray) -> "Flights":
        """Return the half cycles from other start velocities of bodies and feet."""
        states = np.zeros((3, *self.rotation.shape))
        states[:, 0] = self.rotation[0], turning, slip
        module().slide(*self.engine_input, states, g)
        return replace(self, rotation=states[0], velocity=states[1], slip=states[2])

    @property
    def demand(self) -> FloatArray:
        """Friction demand at the start of time steps [-], shape n - 1, k."""
        (alpha, p, size, _, _), push, weight = (
            self.engine_input[0],
            self.engine_input[1][:, 0],
            self.engine_input[2][:, 0],
        )
        turning = angular_acceleration(self.rotation[:-1], 1.0, alpha, p, push / g, weight / g)
        along, across = reactions(self.rotation[:-1], self.velocity[:-1], turning, 1.0, alpha, size, push, weight)
        return np.asarray(np.abs(along) / np.maximum(across, 1e-9))

    def at(self, since: FloatArray, which: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return rotation and angular velocity of some half cycles at times since their start."""
        step = self.step[which]
        n = np.clip((since / step).astype(np.int64), 0, len(self.rotation) - 2)
        x = since / step - n
        y0, y1 = self.rotation[n, which], self.rotation[n + 1, which]
        v0, v1 = step * self.velocity[n, which], step * self.velocity[n + 1, which]
        c2, c3 = 3.0 * (y1 - y0) - 2.0 * v0 - v1, 2.0 * (y0 - y1) + v0 + v1
        return y0 + x * (v0 + x * (c2 + x * c3)), (v0 + x * (2.0 * c2 + x * 3.0 * c3)) / step

    def ends(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return durations, and end velocities of bodies and feet; NaN without an impact."""
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
        slip = self.slip[n, which] + (time / self.step - n) * (self.slip[n + 1, which] - self.slip[n, which])
        return np.where(ended, time, np.nan), np.where(ended, speed, np.nan), np.where(ended, slip, 0.0)


def _within_steps(acceleration: FloatArray, time_step: float, times: FloatArray, step: FloatArray) -> FloatArray:
    """Return the acceleration at start, middle and end of time steps, on a line with equal first two moments.

    The record has corners at its samples. Without the line, a method of order 4 would have order 2.
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


def struck(
    before: FloatArray, after: FloatArray, slip: FloatArray, body: tuple[FloatArray, ...], friction: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the angular velocity after an impact, and the sliding velocity of the new foot [m/s].

    `before` is the angular velocity before the impact, and `after` that after an impact without sliding. `slip` is the
    velocity of the old foot [m/s]. `body` contains the levers of both feet, the height, and the moment of inertia
    about the centre of mass / mass [m, m2].
    """
    old, new, height, inertia = body
    ratio, width, foot_inertia = after / before, old + new, inertia + height**2
    stuck = after - height * slip * (old + ratio * new) / (foot_inertia * width)  # Eq. 74
    along = height * (before - stuck) - slip
    slides = np.abs(along) > friction * (old * before + new * stuck)
    pull = -friction * np.sign(along)
    turn = (pull * height + (1.0 - ratio) * foot_inertia / (old + ratio * new)) / inertia
    normal = width * before / (1.0 + new * turn)  # Eq. 75
    slid = before - turn * normal
    return np.where(slides, slid, stuck), np.where(slides, height * (before - slid) - slip + pull * normal, 0.0)


_NOISES = 6.0  # smallest rotation / noise
_FEWEST = 7  # smallest number of samples
_STEEP = 0.6  # smallest ratio of speeds after and before zero; the body rests if the ratio is smaller


@dataclass(frozen=True, eq=False)
class Excursions:
    """Intervals in which the rotation exceeds its noise."""

    first: IntArray  # index of the first sample
    last: IntArray
    sign: FloatArray  # 1 on the right foot, -1 on the left
    begin: FloatArray  # time of the impact before the interval, or of its first sample [s]
    end: FloatArray  # time of the impact after the interval, or of its last sample [s]
    joined: BoolArray  # True if an impact connects the interval to the previous interval

    def subset(self, which: BoolArray) -> "Excursions":
        """Return selected intervals; an interval without its predecessor begins with its own state."""
        joined = self.joined & np.concatenate([[False], which[:-1]])
        selected = {name: values[which] for name, values in vars(self).items()}
        return Excursions(**(selected | {"joined": joined[which]}))

    def separated(self, which: BoolArray, time: FloatArray) -> "Excursions":
        """Return the intervals; selected intervals lose the connection to their predecessor."""
        begin, end = np.where(which, time[self.first], self.begin), self.end.copy()
        end[np.flatnonzero(which) - 1] = time[self.last[np.flatnonzero(which) - 1]]
        return replace(self, begin=begin, end=end, joined=self.joined & ~which)

    def is_isolated(self) -> BoolArray:
        """Return True for intervals without a connection to another interval."""
        return np.asarray(~(self.joined | np.append(self.joined[1:], False)))


def excursions_of(time: FloatArray, rotation: FloatArray, fraction: float) -> Excursions:
    """Return the intervals in which a rotation exceeds its noise; `fraction` is the smallest rotation / range."""
    min_rotation = max(_NOISES * white_noise(rotation), fraction * float(np.ptp(rotation)))
    side = np.where(np.abs(rotation) > min_rotation, np.sign(rotation), 0.0)
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
