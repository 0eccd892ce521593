"""The compiled engine of hulls: bodies, motions and rows as the tables that it takes, and its results by name."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.history import HullSettings
from rocking.dynamics.settings import CompiledEngine
from rocking.dynamics.space.ground import SpatialGround
from rocking.errors import InvalidValueError
from rocking.restitution.space.impulse_position import HIGHEST, impulse_position

FLOATS = (
    "peak_tilt", "peak_time", "peak_spin", "overturning_time", "direction", "first_uplift", "sliding_distance",
    "residual_displacement", "end_time", "lost",
)  # fmt: skip
WHOLES = (
    "outcome", "status", "pose", "impacts", "uplifts", "events", "steps", "held", "replaced", "still_rocking",
)  # fmt: skip
HOUSNER, POSITION, COEFFICIENT, KED = range(4)
MOST_POWERS = 8

_COMPILED = CompiledEngine(
    "rocking.dynamics._hull",
    "the batch engine of hulls was not built: it takes a C++17 compiler when rocking is installed (in a checkout, "
    "`make engine`)",
    "the reference engine runs instead, row by row",
)
available, module, chosen = _COMPILED.available, _COMPILED.module, _COMPILED.chosen


def library_of(bodies: Sequence[HullBody | None], motions: Sequence[SpatialGround], *, ked: bool) -> Any:
    """Return bodies and motions as the compiled engine keeps them; ked: whether the law asks where the mass is."""
    made = module().Library()
    for body in bodies:
        if body is None:
            made.add_nobody()
        else:
            made.add_body(body.mass, np.array(body.tensor), **_tables(body), positions=_positions(body, ked=ked))
    for motion in motions:
        rows = motion.coefficients.transpose(0, 2, 1)
        if rows.shape[1] > MOST_POWERS:
            raise InvalidValueError(f"motions must be polynomials of degree below {MOST_POWERS}; sample them")
        made.add_motion(motion.times, np.ascontiguousarray(rows.reshape(len(rows), -1)))
    return made


def run_rows(
    library: Any, numbers: FloatArray, choices: IntArray, settings: HullSettings, threads: int
) -> dict[str, np.ndarray]:
    """Return the results of rows by name: `FLOATS`, NaN without result, and `WHOLES`."""
    results, counts = np.full((len(numbers), len(FLOATS)), np.nan), np.zeros((len(numbers), len(WHOLES)), np.int64)
    library.run(
        numbers, choices, results, counts, settings.rest_speed, settings.tolerance, settings.most_events, threads
    )
    return named(results, counts)


def named(results: FloatArray, counts: IntArray) -> dict[str, np.ndarray]:
    """Return the columns of the tables of results by name."""
    whole = {name: np.ascontiguousarray(counts[:, k]) for k, name in enumerate(WHOLES)}
    return whole | {name: np.ascontiguousarray(results[:, k]) for k, name in enumerate(FLOATS)}


def _tables(body: HullBody) -> dict[str, Any]:
    corners, beyond, first = body.hull.borders
    return {
        "vertices": np.array(body.points), "facets": np.array(body.facets), "poses": np.array(body.poses, np.int64),
        "first": first, "beside": beyond, "first_corner": first, "corners": corners,
    }  # fmt: skip


def _positions(body: HullBody, *, ked: bool) -> FloatArray:
    """Return where the impulse of a landing on the solid's own base acts: azimuths and coefficients by interval."""
    if not ked or body.solid is None:
        return np.zeros((0, HIGHEST + 3))
    position = impulse_position(body.solid)
    rows = [[*ends, *position.piece(k)] for k, ends in enumerate(pairwise(position.breaks))]
    return np.array([row + [0.0] * (HIGHEST + 3 - len(row)) for row in rows])
