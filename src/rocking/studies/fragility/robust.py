"""Standard errors of curves whose outcomes come in clusters, each of which counts as one observation."""

from dataclasses import replace

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.fragility.counts import Counts
from rocking.studies.fragility.estimate import FittedCurves, LogScale
from rocking.studies.fragility.likelihood import tails

LEAST = 1e-12
"""Smallest share of the variance in any direction, so that the inverse of the covariance exists [-]."""

FULLEST = 2_000_000
"""Numbers that are held at once."""


def with_cluster_errors(counts: Counts, scale: LogScale, curves: FittedCurves, drawn: FloatArray) -> FittedCurves:
    """Return curves whose curvature is the inverse of the covariance between clusters.

    The covariance is H^-1 M H^-1, with the information H and the sum M of the squared scores of whole clusters (Liang &
    Zeger 1986, Biometrika 73:13): that of the likelihood, H^-1, holds for independent outcomes only.

    drawn: how often each distinct cluster is in each data set, one row a data set [-].
    """
    curvature = np.full_like(curves.curvature, np.nan)
    good = np.flatnonzero(curves.found)
    size = max(1, FULLEST // max(1, drawn.shape[1]))
    for start in range(0, good.size, size):
        rows = good[start : start + size]
        spread = _scores_squared(counts, scale, curves.theta[rows], drawn[rows])
        inverse = np.linalg.inv(curves.curvature[rows])
        covariance = inverse @ spread @ inverse  # Eq. 212
        least = LEAST * np.trace(covariance, axis1=1, axis2=2) + np.finfo(float).tiny ** 0.25
        curvature[rows] = np.linalg.inv(covariance + least[:, None, None] * np.eye(2))
    return replace(curves, curvature=curvature)


def _scores_squared(counts: Counts, scale: LogScale, theta: FloatArray, drawn: FloatArray) -> FloatArray:
    position = scale.position(counts.levels)
    failures, trials = np.split(counts.distinct_clusters[0], 2, axis=1)
    tail = tails(theta[:, :1] + theta[:, 1:] * position)
    up, down = (
        (tail.failure_rate * weight) @ failures.T - (tail.survival_rate * weight) @ (trials - failures).T
        for weight in (np.ones_like(position), position)
    )
    first, mixed, last = (np.sum(drawn * a * b, axis=1) for a, b in ((up, up), (up, down), (down, down)))
    return np.stack([np.stack([first, mixed], axis=1), np.stack([mixed, last], axis=1)], axis=1)
