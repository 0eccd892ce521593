"""Multiple stripes: every motion brought to every level of the measure, and how many reach which state there."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.studies.fragility.subject import (
    FragilityAnalysis,
    Motions,
    Progress,
    Responses,
    Subject,
    checked_levels,
    limit_states,
)
from rocking.studies.histories import Product, results_of

if TYPE_CHECKING:
    import xarray as xr

DEFINITION = (
    "stripes: the probability of a state at a level is the fraction of the motions, each multiplied by its own factor "
    "to that level, that reach the state or a worse one there"
)


@dataclass(frozen=True, eq=False, repr=False)
class MultipleStripeAnalysis(FragilityAnalysis):
    """The outcome of a multiple stripe analysis; states and rotations are of shape (motions, levels)."""

    levels: FloatArray  # levels of the measure [its unit]

    kind = "multiple stripes"
    definition = DEFINITION

    @property
    def history_levels(self) -> FloatArray:
        return np.broadcast_to(self.levels, self.responses.outcome.shape)

    @property
    def trials(self) -> IntArray:
        """Number of motions at each level whose history could be computed."""
        return np.asarray(self.responses.good.sum(axis=0, dtype=np.int64))

    @cached_property
    def counts(self) -> dict[str, IntArray]:
        """Number of motions that reach each state, by name of the state, at each level."""
        return {s.name: np.sum(self.responses.exceed(s) == 1.0, axis=0, dtype=np.int64) for s in self.states}

    @cached_property
    def dataset(self) -> "xr.Dataset":
        """All outcomes, counts and factors with their units, over motion and level."""
        both = ("motion", "level")
        names = [state.name for state in self.states]
        data: dict[str, Any] = {
            **self.responses.labelled(both),
            "factor": (both, np.asarray(self.histories.scales), {"units": "1", "long_name": "factor on the motion"}),
            "exceeded": (("state", "level"), np.array([self.counts[name] for name in names]), {"units": "1"}),
            "trials": ("level", self.trials, {"units": "1"}),
        }
        return self._labelled(data, {"level": ("level", self.levels, self.subject.label), "state": names}, DEFINITION)


def multiple_stripe_plan(
    body: Body,
    motions: Motions,
    levels: Any,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    **options: Any,
) -> tuple[Product, Callable[[Arrays], MultipleStripeAnalysis]]:
    """Return the histories of a multiple stripe analysis, and what makes the analysis of their results."""
    subject = Subject.of(body, motions, restitution, measure, options)
    at = checked_levels("levels", levels, subject.measure.unit)
    limits = limit_states(states)
    histories = subject.product(subject.measure.factors(subject.intensities, at))
    shape = (len(subject.motions), at.size)

    def finish(arrays: Arrays) -> MultipleStripeAnalysis:
        return MultipleStripeAnalysis(subject, limits, histories, Responses.of(arrays, subject.parameters, shape), at)

    return histories, finish


def multiple_stripe_analysis(
    body: Body,
    motions: Motions,
    levels: Any,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    *,
    progress: Progress = None,
    **options: Any,
) -> MultipleStripeAnalysis:
    """Bring every motion to every level of a measure, and count how many reach which state.

    Parameters
    ----------
    body, motions, levels, restitution, measure, states, progress, **options
        As for `rocking.fragility`.

    Returns
    -------
    MultipleStripeAnalysis
        Outcomes, counts and curves.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.4, 0.6, 0.8, 1.0)]
    >>> analysis = multiple_stripe_analysis(rk.Block(width=0.4, height=1.6), pulses, [2.0, 4.0, 6.0, 8.0])
    >>> analysis.counts["rocking"].tolist()
    [0, 4, 4, 4]
    >>> analysis.uplift.verdict
    'rocking is certain above 2.45166 and impossible below: 0 of 16 histories contradict it'
    """
    threads = options.pop("threads", None)
    histories, finish = multiple_stripe_plan(body, motions, levels, restitution, measure, states, **options)
    return finish(results_of(histories, threads=threads, progress=progress))
