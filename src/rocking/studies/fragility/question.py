"""A fragility analysis before the computation: subject, histories, and analysis of their results."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.motions.filters import geometric
from rocking.studies.fragility.cloud_analysis import MIN_ROTATION, CloudAnalysis, checked_min_rotation
from rocking.studies.fragility.incremental_dynamic_analysis import (
    IncrementalDynamicAnalysis,
    check_repeatable,
    overturning_intervals,
)
from rocking.studies.fragility.limit_states import LimitState, limit_states_of
from rocking.studies.fragility.multiple_stripe_analysis import MultipleStripeAnalysis
from rocking.studies.fragility.subject import Progress, Responses, Subject, checked_levels
from rocking.studies.histories import Product, results_of

ANALYSES = ("stripes", "cloud", "incremental")

_MOST_FACTOR = 1e6  # largest scale factor of a motion, as in all histories [-]
_REACH = (0.9, 9.0, 16)
"""Default levels in equal ratios: lowest and highest level over the uplift level, and number of levels."""


@dataclass(frozen=True, eq=False)
class FragilityQuestion:
    """A subject, the requested analysis, and its histories."""

    subject: Subject
    analysis: str  # one of `ANALYSES`
    limit_states: tuple[LimitState, ...]
    levels: FloatArray  # levels of the stripes, or for a cloud the levels of the motions [unit of the measure]
    histories: Product
    min_rotation: float  # smallest rotation / alpha of a history in the regression of a cloud [-]
    tolerance: float  # relative width at which an incremental search ends [-]

    @classmethod
    def of(
        cls, subject: Subject, analysis: str = "stripes", levels: Any = None,
        limit_states: Sequence[float | str] = (0.5,), *, scale: float | None = None, min_rotation: float | None = None,
        tolerance: float | None = None,
    ) -> Self:  # fmt: skip
        """Return the question. Parameters are those of `rocking.fragility`. Only intensities are computed."""
        kind, measure = checks.one_of("analysis", analysis, ANALYSES), subject.measure
        states = limit_states_of(limit_states)
        subject.check_states(states)
        odd = [name for name, value in (("scale", scale), ("min_rotation", min_rotation)) if value is not None]
        if odd and kind != "cloud":
            raise InvalidValueError(
                '{parameter} is for analysis="cloud" only, this is "{kind}"', parameter=odd[0], kind=kind
            )
        min_rotation = checked_min_rotation(MIN_ROTATION if min_rotation is None else min_rotation)
        tolerance = checks.within("tolerance", 1e-8 if tolerance is None else tolerance, 0.0, 0.1)
        if kind == "cloud":
            if levels is not None:
                raise InvalidValueError("A cloud uses the motions as recorded. Remove levels.")
            scale = checks.positive("scale", 1.0 if scale is None else scale)
            at, factors = measure.scaled(subject.intensities, scale), np.array([scale])
        else:
            at = default_levels(subject) if levels is None else checked_levels("levels", levels, measure.unit)
            factors = measure.factors(subject.intensities, at)
            _check_factors(subject, factors)
        histories = subject.product(factors)
        if kind == "incremental":
            check_repeatable(histories.law)
        return cls(subject, kind, states, at, histories, min_rotation, tolerance)

    def answer(self, arrays: Arrays, threads: int | None = None) -> MultipleStripeAnalysis | CloudAnalysis:
        """Return the analysis of the results of the histories. An incremental analysis then searches its intervals."""
        shape = (len(self.subject.motions), *(self.levels.shape if self.analysis != "cloud" else ()))
        responses = Responses.of(arrays, self.subject.parameters, shape, self.subject.restraints)
        common = self.subject, self.limit_states, self.histories, responses, self.levels
        if self.analysis == "cloud":
            return CloudAnalysis(*common, self.min_rotation)
        stripes = MultipleStripeAnalysis(*common)
        if self.analysis == "stripes":
            return stripes
        return IncrementalDynamicAnalysis(*common, tuple(overturning_intervals(stripes, self.tolerance, threads)))

    def computed(self, threads: int | None = None, progress: Progress = None) -> MultipleStripeAnalysis | CloudAnalysis:
        """Return the analysis. The histories are computed in memory."""
        return self.answer(results_of(self.histories, threads=threads, progress=progress), threads)


def _check_factors(subject: Subject, factors: FloatArray) -> None:
    """Raise an error if a motion, such as a dead channel, needs a scale factor above the limit."""
    lowest = np.atleast_2d(factors).min(axis=1)
    if (worst := int(lowest.argmax())) >= 0 and not lowest[worst] <= _MOST_FACTOR:
        value, unit = float(subject.intensities[worst]), subject.measure.unit
        raise InvalidValueError(
            "motion {motion!r:.80} has {measure} = {amount:.3g} {unit}. It needs a scale factor of {factor:.3g} to "
            "reach the lowest level; at most {limit:g} is allowed", motion=subject.motions[worst].name,
            measure=subject.measure.name, amount=value, unit=unit, factor=lowest[worst], limit=_MOST_FACTOR,
            hint="check for a dead channel, or remove the motion",
        )  # fmt: skip


def default_levels(subject: Subject) -> FloatArray:
    """Return levels around the uplift level of the body, for a measure with an uplift level."""
    if subject.measure.uplift is None:
        raise InvalidValueError(
            "levels of {measure} are missing. Add levels in {unit}.",
            measure=subject.measure.name,
            unit=subject.measure.unit,
        )
    low, high, count = _REACH
    uplift = subject.measure.uplift(subject.scale)
    return geometric(low * uplift, high * uplift, count)
