"""First values of a fit under ground motion: rest, detected half cycles, and their approximate first states."""

import math
from dataclasses import replace

import numpy as np

from rocking.conventions import FEET, BoolArray, FloatArray, g
from rocking.errors import InvalidValueError
from rocking.identification.forced_half_cycles import Excursions, excursions_of
from rocking.identification.forced_model import (
    CLOCK,
    DRIFT,
    GAIN,
    HALF,
    HEIGHT,
    KINDS,
    MEAN,
    OFFSET,
    SIZE,
    STEP,
    TILT,
    TREND,
    WIDTH,
    Fit,
    Forced,
    fitted,
)
from rocking.identification.measurement import RotationSeries, white_noise
from rocking.identification.posterior import Knowledge
from rocking.identification.series import correlation
from rocking.motions.motion import GroundMotion

MIN_IMPACTS = 3
"""Smallest number of impacts."""

_SHARE, _SHARE_INTEGRATED = 0.01, 0.05  # smallest rotation / range of the rotation
_STILL = 0.7  # fraction of the uplift acceleration below which the body certainly rests
_TRIES = 8
_ODD = 4.0  # largest mean square of a half cycle with rocking / usual mean square
_TELLS, _TAKES = 0.3, 0.5  # limits of ln r at an impact: standard deviation, absolute value
# numbers of half cycles and samples for the search of the clock offset; step of the search [s]
_LARGEST, _FEW, _BETWEEN = 12, 400, 0.02
_AT_ONCE = 100
ANNEALED = ((0.3, 3e-3), (0.03, 5e-4))
"""Scatter, and tolerance of the time between the end of a half cycle and the start of the next half cycle [s]."""
SURE = 0.03
"""Standard deviation of the clock above which a search precedes the fit [s]."""


def problem_of(series: RotationSeries, prior: Knowledge, motion: GroundMotion, clock: tuple[float, float]) -> Forced:
    """Return the problem with the prior and without detected half cycles."""
    assert prior.body is not None
    mean, deviation = np.zeros(SIZE), np.zeros(SIZE)
    lifts = g / max(prior.body.side(foot).slenderness_ratio for foot in FEET)
    strong = np.flatnonzero(np.abs(motion.acceleration) > _STILL * lifts)
    if not strong.size:
        raise InvalidValueError(
            "{parameter} must exceed the uplift acceleration of {uplift:.3g} m/s2, got a peak of {peak:.3g} m/s2",
            parameter="motion", uplift=lifts, peak=motion.peak, hint="check the unit",
        )  # fmt: skip
    rest_samples = np.flatnonzero(series.time < motion.time[strong[0]] + clock[0] - 3.0 * clock[1])
    mean[MEAN], deviation[MEAN], deviation[HALF] = -0.1, 0.2, 0.5 * prior.asymmetry
    deviation[[WIDTH, HEIGHT]], deviation[TILT] = prior.size_error, prior.tilt_error
    deviation[TREND] = 0.05 if prior.trend else 0.0
    mean[TILT] = prior.tilt
    mean[CLOCK], deviation[CLOCK] = clock
    for k, kind in enumerate(KINDS):
        if (values := getattr(series, kind)) is not None:
            mean[OFFSET + k] = float(np.median(values[rest_samples] if rest_samples.size > 2 * MIN_IMPACTS else values))
            deviation[GAIN + k] = prior.size_error
            deviation[[OFFSET + k, DRIFT + k]] = float(np.ptp(values))
    no_samples = np.zeros(0, np.int64)
    excursions = Excursions(no_samples, no_samples, np.zeros(0), np.zeros(0), np.zeros(0), np.zeros(0, np.bool_))
    return Forced(prior, motion, series, excursions, rest_samples, mean, deviation)


