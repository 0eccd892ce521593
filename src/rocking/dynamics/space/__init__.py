"""Bodies in space: rocking about edges and vertices, rolling on rims, under three components of motion."""

from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.impact_laws import SpatialImpactLaw
from rocking.dynamics.space.response import SpatialResponse
from rocking.outcome import ContactMode

__all__ = [
    "ContactMode",
    "SpatialBody",
    "SpatialImpactLaw",
    "SpatialResponse",
    "SpatialStart",
]
