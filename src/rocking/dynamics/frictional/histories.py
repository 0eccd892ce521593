"""Many histories on hulls: all combinations of bodies, grounds, scales, laws, frictions and starts."""

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.contact_problem import HullContact
from rocking.dynamics.frictional.engine import HullEngine
from rocking.dynamics.frictional.ground import HullGround, applied, cross, dot, frame, scaled
from rocking.dynamics.frictional.history import HullEvent, HullEventKind, HullHistory
from rocking.dynamics.frictional.motion import State
from rocking.dynamics.frictional.restitution import FixedPosition, law_on_hull, mass_distribution, position_on_base
from rocking.dynamics.frictional.settings import HullSettings
from rocking.dynamics.rolling.attitude import SpatialStart
from rocking.dynamics.rolling.batch import DIMENSIONS, SpatialBatch
from rocking.dynamics.rolling.ground import SpatialGround
from rocking.dynamics.settings import CompiledEngine, check_progress, thread_count
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome, Status
from rocking.restitution.space.impulse_position import HIGHEST, impulse_position

HOUSNER, POSITION, COEFFICIENT, KED, CALIBRATED = range(5)
CODES = {"housner-3d": HOUSNER, "ked-3d": KED, "calibrated-3d": CALIBRATED}
MOST_POWERS = 8
ENGINES = {
    "fast": "fast (Dormand-Prince with complementarity, compiled)",
    "reference": "reference (Dormand-Prince with complementarity)",
}

_COMPILED = CompiledEngine(
    "rocking.dynamics._hull",
    "the batch engine of hulls was not built; install rocking with a C++17 compiler (in a checkout, `make engine`)",
    "the reference engine runs instead, row by row",
    ("peak_tilt", "peak_time", "peak_spin", "overturning_time", "direction", "first_uplift", "sliding_distance",
     "residual_displacement", "end_time", "energy_lost"),
    ("outcome", "status", "pose", "impacts", "uplifts", "events", "steps", "held", "replaced", "still_rocking"),
)  # fmt: skip
available, module, chosen = _COMPILED.available, _COMPILED.module, _COMPILED.chosen
COLUMNS = _COMPILED.columns


def library_of(bodies: Sequence[HullBody | None], motions: Sequence[SpatialGround], laws: Collection[int]) -> Any:
    """Return bodies and motions in the form of the compiled engine.

    `laws` contains the codes of the laws in the rows.
    """
    library = module().Library()
    for body in bodies:
        if body is None:
            library.add_nobody()
        else:
            library.add_body(body.mass, np.array(body.tensor), **_tables(body), **_positions(body, laws))
    for motion in motions:
        rows = motion.coefficients.transpose(0, 2, 1)
        if rows.shape[1] > MOST_POWERS:
            raise InvalidValueError(
                "motions must be polynomials of degree below {powers}", powers=MOST_POWERS, hint="sample the motions"
            )
        library.add_motion(motion.times, np.ascontiguousarray(rows.reshape(len(rows), 3 * rows.shape[1])))
    return library


LEVEL = np.array([*np.eye(3).ravel(), math.inf, math.inf])
"""Axes of infinite level ground."""


def numbers_of_rows(  # noqa: PLR0917 - the columns in order
    value: Any,
    scale: Any,
    friction: Any,
    state: FloatArray,
    gravity: Any,
    plane: FloatArray = LEVEL,
    horizon: Any = 0.0,
) -> FloatArray:
    """Return histories as rows of numbers, one row per initial state. Single values of other columns are repeated.

    `value` is the coefficient or the impulse position of the law. `plane` contains the rotation from level axes to axes
    of the plane, and the half sizes of the shelf.
    """
    count = len(state)
    first = (np.broadcast_to(column, count) for column in (value, scale, horizon, friction))
    return np.column_stack([*first, np.broadcast_to(plane, (count, 11)), state, np.broadcast_to(gravity, count)])


