import rocking.outcome

from .base import Start as Start
from .impact_resolution import GroundContact as GroundContact
from .response import ContactResponse as ContactResponse
from .settings import ContactSettings as ContactSettings
from .shenton import analytic_regime as analytic_regime
from .shenton import friction_demand as friction_demand
from .shenton import regime_at_start as regime_at_start
from .shenton import regime_map as regime_map

Regime = rocking.outcome.Regime
