"""Restitution from rocking under a known ground motion: half cycles begin in measured states."""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, IntArray, g
from rocking.identification.forced_half_cycles import Excursions, Flights, struck
from rocking.identification.measurement import RotationSeries
from rocking.identification.posterior import Knowledge
from rocking.motions.motion import GroundMotion

SHARED = (MEAN, HALF, WIDTH, HEIGHT, TILT, TREND, CLOCK) = tuple(range(7))
"""Unknowns as in the state space, ln of width and of height / nominal value, and lead of the clock [s]."""
GAIN, OFFSET, DRIFT = 7, 9, 11  # indices for the rotation; the next index is for the angular velocity
FRICTION = 13  # index of ln of the coefficient of friction
SIZE = 14
KINDS = ("rotation", "angular_velocity")

SAME_TIME = 1e-4  # tolerance of the time between the end of a half cycle and the start of the next half cycle [s]
STEP = 1e-6
_DAMPED, _CLOSE = 1e-3, 5e-3  # largest damping, and largest change of the objective, at convergence
_LONGEST = 1.0  # largest change of an unknown per step
_SETTLED, _CHAIN = 1e-7, 20  # tolerance of start velocities; largest number of iterations
_MOST, _EDGE = 3000, 1  # largest number of compared samples; number of excluded samples at each end


