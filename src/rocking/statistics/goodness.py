"""Whether a lognormal curve agrees with the outcomes: statistics whose p-values come from refitted simulations."""

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

Ends = tuple[float | None, float | None]  # both ends of an interval; None where it is open

STATISTICS = {
    "deviance": "twice the log likelihood lost against a curve free at every level",
    "pearson": "sum over levels of squared differences over variances",
    "hosmer_lemeshow": "the same over groups of neighbouring levels",
    "kolmogorov": "largest distance between the share of failures in a group and the curve",
}
"""Statistics of the goodness of fit, and what they are."""

REPETITIONS, FEWEST = 1000, 99  # data sets that are drawn from a curve for its p-values, and how few will do
MOST_DRAWN = 2_000_000  # levels times data sets that are drawn for p-values without being asked for: seconds of work
MOST_REPEATED = 50_000_000  # levels times data sets of a bootstrap that are held at once: about a gigabyte
_NONE = (math.nan, math.nan)


class Statistic(NamedTuple):
    """A measure of disagreement."""

    value: float  # the measure; zero for perfect agreement [-]
    # share of data sets drawn from the curve, refitted, that disagree as much: small where the curve is wrong [-]
    p_value: float


@dataclass(frozen=True, eq=False)
class Goodness:
    """Agreement of a curve with the outcomes it was fitted to."""

    # twice the log likelihood lost against a curve free at every level; tells little with few trials a level
    deviance: Statistic
    pearson: Statistic  # sum over levels of squared differences over variances
    hosmer_lemeshow: Statistic  # the same over groups of neighbouring levels, which suits single observations
    kolmogorov: Statistic  # largest distance between the share of failures in a group and the curve
    lower: FloatArray  # lower, upper: lowest and highest level of each group [unit of the levels]
    upper: FloatArray
    trials: FloatArray  # trials, observed, expected: trials, failures, and failures by the curve in each group [-]
    observed: FloatArray
    expected: FloatArray
    # where 95 % of the shares of failures in each group fall that the curve would give [-]
    band: tuple[FloatArray, FloatArray]
    distance_limit: float  # largest distance that 95 % of data sets drawn from the curve stay below [-]
    repetitions: int  # number of data sets drawn whose refit succeeded

    def summary(self) -> dict[str, Any]:
        """Return value and p-value of each statistic [-]."""
        return {name: getattr(self, name)._asdict() for name in STATISTICS}


def goodness_of(
    counts: Counts, curves: FittedCurves, scale: LogScale, groups: int, repetitions: int, seed: int
) -> Goodness:
    """Return how well a curve agrees with the outcomes."""
    if groups < 2 or repetitions < 20:
        raise InvalidValueError(
            "groups must be >= 2 and repetitions >= 20, got {groups} and {repetitions}", groups=groups,
            repetitions=repetitions,
        )  # fmt: skip
    position = scale.position(counts.levels)
    own = ndtr(curves.theta[:, :1] + curves.theta[:, 1:] * position)
    failures, trials = resample(counts, own[0], "parametric", repetitions, seed)
    drawn = find_curves(counts.levels, scale, failures, trials, penalised=bool(curves.penalised[0]))
    fitted = np.flatnonzero(drawn.found)
    if fitted.size < 0.5 * repetitions:
        raise InvalidValueError(
            "half of {repetitions} repetitions must be refitted, got {fitted}", repetitions=repetitions,
            fitted=fitted.size, hint="too few trials",
        )  # fmt: skip
    theta, failures, trials = drawn.theta[fitted], failures[fitted], trials[fitted]
    member = group_of(counts.trials, groups)
    simulated = _statistics(failures, trials, ndtr(theta[:, :1] + theta[:, 1:] * position), member)
    found = _statistics(counts.failures[None], counts.trials[None], own, member)
    # discrete statistics tie, but for rounding
    beyond = [int(np.sum(s >= f[0] * (1.0 - 1e-9))) for s, f in zip(simulated, found, strict=True)]
    tests = [Statistic(float(f[0]), (1 + n) / (1 + fitted.size)) for f, n in zip(found, beyond, strict=True)]  # Eq. 226
    first = np.flatnonzero(np.diff(member, prepend=-1))
    total, observed = np.add.reduceat(counts.trials, first), np.add.reduceat(counts.failures, first)
    shares = np.add.reduceat(failures, first, axis=1) / total
    return Goodness(
        tests[0], tests[1], tests[2], tests[3],
        counts.levels[first], counts.levels[np.append(first[1:], member.size) - 1], total, observed,
        np.add.reduceat(counts.trials * own[0], first),
        (np.quantile(shares, 0.025, axis=0), np.quantile(shares, 0.975, axis=0)),
        float(np.quantile(simulated[3], 0.95)), int(fitted.size),
    )  # fmt: skip


