import rocking.outcome

from .attitude import SpatialStart as SpatialStart
from .body import SpatialBody as SpatialBody
from .impact_laws import SpatialImpactLaw as SpatialImpactLaw
from .response import SpatialResponse as SpatialResponse
from .settings import SpaceBatchSettings as SpaceBatchSettings
from .settings import SpaceSettings as SpaceSettings

ContactMode = rocking.outcome.ContactMode
