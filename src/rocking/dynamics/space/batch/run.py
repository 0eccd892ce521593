"""The rows of a batch by the compiled engine, piece by piece, or by the reference engine, one by one."""

import math
import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.batch import engine, tables
from rocking.dynamics.space.batch.one import results_of
from rocking.dynamics.space.batch.result import FLOATS, WHOLES
from rocking.dynamics.space.batch.rows import RowTable
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.ground import SpatialGround
from rocking.dynamics.space.impact_laws import law_of
from rocking.dynamics.space.reference import SpatialReference
from rocking.errors import InvalidValueError, RockingError
from rocking.outcome import Outcome, Status

PIECE = 1 << 15
"""Histories handed to the engine at a time: memory beside the results does not grow with their number."""

Bodies = Sequence[SpatialBody | None]
Results = dict[str, np.ndarray]
Progress = Callable[[int], None] | None


def stock_of(bodies: Bodies, grounds: Sequence[SpatialGround], table: RowTable, gravity: float) -> Any:
    """Return bodies and motions as the compiled engine keeps them.

    gravity: acceleration of gravity [m/s2].
    """
    numbers, corners, vertices = tables.body_table(bodies, gravity)
    kept = tables.kept_table(bodies) if any(law.needs_moments for law in table.laws) else np.zeros(0)
    needed = any(law.needs_positions for law in table.laws)
    places, positions = tables.position_table(bodies if needed else [None] * len(bodies))
    degree, motions, times, accelerations = tables.motion_table(grounds)
    return engine.module().Stock(
        numbers,
        np.column_stack([corners, places]),
        vertices,
        kept,
        positions,
        degree,
        motions,
        times,
        accelerations,
        engine.instruction_set(),
    )


def limits_of(settings: Settings) -> dict[str, Any]:
    """Return settings as the compiled engine names them."""
    return {
        "gravity": settings.gravity,
        "rest_speed": settings.rest_speed,
        "tolerance": settings.tolerance,
        "longest": settings.longest_step,
        "most_events": settings.most_events,
    }


def run_compiled(
    bodies: Bodies,
    grounds: Sequence[SpatialGround],
    table: RowTable,
    settings: Settings,
    threads: int | None,
    progress: Progress,
) -> tuple[Results, str]:
    """Return the results of all rows by the compiled engine."""
    given: object = threads
    if given is not None and (isinstance(given, bool) or not isinstance(given, int) or given < 1):
        raise InvalidValueError(f"threads must be a whole number >= 1, got {threads!r}")
    stock = stock_of(bodies, grounds, table, settings.gravity)
    results, counts = np.empty((len(table), tables.RESULTS)), np.empty((len(table), tables.COUNTS), np.int64)
    crew = threads or _processors()
    for first in range(0, len(table), PIECE):
        last = min(first + PIECE, len(table))
        numbers, choices = table.piece(first, last)
        stock.run(numbers, choices, results[first:last], counts[first:last], threads=crew, **limits_of(settings))
        if progress is not None:
            progress(last - first)
    used = f"fast ({engine.instruction_set()}; Taylor, order up to 16, tolerance {settings.tolerance:g})"
    return named(results, counts), used


def run_reference(
    bodies: Bodies,
    grounds: Sequence[SpatialGround],
    table: RowTable,
    settings: Settings,
    progress: Progress,
) -> tuple[Results, str]:
    """Return the results of all rows by the reference engine."""
    results, counts = np.full((len(table), tables.RESULTS), np.nan), np.empty((len(table), tables.COUNTS), np.int64)
    fields = Settings(
        settings.gravity, rest_speed=settings.rest_speed, most_events=settings.most_events, mechanics="space"
    )
    for k in range(len(table)):
        numbers, choices = table.piece(k, k + 1)
        law = int(np.unravel_index(k, table.shape)[3])
        body, ground = bodies[choices[0, 0]], grounds[choices[0, 1]]
        results[k], counts[k] = _one(body, ground, table.laws[law].law or table.laws[law].label, numbers[0], fields)
        if progress is not None:
            progress(1)
    return named(results, counts), "reference, row by row"


def named(results: FloatArray, counts: IntArray) -> Results:
    """Return the columns of the tables of results by name."""
    made: Results = {name: np.ascontiguousarray(counts[:, k]) for k, name in enumerate(WHOLES)}
    return made | {name: np.ascontiguousarray(results[:, k]) for k, name in enumerate(FLOATS)}


def _one(
    body: SpatialBody | None, ground: SpatialGround, law: Any, row: FloatArray, settings: Settings
) -> tuple[FloatArray, list[int]]:
    codes = [Outcome.FAILED.code, Status.INVALID.code, -1, -1]
    refused = np.full(tables.RESULTS, math.nan), [*codes, 0, 0, 0, 0, 0]
    if body is None or not (np.abs(row) <= 1e9).all():
        return refused
    scaled = SpatialGround(ground.times, row[1] * ground.coefficients)
    try:
        found = SpatialReference(body, scaled, law_of(law, body), settings).run(row[3:7], row[7:10], float(row[2]))
    except RockingError:
        return refused
    return results_of(found)


def _processors() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1
