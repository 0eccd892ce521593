"""Whether the data fix a lognormal curve at all, and what can be claimed from them in plain words.

Decided exactly, from the order of the levels, never by iterating: A. Albert and J. A. Anderson, On the existence of
maximum likelihood estimates in logistic regression models, Biometrika 71 (1984) 1-10; their conditions hold for probit
as well, and with one covariate they are about order.
"""

from enum import Enum
from functools import cached_property

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.statistics.counts import Counts

FLATNESS = 1e-13  # trend over the largest possible one below which it is rounding [-]
LEVEL = 0.95  # confidence level of the bounds that a verdict states [-]


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


def classify(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> IntArray:
    """Return how failures and survivals lie along ascending levels, of many data sets, one row each, at once."""
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

    >>> from rocking.statistics.counts import count_outcomes
    >>> separation_of(count_outcomes([0.1, 0.2, 0.3, 0.4], [0, 0, 1, 1])).name
    'COMPLETE'
    """
    return list(Separation)[int(classify(counts.levels, counts.failures[None], counts.trials[None])[0])]


def median_interval(counts: Counts, separation: Separation) -> tuple[float | None, float | None]:
    """Return the largest level survived and the smallest failed, where no single median is likeliest; None where open.

    After quasi-complete separation both are the level where the outcomes are mixed, which is where the likelihood's
    limit lies and not a certainty.
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


def verdict_of(counts: Counts, separation: Separation, curve: tuple[float, float] | None, rise: float | None) -> str:
    """Return what the outcomes allow to be said, in a sentence or two, and what the likelihood does not know."""
    # The curve is median and dispersion; `rise` its likelihood ratio against a line that does not depend on the level,
    # a chi-square of one degree of freedom; None for a penalised fit.
    parts = [_finding(counts, separation, curve, penalised=rise is None)]
    if rise is not None and rise < 3.841:
        parts.append("Chance alone explains the growth with the level (5 % test): intervals may be open.")
    if curve is not None and counts.is_clustered:
        parts.append(_clustered(counts))
    return " ".join(parts)


def _clustered(counts: Counts) -> str:
    if counts.scarcity:
        return (
            f"Intervals are those of the likelihood and may be much too narrow: they take the outcomes of one cluster"
            f" for independent; the bootstrap of whole clusters has too few of them ({counts.scarcity})."
        )
    how = "draws a capacity for each" if counts.draws_capacities else "draws whole clusters"
    return (
        f"Outcomes of one cluster are not independent: intervals are from the bootstrap, which {how};"
        " likelihood intervals would be too narrow."
    )


def _finding(counts: Counts, separation: Separation, curve: tuple[float, float] | None, *, penalised: bool) -> str:
    levels, sentence = counts.levels, separation.value[0].upper() + separation.value[1:]
    size = f"{counts.observations} outcomes at {levels.size} {'level' if levels.size == 1 else 'levels'}"
    shown = "" if curve is None else f"median {curve[0]:.4g}, dispersion {curve[1]:.3g}"
    if separation is Separation.OVERLAP and curve is None:
        return f"{size} give no curve: the likeliest rises so little, if at all, that it has no median."
    if separation is Separation.OVERLAP:
        what = (
            "penalised likelihood has its highest maximum found" if penalised else "likelihood is proven to be largest"
        )
        return f"{size} give {shown}, where the {what}."
    if separation.step:
        low, high = levels[counts.survivals > 0.0][-1], levels[counts.failures > 0.0][0]
        where = f"between {low:g} and {high:g}" if high > low else f"at {low:g}"
        return (
            f"{sentence}. {size} have no likeliest curve: the likelihood grows towards a step {where},"
            " with dispersion 0."
            + (f" The penalised likelihood gives {shown}: a convention, not a finding." if curve else "")
        )
    if separation in {Separation.NONE_FAILED, Separation.ALL_FAILED}:
        return f"{sentence}. {_bound(counts, separation)} No curve is fitted."
    return f"{sentence}. No curve is fitted to {size}."


def _bound(counts: Counts, separation: Separation) -> str:
    none = separation is Separation.NONE_FAILED
    place = -1 if none else 0
    trials = counts.trials[place]
    # the one-sided Clopper-Pearson bound on a probability of which no trial failed, near 3 / trials for 95 %
    share = float(1.0 - (1.0 - LEVEL) ** (1.0 / float(trials)))  # Eq. 227
    what, text = ("failed", f"below {share:.3g}") if none else ("survived", f"above {1.0 - share:.3g}")
    return (
        f"At {counts.levels[place]:g} none of {trials:g} {what}: there the probability of failure is {text}"
        f" (confidence {LEVEL:.0%})."
    )
