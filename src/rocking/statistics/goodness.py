"""Goodness of fit of lognormal curves: statistics with p-values from refitted simulations."""

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.special import ndtr, xlogy

from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.statistics.bootstrap import resample
from rocking.statistics.counts import Counts
from rocking.statistics.maximum_likelihood import FittedCurves, LogScale, find_curves

if TYPE_CHECKING:
    from rocking.statistics.lognormal import LognormalFit

Ends = tuple[float | None, float | None]  # ends of an interval; None if open

STATISTICS = {
    "deviance": "twice the difference in log likelihood from a curve free at every level",
    "pearson": "sum over levels of squared differences over variances",
    "hosmer_lemeshow": "sum over groups of levels of squared differences over variances",
    "kolmogorov": "largest distance between the fraction of failures in a group and the curve",
}
"""Statistics of the goodness of fit, with descriptions."""

REPETITIONS, FEWEST = 1000, 99  # number of data sets simulated for p-values, and smallest allowed number
MOST_DRAWN = 2_000_000  # largest number of levels times data sets for default p-values, which takes seconds
MOST_REPEATED = 50_000_000  # largest number of levels times data sets of a bootstrap in memory, about 1 GB
_NONE = (math.nan, math.nan)


class Statistic(NamedTuple):
    """A measure of disagreement."""

    value: float  # value of the measure [-]; zero for perfect agreement
    # fraction of refitted simulated data sets with at least this disagreement [-]; small for a wrong curve
    p_value: float


@dataclass(frozen=True, eq=False)
class Goodness:
    """Agreement of a curve with the outcomes to which the curve was fitted."""

    # twice the difference in log likelihood to a curve that is free at every level; weak for few trials per level
    deviance: Statistic
    pearson: Statistic  # sum over levels of squared differences divided by variances
    hosmer_lemeshow: Statistic  # as pearson, but over groups of neighbouring levels, for single observations
    kolmogorov: Statistic  # largest distance between the fraction of failures in a group and the curve
    lower: FloatArray  # lower, upper: lowest and highest levels of the groups [unit of the levels]
    upper: FloatArray
    trials: FloatArray  # per group [-]: number of trials, observed failures, and failures expected from the curve
    observed: FloatArray
    expected: FloatArray
    # 95 % band that the curve predicts for the fraction of failures per group [-]
    band: tuple[FloatArray, FloatArray]
    distance_limit: float  # 95 % quantile of the largest distance in simulated data sets [-]
    repetitions: int  # number of refitted data sets

    def summary(self) -> dict[str, Any]:
        """Return values and p-values of all statistics [-]."""
        return {name: getattr(self, name)._asdict() for name in STATISTICS}


def goodness_of(
    counts: Counts, curves: FittedCurves, scale: LogScale, groups: int, repetitions: int, seed: int
) -> Goodness:
    """Return the goodness of fit of a curve."""
    if groups < 2 or repetitions < 20:
        raise InvalidValueError(
            "groups must be >= 2 and repetitions >= 20, got {groups} and {repetitions}", groups=groups,
            repetitions=repetitions,
        )  # fmt: skip
    position = scale.position(counts.levels)
    own = ndtr(curves.theta[:, :1] + curves.theta[:, 1:] * position)
    failures, trials = resample(counts, own[0], "parametric", repetitions, seed)
    refits = find_curves(counts.levels, scale, failures, trials, penalised=bool(curves.penalised[0]))
    fitted = np.flatnonzero(refits.exists)
    if fitted.size < 0.5 * repetitions:
        raise InvalidValueError(
            "at least half of the {repetitions} repetitions must have a fit, got {fitted}", repetitions=repetitions,
            fitted=fitted.size, hint="too few trials",
        )  # fmt: skip
    theta, failures, trials = refits.theta[fitted], failures[fitted], trials[fitted]
    member = group_of(counts.trials, groups)
    simulated = _statistics(failures, trials, ndtr(theta[:, :1] + theta[:, 1:] * position), member)
    actual = _statistics(counts.failures[None], counts.trials[None], own, member)
    # discrete statistics may be equal except for rounding
    beyond = [int(np.sum(s >= f[0] * (1.0 - 1e-9))) for s, f in zip(simulated, actual, strict=True)]
    tests = [
        Statistic(float(f[0]), (1 + n) / (1 + fitted.size)) for f, n in zip(actual, beyond, strict=True)
    ]  # Eq. 226
    first = np.flatnonzero(np.diff(member, prepend=-1))
    total, observed = np.add.reduceat(counts.trials, first), np.add.reduceat(counts.failures, first)
    fractions = np.add.reduceat(failures, first, axis=1) / total
    return Goodness(
        tests[0], tests[1], tests[2], tests[3],
        counts.levels[first], counts.levels[np.append(first[1:], member.size) - 1], total, observed,
        np.add.reduceat(counts.trials * own[0], first),
        (np.quantile(fractions, 0.025, axis=0), np.quantile(fractions, 0.975, axis=0)),
        float(np.quantile(simulated[3], 0.95)), int(fitted.size),
    )  # fmt: skip


