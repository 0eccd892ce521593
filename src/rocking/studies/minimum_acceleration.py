"""Minimum overturning acceleration: every amplitude at which a body begins or ceases to overturn under a motion."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking import conventions
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.response import Motion
from rocking.dynamics.settings import settings_of
from rocking.errors import InvalidValueError
from rocking.studies.crossings import Crossings
from rocking.studies.minimum_search import Cases, Effort, searched
from rocking.studies.question import Question, sides_of


def minimum_overturning_acceleration(
    body: Body,
    motion: Motion,
    restitution: Any = "ked",
    *,
    lowest: float | None = None,
    highest: float | None = None,
    points: int = 400,
    tolerance: float = 1e-12,
    **options: Any,
) -> Crossings:
    """Return all peak accelerations at which the verdict changes, not the first alone.

    The motion is scaled over a range of amplitudes in equal ratios; intervals in which a thin stretch may hide are
    halved several times; then all changes are bisected together. Under long records overturning and survival may be
    interleaved at all scales: then only what the samples show is listed. Below the least amplitude that overturns
    a record is sampled in further rounds, of as many points each, until the minimum has held for two of them or four
    are done.

    Parameters
    ----------
    body : Body
        The body.
    motion : GroundMotion or Pulse
        The motion, of any amplitude above zero.
    restitution : as for `simulate`
        One that is drawn at random draws the same numbers at every amplitude.
    lowest, highest : float, optional
        Peak accelerations between which to look [m/s2]; if not given 1 (0.1 with a vertical part) and 50 times
        the one that lifts the body.
    points : int
        First samples, in equal ratios, and those of each round below the minimum; nothing wider than their spacing is
        missed [-].
    tolerance : float
        Width of the last brackets over the acceleration; 0 for neighbouring doubles [-].
    **options
        ``levels`` (how often suspicious intervals are halved, 0 to 12, else 4), ``gravity`` [m/s2], ``threads``,
        ``progress`` (called with the number of histories done since the last call), ``engine`` and fields of
        `Settings`.

    Returns
    -------
    Crossings
        All of them, in order.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the motion is zero throughout.

    Examples
    --------
    A full sine of three times the frequency parameter: overturned after an impact, safe again, and overturned
    without impact.

    >>> import math
    >>> import rocking as rk
    >>> block = rk.Block.from_angle(0.2, 1.0)
    >>> pulse = rk.pulses.sine(1.0, 2.0 * math.pi / (3.0 * block.frequency_parameter))
    >>> found = minimum_overturning_acceleration(block, pulse, 0.85)
    >>> found.modes.tolist()
    [[-1, 1], [1, -1], [-1, 0]]
    """
    if not isinstance(body, Body):
        raise InvalidValueError(
            f"body must be a Block, Section or MassPoints, got {body!r:.60}; for several bodies "
            "there is minimum_overturning_accelerations"
        )
    told: dict[str, Any] = {"lowest": lowest, "highest": highest, "points": points, "tolerance": tolerance}
    return minimum_overturning_accelerations([body], motion, restitution, **told, **options)[0]


def minimum_overturning_accelerations(  # noqa: PLR0913 - every one of them is a question that users ask
    bodies: Sequence[Body],
    motion: Motion,
    restitution: Any = "ked",
    *,
    lowest: float | None = None,
    highest: float | None = None,
    points: int = 400,
    levels: int = 4,
    tolerance: float = 1e-12,
    gravity: float = conventions.g,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    **settings: Any,
) -> tuple[Crossings, ...]:
    """Return what `minimum_overturning_acceleration` does for many bodies, computed together.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    motion : GroundMotion or Pulse
        The motion, of any amplitude above zero.
    restitution : as for `simulate`
        Evaluated for every body.
    lowest, highest : float, optional
        Peak accelerations between which to look [m/s2].
    points : int
        First samples, in equal ratios [-].
    levels : int
        How often suspicious intervals are halved, from 0 to 12 [-].
    tolerance : float
        Width of the last brackets over the acceleration [-].
    gravity : float
        Acceleration of gravity [m/s2].
    threads : int, optional
        Threads of the fast engine; the results do not depend on them.
    progress : callable, optional
        Called with the number of histories done since the last call.
    **settings
        ``engine`` and fields of `Settings`.

    Returns
    -------
    tuple of Crossings
        One for each body.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the motion is zero throughout.
    """
    given: object = bodies
    if not isinstance(given, Sequence) or not given:
        raise InvalidValueError(f"bodies must be a sequence of at least one body, got {bodies!r:.60}")
    engine = settings.pop("engine", "auto")
    question = Question(bodies[0], motion, restitution, settings_of(gravity, settings), threads, engine)
    effort = Effort(points, levels, tolerance)
    sides = sides_of([question.rocker_of(b) for b in bodies])
    cases = Cases.of(motion, sides, question.settings, lowest, highest)

    def run(values: dict[str, FloatArray], body: IntArray) -> Arrays:
        return question.run(values, np.ones(body.size), body, progress)[0]

    found = []
    for k, each in enumerate(searched(cases, effort, run)):
        if each is None:
            raise InvalidValueError(
                f"no history of body {k} could be computed; is the range of accelerations too wide?"
            )
        found.append(each)
    return tuple(found)
