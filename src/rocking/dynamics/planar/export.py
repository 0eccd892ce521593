"""What the files of a planar response hold: samples, impacts, regimes, what was computed from what."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.exported import Exported, Quantity, told
from rocking.dynamics.planar.mode import Regime

if TYPE_CHECKING:
    from rocking.dynamics.planar.response import PlanarResponse

COLUMNS = (
    ("time", "s", "time"),
    ("displacement", "m", "displacement of the centre of mass to the right, relative to the ground"),
    ("rise", "m", "height of the centre of mass above its place at rest"),
    ("rotation", "rad", "rotation theta, positive clockwise"),
    ("horizontal_velocity", "m/s", "velocity of the centre of mass to the right, relative to the ground"),
    ("vertical_velocity", "m/s", "velocity of the centre of mass upwards, relative to the ground"),
    ("angular_velocity", "rad/s", "angular velocity"),
    ("regime", "1", "; ".join(f"{r.code} {r.value}" for r in Regime)),
    ("sliding_distance", "m", "path of the feet along the ground since the start"),
    ("horizontal_force", "N", "force of the ground on the body, to the right"),
    ("vertical_force_left", "N", "force of the ground on the left foot, upwards"),
    ("vertical_force_right", "N", "force of the ground on the right foot, upwards"),
    ("kinetic_energy", "J", "kinetic energy relative to the ground"),
    ("potential_energy", "J", "potential energy above rest"),
    ("work_of_ground", "J", "work done by the ground since the start"),
    ("lost_in_impacts", "J", "energy lost in impacts since the start"),
    ("lost_in_friction", "J", "energy lost in friction since the start"),
)
"""Name, unit and meaning of every column."""

_IMPACT_UNITS = {
    "time": "s", "velocity_before": "rad/s", "velocity_after": "rad/s", "normal_left": "N s", "normal_right": "N s",
    "tangential_left": "N s", "tangential_right": "N s", "lost": "J",
}  # fmt: skip
_INTERVAL_UNITS = {"start": "s", "end": "s", "distance": "m"}


def columns(response: "PlanarResponse") -> dict[str, FloatArray]:
    """Return the samples of a response by name.

    Returns all of one length, in the order of `COLUMNS`.
    """
    energy, forces = response.energy, response.forces
    values = (
        response.time, response.displacement, response.rise, response.rotation, response.horizontal_velocity,
        response.vertical_velocity, response.angular_velocity, response.sampled("regime"), response.sampled("slid"),
        forces.horizontal, forces.left, forces.right, energy.kinetic, energy.potential, energy.work,
        energy.lost_in_impacts, energy.lost_in_friction,
    )  # fmt: skip
    return {name: value for (name, _, _), value in zip(COLUMNS, values, strict=True)}


def provenance(response: "PlanarResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values."""
    from rocking.dynamics.export import software

    motion, law, footing = response.motion, response.law, response.footing
    imposed = (
        "none: complementarity" if law.restitution is None else "left {:.9g}, right {:.9g}".format(*law.restitution)
    )
    return {
        "software": software(),
        "engine": "planar: Taylor series with events and complementarity",
        "outcome": response.outcome.name,
        "status": response.status.name,
        "still_rocking": response.still_rocking,
        "summary": response.summary,
        "body": type(response.body).__name__,
        "mass_kg": footing.mass,
        "inertia_kg_m2": footing.mass * footing.inertia,
        "centre_height_m": footing.height,
        "half_width_left_m": footing.left,
        "half_width_right_m": footing.right,
        "friction": law.friction,
        "bounce": law.bounce,
        "imposed_restitution": imposed,
        "motion": "none: ground at rest" if motion is None else motion.name,
        "motion_provenance": told(motion),
        "scale": response.scale,
        **{f"setting_{k}": v for k, v in vars(response.settings).items()},
    }


def exported(response: "PlanarResponse") -> Exported:
    """Return what the files of a response hold.

    Returns Samples, impacts, intervals of one regime, and provenance.
    """
    about = {name: (unit, words) for name, unit, words in COLUMNS}
    samples = {name: Quantity(values, *about[name]) for name, values in columns(response).items()}
    impacts, regimes = response.impacts, response.regimes
    blows = {name: Quantity(impacts[name], unit) for name, unit in _IMPACT_UNITS.items()}
    blows["feet"] = Quantity(impacts["feet"], words="feet that touch the ground")
    blows["slips"] = Quantity(impacts["slips"].astype(np.int8), "1", "whether the feet slid in the impact: 1 yes, 0 no")
    intervals = {name: Quantity(regimes[name], unit) for name, unit in _INTERVAL_UNITS.items()}
    intervals["regime"] = Quantity(regimes["regime"], words="regime")
    intervals["feet"] = Quantity(regimes["feet"], words="feet that carry")
    return Exported(samples, {"impact": blows, "interval": intervals}, provenance(response))
