"""Lognormal curves of all states of an analysis."""

from collections.abc import Sequence

from rocking.conventions import FloatArray
from rocking.studies.fragility.lognormal import LognormalFit, fit_counts
from rocking.studies.fragility.pooling import pooled
from rocking.studies.fragility.states import LimitState, Responses
from rocking.studies.fragility.subject import Subject


def fits_of(
    subject: Subject, states: Sequence[LimitState], levels: FloatArray, responses: Responses
) -> dict[str, LognormalFit]:
    """Return the lognormal curve of each state.

    levels: level of the measure of each history [its unit].
    """
    wanted = [state for state in states if state.level > 0.0 or subject.uplift_threshold is None]
    reached = [responses.exceed(state) == 1.0 for state in wanted]
    counts = pooled(levels, responses.good, reached, subject.clusters)
    return {state.name: fit_counts(each) for state, each in zip(wanted, counts, strict=True)}
