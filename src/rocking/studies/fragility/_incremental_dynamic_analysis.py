"""Incremental dynamic analysis: every motion at rising levels, with every interval in which it overturns the body."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.statistics.censored import CensoredFit, fit_crossings
from rocking.statistics.lognormal import LognormalFit
from rocking.studies.fragility._multiple_stripe_analysis import MultipleStripeAnalysis, multiple_stripe_plan
from rocking.studies.fragility._overturning_intervals import OverturningInterval, overturning_intervals, survivals_of
from rocking.studies.fragility.subject import Motions, Progress, Subject, results_of
from rocking.studies.histories import Product

if TYPE_CHECKING:
    import xarray as xr

FIRST_CROSSING = (
    "first crossing: the level of a motion is the lowest at which it overturns the body; what it does above does not "
    "count, and the probability is that this level has been passed"
)
FRACTION = (
    "fraction: the probability at a level is the fraction of the motions that overturn the body at that level, "
    "whatever they do below or above: that of the stripes"
)

OWN, RANDOM = -1, 2
"""Kinds of `ImpactLaw`: one of one's own, and one whose coefficients are drawn."""

OWN_LAW = (
    "the restitution is a law of one's own: boundaries between levels are those of the body only if its factor is the "
    "same whenever a motion is repeated"
)


