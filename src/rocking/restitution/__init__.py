"""What an impact costs: published and derived restitution models, and what a coefficient implies."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.restitution._implied import Implication as Implication
    from rocking.restitution._implied import implied as implied
    from rocking.restitution._model import Flag as Flag
    from rocking.restitution._model import InertiaModel as InertiaModel
    from rocking.restitution._model import Restitution as Restitution
    from rocking.restitution._model import RestitutionModel as RestitutionModel
    from rocking.restitution.calibrated import Calibrated as Calibrated
    from rocking.restitution.contact_bed import ContactBedModel as ContactBedModel
    from rocking.restitution.distributed_impulse import DistributedImpulse as DistributedImpulse
    from rocking.restitution.fixed import Fixed as Fixed
    from rocking.restitution.horizontal_momentum import HorizontalMomentum as HorizontalMomentum
    from rocking.restitution.housner import Housner as Housner
    from rocking.restitution.identities import IdentityCheck as IdentityCheck
    from rocking.restitution.identities import identity_report as identity_report
    from rocking.restitution.impact import ImpactGeometry as ImpactGeometry
    from rocking.restitution.interface import Interface as Interface
    from rocking.restitution.ked import EnergyBalance as EnergyBalance
    from rocking.restitution.ked import Ked as Ked
    from rocking.restitution.ked import energy_balance as energy_balance
    from rocking.restitution.ked import projected_moment as projected_moment
    from rocking.restitution.plastic_winkler import PlasticWinkler as PlasticWinkler
    from rocking.restitution.registry import coefficient_of_restitution as coefficient_of_restitution
    from rocking.restitution.registry import model as model
    from rocking.restitution.registry import models as models
    from rocking.restitution.registry import register as register
    from rocking.restitution.shifted_impulse import ShiftedImpulse as ShiftedImpulse
else:
    __all__, __getattr__, __dir__ = exports(__name__)
