"""The compiled 3D engine: tables of bodies, motions and laws, and results by name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.rolling.attitude import SpatialStart
from rocking.dynamics.rolling.body import SpatialBody
from rocking.dynamics.rolling.ground import SpatialGround
from rocking.dynamics.rolling.impact_laws import FixedSpatial, ModelLaw, SpatialImpactLaw, law_of
from rocking.dynamics.rolling.settings import SpaceBatchSettings
from rocking.dynamics.settings import CompiledEngine, thread_count
from rocking.errors import InvalidValueError
from rocking.restitution.space.calibrated import calibrated_position
from rocking.restitution.space.impulse_position import HIGHEST, impulse_position

PIECE = 1 << 15
"""Histories per call of the engine. With pieces, only the memory for results increases with the number of histories."""

MOST_CORNERS = 64  # largest number of vertices of a base in the compiled engine

CODES = {"housner-3d": 0, "horizontal-momentum-3d": 1, "ked-3d": 3, "ked-3d-point": 4, "calibrated-3d": 5}
"""Codes of the laws without a coefficient."""

STEP = np.dtype([
    ("time", "f8"), ("kind", "f8"), ("contact", "f8"), ("number", "f8"), ("before", "f8"), ("after", "f8"),
    ("rotation", "f8", (3, 3)), ("velocity", "f8", (3,)),
])  # fmt: skip
"""Fields of a step.

