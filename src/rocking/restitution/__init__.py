"""What an impact costs: published and derived restitution models, and what a coefficient implies."""

from typing import TYPE_CHECKING

from rocking.lazy import exports
from rocking.restitution.impact import ImpactGeometry
from rocking.restitution.implied import Implication, implied
from rocking.restitution.model import Flag, InertiaModel, Restitution, RestitutionModel
from rocking.restitution.registry import coefficient_of_restitution, homes, model, models, recommend, register

if TYPE_CHECKING:
    from rocking.restitution.calibrated import Calibrated
    from rocking.restitution.contact_bed import ContactBedModel
    from rocking.restitution.distributed_impulse import DistributedImpulse
    from rocking.restitution.fixed import Fixed
    from rocking.restitution.horizontal_momentum import HorizontalMomentum
    from rocking.restitution.housner import Housner
    from rocking.restitution.identities import IdentityCheck, identity_report
    from rocking.restitution.interface import Interface
    from rocking.restitution.ked import EnergyBalance, Ked, energy_balance, projected_moment
    from rocking.restitution.plastic_winkler import PlasticWinkler
    from rocking.restitution.shifted_impulse import ShiftedImpulse

__all__ = [
    "Calibrated",
    "ContactBedModel",
    "DistributedImpulse",
    "EnergyBalance",
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
    "energy_balance",
    "identity_report",
    "implied",
    "model",
    "models",
    "projected_moment",
    "recommend",
    "register",
]

_HOME = {
    "EnergyBalance": "ked",
    "IdentityCheck": "identities",
    "Interface": "interface",
    "energy_balance": "ked",
    "identity_report": "identities",
    "projected_moment": "ked",
}

# a model is imported when it is first asked for: a response needs one of them, not all
_HOMES = {name: f"rocking.restitution.{home}" for name, home in _HOME.items()} | homes
__getattr__, _ = exports("rocking.restitution", _HOMES)


def __dir__() -> list[str]:
    """Public names for completion."""
    return sorted(__all__)
