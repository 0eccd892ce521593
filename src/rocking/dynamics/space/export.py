"""What the files of a response in space hold: samples, impacts, contacts, what was computed from what."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.tables import Column, Table
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.dynamics.space.response import SpatialResponse

_AXES = ("x", "y", "z")


def columns(response: "SpatialResponse") -> dict[str, Column]:
    """Return the samples of a response in space by name."""
    energy, states = response.energy, response.states
    ground = response.ground.at(response.time)
    values = {"time": response.time}
    values |= {f"quaternion_{axis}": states.quaternion[:, k] for k, axis in enumerate(("s", *_AXES))}
    values |= _vector("angular_velocity", states.angular_velocity)
    values |= {"tilt": response.tilt, "azimuth": response.azimuth, "contact": response.contact.astype(np.float64)}
    values |= _vector("centre", response.centre) | _vector("ground_acceleration", ground)
    values |= {"kinetic_energy": energy.kinetic, "potential_energy": energy.potential}
    values |= {"work_of_ground": energy.work, "energy_lost": energy.lost}
    return {name: Column.of(name, each) for name, each in values.items()}


def provenance(response: "SpatialResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values.

    Returns Numbers, words and lists of numbers; ``overturning_direction_rad`` only where it overturned.
    """
    body, direction = response.body, response.overturning_direction
    return {
        "software": SOFTWARE,
        "engine": response.trajectory.engine,
        "outcome": response.outcome.name,
        "status": response.status.name,
        "still_rocking": response.still_rocking,
        "summary": response.summary,
        **({} if math.isnan(direction) else {"overturning_direction_rad": direction}),
        "mass_kg": body.mass,
        "centre_m": body.centre.tolist(),
        "inertia_kg_m2": body.inertia.ravel().tolist(),
        "base_m": np.ravel(body.base).tolist(),
        "restitution": response.law.label,
        **{f"motion_{axis}": name for axis, name in zip(("x", "y", "vertical"), response.names, strict=True)},
        **{f"setting_{k}": v for k, v in response.settings.stated.items()},
    }


def exported(response: "SpatialResponse") -> Table:
    """Return what the files of a response in space hold.

    Returns Samples, impacts, intervals of one contact, and provenance.
    """
    known = ("time", "energy_before", "energy_after", "impulse", "pull")
    impacts = {name: Column.of(name, response.impacts[name]) for name in known}
    impacts["contact"] = Column(response.impacts["contact"], "", "contact that stays")
    impacts["vertices"] = Column(response.impacts["vertices"], "", "vertices that stay on the ground")
    rows = response.intervals
    intervals = {
        "start": Column.of("start", np.array([start for start, _, _, _ in rows], dtype=np.float64)),
        "end": Column.of("end", np.array([end for _, end, _, _ in rows], dtype=np.float64)),
        "contact": Column(np.array([contact.name.lower() for _, _, contact, _ in rows], dtype="U8"), "", "contact"),
        "vertices": Column.of(
            "vertices", np.array(["-".join(map(str, points)) for _, _, _, points in rows], dtype="U64")
        ),
    }
    beside = {"impact": Table("impact", impacts), "interval": Table("interval", intervals)}
    return Table("time", columns(response), provenance(response), beside, no_unit="-")


def _vector(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    return {f"{name}_{axis}": values[:, k] for k, axis in enumerate(_AXES)}
