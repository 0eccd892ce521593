"""Predict what an impact costs a rocking body, how it rocks in an earthquake, and whether it overturns."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from rocking.version import __version__ as __version__

if TYPE_CHECKING:
    from rocking import bodies, conventions, dynamics, errors, evidence, motions, plots, report, restitution, studies
    from rocking.bodies import Block, Body, MassPoints, Region, Section, Side, shapes, solid
    from rocking.bodies.formats import read_body, read_solid
    from rocking.bodies.solid import Part, Solid
    from rocking.campaigns import Campaign
    from rocking.dynamics import (
        Outcome,
        RandomRestitution,
        Response,
        SpeedRestitution,
        free_rocking,
        simulate,
        simulate_many,
    )
    from rocking.dynamics.planar import PlanarResponse, simulate_with_contact
    from rocking.dynamics.spatial import SpatialBody, SpatialResponse, free_rocking_spatial, simulate_spatial
    from rocking.dynamics.spatial_batch import SpatialBatch, simulate_spatial_batch
    from rocking.motions import GroundMotion, pulses, synthetic
    from rocking.motions.formats import read_motion
    from rocking.restitution import RestitutionModel, coefficient_of_restitution
    from rocking.restitution.bed import ContactBed, bed_impact
    from rocking.restitution.spatial import edge_coefficient, impact_in_space
    from rocking.studies._overturning_map import overturning_map
    from rocking.studies._rocking_spectrum import rocking_spectrum
    from rocking.studies.minimum_acceleration import minimum_overturning_acceleration

__all__ = [
    "Block",
    "Body",
    "Campaign",
    "ContactBed",
    "GroundMotion",
    "MassPoints",
    "Outcome",
    "Part",
    "PlanarResponse",
    "RandomRestitution",
    "Region",
    "Response",
    "RestitutionModel",
    "Section",
    "Side",
    "Solid",
    "SpatialBatch",
    "SpatialBody",
    "SpatialResponse",
    "SpeedRestitution",
    "bed_impact",
    "bodies",
    "coefficient_of_restitution",
    "conventions",
    "dynamics",
    "edge_coefficient",
    "errors",
    "evidence",
    "free_rocking",
    "free_rocking_spatial",
    "impact_in_space",
    "minimum_overturning_acceleration",
    "motions",
    "overturning_map",
    "plots",
    "pulses",
    "read_body",
    "read_motion",
    "read_solid",
    "report",
    "restitution",
    "rocking_spectrum",
    "shapes",
    "simulate",
    "simulate_many",
    "simulate_spatial",
    "simulate_spatial_batch",
    "simulate_with_contact",
    "solid",
    "studies",
    "synthetic",
]

_HOME = {
    "Block": "rocking.bodies",
    "Body": "rocking.bodies",
    "Campaign": "rocking.campaigns",
    "ContactBed": "rocking.restitution.bed",
    "GroundMotion": "rocking.motions",
    "MassPoints": "rocking.bodies",
    "Outcome": "rocking.dynamics",
    "Part": "rocking.bodies.solid",
    "PlanarResponse": "rocking.dynamics.planar",
    "RandomRestitution": "rocking.dynamics",
    "Region": "rocking.bodies",
    "Response": "rocking.dynamics",
    "RestitutionModel": "rocking.restitution",
    "Section": "rocking.bodies",
    "Side": "rocking.bodies",
    "Solid": "rocking.bodies.solid",
    "SpatialBatch": "rocking.dynamics.spatial_batch",
    "SpatialBody": "rocking.dynamics.spatial",
    "SpatialResponse": "rocking.dynamics.spatial",
    "SpeedRestitution": "rocking.dynamics",
    "bed_impact": "rocking.restitution.bed",
    "coefficient_of_restitution": "rocking.restitution",
    "edge_coefficient": "rocking.restitution.spatial",
    "free_rocking": "rocking.dynamics",
    "free_rocking_spatial": "rocking.dynamics.spatial",
    "impact_in_space": "rocking.restitution.spatial",
    "minimum_overturning_acceleration": "rocking.studies",
    "overturning_map": "rocking.studies",
    "pulses": "rocking.motions",
    "read_body": "rocking.bodies.formats",
    "read_motion": "rocking.motions.formats",
    "read_solid": "rocking.bodies.formats",
    "rocking_spectrum": "rocking.studies",
    "shapes": "rocking.bodies",
    "simulate": "rocking.dynamics",
    "simulate_many": "rocking.dynamics",
    "simulate_spatial": "rocking.dynamics.spatial",
    "simulate_spatial_batch": "rocking.dynamics.spatial_batch",
    "simulate_with_contact": "rocking.dynamics.planar",
    "solid": "rocking.bodies",
    "synthetic": "rocking.motions",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, so that `import rocking` stays quick."""
    if name not in __all__:
        raise AttributeError(f"module 'rocking' has no attribute {name!r}")
    home = _HOME.get(name)
    if home is None:
        return import_module(f"rocking.{name}")
    found = getattr(import_module(home), name, None)
    return import_module(f"{home}.{name}") if found is None else found


def __dir__() -> list[str]:
    """Public names for completion."""
    return sorted([*__all__, "__version__"])
