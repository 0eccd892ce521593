"""Bootstrap: simulated repetitions of a study, with fits."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, get_args

import numpy as np
from scipy.special import ndtr, ndtri

from rocking import checks
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.statistics.counts import Counts
from rocking.statistics.maximum_likelihood import (
    FittedCurves,
    LogScale,
    find_curves,
    log_quantity,
    quadratic_error,
    standard_errors,
    with_cluster_errors,
)

Resampling = Literal["parametric", "cases", "clusters"]
Ends = Literal["studentised", "percentile", "basic"]
Pair = tuple[FloatArray, FloatArray]

OUTWARD = (
    6  # number of steps to a value outside the interval; every step is twice as long as the last; ends beyond are open
)

NEAR = 0.05
"""Tolerance of an end, relative to the first step of its search."""

NODES = (
    -3.0,
    -1.5,
    -0.7,
    0.0,
    0.7,
    1.5,
    3.0,
)  # variates of the fractiles that bound a band; ends between these variates are interpolated


def resample(
    counts: Counts, probability: FloatArray, kind: Resampling, repetitions: int, seed: int
) -> tuple[FloatArray, FloatArray]:
    """Return failures and trials of resampled data sets, with one row per data set and one column per level."""
    checks.within("repetitions", repetitions, 1, 10**7)
    random = np.random.default_rng(seed)
    if kind == "parametric":
        trials = np.broadcast_to(counts.trials, (repetitions, counts.levels.size))
        return random.binomial(trials.astype(np.int64), probability).astype(np.float64), trials  # Eq. 208
    if kind == "cases":
        cells = np.concatenate([counts.failures, counts.survivals]) / counts.trials.sum()
        samples = random.multinomial(counts.observations, cells, size=repetitions).astype(np.float64)
        failures, survivals = np.split(samples, 2, axis=1)
        return failures, failures + survivals
    if kind != "clusters":
        raise InvalidValueError(
            "kind must be one of {kinds} or capacities, got {kind}",
            kinds=", ".join(get_args(Resampling)),
            kind=f"{kind!r}",
        )
    if counts.cluster_trials is None:
        raise InvalidValueError("kind='clusters' needs the record of each outcome in clusters=")
    if counts.scarcity:
        raise InvalidValueError(
            "{parameter} must not be 'clusters' for {clusters}: the interval would be far too narrow",
            parameter="kind", value="clusters", clusters=counts.scarcity,
            hint="Use more records, or the profile interval with caution.",
        )  # fmt: skip
    failures, trials = np.split(_sampled_clusters(counts, repetitions, seed) @ counts.distinct_clusters[0], 2, axis=1)
    return failures, trials


def _sampled_clusters(counts: Counts, repetitions: int, seed: int) -> FloatArray:
    """Return the numbers of samples of the distinct clusters, one row per repetition."""
    weights = counts.distinct_clusters[1]
    random, total = np.random.default_rng(seed), weights.sum()
    return random.multinomial(round(total), weights / total, size=repetitions).astype(np.float64)  # Eq. 209


@dataclass(frozen=True, eq=False)
class BootstrapSample:
    """Curves of repeated studies, with the curve of the study.

    Repetitions with a step are fitted by the penalised likelihood. Repetitions without a rising curve are beyond both
    ends of every interval, so that they widen the interval.
    """

    curves: FittedCurves  # the curves of the repetitions
    original: FittedCurves  # the curve of the study (one row)
    scale: LogScale  # scale of the coefficients
    kind: Resampling  # kind of resampling
    ends = "studentised"

    @property
    def repetitions(self) -> int:
        """Number of repeated studies."""
        return self.curves.exists.size

    @property
    def undetermined(self) -> int:
        """Number of repeated studies without a rising curve."""
        return int(np.sum(~self.curves.exists))

    @property
    def penalised(self) -> int:
        """Number of repeated studies fitted by the penalised likelihood."""
        return int(np.sum(self.curves.penalised & self.curves.exists))

    def log_interval(self, variate: float | None, level: float, ends: Ends = "studentised") -> tuple[float, float]:
        """Return both ends of the interval of `log_quantity`."""
        # by the distances of the repetitions in standard errors (second-order accurate), by percentiles, or by
        # mirrored percentiles; infinite for open ends
        of_study, of_repetitions = (
            (
                log_quantity(curves.theta, self.scale, variate)[:, None],
                standard_errors(curves.theta, curves.curvature, self.scale, variate)[:, None],
            )
            for curves in (self.original, self.curves)
        )
        low, high = self._ends(of_study, of_repetitions, level, ends)
        return float(low[0]), float(high[0])

    def variate_band(
        self, position: FloatArray, level: float, ends: Ends = "studentised"
    ) -> tuple[FloatArray, FloatArray]:
        """Return pointwise ends of the variate a + b u of the probability."""
        slope = np.stack([np.ones_like(position), position], axis=1)
        of_study, of_repetitions = (
            (
                curves.theta @ slope.T,
                np.stack([quadratic_error(row[None], curves.curvature) for row in slope], axis=1),
            )
            for curves in (self.original, self.curves)
        )
        return self._ends(of_study, of_repetitions, level, ends)

    def _ends(self, of_study: Pair, of_repetitions: Pair, level: float, ends: Ends) -> Pair:
        """Return the ends of the intervals of all columns, from values and standard errors of study and repetitions."""
        kind = checks.one_of("ends", ends, get_args(Ends))
        distance = of_repetitions[0] if kind == "percentile" else of_repetitions[0] - of_study[0]
        distance = distance / of_repetitions[1] if kind == "studentised" else distance  # Eq. 210
        exists, tail = self.curves.exists[:, None], 0.5 * (1.0 - level)
        low = _order_statistic(np.where(exists, distance, -np.inf), tail)
        high = -_order_statistic(np.where(exists, -distance, -np.inf), tail)
        if kind == "percentile":
            return low, high
        unit = of_study[1][0] if kind == "studentised" else 1.0
        return of_study[0][0] - high * unit, of_study[0][0] - low * unit  # Eq. 210


def bootstrap(
    counts: Counts, original: FittedCurves, scale: LogScale, kind: Resampling, repetitions: int, seed: int
) -> BootstrapSample:
    """Repeat a study many times, and fit every repetition in the same way as the study."""
    probability = curve_probability(original, scale, counts.levels)
    failures, trials = resample(counts, probability, kind, repetitions, seed)
    curves = find_curves(counts.levels, scale, failures, trials, penalised=bool(original.penalised[0]))
    if kind == "clusters":
        curves = with_cluster_errors(counts, scale, curves, _sampled_clusters(counts, repetitions, seed))
        original = with_cluster_errors(counts, scale, original, counts.distinct_clusters[1][None])
    return BootstrapSample(curves, original, scale, kind)


def curve_probability(curves: FittedCurves, scale: LogScale, levels: FloatArray) -> FloatArray:
    """Return the probability of failure of the first curve at levels."""
    return np.asarray(ndtr(curves.theta[0, 0] + curves.theta[0, 1] * scale.position(levels)))  # Eq. 190


def _order_statistic(values: FloatArray, probability: float) -> FloatArray:
    """Return the quantile of the rows at a probability, rounded outwards (B + 1 equal intervals)."""
    index = int(np.floor(probability * (values.shape[0] + 1))) - 1  # Eq. 211
    if index < 0:
        return np.full(values.shape[1], -np.inf)
    return np.asarray(np.partition(values, index, axis=0)[index])


@dataclass(frozen=True, eq=False)
class CapacitySample:
    """Studies repeated with sampled lognormal capacities, one per record."""

    levels: FloatArray  # levels of every record
    original: FittedCurves  # the curve of the study (one row)
    scale: LogScale  # scale of its coefficients
    variates: FloatArray  # standard normal variates of the capacities, one row per repetition
    kind = "capacities"
    ends = "inverted"
    undetermined = 0

    @property
    def repetitions(self) -> int:
        """Number of repeated studies."""
        return int(self.variates.shape[0])

    @cached_property
    def _log_curve(self) -> tuple[float, float]:
        """Logarithms of median and dispersion of the study."""
        a, b = self.original.theta[0].tolist()
        return float(self.scale.log_level(np.array(-a / b))), math.log(self.scale.spread / b)

    def rarity(self, variate: float | None, value: float) -> float:
        """Return the fraction of repetitions with a smaller estimate, for a value of a logarithmic parameter."""
        # the other parameter is the maximum-likelihood value for known capacities, with n - 1 for n records; half of
        # the repetitions with an equal estimate count
        median, log_dispersion = self._log_curve
        if variate is None:
            slopes = self._repeated(median, math.exp(value))[:, 1]
            return _below(-slopes, -float(self.original.theta[0, 1]))
        spread, distance = math.exp(log_dispersion), value - median
        estimate = 0.5 * (math.hypot(variate * distance, 2.0 * math.hypot(spread, distance)) - variate * distance)
        records = self.variates.shape[1]
        dispersion = estimate * math.sqrt(records / (records - 1.0))
        at = (value - self.scale.center) / self.scale.spread
        theta = self._repeated(value - variate * dispersion, dispersion)
        # a curve above the fractile has a lower fractile
        return _below(-(theta[:, 0] + theta[:, 1] * at), -float(self.original.theta[0] @ (1.0, at)))  # Eq. 213

    def log_interval(self, variate: float | None, level: float) -> tuple[float, float]:
        """Return both ends of the interval of `log_quantity`; an interval is computed once."""
        if (variate, level) not in self._intervals:
            self._intervals[variate, level] = self._log_interval(variate, level)
        return self._intervals[variate, level]

    def _log_interval(self, variate: float | None, level: float) -> tuple[float, float]:
        (median, log_dispersion), records = self._log_curve, self.variates.shape[1]
        start = log_dispersion if variate is None else median + variate * math.exp(log_dispersion)
        # approximate ends are slightly wider than the ends for known capacities
        error = (
            math.sqrt(0.5) if variate is None else math.exp(log_dispersion) * math.hypot(1.0, math.sqrt(0.5) * variate)
        )
        tail = 0.5 * (1.0 - level)
        step = -float(ndtri(tail)) * (1.0 + 2.0 / records) / math.sqrt(records) * error
        low = _end(lambda value: 1.0 - self.rarity(variate, value), start, -step, tail)  # Eq. 213
        return low, _end(lambda value: self.rarity(variate, value), start, step, tail)

    def variate_band(self, position: FloatArray, level: float) -> tuple[FloatArray, FloatArray]:
        """Return pointwise ends of the variate a + b u of the probability, from the ends of fractiles."""
        ends = np.array([self.log_interval(variate, level) for variate in NODES])
        at = self.scale.log_level(position)
        # a level is the upper end of the fractile with the smallest probability of the level
        low, high = _along(at, ends[:, 1]), _along(at, ends[:, 0])
        return np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)

    def _repeated(self, median: float, dispersion: float) -> FloatArray:
        """Return a and b of the repeated studies, for a logarithmic median and a dispersion of the capacities."""
        failures = np.count_nonzero(dispersion * self.variates[:, :, None] < np.log(self.levels) - median, axis=1)
        rows, inverse = np.unique(failures, axis=0, return_inverse=True)
        keys = [row.tobytes() for row in rows]
        new = [k for k, key in enumerate(keys) if key not in self._curves]
        if new:
            self._curves.update(zip([keys[k] for k in new], self._fitted(rows[new]), strict=True))
        return np.array([self._curves[key] for key in keys])[inverse.ravel()]

    @cached_property
    def _intervals(self) -> dict[tuple[float | None, float], tuple[float, float]]:
        return {}

    @cached_property
    def _curves(self) -> dict[bytes, FloatArray]:
        """Curves by the failures at all levels. For few records, equal failures occur often."""
        return {}

    def _fitted(self, rows: IntArray) -> FloatArray:
        failures, trials = rows.astype(np.float64), np.full(rows.shape, float(self.variates.shape[1]))
        curves = find_curves(self.levels, self.scale, failures, trials, penalised=bool(self.original.penalised[0]))
        # with equal failures at all levels, the curve does not rise
        flat = np.stack([ndtri(np.mean(failures / trials, axis=1)), np.zeros(len(rows))], axis=1)
        return np.asarray(np.where(curves.exists[:, None], curves.theta, flat))


def draw_capacities(
    counts: Counts, original: FittedCurves, scale: LogScale, repetitions: int, seed: int
) -> CapacitySample:
    """Return the sample for the bootstrap of a study with one capacity per record."""
    checks.within("repetitions", repetitions, 1, 10**6)
    if not counts.tries_all_levels:
        raise InvalidValueError("kind='capacities' needs two or more records in clusters=, each once at every level")
    variates = np.random.default_rng(seed).standard_normal((repetitions, counts.clusters))
    return CapacitySample(counts.levels, original, scale, variates)


def _below(estimates: FloatArray, original: float) -> float:
    near = 1e-9 * (1.0 + abs(original))
    less, equal = np.count_nonzero(estimates < original - near), np.count_nonzero(np.abs(estimates - original) <= near)
    return float((less + 0.5 * equal) / estimates.size)


def _end(rarity: Callable[[float], float], start: float, step: float, tail: float) -> float:
    """Return the value at which a fraction that decreases from 0.5 reaches a tail probability, or infinity."""
    # variates of such fractions are nearly linear; variates have a lower limit, and steps are limited to 0.1 to 0.9
    lowest, goal = ndtri(np.array([0.05 * tail, tail])).tolist()
    inside, above, near = start, 0.0, NEAR * abs(step)
    for _ in range(OUTWARD):
        last = outside = inside + step
        below = max(ndtri(rarity(outside)), lowest)
        if below < goal:
            break
        inside, above, step = outside, below, 2.0 * step
    else:
        return math.copysign(math.inf, step)
    while True:
        middle = inside + min(max((above - goal) / (above - below), 0.1), 0.9) * (outside - inside)
        if abs(middle - last) <= near:
            return float(middle)
        last, variate = middle, max(ndtri(rarity(middle)), lowest)
        if variate < goal:
            outside, below = middle, variate
        else:
            inside, above = middle, variate


def _along(at: FloatArray, ends: FloatArray) -> FloatArray:
    """Return variates by linear interpolation between the nodes, and by extrapolation if the ends are not open."""
    closed = np.isfinite(ends)
    if closed.sum() < 2:
        return np.full(at.shape, np.nan)
    x, y = np.maximum.accumulate(ends[closed]), np.array(NODES)[closed]
    variates = np.asarray(np.interp(at, x, y))
    for end, near, beyond in ((0, 1, at < x[0]), (-1, -2, at > x[-1])):
        if closed[end] and x[end] != x[near]:
            variates = np.where(beyond, y[end] + (y[near] - y[end]) / (x[near] - x[end]) * (at - x[end]), variates)
    return variates
