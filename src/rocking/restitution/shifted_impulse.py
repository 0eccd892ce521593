"""Shifted impulse: the resultant acts at k times the lever of the new foot (Kalliontzis et al. 2016)."""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.restitution._model import InertiaModel
from rocking.restitution.impact import ImpactGeometry


@dataclass(frozen=True)
class ShiftedImpulse(InertiaModel):
    """Angular momentum is conserved about a point of the base, at a = k b_new ahead of the plumb line.

    ``r = (I_C + m (h^2 - a b_old)) / (I_C + m (h^2 + a b_new))``; k = 1 is Housner, k = 0 has no loss.

    Parameters
    ----------
    k : float
        Impulse position between plumb line (0) and new foot (1) [-]. For slender bodies, KED and a viscous flat contact
        have the limit 2/3.

    Raises
    ------
    InvalidValueError
        If k is outside [0, 1].

    Examples
    --------
    >>> from rocking import Block
    >>> block = Block(width=1.0, height=2.0)
    >>> round(ShiftedImpulse(k=1.0).coefficient(block), 12), ShiftedImpulse(k=0.0).coefficient(block)
    (0.7, 1.0)
    """

    k: float = 2.0 / 3.0

    name = "shifted-impulse"
    short_name = "shifted impulse"
    colour, linestyle = "#AC8191", ":"
    legend = "shifted impulse, k = 2/3"
    title = "the impulse acts inside the base, at k times the half base"
    reference = (
        "after Kalliontzis, Sritharan & Schultz 2016, J. Struct. Eng. 142(12) 06016002; "
        "the form in k is derived in this project"
    )
    assumptions = (
        "rigid body and ground, instantaneous impact, no sliding, no bouncing",
        "the resultant of all contact impulses passes through one given point of the base",
    )
    domain = "0 <= k <= 1; the body stops (r = 0) where 3 k >= 1 + 4 (h/b)^2 for a rectangle"
    known_defects = (
        "k is not predicted: it must be measured or fitted",
        "for asymmetric feet a small k (below 1/2) can exceed the energy bound",
    )
    inertia_only = True
    trials = ("", "k=0", "k=1")

    def __post_init__(self) -> None:
        checks.within("k", self.k, 0.0, 1.0, hint="the impulse acts between the plumb line (0) and the foot (1)")
        object.__setattr__(self, "keeps_energy", self.k >= 0.5)  # a smaller k may create energy

    def of_geometry(self, geometry: ImpactGeometry) -> FloatArray:
        """Return r from conservation of angular momentum about the impulse position [-]."""
        return shifted(geometry, np.asarray(self.k))


def shifted(geometry: ImpactGeometry, k: FloatArray) -> FloatArray:
    """Return the coefficients for arrays of impulse positions k [-]."""
    arm, gyration = k * geometry.new_lever, geometry.base_gyration
    return np.asarray((gyration - arm * geometry.old_lever) / (gyration + arm * geometry.new_lever))  # Eq. 3
