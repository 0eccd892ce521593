"""Where to begin: when a shaken body rests, which half cycles are seen, and about how each of them begins."""

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

FEWEST = 3
"""Impacts."""

_SHARE, _SHARE_INTEGRATED = 0.01, 0.05  # of the range, least rotation that counts
_STILL = 0.7  # of the acceleration that lifts a body: below it rests for certain
_TRIES = 8
_ODD = 4.0  # of the usual mean square: no half cycle of rocking
_TELLS, _TAKES = 0.3, 0.5  # of ln r: standard deviation beyond which, and amount beyond which it is no impact
_LARGEST, _FEW, _BETWEEN = 12, 400, 0.02  # half cycles and samples by which a clock is sought, every so many seconds
_AT_ONCE = 100
ANNEALED = ((0.3, 3e-3), (0.03, 5e-4))
"""Scatter, and within which time half cycles end where the next ones begin [s]."""
SURE = 0.03
"""Standard deviation of a clock above which it is sought [s]."""


def problem_of(series: RotationSeries, known: Knowledge, motion: GroundMotion, clock: tuple[float, float]) -> Forced:
    """Return what is known, of a body of which nothing has been seen yet."""
    assert known.body is not None
    mean, deviation = np.zeros(SIZE), np.zeros(SIZE)
    lifts = g / max(known.body.side(foot).slenderness_ratio for foot in FEET)
    strong = np.flatnonzero(np.abs(motion.acceleration) > _STILL * lifts)
    if not strong.size:
        raise InvalidValueError(
            "{parameter} must lift the body, which takes {uplift:.3g} m/s2, got a peak of {peak:.3g} m/s2",
            parameter="motion", uplift=lifts, peak=motion.peak, hint="perhaps its unit is another one",
        )  # fmt: skip
    rest = np.flatnonzero(series.time < motion.time[strong[0]] + clock[0] - 3.0 * clock[1])
    mean[MEAN], deviation[MEAN], deviation[HALF] = -0.1, 0.2, 0.5 * known.asymmetry
    deviation[[WIDTH, HEIGHT]], deviation[TILT] = known.size_error, known.tilt_error
    deviation[TREND] = 0.05 if known.trend else 0.0
    mean[TILT] = known.tilt
    mean[CLOCK], deviation[CLOCK] = clock
    for k, kind in enumerate(KINDS):
        if (values := getattr(series, kind)) is not None:
            mean[OFFSET + k] = float(np.median(values[rest] if rest.size > 2 * FEWEST else values))
            deviation[GAIN + k] = known.size_error
            deviation[[OFFSET + k, DRIFT + k]] = float(np.ptp(values))
    none = np.zeros(0, np.int64)
    seen = Excursions(none, none, np.zeros(0), np.zeros(0), np.zeros(0), np.zeros(0, np.bool_))
    return Forced(known, motion, series, seen, rest, mean, deviation)


def rotation_of(problem: Forced, shared: FloatArray) -> FloatArray:
    """Return the rotation, zero at rest; an angular velocity is integrated."""
    series, time = problem.series, problem.series.time
    if series.rotation is not None:
        return np.asarray(series.rotation - shared[OFFSET] - shared[DRIFT] * problem.line)
    turning = np.asarray(series.angular_velocity) - shared[OFFSET + 1] - shared[DRIFT + 1] * problem.line
    found = np.concatenate([[0.0], np.cumsum(0.5 * (turning[1:] + turning[:-1]) * np.diff(time))])
    # where nothing turns for a while it rests, and so it does at the begin
    loud = np.flatnonzero(np.abs(turning) > 4.0 * white_noise(turning))
    edges = np.concatenate([[0], loud, [time.size - 1]])
    calm = np.flatnonzero(np.diff(edges) > max(10, 0.3 / float(np.median(np.diff(time)))))
    if not calm.size:
        return np.asarray(found - np.median(found))
    at = np.concatenate([[edges[k], edges[k + 1]] for k in calm]).astype(np.int64)
    return np.asarray(found - np.interp(time, time[at], found[at]))


def seen_of(problem: Forced, shared: FloatArray) -> Forced:
    """Return it with the half cycles that are seen, and joined to others."""
    share = _SHARE if problem.series.rotation is not None else _SHARE_INTEGRATED
    seen = excursions_of(problem.series.time, rotation_of(problem, shared), share)
    return replace(problem, seen=seen.kept(~seen.alone()), odd=0)


