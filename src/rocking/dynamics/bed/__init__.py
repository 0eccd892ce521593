"""The contact bed: an impact that takes time, on contact points with stiffness, loss and friction."""

from rocking.dynamics.bed.contact_bed import ContactBed
from rocking.dynamics.bed.emergent import BedStatus, Emergent
from rocking.dynamics.bed.friction import BaseFriction, Coulomb, RegularisedCoulomb, Sticking
from rocking.dynamics.bed.hertz import Hertz
from rocking.dynamics.bed.hunt_crossley import HuntCrossley
from rocking.dynamics.bed.impact import BedImpact, bed_impact, setup_of
from rocking.dynamics.bed.kelvin_voigt import KelvinVoigt
from rocking.dynamics.bed.law import ContactLaw
from rocking.dynamics.bed.many import BedImpacts, bed_impacts
from rocking.dynamics.bed.plastic_unloading import PlasticUnloading
from rocking.dynamics.bed.rocking_down import BedRocking, bed_free_rocking

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
