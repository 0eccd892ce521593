"""The contact bed: impacts resolved in time, on contact points with stiffness, damping and friction."""

from rocking.restitution.bed.contact_bed import BaseFriction, ContactBed, Coulomb, RegularisedCoulomb, Sticking
from rocking.restitution.bed.impact import BedImpact, BedImpacts, BedStatus, bed_impact, bed_impacts
from rocking.restitution.bed.laws import ContactLaw, Hertz, HuntCrossley, KelvinVoigt, PlasticUnloading
from rocking.restitution.bed.rocking_down import bed_free_rocking
from rocking.restitution.bed.setup import setup_of

__all__ = [
    "BaseFriction",
    "BedImpact",
    "BedImpacts",
    "BedStatus",
    "ContactBed",
    "ContactLaw",
    "Coulomb",
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
