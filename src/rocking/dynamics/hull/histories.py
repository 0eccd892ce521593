"""Many histories of bodies on their hulls: every combination of bodies, grounds, scales, laws, frictions and starts."""

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.contact_problem import HullContact
from rocking.dynamics.hull.engine import HullEngine
from rocking.dynamics.hull.ground import HullGround, applied, cross, dot, frame, scaled
from rocking.dynamics.hull.history import HullEvent, HullEventKind, HullHistory
from rocking.dynamics.hull.motion import State
from rocking.dynamics.hull.restitution import FixedPosition, law_on_hull, position_on_base, spread_of
from rocking.dynamics.hull.settings import HullSettings
from rocking.dynamics.settings import CompiledEngine, check_progress, thread_count
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.batch import DIMENSIONS, SpatialBatch
from rocking.dynamics.space.ground import SpatialGround
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
    "the batch engine of hulls was not built: it takes a C++17 compiler when rocking is installed (in a checkout, "
    "`make engine`)",
    "the reference engine runs instead, row by row",
    ("peak_tilt", "peak_time", "peak_spin", "overturning_time", "direction", "first_uplift", "sliding_distance",
     "residual_displacement", "end_time", "energy_lost"),
    ("outcome", "status", "pose", "impacts", "uplifts", "events", "steps", "held", "replaced", "still_rocking"),
)  # fmt: skip
available, module, chosen = _COMPILED.available, _COMPILED.module, _COMPILED.chosen
COLUMNS = _COMPILED.columns


def library_of(bodies: Sequence[HullBody | None], motions: Sequence[SpatialGround], laws: Collection[int]) -> Any:
    """Return bodies and motions as the compiled engine keeps them; laws: codes of the rows."""
    made = module().Library()
    for body in bodies:
        if body is None:
            made.add_nobody()
        else:
            made.add_body(body.mass, np.array(body.tensor), **_tables(body), **_positions(body, laws))
    for motion in motions:
        rows = motion.coefficients.transpose(0, 2, 1)
        if rows.shape[1] > MOST_POWERS:
            raise InvalidValueError(
                "motions must be polynomials of degree below {powers}", powers=MOST_POWERS, hint="sample them"
            )
        made.add_motion(motion.times, np.ascontiguousarray(rows.reshape(len(rows), 3 * rows.shape[1])))
    return made


LEVEL = np.array([*np.eye(3).ravel(), math.inf, math.inf])
"""Axes of level ground, which has no end."""


def numbers_of_rows(  # noqa: PLR0917 - the columns, in order
    value: Any,
    scale: Any,
    friction: Any,
    state: FloatArray,
    gravity: Any,
    plane: FloatArray = LEVEL,
    horizon: Any = 0.0,
) -> FloatArray:
    """Return histories as rows of numbers, one for each state at the start; the others are repeated where they are one.

    value: coefficient or position of the law; plane: level axes to axes of the plane, and half sizes of the shelf.
    """
    count = len(state)
    first = (np.broadcast_to(each, count) for each in (value, scale, horizon, friction))
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
    """Return one history of the compiled engine as the reference engine keeps it; of its events the impacts alone."""
    code, value = _code(law)
    if code == KED:
        spread_of(body)
    state, plane = numbers_of(body, start)[None], _plane(ground)
    numbers = numbers_of_rows(value, 1.0, friction, state, ground.gravity, plane, horizon)
    library = library_of([body], [ground.motion], {code})
    results, counts = _COMPILED.empty_tables(1)
    limits = settings.rest_speed, settings.tolerance, settings.most_events
    nodes, impacts, members, stuck, struck, least, fell = library.trace(
        numbers, np.array([[0, 0, code, body.base]]), results, counts, *limits
    )
    found = {name: column.item() for name, column in _COMPILED.columns_by_name(results, counts).items()}
    if not nodes.size:
        raise InvalidValueError("a number of the start, the ground or the duration is not within [-1e9, 1e9]")
    contacts = [HullContact(*each) for each in zip(_groups(members), _groups(stuck), strict=True)]
    events = [
        HullEvent(time, HullEventKind.IMPACT, HullContact(touching, touching), before, after)
        for (time, before, after), touching in zip(impacts.tolist(), _groups(struck), strict=True)
    ]
    same = ("peak_time", "peak_spin", "overturning_time", "direction", "first_uplift", "sliding_distance", "pose",
            "uplifts", "steps", "held", "replaced")  # fmt: skip
    return HullHistory(
        nodes[:, 0].tolist(), [_state(row[1:]) for row in nodes], contacts, events, list(Status)[found["status"]],
        list(Outcome)[found["outcome"]], bool(found["still_rocking"]), fell=fell, least_cosine=least, stood=body.base,
        lost=found["energy_lost"], **{name: found[name] for name in same},
    )  # fmt: skip


