"""Bodies in space: rocking about edges and vertices, rolling on rims, under three components of motion."""

from rocking.dynamics.spatial.impact import SpatialImpactLaw
from rocking.dynamics.spatial.response import SpatialResponse
from rocking.dynamics.spatial.rocker import SpatialBody
from rocking.dynamics.spatial.start import SpatialStart
from rocking.outcome import ContactMode

__all__ = [
    "ContactMode",
    "SpatialBody",
    "SpatialImpactLaw",
    "SpatialResponse",
    "SpatialStart",
]
