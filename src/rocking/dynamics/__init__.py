"""How a body moves: equations, engines, responses."""

from typing import TYPE_CHECKING

from rocking.dynamics._simulate import free_rocking, simulate
from rocking.dynamics.impact_law import ConstantRestitution, ImpactLaw, RandomRestitution, SpeedRestitution
from rocking.dynamics.many import simulate_many
from rocking.dynamics.response import Response
from rocking.dynamics.rocker import Rocker, RockingSide
from rocking.dynamics.settings import Settings
from rocking.lazy import exports
from rocking.outcome import Outcome, Status

if TYPE_CHECKING:
    from rocking.dynamics.planar import PlanarResponse, Start
    from rocking.dynamics.spatial import SpatialBody, SpatialResponse, SpatialStart

__all__ = [
    "ConstantRestitution",
    "ImpactLaw",
    "Outcome",
    "PlanarResponse",
    "RandomRestitution",
    "Response",
    "Rocker",
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
        "PlanarResponse": "rocking.dynamics.planar",
        "SpatialBody": "rocking.dynamics.spatial",
        "SpatialResponse": "rocking.dynamics.spatial",
        "SpatialStart": "rocking.dynamics.spatial",
        "Start": "rocking.dynamics.planar",
    },
)