def _groups(lists: IntArray) -> list[tuple[int, ...]]:
    """Return groups of numbers that stand one after another, each led by its length."""
    rest, made, place = lists.ravel().tolist(), [], 0
    while place < len(rest):
        end = place + 1 + rest[place]
        made.append(tuple(rest[place + 1 : end]))
        place = end
    return made


def _tables(body: HullBody) -> dict[str, Any]:
    corners, beyond, first = body.hull.borders
    return {
        "vertices": np.array(body.points), "facets": np.array(body.facets), "poses": np.array(body.poses, np.int64),
        "first": first, "beside": beyond, "first_corner": first, "corners": corners,
    }  # fmt: skip


def _positions(body: HullBody, laws: Collection[int]) -> dict[str, FloatArray]:
    """Return the impulse position of a landing on the body's own base: azimuths and coefficients by interval."""
    ked = impulse_position(body.solid).table() if KED in laws and body.solid is not None else ()
    calibrated = position_on_base(body).table() if CALIBRATED in laws else ()
    return {name: np.array(rows).reshape(-1, HIGHEST + 3) for name, rows in (("ked", ked), ("calibrated", calibrated))}


PIECE = 1 << 14
"""Histories that are handed to the engine at a time."""


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
    """Return the outcome of every combination of bodies, grounds, scales, restitutions, frictions and starts.

    >>> from rocking.bodies.solid import Solid, box
    >>> body = HullBody.of(Solid(box(1.0, 1.0, 4.0)))
    >>> batch = hull_histories(body, HullGround(slope=0.2), engine="reference")
    >>> batch["outcome"].ravel().tolist(), batch["status"].ravel().tolist()
    ([0], [0])
    """
    # bodies: None for one that cannot be, whose rows are refused by themselves; restitution: as `HullEngine` takes it;
    # friction: infinite for vertices that never slide; start: in the axes of the vertices, the lowest at rest on the
    # ground; horizon: how long to follow them at least [s]; the reference engine takes hundreds of times as long
    taken = thread_count(threads)
    check_progress(progress)
    settings = settings or HullSettings()
    several, under = _listed("bodies", bodies), _listed("grounds", grounds)
    laws, starts = _listed("restitution", restitution), [SpatialStart()] if start is None else _listed("start", start)
    codes = [_code(law) for law in laws]
    frictions, factors = (
        np.atleast_1d(checks.real_array(n, v)) for n, v in (("friction", friction), ("scales", scales))
    )
    used = {code for code, _ in codes}
    if KED in used:
        for one in filter(None, several):
            spread_of(one)
    shape = (len(several), len(under), factors.size, len(laws), frictions.size, len(starts))
    states = np.array([[numbers_of(body, each) for each in starts] for body in several])
    planes, pulls = np.array([_plane(each) for each in under]), np.array([each.gravity for each in under])
    body, ground, scale, law, mu, first = np.unravel_index(np.arange(int(np.prod(shape))), shape)
    values = np.array([r for _, r in codes])
    numbers = numbers_of_rows(
        values[law], factors[scale], frictions[mu], states[body, first], pulls[ground], planes[ground], float(horizon)
    )
    bases = np.array([0 if each is None else each.base for each in several])
    choices = np.column_stack([body, ground, np.array([code for code, _ in codes])[law], bases[body]]).astype(np.int64)
    rows = HullRows(several, [g.motion for g in under], settings, chosen(engine), used)
    found = rows.run(numbers, choices, taken, progress)
    return SpatialBatch(shape, found, rows.words, dimensions=(*DIMENSIONS[:-1], "friction", DIMENSIONS[-1]))


