"""A freely rocking body as a state-space model: its speed after each impact, and the measured quantities.

The unknowns have standard normal priors: the parameters shared by all impacts, and one random number per impact. This
number scatters the coefficient of restitution about its mean. Many pairs of scatter and noise are computed together.
They are the first axis of all arrays, with the size g below. All angles of the left side are mirrored.

`y` is the ratio of the speed after an impact to the smallest speed with overturning. `alpha` is the slenderness angle
of the foot in contact. Times are multiplied by the frequency parameter p.
"""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from scipy.special import ellipj, elliprd, elliprf

from rocking.conventions import BoolArray, FloatArray, IntArray


def overturning_speed(alpha: FloatArray) -> FloatArray:
    """Return the smallest angular velocity / p with overturning [-]."""
    return np.asarray(2.0 * np.sin(0.5 * alpha))  # Eq. 264


def duration(y: FloatArray, alpha: FloatArray) -> FloatArray:
    """Return p T, with the time T from one impact to the next impact [-].

    >>> round(float(duration(np.array(0.8), np.array(1e-9)) - 2.0 * np.arctanh(0.8)), 12)
    0.0
    """
    return np.asarray(2.0 * y * elliprf(*_arguments(y, alpha)))  # Eq. 265


def duration_and_slopes(y: FloatArray, alpha: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return p T, its derivative by ln y at constant alpha, and its derivative by alpha at constant y."""
    a, b, c = _arguments(y, alpha)
    q, s2 = 1.0 - y * y, np.sin(0.5 * alpha) ** 2
    by_a, by_b, by_c = -elliprd(b, c, a) / 6.0, -elliprd(a, c, b) / 6.0, -elliprd(a, b, c) / 6.0
    scaled = 2.0 * y * elliprf(a, b, c)
    by_y = (s2 - 1.0) * by_a + (s2 * q - c) * by_b + s2 * by_c  # derivative / (2 y)
    by_s2 = -q * (by_a + q * by_b + by_c)
    return scaled, scaled + 4.0 * y**3 * by_y, y * np.sin(alpha) * by_s2


def speed(scaled_duration: FloatArray, alpha: FloatArray) -> FloatArray:
    """Return y from p T: the inverse of `duration`."""
    goal = np.log(np.asarray(scaled_duration, dtype=np.float64))
    y = np.tanh(0.5 * np.exp(goal))
    for _ in range(30):
        trial, slope, _ = duration_and_slopes(y, alpha)
        # ln T is nearly linear in ln atanh y
        step = (np.log(trial) - goal) * trial / slope * y / (1.0 - y * y)
        y = np.tanh(np.maximum(np.arctanh(y) - step, 0.5 * np.arctanh(y)))
        if np.all(np.abs(step) <= 1e-14 * np.arctanh(y)):
            break
    return np.asarray(y)


def peak(y: FloatArray, alpha: FloatArray) -> FloatArray:
    """Return the peak rotation until the next impact [rad]."""
    s = np.sin(0.5 * alpha)
    return np.asarray(alpha - 2.0 * np.arcsin(s * np.sqrt(1.0 - y * y)))  # Eq. 266


def rotation(
    since: FloatArray, y: FloatArray, alpha: FloatArray, until: FloatArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """Return rotation [rad] and angular velocity / p [-]; `since`, `until`: p x time since and time to an impact."""
    low = np.sin(0.5 * alpha) * np.sqrt(1.0 - y * y)  # sine of half the angle to equilibrium at the peak
    m = 1.0 - low * low
    sn, _, dn, _ = ellipj(since - 0.5 * (duration(y, alpha) if until is None else until), m)
    return alpha - 2.0 * np.arcsin(np.minimum(low / dn, 1.0)), -2.0 * low * np.sqrt(m) * sn / dn  # Eq. 267


def viscous_loss(y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the decrease of ln y until the next impact / damping ratio, for slender bodies.

    The second result is its derivative by ln y; y is the geometric mean of the values at both ends.
    """
    small = y < 0.05
    z = np.where(small, 0.5, y)
    exact = 2.0 * (z - (1.0 - z * z) * np.arctanh(z)) / (z * z)  # Eq. 268
    slope = 4.0 * (np.arctanh(z) - z) / (z * z)
    return np.where(small, 4.0 * y / 3.0 + 4.0 * y**3 / 15.0, exact), np.where(small, 4.0 * y / 3.0 + 0.8 * y**3, slope)


def _arguments(y: FloatArray, alpha: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    q, s2 = 1.0 - y * y, np.sin(0.5 * alpha) ** 2
    m = 1.0 - s2 * q
    return (1.0 - s2) * q, m * q, m


SHARED = (START, SPEED, MEAN, HALF, FREQUENCY, TILT, SLENDERNESS, TREND, DAMPING) = tuple(range(9))
"""Time of the first impact [s], ln of the speed after the first impact, ln of the mean coefficient, half the difference
of ln r between the right and the left foot, ln of the ratios of p and of the slenderness angle to their nominal values,
clockwise tilt of the floor [rad], slope of ln r over ln of the speed, damping ratio."""

_BELOW_OVERTURNING = 1.0 - 1e-9
_ROUNDING = 1e-14
_STEEPEST = 1.5  # largest slenderness angle [rad]
_PART = 128  # rows of a matrix product that is small enough for one thread
# largest number of steps; step of the check; difference of ln of the density with negligible weight
_STEPS, _PATIENCE, _FAR_BEHIND = 40, 12, 100.0
_CLOSE = 1e-3  # largest change of -2 ln of the posterior at convergence


@dataclass(frozen=True, eq=False)
class Path:
    """Path of the body for given unknowns: impacts n = 0..N, half cycles k = 0..N-1.

    Slopes are derivatives by the d unknowns on the last axis.
    """

    times: FloatArray  # times of impacts, shape (g, n) [s]
    speeds: FloatArray  # ln of the angular velocity after the impact, shape (g, k)
    y: FloatArray  # speed / overturning speed, shape (g, k) [-]
    alpha: FloatArray  # slenderness angle, shape (g, k) [rad]
    p: FloatArray  # frequency parameter, shape (g, k) [rad/s]
    time_slopes: FloatArray  # slopes of the times, shape (g, n, d)
    y_slopes: FloatArray  # slopes of ln y, shape (g, k, d)
    alpha_slopes: FloatArray  # slopes of alpha, shape (g, k, d)
    p_slopes: FloatArray  # slopes of ln p, shape (d,)
    feasible: BoolArray  # True without overturning, shape (g,)


class _HalfCycle(NamedTuple):
    """Quantities of all half cycles on one side."""

    alpha: FloatArray  # slenderness angle, shape (g,) [rad]
    p: FloatArray  # frequency parameter, shape (g,) [rad/s]
    alpha_slopes: FloatArray  # shape (g, d)
    ln_overturning: FloatArray  # ln of the speed that overturns the body, shape (g,)
    overturning_slopes: FloatArray  # slopes of its dependence on alpha, shape (g, d)
    change: FloatArray  # change of ln of the speed at the impact without scatter, shape (g,)
    change_slopes: FloatArray  # shape (d,)


@dataclass(frozen=True, eq=False)
class Model:
    """Prior of a measurement: the body, its side in each half cycle, and the prior distributions."""

    sides: IntArray  # 0 for right, 1 for left, shape (k,)
    alpha: tuple[float, float]  # slenderness angles, right and left [rad]
    p: tuple[float, float]  # frequency parameters, right and left [rad/s]
    mean: FloatArray  # prior mean of the shared parameters
    deviation: FloatArray  # prior standard deviation of the shared parameters, zero for known parameters
    middle: float = 0.0  # ln of the reference speed of a trend

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return len(SHARED) + self.sides.size - 1

    def shared(self, u: FloatArray) -> FloatArray:
        """Return the parameters shared by all impacts, from the unknowns."""
        return np.asarray(self.mean + self.deviation * u[..., : len(SHARED)])

    def path(self, u: FloatArray, scatter: FloatArray) -> Path:
        """Return the path from impact to impact for u, shape (g, d), and the scatter of ln r at impacts, shape (g,)."""
        count, size = self.sides.size, self.size
        z = self.shared(u)
        unit = np.zeros((len(SHARED), size))
        unit[:, : len(SHARED)] = np.diag(self.deviation)
        ends = [self._on(side, z, unit) for side in (0, 1)]
        time, speed = z[:, START], z[:, SPEED]
        dt, dx = np.broadcast_to(unit[START], u.shape), np.broadcast_to(unit[SPEED], u.shape)
        times, time_slopes = np.empty((len(u), count + 1)), np.empty((len(u), count + 1, size))
        speeds, y_of_cycle, alphas, ps = (np.empty((len(u), count)) for _ in range(4))
        y_slopes, alpha_slopes = (np.empty((len(u), count, size)) for _ in range(2))
        feasible = np.ones(len(u), dtype=np.bool_)
        trend, damped = (self.deviation[which] > 0.0 or self.mean[which] != 0.0 for which in (TREND, DAMPING))
        lost, dl = np.zeros(len(u)), np.zeros(u.shape)
        highest = np.log(_BELOW_OVERTURNING)
        for k, side in enumerate(self.sides):
            end = ends[side]
            ln_y = speed - end.ln_overturning
            dy = dx - unit[FREQUENCY] - end.overturning_slopes
            feasible &= ln_y < highest
            y = np.exp(np.minimum(ln_y, highest))
            if damped:
                y, dy, lost, dl = _damped(y, dy, z[:, DAMPING], unit[DAMPING])
            scaled, by_y, by_alpha = duration_and_slopes(y, end.alpha)
            times[:, k], speeds[:, k], y_of_cycle[:, k], alphas[:, k], ps[:, k] = time, speed, y, end.alpha, end.p
            time_slopes[:, k], y_slopes[:, k], alpha_slopes[:, k] = dt, dy, end.alpha_slopes
            time = time + scaled / end.p
            dt = (
                dt
                + (by_y[:, None] * dy + by_alpha[:, None] * end.alpha_slopes) / end.p[:, None]
                - (scaled / end.p)[:, None] * unit[FREQUENCY]
            )
            if k + 1 == count:
                break
            change = end.change + scatter * u[:, len(SHARED) + k] - lost  # Eq. 269
            dc = end.change_slopes - dl
            dc[:, len(SHARED) + k] += scatter
            if trend:
                off = speed - self.middle
                change = change + z[:, TREND] * off
                dc += off[:, None] * unit[TREND] + z[:, TREND, None] * dx
            speed, dx = speed + change, dx + dc
        times[:, count], time_slopes[:, count] = time, dt
        return Path(
            times, speeds, y_of_cycle, alphas, ps, time_slopes, y_slopes, alpha_slopes, unit[FREQUENCY], feasible
        )

    def _on(self, side: int, z: FloatArray, unit: FloatArray) -> "_HalfCycle":
        """Return the quantities of all half cycles on one side."""
        sign = 1.0 - 2.0 * side  # a tilt to the right reduces the slenderness angle over the right foot
        alone = self.alpha[side] * np.exp(z[:, SLENDERNESS])
        alpha, p = np.clip(alone - sign * z[:, TILT], 1e-3, _STEEPEST), self.p[side] * np.exp(z[:, FREQUENCY])
        da = alone[:, None] * unit[SLENDERNESS] - sign * unit[TILT]
        lands = -sign  # the body lands on the other side
        return _HalfCycle(
            alpha, p, da, np.log(p * overturning_speed(alpha)), (0.5 / np.tan(0.5 * alpha))[:, None] * da,
            z[:, MEAN] + lands * z[:, HALF], unit[MEAN] + lands * unit[HALF],
        )  # fmt: skip

    def unknowns_at_times(self, u: FloatArray, scatter: FloatArray, times: FloatArray) -> FloatArray:
        """Return unknowns with impacts at given times and the shared parameters of u."""
        z, unknowns = self.shared(u), u.copy()
        sign = 1.0 - 2.0 * self.sides
        alone = np.array(self.alpha)[self.sides] * np.exp(z[:, SLENDERNESS, None])
        alpha = np.clip(alone - sign * z[:, TILT, None], 1e-3, _STEEPEST)
        p = np.array(self.p)[self.sides] * np.exp(z[:, FREQUENCY, None])
        y = speed(p * np.maximum(np.diff(times), 1e-6), alpha)
        loss = z[:, DAMPING, None] * viscous_loss(y)[0]
        speeds = np.log(y * p * overturning_speed(alpha)) + 0.5 * loss
        mean = z[:, MEAN, None] - sign[:-1] * z[:, HALF, None] + z[:, TREND, None] * (speeds[:, :-1] - self.middle)
        draws = np.diff(speeds) - mean + loss[:, :-1]
        unknowns[:, len(SHARED) :] = draws / np.maximum(scatter, 1e-300)[:, None]
        unknowns[:, START] = (times[:, 0] - self.mean[START]) / self.deviation[START]
        unknowns[:, SPEED] = (speeds[:, 0] - self.mean[SPEED]) / self.deviation[SPEED]
        return unknowns


def _damped(
    y: FloatArray, dy: FloatArray, ratio: FloatArray, unit: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return y at the middle of a half cycle, the slopes of ln y, the viscous loss, and the slopes of the loss."""
    loss, slope = viscous_loss(y)
    dy = (1.0 - 0.5 * ratio * slope)[:, None] * dy - 0.5 * loss[:, None] * unit
    y = y * np.exp(-0.5 * ratio * loss)
    loss, slope = viscous_loss(y)
    return y, dy, ratio * loss, loss[:, None] * unit + (ratio * slope)[:, None] * dy


class Observer(Protocol):
    """Measured quantities of a path."""

    @property
    def count(self) -> int:
        """Number of independent values."""
        ...

    def residuals(self, path: Path) -> tuple[FloatArray, FloatArray]:
        """Return measured minus computed values, shape (g, m), and slopes of the computed values, shape (g, m, d)."""
        ...


@dataclass(frozen=True, eq=False)
class Clicks:
    """Times of impacts; some impacts may be missing."""

    measured: FloatArray
    impacts: IntArray  # index of the impact at each time

    @property
    def count(self) -> int:
        """Number of times."""
        return self.measured.size

    def residuals(self, path: Path) -> tuple[FloatArray, FloatArray]:
        """Return measured minus computed times, with slopes of the computed times."""
        return self.measured - path.times[:, self.impacts], path.time_slopes[:, self.impacts]


@dataclass(frozen=True, eq=False)
class Laplace:
    """The posterior for each pair of scatter and noise, as a normal distribution of the unknowns."""

    u: FloatArray  # unknowns at the maximum, shape (g, d)
    covariance: FloatArray  # covariances of the unknowns, shape (g, d, d)
    evidence: FloatArray  # ln of the probability density of the measurement, shape (g,)
    residuals: FloatArray  # measured minus computed values, shape (g, m)
    converged: BoolArray  # True after convergence, shape (g,)


def laplace(model: Model, observer: Observer, scatter: FloatArray, noise: FloatArray, u: FloatArray) -> Laplace:
    """Return the posterior about its maximum; damped Gauss-Newton steps from u search the maximum."""
    u = u.copy()
    best = _objective(model, observer, scatter, noise, u)
    damping, active, converged = np.zeros(len(u)), np.arange(len(u)), np.zeros(len(u), dtype=np.bool_)
    for iteration in range(_STEPS):
        if iteration == _PATIENCE:  # omit unlikely nodes, which have a negligible weight
            ln = -0.5 * best[0] - observer.count * np.log(noise)
            active = active[ln[active] > ln.max() - _FAR_BEHIND]
        state = (u[active], *(values[active] for values in best))
        tried, stepped = _stepped(model, observer, scatter[active], noise[active], state, damping[active])
        value = best[0][active]
        better = stepped[0] <= value
        for old, new in zip(best, stepped, strict=True):
            old[active[better]] = new[better]
        u[active[better]] = tried[better]
        # a damped step hardly changes parameters without data
        done = (np.abs(value - stepped[0]) < _CLOSE * (1.0 + _CLOSE * value)) & (damping[active] == 0.0)
        eased = np.where(damping[active] > 0.1, 0.1 * damping[active], 0.0)
        damping[active] = np.where(better, eased, np.maximum(10.0 * damping[active], 0.1))
        converged[active[done]] = True
        active = active[~done]
        if not active.size:
            break
    value, residual, slopes, *_ = best
    # with the root of the Hessian, parameters without data keep their digits
    eye = np.broadcast_to(np.eye(model.size), (len(u), model.size, model.size))
    root = np.linalg.qr(np.concatenate([slopes, eye], axis=1), mode="r")
    half = np.log(np.abs(np.einsum("gii->gi", root))).sum(axis=1)
    evidence = -0.5 * value - half - observer.count * (np.log(noise) + 0.5 * np.log(2.0 * np.pi))  # Eq. 272
    inverse = np.linalg.inv(root)
    return Laplace(u, inverse @ inverse.transpose(0, 2, 1), evidence, residual * noise[:, None], converged)


def _stepped(
    model: Model,
    observer: Observer,
    scatter: FloatArray,
    noise: FloatArray,
    state: tuple[FloatArray, ...],
    damping: FloatArray,
) -> tuple[FloatArray, tuple[FloatArray, ...]]:
    """Return the better of a straight and a curved step for each node, and the objective at its end."""
    u, value, residual, slopes, times, time_slopes = state
    turned, eye = slopes.transpose(0, 2, 1), np.eye(model.size)
    blocks = [slice(k, k + _PART) for k in range(0, residual.shape[1], _PART)]
    hessian = eye + sum(turned[:, :, block] @ slopes[:, block] for block in blocks)  # Eq. 271
    matrix = hessian + damping[:, None, None] * eye + _ROUNDING * eye * np.einsum("gii->gi", hessian)[:, None, :]
    step = np.linalg.solve(matrix, turned @ residual[..., None] - u[..., None])
    tried = u + step[..., 0]
    straight = _objective(model, observer, scatter, noise, tried)
    again = np.flatnonzero((scatter > 0.0) | (straight[0] > value))
    bent, has_draws = tried[again], scatter[again] > 0.0
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        # the curved step is linear in the impact times, because times are much more accurate than speeds
        goal = (times + (time_slopes @ step)[..., 0])[again][has_draws]
        bent[has_draws] = model.unknowns_at_times(bent[has_draws], scatter[again][has_draws], goal)
    # without random numbers, a second step has the slopes of the first step
    fixed = again[~has_draws]
    bent[~has_draws] += np.linalg.solve(
        matrix[fixed], (turned @ straight[1][..., None])[fixed] - tried[fixed][..., None]
    )[..., 0]
    at_bent = _objective(model, observer, scatter[again], noise[again], bent)
    better = at_bent[0] < straight[0][again]
    tried[again[better]] = bent[better]
    for straight_part, bent_part in zip(straight, at_bent, strict=True):
        straight_part[again[better]] = bent_part[better]
    return tried, straight


def _objective(
    model: Model, observer: Observer, scatter: FloatArray, noise: FloatArray, u: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return -2 ln of the posterior, residuals and slopes divided by the noise, times of impacts and their slopes."""
    # far from the maximum, values overflow and the step is rejected
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        path = model.path(u, scatter)
        residual, slopes = observer.residuals(path)
        residual = residual / noise[:, None]
        value = (u * u).sum(axis=1) + (residual * residual).sum(axis=1)  # Eq. 270
        slopes = slopes / noise[:, None, None]
    feasible = path.feasible & np.isfinite(value)
    return (
        np.where(feasible, value, np.inf), np.where(feasible[:, None], residual, 0.0), np.nan_to_num(slopes),
        path.times, path.time_slopes,
    )  # fmt: skip
