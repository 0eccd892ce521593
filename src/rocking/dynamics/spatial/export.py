"""What the files of a response in space hold: samples, impacts, contacts, what was computed from what."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.dynamics.exported import Exported, Quantity
from rocking.dynamics.spatial.outcome import Contact

if TYPE_CHECKING:
    from rocking.dynamics.spatial.response import SpatialResponse

_AXES = ("x", "y", "z")
_CONTACTS = ", ".join(f"{contact.code} {contact.name.lower()}" for contact in Contact)
_IMPACT_UNITS = {"time": "s", "energy_before": "J", "energy_after": "J", "impulse": "N s", "pull": "N s"}


def columns(response: "SpatialResponse") -> dict[str, Quantity]:
    """Return the samples of a response in space by name."""
    energy, states = response.energy, response.states
    ground = response.ground.at(response.time)
    made = {"time": Quantity(response.time, "s", "time")}
    for k, name in enumerate(("s", *_AXES)):
        words = f"attitude, component {name} of the unit quaternion"
        made[f"quaternion_{name}"] = Quantity(states.quaternion[:, k], "1", words)
    made |= _vector("angular_velocity", "rad/s", "angular velocity about", states.angular_velocity)
    made["tilt"] = Quantity(response.tilt, "rad", "angle between the axis of the body and the vertical")
    made["azimuth"] = Quantity(response.azimuth, "rad", "direction in which the body leans, from x towards y")
    made["contact"] = Quantity(response.contact.astype(np.float64), "1", _CONTACTS)
    made |= _vector("centre", "m", "centre of mass,", response.centre)
    made |= _vector("ground_acceleration", "m/s2", "acceleration of the ground,", ground)
    made["kinetic_energy"] = Quantity(energy.kinetic, "J", "kinetic energy")
    made["potential_energy"] = Quantity(energy.potential, "J", "potential energy above rest")
    made["work_of_ground"] = Quantity(energy.work, "J", "work done by the ground since the start")
    made["energy_lost"] = Quantity(energy.lost, "J", "energy lost at impacts since the start")
    return made


def provenance(response: "SpatialResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values.

    Returns Numbers, words and lists of numbers; ``overturning_direction_rad`` only where it overturned.
    """
    from rocking.dynamics.export import software

    body, direction = response.body, response.overturning_direction
    return {
        "software": software(),
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
        **{f"setting_{k}": v for k, v in vars(response.settings).items()},
    }


def exported(response: "SpatialResponse") -> Exported:
    """Return what the files of a response in space hold.

    Returns Samples, impacts, intervals of one contact, and provenance.
    """
    impacts = {name: Quantity(response.impacts[name], unit) for name, unit in _IMPACT_UNITS.items()}
    impacts["contact"] = Quantity(response.impacts["contact"], words="contact that stays")
    impacts["vertices"] = Quantity(response.impacts["vertices"], words="vertices that stay on the ground")
    rows = response.intervals
    intervals = {
        "start": Quantity(np.array([start for start, _, _, _ in rows], dtype=np.float64), "s"),
        "end": Quantity(np.array([end for _, end, _, _ in rows], dtype=np.float64), "s"),
        "contact": Quantity(np.array([contact.name.lower() for _, _, contact, _ in rows], dtype="U8"), words="contact"),
        "vertices": Quantity(
            np.array(["-".join(map(str, points)) for _, _, _, points in rows], dtype="U64"),
            words="vertices on the ground",
        ),
    }
    return Exported(columns(response), {"impact": impacts, "interval": intervals}, provenance(response))


def _vector(name: str, unit: str, words: str, values: np.ndarray) -> dict[str, Quantity]:
    return {f"{name}_{axis}": Quantity(values[:, k], unit, f"{words} {axis}") for k, axis in enumerate(_AXES)}
