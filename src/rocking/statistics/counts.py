"""Checked counts of failures and trials at levels."""

import math
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.messages import Range

NARROWEST = 1e-9  # smallest relative distance between the lowest and the highest level [-]
MIN_CLUSTERS = 5  # minimum number of distinct clusters for resampling

MANY_CLUSTERS = 30
"""With more clusters, resampled intervals have their nominal coverage."""

_ROWS_AT_ONCE = 1 << 15


@dataclass(frozen=True, eq=False)
class Counts:
    """Failures and trials at ascending levels, from `count_outcomes`."""

    levels: FloatArray  # distinct levels of the intensity measure, ascending [any unit]
    failures: FloatArray  # failures, trials: numbers of failures and trials at every level [-]
    trials: FloatArray
    # cluster_failures, cluster_trials: failures and trials by cluster (row) and level (column) [-]
    cluster_failures: FloatArray | None = None
    cluster_trials: FloatArray | None = None
    cluster_weights: FloatArray | None = None  # number of clusters per row [-]; default 1

    @property
    def survivals(self) -> FloatArray:
        """Number of survivals at every level [-]."""
        return self.trials - self.failures

    @property
    def observations(self) -> int:
        """Total number of trials [-]."""
        return int(self.trials.sum())

    @property
    def clusters(self) -> int:
        """Number of named clusters."""
        if self.cluster_weights is not None:
            return int(self.cluster_weights.sum())
        return 0 if self.cluster_trials is None else self.cluster_trials.shape[0]

    @property
    def is_clustered(self) -> bool:
        """True if a cluster contains more than one trial, so that trials are not independent."""
        return self.cluster_trials is not None and bool(self.cluster_trials.sum(axis=1).max() > 1.0)

    @cached_property
    def tries_all_levels(self) -> bool:
        """True if every cluster has one trial at every level, such as records scaled to all levels."""
        if self.cluster_trials is None or self.clusters < 2 or self.levels.size < 2:
            return False
        return bool((self.cluster_trials == 1.0).all())

    @property
    def draws_capacities(self) -> bool:
        """True for few clusters, all with one trial at every level."""
        return MIN_CLUSTERS <= self.clusters < MANY_CLUSTERS and self.tries_all_levels

    @cached_property
    def distinct_clusters(self) -> tuple[FloatArray, FloatArray]:
        """Distinct rows of failures and trials by level, and the number of clusters per row [-]."""
        if self.cluster_failures is None or self.cluster_trials is None:
            return np.empty((0, 2 * self.levels.size)), np.empty(0)
        table = np.hstack([self.cluster_failures, self.cluster_trials])
        rows, inverse = np.unique(table, axis=0, return_inverse=True)
        return rows, np.bincount(inverse.ravel(), self.cluster_weights).astype(np.float64)

    @property
    def scarcity(self) -> str:
        """Reason why there are too few clusters for resampling; empty if there are enough.

        Five records with a trial at every level are enough, because their capacities are sampled from the curve.
        Otherwise, five clusters with distinct outcomes are needed. For fewer than four levels, the number of distinct
        increasing outcomes is at most the number of levels plus one.
        """
        if self.draws_capacities:
            return ""
        distinct, needed = self.distinct_clusters[1].size, min(MIN_CLUSTERS, self.levels.size + 1)
        if self.clusters >= MIN_CLUSTERS and distinct >= needed:
            return ""
        if self.clusters < MIN_CLUSTERS:
            noun = "cluster" if self.clusters == 1 else "clusters"
            return f"{self.clusters} distinct {noun}, where {MIN_CLUSTERS} are needed"
        return f"{self.clusters} clusters of {distinct} distinct outcomes, where {needed} are needed"


@dataclass(frozen=True, eq=False)
class StateCounts:
    """Three states at ascending levels, from `count_states`."""

    levels: FloatArray  # distinct levels of the intensity measure, ascending [any unit]
    rocked: FloatArray  # number of trials that rocked (to the chosen level) or overturned, at every level [-]
    overturned: FloatArray  # number of trials that overturned, at every level [-]
    trials: FloatArray  # number of all trials at every level [-]


