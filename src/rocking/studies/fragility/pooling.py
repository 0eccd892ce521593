"""Outcomes of very many histories counted by level and motion, without a table of all of them."""

from collections.abc import Sequence

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.studies.fragility.counts import Counts, check_spread, count_outcomes

_ROWS_AT_ONCE = 1 << 15


def pooled(levels: FloatArray, good: BoolArray, reached: Sequence[BoolArray], cluster: IntArray) -> list[Counts]:
    """Return the counts of several states of the same histories, as `count_outcomes` would of each.

    Motions at the same levels with the same outcomes are one row and a number, so that ten million histories take no
    more room than the outcomes they can have.

    levels: level of each history, > 0; the first axis is the motion [unit of the measure]. Returns one a state; by
    cluster where one has more than one history.
    """
    size = np.bincount(cluster, good.reshape(cluster.size, -1).sum(axis=1))
    if good.any() and size.max() <= 1.0:
        return _single(levels[good], [state[good] for state in reached])
    if good.any() and levels.ndim == 2 and levels.strides[0] == 0:
        return [_grid(levels[0], good, state & good, cluster) for state in reached]
    names = np.broadcast_to(cluster.reshape(-1, *[1] * (good.ndim - 1)), good.shape)[good]
    return [count_outcomes(levels[good], state[good], clusters=names.tolist()) for state in reached]


def _single(levels: FloatArray, reached: Sequence[BoolArray]) -> list[Counts]:
    """Return the counts of histories that are independent; levels and trials are kept once for all states."""
    distinct, where = np.unique(levels, return_inverse=True)
    check_spread(distinct)
    trials = np.bincount(where, minlength=distinct.size).astype(np.float64)
    failures = [np.bincount(where[state], minlength=distinct.size).astype(np.float64) for state in reached]
    return [Counts(distinct, failed, trials) for failed in failures]


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