Time [s]; kind: -1 end of a step, 0 uplift, 1 impact, 2 change, 3 rest; code of the contact; number of the edge or
vertex; kinetic energies [J]; rotation from body axes to axes of the ground [-]; angular velocity in body axes [rad/s].
"""

Bodies = Sequence[SpatialBody | None]
Results = dict[str, np.ndarray]
Progress = Callable[[int], None] | None

_FIXED = 2
_MOMENTS = 117  # number of moments per vertex or edge for ked-3d-point: 9 + 27 + 81
_ROUNDING = 1e-9
_COMPILED = CompiledEngine(
    "rocking.dynamics._spatial",
    "the batch engine in space was not built; install rocking with a C++17 compiler (in a checkout, `make engine`)",
    "the reference engine runs instead, row by row",
    ("peak_tilt", "peak_time", "peak_spin", "overturning_time", "direction", "first_uplift", "end_time", "held",
     "energy_lost"),
    ("outcome", "status", "over_contact", "over_number", "impacts", "uplifts", "events", "steps", "still_rocking"),
)  # fmt: skip
available, module, chosen = _COMPILED.available, _COMPILED.module, _COMPILED.chosen
COLUMNS = _COMPILED.columns
instruction_set = _COMPILED.instruction_set
empty_tables, columns_by_name = _COMPILED.empty_tables, _COMPILED.columns_by_name


@dataclass(frozen=True)
class BatchLaw:
    """Impact law in the form of the compiled engine."""

    law: SpatialImpactLaw | None  # law of the reference engine; None if the law depends on the body
    label: str  # name or coefficient
    code: int  # code in the compiled engine
    coefficient: float = 0.0  # r of a fixed coefficient, otherwise 0 [-]


def batch_law(restitution: Any) -> BatchLaw:
    """Return an impact law of a batch."""
    law = law_of(restitution)
    if isinstance(law, ModelLaw) and law.model.needs_solid and law.label in CODES:
        return BatchLaw(None, law.label, CODES[law.label])
    if isinstance(law, FixedSpatial):
        return BatchLaw(law, law.label, _FIXED, law.coefficient)
    if law.label in CODES and type(law).__module__.startswith("rocking."):
        return BatchLaw(law, law.label, CODES[law.label])
    raise InvalidValueError(
        "restitution in a batch must be one of {models}, or a coefficient in [0, 1], got "
        "{model}; simulate accepts any law",
        models=", ".join(CODES),
        model=f"{law.label!r:.60}",
    )


@dataclass(frozen=True, eq=False)
class RowTable:
    """Rows of a batch, for all combinations of bodies, motions, scales, restitutions and starts."""

    shape: tuple[int, int, int, int, int]  # numbers of bodies, motions, scales, restitutions and starts
    scales: FloatArray  # factors on the motions [-]
    laws: Sequence[BatchLaw]
    starts: Sequence[SpatialStart]
    horizons: FloatArray  # duration of each history [s]; shape (bodies, motions)

    def __len__(self) -> int:
        return int(np.prod(self.shape))

    def piece(self, first: int, last: int) -> tuple[FloatArray, IntArray]:
        """Return rows (n, 10) of coefficient, scale, horizon, attitude and angular velocity, and indices (n, 3)."""
        # the indices are body, motion and code of the law; the numbers of an invalid start are NaN
        body, motion, scale, law, start = np.unravel_index(np.arange(first, last), self.shape)
        no_start = np.full(7, np.nan)
        states = [np.concatenate([s.quaternion, s.body_velocity]) if s.valid else no_start for s in self.starts]
        numbers = np.empty((last - first, 10))
        numbers[:, 0] = np.array([item.coefficient for item in self.laws])[law]
        numbers[:, 1] = self.scales[scale]
        numbers[:, 2] = self.horizons[body, motion]
        numbers[:, 3:] = np.array(states)[start]
        codes = np.array([item.code for item in self.laws], np.int64)
        return numbers, np.column_stack([body, motion, codes[law]]).astype(np.int64)


def run_compiled(
    bodies: Bodies,
    grounds: Sequence[SpatialGround],
    table: RowTable,
    settings: SpaceBatchSettings,
    threads: int | None,
    progress: Progress,
) -> tuple[Results, str]:
    """Return the results of all rows, and the name of the engine."""
    stock = _stock(bodies, grounds, table, settings.gravity)
    results, counts = empty_tables(len(table))
    limits = {"threads": thread_count(threads), **_limits(settings)}
    for first in range(0, len(table), PIECE):
        last = min(first + PIECE, len(table))
        stock.run(*table.piece(first, last), results[first:last], counts[first:last], **limits)
        if progress is not None:
            progress(last - first)
    engine_name = f"fast ({instruction_set()}; Taylor, order up to 16, tolerance {settings.tolerance:g})"
    return columns_by_name(results, counts), engine_name


def steps_of(
    body: SpatialBody,
    ground: SpatialGround,
    horizon: float,
    restitution: Any = "housner-3d",
    *,
    scale: float = 1.0,
    start: SpatialStart | None = None,
    settings: SpaceBatchSettings | None = None,
) -> np.ndarray:
    """Return the steps of a history in the compiled engine, with fields of `STEP`. A batch has identical steps."""
    settings = settings or SpaceBatchSettings()
    laws, starts, horizons = [batch_law(restitution)], [start or SpatialStart()], np.array([[horizon]])
    table = RowTable((1, 1, 1, 1, 1), np.array([scale]), laws, starts, horizons)
    stock = _stock([body], [ground], table, settings.gravity)
    rows: FloatArray = stock.trace(*table.piece(0, 1), *empty_tables(1), **_limits(settings))
    return rows.view(STEP)[:, 0]


def _stock(bodies: Bodies, grounds: Sequence[SpatialGround], table: RowTable, gravity: float) -> Any:
    """Return bodies and motions in the form of the compiled engine."""
    codes = {law.code for law in table.laws}
    numbers, corners, vertices = _body_table(bodies, gravity)
    moments = _moment_table(bodies) if CODES["ked-3d-point"] in codes else np.zeros(0)
    offsets, positions = _position_table(bodies, codes)
    degree, motions, times, accelerations = _motion_table(grounds)
    return module().Stock(
        numbers, np.column_stack([corners, offsets]), vertices, moments, positions,
        degree, motions, times, accelerations, instruction_set(),
    )  # fmt: skip


def _limits(settings: SpaceBatchSettings) -> dict[str, Any]:
    return {
        "gravity": settings.gravity, "rest_speed": settings.rest_speed, "tolerance": settings.tolerance,
        "longest": settings.longest_step, "most_events": settings.most_events,
    }  # fmt: skip


def _body_table(bodies: Bodies, gravity: float) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return tables of bodies."""
    # Table 1: mass, frequency, size, lift, radius, centre, inertia; NaN without a body (shape (n, 17)).
    # Table 2: first vertex and number of vertices, zero for a round base (shape (n, 2)).
    # Table 3: vertices of all bodies [m] (shape (m, 2)).
    numbers, corners = np.full((len(bodies), 17), np.nan), np.zeros((len(bodies), 2), np.int64)
    points: list[FloatArray] = []
    vertex_count = 0
    for k, body in enumerate(bodies):
        if body is None:
            continue
        count = len(body.vertices)
        if count > MOST_CORNERS:
            raise InvalidValueError(
                "a base must have at most {limit} vertices in a batch, got {count}", limit=MOST_CORNERS, count=count,
                hint='state a round base by its radius, or use engine="reference", which accepts any number of '
                    "vertices",
            )  # fmt: skip
        scalars = (body.mass, body.frequency(gravity), body.size, body.lift, body.radius)
        numbers[k] = np.concatenate([scalars, body.centre, body.inertia.ravel()])
        corners[k] = vertex_count, count
        points.append(body.vertices[:, :2])
        vertex_count += count
    vertices = np.concatenate(points) if points else np.zeros((0, 2))
    return numbers, corners, np.ascontiguousarray(vertices)


