"""How a body moves: equations, engines, responses."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.dynamics._simulate import free_rocking as free_rocking
    from rocking.dynamics._simulate import simulate as simulate
    from rocking.dynamics.contact.base import Start as Start
    from rocking.dynamics.contact.response import ContactResponse as ContactResponse
    from rocking.dynamics.contact.settings import ContactSettings as ContactSettings
    from rocking.dynamics.hull.response import HullResponse as HullResponse
    from rocking.dynamics.hull.settings import HullSettings as HullSettings
    from rocking.dynamics.impact_laws import ConstantRestitution as ConstantRestitution
    from rocking.dynamics.impact_laws import ImpactLaw as ImpactLaw
    from rocking.dynamics.impact_laws import RandomRestitution as RandomRestitution
    from rocking.dynamics.impact_laws import SpeedRestitution as SpeedRestitution
    from rocking.dynamics.many import simulate_many as simulate_many
    from rocking.dynamics.parameters import RockingParameters as RockingParameters
    from rocking.dynamics.parameters import RockingSide as RockingSide
    from rocking.dynamics.plane.settings import PlaneSettings as PlaneSettings
    from rocking.dynamics.response import Response as Response
    from rocking.dynamics.settings import Settings as Settings
    from rocking.dynamics.space.attitude import SpatialStart as SpatialStart
    from rocking.dynamics.space.body import SpatialBody as SpatialBody
    from rocking.dynamics.space.response import SpatialResponse as SpatialResponse
    from rocking.dynamics.space.settings import SpaceBatchSettings as SpaceBatchSettings
    from rocking.dynamics.space.settings import SpaceSettings as SpaceSettings
    from rocking.outcome import Outcome as Outcome
    from rocking.outcome import Status as Status
else:
    __all__, __getattr__, __dir__ = exports(__name__)
