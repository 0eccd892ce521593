"""What the files of a rocking response hold: its samples, its impacts, what was computed from what."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.exportable import motion_provenance
from rocking.tables import Column, Table
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.dynamics.response import Response

_SAMPLES = (
    "time", "rotation", "angular_velocity", "ground_acceleration", "vertical_ground_acceleration", "kinetic_energy",
    "potential_energy", "work_of_ground", "energy_lost", "horizontal_force", "vertical_force",
)  # fmt: skip


def columns(response: "Response") -> dict[str, FloatArray]:
    """Return the samples of a response by name.

    Returns all of one length; `vertical_ground_acceleration` only if the motion has a vertical part.
    """
    energy, contact = response.energy, response.contact
    values = (
        response.time, response.rotation, response.angular_velocity, response.ground_acceleration,
        response.vertical_ground_acceleration, energy.kinetic, energy.potential, energy.work, energy.lost,
        contact.horizontal, contact.vertical,
    )  # fmt: skip
    count = response.time.size  # energy and forces may have one row more, for a fall after the last sample
    pairs = zip(_SAMPLES, values, strict=True)
    return {name: value[:count] for name, value in pairs if value is not None}


def provenance(response: "Response") -> dict[str, Any]:
    """Return what was computed from what, as plain values."""
    motion, parameters = response.motion, response.parameters
    sides = {
        f"{name}_{foot}": getattr(getattr(parameters, foot), name)
        for foot in ("left", "right")
        for name in ("slenderness_angle", "frequency_parameter", "semi_diagonal", "coefficient")
    }
    return {
        "software": SOFTWARE,
        "engine": response.engine,
        "outcome": response.outcome.name,
        "status": response.status.name,
        "still_rocking": response.still_rocking,
        "summary": response.summary,
        "side": response.side,
        "impacts": int(response.trajectory.impacts),
        **({"overturning_time_s": response.overturning_time} if response.side else {}),
        "body": type(response.body).__name__,
        "mass_kg": response.body.mass,
        "restitution": parameters.label,
        **sides,
        "motion": "none: free rocking" if motion is None else motion.name,
        "motion_provenance": motion_provenance(motion),
        "scale": response.scale,
        "random_stream": response.stream,
        **{f"setting_{k}": v for k, v in response.settings.stated.items()},
    }


def exported(response: "Response") -> Table:
    """Return what the files of a response hold."""
    samples = {name: Column.of(name, values) for name, values in columns(response).items()}
    measured = ("time", "velocity_before", "velocity_after", "coefficient")
    impacts = {name: Column.of(name, response.impacts[name]) for name in measured}
    onto = np.where(response.impacts["onto"] == "right", 1, -1).astype(np.int8)
    impacts["onto"] = Column.of("onto", onto)
    return Table("time", samples, provenance(response), {"impact": Table("impact", impacts)}, no_unit="-")
