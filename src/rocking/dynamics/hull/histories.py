"""Many histories of bodies on their hulls: every combination of bodies, grounds, scales, laws, frictions and starts."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.hull import fast_engine
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.engine import HullEngine, HullEventKind, HullHistory, HullSettings
from rocking.dynamics.hull.ground import HullGround
from rocking.dynamics.hull.motion import State
from rocking.dynamics.hull.restitution import FixedPosition
from rocking.dynamics.hull.vectors import applied, cross, dot, frame, scaled
from rocking.dynamics.settings import check_threads, processors
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.ground import SpatialGround
from rocking.errors import InvalidValueError
from rocking.outcome import Status, overturned

DIMENSIONS = ("body", "ground", "scale", "restitution", "friction", "start")


@dataclass(frozen=True, eq=False)
class HullBatch:
    """Results of many histories; every array has the shape (body, ground, scale, restitution, friction, start).

    Parameters
    ----------
    shape : tuple of int
        How many of each.
    values : dict of str to ndarray
        Results by name, one after another; codes of `Outcome` and `Status`; NaN where there is no result.
    engine : str
        Which engine ran.

    Examples
    --------
    >>> HullBatch((1, 1, 1, 1, 1, 1), {"outcome": np.array([2])}, "none").overturned.item()
    1.0
    """

    shape: tuple[int, ...]
    values: dict[str, np.ndarray] = field(repr=False)
    engine: str

    def __getitem__(self, name: str) -> np.ndarray:
        """Return an array by name."""
        return self.values[name].reshape(self.shape)

    @property
    def overturned(self) -> FloatArray:
        """1 where it ends in another stable pose, 0 where not, NaN where there is no result."""
        return overturned(self["outcome"])


def hull_histories(  # noqa: PLR0913 - the axes of a study
    bodies: HullBody | Sequence[HullBody],
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
) -> HullBatch:
    """Return the outcome of every combination of bodies, grounds, scales, restitutions, frictions and starts.

    Parameters
    ----------
    bodies : HullBody or sequence of them
        Bodies.
    grounds : HullGround or sequence of them
        What they stand on, and how that moves.
    restitution : {"housner-3d", "ked-3d"}, FixedPosition, float or list of them
        What an impact costs, as `HullEngine` takes it.
    friction : float or array_like
        Coulomb coefficients; infinite for vertices that never slide [-].
    scales : float or array_like
        Factors on the motions [-].
    start : SpatialStart or sequence of them, optional
        How they lean at the beginning, in the axes of their vertices, the lowest vertex at rest on the ground.
    horizon : float
        How long to follow them at least [s].
    settings : HullSettings, optional
        How to integrate.
    engine : {"auto", "fast", "reference"}
        Which engine runs; the reference takes hundreds of times as long.
    threads : int, optional
        How many threads; all processors by default. Results do not depend on it.

    Returns
    -------
    HullBatch
        The results; a row that could not be computed has its reason in `status`.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or a law needs a solid that a body has not.

    Examples
    --------
    >>> from rocking.bodies.solid import Solid, box
    >>> body = HullBody.of(Solid(box(1.0, 1.0, 4.0)))
    >>> batch = hull_histories(body, HullGround(slope=0.2), engine="reference")
    >>> batch["outcome"].ravel().tolist(), batch["status"].ravel().tolist()
    ([0], [0])
    """
    check_threads(threads)
    settings = settings or HullSettings()
    several, under = _listed("bodies", bodies), _listed("grounds", grounds)
    laws, starts = _listed("restitution", restitution), [SpatialStart()] if start is None else _listed("start", start)
    codes = [_code(law) for law in laws]
    frictions, factors = (
        np.atleast_1d(checks.real_array(n, v)) for n, v in (("friction", friction), ("scales", scales))
    )
    if any(code == fast_engine.KED and body.solid is None for code, _ in codes for body in several):
        raise InvalidValueError("restitution 'ked-3d' needs the distribution of mass: give the HullBody its solid")
    shape = (len(several), len(under), factors.size, len(laws), frictions.size, len(starts))
    states = np.array([[state_of(body, each) for each in starts] for body in several])
    body, ground, scale, law, mu, first = np.unravel_index(np.arange(int(np.prod(shape))), shape)
    code, coefficient = np.array([code for code, _ in codes]), np.array([value for _, value in codes])
    rows = HullRows(body, ground, code[law], coefficient[law], factors[scale], frictions[mu], states[body, first])
    if fast_engine.chosen(engine) == "fast":
        values = rows.run(several, under, settings, float(horizon), threads)
        return HullBatch(shape, values, "fast (Dormand-Prince with complementarity, compiled)")
    results = []
    for k in range(len(body)):
        scaled_ground = _scaled(under[ground[k]], float(factors[scale[k]]))
        run = HullEngine(several[body[k]], scaled_ground, laws[law[k]], float(frictions[mu[k]]), settings)
        results.append(results_of(run.run(_state(rows.state[k]), float(horizon))))
    values = fast_engine.named(np.array([r for r, _ in results]), np.array([c for _, c in results], np.int64))
    return HullBatch(shape, values, "reference, row by row")


class HullRows(NamedTuple):
    """Histories for the compiled engine, one entry each."""

    body: IntArray  # body, ground: numbers of both
    ground: IntArray
    law: IntArray
    coefficient: FloatArray  # of laws that have one
    scale: FloatArray
    friction: FloatArray
    state: FloatArray  # attitude, place, velocity and angular velocity, (n, 13)

    def run(
        self,
        bodies: Sequence[HullBody | None],
        grounds: Sequence[HullGround],
        settings: HullSettings,
        horizon: float = 0.0,
        threads: int | None = None,
    ) -> dict[str, np.ndarray]:
        """Return the results by name."""
        planes = np.array([[*np.ravel(g.level), *(g.shelf or (math.inf, math.inf)), g.gravity] for g in grounds])
        numbers = np.column_stack([
            self.coefficient, self.scale, np.full(len(self.body), horizon), self.friction, planes[self.ground, :11],
            self.state, planes[self.ground, 11],
        ])  # fmt: skip
        choices = np.column_stack([self.body, self.ground, self.law]).astype(np.int64)
        ked = bool((self.law == fast_engine.KED).any())
        library = fast_engine.library_of(bodies, [g.motion for g in grounds], ked=ked)
        return fast_engine.run_rows(library, numbers, choices, settings, threads or processors())


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
        raise InvalidValueError(f"{name} must be at least one, got none")
    return several


def _code(law: Any) -> tuple[int, float]:
    if law in ("housner", "housner-3d"):
        return fast_engine.HOUSNER, 0.0
    if law in ("ked", "ked-3d"):
        return fast_engine.KED, 0.0
    if isinstance(law, FixedPosition):
        return fast_engine.POSITION, law.k
    if isinstance(law, (int, float)):
        return fast_engine.COEFFICIENT, checks.within("restitution", float(law), 0.0, 1.0)
    raise InvalidValueError(f"restitution must be 'housner-3d', 'ked-3d' or a number, got {law!r:.60}")


def state_of(body: HullBody, start: SpatialStart) -> FloatArray:
    """Return attitude, place, velocity and angular velocity of a start; NaN for one that is none."""
    if not start.valid:
        return np.full(13, np.nan)
    attitude = tuple(start.quaternion.tolist())
    axes, spin = frame(attitude), start.body_velocity.tolist()
    low = min(body.points, key=lambda p: dot(axes[2], p))
    velocity = applied(axes, cross((spin[0], spin[1], spin[2]), scaled(-1.0, low)))
    return np.array([*attitude, 0.0, 0.0, -dot(axes[2], low), *velocity, *spin])


def _state(row: FloatArray) -> State:
    q, x, v, w = (tuple(row[a:b].tolist()) for a, b in ((0, 4), (4, 7), (7, 10), (10, 13)))
    return State(x, q, v, w)


def _scaled(ground: HullGround, scale: float) -> HullGround:
    made = HullGround(None, None, None, ground.slope, ground.azimuth, ground.shelf, ground.gravity)
    motion = SpatialGround(ground.motion.times, scale * ground.motion.coefficients)
    object.__setattr__(made, "motion", motion)
    return made
