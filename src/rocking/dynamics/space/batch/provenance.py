"""Of what a batch of bodies in space was computed."""

import hashlib
import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking.dynamics.exportable import motion_provenance
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.body import SpatialBody

_FEW = 100
"""Up to so many bodies are spelled out; of more of them the digest alone is kept."""


def provenance(
    bodies: Sequence[SpatialBody | None],
    motions: Sequence[Any],
    starts: Sequence[SpatialStart],
    settings: Settings,
    duration: float | None,
) -> dict[str, Any]:
    """Return of what a batch was computed, beside its labels.

    duration: how long bodies were followed, where given [s]. Returns numbers and words; bodies and starts as JSON, and
    a digest of all bodies.

    >>> made = provenance([SpatialBody.box(1.0, 1.0, 4.0)], [None], [SpatialStart()], Settings(), None)
    >>> made["duration_s"], len(json.loads(made["bodies"]))
    ('to the end of the motion', 1)
    """
    spelled = json.dumps([None if body is None else _numbers(body) for body in bodies])
    few = {"bodies": spelled} if len(bodies) <= _FEW else {}
    leaning = [[s.tilt, s.azimuth, s.yaw, *np.ravel(s.angular_velocity).tolist()] for s in starts if s.valid]
    return {
        "duration_s": "to the end of the motion" if duration is None else float(duration),
        **{f"setting_{name}": value for name, value in settings.stated.items()},
        "motions": json.dumps([[motion_provenance(part) for part in _parts(motion)] for motion in motions]),
        "starts": json.dumps(leaning),
        **few,
        "bodies_sha256": hashlib.sha256(spelled.encode()).hexdigest(),
    }


def _numbers(body: SpatialBody) -> dict[str, Any]:
    return {
        "mass_kg": body.mass,
        "centre_m": body.centre.tolist(),
        "inertia_kg_m2": np.ravel(body.inertia).tolist(),
        "base_m": np.ravel(body.base).tolist(),
    }


def _parts(motion: Any) -> tuple[Any, ...]:
    return motion if isinstance(motion, tuple) else (motion,)
