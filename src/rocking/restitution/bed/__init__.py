"""The contact bed: an impact that takes time, on contact points with stiffness, loss and friction."""

from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.emergent import BedStatus, Emergent
from rocking.restitution.bed.friction import BaseFriction, Coulomb, RegularisedCoulomb, Sticking
from rocking.restitution.bed.hertz import Hertz
from rocking.restitution.bed.hunt_crossley import HuntCrossley
from rocking.restitution.bed.impact import BedImpact, bed_impact, setup_of
from rocking.restitution.bed.kelvin_voigt import KelvinVoigt
from rocking.restitution.bed.law import ContactLaw
from rocking.restitution.bed.many import BedImpacts, bed_impacts
from rocking.restitution.bed.plastic_unloading import PlasticUnloading
from rocking.restitution.bed.rocking_down import BedRocking, bed_free_rocking

__all__ = [
    "BaseFriction",
    "BedImpact",
    "BedImpacts",
    "BedRocking",
    "BedStatus",
    "ContactBed",
    "ContactLaw",
    "Coulomb",
    "Emergent",
    "Hertz",
    "HuntCrossley",
    "KelvinVoigt",
    "PlasticUnloading",
    "RegularisedCoulomb",
    "Sticking",
    "bed_free_rocking",
    "bed_impact",
    "bed_impacts",
    "setup_of",
]
