"""How a body moves: equations, engines, responses."""

from typing import TYPE_CHECKING

from rocking.dynamics._simulate import free_rocking, simulate
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw, RandomRestitution, SpeedRestitution
from rocking.dynamics.many import simulate_many
from rocking.dynamics.parameters import RockingParameters, RockingSide
from rocking.dynamics.response import Response
from rocking.dynamics.settings import Settings
from rocking.lazy import exports
from rocking.outcome import Outcome, Status

if TYPE_CHECKING:
    from rocking.dynamics.contact import ContactResponse, Start
    from rocking.dynamics.space import SpatialBody, SpatialResponse, SpatialStart

__all__ = [
    "ConstantRestitution",
    "ContactResponse",
    "ImpactLaw",
    "Outcome",
    "RandomRestitution",
    "Response",
    "RockingParameters",
    "RockingSide",
    "Settings",
    "SpatialBody",
    "SpatialResponse",
    "SpatialStart",
    "SpeedRestitution",
    "Start",
    "Status",
    "free_rocking",
    "simulate",
    "simulate_many",
]

__getattr__, __dir__ = exports(
    "rocking.dynamics",
    {
        "ContactResponse": "rocking.dynamics.contact",
        "SpatialBody": "rocking.dynamics.space",
        "SpatialResponse": "rocking.dynamics.space",
        "SpatialStart": "rocking.dynamics.space",
        "Start": "rocking.dynamics.contact",
    },
)
