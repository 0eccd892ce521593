"""Differences between two results of a study: changed verdicts with intervals, and changes of values."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, percent
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome
from rocking.statistics.counts import share_interval
from rocking.statistics.lognormal import difference_extremes
from rocking.statistics.maximum_likelihood import LogScale, find_curves, log_dispersion, log_fractile

if TYPE_CHECKING:
    import xarray as xr

UNKNOWN = 2  # value in a map of flips if one of the two histories could not be computed
LEVEL = 0.95  # confidence level of the intervals [-]
_SIGNED = "peak_rotation"


@dataclass(frozen=True)
class Flips:
    """Numbers of histories with different verdicts (overturned or not) in two results."""

    count: int  # number of different verdicts
    only_second: int  # number of histories that overturn only in the second result
    compared: int  # number of histories with a verdict in both results
    unknown: int  # number of histories that failed in one of the results
    # 95 % interval of the fraction for other motions or samples of the same kind [-]; NaN without motions and samples,
    # because the cells of a grid are not a random sample
    fraction_low: float
    fraction_high: float
    # number of independent motions for the interval; 0 if all histories are independent, or without an interval
    clusters: int = 0

    @property
    def fraction(self) -> float:
        """Fraction of different verdicts among the compared histories [-]."""
        return self.count / self.compared

    @property
    def only_first(self) -> int:
        """Number of histories that overturn only in the first result."""
        return self.count - self.only_second


def flips_of(first: Any, second: Any, motions: Any = None, *, sampled: bool = False) -> Flips:
    """Return the number of different verdicts between two results, with a 95 % interval if defined."""
    sign = flip_map(first, second)
    has_verdicts = sign != UNKNOWN
    compared = int(has_verdicts.sum())
    if not compared:
        raise InvalidValueError(
            "no verdicts to compare: all {count} histories failed in one of the two results", count=sign.size
        )
    flipped = np.abs(sign[has_verdicts])
    count, only_second = int(flipped.sum()), int((sign == 1).sum())
    groups = None if motions is None else np.broadcast_to(np.asarray(motions), sign.shape)[has_verdicts]
    size, clusters = _effective(flipped, groups)
    low, high = share_interval(count / compared * size, size) if clusters or sampled else (np.nan, np.nan)
    return Flips(count, only_second, compared, sign.size - compared, low, high, clusters)


def flip_map(first: Any, second: Any) -> np.ndarray:
    """Return 0 for equal verdicts, 1 (-1) if only the second (first) overturned, and 2 without a verdict."""
    a, b = _codes(first), _codes(second)
    if a.shape != b.shape:
        raise InvalidValueError(
            "results to compare must be of one shape, got {first} and {second}", first=a.shape, second=b.shape
        )
    over, failed = Outcome.OVERTURNED.code, Outcome.FAILED.code
    sign = (b == over).astype(np.int8) - (a == over).astype(np.int8)
    return np.where((a == failed) | (b == failed), np.int8(UNKNOWN), sign)


def difference_of(first: "xr.Dataset", second: "xr.Dataset", name: str) -> "xr.DataArray":
    """Return second value minus first value (absolute peaks); NaN unless both histories are without overturning."""
    if name == "verdict":
        flag = "-1 overturned in the baseline only, 0 same verdict, 1 overturned only here, 2 one of the two failed"
        flips = first["outcome"].copy(data=flip_map(first["outcome"].values, second["outcome"].values))
        return flips.rename("verdict").assign_attrs(units="1", long_name=flag)
    names = sorted(str(k) for k, v in first.data_vars.items() if v.dtype.kind in "if" and k in second)
    if name not in names:
        raise InvalidValueError(parameter="name", allowed=f"verdict or one of {', '.join(names)}", value=name)
    upright = [~result["outcome"].isin([Outcome.OVERTURNED.code, Outcome.FAILED.code]) for result in (first, second)]
    before, after = (result[name].astype(np.float64) for result in (first, second))
    label = name
    if name == _SIGNED:  # absolute values, so that the difference of 0.1 to the right and 0.1 to the left is 0
        before, after, label = abs(before), abs(after), f"the absolute {name}"
    difference = after - before
    units = first[name].attrs.get("units", "1")
    kept: xr.DataArray = difference.where(upright[0] & upright[1]).rename(name)
    return kept.assign_attrs(units=units, long_name=f"difference of {label}; missing if either overturned or failed")


def _codes(values: Any) -> np.ndarray:
    codes = np.asarray(values)
    if codes.dtype.kind not in "iu" or (codes.size and not 0 <= codes.min() <= codes.max() < len(Outcome)):
        raise InvalidValueError(
            parameter="verdicts", allowed=f"codes of outcomes in [0, {len(Outcome) - 1}]", value=values
        )
    return codes


def _effective(flipped: FloatArray, groups: np.ndarray | None) -> tuple[float, int]:
    """Return the effective number of independent histories, and the number of motions."""
    from scipy.special import stdtrit

    # Korn & Graubard 1998 (Survey Methodology 24:193): size whose binomial variance is the variance between motions
    if groups is None:
        return float(flipped.size), 0
    _, cluster, counts = np.unique(groups, return_inverse=True, return_counts=True)
    clusters, fraction = counts.size, float(flipped.mean())
    if clusters < 2:
        return float(flipped.size), 0
    if fraction in {0.0, 1.0}:
        return float(clusters), clusters
    excess = np.bincount(cluster, flipped - fraction)
    variance = clusters / (clusters - 1) * float(excess @ excess) / flipped.size**2
    size = fraction * (1.0 - fraction) / variance if variance > 0.0 else float(flipped.size)  # Eq. 188
    # correction for a variance that is estimated from few motions
    few, many = stdtrit(np.array([clusters, flipped.size]) - 1, 0.5 * (1.0 + LEVEL))
    return min(max(size * float((many / few) ** 2), 1.0), float(flipped.size)), clusters


_FEWEST = 0.975
_WEIGHTS = 4_000_000


@dataclass(frozen=True)
class Change:
    """A number with its 95 % interval from resampled motions."""

    value: float  # the number
    # ends of the interval; None if more than 2.5 % of the resampled sets have no curve
    interval: tuple[float, float] | None


@dataclass(frozen=True)
class CurveChange:
    """Differences between two lognormal fragility curves."""

    median: Change  # second median over first median [-]
    dispersion: Change  # second dispersion minus first dispersion [-]
    # largest absolute difference of the probabilities [-]; its interval never contains zero
    distance: Change
    level: float  # level of the largest difference [unit of the measure]
    repetitions: int  # number of resampled sets of motions, common to both curves
    without_curve: int  # number of sets in which a curve is missing

    def text(self, unit: str, size: float = 1.0) -> str:
        """Return the changes as a phrase, with levels in a unit of the measure. `size` is the size of this unit."""
        formatted = "{:+.3f}".format
        ends = self.median.interval
        median = None if ends is None else (ends[0] - 1.0, ends[1] - 1.0)
        return (
            f"the median changes by {signed(self.median.value - 1.0)} ({_interval(median, signed)}), "
            f"the dispersion by {formatted(self.dispersion.value)} ({_interval(self.dispersion.interval, formatted)}), "
            f"the probability by at most {self.distance.value:.3f} "
            f"({_interval(self.distance.interval, '{:.3f}'.format)}) at {self.level / size:.4g} {unit}"
        )


def signed(fraction: float) -> str:
    """Return a fraction [-] in percent with its sign."""
    return ("+" if fraction >= 0.0 else "") + percent(fraction)


def _interval(ends: tuple[float, float] | None, formatted: Callable[[float], str]) -> str:
    return "no interval" if ends is None else f"95 % interval {formatted(ends[0])} to {formatted(ends[1])}"


def curve_change(
    curves: tuple[tuple[float, float], tuple[float, float]],
    levels: Any,
    first: Any,
    second: Any,
    *,
    repetitions: int = 1000,
    seed: int = 0,
) -> CurveChange:
    """Return the differences between two fragility curves (median, dispersion), with 95 % intervals."""
    # The intervals result from motions sampled with replacement. Both curves of a repetition are fitted to the same
    # motions, so that common effects of the motions cancel.
    at = checks.positive_array("levels", levels)
    if at.ndim != 1 or at.size < 2:
        raise InvalidValueError(parameter="levels", allowed="two or more numbers", value=levels)
    checks.increasing("levels", at)
    hits = [_indicators(name, values, at.size) for name, values in (("first", first), ("second", second))]
    if hits[0].shape != hits[1].shape:
        raise InvalidValueError(
            "both results must be of the same motions, got {first} and {second}", first=hits[0].shape,
            second=hits[1].shape,
        )  # fmt: skip
    values = [checks.positive("median or dispersion", value) for curve in curves for value in curve]
    log_median, dispersion = np.log(values[::2]), np.array(values[1::2])
    curves_of_samples = _resampled_curves(at, hits, int(checks.within("repetitions", repetitions, 0, 1_000_000)), seed)
    good = np.isfinite(curves_of_samples).all(axis=(0, 1))
    enough = int(good.sum()) >= max(_FEWEST * good.size, 1)
    samples = _differences(curves_of_samples[:, 0, good], curves_of_samples[:, 1, good])
    changes = [
        Change(float(value), tuple(np.quantile(sample, [0.025, 0.975]).tolist()) if enough else None)
        for value, sample in zip(_differences(log_median, dispersion), samples, strict=True)
    ]
    level = float(np.exp(curve_distance(log_median, dispersion)[1]))
    return CurveChange(changes[0], changes[1], changes[2], level, good.size, good.size - int(good.sum()))


def _differences(log_median: FloatArray, dispersion: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return ratio of medians, difference of dispersions and largest distance for pairs of curves."""
    ratio = np.exp(log_median[1] - log_median[0])
    return ratio, dispersion[1] - dispersion[0], curve_distance(log_median, dispersion)[0]