def traced(
    body: HullBody,
    ground: HullGround,
    law: Any,
    friction: float,
    start: SpatialStart,
    *,
    horizon: float,
    settings: HullSettings,
) -> HullHistory:
    """Return one history of the compiled engine in the form of the reference engine. The events are impacts only."""
    code, value = _code(law)
    if code == KED:
        mass_distribution(body)
    state, plane = numbers_of(body, start)[None], _plane(ground)
    numbers = numbers_of_rows(value, 1.0, friction, state, ground.gravity, plane, horizon)
    library = library_of([body], [ground.motion], {code})
    results, counts = _COMPILED.empty_tables(1)
    limits = settings.rest_speed, settings.tolerance, settings.most_events
    nodes, impacts, members, stuck, impact_members, min_cosine, fell_off = library.trace(
        numbers, np.array([[0, 0, code, body.base]]), results, counts, *limits
    )
    values = {name: column.item() for name, column in _COMPILED.columns_by_name(results, counts).items()}
    if not nodes.size:
        raise InvalidValueError("all numbers of start, ground and duration must be within [-1e9, 1e9]")
    contacts = [HullContact(*pair) for pair in zip(_groups(members), _groups(stuck), strict=True)]
    events = [
        HullEvent(time, HullEventKind.IMPACT, HullContact(touching, touching), before, after)
        for (time, before, after), touching in zip(impacts.tolist(), _groups(impact_members), strict=True)
    ]
    names = ("peak_time", "peak_spin", "overturning_time", "direction", "first_uplift", "sliding_distance", "pose",
            "uplifts", "steps", "held", "replaced")  # fmt: skip
    return HullHistory(
        nodes[:, 0].tolist(), [_state(row[1:]) for row in nodes], contacts, events, list(Status)[values["status"]],
        list(Outcome)[values["outcome"]], bool(values["still_rocking"]), fell_off=fell_off,
        min_cosine=min_cosine, initial_facet=body.base, lost=values["energy_lost"],
        **{name: values[name] for name in names},
    )  # fmt: skip


def _groups(lists: IntArray) -> list[tuple[int, ...]]:
    """Return consecutive groups of numbers, each preceded by its length."""
    values, groups, start = lists.ravel().tolist(), [], 0
    while start < len(values):
        end = start + 1 + values[start]
        groups.append(tuple(values[start + 1 : end]))
        start = end
    return groups


def _tables(body: HullBody) -> dict[str, Any]:
    hull = body.hull
    corners, beyond, first = hull.borders
    return {
        "vertices": hull.vertices, "facets": hull.normals / hull.heights[:, None],
        "poses": np.array(body.poses, np.int64), "first": first, "beside": beyond,
        "first_corner": first, "corners": corners,
    }  # fmt: skip


def _positions(body: HullBody, laws: Collection[int]) -> dict[str, FloatArray]:
    """Return the impulse position of a landing on the base: azimuths and coefficients by interval."""
    ked = impulse_position(body.solid).table() if KED in laws and body.solid is not None else ()
    calibrated = position_on_base(body).table() if CALIBRATED in laws else ()
    return {name: np.array(rows).reshape(-1, HIGHEST + 3) for name, rows in (("ked", ked), ("calibrated", calibrated))}


PIECE = 1 << 14
"""Histories per call of the engine."""


