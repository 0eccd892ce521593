"""Outcomes checked and counted: how many of how many trials failed at each level."""

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

NARROWEST = 1e-9  # least relative distance between the lowest and the highest level [-]
LEAST_CLUSTERS = 5  # distinct clusters below which drawing them again says nothing about clusters that were not seen

MANY_CLUSTERS = 30
"""Clusters from which drawing them again covers as often as it says, whatever their outcomes have in common."""

_ROWS_AT_ONCE = 1 << 15


@dataclass(frozen=True, eq=False)
class Counts:
    """Failures and trials at ascending levels; use `count_outcomes` to make one."""

    levels: FloatArray  # distinct levels of the intensity measure, ascending [any unit]
    failures: FloatArray  # failures, trials: trials that failed, and all trials, at each level [-]
    trials: FloatArray
    # cluster_failures, cluster_trials: the same by cluster: one row a cluster, one column a level [-]
    cluster_failures: FloatArray | None = None
    cluster_trials: FloatArray | None = None
    cluster_weights: FloatArray | None = None  # how many clusters have each of these rows; one each, if not given [-]

    @property
    def survivals(self) -> FloatArray:
        """Trials that survived at each level [-]."""
        return self.trials - self.failures

    @property
    def observations(self) -> int:
        """Number of trials in all [-]."""
        return int(self.trials.sum())

    @property
    def clusters(self) -> int:
        """Number of clusters that were named; 0 if none were."""
        if self.cluster_weights is not None:
            return int(self.cluster_weights.sum())
        return 0 if self.cluster_trials is None else self.cluster_trials.shape[0]

    @property
    def is_clustered(self) -> bool:
        """Whether a cluster holds more than one trial, so that the trials are not independent."""
        return self.cluster_trials is not None and bool(self.cluster_trials.sum(axis=1).max() > 1.0)

    @cached_property
    def tries_all_levels(self) -> bool:
        """Whether clusters were each tried once at every level, as records that are raised level by level."""
        if self.cluster_trials is None or self.clusters < 2 or self.levels.size < 2:
            return False
        return bool((self.cluster_trials == 1.0).all())

    @property
    def draws_capacities(self) -> bool:
        """Whether few clusters were each tried once at every level."""
        return LEAST_CLUSTERS <= self.clusters < MANY_CLUSTERS and self.tries_all_levels

    @cached_property
    def distinct_clusters(self) -> tuple[FloatArray, FloatArray]:
        """Distinct rows of failures and trials by level, side by side, and how many clusters have each [-]."""
        if self.cluster_failures is None or self.cluster_trials is None:
            return np.empty((0, 2 * self.levels.size)), np.empty(0)
        both = np.hstack([self.cluster_failures, self.cluster_trials])
        rows, which = np.unique(both, axis=0, return_inverse=True)
        return rows, np.bincount(which.ravel(), self.cluster_weights).astype(np.float64)

    @property
    def scarcity(self) -> str:
        """Why the clusters are too few to be drawn again; empty if they are not.

        Few records that serve at every level need only be five, since their capacities are drawn from the curve. Else
        five must differ in name and in outcome; at fewer than four levels as many outcomes as can differ there while
        they grow with the level: one more than there are levels.
        """
        if self.draws_capacities:
            return ""
        found, wanted = self.distinct_clusters[1].size, min(LEAST_CLUSTERS, self.levels.size + 1)
        if self.clusters >= LEAST_CLUSTERS and found >= wanted:
            return ""
        if self.clusters < LEAST_CLUSTERS:
            word = "cluster" if self.clusters == 1 else "clusters"
            return f"{self.clusters} distinct {word}, where {LEAST_CLUSTERS} are needed"
        return f"{self.clusters} clusters of {found} distinct outcomes, where {wanted} are needed"


@dataclass(frozen=True, eq=False)
class StateCounts:
    """Three states at ascending levels; use `count_states` to make one."""

    levels: FloatArray  # distinct levels of the intensity measure, ascending [any unit]
    rocked: FloatArray  # trials that rocked at least (to the chosen level, or overturned) at each level [-]
    overturned: FloatArray  # trials that overturned at each level [-]
    trials: FloatArray  # all trials at each level [-]