def group_of(trials: FloatArray, groups: int) -> IntArray:
    """Return the group index of every level. Groups are neighbouring levels with about equal numbers of trials."""
    if trials.size <= groups:
        return np.arange(trials.size)
    middle = (np.cumsum(trials) - 0.5 * trials) / trials.sum()
    return np.asarray(np.minimum((middle * groups).astype(np.int64), groups - 1))


def _statistics(z: FloatArray, n: FloatArray, p: FloatArray, member: IntArray) -> tuple[FloatArray, ...]:
    """Return the statistics of deviance, Pearson, Hosmer and Lemeshow, and Kolmogorov, one row per data set."""
    p = np.clip(p, 1e-300, 1.0 - 1e-16)
    deviance = 2.0 * np.sum(xlogy(z, z / (n * p)) + xlogy(n - z, (n - z) / (n * (1.0 - p))), axis=1)  # Eq. 223
    pearson = np.sum((z - n * p) ** 2 / (n * p * (1.0 - p)), axis=1)  # Eq. 224
    first = np.flatnonzero(np.diff(member, prepend=-1))
    observed, expected, variance, total = (np.add.reduceat(v, first, axis=1) for v in (z, n * p, n * p * (1.0 - p), n))
    grouped = np.sum((observed - expected) ** 2 / variance, axis=1)  # Eq. 225
    return deviance, pearson, grouped, np.max(np.abs(observed - expected) / total, axis=1)  # Eq. 225


@dataclass(frozen=True)
class Agreement:
    """Goodness of fit as plain numbers."""

    # value and p-value of each of `STATISTICS`; NaN if missing [-]
    numbers: dict[str, tuple[float, float]] = field(default_factory=lambda: dict.fromkeys(STATISTICS, _NONE))
    basis: str = ""  # basis of the p-values, or reason of missing ones


@dataclass(frozen=True, eq=False)
class Repeated:
    """Intervals of a curve from the bootstrap."""

    # median_95, dispersion_95: ends of the 95 % intervals; None for an open end or a missing interval [units of
    # median and dispersion]
    median_95: Ends | None = None
    dispersion_95: Ends | None = None
    # lower and upper ends of the 95 % intervals of the probability at the levels, or None [-]
    band: tuple[FloatArray, FloatArray] | None = None
    basis: str = ""  # kind of the bootstrap, or reason for a missing bootstrap


def ends_of(interval: Ends | None) -> tuple[float, float]:
    """Return an interval as numbers. NaN means an open end or a missing interval.

    >>> ends_of((0.5, None)), ends_of(None)
    ((0.5, nan), (nan, nan))
    """
    low, high = (math.nan if end is None else end for end in interval or (None, None))
    return low, high


def agreement_of(fit: "LognormalFit", seed: int = 0) -> Agreement:
    """Return the goodness of fit of a curve, if the p-values can be computed quickly."""
    levels = fit.counts.levels.size
    repetitions = min(REPETITIONS, MOST_DRAWN // levels)
    if repetitions < FEWEST:
        return Agreement(basis=f"none: {levels} levels are too many for simulated p-values; use goodness()")
    try:
        goodness = fit.goodness(repetitions=repetitions, seed=seed)
    except InvalidValueError as error:
        return Agreement(basis=f"none: {error}")
    basis = f"p-values from {goodness.repetitions} data sets simulated with the curve and refitted, seed {seed}"
    if fit.counts.is_clustered:
        basis += "; they assume independent outcomes of each motion"
    return Agreement({name: tuple(getattr(goodness, name)) for name in STATISTICS}, basis)


def repeated_of(fit: "LognormalFit", levels: FloatArray, repetitions: int, seed: int = 0) -> Repeated:
    """Return intervals of a curve from the bootstrap, or the reason for missing intervals."""
    count = repetitions * max(fit.counts.levels.size, levels.size)
    if count > MOST_REPEATED:
        size = fit.counts.levels.size
        return Repeated(basis=f"none: {repetitions} repetitions at {size} levels need too much memory; use fewer")
    options: dict[str, Any] = {"repetitions": repetitions, "seed": seed}
    try:
        sample = fit.bootstrap(**options)
        ends = [fit.interval(name, 0.95, "bootstrap", **options) for name in ("median", "dispersion")]
        band = fit.band(levels, 0.95, "bootstrap", **options)
    except InvalidValueError as error:
        return Repeated(basis=f"none: {error}")
    basis = f"{sample.kind}, {sample.repetitions} repetitions, seed {seed}, {sample.ends} ends"
    if sample.undetermined:
        basis += f"; {sample.undetermined} repetitions have no rising curve and widen the intervals"
    median, dispersion = ((low if low > 0.0 else None, high if math.isfinite(high) else None) for low, high in ends)
    return Repeated(median, dispersion, band, basis)
