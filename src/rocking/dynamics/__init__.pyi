import rocking.outcome

from ._simulate import free_rocking as free_rocking
from ._simulate import simulate as simulate
from .frictional.response import HullResponse as HullResponse
from .frictional.settings import HullSettings as HullSettings
from .impact_laws import ConstantRestitution as ConstantRestitution
from .impact_laws import ImpactLaw as ImpactLaw
from .impact_laws import RandomRestitution as RandomRestitution
from .impact_laws import SpeedRestitution as SpeedRestitution
from .isolated.response import IsolatedResponse as IsolatedResponse
from .isolated.settings import IsolatedSettings as IsolatedSettings
from .many import simulate_many as simulate_many
from .parameters import RockingParameters as RockingParameters
from .parameters import RockingSide as RockingSide
from .plane.settings import PlaneSettings as PlaneSettings
from .plane_frictional.base import Start as Start
from .plane_frictional.response import ContactResponse as ContactResponse
from .plane_frictional.settings import ContactSettings as ContactSettings
from .response import Response as Response
from .restrained.pushover import Pushover as Pushover
from .restrained.pushover import pushover as pushover
from .restrained.response import RestrainedResponse as RestrainedResponse
from .restrained.settings import RestrainedSettings as RestrainedSettings
from .rolling.attitude import SpatialStart as SpatialStart
from .rolling.body import SpatialBody as SpatialBody
from .rolling.response import SpatialResponse as SpatialResponse
from .rolling.settings import SpaceBatchSettings as SpaceBatchSettings
from .rolling.settings import SpaceSettings as SpaceSettings
from .settings import Settings as Settings
from .stack.impacts import StackImpact as StackImpact
from .stack.impacts import stack_impact as stack_impact
from .stack.response import StackResponse as StackResponse
from .stack.settings import StackSettings as StackSettings

Outcome = rocking.outcome.Outcome
Status = rocking.outcome.Status
