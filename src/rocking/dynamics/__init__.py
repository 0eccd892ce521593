"""How a body moves: equations, engines, responses."""

from rocking.dynamics.histories import free_rocking, simulate
from rocking.dynamics.impact_law import ConstantRestitution, ImpactLaw, RandomRestitution, SpeedRestitution
from rocking.dynamics.many import simulate_many
from rocking.dynamics.response import Response
from rocking.dynamics.rocker import Rocker, RockingSide
from rocking.dynamics.settings import Settings
from rocking.outcome import Outcome, Status

__all__ = [
    "ConstantRestitution",
    "ImpactLaw",
    "Outcome",
    "RandomRestitution",
    "Response",
    "Rocker",
    "RockingSide",
    "Settings",
    "SpeedRestitution",
    "Status",
    "free_rocking",
    "simulate",
    "simulate_many",
]