def _moment_table(bodies: Bodies) -> FloatArray:
    """Return 117 moments for ked-3d-point per vertex, followed by 117 moments per edge."""
    # units kg, kg m, kg m2; NaN without a distribution of mass
    if any(body is not None and body.round for body in bodies):
        raise InvalidValueError(
            'ked-3d-point does not apply to a round base in a batch; use ked-3d, or engine="reference"'
        )
    rows = [_moments(body) for body in bodies if body is not None]
    return np.concatenate(rows) if rows else np.zeros(0)


def _moments(body: SpatialBody) -> FloatArray:
    from rocking.bodies.solid import Corner, Edge
    from rocking.restitution.space.integrals import kept_moments

    if body.matter is None:
        return np.full(2 * len(body.vertices) * _MOMENTS, np.nan)
    solid, origin = body.matter.placed
    vertices = body.vertices - origin
    vertices[np.abs(vertices[:, 2]) <= _ROUNDING * solid.size, 2] = 0.0
    edges = [Edge(vertex, along) for vertex, along in zip(vertices, body.edges, strict=True)]
    landings: list[Corner | Edge] = [*map(Corner, vertices), *edges]
    moments = [kept_moments(solid, onto) for onto in landings]
    return np.concatenate(
        [tensor.ravel() for moment in moments for tensor in (moment.second, moment.third, moment.fourth)]
    )


def _position_table(bodies: Bodies, codes: set[int]) -> tuple[IntArray, FloatArray]:
    """Return tables of the impulse position of a landing of the full base, for ked-3d and calibrated-3d."""
    # Table 1: first interval and number of intervals for both models (shape (n, 4)); zero for a model without rows, and
    # for ked-3d without a distribution of mass.
    # Table 2: first and last azimuth of an interval [rad], and the coefficients of k over the interval [-]
    # (shape (m, 3 + HIGHEST)).
    ranges = np.zeros((len(bodies), 4), np.int64)
    rows: list[list[float]] = []
    for index, body in enumerate(bodies):
        if body is None:
            continue
        if CODES["ked-3d"] in codes and body.matter is not None:
            table = impulse_position(body.matter.placed[0]).table()
            ranges[index, :2] = len(rows), len(table)
            rows += table
        if CODES["calibrated-3d"] in codes:
            table = calibrated_position(body.moments, body.footprint).table()
            ranges[index, 2:] = len(rows), len(table)
            rows += table
    return ranges, np.array(rows).reshape(-1, HIGHEST + 3)


def _motion_table(grounds: Sequence[SpatialGround]) -> tuple[int, IntArray, FloatArray, FloatArray]:
    """Return tables of motions."""
    # 1: common degree, 1 or 7. 2: first time, first acceleration, number of segments (shape (n, 3)). 3: ends of the
    # segments of all motions [s]. 4: accelerations by motion, segment, power and axis [m/s2].
    highest = max(ground.coefficients.shape[2] for ground in grounds) - 1
    if highest > 7:
        raise InvalidValueError(
            "motions must be polynomials of degree at most 7, got {degree}", degree=highest, hint="sample the motions"
        )
    degree = 1 if highest <= 1 else 7
    offsets = np.zeros((len(grounds), 3), np.int64)
    times, rows = [], []
    time_offset, value_offset = 0, 0
    for k, ground in enumerate(grounds):
        row = np.zeros((ground.count, degree + 1, 3))
        row[:, : ground.coefficients.shape[2]] = ground.coefficients.transpose(0, 2, 1)
        offsets[k] = time_offset, value_offset, ground.count
        time_offset, value_offset = time_offset + len(ground.times), value_offset + row.size
        times.append(ground.times)
        rows.append(row.ravel())
    return degree, offsets, np.concatenate(times), np.concatenate(rows)
