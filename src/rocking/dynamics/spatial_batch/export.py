"""What the files of a batch in space hold: one row a history, its labels, its results, what was computed from what."""

import hashlib
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.dynamics.exportable import motion_provenance, software
from rocking.dynamics.spatial.rocker import SpatialBody
from rocking.dynamics.spatial_batch.settings import SpatialBatchSettings
from rocking.dynamics.spatial_batch.start import SpatialStart
from rocking.tables import Column, Table

if TYPE_CHECKING:
    from rocking.dynamics.spatial_batch.result import SpatialBatch

_FEW = 100
"""Up to so many bodies are spelled out; of more of them the digest alone is kept."""


def provenance(
    bodies: Sequence[SpatialBody | None],
    motions: Sequence[Any],
    starts: Sequence[SpatialStart],
    settings: SpatialBatchSettings,
    duration: float | None,
) -> dict[str, Any]:
    """Return of what a batch was computed, beside its labels.

    duration: how long bodies were followed, where given [s]. Returns numbers and words; bodies and starts as JSON, and
    a digest of all bodies.

    >>> made = provenance([SpatialBody.box(1.0, 1.0, 4.0)], [None], [SpatialStart()], SpatialBatchSettings(), None)
    >>> made["duration_s"], len(json.loads(made["bodies"]))
    ('to the end of the motion', 1)
    """
    spelled = json.dumps([None if body is None else _numbers(body) for body in bodies])
    few = {"bodies": spelled} if len(bodies) <= _FEW else {}
    leaning = [[s.tilt, s.azimuth, s.yaw, *np.ravel(s.angular_velocity).tolist()] for s in starts if s.valid]
    return {
        "duration_s": "to the end of the motion" if duration is None else float(duration),
        **{f"setting_{name}": value for name, value in vars(settings).items()},
        "motions": json.dumps([[motion_provenance(part) for part in _parts(motion)] for motion in motions]),
        "starts": json.dumps(leaning),
        **few,
        "bodies_sha256": hashlib.sha256(spelled.encode()).hexdigest(),
    }


def stated(batch: "SpatialBatch") -> dict[str, Any]:
    """Return the provenance of a batch with software, engine and refusals."""
    refused = json.dumps({str(number): reason for number, reason in batch.refused.items()})
    return {"software": software(), "engine": batch.engine, "refused": refused, **batch.provenance}


def exported(batch: "SpatialBatch") -> Table:
    """Return what the files of a batch hold.

    Returns one row a history: numbers of body, motion and start, names of motion and restitution, scale, all results.
    """
    from rocking.dynamics.spatial_batch.result import DIMENSIONS

    places = dict(zip(DIMENSIONS, np.unravel_index(np.arange(len(batch)), batch.shape), strict=True))
    rows = {name: Column(places[name], "1", f"number of the {name}") for name in ("body", "motion", "start")}
    for name in ("motion", "restitution"):
        words = np.array([str(label) for label in batch.labels[name]])
        key = "motion_name" if name == "motion" else name
        rows[key] = Column(words[places[name]], "", f"name of the {name}")
    rows["scale"] = Column(np.array(batch.labels["scale"], dtype=np.float64)[places["scale"]], "1", "factor")
    rows |= {name: Column.of(name, values) for name, values in batch.results.items()}
    return Table("history", rows, stated(batch), no_unit="-")


def _numbers(body: SpatialBody) -> dict[str, Any]:
    return {
        "mass_kg": body.mass,
        "centre_m": body.centre.tolist(),
        "inertia_kg_m2": np.ravel(body.inertia).tolist(),
        "base_m": np.ravel(body.base).tolist(),
    }


def _parts(motion: Any) -> tuple[Any, ...]:
    return motion if isinstance(motion, tuple) else (motion,)
