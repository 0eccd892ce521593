"""A power law with a loss that grows with depth, and Hertz's as its elastic case."""

from dataclasses import dataclass

from rocking import checks
from rocking.restitution.bed.law import ContactLaw, LawKind, LawNumbers


@dataclass(frozen=True)
class HuntCrossley(ContactLaw):
    """Power-law spring with a damping proportional to its force: F = k d^n (1 + chi d').

    Hunt and Crossley 1975, J. Appl. Mech. 42:440.

    Parameters
    ----------
    stiffness : float
        k of one copy of the law [N/m^n].
    exponent : float
        n, 1.5 for round points [-].
    viscosity : float
        chi, about 3 (1 - e) / (2 v) for a velocity ratio e near one at landing speed v [s/m].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> HuntCrossley(1e9, viscosity=0.2).label
    'Hunt-Crossley, k=1e+09 N/m^1.5, chi=0.2 s/m'
    """

    stiffness: float
    exponent: float = 1.5
    viscosity: float = 0.0

    def __post_init__(self) -> None:
        checks.within("stiffness", self.stiffness, 0.0, 1e24, unit="N/m^n", open_low=True)
        checks.within("exponent", self.exponent, 1.0, 4.0)
        checks.within("viscosity", self.viscosity, 0.0, 1e6, unit="s/m")

    def numbers(self, mass: float) -> LawNumbers:
        return LawNumbers(
            LawKind.HUNT_CROSSLEY, float(self.stiffness), exponent=float(self.exponent), viscosity=float(self.viscosity)
        )

    @property
    def label(self) -> str:
        return f"Hunt-Crossley, k={self.stiffness:.4g} N/m^{self.exponent:.4g}, chi={self.viscosity:.4g} s/m"
