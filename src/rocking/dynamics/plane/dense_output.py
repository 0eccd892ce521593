"""A response between samples and events: states at both ends of every interval, and smooth curves between the ends.

Additional states divide long steps, and the step with overturning.
"""

import math
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane import equations
from rocking.dynamics.plane.equations import EventKind, Trajectory
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.taylor import series, shifted, slope, value
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.outcome import Outcome
from rocking.portable import applied, gauss_legendre, powers, times

# Gauss-Legendre points and weights on [0, 1], exact for polynomials up to degree 9
_POINTS, _WEIGHTS = gauss_legendre(5)
_POINTS, _WEIGHTS = 0.5 * (_POINTS + 1.0), 0.5 * _WEIGHTS


@dataclass(frozen=True)
class DenseOutput:
    """Intervals between samples, events and additional states, in order of time."""

    start: FloatArray  # start, end: times [s]; shape (n,)
    end: FloatArray
    side: FloatArray  # +1 or -1; 0 if the body rests; shape (n,)
    # rotation, velocity, acceleration: theta [rad], theta' [rad/s] and theta'' [rad/s2] at the start and at the end of
    # each interval, as limits from inside the interval; shape (n, 2)
    rotation: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    push: FloatArray  # push, lift: a_x and a_z at both ends of each interval [m/s2]; shape (n, 2)
    lift: FloatArray
    # alpha, p, semi_diagonal: values of the side in contact; at rest, values of the right side; shape (n,)
    alpha: FloatArray
    p: FloatArray
    semi_diagonal: FloatArray
    _segments: Segments
    _scale: float

    @classmethod
    def of(
        cls,
        trajectory: Trajectory,
        segments: Segments,
        parameters: RockingParameters,
        settings: PlaneSettings,
        scale: float,
    ) -> "DenseOutput":
        time, before, after = _nodes(trajectory, segments.step)
        added = _inner_states(trajectory, segments, parameters, settings, scale, time, before, after)
        if added:
            rows = np.array(added)
            time = np.concatenate([time, rows[:, 0]])
            order = np.argsort(time, kind="stable")
            time = time[order]
            before, after = (np.concatenate([limits, rows[:, 1:]])[order] for limits in (before, after))
        index = np.flatnonzero(np.diff(time) > 0.0)
        if not index.size:
            raise InvalidValueError(
                "there is no response at any time above 0 s: {status}", status=trajectory.status.value
            )
        start, end = time[index], time[index + 1]
        states = np.stack([after[index], before[index + 1]], axis=1)
        rotation, velocity = states[..., 0], states[..., 1]
        size = rotation[:, 0] + rotation[:, 1]
        side = np.sign(np.where(size != 0.0, size, velocity[:, 0] - velocity[:, 1]))
        right = side >= 0.0
        alpha, p, radius = (
            np.where(right, getattr(parameters.right, name), getattr(parameters.left, name))
            for name in ("slenderness_angle", "frequency_parameter", "semi_diagonal")
        )
        stretch = np.clip(((0.5 * (start + end)) / segments.step).astype(np.int64), 0, segments.count - 1)
        tau = np.stack([start, end], axis=1) / segments.step - stretch[:, None]
        push = scale * _evaluated(segments.horizontal, stretch, tau)
        lift = np.zeros_like(push) if segments.vertical is None else scale * _evaluated(segments.vertical, stretch, tau)
        g = settings.gravity
        acceleration = equations.angular_acceleration(
            rotation, side[:, None], alpha[:, None], p[:, None], push / g, 1.0 + lift / g, linear=settings.linear
        )
        acceleration = np.where(side[:, None] != 0.0, acceleration, 0.0)
        return cls(start, end, side, rotation, velocity, acceleration, push, lift, alpha, p, radius, segments, scale)

    @property
    def length(self) -> FloatArray:
        return self.end - self.start

    def indices(self, time: FloatArray) -> IntArray:
        """Return for every time [s] the index of the last interval that ends before or at this time, or zero."""
        return np.maximum(np.searchsorted(self.end, time * (1.0 + 1e-14), side="right") - 1, 0)

    def evaluated(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return theta [rad] and theta' [rad/s] of the quintics at positions x of every interval (shape (n, m))."""
        c = self.quintics()
        by_power = powers(x, 6).T
        slopes = np.arange(1, 6)[:, None] * by_power[:5]
        return times(c, by_power), times(c[:, 1:], slopes) / self.length[:, None]

    def quintics(self) -> FloatArray:
        """Return the quintics over 0 <= x <= 1 [rad]. They match value, rate and acceleration at both ends."""
        h = self.length
        a, b = self.rotation[:, 0], self.rotation[:, 1]
        va, vb = self.velocity[:, 0] * h, self.velocity[:, 1] * h
        ja, jb = 0.5 * self.acceleration[:, 0] * h * h, 0.5 * self.acceleration[:, 1] * h * h
        gap, rate, bend = b - a - va - ja, vb - va - 2.0 * ja, jb - ja
        return np.stack(
            [
                a,
                va,
                ja,
                10.0 * gap - 4.0 * rate + bend,  # Eq. 57
                -15.0 * gap + 7.0 * rate - 2.0 * bend,
                6.0 * gap - 3.0 * rate + bend,
            ],
            axis=1,
        )

    def work(self, settings: PlaneSettings) -> FloatArray:
        """Return the work of the ground per unit mass in every interval [J/kg]."""
        # the inertia forces -m a_x and -m a_z act in the frame of the ground; slender-linear equations are analogous
        rotation, velocity = self.evaluated(_POINTS)
        middle = 0.5 * (self.start + self.end) / self._segments.step
        stretch = np.clip(middle.astype(np.int64), 0, self._segments.count - 1)
        tau = (self.start[:, None] + _POINTS * self.length[:, None]) / self._segments.step - stretch[:, None]
        to_top = self.alpha[:, None] - self.side[:, None] * rotation
        sine, cosine = (to_top, np.ones_like(to_top)) if settings.linear else (np.sin(to_top), np.cos(to_top))
        force = -self._scale * _evaluated(self._segments.horizontal, stretch, tau) * cosine
        if self._segments.vertical is not None:
            lift = self._scale * _evaluated(self._segments.vertical, stretch, tau)
            force = force - lift * sine * self.side[:, None]
        power = self.semi_diagonal[:, None] * force * velocity  # Eq. 46
        return np.where(self.side != 0.0, applied(power, _WEIGHTS) * self.length, 0.0)


def _nodes(trajectory: Trajectory, step: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return times, and the states (rotation, velocity) just before and just after every sample and event."""
    finite = np.isfinite(trajectory.rotation)
    samples = np.stack([trajectory.rotation[finite], trajectory.angular_velocity[finite]], axis=1)
    # events other than impacts have zero velocity before and after
    events = [e for e in trajectory.events if e.time > 0.0 or e.kind is EventKind.IMPACT]
    times = np.concatenate([np.flatnonzero(finite) * step, [e.time for e in events]])
    before, after = (np.array([[0.0, getattr(e, name)] for e in events]).reshape(-1, 2) for name in ("before", "after"))
    # order at one instant: impacts, then rest or uplift, then the sample
    rank = np.concatenate([np.full(len(samples), 2), [int(e.kind is not EventKind.IMPACT) for e in events]])
    order = np.lexsort((rank, times))
    return times[order], np.concatenate([samples, before])[order], np.concatenate([samples, after])[order]


def _evaluated(polynomials: FloatArray, stretch: IntArray, tau: FloatArray) -> FloatArray:
    c = polynomials[stretch]
    total = np.zeros_like(tau)
    for k in range(c.shape[1] - 1, -1, -1):
        total = total * tau + c[:, k, None]
    return total


LONG = 0.1
"""An interval is long if p times its length exceeds this value [-].

Curves of shorter intervals are accurate to 1e-11.
"""

_ORDER = 16
# bound on the sixth-power term within a piece, divided by the slenderness angle
_TOLERANCE = 1e-11
_MAX_PIECES = 100_000
_ROUNDING = 1e-12


def _inner_states(  # noqa: PLR0917 - a history and its inputs
    trajectory: Trajectory,
    segments: Segments,
    parameters: RockingParameters,
    settings: PlaneSettings,
    scale: float,
    time: FloatArray,
    before: FloatArray,
    after: FloatArray,
) -> list[tuple[float, float, float]]:
    """Return additional states: times [s], theta [rad] and theta' [rad/s]."""
    # time: times of samples and events, in order [s]; before, after: theta [rad] and theta' [rad/s] just before and
    # just after these times
    # States are added in long intervals, at the overturning time, and after the last sample until the body has fallen.
    fall, step, g = trajectory.overturning_time, segments.step, settings.gravity
    shortest = _ROUNDING * step

    def coefficients(motion: FloatArray, stretch: int, at: float, width: float) -> list[float]:
        return shifted((scale / g * motion[stretch]).tolist(), at, width)

    def terms_of(time: float, left: float, side: int, u: float, rate: float) -> list[float]:
        """Return the Taylor series of the motion over the remainder of a segment."""
        stretch = min(int((time + 0.5 * left) / step), segments.count - 1)
        at, width = time / step - stretch, left / step
        push = [side * c for c in coefficients(segments.horizontal, stretch, at, width)]
        weight = [0.0] if segments.vertical is None else coefficients(segments.vertical, stretch, at, width)
        weight[0] += 1.0
        kappa = (parameters.side(side).frequency_parameter * left) ** 2
        return series(u, rate * left, kappa, push, weight, _ORDER, linear=settings.linear)

    def states(
        start: tuple[float, float, float], side: int, until: float, *, to_the_ground: bool
    ) -> list[tuple[float, float, float]]:
        """Return states at spacings short enough for quintics, not beyond the end of the segment."""
        alpha = parameters.side(side).slenderness_angle
        time, rotation, velocity = start
        u, rate = alpha - side * rotation, -side * velocity
        inner_states: list[tuple[float, float, float]] = []
        while until - time > shortest and len(inner_states) < _MAX_PIECES:
            remaining = (fall if time < fall - shortest and fall < until else until) - time
            terms = terms_of(time, remaining, side, u, rate)
            fraction = _quintic_fraction(terms, alpha)
            time += fraction * remaining
            u, rate = value(terms, fraction), slope(terms, fraction) / remaining
            inner_states.append((time, side * (alpha - u), -side * rate))
            if to_the_ground and alpha - u >= 0.5 * math.pi and not time < fall - shortest:
                break
        return inner_states

    turned = after[:-1, 0] + before[1:, 0]
    turned = np.where(turned != 0.0, turned, after[:-1, 1] - before[1:, 1])  # zero from one impact to the next
    quickest = max(parameters.right.frequency_parameter, parameters.left.frequency_parameter)
    falls = (time[:-1] < fall - shortest) & (time[1:] > fall + shortest)
    added: list[tuple[float, float, float]] = []
    for i in np.flatnonzero((turned != 0.0) & (falls | (quickest * np.diff(time) > LONG))).tolist():
        start, side = (float(time[i]), *after[i].tolist()), 1 if turned[i] > 0.0 else -1
        inner = states(start, side, float(time[i + 1]), to_the_ground=False)
        added += [state for state in inner if state[0] < time[i + 1] - shortest]
    if trajectory.outcome is Outcome.OVERTURNED and not np.isfinite(trajectory.rotation[-1]):
        until = (math.floor(float(time[-1]) / step + 1e-9) + 1.0) * step
        added += states((float(time[-1]), *after[-1].tolist()), trajectory.side, until, to_the_ground=True)
    return added


def _quintic_fraction(terms: list[float], alpha: float) -> float:
    """Return the fraction of the step over which the terms above the fifth power are small."""
    fraction = 1.0
    for k in range(6, len(terms)):
        if abs(terms[k]) * fraction**k > _TOLERANCE * alpha:
            fraction = (_TOLERANCE * alpha / abs(terms[k])) ** (1.0 / k)
    return fraction
