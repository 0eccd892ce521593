"""Cloud analysis: the motions as they are, a regression of the rotation on the measure, and overturning apart."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.dynamics.engine import Arrays
from rocking.studies.fragility.barely_lifted import LEAST, checked_least
from rocking.studies.fragility.cloud_analysis import CloudAnalysis
from rocking.studies.fragility.states import Responses, limit_states
from rocking.studies.fragility.subject import Motions, Progress, Subject, results_of
from rocking.studies.histories import Product

__all__ = ["CloudAnalysis", "cloud", "cloud_plan"]


def cloud_plan(
    body: Body,
    motions: Motions,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    *,
    factor: float = 1.0,
    least: float = LEAST,
    **options: Any,
) -> tuple[Product, Callable[[Arrays], CloudAnalysis]]:
    """Return the histories of a cloud analysis, and what makes the analysis of their results.

    Parameters
    ----------
    body, motions, restitution, measure, states, factor, least, **options
        As for `cloud`.

    Returns
    -------
    histories : Product
        What has to be computed, by a campaign for instance.
    finish : callable
        Takes the results of all histories and returns the `CloudAnalysis`.
    """
    subject = Subject.of(body, motions, restitution, measure, options)
    factor, least = checks.positive("factor", factor), checked_least(least)
    levels = subject.measure.scaled(subject.intensities, factor)
    limits = limit_states(states)
    histories = subject.product(np.array([factor]))

    def finish(arrays: Arrays) -> CloudAnalysis:
        responses = Responses.of(arrays, subject.rocker, (len(subject.motions),))
        return CloudAnalysis(subject, levels, limits, histories, responses, least)

    return histories, finish


def cloud(
    body: Body,
    motions: Motions,
    restitution: Any = "ked",
    measure: Any = "pga",
    states: Sequence[float] = (0.5,),
    *,
    factor: float = 1.0,
    least: float = LEAST,
    progress: Progress = None,
    **options: Any,
) -> CloudAnalysis:
    """Take the motions as they are, and relate rotation and overturning to a measure of them.

    Parameters
    ----------
    body : Body
        The body.
    motions : GroundMotion or Pulse, a sequence of them, or MotionSet
        All records or all pulses.
    restitution : as for `simulate`
        Model or its name, number, pair by side, or law.
    measure : str or IntensityMeasure
        A name of `measures`, or ``sa(period)``.
    states : sequence of float
        Rotations over alpha that count as states of their own [-].
    factor : float
        One factor on all motions [-].
    least : float
        Rotation over alpha below which a history counts as barely lifted, and is left out of the line [-].
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        ``gravity`` [m/s2], ``engine``, ``threads`` and fields of `Settings`.

    Returns
    -------
    CloudAnalysis
        Outcomes, the line and the curves.

    Examples
    --------
    >>> import rocking as rk
    >>> pulses = [rk.pulses.sine(a, 0.6) for a in (2.0, 2.6, 2.8, 3.0, 3.2, 6.0, 8.0)]
    >>> found = cloud(rk.Block(width=0.4, height=1.6), pulses)
    >>> {outcome.name: n for outcome, n in found.responses.counts().items()}
    {'NO_UPLIFT': 1, 'ROCKED': 4, 'OVERTURNED': 2}
    """
    threads = options.pop("threads", None)
    histories, finish = cloud_plan(body, motions, restitution, measure, states, factor=factor, least=least, **options)
    return finish(results_of(histories, threads=threads, progress=progress))
