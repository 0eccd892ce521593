"""How a body moves: equations, engines, responses."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.dynamics._simulate import free_rocking, simulate
    from rocking.dynamics.contact import ContactResponse, Start
    from rocking.dynamics.hull.response import HullResponse
    from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw, RandomRestitution, SpeedRestitution
    from rocking.dynamics.many import simulate_many
    from rocking.dynamics.parameters import RockingParameters, RockingSide
    from rocking.dynamics.response import Response
    from rocking.dynamics.settings import Settings
    from rocking.dynamics.space import SpatialBody, SpatialResponse, SpatialStart
    from rocking.outcome import Outcome, Status

__all__ = [
    "ConstantRestitution",
    "ContactResponse",
    "HullResponse",
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

_HOMES = {
    "rocking.dynamics._simulate": ("free_rocking", "simulate"),
    "rocking.dynamics.contact": ("ContactResponse", "Start"),
    "rocking.dynamics.hull.response": ("HullResponse",),
    "rocking.dynamics.impact_laws": ("ConstantRestitution", "ImpactLaw", "RandomRestitution", "SpeedRestitution"),
    "rocking.dynamics.many": ("simulate_many",),
    "rocking.dynamics.parameters": ("RockingParameters", "RockingSide"),
    "rocking.dynamics.response": ("Response",),
    "rocking.dynamics.settings": ("Settings",),
    "rocking.dynamics.space": ("SpatialBody", "SpatialResponse", "SpatialStart"),
    "rocking.outcome": ("Outcome", "Status"),
}
__getattr__, __dir__ = exports("rocking.dynamics", {name: home for home, names in _HOMES.items() for name in names})