def curve_distance(log_median: FloatArray, dispersion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the largest vertical distance between pairs of lognormal curves [-], and the ln of the level."""
    from scipy.special import ndtr

    (m, n), (s, t) = log_median, dispersion
    log_levels = difference_extremes(log_median, dispersion)
    distances = np.abs(ndtr((log_levels - m) / s) - ndtr((log_levels - n) / t))
    best = distances.argmax(axis=0)[np.newaxis]
    return np.take_along_axis(distances, best, 0)[0], np.take_along_axis(log_levels, best, 0)[0]


def fits(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> FloatArray:
    """Return ln of the median, and dispersion, of many sets of stripes; NaN if there is no curve."""
    x = np.log(levels)
    scale = LogScale(float(x.mean()), float(x.std()))
    theta = find_curves(levels, scale, failures, trials).theta
    return np.array([log_fractile(theta, scale, 0.0), np.exp(log_dispersion(theta, scale))])


def _resampled_curves(levels: FloatArray, hits: list[FloatArray], repetitions: int, seed: int) -> FloatArray:
    """Return curves of resampled motions, of shape (2 curves, median and dispersion, repetitions)."""
    motions, random = len(hits[0]), np.random.default_rng(seed)
    has_results = np.isfinite(hits[0]) & np.isfinite(hits[1])
    tables = [has_results.astype(np.float64), *(np.where(has_results, values, 0.0) for values in hits)]
    counts = np.empty((len(tables), repetitions, levels.size))
    probabilities, size = np.full(motions, 1.0 / motions), max(1, _WEIGHTS // motions)
    for first in range(0, repetitions, size):  # samples do not depend on the size of the pieces
        last = min(first + size, repetitions)
        weights = random.multinomial(motions, probabilities, size=last - first).astype(np.float64)
        for sums, table in zip(counts, tables, strict=True):
            sums[first:last] = weights @ table
    return np.array([fits(levels, reached, counts[0]) for reached in counts[1:]])


def _indicators(name: str, values: Any, levels: int) -> FloatArray:
    indicators = np.asarray(values, dtype=np.float64)
    if indicators.ndim != 2 or indicators.shape[1] != levels or not len(indicators):
        raise InvalidValueError(
            "{parameter} must be of shape (motions, {levels} levels), got {shape}", parameter=name, levels=levels,
            shape=indicators.shape,
        )  # fmt: skip
    if not np.isin(indicators[np.isfinite(indicators)], (0.0, 1.0)).all():
        raise InvalidValueError("{parameter} must be 0 or 1 (NaN for a history that failed)", parameter=name)
    return indicators
