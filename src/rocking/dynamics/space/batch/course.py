"""The steps and events of one row of a batch, for comparison with other engines."""

from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.batch import tables
from rocking.dynamics.space.batch.laws import batch_law
from rocking.dynamics.space.batch.rows import RowTable
from rocking.dynamics.space.batch.run import limits_of, stock_of
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.ground import SpatialGround

COURSE = np.dtype(
    [
        ("time", "f8"),
        ("kind", "f8"),
        ("contact", "f8"),
        ("number", "f8"),
        ("before", "f8"),
        ("after", "f8"),
        ("rotation", "f8", (3, 3)),
        ("velocity", "f8", (3,)),
    ]
)
"""Fields: [s]; -1 for the end of a step, else uplift 0, impact 1, change 2, rest 3; code of the contact; number of its
edge or vertex; kinetic energies [J]; body axes to axes of the ground [-]; angular velocity in body axes [rad/s]."""


def course_of(
    body: SpatialBody,
    ground: SpatialGround,
    horizon: float,
    restitution: Any = "housner-3d",
    *,
    scale: float = 1.0,
    start: SpatialStart | None = None,
    settings: Settings | None = None,
) -> np.ndarray:
    """Return the course of a history as the compiled engine computes it in any batch, bit for bit.

    horizon: how long to follow the body [s]; scale: factor on the motion [-]. Returns with the fields of `COURSE`, in
    order of time.
    """
    made = settings or Settings(mechanics="space, many")
    laws, starts, horizons = [batch_law(restitution)], [start or SpatialStart()], np.array([[horizon]])
    table = RowTable((1, 1, 1, 1, 1), np.array([scale]), laws, starts, horizons)
    numbers, choices = table.piece(0, 1)
    results, counts = np.empty((1, tables.RESULTS)), np.empty((1, tables.COUNTS), np.int64)
    stock = stock_of([body], [ground], table, made.gravity)
    rows: FloatArray = stock.trace(numbers, choices, results, counts, **limits_of(made))
    return rows.view(COURSE)[:, 0]
