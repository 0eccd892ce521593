"""Elastic contact of round points."""

from dataclasses import dataclass

from rocking import checks
from rocking.restitution.bed.law import ContactLaw, LawKind, LawNumbers


@dataclass(frozen=True)
class Hertz(ContactLaw):
    """Hertz contact: F = (4/3) E* sqrt(R) d^1.5 (Hertz 1882; Johnson, Contact Mechanics, 1985).

    Parameters
    ----------
    modulus : float
        Effective modulus E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 [Pa].
    radius : float
        Radius of curvature of a contact point R [m].

    Raises
    ------
    InvalidValueError
        If a value is not above zero.

    Examples
    --------
    >>> round(Hertz(modulus=3e9, radius=0.01).numbers(mass=1.0).stiffness / 1e6, 6)
    400.0
    """

    modulus: float
    radius: float

    def __post_init__(self) -> None:
        checks.positive("modulus", self.modulus, "Pa", hint="GPa?")
        checks.length("radius", self.radius)

    def numbers(self, mass: float) -> LawNumbers:
        return LawNumbers(LawKind.HUNT_CROSSLEY, 4.0 / 3.0 * self.modulus * self.radius**0.5, exponent=1.5)  # Eq. 119

    @property
    def label(self) -> str:
        return f"Hertz, E*={self.modulus:.4g} Pa, R={self.radius:.4g} m"
