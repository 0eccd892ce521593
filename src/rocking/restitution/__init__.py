"""What an impact costs: published and derived restitution models, and what a coefficient implies."""

from rocking.restitution.coefficient import coefficient_of_restitution
from rocking.restitution.distributed_impulse import DistributedImpulse
from rocking.restitution.fixed import Fixed
from rocking.restitution.horizontal_momentum import HorizontalMomentum
from rocking.restitution.housner import Housner
from rocking.restitution.identities import IdentityCheck, identity_report
from rocking.restitution.impact import ImpactGeometry
from rocking.restitution.implied import Implication, implied
from rocking.restitution.interface import Interface
from rocking.restitution.ked import Ked, projected_moment
from rocking.restitution.ledger import EnergyLedger, energy_ledger
from rocking.restitution.model import Flag, InertiaModel, Restitution, RestitutionModel
from rocking.restitution.plastic_winkler import PlasticWinkler
from rocking.restitution.registry import model, models, register
from rocking.restitution.shifted_impulse import ShiftedImpulse

__all__ = [
    "DistributedImpulse",
    "EnergyLedger",
    "Fixed",
    "Flag",
    "HorizontalMomentum",
    "Housner",
    "IdentityCheck",
    "ImpactGeometry",
    "Implication",
    "InertiaModel",
    "Interface",
    "Ked",
    "PlasticWinkler",
    "Restitution",
    "RestitutionModel",
    "ShiftedImpulse",
    "coefficient_of_restitution",
    "energy_ledger",
    "identity_report",
    "implied",
    "model",
    "models",
    "projected_moment",
    "register",
]
