"""Rest, sliding, rocking, sliding while rocking, and flight of a plane body, with friction and impacts."""

from rocking.dynamics.contact.ground_contact import GroundContact
from rocking.dynamics.contact.response import PlanarResponse
from rocking.dynamics.contact.shenton import analytic_regime, friction_demand, regime_at_start, regime_map
from rocking.dynamics.contact.start import Start
from rocking.outcome import Regime

__all__ = [
    "GroundContact",
    "PlanarResponse",
    "Regime",
    "Start",
    "analytic_regime",
    "friction_demand",
    "regime_at_start",
    "regime_map",
]
