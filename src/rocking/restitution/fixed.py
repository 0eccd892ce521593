"""A fixed coefficient, for example a measured value."""

from dataclasses import dataclass

import numpy as np

from rocking import checks, plausibility
from rocking.bodies import Body, Frame
from rocking.conventions import FloatArray, Foot
from rocking.restitution._model import RestitutionModel


@dataclass(frozen=True)
class Fixed(RestitutionModel):
    """Fixed coefficient for all bodies and both feet.

    Parameters
    ----------
    r : float
        Coefficient of restitution, the ratio of velocities (not of energies) [-].

    Raises
    ------
    InvalidValueError
        If r is outside [0, 1].

    Examples
    --------
    >>> from rocking import Block
    >>> Fixed(r=0.9).coefficient(Block(width=1.0, height=4.0))
    0.9
    """

    r: float

    name = "fixed"
    short_name = "given value"
    title = "a fixed coefficient"
    reference = "the user's own value"
    assumptions = ("the value was measured on this body or on a similar body",)
    domain = "0 <= r <= 1"
    known_defects = ("independent of the body: may exceed the energy bound of an asymmetric body",)
    inertia_only = True
    keeps_energy = sees_old_foot = False
    trials = ("r=0.7",)

    def __post_init__(self) -> None:
        checks.within("r", self.r, 0.0, 1.0, hint="a velocity ratio, not an energy ratio or a percentage")
        object.__setattr__(self, "slender_limit", self.r)
        object.__setattr__(self, "sees_old_foot", self.r == 1.0)
        plausibility.warn(plausibility.of_coefficient(self.r))

    def raw_coefficient(self, body: Body, foot: Foot) -> float:
        return self.r

    def of_frame(self, frame: Frame, foot: Foot) -> float:
        return self.r

    def raw_of_slenderness(self, slenderness: FloatArray) -> FloatArray:
        return np.full(slenderness.shape, self.r)
