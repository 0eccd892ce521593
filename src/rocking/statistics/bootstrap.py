"""Bootstrap: the study repeated many times on the computer, all repetitions fitted at once."""

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

OUTWARD = 6  # steps that look for a value outside the interval, each twice as long: an end beyond them is open

NEAR = 0.05
"""An end is taken from a line whose last two places are this part of the first step apart: far nearer than that."""

NODES = (-3.0, -1.5, -0.7, 0.0, 0.7, 1.5, 3.0)  # variates whose fractiles bound a band; between them it is interpolated


def resample(
    counts: Counts, probability: FloatArray, kind: Resampling, repetitions: int, seed: int
) -> tuple[FloatArray, FloatArray]:
    """Return failures and trials that might have been found instead, one row a data set, one column a level."""
    checks.within("repetitions", repetitions, 1, 10**7)
    random = np.random.default_rng(seed)
    if kind == "parametric":
        trials = np.broadcast_to(counts.trials, (repetitions, counts.levels.size))
        return random.binomial(trials.astype(np.int64), probability).astype(np.float64), trials  # Eq. 208
    if kind == "cases":
        cells = np.concatenate([counts.failures, counts.survivals]) / counts.trials.sum()
        drawn = random.multinomial(counts.observations, cells, size=repetitions).astype(np.float64)
        failures, survivals = np.split(drawn, 2, axis=1)
        return failures, failures + survivals
    if kind != "clusters":
        raise InvalidValueError(
            "kind must be one of {kinds} or capacities, got {kind}",
            kinds=", ".join(get_args(Resampling)),
            kind=f"{kind!r}",
        )
    if counts.cluster_trials is None:
        raise InvalidValueError("kind must not be 'clusters' unless clusters= names the record of each outcome")
    if counts.scarcity:
        raise InvalidValueError(
            "{parameter} must not be 'clusters' for {clusters}: drawn again they repeat one another, and the interval "
            "would be far too narrow", parameter="kind", value="clusters", clusters=counts.scarcity,
            hint="take more records, or the profile interval with that caution",
        )  # fmt: skip
    failures, trials = np.split(_drawn_clusters(counts, repetitions, seed) @ counts.distinct_clusters[0], 2, axis=1)
    return failures, trials


def _drawn_clusters(counts: Counts, repetitions: int, seed: int) -> FloatArray:
    """Return how often each distinct cluster is drawn: a hundred thousand cost no more than their distinct outcomes."""
    share, number = counts.distinct_clusters[1], round(counts.distinct_clusters[1].sum())
    drawn = np.random.default_rng(seed).multinomial(number, share / share.sum(), size=repetitions)  # Eq. 209
    return drawn.astype(np.float64)


@dataclass(frozen=True, eq=False)
class BootstrapSample:
    """Curves of repeated studies, beside the one of the study itself.

    Repetitions whose outcomes form a step are fitted by the penalised likelihood. Those that no rising curve fits
    are taken to lie beyond both ends of every interval, so that they can only widen it.
    """

    curves: FittedCurves  # the curves of the repetitions
    original: FittedCurves  # the curve of the study: one row
    scale: LogScale  # scale of the coefficients
    kind: Resampling  # how the repetitions were drawn
    ends = "studentised"

    @property
    def repetitions(self) -> int:
        """Number of repeated studies."""
        return self.curves.found.size

    @property
    def undetermined(self) -> int:
        """Number of repeated studies that no rising curve fits."""
        return int(np.sum(~self.curves.found))

    @property
    def penalised(self) -> int:
        """Number of repeated studies fitted by the penalised likelihood."""
        return int(np.sum(self.curves.penalised & self.curves.found))

    def log_interval(self, variate: float | None, level: float, ends: Ends = "studentised") -> tuple[float, float]:
        """Return both ends of a variate's logarithmic fractile, without one of the logarithmic dispersion."""
        # they follow from the distances of the repetitions in standard errors, which is second-order accurate; as their
        # percentiles; or mirrored; and are infinite where the repetitions leave them open
        one, many = (
            (
                log_quantity(curves.theta, self.scale, variate)[:, None],
                standard_errors(curves.theta, curves.curvature, self.scale, variate)[:, None],
            )
            for curves in (self.original, self.curves)
        )
        low, high = self._ends(one, many, level, ends)
        return float(low[0]), float(high[0])

    def variate_band(
        self, position: FloatArray, level: float, ends: Ends = "studentised"
    ) -> tuple[FloatArray, FloatArray]:
        """Return pointwise ends of the variate a + b u of the probability."""
        slope = np.stack([np.ones_like(position), position], axis=1)
        one, many = (
            (
                curves.theta @ slope.T,
                np.stack([quadratic_error(row[None], curves.curvature) for row in slope], axis=1),
            )
            for curves in (self.original, self.curves)
        )
        return self._ends(one, many, level, ends)

    def _ends(self, one: Pair, many: Pair, level: float, ends: Ends) -> Pair:
        """Return both ends, column by column, from values and errors of the study and of the repetitions."""
        chosen = checks.one_of("ends", ends, get_args(Ends))
        distance = many[0] if chosen == "percentile" else many[0] - one[0]
        distance = distance / many[1] if chosen == "studentised" else distance  # Eq. 210
        found, tail = self.curves.found[:, None], 0.5 * (1.0 - level)
        low = _order_statistic(np.where(found, distance, -np.inf), tail)
        high = -_order_statistic(np.where(found, -distance, -np.inf), tail)
        if chosen == "percentile":
            return low, high
        unit = one[1][0] if chosen == "studentised" else 1.0
        return one[0][0] - high * unit, one[0][0] - low * unit  # Eq. 210


