"""Rest, sliding, rocking, sliding while rocking, and flight of a plane body, with friction and impacts."""

from rocking.dynamics.contact.base import Start
from rocking.dynamics.contact.impact_resolution import GroundContact
from rocking.dynamics.contact.response import ContactResponse
from rocking.dynamics.contact.shenton import analytic_regime, friction_demand, regime_at_start, regime_map
from rocking.outcome import Regime

__all__ = [
    "ContactResponse",
    "GroundContact",
    "Regime",
    "Start",
    "analytic_regime",
    "friction_demand",
    "regime_at_start",
    "regime_map",
]