@dataclass(frozen=True, eq=False)
class Terms:
    """Residuals of samples, of times of impacts, and of ln r relative to its mean, with their slopes."""

    # residuals and slopes per measured quantity; slopes by shared and own unknowns
    samples: list[tuple[FloatArray, FloatArray]]
    owners: IntArray  # half cycle of each sample; samples at rest come last
    times: tuple[FloatArray, FloatArray]
    draws: tuple[FloatArray, FloatArray]
    start_velocities: FloatArray | None = None  # start velocities of bodies and feet, if feet slide

    def value(self, noise: FloatArray, scatter: float, same: float | None) -> float:
        """Return the sum of squares divided by the variances, without impacts if `same` is None."""
        total = sum(float(r @ r) / float(s) ** 2 for (r, _), s in zip(self.samples, noise, strict=True))
        if same is not None:
            total += float(self.times[0] @ self.times[0]) / same**2 + float(self.draws[0] @ self.draws[0]) / scatter**2
        return total

    def normal(self, noise: FloatArray, scatter: float, same: float | None) -> tuple[FloatArray, FloatArray]:
        """Return half the second derivatives of `value` (Gauss-Newton), and minus half its first derivatives."""
        size = self.times[1].shape[1]
        hessian, gradient = np.zeros((size, size)), np.zeros(size)
        starts = np.searchsorted(self.owners, np.arange((size - SIZE) // 2 + 1))
        for (residual, slopes), s in zip(self.samples, noise, strict=True):
            for k, (a, b) in enumerate(pairwise([*starts, residual.size])):
                last = min(SIZE + 2 * k + 2, size)
                own = np.r_[:SIZE, SIZE + 2 * k : last, max(SIZE, SIZE + 2 * k - 2) : min(SIZE + 2 * k, last - 2)]
                by = slopes[a:b, : own.size]
                hessian[np.ix_(own, own)] += by.T @ by / s**2
                gradient[own] += by.T @ residual[a:b] / s**2
        for (residual, by), s in () if same is None else ((self.times, same), (self.draws, scatter)):
            hessian += by.T @ by / s**2
            gradient += by.T @ residual / s**2
        return hessian, gradient


@dataclass(frozen=True, eq=False)
class Forced:
    """A measured body under a ground motion, with its prior."""

    prior: Knowledge
    motion: GroundMotion
    series: RotationSeries
    excursions: Excursions
    rest_samples: IntArray  # indices of the samples at rest
    mean: FloatArray  # mean of the shared parameters
    deviation: FloatArray
    middle: float = 0.0  # ln of the reference speed of a trend
    slides: bool = False  # True if feet may slide
    excluded: int = 0  # number of excluded half cycles

    @cached_property
    def kinds(self) -> tuple[int, ...]:
        """Indices of the measured quantities."""
        return tuple(k for k, kind in enumerate(KINDS) if getattr(self.series, kind) is not None)

    @cached_property
    def samples(self) -> tuple[IntArray, IntArray]:
        """Indices of the compared samples, and index of the half cycle of each sample."""
        excursions, time = self.excursions, self.series.time
        first, last = excursions.first + _EDGE, excursions.last - _EDGE
        if self.series.angular_velocity is None:  # samples up to the impacts, so that the noise does not select samples
            near = 1.5 * float(np.median(np.diff(time)))
            first = np.where(excursions.joined, np.searchsorted(time, excursions.begin + near), first)
            last = np.where(
                np.append(excursions.joined[1:], False), np.searchsorted(time, excursions.end - near) - 1, last
            )
        pieces = [np.arange(a, b + 1) for a, b in zip(first, last, strict=True)]
        stride = max(1, math.ceil(sum(piece.size for piece in pieces) / _MOST))
        pieces = [piece[:: max(1, min(stride, (piece.size - 1) // 2))] for piece in pieces]  # none is empty
        return np.concatenate(pieces), np.repeat(np.arange(len(pieces)), [piece.size for piece in pieces])

    @cached_property
    def line(self) -> FloatArray:
        """Time, scaled to the range from -1 to 1."""
        time = self.series.time
        return np.asarray((time - 0.5 * (time[0] + time[-1])) / (0.5 * (time[-1] - time[0])))

    @cached_property
    def believed(self) -> list[tuple[float, float]]:
        """Half width, height of the centre of mass, p and R, for the right and for the left foot."""
        body = self.prior.body
        assert body is not None
        sides = body.side("right"), body.side("left")
        names = "half_width", "centre_height", "frequency_parameter", "semi_diagonal"
        return [(getattr(sides[0], name), getattr(sides[1], name)) for name in names]

    def sides(self, sign: Any, width: Any, height: Any, tilt: Any) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return slenderness angle [rad], p [rad/s] and R [m] for the right foot (sign 1) or the left foot."""
        across, up, p, size = (np.where(np.asarray(sign) > 0.0, *pair) for pair in self.believed)
        across, up = across * np.exp(width), up * np.exp(height)
        real = np.hypot(across, up)
        return np.arctan2(across, up) - sign * tilt, p * np.sqrt(size / real), real

    def levers(self, z: FloatArray) -> tuple[FloatArray, ...]:
        """Return the levers of the feet before and after the impact at the start, the height, and inertia / mass."""
        (alpha, p, size), (before, _, old) = (
            self.sides(sign, z[:, WIDTH], z[:, HEIGHT], 0.0) for sign in (self.excursions.sign, -self.excursions.sign)
        )
        height = size * np.cos(alpha)
        return old * np.sin(before), size * np.sin(alpha), height, size * (g / p**2 - size)

    def find_start_velocities(self, x: FloatArray, moved: FloatArray, about: FloatArray | None) -> FloatArray:
        """Return start velocities of bodies and feet of all half cycles, for all moved unknowns.

        The velocities follow from the end of the previous half cycle by iteration; `about` contains first values.
        """
        if about is None:
            about = np.stack([np.exp(np.minimum(x[SIZE + 1 :: 2], 5.0)), 0.0 * x[SIZE::2]])[:, None]
        common, velocities = ~moved[:, SIZE:].any(axis=1), about[:, :1]
        flights, _ = self.flights(x, moved[:1], velocities)
        for _ in range(_CHAIN):
            new = self.after(x, moved[:1], np.stack(flights.ends())[:, None])
            change, velocities = np.abs(new - velocities).max(), new
            if change < _SETTLED:
                break
            free = np.where(self.excursions.joined, new[0, 0], flights.velocity[0])
            flights = flights.restarted(free, new[1, 0])
        ends = self.ends(x, moved[common], np.broadcast_to(velocities, (2, int(common.sum()), velocities.shape[2])))
        return self.after(x, moved, ends[:, np.where(common, np.cumsum(common) - 1, 0)], moved[:, -1:])

    def ends(self, x: FloatArray, moved: FloatArray, start_velocities: FloatArray) -> FloatArray:
        """Return durations of half cycles, and end velocities of bodies and feet."""
        return np.stack(self.flights(x, moved, start_velocities)[0].ends()).reshape(3, len(moved), -1)

    def after(self, x: FloatArray, moved: FloatArray, ends: FloatArray, faster: Any = 0.0) -> FloatArray:
        """Return velocities of bodies and feet after impacts, zero without an impact."""
        joined, velocities = np.flatnonzero(self.excursions.joined), np.zeros((2, *ends.shape[1:]))
        _, speed, slip = ends[:, :, joined - 1]
        z = (np.concatenate([x[:SIZE], [0.0, 0.0]]) + moved)[:, :, None]
        body = tuple(lever[:, joined] for lever in self.levers(z))
        without = np.exp(np.minimum(x[SIZE + 1 :: 2][joined] + faster, 5.0))
        velocities[:, :, joined] = struck(speed, without, slip, body, np.exp(z[:, FRICTION]))
        return velocities

    def flights(
        self, x: FloatArray, moved: FloatArray, start_velocities: FloatArray | None = None
    ) -> tuple[Flights, FloatArray]:
        """Return half cycles for all moved unknowns, and their start times [s]."""
        excursions, states = self.excursions, x[SIZE:].reshape(-1, 2)
        z = (np.concatenate([x[:SIZE], [0.0, 0.0]]) + moved)[:, :, None]
        first, second = states[:, 0] + z[:, -2], states[:, 1] + z[:, -1]
        begin = np.where(excursions.joined, first, excursions.begin)
        alpha, p, size = self.sides(excursions.sign, z[:, WIDTH], z[:, HEIGHT], z[:, TILT])
        turning = np.where(
            excursions.joined,
            np.exp(np.minimum(second, 5.0)) if start_velocities is None else start_velocities[0],
            second,
        )
        rows = (
            begin - z[:, CLOCK], np.where(excursions.joined, 0.0, first), turning, alpha, p, size,
            np.broadcast_to(excursions.sign, p.shape),
        )  # fmt: skip
        lasts = excursions.end - excursions.begin
        length = 1.15 * lasts + 0.05 * lasts.mean() + np.clip(excursions.begin - begin[0], 0.0, lasts)
        flat, sliding = [row.ravel() for row in rows], None
        if start_velocities is not None:
            lean = excursions.sign * np.sin(z[:, TILT])
            sliding = (
                np.broadcast_to(np.exp(z[:, FRICTION]), p.shape).ravel(),
                start_velocities[1].ravel(),
                lean.ravel(),
            )
        flights = Flights.integrated(
            self.motion, (flat[0], flat[1], flat[2]), (flat[3], flat[4], flat[5]), flat[6],
            np.broadcast_to(length, p.shape).ravel(),
            sliding,
        )  # fmt: skip
        return flights, begin

    def terms(self, x: FloatArray, about: FloatArray | None = None) -> Terms:
        """Return the residuals with slopes by finite differences; `about` has first values of start velocities."""
        excursions, (index, which), count = self.excursions, self.samples, self.excursions.sign.size
        by_move = [SIZE, SIZE + 1, WIDTH, HEIGHT, TILT, CLOCK, *([FRICTION] if self.slides else [])]
        moves = 1 + len(by_move)
        moved, start_velocities = np.zeros((moves, SIZE + 2)), None
        moved[np.arange(1, moves), by_move] = STEP
        if self.slides:  # the last two rows move the previous half cycle
            start_velocities = self.find_start_velocities(x, moved, about)
            before = self.after(x, moved[:3], self.ends(x, moved[:3], start_velocities[:, :3]))[:, 1:]
            start_velocities, moved = (
                np.concatenate([start_velocities, before], axis=1),
                np.concatenate([moved, np.zeros((2, SIZE + 2))]),
            )
            by_move, moves = [*by_move, SIZE + 2, SIZE + 3], moves + 2
        flights, begin = self.flights(x, moved, start_velocities)

        def slopes(values: FloatArray) -> FloatArray:
            matrix = np.zeros((values.shape[1], SIZE + 4))
            matrix[:, by_move] = (values[1:] - values[0]).T / STEP
            return matrix

        samples, at = [], np.concatenate([index, self.rest_samples])
        since = (self.series.time[index] - begin[:, which]).ravel()
        computed = flights.at(since, (np.arange(moves)[:, None] * count + which).ravel())
        for k in self.kinds:
            value = computed[k].reshape(moves, -1) * excursions.sign[which] * math.exp(x[GAIN + k])
            by = np.concatenate([slopes(value), np.zeros((self.rest_samples.size, SIZE + 4))])
            by[: index.size, GAIN + k] = value[0]
            by[:, OFFSET + k], by[:, DRIFT + k] = 1.0, self.line[at]
            predicted = (
                np.concatenate([value[0], np.zeros(self.rest_samples.size)])
                + x[OFFSET + k]
                + x[DRIFT + k] * self.line[at]
            )
            samples.append((getattr(self.series, KINDS[k])[at] - predicted, by))  # Eq. 280
        owners = np.concatenate([which, np.full(self.rest_samples.size, count)])

        def spread(own: FloatArray, k: IntArray) -> FloatArray:
            matrix, row = np.zeros((k.size, x.size)), np.arange(k.size)
            matrix[:, :SIZE] = own[:, :SIZE]
            for column in range(2):
                matrix[row, SIZE + 2 * k + column] = own[:, SIZE + column]
                matrix[row[k > 0], SIZE + 2 * k[k > 0] - 2 + column] = own[k > 0, SIZE + 2 + column]
            return matrix

        ended = np.flatnonzero(excursions.joined) - 1  # half cycles with an impact at the end
        lasts, speed = np.stack(flights.ends()[:2]).reshape(2, moves, count)[:, :, ended]
        ends, ln = begin[:, ended] + lasts, np.log(speed)
        states, row, sign = x[SIZE:].reshape(-1, 2)[ended + 1], np.arange(ended.size), excursions.sign[ended + 1]
        by_time, by_speed = spread(slopes(ends), ended), spread(slopes(ln), ended) * (1.0 + x[TREND])
        by_time[row, SIZE + 2 * (ended + 1)] = -1.0
        by_speed[row, SIZE + 2 * (ended + 1) + 1] = -1.0
        by_speed[:, MEAN], by_speed[:, HALF], by_speed[:, TREND] = 1.0, sign, ln[0] - self.middle
        took = states[:, 1] - ln[0] - x[MEAN] - sign * x[HALF] - x[TREND] * (ln[0] - self.middle)  # Eq. 281
        return Terms(samples, owners, (states[:, 0] - ends[0], by_time), (took, by_speed), start_velocities)

    def demand(self, x: FloatArray) -> float:
        """Return the largest friction demand during half cycles and at impacts [-]."""
        flights, _ = self.flights(x, np.zeros((1, SIZE + 2)))
        during = (
            np.arange(len(flights.rotation) - 1)[:, None] * flights.step < self.excursions.end - self.excursions.begin
        )
        old, new, height, _ = self.levers(np.concatenate([x[:SIZE], [0.0, 0.0]])[None, :, None])
        r = np.exp(x[MEAN] + self.excursions.sign * x[HALF])
        return float(max(flights.demand[during].max(), (height * (1.0 - r) / (old + new * r)).max()))  # Eq. 5

    @cached_property
    def precision(self) -> FloatArray:
        """Prior precision of all unknowns; infinite for known values."""
        with np.errstate(divide="ignore"):
            return np.concatenate([1.0 / self.deviation**2, np.zeros(2 * self.excursions.sign.size)])


@dataclass(frozen=True, eq=False)
class Fit:
    """The most likely unknowns."""

    x: FloatArray
    terms: Terms
    objective: float
    converged: bool


def fitted(
    problem: Forced, x: FloatArray, noise: FloatArray, scatter: float, same: float | None, steps: int = 30
) -> Fit:
    """Return the minimum of the objective, by damped Gauss-Newton steps."""
    free = np.isfinite(problem.precision)
    precision = problem.precision[free]
    prior = np.concatenate([problem.mean, np.zeros(x.size - SIZE)])

    def objective(x: FloatArray, about: FloatArray | None = None) -> tuple[float, Terms | None]:
        if not np.isfinite(x).all():
            return math.inf, None
        with np.errstate(all="ignore"):
            terms = problem.terms(x, about)
            value = terms.value(noise, scatter, same) + float(precision @ (x - prior)[free] ** 2)  # Eq. 283
        return value if math.isfinite(value) else math.inf, terms

    value, terms = objective(x)
    damping, converged = 0.0, False
    for _ in range(steps if math.isfinite(value) else 0):
        assert terms is not None
        hessian, gradient = terms.normal(noise, scatter, same)
        hessian, gradient = hessian[np.ix_(free, free)] + np.diag(precision), gradient[free]
        gradient -= precision * (x - prior)[free]
        scale = 1.0 / np.sqrt(np.diag(hessian))
        scaled = hessian * scale[:, None] * scale + (damping + 1e-14) * np.eye(scale.size)
        step = scale * np.linalg.solve(scaled, scale * gradient)
        trial = x.copy()
        trial[free] += step * min(1.0, _LONGEST / np.abs(step).max())
        trial_value, new = objective(trial, terms.start_velocities)
        better = trial_value <= value
        converged = damping <= _DAMPED and abs(trial_value - value) < _CLOSE and (better or damping == 0.0)
        if better:
            x, value, terms = trial, trial_value, new
        damping = (0.1 * damping if damping > 1e-3 else 0.0) if better else max(10.0 * damping, 1e-3)
        if converged or damping > 1e9:
            break
    assert terms is not None
    return Fit(x, terms, value, converged)