def group_of(trials: FloatArray, groups: int) -> IntArray:
    """Return the group of each level: groups of neighbours hold about equally many trials."""
    if trials.size <= groups:
        return np.arange(trials.size)
    middle = (np.cumsum(trials) - 0.5 * trials) / trials.sum()
    return np.asarray(np.minimum((middle * groups).astype(np.int64), groups - 1))


def _statistics(z: FloatArray, n: FloatArray, p: FloatArray, member: IntArray) -> tuple[FloatArray, ...]:
    """Return deviance, Pearson's, Hosmer and Lemeshow's and Kolmogorov's statistics, one row a data set."""
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

    # value and p-value of each of `STATISTICS`; NaN where there is none [-]
    numbers: dict[str, tuple[float, float]] = field(default_factory=lambda: dict.fromkeys(STATISTICS, _NONE))
    words: str = ""  # what the p-values rest on, or why there is none


@dataclass(frozen=True, eq=False)
class Repeated:
    """Intervals from the study repeated many times."""

    # median_95, dispersion_95: ends of the 95 % intervals, None where one is open; None if there is no interval [as
    # median, dispersion]
    median_95: Ends | None = None
    dispersion_95: Ends | None = None
    # lower and upper ends of the 95 % intervals of the probability at the levels; None if there is none [-]
    band: tuple[FloatArray, FloatArray] | None = None
    words: str = ""  # how the study was repeated, or why there is none


def ends_of(interval: Ends | None) -> tuple[float, float]:
    """Return an interval as numbers: NaN where an end is open, or there is no interval.

    >>> ends_of((0.5, None)), ends_of(None)
    ((0.5, nan), (nan, nan))
    """
    low, high = (math.nan if end is None else end for end in interval or (None, None))
    return low, high


def agreement_of(fit: "LognormalFit", seed: int = 0) -> Agreement:
    """Return how well a curve agrees with its outcomes, where the p-values cost little."""
    levels = fit.counts.levels.size
    repetitions = min(REPETITIONS, MOST_DRAWN // levels)
    if repetitions < FEWEST:
        return Agreement(words=f"none: {levels} levels are too many to draw and refit; goodness() does it on request")
    try:
        found = fit.goodness(repetitions=repetitions, seed=seed)
    except InvalidValueError as error:
        return Agreement(words=f"none: {error}")
    words = f"p-values from {found.repetitions} data sets drawn from the curve and refitted, seed {seed}"
    if fit.counts.is_clustered:
        words += "; they take the outcomes of one motion for independent"
    return Agreement({name: tuple(getattr(found, name)) for name in STATISTICS}, words)


def repeated_of(fit: "LognormalFit", levels: FloatArray, repetitions: int, seed: int = 0) -> Repeated:
    """Return intervals of a curve from the bootstrap, or why there are none."""
    held = repetitions * max(fit.counts.levels.size, levels.size)
    if held > MOST_REPEATED:
        size = fit.counts.levels.size
        return Repeated(words=f"none: {repetitions} repetitions at {size} levels take too much memory; take fewer")
    how: dict[str, Any] = {"repetitions": repetitions, "seed": seed}
    try:
        sample = fit.bootstrap(**how)
        ends = [fit.interval(name, 0.95, "bootstrap", **how) for name in ("median", "dispersion")]
        band = fit.band(levels, 0.95, "bootstrap", **how)
    except InvalidValueError as error:
        return Repeated(words=f"none: {error}")
    words = f"{sample.kind}, {sample.repetitions} repetitions, seed {seed}, {sample.ends} ends"
    if sample.undetermined:
        words += f"; {sample.undetermined} repetitions have no rising curve and widen the intervals"
    median, dispersion = ((low if low > 0.0 else None, high if math.isfinite(high) else None) for low, high in ends)
    return Repeated(median, dispersion, band, words)
