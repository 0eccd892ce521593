"""Restitution of 3D bodies: impacts between corners and edges."""

from rocking.restitution.space.calibrated import SpatialCalibrated
from rocking.restitution.space.energies import UnitEnergies, unit_energies
from rocking.restitution.space.horizontal_momentum import SpatialHorizontalMomentum
from rocking.restitution.space.housner import SpatialHousner
from rocking.restitution.space.impact import SpatialImpact
from rocking.restitution.space.impulse_position import SpatialKed
from rocking.restitution.space.interface import edge_coefficient, impact_in_space, spatial_model, spatial_models
from rocking.restitution.space.ked import SpatialKedPoint
from rocking.restitution.space.model import SpatialFlag, SpatialModel, SpatialRestitution

__all__ = [
    "SpatialCalibrated",
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
    "impact_in_space",
    "spatial_model",
    "spatial_models",
    "unit_energies",
]
