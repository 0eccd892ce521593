"""What differs between two results of the same study: verdicts that flip, how surely, and by how much values move."""

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

UNKNOWN = 2  # in a map of flips: no verdict, because one of the two histories could not be computed
LEVEL = 0.95  # confidence of the intervals [-]
_SIGNED = "peak_rotation"


@dataclass(frozen=True)
class Flips:
    """Histories whose verdict, overturned or not, differs between two results."""

    count: int  # histories whose verdict differs
    only_second: int  # those of them that overturn in the second result only; the others overturn in the first only
    compared: int  # histories with a verdict in both
    unknown: int  # histories that could not be computed in one of them
    # 95 % interval of the share: what other motions, or other draws, of the same kind may give; NaN where
    # there is neither, since the cells of a grid are no sample of anything [-]
    share_low: float
    share_high: float
    # motions that the histories belong to, which are what the interval takes for independent; 0 if it takes every
    # history for independent, or there is none
    clusters: int = 0

    @property
    def share(self) -> float:
        """Share of the compared histories whose verdict differs [-]."""
        return self.count / self.compared

    @property
    def only_first(self) -> int:
        """Histories that overturn in the first result only."""
        return self.count - self.only_second


def flips_of(first: Any, second: Any, motions: Any = None, *, drawn: bool = False) -> Flips:
    """Return how many verdicts differ between two results, with a 95 % interval of their share where there is one."""
    sign = flip_map(first, second)
    known = sign != UNKNOWN
    compared = int(known.sum())
    if not compared:
        raise InvalidValueError(
            "no verdicts to compare: all {count} histories failed in one of the two results", count=sign.size
        )
    flipped = np.abs(sign[known])
    count, only_second = int(flipped.sum()), int((sign == 1).sum())
    groups = None if motions is None else np.broadcast_to(np.asarray(motions), sign.shape)[known]
    size, clusters = _effective(flipped, groups)
    low, high = share_interval(count / compared * size, size) if clusters or drawn else (np.nan, np.nan)
    return Flips(count, only_second, compared, sign.size - compared, low, high, clusters)


def flip_map(first: Any, second: Any) -> np.ndarray:
    """Return 0 the same verdict, 1 overturned in the second only, -1 in the first only, 2 no verdict in one of them."""
    a, b = _codes(first), _codes(second)
    if a.shape != b.shape:
        raise InvalidValueError(
            "results to compare must be of one shape, got {first} and {second}", first=a.shape, second=b.shape
        )
    over, failed = Outcome.OVERTURNED.code, Outcome.FAILED.code
    sign = (b == over).astype(np.int8) - (a == over).astype(np.int8)
    return np.where((a == failed) | (b == failed), np.int8(UNKNOWN), sign)


def difference_of(first: "xr.Dataset", second: "xr.Dataset", name: str) -> "xr.DataArray":
    """Return second less first of a value, of peaks their sizes; NaN unless the history stood in both."""
    if name == "verdict":
        flag = "-1 overturned in the baseline only, 0 same verdict, 1 overturned only here, 2 one of the two failed"
        flips = first["outcome"].copy(data=flip_map(first["outcome"].values, second["outcome"].values))
        return flips.rename("verdict").assign_attrs(units="1", long_name=flag)
    names = sorted(str(k) for k, v in first.data_vars.items() if v.dtype.kind in "if" and k in second)
    if name not in names:
        raise InvalidValueError(parameter="name", allowed=f"verdict or one of {', '.join(names)}", value=name)
    stood = [~result["outcome"].isin([Outcome.OVERTURNED.code, Outcome.FAILED.code]) for result in (first, second)]
    before, after = (result[name].astype(np.float64) for result in (first, second))
    words = name
    if name == _SIGNED:  # 0.1 to the right and 0.1 to the left are no difference of 0.2
        before, after, words = abs(before), abs(after), f"the size of {name}"
    moved = after - before
    units = first[name].attrs.get("units", "1")
    kept: xr.DataArray = moved.where(stood[0] & stood[1]).rename(name)
    return kept.assign_attrs(units=units, long_name=f"difference of {words}; missing where either did not stand")


def _codes(values: Any) -> np.ndarray:
    codes = np.asarray(values)
    if codes.dtype.kind not in "iu" or (codes.size and not 0 <= codes.min() <= codes.max() < len(Outcome)):
        raise InvalidValueError(
            parameter="verdicts", allowed=f"codes of outcomes in [0, {len(Outcome) - 1}]", value=values
        )
    return codes


def _effective(flipped: FloatArray, groups: np.ndarray | None) -> tuple[float, int]:
    """Return how many independent histories tell as much about the share, and how many motions they belong to."""
    from scipy.special import stdtrit

    # Korn & Graubard 1998 (Survey Methodology 24:193): the size whose binomial variance is that between the motions
    if groups is None:
        return float(flipped.size), 0
    _, place, counts = np.unique(groups, return_inverse=True, return_counts=True)
    clusters, share = counts.size, float(flipped.mean())
    if clusters < 2:
        return float(flipped.size), 0
    if share in {0.0, 1.0}:
        return float(clusters), clusters
    excess = np.bincount(place, flipped - share)
    variance = clusters / (clusters - 1) * float(excess @ excess) / flipped.size**2
    size = share * (1.0 - share) / variance if variance > 0.0 else float(flipped.size)  # Eq. 188
    # for a variance estimated from few motions
    few, many = stdtrit(np.array([clusters, flipped.size]) - 1, 0.5 * (1.0 + LEVEL))
    return min(max(size * float((many / few) ** 2), 1.0), float(flipped.size)), clusters


