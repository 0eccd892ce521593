"""How far two fragility curves lie apart, and how much of that the choice of records explains."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, percent
from rocking.errors import InvalidValueError
from rocking.statistics.maximum_likelihood import LogScale, find_curves, log_dispersion, log_fractile

_FEWEST = 0.975
_WEIGHTS = 4_000_000


@dataclass(frozen=True)
class Change:
    """A number with the 95 % interval that resampling the motions gives it.

    Parameters
    ----------
    value : float
        The number.
    interval : tuple of float, optional
        Ends; None where more than 2.5 % of the resampled sets have no curve, so that no interval can be claimed.
    """

    value: float
    interval: tuple[float, float] | None


@dataclass(frozen=True)
class CurveChange:
    """What changes from one lognormal fragility curve to another.

    Parameters
    ----------
    median : Change
        Second median over the first [-].
    dispersion : Change
        Second dispersion less the first [-].
    distance : Change
        Largest difference of the probabilities, without its sign [-]; zero is never inside its interval.
    level : float
        Intensity at which it is largest, in the unit of the intensity measure.
    repetitions : int
        Sets of motions drawn, the same for both curves.
    without_curve : int
        Those of them for which one of the curves does not exist.
    """

    median: Change
    dispersion: Change
    distance: Change
    level: float
    repetitions: int
    without_curve: int

    def told(self, unit: str, size: float = 1.0) -> str:
        """Return the changes in words.

        Parameters
        ----------
        unit : str
            Of the intensity measure.
        size : float
            Its size in the unit of the levels.

        Returns
        -------
        str
            Part of a sentence.
        """
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
    """Return a share in percent with its sign.

    share: the share [-].

    >>> signed(0.14), signed(-0.02)
    ('+14 %', '-2 %')
    """
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
    """Return what changes from one fragility curve to another, with intervals from motions drawn with replacement.

    Both curves of a repetition are fitted to the same motions, so that what the motions have in common cancels.

    curves: the two curves: medians in the unit of the levels, dispersions [-]; levels: intensities [unit of the
    intensity measure]. Returns ratio of the medians, difference of the dispersions, largest distance.
    """
    at = checks.positive_array("levels", levels)
    if at.ndim != 1 or at.size < 2 or np.any(np.diff(at) <= 0.0):
        raise InvalidValueError(f"levels must be two or more numbers, each above the one before, got {levels!r:.60}")
    hits = [_indicators(name, values, at.size) for name, values in (("first", first), ("second", second))]
    if hits[0].shape != hits[1].shape:
        raise InvalidValueError(f"both results must be of the same motions, got {hits[0].shape} and {hits[1].shape}")
    values = [checks.positive("median or dispersion", value) for curve in curves for value in curve]
    log_median, dispersion = np.log(values[::2]), np.array(values[1::2])
    drawn = _drawn(at, hits, int(checks.within("repetitions", repetitions, 0, 1_000_000)), seed)
    good = np.isfinite(drawn).all(axis=(0, 1))
    enough = int(good.sum()) >= max(_FEWEST * good.size, 1)
    samples = _moved(drawn[:, 0, good], drawn[:, 1, good])
    found = [
        Change(float(value), _ends(sample) if enough else None)
        for value, sample in zip(_moved(log_median, dispersion), samples, strict=True)
    ]
    level = float(np.exp(curve_distance(log_median, dispersion)[1]))
    return CurveChange(found[0], found[1], found[2], level, good.size, good.size - int(good.sum()))


def _moved(log_median: FloatArray, dispersion: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return ratio of the medians, difference of the dispersions and largest distance of pairs of curves."""
    ratio = np.exp(log_median[1] - log_median[0])
    return ratio, dispersion[1] - dispersion[0], curve_distance(log_median, dispersion)[0]


def curve_distance(log_median: FloatArray, dispersion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the largest vertical distance between pairs of lognormal curves, and where it is.

    dispersion: dispersions [-]. Returns distance: largest difference of the probabilities, without its sign [-].

    >>> distance, where = curve_distance(np.array([0.0, 1.0]), np.array([0.5, 0.5]))
    >>> round(float(distance), 6), float(where)
    (0.682689, 0.5)
    """
    from scipy.special import ndtr

    (m, n), (s, t) = log_median, dispersion
    # where the densities are equal: ((u - m)/s)^2 - ((u - n)/t)^2 + 2 ln(s/t) = 0, with u measured from m
    a, b = t**2 - s**2, s**2 * (n - m)
    c = -(s**2) * (n - m) ** 2 + 2.0 * (s * t) ** 2 * np.log(s / t)  # Eq. 189
    root = np.sqrt(np.maximum(b**2 - a * c, 0.0))
    q = -(b + np.where(b < 0.0, -root, root))
    with np.errstate(divide="ignore", invalid="ignore"):
        places = m + np.array([np.where(a != 0.0, q / a, np.inf), np.where(q != 0.0, c / q, 0.0)])
    places = np.where(np.isfinite(places), places, m)
    apart = np.abs(ndtr((places - m) / s) - ndtr((places - n) / t))
    best = apart.argmax(axis=0)[np.newaxis]
    return np.take_along_axis(apart, best, 0)[0], np.take_along_axis(places, best, 0)[0]


def fits(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> FloatArray:
    """Return lognormal curves of many sets of stripes at once, as `fit_lognormal` finds them.

    levels: intensities, ascending [unit of the intensity measure]. Returns logarithm of the median, and dispersion [-];
    NaN where there is no curve.
    """
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


def _ends(sample: FloatArray) -> tuple[float, float]:
    low, high = np.quantile(sample, [0.025, 0.975]).tolist()
    return low, high


def _indicators(name: str, values: Any, levels: int) -> FloatArray:
    found = np.asarray(values, dtype=np.float64)
    if found.ndim != 2 or found.shape[1] != levels or not len(found):
        raise InvalidValueError(f"{name} must be of shape (motions, {levels} levels), got {found.shape}")
    if not np.isin(found[np.isfinite(found)], (0.0, 1.0)).all():
        raise InvalidValueError(f"{name} must be 0 or 1 (NaN for a history that failed)")
    return found