@dataclass(frozen=True, eq=False)
class IncrementalDynamicAnalysis:
    """The outcome of an incremental analysis.

    A stronger motion may leave standing what a weaker one overturns (resurrection). Two definitions of the probability
    of overturning therefore differ; both are given, each with its name.

    Parameters
    ----------
    stripes : MultipleStripeAnalysis
        The curves: every motion at every level.
    intervals : tuple of OverturningInterval
        All intervals of levels in which a motion overturns the body, by motion and level, of motions without a failed
        history. Survival between overturning to one side and to the other is always found; other intervals of either
        kind that are narrower than the distance between levels may be missed.
    """

    stripes: MultipleStripeAnalysis
    intervals: tuple[OverturningInterval, ...]

    @property
    def subject(self) -> Subject:
        """The body, the motions and the measure."""
        return self.stripes.subject

    @property
    def histories(self) -> Product:
        """What was computed, the search between the levels apart."""
        return self.stripes.histories

    @property
    def levels(self) -> FloatArray:
        """Levels of the measure [its unit]."""
        return self.stripes.levels

    @property
    def curves(self) -> FloatArray:
        """Rotation over alpha, infinite where overturned, of shape (motions, levels) [-]."""
        return self.stripes.responses.rotation

    @property
    def trials(self) -> IntArray:
        """Motions at each level whose history could be computed."""
        return self.stripes.trials

    @property
    def counts(self) -> dict[str, IntArray]:
        """Number of motions that reach each state, by name of the state, at each level."""
        return self.stripes.counts

    @property
    def fits(self) -> dict[str, LognormalFit]:
        """Lognormal curve of each state by the definition "fraction"."""
        return self.stripes.fits

    @property
    def definitions(self) -> dict[str, str]:
        """What is meant by the probability of overturning, both ways."""
        return {"first crossing": FIRST_CROSSING, "fraction": FRACTION}

    @property
    def definition(self) -> str:
        """What is meant in `fits` and `fractions`."""
        return FRACTION

    @property
    def restitution_note(self) -> str:
        """What the boundaries take for granted of a law of one's own; empty for the others."""
        return OWN_LAW if self.histories.law.kind == OWN else ""

    @cached_property
    def complete(self) -> BoolArray:
        """Which motions have no failed history; the others have no first crossing."""
        return np.asarray(self.stripes.responses.good.all(axis=1))

    @property
    def fractions(self) -> FloatArray:
        """Fraction of the motions that overturn the body at each level; NaN where none could be computed [-]."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self.counts["overturned"] / self.trials)

    @cached_property
    def first_crossings(self) -> FloatArray:
        """Lowest level at which each motion overturns the body; infinite if it does not, NaN if one failed."""
        found = np.where(self.complete, math.inf, math.nan)
        for interval in reversed(self.intervals):
            found[interval.motion] = interval.start
        return found

    @cached_property
    def first_crossing_fit(self) -> CensoredFit | None:
        """Lognormal distribution of the first crossings; None if fewer than two motions overturn the body.

        By moments if every motion overturns it, else by maximum likelihood with the others above the highest level.
        """
        return fit_crossings(self.first_crossings[self.complete], float(self.levels[-1]))

    @property
    def survivals(self) -> list[tuple[int, float, float]]:
        """Motion and ends of the levels, above an overturning one, at which it leaves the body standing after all."""
        return survivals_of(self.intervals, float(self.levels[-1]))

    def resurrected(self, wider_than: float = 0.0) -> list[int]:
        """Return which motions leave the body standing at levels above one at which they overturn it.

        Parameters
        ----------
        wider_than : float
            Least width of these levels, over the lowest of them. Long records have survivals as narrow as anyone cares
            to search for, in which the body balances on its corner; a width such as 0.01 leaves these out [-].

        Returns
        -------
        list of int
            Numbers of the motions.
        """
        least = checks.within("wider_than", wider_than, 0.0, 1e6)
        return sorted({motion for motion, low, high in self.survivals if high - low > least * low})

    def share_resurrected(self, wider_than: float = 0.0) -> float:
        """Return the share of resurrected motions among those without a failed history.

        Parameters
        ----------
        wider_than : float
            As for `resurrected` [-].

        Returns
        -------
        float
            From 0 to 1 [-].
        """
        return len(self.resurrected(wider_than)) / max(1, int(self.complete.sum()))

    @property
    def dataset(self) -> "xr.Dataset":
        """All outcomes of the levels, the first crossings and the intervals, with their units."""
        rows = [(i.motion, i.start, i.end) for i in self.intervals]
        motion, start, end = (np.array(column) for column in zip(*rows, strict=True)) if rows else (np.empty(0),) * 3
        words = {f"definition_{name.replace(' ', '_')}": told for name, told in self.definitions.items()}
        return self.stripes.dataset.assign(
            first_crossing=("motion", self.first_crossings, self.subject.label),
            interval_motion=("interval", motion.astype(np.int64), {"units": "1"}),
            interval_start=("interval", start, self.subject.label),
            interval_end=("interval", end, self.subject.label),
        ).assign_attrs(**words)

    def summary(self) -> dict[str, Any]:
        """Return what is printed: both definitions, each with its curve, and the resurrections.

        Returns
        -------
        dict
            Plain values; median in the unit of the measure.
        """
        first = self.first_crossing_fit
        return {
            **self.stripes.summary(),
            "analysis": "incremental",
            "definition": self.definitions,
            "first crossing": first and first.summary(),
            "incomplete motions": np.flatnonzero(~self.complete).tolist(),
            "restitution note": self.restitution_note,
            "motions with resurrection": len(self.resurrected()),
            "share with resurrection": self.share_resurrected(),
            "share with resurrection wider than 1 %": self.share_resurrected(0.01),
        }


def incremental_dynamic_plan(
    body: Body,
    motions: Motions,
    levels: Any,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    *,
    tolerance: float = 1e-8,
    **options: Any,
) -> tuple[Product, Callable[[Arrays], IncrementalDynamicAnalysis]]:
    """Return the histories of an incremental analysis, and what makes the analysis of their results.

    Parameters
    ----------
    body, motions, levels, restitution, measure, states, tolerance, **options
        As for `incremental_dynamic_analysis`.

    Returns
    -------
    histories : Product
        What has to be computed, by a campaign for instance.
    finish : callable
        Takes the results of all histories, searches between the levels, and returns the `IncrementalDynamicAnalysis`.

    Raises
    ------
    InvalidValueError
        If the coefficients of restitution are drawn at random: crossings would not be defined.
    """
    tolerance = checks.within("tolerance", tolerance, 0.0, 0.1)
    threads = options.pop("threads", None)
    histories, stripes = multiple_stripe_plan(body, motions, levels, restitution, measure, states, **options)
    if histories.law.kind == RANDOM or histories.law.per_history:
        raise InvalidValueError(
            f"restitution must be the same whenever a motion is repeated, got {type(histories.law).__name__}: no level "
            "starts the overturning if the coefficients are drawn anew; multiple_stripe_analysis() takes it"
        )

    def finish(arrays: Arrays) -> IncrementalDynamicAnalysis:
        found = stripes(arrays)
        return IncrementalDynamicAnalysis(found, tuple(overturning_intervals(found, tolerance, threads)))

    return histories, finish


def incremental_dynamic_analysis(
    body: Body,
    motions: Motions,
    levels: Any,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    *,
    tolerance: float = 1e-8,
    progress: Progress = None,
    **options: Any,
) -> IncrementalDynamicAnalysis:
    """Raise every motion level by level, and find all intervals in which it overturns the body.

    Parameters
    ----------
    body : Body
        The body.
    motions : GroundMotion or Pulse, a sequence of them, or MotionSet
        All records or all pulses.
    levels : array_like
        Levels of the measure, increasing; between neighbours of unlike outcome the boundary is searched, and below
        the first one down to zero [unit of the measure].
    restitution : as for `simulate`
        Model or its name, number, pair by side, or law.
    measure : str or IntensityMeasure
        A name of `measures`, or ``sa(period)``; one that grows with the motion.
    states : sequence of float
        Rotations over alpha that count as states of their own [-].
    tolerance : float
        Width over level to which the boundaries are searched; 0 for the last bit [-].
    progress : callable, optional
        Called with the number of histories done since the last call; those of the search are not told.
    **options
        ``gravity`` [m/s2], ``engine``, ``threads`` and fields of `Settings`.

    Returns
    -------
    IncrementalDynamicAnalysis
        Curves, intervals and both definitions.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.5, 0.7)]
    >>> found = incremental_dynamic_analysis(rk.Block(width=0.4, height=1.6), pulses, [3.0, 6.0, 9.0], restitution=0.9)
    >>> found.fractions.tolist()  # what overturns at 6 m/s2 need not at 9
    [0.0, 1.0, 0.5]
    >>> [(round(i.start, 3), round(i.end, 3)) for i in found.intervals]
    [(4.789, inf), (3.449, 8.667)]
    """
    histories, finish = incremental_dynamic_plan(
        body, motions, levels, restitution, measure, states, tolerance=tolerance, **options
    )
    return finish(results_of(histories, threads=options.get("threads"), progress=progress))
