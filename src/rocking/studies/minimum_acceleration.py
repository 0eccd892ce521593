"""Minimum overturning acceleration: every amplitude at which a body begins or ceases to overturn under a motion."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.dynamics.histories import settings_of
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.studies.below import below, search_below
from rocking.studies.crossings import Crossings
from rocking.studies.question import FAILED, Question, sides_of
from rocking.studies.scan import Scan

# range searched over the acceleration that lifts the body, and how far below it where a vertical part lightens it
_FROM, _FROM_VERTICAL, _TO = 1.0, 0.1, 50.0
_MOST_POINTS = 1_000_000


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
    _check(question, points, levels)
    tolerance = checks.within("tolerance", tolerance, 0.0, 0.1)
    sides = sides_of([question.rocker_of(b) for b in bodies])
    uplift, ends = _range(question, sides, lowest, highest)
    grid = np.geomspace(ends[0], ends[1], points, axis=1) / motion.peak
    scan = Scan(question, sides, grid, progress)
    if isinstance(motion, GroundMotion):
        search_below(scan, points)
    for _ in range(levels):
        scan.zoom()
    scan.hunt()
    return _crossings(scan, tolerance, uplift, ends, points)


def _check(question: Question, points: object, levels: object) -> None:
    for name, value, low, high in (("points", points, 2, _MOST_POINTS), ("levels", levels, 0, 12)):
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise InvalidValueError(f"{name} must be a whole number in [{low}, {high}], got {value!r:.60}")
    if not question.motion.peak > 0.0:
        raise InvalidValueError(f"motion must have a peak above zero to be scaled, got {question.motion.name!r}")


def _range(
    question: Question, sides: dict[str, FloatArray], lowest: float | None, highest: float | None
) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Return the accelerations that lift the bodies, and between which to look."""
    gravity, linear, motion = question.settings.gravity, question.settings.linear, question.motion
    both = np.stack([sides["alpha_right"], sides["alpha_left"]])
    lifts = gravity * (both if linear else np.tan(both))
    light = isinstance(motion, GroundMotion) and motion.vertical is not None
    low = (_FROM_VERTICAL if light else _FROM) * lifts.min(axis=0)
    high = _TO * lifts.max(axis=0)
    if lowest is not None:
        low = np.full_like(low, checks.positive("lowest", lowest, "m/s2"))
    if highest is not None:
        high = np.full_like(high, checks.positive("highest", highest, "m/s2"))
    bad = np.flatnonzero(~(low < high))
    if bad.size:
        k = bad[0]
        raise InvalidValueError(f"lowest must be below highest, got {low[k]:g} and {high[k]:g} m/s2 for body {k}")
    return lifts.min(axis=0), (low, high)


def _crossings(
    scan: Scan, tolerance: float, uplift: FloatArray, ends: tuple[FloatArray, FloatArray], points: int
) -> tuple[Crossings, ...]:
    found, peak = scan.brackets(tolerance), scan.question.motion.peak
    gaps = {k: each.gap for k, each in below(scan.samples.good).items()}
    made = []
    for k in range(uplift.size):
        own, mine = found.body == k, scan.samples.body == k
        modes = scan.samples.mode[mine]
        good = modes[modes != FAILED]
        if not good.size:
            raise InvalidValueError(
                f"no history of body {k} could be computed; is the range of accelerations too wide?"
            )
        scale, low, high = found.ends[own].mean(axis=1), float(ends[0][k]), float(ends[1][k])
        made.append(
            Crossings(
                scale * peak, scale * peak / uplift[k], scale, found.modes[own], np.diff(found.ends[own])[:, 0] * peak,
                low, high, float(uplift[k]), (high / low) ** (1.0 / (points - 1)) - 1.0, bool(good[0] >= 0),
                int(modes.size), int(np.sum(modes == FAILED)), gaps.get(k, math.nan),
            )
        )  # fmt: skip
    return tuple(made)
