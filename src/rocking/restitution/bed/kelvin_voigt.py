"""Spring and dashpot side by side."""

from dataclasses import dataclass
from typing import Self

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.restitution.bed.law import ContactLaw, LawKind, LawNumbers


@dataclass(frozen=True)
class KelvinVoigt(ContactLaw):
    """Linear spring and dashpot: F = k d + c d' while that is above zero and d > 0.

    Parameters
    ----------
    stiffness : float
        k of one copy of the law; zero leaves the dashpot alone [N/m].
    damping : float, optional
        c of one copy [N s/m]; by default from `damping_ratio`.
    damping_ratio : float, optional
        zeta with c = 2 zeta sqrt(k m), m the mass of the body [-].

    Raises
    ------
    InvalidValueError
        If a value is negative, both dampings are given, or the law would give no force at all.

    Examples
    --------
    >>> KelvinVoigt(4e6, damping_ratio=0.5).numbers(mass=100.0).damping
    20000.0
    """

    stiffness: float
    damping: float | None = None
    damping_ratio: float | None = None

    def __post_init__(self) -> None:
        checks.within("stiffness", self.stiffness, 0.0, 1e18, unit="N/m")
        if self.damping is not None and self.damping_ratio is not None:
            raise InvalidValueError("give damping or damping_ratio, not both: one of them follows from the other")
        if self.damping is not None:
            checks.within("damping", self.damping, 0.0, 1e18, unit="N s/m")
        if self.damping_ratio is not None:
            checks.within("damping_ratio", self.damping_ratio, 0.0, 1e6)
        if self.stiffness == 0.0 and not self.damping:
            raise InvalidValueError("stiffness must be > 0 N/m where there is no dashpot, got 0; a bed without force?")

    @classmethod
    def from_layer(
        cls, modulus: float, area: float, thickness: float, *, damping_ratio: float = 0.0, confinement: float = 1.0
    ) -> Self:
        """Return the law of an elastic layer under the whole base: k = E_eff A / t (docs/theory.md, Section 13).

        Parameters
        ----------
        modulus : float
            Elastic modulus E of the layer [Pa].
        area : float
            Area of the base A [m2].
        thickness : float
            Thickness of the layer t [m].
        damping_ratio : float
            zeta of the bed [-].
        confinement : float
            E_eff / E, above one for a layer that cannot bulge sideways [-].

        Returns
        -------
        KelvinVoigt
            The law of the whole bed.

        Examples
        --------
        >>> KelvinVoigt.from_layer(2e9, area=0.05, thickness=0.01).stiffness
        10000000000.0
        """
        modulus = checks.positive("modulus", modulus, "Pa", hint="GPa?")
        area = checks.positive("area", area, "m2")
        thickness = checks.length("thickness", thickness)
        return cls(  # Eq. 115
            checks.positive("confinement", confinement) * modulus * area / thickness, damping_ratio=damping_ratio
        )

    def numbers(self, mass: float) -> LawNumbers:
        ratio = self.damping_ratio or 0.0
        damping = 2.0 * ratio * (self.stiffness * mass) ** 0.5 if self.damping is None else self.damping  # Eq. 116
        return LawNumbers(LawKind.KELVIN_VOIGT, float(self.stiffness), float(damping))

    @property
    def label(self) -> str:
        loss = f"c={self.damping:.4g} N s/m" if self.damping is not None else f"zeta={self.damping_ratio or 0.0:.4g}"
        return f"Kelvin-Voigt, k={self.stiffness:.4g} N/m, {loss}"
