"""Multiple stripes: every motion brought to every level of the measure, and how many reach which state there."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import extra
from rocking.statistics.lognormal import LognormalFit
from rocking.studies.fragility.subject import (
    LimitState,
    Motions,
    Progress,
    Responses,
    Subject,
    UpliftCheck,
    checked_levels,
    fits_of,
    limit_states,
    results_of,
    uplift_check,
)
from rocking.studies.histories import Product

if TYPE_CHECKING:
    import xarray as xr

DEFINITION = (
    "stripes: the probability of a state at a level is the fraction of the motions, each multiplied by its own factor "
    "to that level, that reach the state or a worse one there"
)


@dataclass(frozen=True, eq=False)
class MultipleStripeAnalysis:
    """The outcome of a multiple-stripe analysis.

    Parameters
    ----------
    subject : Subject
        The body, the motions and the measure.
    levels : ndarray
        Levels of the measure [its unit].
    states : tuple of LimitState
        From rocking to overturned.
    histories : Product
        What was computed.
    responses : Responses
        States and rotations, of shape (motions, levels).
    """

    subject: Subject
    levels: FloatArray
    states: tuple[LimitState, ...]
    histories: Product
    responses: Responses

    @property
    def definition(self) -> str:
        """What is meant by the probability of a state."""
        return DEFINITION

    @property
    def trials(self) -> IntArray:
        """Number of motions at each level whose history could be computed."""
        return np.asarray(self.responses.good.sum(axis=0, dtype=np.int64))

    @property
    def failed(self) -> int:
        """Number of histories that could not be computed; they count in no level."""
        return int((~self.responses.good).sum())

    @cached_property
    def counts(self) -> dict[str, IntArray]:
        """Number of motions that reach each state, by name of the state, at each level."""
        return {s.name: np.sum(self.responses.exceed(s) == 1.0, axis=0, dtype=np.int64) for s in self.states}

    @property
    def _levels(self) -> FloatArray:
        return np.broadcast_to(self.levels, self.responses.outcome.shape)

    @cached_property
    def fits(self) -> dict[str, LognormalFit]:
        """Lognormal curve of each state, by its name; none for rocking where a level decides it."""
        return fits_of(self.subject, self.states, self._levels, self.responses)

    @cached_property
    def uplift(self) -> UpliftCheck:
        """Check of the histories against the threshold of uplift."""
        return uplift_check(self.subject, self._levels, self.responses)

    @cached_property
    def dataset(self) -> "xr.Dataset":
        """All outcomes, counts and factors with their units, over motion and level."""
        xarray = extra("xarray", "a labelled dataset")
        both = ("motion", "level")
        names = [state.name for state in self.states]
        data: dict[str, Any] = {
            **self.responses.labelled(both),
            "factor": (both, np.asarray(self.histories.scales), {"units": "1", "long_name": "factor on the motion"}),
            "exceeded": (("state", "level"), np.array([self.counts[name] for name in names]), {"units": "1"}),
            "trials": ("level", self.trials, {"units": "1"}),
        }
        levels = ("level", self.levels, self.subject.label)
        coords = {"level": levels, "state": names, "motion_name": ("motion", self.subject.names)}
        more = {"definition": self.definition, "uplift": self.uplift.verdict, "failed": self.failed}
        more["contact"] = self.responses.contact
        made: xr.Dataset = xarray.Dataset(data, coords=coords, attrs=self.subject.about() | more)
        return made

    def summary(self) -> dict[str, Any]:
        """Return what is printed: the definition, the check and the curves.

        Returns
        -------
        dict
            Plain values; median in the unit of the measure.
        """
        return {
            "analysis": "multiple stripes",
            "definition": self.definition,
            "measure": self.subject.measure.name,
            "unit": self.subject.measure.unit,
            "uplift": self.uplift.verdict,
            "failed": self.failed,
            "contact": self.responses.contact,
            "curves": {name: fit.summary() for name, fit in self.fits.items()},
        }


def multiple_stripe_plan(
    body: Body,
    motions: Motions,
    levels: Any,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    **options: Any,
) -> tuple[Product, Callable[[Arrays], MultipleStripeAnalysis]]:
    """Return the histories of a multiple-stripe analysis, and what makes the analysis of their results.

    Parameters
    ----------
    body, motions, levels, restitution, measure, states, **options
        As for `multiple_stripe_analysis`.

    Returns
    -------
    histories : Product
        What has to be computed, by a campaign for instance.
    finish : callable
        Takes the results of all histories and returns the `MultipleStripeAnalysis`.
    """
    subject = Subject.of(body, motions, restitution, measure, options)
    wanted = checked_levels("levels", levels, subject.measure.unit)
    limits = limit_states(states)
    histories = subject.product(subject.measure.factors(subject.intensities, wanted))
    shape = (len(subject.motions), wanted.size)

    def finish(arrays: Arrays) -> MultipleStripeAnalysis:
        return MultipleStripeAnalysis(
            subject, wanted, limits, histories, Responses.of(arrays, subject.parameters, shape)
        )

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
    body : Body
        The body.
    motions : GroundMotion or Pulse, a sequence of them, or MotionSet
        All records or all pulses.
    levels : array_like
        Levels of the measure, increasing [unit of the measure].
    restitution : as for `simulate`
        Model or its name, number, pair by side, or law.
    measure : str or IntensityMeasure
        A name of `measures`, or ``sa(period)``; one that grows with the motion.
    states : sequence of float
        Rotations over alpha that count as states of their own [-].
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        ``gravity`` [m/s2], ``engine``, ``threads`` and fields of `Settings`.

    Returns
    -------
    MultipleStripeAnalysis
        Outcomes, counts and curves.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.4, 0.6, 0.8, 1.0)]
    >>> found = multiple_stripe_analysis(rk.Block(width=0.4, height=1.6), pulses, [2.0, 4.0, 6.0, 8.0])
    >>> found.counts["rocking"].tolist()
    [0, 4, 4, 4]
    >>> found.uplift.verdict
    'rocking is certain above 2.45166 and impossible below: 0 of 16 histories contradict it'
    """
    threads = options.pop("threads", None)
    histories, finish = multiple_stripe_plan(body, motions, levels, restitution, measure, states, **options)
    return finish(results_of(histories, threads=threads, progress=progress))