@dataclass(frozen=True, eq=False)
class HullRows:
    """Bodies and motions, and histories of them as rows of numbers; a row without a body is refused by itself."""

    bodies: Sequence[HullBody | None]
    motions: Sequence[SpatialGround]
    settings: HullSettings
    engine: str  # fast or reference
    laws: Collection[int]  # codes of the rows

    @property
    def words(self) -> str:
        """Which engine runs, and how."""
        return ENGINES[self.engine]

    @cached_property
    def library(self) -> Any:
        """Bodies and motions as the compiled engine keeps them."""
        return library_of(self.bodies, self.motions, self.laws)

    def run(
        self, numbers: FloatArray, choices: IntArray, threads: int, progress: Callable[[int], None] | None = None
    ) -> dict[str, np.ndarray]:
        """Return the results of rows by name, NaN where there is none.

        numbers: as of `numbers_of_rows`; choices: body, motion, law, facet on which the body stood before its tilt.
        """
        pieces = []
        size = PIECE if self.engine == "fast" else 1
        for first in range(0, len(numbers), size):
            some, which = numbers[first : first + size], choices[first : first + size]
            results, counts = _COMPILED.empty_tables(len(some))
            if self.engine == "fast":
                how = self.settings
                self.library.run(some, which, results, counts, how.rest_speed, how.tolerance, how.most_events, threads)
            else:
                results[0], counts[0] = self._one(some[0], which[0].tolist())
            pieces.append(_COMPILED.columns_by_name(results, counts))
            if progress is not None:
                progress(len(some))
        return {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}

    def _one(self, row: FloatArray, which: list[int]) -> tuple[list[float], list[int]]:
        body, unbounded = self.bodies[which[0]], np.isin(np.arange(row.size), (3, 13, 14))
        known = (np.abs(row) <= 1e9) | (unbounded & (row == math.inf))
        bounded = which[2] in CODES.values() or 0.0 <= row[0] <= 1.0
        if body is None or not (known.all() and bounded and row[3] >= 0.0 and row[28] > 0.0):
            refused = [Outcome.FAILED.code, Status.INVALID.code, -1, *[0] * (len(_COMPILED.integers) - 3)]
            return [math.nan] * len(_COMPILED.floats), refused
        named = {code: name for name, code in CODES.items()}
        law = FixedPosition(row[0]) if which[2] == POSITION else named.get(which[2], float(row[0]))
        moving = self.motions[which[1]]
        ground = HullGround.placed(
            SpatialGround(moving.times, row[1] * moving.coefficients), row[4:13], row[13:15], float(row[28])
        )
        engine = HullEngine(body, ground, law, float(row[3]), self.settings)
        return results_of(engine.run(_state(row[15:28]), row[2], which[3]))


def results_of(history: HullHistory) -> tuple[list[float], list[int]]:
    """Return a history of the reference engine as a row of a batch."""
    first, last = history.states[0].place, history.states[-1].place
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
    several = list(values) if isinstance(values, (list, tuple, np.ndarray)) else [values]
    if not several:
        raise InvalidValueError("{parameter} must be at least one, got none", parameter=name)
    return several


def _code(restitution: Any) -> tuple[int, float]:
    law = law_on_hull(restitution)
    if isinstance(law, FixedPosition):
        return POSITION, law.k
    return (COEFFICIENT, law) if isinstance(law, float) else (CODES[law], 0.0)


def _plane(ground: HullGround) -> FloatArray:
    return np.array([*np.ravel(ground.level), *(ground.shelf or (math.inf, math.inf))])


def numbers_of(body: HullBody | None, start: SpatialStart) -> FloatArray:
    """Return attitude, place, velocity and angular velocity of a start; NaN for one that is none."""
    if body is None or not start.valid:
        return np.full(13, np.nan)
    attitude = tuple(start.quaternion.tolist())
    axes, spin = frame(attitude), start.body_velocity.tolist()
    low = min(body.points, key=lambda p: dot(axes[2], p))
    velocity = np.add(start.velocity, applied(axes, cross((spin[0], spin[1], spin[2]), scaled(-1.0, low))))
    return np.array([*attitude, 0.0, 0.0, start.height - dot(axes[2], low), *velocity, *spin])


def start_of(body: HullBody, start: SpatialStart) -> State:
    """Return the state of a body at the start, whose lowest vertex is on the ground at rest, or above it."""
    return _state(numbers_of(body, start))


def _state(row: FloatArray) -> State:
    q, x, v, w = (tuple(row[a:b].tolist()) for a, b in ((0, 4), (4, 7), (7, 10), (10, 13)))
    return State(x, q, v, w)
