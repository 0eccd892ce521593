"""What the files of a planar response hold: samples, impacts, regimes, what was computed from what."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.exportable import motion_provenance
from rocking.tables import Column, Table
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.dynamics.contact.response import ContactResponse

SAMPLES = (
    "time", "displacement", "rise", "rotation", "horizontal_velocity", "vertical_velocity", "angular_velocity",
    "regime", "sliding_distance", "horizontal_force", "vertical_force_left", "vertical_force_right", "kinetic_energy",
    "potential_energy", "work_of_ground", "energy_lost", "lost_in_friction",
)  # fmt: skip
"""What is known at every sample."""
_IMPACTS = (
    "time", "velocity_before", "velocity_after", "normal_left", "normal_right", "tangential_left", "tangential_right",
    "lost",
)  # fmt: skip


def columns(response: "ContactResponse") -> dict[str, FloatArray]:
    """Return the samples of a response by name.

    Returns all of one length, in the order of `SAMPLES`.
    """
    energy, forces = response.energy, response.forces
    values = (
        response.time, response.displacement, response.rise, response.rotation, response.horizontal_velocity,
        response.vertical_velocity, response.angular_velocity, response.sampled("regime"), response.sampled("slid"),
        forces.horizontal, forces.left, forces.right, energy.kinetic, energy.potential, energy.work,
        energy.lost_in_impacts, energy.lost_in_friction,
    )  # fmt: skip
    return dict(zip(SAMPLES, values, strict=True))


def provenance(response: "ContactResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values."""
    motion, law, base = response.motion, response.law, response.base
    imposed = (
        "none: complementarity" if law.restitution is None else "left {:.9g}, right {:.9g}".format(*law.restitution)
    )
    return {
        "software": SOFTWARE,
        "engine": "planar: Taylor series with events and complementarity",
        "outcome": response.outcome.name,
        "status": response.status.name,
        "still_rocking": response.still_rocking,
        "summary": response.summary,
        "body": type(response.body).__name__,
        "mass_kg": base.mass,
        "inertia_kg_m2": base.mass * base.inertia,
        "centre_height_m": base.height,
        "half_width_left_m": base.left,
        "half_width_right_m": base.right,
        "friction": law.friction,
        "bounce": law.bounce,
        "imposed_restitution": imposed,
        "motion": "none: ground at rest" if motion is None else motion.name,
        "motion_provenance": motion_provenance(motion),
        "scale": response.scale,
        **{f"setting_{k}": v for k, v in response.settings.stated.items()},
    }


def exported(response: "ContactResponse") -> Table:
    """Return what the files of a response hold.

    Returns Samples, impacts, intervals of one regime, and provenance.
    """
    samples = {name: Column.of(name, values) for name, values in columns(response).items()}
    impacts, regimes = response.impacts, response.regimes
    blows = {name: Column.of(name, impacts[name]) for name in _IMPACTS}
    blows["feet"] = Column.of("feet", impacts["feet"])
    blows["slips"] = Column.of("slips", impacts["slips"].astype(np.int8))
    intervals = {name: Column.of(name, regimes[name]) for name in ("start", "end", "distance")}
    intervals["regime"] = Column(regimes["regime"], "", "regime")
    intervals["feet"] = Column(regimes["feet"], "", "feet that carry")
    beside = {"impact": Table("impact", blows), "interval": Table("interval", intervals)}
    return Table("time", samples, provenance(response), beside, no_unit="-")