def bootstrap(
    counts: Counts, original: FittedCurves, scale: LogScale, kind: Resampling, repetitions: int, seed: int
) -> BootstrapSample:
    """Repeat a study many times and fit every repetition as the study itself was."""
    probability = curve_probability(original, scale, counts.levels)
    failures, trials = resample(counts, probability, kind, repetitions, seed)
    curves = find_curves(counts.levels, scale, failures, trials, penalised=bool(original.penalised[0]))
    if kind == "clusters":
        curves = with_cluster_errors(counts, scale, curves, _drawn_clusters(counts, repetitions, seed))
        original = with_cluster_errors(counts, scale, original, counts.distinct_clusters[1][None])
    return BootstrapSample(curves, original, scale, kind)


def curve_probability(curves: FittedCurves, scale: LogScale, levels: FloatArray) -> FloatArray:
    """Return the probability of failure of the first curve at levels."""
    return np.asarray(ndtr(curves.theta[0, 0] + curves.theta[0, 1] * scale.position(levels)))  # Eq. 190


def _order_statistic(values: FloatArray, share: float) -> FloatArray:
    """Return the value below which a share of the rows lie, rounded outwards (B + 1 points make B + 1 equal parts)."""
    place = int(np.floor(share * (values.shape[0] + 1))) - 1  # Eq. 211
    if place < 0:
        return np.full(values.shape[1], -np.inf)
    return np.asarray(np.partition(values, place, axis=0)[place])


@dataclass(frozen=True, eq=False)
class CapacitySample:
    """Studies repeated with capacities drawn from lognormal distributions, one for each record."""

    levels: FloatArray  # levels at which every record is tried
    original: FittedCurves  # the curve of the study: one row
    scale: LogScale  # scale of its coefficients
    variates: FloatArray  # standard normal variates of the capacities, one row a repetition, for every value tried
    kind = "capacities"
    ends = "inverted"
    undetermined = 0

    @property
    def repetitions(self) -> int:
        """Number of repeated studies."""
        return int(self.variates.shape[0])

    @cached_property
    def _found(self) -> tuple[float, float]:
        """Logarithms of median and dispersion of the study."""
        a, b = self.original.theta[0].tolist()
        return float(self.scale.log_level(np.array(-a / b))), math.log(self.scale.spread / b)

    def rarity(self, variate: float | None, value: float) -> float:
        """Return how often the study would find less than it did, had a logarithmic parameter some value."""
        # the other parameter is then the likeliest one of capacities that are all known, with records less one for
        # records; half of the repetitions that find the same count
        median, log_dispersion = self._found
        if variate is None:
            slopes = self._repeated(median, math.exp(value))[:, 1]
            return _below(-slopes, -float(self.original.theta[0, 1]))
        spread, away = math.exp(log_dispersion), value - median
        likely = 0.5 * (math.hypot(variate * away, 2.0 * math.hypot(spread, away)) - variate * away)
        records = self.variates.shape[1]
        dispersion = likely * math.sqrt(records / (records - 1.0))
        at = (value - self.scale.center) / self.scale.spread
        theta = self._repeated(value - variate * dispersion, dispersion)
        # a curve that is high where the fractile should be has a low fractile
        return _below(-(theta[:, 0] + theta[:, 1] * at), -float(self.original.theta[0] @ (1.0, at)))  # Eq. 213

    def log_interval(self, variate: float | None, level: float) -> tuple[float, float]:
        """Return both ends of a variate's logarithmic fractile, without one of the logarithmic dispersion."""
        (median, log_dispersion), records = self._found, self.variates.shape[1]
        start = log_dispersion if variate is None else median + variate * math.exp(log_dispersion)
        # about where the ends are: as of known capacities, a little wider
        error = (
            math.sqrt(0.5) if variate is None else math.exp(log_dispersion) * math.hypot(1.0, math.sqrt(0.5) * variate)
        )
        tail = 0.5 * (1.0 - level)
        step = -float(ndtri(tail)) * (1.0 + 2.0 / records) / math.sqrt(records) * error
        low = _end(lambda value: 1.0 - self.rarity(variate, value), start, -step, tail)  # Eq. 213
        return low, _end(lambda value: self.rarity(variate, value), start, step, tail)

    def variate_band(self, position: FloatArray, level: float) -> tuple[FloatArray, FloatArray]:
        """Return pointwise ends of the variate a + b u of the probability: where fractiles have their ends."""
        ends = np.array([self.log_interval(variate, level) for variate in NODES])
        at = self.scale.log_level(position)
        # a level is the upper end of the fractile that is the least probability which it may have
        low, high = _along(at, ends[:, 1]), _along(at, ends[:, 0])
        return np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)

    def _repeated(self, median: float, dispersion: float) -> FloatArray:
        """Return a and b of the repeated studies, if capacities had this logarithmic median and this dispersion."""
        failures = np.count_nonzero(dispersion * self.variates[:, :, None] < np.log(self.levels) - median, axis=1)
        rows, which = np.unique(failures, axis=0, return_inverse=True)
        keys = [row.tobytes() for row in rows]
        new = [place for place, key in enumerate(keys) if key not in self._curves]
        if new:
            self._curves.update(zip([keys[place] for place in new], self._fitted(rows[new]), strict=True))
        return np.array([self._curves[key] for key in keys])[which.ravel()]

    @cached_property
    def _curves(self) -> dict[bytes, FloatArray]:
        """Curves by the failures at each level: of few records the same ones come again and again."""
        return {}

    def _fitted(self, rows: IntArray) -> FloatArray:
        failed, tried = rows.astype(np.float64), np.full(rows.shape, float(self.variates.shape[1]))
        curves = find_curves(self.levels, self.scale, failed, tried, penalised=bool(self.original.penalised[0]))
        # as many failures at every level: a curve that does not rise
        flat = np.stack([ndtri(np.mean(failed / tried, axis=1)), np.zeros(len(rows))], axis=1)
        return np.asarray(np.where(curves.found[:, None], curves.theta, flat))