def hull_histories(  # noqa: PLR0913 - the axes of a study
    bodies: HullBody | Sequence[HullBody | None],
    grounds: HullGround | Sequence[HullGround],
    restitution: Any = "housner-3d",
    friction: Any = math.inf,
    scales: Any = 1.0,
    start: SpatialStart | Sequence[SpatialStart] | None = None,
    *,
    horizon: float = 0.0,
    settings: HullSettings | None = None,
    engine: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> SpatialBatch:
    """Return the outcome of all combinations of bodies, grounds, scales, restitutions, frictions and starts.

    >>> from rocking.bodies.solid import Solid, box
    >>> body = HullBody.of(Solid(box(1.0, 1.0, 4.0)))
    >>> batch = hull_histories(body, HullGround(slope=0.2), engine="reference")
    >>> batch["outcome"].ravel().tolist(), batch["status"].ravel().tolist()
    ([0], [0])
    """
    # bodies: None for an invalid body, whose rows get an error status
    # restitution: argument of `HullEngine`
    # friction: infinite for vertices that never slide
    # start: state in the axes of the vertices; the lowest vertex is at rest on the ground
    # horizon: shortest duration [s]
    # engine: the reference engine is hundreds of times slower
    worker_count = thread_count(threads)
    check_progress(progress)
    settings = settings or HullSettings()
    body_list, ground_list = _listed("bodies", bodies), _listed("grounds", grounds)
    laws, starts = _listed("restitution", restitution), [SpatialStart()] if start is None else _listed("start", start)
    codes = [_code(law) for law in laws]
    frictions, factors = (
        np.atleast_1d(checks.real_array(n, v)) for n, v in (("friction", friction), ("scales", scales))
    )
    used_codes = {code for code, _ in codes}
    if KED in used_codes:
        for hull_body in filter(None, body_list):
            mass_distribution(hull_body)
    shape = (len(body_list), len(ground_list), factors.size, len(laws), frictions.size, len(starts))
    states = np.array([[numbers_of(body, item) for item in starts] for body in body_list])
    planes, pulls = np.array([_plane(item) for item in ground_list]), np.array([item.gravity for item in ground_list])
    body, ground, scale, law, mu, start_index = np.unravel_index(np.arange(int(np.prod(shape))), shape)
    values = np.array([r for _, r in codes])
    numbers = numbers_of_rows(
        values[law],
        factors[scale],
        frictions[mu],
        states[body, start_index],
        pulls[ground],
        planes[ground],
        float(horizon),
    )
    bases = np.array([0 if item is None else item.base for item in body_list])
    choices = np.column_stack([body, ground, np.array([code for code, _ in codes])[law], bases[body]]).astype(np.int64)
    rows = HullRows(body_list, [g.motion for g in ground_list], settings, chosen(engine), used_codes)
    results = rows.run(numbers, choices, worker_count, progress)
    return SpatialBatch(shape, results, rows.engine_name, dimensions=(*DIMENSIONS[:-1], "friction", DIMENSIONS[-1]))


@dataclass(frozen=True, eq=False)
class HullRows:
    """Bodies and motions. `run` computes histories given as rows; a row without a body gets an error status."""

    bodies: Sequence[HullBody | None]
    motions: Sequence[SpatialGround]
    settings: HullSettings
    engine: str  # fast or reference
    laws: Collection[int]  # codes of the laws in the rows

    @property
    def engine_name(self) -> str:
        """Name of the engine, with its method."""
        return ENGINES[self.engine]

    @cached_property
    def library(self) -> Any:
        """Bodies and motions in the form of the compiled engine."""
        return library_of(self.bodies, self.motions, self.laws)

    def run(
        self, numbers: FloatArray, choices: IntArray, threads: int, progress: Callable[[int], None] | None = None
    ) -> dict[str, np.ndarray]:
        """Return the results of rows by name; NaN if there is no result.

        `numbers` is the result of `numbers_of_rows`. `choices` contains body, motion, law, and facet of the body before
        its tilt.
        """
        pieces = []
        size = PIECE if self.engine == "fast" else 1
        for first in range(0, len(numbers), size):
            piece_numbers, piece_choices = numbers[first : first + size], choices[first : first + size]
            results, counts = _COMPILED.empty_tables(len(piece_numbers))
            if self.engine == "fast":
                settings = self.settings
                self.library.run(
                    piece_numbers,
                    piece_choices,
                    results,
                    counts,
                    settings.rest_speed,
                    settings.tolerance,
                    settings.most_events,
                    threads,
                )
            else:
                results[0], counts[0] = self._one(piece_numbers[0], piece_choices[0].tolist())
            pieces.append(_COMPILED.columns_by_name(results, counts))
            if progress is not None:
                progress(len(piece_numbers))
        return {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}

    def _one(self, row: FloatArray, choice: list[int]) -> tuple[list[float], list[int]]:
        body, unbounded = self.bodies[choice[0]], np.isin(np.arange(row.size), (3, 13, 14))
        is_finite = (np.abs(row) <= 1e9) | (unbounded & (row == math.inf))
        bounded = choice[2] in CODES.values() or 0.0 <= row[0] <= 1.0
        if body is None or not (is_finite.all() and bounded and row[3] >= 0.0 and row[28] > 0.0):
            refused = [Outcome.FAILED.code, Status.INVALID.code, -1, *[0] * (len(_COMPILED.integers) - 3)]
            return [math.nan] * len(_COMPILED.floats), refused
        names = {code: name for name, code in CODES.items()}
        law = FixedPosition(row[0]) if choice[2] == POSITION else names.get(choice[2], float(row[0]))
        motion = self.motions[choice[1]]
        ground = HullGround.placed(
            SpatialGround(motion.times, row[1] * motion.coefficients), row[4:13], row[13:15], float(row[28])
        )
        engine = HullEngine(body, ground, law, float(row[3]), self.settings)
        return results_of(engine.run(_state(row[15:28]), row[2], choice[3]))


def results_of(history: HullHistory) -> tuple[list[float], list[int]]:
    """Return a history of the reference engine as a row of a batch."""
    first, last = history.states[0].position, history.states[-1].position
    floats = [
        history.peak_tilt, history.peak_time, history.peak_spin, history.overturning_time, history.direction,
        history.first_uplift, history.sliding_distance, math.hypot(last[0] - first[0], last[1] - first[1]),
        history.time[-1], history.lost,
    ]  # fmt: skip
    if history.status is not Status.GOOD:
        floats = [math.nan] * len(floats)
    impacts = sum(event.kind is HullEventKind.IMPACT for event in history.events)
    return floats, [
        history.outcome.code, history.status.code, history.pose, impacts, history.uplifts, len(history.events),
        history.steps, history.held, history.replaced, int(history.still_rocking),
    ]  # fmt: skip


def _listed(name: str, values: Any) -> list[Any]:
    items = list(values) if isinstance(values, (list, tuple, np.ndarray)) else [values]
    if not items:
        raise InvalidValueError("{parameter} must contain at least one value, got none", parameter=name)
    return items


def _code(restitution: Any) -> tuple[int, float]:
    law = law_on_hull(restitution)
    if isinstance(law, FixedPosition):
        return POSITION, law.k
    return (COEFFICIENT, law) if isinstance(law, float) else (CODES[law], 0.0)


def _plane(ground: HullGround) -> FloatArray:
    return np.array([*np.ravel(ground.level), *(ground.shelf or (math.inf, math.inf))])


def numbers_of(body: HullBody | None, start: SpatialStart) -> FloatArray:
    """Return attitude, position, velocity and angular velocity of a start; NaN for an invalid start."""
    if body is None or not start.valid:
        return np.full(13, np.nan)
    attitude = tuple(start.quaternion.tolist())
    axes, spin = frame(attitude), start.body_velocity.tolist()
    low = min(body.points, key=lambda p: dot(axes[2], p))
    velocity = np.add(start.velocity, applied(axes, cross((spin[0], spin[1], spin[2]), scaled(-1.0, low))))
    return np.array([*attitude, 0.0, 0.0, start.height - dot(axes[2], low), *velocity, *spin])


def start_of(body: HullBody, start: SpatialStart) -> State:
    """Return the initial state of a body. Its lowest vertex is at rest on the ground, or above the ground."""
    return _state(numbers_of(body, start))


def _state(row: FloatArray) -> State:
    q, x, v, w = (tuple(row[a:b].tolist()) for a, b in ((0, 4), (4, 7), (7, 10), (10, 13)))
    return State(x, q, v, w)
