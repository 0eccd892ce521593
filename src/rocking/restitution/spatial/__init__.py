"""What an impact costs a body in space: corner to corner, edge to edge, corner to edge."""

from rocking.restitution.spatial.energies import UnitEnergies, lost_density, unit_energies
from rocking.restitution.spatial.geometry import SpatialImpact
from rocking.restitution.spatial.horizontal_momentum import SpatialHorizontalMomentum
from rocking.restitution.spatial.housner import SpatialHousner
from rocking.restitution.spatial.impulse_position import ImpulsePosition, impulse_position
from rocking.restitution.spatial.interface import edge_coefficient, impact_in_space, spatial_model, spatial_models
from rocking.restitution.spatial.ked import SpatialKedPoint, energy_left
from rocking.restitution.spatial.ked_impulse import SpatialKed
from rocking.restitution.spatial.leaning import LeaningImpact
from rocking.restitution.spatial.model import SpatialFlag, SpatialModel, SpatialRestitution
from rocking.restitution.spatial.moments import KeptMoments, kept_moments
from rocking.restitution.spatial.rigid import RigidImpact

__all__ = [
    "ImpulsePosition",
    "KeptMoments",
    "LeaningImpact",
    "RigidImpact",
    "SpatialFlag",
    "SpatialHorizontalMomentum",
    "SpatialHousner",
    "SpatialImpact",
    "SpatialKed",
    "SpatialKedPoint",
    "SpatialModel",
    "SpatialRestitution",
    "UnitEnergies",
    "edge_coefficient",
    "energy_left",
    "impact_in_space",
    "impulse_position",
    "kept_moments",
    "lost_density",
    "spatial_model",
    "spatial_models",
    "unit_energies",
]
