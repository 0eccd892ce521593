"""Every body on its hull under every motion at every scale with every restitution, friction and start."""

import json
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rocking import plausibility
from rocking.conventions import FloatArray
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.ground import HullGround
from rocking.dynamics.hull.histories import hull_histories
from rocking.dynamics.hull.law import law_on_hull
from rocking.dynamics.hull.response import settings_on_hull
from rocking.dynamics.response_base import motion_provenance
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.batch import DIMENSIONS, SpatialBatch
from rocking.dynamics.space.ground import joined
from rocking.errors import InvalidValueError, RockingError

RENAMED = {"held": "contacts_held", "replaced": "landings_replaced"}
"""Results whose names in the engine mean something else in `rocking.quantities`."""


def hull_bodies(bodies: Sequence[Any]) -> tuple[list[HullBody | None], dict[int, str]]:
    """Return bodies on their hulls, None for what cannot be one, and why by its number."""
    made: list[HullBody | None] = []
    refused: dict[int, str] = {}
    for number, body in enumerate(bodies):
        try:
            made.append(HullBody.of(body))
        except RockingError as error:
            made.append(None)
            refused[number] = str(error)
    return made, refused


def batch_on_hulls(  # noqa: PLR0913, PLR0917 - what the front door hands on
    bodies: Sequence[Any],
    motions: Sequence[Any],
    scales: FloatArray,
    restitutions: Sequence[Any],
    frictions: FloatArray,
    starts: Sequence[SpatialStart | None],
    settings: Settings,
    duration: float | None = None,
    engine: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> SpatialBatch:
    """Return the outcome of every combination; motions are tuples of components, None for ground at rest."""
    made, refused = hull_bodies(bodies)
    if not made or not motions or not restitutions or not starts:
        raise InvalidValueError("bodies, motions, restitution and start must be at least one each, got none")
    if (frictions < 0.0).any():
        raise InvalidValueError(f"friction must be in [0, 1e+06], got {frictions.min():g}")
    until = math.inf if duration is None else duration
    shaken = [tuple(part for part in motion or () if part is not None) for motion in motions]
    for parts in shaken:
        plausibility.warn(plausibility.of_scaled(parts, scales))
    laws = [law_on_hull(each) for each in restitutions]
    grounds = [
        HullGround.placed(joined(motion or (), until), np.eye(3), (math.inf, math.inf), settings.gravity)
        for motion in motions
    ]
    leaning = [start or SpatialStart() for start in starts]
    found = hull_histories(
        made, grounds, laws, frictions, scales, leaning, horizon=duration or 0.0,
        settings=settings_on_hull(settings), engine=engine, threads=threads, progress=progress,
    )  # fmt: skip
    # hull_histories has its own order: body, motion, scale, restitution, friction, start
    values = {RENAMED.get(name, name): array for name, array in found.values.items()}
    labels: dict[str, list[object]] = {
        "motion": [", ".join(part.name for part in parts) or "none" for parts in shaken], "scale": scales.tolist(),
        "restitution": [str(law) for law in laws], "friction": frictions.tolist(),
    }  # fmt: skip
    stated = {name: value for name, value in settings.stated.items() if name != "friction"}
    leans = [[s.tilt, s.azimuth, s.yaw, *np.ravel(s.angular_velocity).tolist()] for s in leaning if s.valid]
    facts = [None if b is None else [b.mass, b.centre.tolist(), len(b.points)] for b in made]
    source = {
        "duration_s": "until it rests after the motion" if duration is None else float(duration),
        **{f"setting_{name}": value for name, value in stated.items()},
        "motions": json.dumps([[motion_provenance(part) for part in motion or ()] for motion in motions]),
        "starts": json.dumps(leans), "bodies": json.dumps(facts),
    }  # fmt: skip
    dimensions = (*DIMENSIONS[:-1], "friction", DIMENSIONS[-1])
    return SpatialBatch(found.shape, values, found.engine, labels, refused, source, dimensions)
