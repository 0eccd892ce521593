"""Whether the data fix a lognormal curve at all: decided exactly, from the order of the levels, never by iterating.

A. Albert and J. A. Anderson, On the existence of maximum likelihood estimates in logistic regression models,
Biometrika 71 (1984) 1-10; their conditions hold for probit as well, and with one covariate they are about order.
"""

from enum import Enum
from functools import cached_property

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.studies.fragility.counts import Counts


class Separation(Enum):
    """How failures and survivals lie along the levels; the values are the sentences that a user reads."""

    OVERLAP = "failures and survivals overlap and failures grow with the level: one lognormal curve is likeliest"
    COMPLETE = "complete separation: all survived up to one level and all failed from the next, so any step between"
    QUASI_COMPLETE = "quasi-complete separation: all survived below one level and all failed above it"
    NONE_FAILED = "nothing failed: the data only say that the curve lies above the levels tried"
    ALL_FAILED = "everything failed: the data only say that the curve lies below the levels tried"
    SINGLE_LEVEL = "one level only: a dispersion cannot be told from it"
    FLAT = "failures do not depend on the level: the dispersion would be infinite"
    DECREASING = "failures become fewer as the level grows: no lognormal fragility in this measure"
    DECREASING_SEPARATED = "all failed below one level and survived above it: no lognormal fragility in this measure"

    @cached_property
    def number(self) -> int:
        """Place in the order of definition, as `classify` returns it."""
        return list(Separation).index(self)

    @property
    def step(self) -> bool:
        """Whether the likelihood grows without end towards a step at some level: dispersion 0."""
        return self in {Separation.COMPLETE, Separation.QUASI_COMPLETE}


FLATNESS = 1e-13
"""Trend over the largest possible one below which it is rounding [-]."""


def classify(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> IntArray:
    """Return how failures and survivals lie along the levels, of many data sets at once.

    levels: distinct levels, ascending [any unit]; failures, trials: one row a data set, one column a level; a level may
    have no trials [-].
    """
    failed, survived = failures > 0.0, trials > failures
    last = levels.size - 1
    first_failed, last_failed = np.argmax(failed, axis=1), last - np.argmax(failed[:, ::-1], axis=1)
    first_survived, last_survived = np.argmax(survived, axis=1), last - np.argmax(survived[:, ::-1], axis=1)
    trend, largest = _trend(levels, failures, trials)
    # the first that holds is the answer
    answers = (
        (Separation.NONE_FAILED, ~failed.any(axis=1)),
        (Separation.ALL_FAILED, ~survived.any(axis=1)),
        (Separation.SINGLE_LEVEL, (trials > 0.0).sum(axis=1) == 1),
        (Separation.COMPLETE, last_survived < first_failed),  # Eq. 200
        (Separation.QUASI_COMPLETE, last_survived == first_failed),  # Eq. 200
        (Separation.DECREASING_SEPARATED, last_failed <= first_survived),
        (Separation.FLAT, np.abs(trend) <= FLATNESS * largest),
        (Separation.DECREASING, trend < 0.0),
    )
    conditions, numbers = [holds for _, holds in answers], [kind.number for kind, _ in answers]
    return np.select(conditions, numbers, Separation.OVERLAP.number).astype(np.int64)


def separation_of(counts: Counts) -> Separation:
    """Return how failures and survivals of one data set lie along the levels.

    >>> from rocking.studies.fragility.counts import count_outcomes
    >>> separation_of(count_outcomes([0.1, 0.2, 0.3, 0.4], [0, 0, 1, 1])).name
    'COMPLETE'
    """
    return list(Separation)[int(classify(counts.levels, counts.failures[None], counts.trials[None])[0])]


def median_interval(counts: Counts, separation: Separation) -> tuple[float | None, float | None]:
    """Return the largest level survived and the smallest failed, where no single median is likeliest.

    Returns the two levels; None where the data bound nothing on that side. After quasi-complete separation both are the
    level where the outcomes are mixed, which is where the likelihood's limit lies and not a certainty.
    """
    survived, failed = counts.levels[counts.survivals > 0.0], counts.levels[counts.failures > 0.0]
    if separation is Separation.NONE_FAILED:
        return float(survived[-1]), None
    if separation is Separation.ALL_FAILED:
        return None, float(failed[0])
    return (float(survived[-1]), float(failed[0])) if separation.step else (None, None)


def _trend(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the score of the slope at slope zero, whose sign is the slope's, and the largest it could be."""
    u = np.log(levels / levels[0])
    total = np.maximum(trials.sum(axis=1), 1.0)
    distance = u - ((trials @ u) / total)[:, None]
    return np.sum(failures * distance, axis=1), np.sum(trials * np.abs(distance), axis=1)  # Eq. 201
