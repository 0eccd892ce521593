"""Every body in space under every motion at every scale with every restitution and start."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.batch import engine as engines
from rocking.dynamics.space.batch.laws import batch_law
from rocking.dynamics.space.batch.provenance import provenance
from rocking.dynamics.space.batch.result import SpatialBatch
from rocking.dynamics.space.batch.rows import RowTable
from rocking.dynamics.space.batch.run import run_compiled, run_reference
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.ground import SpatialGround, joined
from rocking.errors import InvalidValueError, RockingError

_LONG = 300.0


def batch_in_space(  # noqa: PLR0913, PLR0917 - what the front door hands on
    bodies: Any,
    motions: Any = None,
    restitution: Any = "housner-3d",
    scales: Any = 1.0,
    start: SpatialStart | Sequence[SpatialStart] | None = None,
    settings: Settings | None = None,
    duration: float | None = None,
    engine: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> SpatialBatch:
    """Return the outcome of every combination of bodies, motions, scales, restitutions and starts in space.

    motions: tuples of components; scales: factors on them [-]; duration: how long to follow the bodies [s]; the
    reference engine takes thousands of times as long as the compiled one.
    """
    settings = settings or Settings(mechanics="space, many")
    made, refused = _bodies(bodies)
    grounds, names = _grounds(motions, duration)
    laws = [batch_law(choice) for choice in _listed("restitution", restitution)]
    factors = np.atleast_1d(checks.real_array("scales", scales))
    starts = [SpatialStart()] if start is None else _listed("start", start)
    if factors.ndim != 1 or not factors.size or not all(isinstance(s, SpatialStart) for s in starts):
        raise InvalidValueError("scales must be one number or a row of them, and start one or more SpatialStart")
    for motion in _listed("motions", motions):
        plausibility.warn(plausibility.of_scaled(motion if isinstance(motion, tuple) else [motion], factors))
    if progress is not None and not callable(progress):
        raise InvalidValueError(f"progress must be a function of the histories done, or None, got {progress!r:.60}")
    shape = (len(made), len(grounds), factors.size, len(laws), len(starts))
    horizons = np.array([[_horizon(body, ground, duration, settings.gravity) for ground in grounds] for body in made])
    table = RowTable(shape, factors, laws, starts, horizons)
    if engines.chosen(engine) == "fast":
        values, used = run_compiled(made, grounds, table, settings, threads, progress)
    else:
        values, used = run_reference(made, grounds, table, settings, progress)
    labels: dict[str, list[object]] = {
        "motion": list(names),
        "scale": factors.tolist(),
        "restitution": [law.label for law in laws],
    }
    source = provenance(made, _listed("motions", motions), starts, settings, duration)
    return SpatialBatch(shape, values, used, labels, refused, source)


def _horizon(body: SpatialBody | None, ground: SpatialGround, duration: float | None, gravity: float) -> float:
    if body is None:
        return 0.0
    if duration is not None:
        return max(duration, ground.end)
    return ground.end if ground.count else _LONG / body.frequency(gravity)


def _listed(name: str, given: Any) -> list[Any]:
    found = list(given) if isinstance(given, (list, np.ndarray)) else [given]
    if not found:
        raise InvalidValueError(f"{name} must be at least one, got none")
    return found


def _bodies(given: Any) -> tuple[list[SpatialBody | None], dict[int, str]]:
    several = isinstance(given, Sequence) and not isinstance(given, str)
    found: list[SpatialBody | None] = []
    refused: dict[int, str] = {}
    for number, body in enumerate(given if several else [given]):
        try:
            found.append(SpatialBody.of(body))
        except RockingError as error:
            found.append(None)
            refused[number] = str(error)
    if not found:
        raise InvalidValueError("bodies must be at least one, got none")
    return found, refused


def _grounds(given: Any, duration: float | None) -> tuple[list[SpatialGround], list[str]]:
    until = np.inf if duration is None else checks.positive("duration", duration, "s")
    grounds, names = [], []
    for motion in _listed("motions", given):
        parts = motion if isinstance(motion, tuple) else (motion,)
        if len(parts) > 3:
            raise InvalidValueError(f"a motion has at most three components, x, y and vertical, got {len(parts)}")
        grounds.append(joined(parts, until))
        names.append(", ".join("none" if part is None else part.name for part in parts))
    return grounds, names