def draw_capacities(
    counts: Counts, original: FittedCurves, scale: LogScale, repetitions: int, seed: int
) -> CapacitySample:
    """Return what repeats a study whose records have one capacity each."""
    checks.within("repetitions", repetitions, 1, 10**6)
    if not counts.tries_all_levels:
        raise InvalidValueError(
            "kind must not be 'capacities' unless clusters= names two records or more, each tried once at every level"
        )
    variates = np.random.default_rng(seed).standard_normal((repetitions, counts.clusters))
    return CapacitySample(counts.levels, original, scale, variates)


def _below(found: FloatArray, original: float) -> float:
    near = 1e-9 * (1.0 + abs(original))
    less, same = np.count_nonzero(found < original - near), np.count_nonzero(np.abs(found - original) <= near)
    return float((less + 0.5 * same) / found.size)


def _end(rarity: Callable[[float], float], start: float, step: float, tail: float) -> float:
    """Return where a share that falls from a half at the start on reaches that of a tail; infinite if it never does."""
    # variates of such shares are nearly straight lines; none counts as far out, and a tenth is always left
    least, goal = ndtri(np.array([0.05 * tail, tail])).tolist()
    inside, above, near = start, 0.0, NEAR * abs(step)
    for _ in range(OUTWARD):
        last = outside = inside + step
        below = max(ndtri(rarity(outside)), least)
        if below < goal:
            break
        inside, above, step = outside, below, 2.0 * step
    else:
        return math.copysign(math.inf, step)
    while True:
        middle = inside + min(max((above - goal) / (above - below), 0.1), 0.9) * (outside - inside)
        if abs(middle - last) <= near:
            return float(middle)
        last, found = middle, max(ndtri(rarity(middle)), least)
        if found < goal:
            outside, below = middle, found
        else:
            inside, above = middle, found


def _along(at: FloatArray, places: FloatArray) -> FloatArray:
    """Return the variate at each place: straight lines between the nodes, and beyond them unless they end open."""
    some = np.isfinite(places)
    if some.sum() < 2:
        return np.full(at.shape, np.nan)
    x, y = np.maximum.accumulate(places[some]), np.array(NODES)[some]
    found = np.asarray(np.interp(at, x, y))
    for end, near, beyond in ((0, 1, at < x[0]), (-1, -2, at > x[-1])):
        if some[end] and x[end] != x[near]:
            found = np.where(beyond, y[end] + (y[near] - y[end]) / (x[near] - x[end]) * (at - x[end]), found)
    return found
