import rocking.outcome

from ._simulate import free_rocking as free_rocking
from ._simulate import simulate as simulate
from .contact.base import Start as Start
from .contact.response import ContactResponse as ContactResponse
from .contact.settings import ContactSettings as ContactSettings
from .hull.response import HullResponse as HullResponse
from .hull.settings import HullSettings as HullSettings
from .impact_laws import ConstantRestitution as ConstantRestitution
from .impact_laws import ImpactLaw as ImpactLaw
from .impact_laws import RandomRestitution as RandomRestitution
from .impact_laws import SpeedRestitution as SpeedRestitution
from .many import simulate_many as simulate_many
from .parameters import RockingParameters as RockingParameters
from .parameters import RockingSide as RockingSide
from .plane.settings import PlaneSettings as PlaneSettings
from .response import Response as Response
from .settings import Settings as Settings
from .space.attitude import SpatialStart as SpatialStart
from .space.body import SpatialBody as SpatialBody
from .space.response import SpatialResponse as SpatialResponse
from .space.settings import SpaceBatchSettings as SpaceBatchSettings
from .space.settings import SpaceSettings as SpaceSettings

Outcome = rocking.outcome.Outcome
Status = rocking.outcome.Status