def count_outcomes(
    levels: Any, failures: Any, trials: Any = None, clusters: Iterable[Hashable] | None = None
) -> Counts:
    """Check outcomes and pool equal levels.

    Parameters
    ----------
    levels : array_like
        Levels of the intensity measure, one per entry, in any order, > 0 [any unit].
    failures : array_like
        Number of failures per entry [-]. Without `trials`: 0 or 1, or booleans.
    trials : array_like, optional
        Number of trials per entry, at least 1 [-]. The default is 1.
    clusters : iterable, optional
        Name of the cluster of every entry, such as its record. Outcomes of one cluster are not independent.

    Returns
    -------
    Counts
        One entry per distinct level, ascending.

    Raises
    ------
    InvalidValueError
        If a level is not a finite number > 0, if a count is not an integer, or if failures exceed trials.

    Examples
    --------
    >>> count_outcomes([0.4, 0.2, 0.4], [1, 0, 0]).trials
    array([1., 2.])
    """
    level = _row("levels", levels)
    checks.all_positive("levels", level)
    number = np.ones_like(level) if trials is None else _whole("trials", trials, level.size, 1.0)
    failed = _whole("failures", failures, level.size, 0.0)
    _none_above("failures", failed, number)
    distinct, index = np.unique(level, return_inverse=True)
    check_spread(distinct)
    pooled = [np.bincount(index, values, distinct.size).astype(np.float64) for values in (failed, number)]
    if clusters is None:
        return Counts(distinct, *pooled)
    numbers: dict[Hashable, int] = {}
    cluster = np.array([numbers.setdefault(name, len(numbers)) for name in clusters], dtype=np.int64)
    if cluster.size != level.size:
        raise InvalidValueError(
            "{parameter} must contain one name per level: {levels}, got {count}", parameter="clusters",
            levels=level.size, count=cluster.size,
        )  # fmt: skip
    tables = [np.zeros((len(numbers), distinct.size)) for _ in pooled]
    for table, values in zip(tables, (failed, number), strict=True):
        np.add.at(table, (cluster, index), values)
    return Counts(distinct, *pooled, *tables)


def count_states(levels: Any, rocked: Any, overturned: Any, trials: Any = None) -> StateCounts:
    """Check outcomes of three states and pool equal levels.

    Parameters
    ----------
    levels : array_like
        Levels of the intensity measure, one per entry, in any order, > 0 [any unit].
    rocked : array_like
        Number of trials per entry that rocked to the chosen level or further, including overturned trials [-].
    overturned : array_like
        Number of trials per entry that overturned [-].
    trials : array_like, optional
        Number of trials per entry, at least 1 [-]. The default is 1.

    Returns
    -------
    StateCounts
        One entry per distinct level, ascending.

    Raises
    ------
    InvalidValueError
        If a count is invalid, or if more trials overturned than rocked.

    Examples
    --------
    >>> count_states([0.2, 0.4], rocked=[1, 5], overturned=[0, 2], trials=[5, 5]).overturned
    array([0., 2.])
    """
    worst, milder = count_outcomes(levels, overturned, trials), count_outcomes(levels, rocked, trials)
    pair = [_whole(name, values, np.size(levels), 0.0) for name, values in (("o", overturned), ("r", rocked))]
    _none_above("overturned", pair[0], pair[1], "rocked")
    return StateCounts(milder.levels, milder.failures, worst.failures, milder.trials)


def _row(name: str, values: Any) -> FloatArray:
    array = checks.real_array(name, values)
    if array.ndim != 1 or not array.size:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter=name,
            allowed="one row of at least one number", shape=array.shape,
        )  # fmt: skip
    return array


def _whole(name: str, values: Any, size: int, minimum: float) -> FloatArray:
    is_boolean = getattr(values, "dtype", None) == np.bool_ or (
        isinstance(values, (list, tuple)) and all(isinstance(value, (bool, np.bool_)) for value in values)
    )
    array = _row(name, np.asarray(values, dtype=np.float64) if is_boolean else values)
    if array.size != size:
        raise InvalidValueError(
            "{parameter} must have one number per level: {size}, got {count}",
            parameter=name,
            size=size,
            count=array.size,
        )
    bad = ~(np.isfinite(array) & (array >= minimum) & (array == np.round(array)) & (array < 2.0**53))
    if bad.any():
        first = int(np.argmax(bad))
        cause = "Remove levels without trials." if minimum > array[first] == 0.0 else "Use counts, not fractions."
        raise InvalidValueError(
            "{parameter} must be whole numbers {allowed}, got {value} at index {index}", parameter=name,
            allowed=Range(minimum, math.inf), value=float(array[first]), index=first, hint=cause,
        )  # fmt: skip
    return array


def _none_above(name: str, count: FloatArray, total: FloatArray, of: str = "trials") -> None:
    bad = count > total
    if bad.any():
        first = int(np.argmax(bad))
        raise InvalidValueError(
            "{parameter} must not exceed {of}, got {value} of {limit:g} at index {index}. Check {of}=.",
            parameter=name, value=float(count[first]), of=of, limit=float(total[first]), index=first,
        )  # fmt: skip


def check_spread(levels: FloatArray) -> None:
    """Raise an error if ascending levels differ only by rounding."""
    if levels.size > 1 and levels[-1] <= levels[0] * (1.0 + NARROWEST):
        raise InvalidValueError(
            "the relative range of {parameter} must exceed {smallest:g}, got {low:.17g} to {high:.17g}",
            parameter="levels", smallest=NARROWEST, low=float(levels[0]), high=float(levels[-1]),
            hint="Use one level.",
        )  # fmt: skip


