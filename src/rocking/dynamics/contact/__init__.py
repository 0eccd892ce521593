"""Rest, sliding, rocking, sliding while rocking, and flight of a plane body, with friction and impacts."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.dynamics.contact.base import Start as Start
    from rocking.dynamics.contact.impact_resolution import GroundContact as GroundContact
    from rocking.dynamics.contact.response import ContactResponse as ContactResponse
    from rocking.dynamics.contact.settings import ContactSettings as ContactSettings
    from rocking.dynamics.contact.shenton import analytic_regime as analytic_regime
    from rocking.dynamics.contact.shenton import friction_demand as friction_demand
    from rocking.dynamics.contact.shenton import regime_at_start as regime_at_start
    from rocking.dynamics.contact.shenton import regime_map as regime_map
    from rocking.outcome import Regime as Regime
else:
    __all__, __getattr__, __dir__ = exports(__name__)