def rotation_of(problem: Forced, shared: FloatArray) -> FloatArray:
    """Return the rotation, zero at rest; an angular velocity is integrated."""
    series, time = problem.series, problem.series.time
    if series.rotation is not None:
        return np.asarray(series.rotation - shared[OFFSET] - shared[DRIFT] * problem.line)
    turning = np.asarray(series.angular_velocity) - shared[OFFSET + 1] - shared[DRIFT + 1] * problem.line
    rotation = np.concatenate([[0.0], np.cumsum(0.5 * (turning[1:] + turning[:-1]) * np.diff(time))])
    # the body is at rest at the start and in intervals without rotation
    loud = np.flatnonzero(np.abs(turning) > 4.0 * white_noise(turning))
    edges = np.concatenate([[0], loud, [time.size - 1]])
    calm = np.flatnonzero(np.diff(edges) > max(10, 0.3 / float(np.median(np.diff(time)))))
    if not calm.size:
        return np.asarray(rotation - np.median(rotation))
    at = np.concatenate([[edges[k], edges[k + 1]] for k in calm]).astype(np.int64)
    return np.asarray(rotation - np.interp(time, time[at], rotation[at]))


def with_excursions(problem: Forced, shared: FloatArray) -> Forced:
    """Return the problem without isolated half cycles."""
    fraction = _SHARE if problem.series.rotation is not None else _SHARE_INTEGRATED
    excursions = excursions_of(problem.series.time, rotation_of(problem, shared), fraction)
    return replace(problem, excursions=excursions.subset(~excursions.is_isolated()), excluded=0)


