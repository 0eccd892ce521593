"""Incremental analysis: every motion at rising levels, with every interval in which it overturns the body."""

from collections.abc import Callable, Sequence
from typing import Any

from rocking import checks
from rocking.bodies import Body
from rocking.dynamics.engine import Arrays
from rocking.errors import InvalidValueError
from rocking.studies.fragility.crossings import overturning_intervals
from rocking.studies.fragility.incremental_analysis import RANDOM, IncrementalAnalysis
from rocking.studies.fragility.stripes import stripes_plan
from rocking.studies.fragility.subject import Motions, Progress, results_of
from rocking.studies.histories import Product

__all__ = ["IncrementalAnalysis", "incremental", "incremental_plan"]


def incremental_plan(
    body: Body,
    motions: Motions,
    levels: Any,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    *,
    tolerance: float = 1e-8,
    **options: Any,
) -> tuple[Product, Callable[[Arrays], IncrementalAnalysis]]:
    """Return the histories of an incremental analysis, and what makes the analysis of their results.

    Parameters
    ----------
    body, motions, levels, restitution, measure, states, tolerance, **options
        As for `incremental`.

    Returns
    -------
    histories : Product
        What has to be computed, by a campaign for instance.
    finish : callable
        Takes the results of all histories, searches between the levels, and returns the `IncrementalAnalysis`.

    Raises
    ------
    InvalidValueError
        If the coefficients of restitution are drawn at random: crossings would not be defined.
    """
    tolerance = checks.within("tolerance", tolerance, 0.0, 0.1)
    threads = options.pop("threads", None)
    histories, stripes = stripes_plan(body, motions, levels, restitution, measure, states, **options)
    if histories.law.kind == RANDOM or histories.law.per_history:
        raise InvalidValueError(
            f"restitution must be the same whenever a motion is repeated, got {type(histories.law).__name__}: no level "
            "starts the overturning if the coefficients are drawn anew; multiple_stripes() takes it"
        )

    def finish(arrays: Arrays) -> IncrementalAnalysis:
        found = stripes(arrays)
        return IncrementalAnalysis(found, tuple(overturning_intervals(found, tolerance, threads)))

    return histories, finish


def incremental(
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
) -> IncrementalAnalysis:
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
    IncrementalAnalysis
        Curves, intervals and both definitions.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(1.0, period) for period in (0.5, 0.7)]
    >>> found = incremental(rk.Block(width=0.4, height=1.6), pulses, [3.0, 6.0, 9.0], restitution=0.9)
    >>> found.fractions.tolist()  # what overturns at 6 m/s2 need not at 9
    [0.0, 1.0, 0.5]
    >>> [(round(i.start, 3), round(i.end, 3)) for i in found.intervals]
    [(4.789, inf), (3.449, 8.667)]
    """
    histories, finish = incremental_plan(
        body, motions, levels, restitution, measure, states, tolerance=tolerance, **options
    )
    return finish(results_of(histories, threads=options.get("threads"), progress=progress))
