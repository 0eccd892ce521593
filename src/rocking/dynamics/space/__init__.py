"""Bodies in space: rocking about edges and vertices, rolling on rims, under three components of motion."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.dynamics.space.attitude import SpatialStart as SpatialStart
    from rocking.dynamics.space.body import SpatialBody as SpatialBody
    from rocking.dynamics.space.impact_laws import SpatialImpactLaw as SpatialImpactLaw
    from rocking.dynamics.space.response import SpatialResponse as SpatialResponse
    from rocking.dynamics.space.settings import SpaceBatchSettings as SpaceBatchSettings
    from rocking.dynamics.space.settings import SpaceSettings as SpaceSettings
    from rocking.outcome import ContactMode as ContactMode
else:
    __all__, __getattr__, __dir__ = exports(__name__)