def initial_unknowns(problem: Forced, shared: FloatArray) -> FloatArray:
    """Return unknowns with the approximate first state of each half cycle."""
    rotation, time, excursions = rotation_of(problem, shared), problem.series.time, problem.excursions
    states = np.zeros((excursions.sign.size, 2))
    for k, (a, b) in enumerate(zip(excursions.first, excursions.last, strict=True)):
        near = slice(a, a + min(max(6, (b + 1 - a) // 4), b + 1 - a))
        since, values = time[near] - excursions.begin[k], excursions.sign[k] * rotation[near]
        if excursions.joined[k]:
            speed = np.linalg.lstsq(np.column_stack([since, since**2]), values)[0][0]
            states[k] = excursions.begin[k], math.log(max(speed, 0.3 * float(np.max(values / since))))
        else:
            states[k] = np.polyfit(since, values, 1)[::-1]
    return np.concatenate([shared, states.ravel()])


def best_clock(problem: Forced, clock: tuple[float, float]) -> float:
    """Return the clock offset with the best fit of the largest half cycles, each fitted separately [s]."""
    shared = problem.mean
    excursions = excursions_of(problem.series.time, rotation_of(problem, shared), _SHARE_INTEGRATED)
    if not excursions.sign.size:
        return clock[0]
    samples = excursions.last - excursions.first
    large = samples >= np.sort(samples)[-min(_LARGEST, samples.size)]
    largest = replace(problem, excursions=excursions.separated(excursions.joined, problem.series.time).subset(large))
    x, shifts = initial_unknowns(largest, shared), np.arange(-3.0 * clock[1], 3.0 * clock[1] + _BETWEEN, _BETWEEN)
    blocks = np.array_split(shifts, math.ceil(shifts.size / _AT_ONCE))
    return clock[0] + float(shifts[np.argmin(np.concatenate([_misfits(largest, x, block) for block in blocks]))])


def _misfits(problem: Forced, x: FloatArray, shifts: FloatArray) -> FloatArray:
    """Return sums of squares for shifted clocks, with the first state of each half cycle fitted to first order."""
    index, which = (samples[:: max(1, samples.size // _FEW)] for samples in problem.samples)
    count, kind = problem.excursions.sign.size, problem.kinds[0]
    measured = problem.excursions.sign[which] * (getattr(problem.series, KINDS[kind])[index] - x[OFFSET + kind])
    moved = np.zeros((shifts.size, 3, SIZE + 2))
    moved[:, :, CLOCK] = shifts[:, None]
    moved[:, 1, -2] = moved[:, 2, -1] = STEP
    flights, begin = problem.flights(x, moved.reshape(-1, SIZE + 2))
    rows = np.arange(3 * shifts.size)[:, None] * count + which
    since = problem.series.time[index] - begin[:, which]
    value = flights.at(since.ravel(), rows.ravel())[kind].reshape(shifts.size, 3, -1)
    misfits = np.zeros(shifts.size)
    for k in range(count):
        here = value[:, :, which == k]
        residual, by = measured[which == k] - here[:, 0], (here[:, 1:] - here[:, :1]) / STEP
        normal = by @ by.transpose(0, 2, 1)
        across = by @ residual[:, :, None]
        misfits += (residual**2).sum(axis=1) - (across * np.linalg.solve(normal, across)).sum(axis=(1, 2))
    return misfits


def noise_of(problem: Forced) -> FloatArray:
    """Return the standard deviation of the noise of each kind of sample."""
    return np.array([white_noise(getattr(problem.series, KINDS[k])) for k in problem.kinds])


def deviations(problem: Forced, fit: Fit) -> FloatArray:
    """Return the standard deviation of each kind of sample about the fit, increased for correlated neighbours."""
    spent = 2 * problem.excursions.sign.size / len(problem.kinds)
    rows = [residual for residual, _ in fit.terms.samples]
    return np.array([math.sqrt(correlation(r) * float(r @ r) / max(r.size - spent, 0.3 * r.size)) for r in rows])


def first_fit(problem: Forced, shared: FloatArray) -> tuple[Forced, Fit, FloatArray] | None:
    """Return the problem without other half cycles, a fit with an approximate scatter, and the noise."""
    problem, noise = with_excursions(problem, shared), noise_of(problem)
    for _ in range(_TRIES):
        if problem.excursions.joined.sum() < MIN_IMPACTS:
            return None
        fit = fitted(problem, initial_unknowns(problem, shared), noise, 1.0, None)
        sound, apart = _is_regular(problem, fit, noise), np.zeros(problem.excursions.sign.size, np.bool_)
        apart[np.flatnonzero(problem.excursions.joined)] = _is_no_impact(problem, fit, noise)
        if sound.all() and not apart.any():
            break
        excursions = problem.excursions.separated(apart, problem.series.time).subset(sound)
        problem = replace(
            problem,
            excursions=excursions.subset(~excursions.is_isolated()),
            excluded=problem.excluded + int(np.sum(~sound)),
        )
    for scatter, same in ANNEALED if math.isfinite(fit.objective) else ():
        fit = fitted(problem, fit.x, noise, scatter, same)
        noise = np.maximum(noise, deviations(problem, fit)) if fit.converged else noise
    return (problem, fit, noise) if math.isfinite(fit.objective) and np.isfinite(fit.terms.times[0]).all() else None


def _is_regular(problem: Forced, fit: Fit, noise: FloatArray) -> BoolArray:
    """Return True for half cycles with a usual misfit."""
    which, count = problem.samples[1], problem.excursions.sign.size
    square = sum((r[: which.size] / s) ** 2 for (r, _), s in zip(fit.terms.samples, noise, strict=True))
    mean_squares = np.bincount(which, square, count) / np.maximum(np.bincount(which, minlength=count), 1)
    return np.asarray(mean_squares < _ODD * np.median(mean_squares))


def _is_no_impact(problem: Forced, fit: Fit, noise: FloatArray) -> BoolArray:
    """Return True for false or too uncertain impacts, from separately fitted half cycles."""
    drawn, by = fit.terms.draws
    hessian = fit.terms.normal(noise, 1.0, None)[0] + np.diag(np.minimum(problem.precision, 1e12))
    scale = 1.0 / np.sqrt(np.diag(hessian))
    root = np.linalg.inv(np.linalg.cholesky(hessian * scale[:, None] * scale + 1e-12 * np.eye(scale.size))) * scale
    spread = np.linalg.norm(root @ by.T, axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(~((spread < _TELLS) & (np.abs(drawn) < _TAKES + 3.0 * spread)))