def count_outcomes(
    levels: Any, failures: Any, trials: Any = None, clusters: Iterable[Hashable] | None = None
) -> Counts:
    """Check outcomes and pool those of equal levels.

    Parameters
    ----------
    levels : array_like
        Level of the intensity measure of each entry, in any order, > 0 [any unit].
    failures : array_like
        How many trials of each entry failed; 0 or 1, or booleans, without `trials` [-].
    trials : array_like, optional
        How many trials each entry holds, at least 1; 1 each by default [-].
    clusters : iterable, optional
        Name of the cluster of each entry, such as its record: outcomes of one cluster are not independent.

    Returns
    -------
    Counts
        One entry a distinct level, ascending.

    Raises
    ------
    InvalidValueError
        If a level is not a finite number > 0, a count is not whole or failures exceed trials; naming the first.

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
    distinct, where = np.unique(level, return_inverse=True)
    check_spread(distinct)
    pooled = [np.bincount(where, values, distinct.size).astype(np.float64) for values in (failed, number)]
    if clusters is None:
        return Counts(distinct, *pooled)
    known: dict[Hashable, int] = {}
    cluster = np.array([known.setdefault(name, len(known)) for name in clusters], dtype=np.int64)
    if cluster.size != level.size:
        raise InvalidValueError(
            "{parameter} must name one cluster a level: {levels}, got {count}", parameter="clusters", levels=level.size,
            count=cluster.size,
        )  # fmt: skip
    tables = [np.zeros((len(known), distinct.size)) for _ in pooled]
    for table, values in zip(tables, (failed, number), strict=True):
        np.add.at(table, (cluster, where), values)
    return Counts(distinct, *pooled, *tables)


def count_states(levels: Any, rocked: Any, overturned: Any, trials: Any = None) -> StateCounts:
    """Check outcomes of three states and pool those of equal levels.

    Parameters
    ----------
    levels : array_like
        Level of the intensity measure of each entry, in any order, > 0 [any unit].
    rocked : array_like
        How many trials of each entry rocked to the chosen level or further, the overturned ones among them [-].
    overturned : array_like
        How many trials of each entry overturned [-].
    trials : array_like, optional
        How many trials each entry holds, at least 1; 1 each by default [-].

    Returns
    -------
    StateCounts
        One entry a distinct level, ascending.

    Raises
    ------
    InvalidValueError
        If a count is refused, or more trials overturned than rocked.

    Examples
    --------
    >>> count_states([0.2, 0.4], rocked=[1, 5], overturned=[0, 2], trials=[5, 5]).overturned
    array([0., 2.])
    """
    worst, least = count_outcomes(levels, overturned, trials), count_outcomes(levels, rocked, trials)
    pair = [_whole(name, values, np.size(levels), 0.0) for name, values in (("o", overturned), ("r", rocked))]
    _none_above("overturned", pair[0], pair[1], "rocked")
    return StateCounts(least.levels, least.failures, worst.failures, least.trials)


def _row(name: str, values: Any) -> FloatArray:
    array = checks.real_array(name, values)
    if array.ndim != 1 or not array.size:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter=name,
            allowed="one row of at least one number", shape=array.shape,
        )  # fmt: skip
    return array


def _whole(name: str, values: Any, size: int, least: float) -> FloatArray:
    yes_or_no = getattr(values, "dtype", None) == np.bool_ or (
        isinstance(values, (list, tuple)) and all(isinstance(value, (bool, np.bool_)) for value in values)
    )
    array = _row(name, np.asarray(values, dtype=np.float64) if yes_or_no else values)
    if array.size != size:
        raise InvalidValueError(
            "{parameter} must have one number a level: {size}, got {count}", parameter=name, size=size, count=array.size
        )
    bad = ~(np.isfinite(array) & (array >= least) & (array == np.round(array)) & (array < 2.0**53))
    if bad.any():
        first = int(np.argmax(bad))
        cause = "leave out levels without trials" if least > array[first] == 0.0 else "a fraction or a percentage?"
        raise InvalidValueError(
            "{parameter} must be whole numbers {allowed}, got {value} at index {index}", parameter=name,
            allowed=Range(least, math.inf), value=float(array[first]), index=first, hint=cause,
        )  # fmt: skip
    return array


def _none_above(name: str, part: FloatArray, whole: FloatArray, of: str = "trials") -> None:
    bad = part > whole
    if bad.any():
        first = int(np.argmax(bad))
        raise InvalidValueError(
            "{parameter} must not exceed {of}, got {value} of {limit:g} at index {index}; is {of}= missing?",
            parameter=name, value=float(part[first]), of=of, limit=float(whole[first]), index=first,
        )  # fmt: skip


def check_spread(levels: FloatArray) -> None:
    """Refuse ascending levels that differ by rounding only."""
    if levels.size > 1 and levels[-1] <= levels[0] * (1.0 + NARROWEST):
        raise InvalidValueError(
            "{parameter} must differ by more than {smallest:g} of themselves in all, got {low:.17g} to {high:.17g}",
            parameter="levels", smallest=NARROWEST, low=float(levels[0]), high=float(levels[-1]),
            hint="rounding of one and the same level?",
        )  # fmt: skip


def pooled(levels: FloatArray, good: BoolArray, reached: Sequence[BoolArray], cluster: IntArray) -> list[Counts]:
    """Return the counts of several states of the same histories, as `count_outcomes` would of each."""
    # motions, the first axis, at the same levels with the same outcomes are one row and a number, so that ten million
    # histories take no more room than the outcomes they can have; by cluster where one has more than one history
    size = np.bincount(cluster, good.reshape(cluster.size, -1).sum(axis=1))
    if good.any() and size.max() <= 1.0:  # independent: levels and trials are kept once for all states
        distinct, where = np.unique(levels[good], return_inverse=True)
        check_spread(distinct)
        trials, *failures = (
            np.bincount(where[state[good]], minlength=distinct.size).astype(np.float64) for state in (good, *reached)
        )
        return [Counts(distinct, failed, trials) for failed in failures]
    if good.any() and levels.ndim == 2 and levels.strides[0] == 0:
        return [_grid(levels[0], good, state & good, cluster) for state in reached]
    names = np.broadcast_to(cluster.reshape(-1, *[1] * (good.ndim - 1)), good.shape)[good]
    return [count_outcomes(levels[good], state[good], clusters=names.tolist()) for state in reached]


def _grid(levels: FloatArray, good: BoolArray, failed: BoolArray, cluster: IntArray) -> Counts:
    """Return the counts of motions that were all brought to the same levels."""
    tried = good.any(axis=0)
    check_spread(levels[tried])
    members = np.bincount(cluster, minlength=cluster.size)[cluster]
    rows, weights = _distinct(failed[:, tried], good[:, tried], np.flatnonzero((members == 1) & good.any(axis=1)))
    more = _summed(failed[:, tried], good[:, tried], cluster, np.flatnonzero(members > 1))
    rows, weights = np.vstack([rows, more]), np.append(weights, np.ones(len(more)))
    trials, failures = good[:, tried].sum(axis=0), failed[:, tried].sum(axis=0)
    parts = np.split(rows, 2, axis=1)
    return Counts(levels[tried], failures.astype(np.float64), trials.astype(np.float64), parts[0], parts[1], weights)


def _distinct(failed: BoolArray, good: BoolArray, motions: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return the distinct rows of failures and trials of motions, and how many motions have each."""
    width = failed.shape[1]
    known, weights = np.empty((0, (2 * width + 7) // 8), np.uint8), np.empty(0, np.float64)
    for first in range(0, motions.size, _ROWS_AT_ONCE):
        part = motions[first : first + _ROWS_AT_ONCE]
        bits = np.packbits(np.hstack([failed[part], good[part]]), axis=1)
        known, which = np.unique(np.vstack([known, bits]), axis=0, return_inverse=True)
        weights = np.bincount(which.ravel(), np.append(weights, np.ones(part.size))).astype(np.float64)
    return np.unpackbits(known, axis=1, count=2 * width).astype(np.float64), weights


def _summed(failed: BoolArray, good: BoolArray, cluster: IntArray, motions: IntArray) -> FloatArray:
    """Return the rows of failures and trials of clusters of several motions, those without any trial left out."""
    names, number = np.unique(cluster[motions], return_inverse=True)
    rows = np.zeros((names.size, 2 * failed.shape[1]))
    np.add.at(rows, number, np.hstack([failed[motions], good[motions]]))
    return rows[rows[:, failed.shape[1] :].any(axis=1)]


def share_interval(hits: float, trials: float, level: float = 0.95) -> tuple[float, float]:
    """Return the exact binomial interval of a share (Clopper & Pearson 1934).

    It covers the true share at least as often as its level says, for any number of trials, which need not be whole.

    Parameters
    ----------
    hits, trials : float
        How many of how many [-].
    level : float
        Confidence, equal tails [-].

    Returns
    -------
    tuple of float
        Lower and upper end [-].

    Raises
    ------
    InvalidValueError
        If there are no trials or more hits than trials.

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