_FEWEST = 0.975
_WEIGHTS = 4_000_000


@dataclass(frozen=True)
class Change:
    """A number with the 95 % interval that resampling the motions gives it."""

    value: float  # the number
    # ends; None where more than 2.5 % of the resampled sets have no curve, so that no interval can be claimed
    interval: tuple[float, float] | None


@dataclass(frozen=True)
class CurveChange:
    """What changes from one lognormal fragility curve to another."""

    median: Change  # second median over the first [-]
    dispersion: Change  # second dispersion less the first [-]
    # largest difference of the probabilities, without its sign [-]; zero is never inside its interval
    distance: Change
    level: float  # intensity at which it is largest, in the unit of the intensity measure
    repetitions: int  # sets of motions drawn, the same for both curves
    without_curve: int  # those of them for which one of the curves does not exist

    def told(self, unit: str, size: float = 1.0) -> str:
        """Return the changes as part of a sentence, in a unit of the intensity measure of some size."""
        shown = "{:+.3f}".format
        ends = self.median.interval
        median = None if ends is None else (ends[0] - 1.0, ends[1] - 1.0)
        return (
            f"the median changes by {signed(self.median.value - 1.0)} ({_interval(median, signed)}), "
            f"the dispersion by {shown(self.dispersion.value)} ({_interval(self.dispersion.interval, shown)}), "
            f"the probability by at most {self.distance.value:.3f} "
            f"({_interval(self.distance.interval, '{:.3f}'.format)}) at {self.level / size:.4g} {unit}"
        )


def signed(share: float) -> str:
    """Return a share [-] in percent with its sign."""
    return ("+" if share >= 0.0 else "") + percent(share)


def _interval(ends: tuple[float, float] | None, shown: Callable[[float], str]) -> str:
    return "no interval" if ends is None else f"95 % interval {shown(ends[0])} to {shown(ends[1])}"


def curve_change(
    curves: tuple[tuple[float, float], tuple[float, float]],
    levels: Any,
    first: Any,
    second: Any,
    *,
    repetitions: int = 1000,
    seed: int = 0,
) -> CurveChange:
    """Return what changes from one fragility curve (median, dispersion) to another, with 95 % intervals."""
    # The intervals come from motions drawn with replacement. Both curves of a repetition are fitted to the same
    # motions, so that what the motions have in common cancels.
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
    drawn = _drawn(at, hits, int(checks.within("repetitions", repetitions, 0, 1_000_000)), seed)
    good = np.isfinite(drawn).all(axis=(0, 1))
    enough = int(good.sum()) >= max(_FEWEST * good.size, 1)
    samples = _moved(drawn[:, 0, good], drawn[:, 1, good])
    changes = [
        Change(float(value), tuple(np.quantile(sample, [0.025, 0.975]).tolist()) if enough else None)
        for value, sample in zip(_moved(log_median, dispersion), samples, strict=True)
    ]
    level = float(np.exp(curve_distance(log_median, dispersion)[1]))
    return CurveChange(changes[0], changes[1], changes[2], level, good.size, good.size - int(good.sum()))


def _moved(log_median: FloatArray, dispersion: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return ratio of the medians, difference of the dispersions and largest distance of pairs of curves."""
    ratio = np.exp(log_median[1] - log_median[0])
    return ratio, dispersion[1] - dispersion[0], curve_distance(log_median, dispersion)[0]


def curve_distance(log_median: FloatArray, dispersion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the largest vertical distance between pairs of lognormal curves [-], and the ln of the level."""
    from scipy.special import ndtr

    (m, n), (s, t) = log_median, dispersion
    places = difference_extremes(log_median, dispersion)
    apart = np.abs(ndtr((places - m) / s) - ndtr((places - n) / t))
    best = apart.argmax(axis=0)[np.newaxis]
    return np.take_along_axis(apart, best, 0)[0], np.take_along_axis(places, best, 0)[0]


def fits(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> FloatArray:
    """Return ln of the median, and dispersion, of many sets of stripes at once; NaN where there is no curve."""
    x = np.log(levels)
    scale = LogScale(float(x.mean()), float(x.std()))
    theta = find_curves(levels, scale, failures, trials).theta
    return np.array([log_fractile(theta, scale, 0.0), np.exp(log_dispersion(theta, scale))])


def _drawn(levels: FloatArray, hits: list[FloatArray], repetitions: int, seed: int) -> FloatArray:
    """Return curves of motions drawn with replacement, the same for both: (two, median and dispersion, repetitions)."""
    motions, random = len(hits[0]), np.random.default_rng(seed)
    known = np.isfinite(hits[0]) & np.isfinite(hits[1])
    tables = [known.astype(np.float64), *(np.where(known, values, 0.0) for values in hits)]
    counts = np.empty((len(tables), repetitions, levels.size))
    share, size = np.full(motions, 1.0 / motions), max(1, _WEIGHTS // motions)
    for first in range(0, repetitions, size):  # drawn one after another: the pieces do not matter
        last = min(first + size, repetitions)
        weights = random.multinomial(motions, share, size=last - first).astype(np.float64)
        for whole, table in zip(counts, tables, strict=True):
            whole[first:last] = weights @ table
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