def begun(problem: Forced, shared: FloatArray) -> FloatArray:
    """Return unknowns with about what each half cycle begins with."""
    rotation, time, seen = rotation_of(problem, shared), problem.series.time, problem.seen
    states = np.zeros((seen.sign.size, 2))
    for k, (a, b) in enumerate(zip(seen.first, seen.last, strict=True)):
        near = slice(a, a + min(max(6, (b + 1 - a) // 4), b + 1 - a))
        since, values = time[near] - seen.begin[k], seen.sign[k] * rotation[near]
        if seen.joined[k]:
            speed = np.linalg.lstsq(np.column_stack([since, since**2]), values)[0][0]
            states[k] = seen.begin[k], math.log(max(speed, 0.3 * float(np.max(values / since))))
        else:
            states[k] = np.polyfit(since, values, 1)[::-1]
    return np.concatenate([shared, states.ravel()])


def sought(problem: Forced, clock: tuple[float, float]) -> float:
    """Return the clock that fits the largest half cycles best, each by itself [s]."""
    shared = problem.mean
    seen = excursions_of(problem.series.time, rotation_of(problem, shared), _SHARE_INTEGRATED)
    if not seen.sign.size:
        return clock[0]
    samples = seen.last - seen.first
    large = samples >= np.sort(samples)[-min(_LARGEST, samples.size)]
    tried = replace(problem, seen=seen.parted(seen.joined, problem.series.time).kept(large))
    x, shifts = begun(tried, shared), np.arange(-3.0 * clock[1], 3.0 * clock[1] + _BETWEEN, _BETWEEN)
    parts = np.array_split(shifts, math.ceil(shifts.size / _AT_ONCE))
    return clock[0] + float(shifts[np.argmin(np.concatenate([_misfits(tried, x, part) for part in parts]))])


def _misfits(problem: Forced, x: FloatArray, shifts: FloatArray) -> FloatArray:
    """Return sums of squares for shifted clocks, each half cycle begun as fits it best, to first order."""
    index, which = (each[:: max(1, each.size // _FEW)] for each in problem.samples)
    count, kind = problem.seen.sign.size, problem.kinds[0]
    measured = problem.seen.sign[which] * (getattr(problem.series, KINDS[kind])[index] - x[OFFSET + kind])
    moved = np.zeros((shifts.size, 3, SIZE + 2))
    moved[:, :, CLOCK] = shifts[:, None]
    moved[:, 1, -2] = moved[:, 2, -1] = STEP
    flights, begin = problem.flights(x, moved.reshape(-1, SIZE + 2))
    rows = np.arange(3 * shifts.size)[:, None] * count + which
    since = problem.series.time[index] - begin[:, which]
    value = flights.at(since.ravel(), rows.ravel())[kind].reshape(shifts.size, 3, -1)
    found = np.zeros(shifts.size)
    for k in range(count):
        here = value[:, :, which == k]
        residual, by = measured[which == k] - here[:, 0], (here[:, 1:] - here[:, :1]) / STEP
        normal = by @ by.transpose(0, 2, 1)
        across = by @ residual[:, :, None]
        found += (residual**2).sum(axis=1) - (across * np.linalg.solve(normal, across)).sum(axis=(1, 2))
    return found


def noise_of(problem: Forced) -> FloatArray:
    """Return the standard deviation of the noise of each kind of sample."""
    return np.array([white_noise(getattr(problem.series, KINDS[k])) for k in problem.kinds])


def deviations(problem: Forced, fit: Fit) -> FloatArray:
    """Return the standard deviation of each kind of sample about the fit, raised where neighbours go together."""
    spent = 2 * problem.seen.sign.size / len(problem.kinds)
    rows = [residual for residual, _ in fit.terms.samples]
    return np.array([math.sqrt(correlation(r) * float(r @ r) / max(r.size - spent, 0.3 * r.size)) for r in rows])


def first_fit(problem: Forced, shared: FloatArray) -> tuple[Forced, Fit, FloatArray] | None:
    """Return half cycles that are those of rocking, the fit with a scatter that is only about right, and the noise."""
    problem, noise = seen_of(problem, shared), noise_of(problem)
    for _ in range(_TRIES):
        if problem.seen.joined.sum() < FEWEST:
            return None
        fit = fitted(problem, begun(problem, shared), noise, 1.0, None)
        sound, apart = _sound(problem, fit, noise), np.zeros(problem.seen.sign.size, np.bool_)
        apart[np.flatnonzero(problem.seen.joined)] = _apart(problem, fit, noise)
        if sound.all() and not apart.any():
            break
        seen = problem.seen.parted(apart, problem.series.time).kept(sound)
        problem = replace(problem, seen=seen.kept(~seen.alone()), odd=problem.odd + int(np.sum(~sound)))
    for scatter, same in ANNEALED if math.isfinite(fit.objective) else ():
        fit = fitted(problem, fit.x, noise, scatter, same)
        noise = np.maximum(noise, deviations(problem, fit)) if fit.converged else noise
    return (problem, fit, noise) if math.isfinite(fit.objective) and np.isfinite(fit.terms.times[0]).all() else None


def _sound(problem: Forced, fit: Fit, noise: FloatArray) -> BoolArray:
    """Which half cycles are followed as well as most are."""
    which, count = problem.samples[1], problem.seen.sign.size
    square = sum((r[: which.size] / s) ** 2 for (r, _), s in zip(fit.terms.samples, noise, strict=True))
    each = np.bincount(which, square, count) / np.maximum(np.bincount(which, minlength=count), 1)
    return np.asarray(each < _ODD * np.median(each))


def _apart(problem: Forced, fit: Fit, noise: FloatArray) -> BoolArray:
    """Which impacts were none, or tell nothing: from half cycles each by itself, with what is not known of them."""
    drawn, by = fit.terms.draws
    hessian = fit.terms.normal(noise, 1.0, None)[0] + np.diag(np.minimum(problem.precision, 1e12))
    scale = 1.0 / np.sqrt(np.diag(hessian))
    root = np.linalg.inv(np.linalg.cholesky(hessian * scale[:, None] * scale + 1e-12 * np.eye(scale.size))) * scale
    spread = np.linalg.norm(root @ by.T, axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(~((spread < _TELLS) & (np.abs(drawn) < _TAKES + 3.0 * spread)))