def pooled(levels: FloatArray, good: BoolArray, reached: Sequence[BoolArray], cluster: IntArray) -> list[Counts]:
    """Return the counts of several states of common histories. They are equal to `count_outcomes` of every state."""
    # motions (first axis) with equal levels and outcomes become one row with a weight, so that ten million histories
    # need little memory; a cluster with more than one history has its own row
    size = np.bincount(cluster, good.reshape(cluster.size, -1).sum(axis=1))
    if good.any() and size.max() <= 1.0:  # independent trials: all states have common levels and trials
        distinct, index = np.unique(levels[good], return_inverse=True)
        check_spread(distinct)
        trials, *failures = (
            np.bincount(index[state[good]], minlength=distinct.size).astype(np.float64) for state in (good, *reached)
        )
        return [Counts(distinct, failed, trials) for failed in failures]
    if good.any() and levels.ndim == 2 and levels.strides[0] == 0:
        return [_grid(levels[0], good, state & good, cluster) for state in reached]
    names = np.broadcast_to(cluster.reshape(-1, *[1] * (good.ndim - 1)), good.shape)[good]
    return [count_outcomes(levels[good], state[good], clusters=names.tolist()) for state in reached]


def _grid(levels: FloatArray, good: BoolArray, failed: BoolArray, cluster: IntArray) -> Counts:
    """Return the counts of motions scaled to common levels."""
    used = good.any(axis=0)
    check_spread(levels[used])
    members = np.bincount(cluster, minlength=cluster.size)[cluster]
    rows, weights = _distinct(failed[:, used], good[:, used], np.flatnonzero((members == 1) & good.any(axis=1)))
    more = _summed(failed[:, used], good[:, used], cluster, np.flatnonzero(members > 1))
    rows, weights = np.vstack([rows, more]), np.append(weights, np.ones(len(more)))
    trials, failures = good[:, used].sum(axis=0), failed[:, used].sum(axis=0)
    by_cluster = np.split(rows, 2, axis=1)
    return Counts(
        levels[used], failures.astype(np.float64), trials.astype(np.float64), by_cluster[0], by_cluster[1], weights
    )


def _distinct(failed: BoolArray, good: BoolArray, motions: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return the distinct rows of failures and trials of motions, and the number of motions per row."""
    width = failed.shape[1]
    distinct, weights = np.empty((0, (2 * width + 7) // 8), np.uint8), np.empty(0, np.float64)
    for first in range(0, motions.size, _ROWS_AT_ONCE):
        piece = motions[first : first + _ROWS_AT_ONCE]
        bits = np.packbits(np.hstack([failed[piece], good[piece]]), axis=1)
        distinct, inverse = np.unique(np.vstack([distinct, bits]), axis=0, return_inverse=True)
        weights = np.bincount(inverse.ravel(), np.append(weights, np.ones(piece.size))).astype(np.float64)
    return np.unpackbits(distinct, axis=1, count=2 * width).astype(np.float64), weights


def _summed(failed: BoolArray, good: BoolArray, cluster: IntArray, motions: IntArray) -> FloatArray:
    """Return the rows of failures and trials of clusters of several motions, without empty rows."""
    names, number = np.unique(cluster[motions], return_inverse=True)
    rows = np.zeros((names.size, 2 * failed.shape[1]))
    np.add.at(rows, number, np.hstack([failed[motions], good[motions]]))
    return rows[rows[:, failed.shape[1] :].any(axis=1)]


def share_interval(hits: float, trials: float, level: float = 0.95) -> tuple[float, float]:
    """Return the exact binomial interval of a fraction (Clopper & Pearson 1934).

    The coverage is at least the level, for any number of trials. The number of trials may be a non-integer.

    Parameters
    ----------
    hits, trials : float
        Number of hits and number of trials [-].
    level : float
        Confidence level with equal tails [-].

    Returns
    -------
    tuple of float
        Lower and upper end [-].

    Raises
    ------
    InvalidValueError
        If there are no trials, or more hits than trials.

    Examples
    --------
    >>> low, high = share_interval(0, 100)
    >>> low, round(high, 6), round(1.0 - 0.025 ** (1 / 100), 6)
    (0.0, 0.036217, 0.036217)
    """
    from scipy.special import betaincinv

    level = checks.within("level", level, 0.0, 1.0, open_low=True, open_high=True)
    if not 0 <= hits <= trials or trials < 1:
        raise InvalidValueError(
            "hits must be in [0, count] with a count of at least 1, got {hits} of {trials}", hits=hits, trials=trials
        )
    tail = 0.5 * (1.0 - level)
    low = 0.0 if hits == 0 else float(betaincinv(hits, trials - hits + 1.0, tail))
    high = 1.0 if hits == trials else float(betaincinv(hits + 1.0, trials - hits, 1.0 - tail))  # Eq. 186
    return low, high
