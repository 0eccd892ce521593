"""What differs between two results of the same study: verdicts that flip, how surely, and by how much values move."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome

if TYPE_CHECKING:
    import xarray as xr

UNKNOWN = 2
"""In a map of flips: no verdict, because one of the two histories could not be computed."""

LEVEL = 0.95
"""Confidence of the intervals [-]."""

_SIGNED = "peak_rotation"


@dataclass(frozen=True)
class Flips:
    """Histories whose verdict, overturned or not, differs between two results.

    Parameters
    ----------
    count : int
        Histories whose verdict differs.
    gained : int
        Those of them that overturn in the second result only; the others overturn in the first only.
    compared : int
        Histories with a verdict in both.
    unknown : int
        Histories that could not be computed in one of them.
    low, high : float
        95 % interval of the share: what other motions, or other draws, of the same kind may give; NaN where there is
        neither, since the cells of a grid are no sample of anything [-].
    clusters : int
        Motions that the histories belong to, which are what the interval takes for independent; 0 if it takes every
        history for independent, or there is none.
    """

    count: int
    gained: int
    compared: int
    unknown: int
    low: float
    high: float
    clusters: int = 0

    @property
    def share(self) -> float:
        """Share of the compared histories whose verdict differs [-]."""
        return self.count / self.compared

    @property
    def lost(self) -> int:
        """Histories that overturn in the first result only."""
        return self.count - self.gained


def flips_of(first: Any, second: Any, motions: Any = None, *, drawn: bool = False) -> Flips:
    """Return how many verdicts differ between two results, with a 95 % interval of their share where there is one.

    >>> found = flips_of([1, 2, 2, 2], [1, 1, 2, 2])
    >>> found.count, found.gained, found.share, found.low
    (1, 0, 0.25, nan)
    >>> round(flips_of([1, 1, 1, 1], [1, 1, 1, 1], [1, 2, 3, 4]).high, 3)
    0.602
    """
    sign = flip_map(first, second)
    known = sign != UNKNOWN
    compared = int(known.sum())
    if not compared:
        raise InvalidValueError(f"no verdicts to compare: all {sign.size} histories failed in one of the two results")
    flipped = np.abs(sign[known])
    count, gained = int(flipped.sum()), int((sign == 1).sum())
    groups = None if motions is None else np.broadcast_to(np.asarray(motions), sign.shape)[known]
    size, clusters = _effective(flipped, groups)
    low, high = share_interval(count / compared, size) if clusters or drawn else (np.nan, np.nan)
    return Flips(count, gained, compared, sign.size - compared, low, high, clusters)


def flip_map(first: Any, second: Any) -> np.ndarray:
    """Return where the verdict differs.

    Returns 0 the same verdict, 1 overturned in the second only, -1 in the first only, 2 no verdict in one of them.
    """
    a, b = _codes(first), _codes(second)
    if a.shape != b.shape:
        raise InvalidValueError(f"results to compare must be of one shape, got {a.shape} and {b.shape}")
    over, failed = Outcome.OVERTURNED.code, Outcome.FAILED.code
    sign = (b == over).astype(np.int8) - (a == over).astype(np.int8)
    return np.where((a == failed) | (b == failed), np.int8(UNKNOWN), sign)


def share_interval(share: float, size: float, level: float = LEVEL) -> tuple[float, float]:
    """Return the exact binomial interval of a share (Clopper & Pearson 1934), for a number of trials not always whole.

    share: share observed [-]; level: confidence [-]. Returns ends [-].

    >>> low, high = share_interval(0.0, 100)
    >>> low, round(high, 6) == round(1 - 0.025 ** (1 / 100), 6)
    (0.0, True)
    """
    from scipy.special import betaincinv

    tail, hits = 0.5 * (1.0 - level), share * size
    low = float(betaincinv(hits, size - hits + 1.0, tail)) if share > 0.0 else 0.0
    high = float(betaincinv(hits + 1.0, size - hits, 1.0 - tail)) if share < 1.0 else 1.0  # Eq. 186
    return low, high


def difference_of(first: "xr.Dataset", second: "xr.Dataset", name: str) -> "xr.DataArray":
    """Return how a value moves from one result to another, where the history stood in both.

    Returns second less first, of peak rotations their sizes; missing (NaN) where either overturned or failed: its peak
    is then no rotation of rocking.
    """
    if name == "verdict":
        flag = "-1 overturned in the baseline only, 0 same verdict, 1 overturned only here, 2 one of the two failed"
        made = first["outcome"].copy(data=flip_map(first["outcome"].values, second["outcome"].values))
        return made.rename("verdict").assign_attrs(units="1", long_name=flag)
    names = sorted(str(k) for k, v in first.data_vars.items() if v.dtype.kind in "if" and k in second)
    if name not in names:
        raise InvalidValueError(f"name must be verdict or one of {', '.join(names)}, got {name!r}")
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
        raise InvalidValueError(f"verdicts must be codes of outcomes in [0, {len(Outcome) - 1}], got {values!r:.60}")
    return codes


def _effective(flipped: FloatArray, groups: np.ndarray | None) -> tuple[float, int]:
    """Return how many independent histories tell as much about the share, and how many motions they belong to."""
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
    return min(max(size * _student(flipped.size, clusters), 1.0), float(flipped.size)), clusters


def _student(histories: int, clusters: int) -> float:
    """Return the factor on the size for a variance estimated from few motions."""
    from scipy.special import stdtrit

    tail = 0.5 * (1.0 + LEVEL)
    return float((stdtrit(histories - 1, tail) / stdtrit(clusters - 1, tail)) ** 2)
