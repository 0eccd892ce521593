"""Laws of contact points: force as a function of depth, speed and largest depth."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import IntEnum
from typing import Self

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError


class LawKind(IntEnum):
    """Branches of the fast engine."""

    KELVIN_VOIGT = 0
    HUNT_CROSSLEY = 1
    PLASTIC = 2


@dataclass(frozen=True, slots=True)
class LawNumbers:
    """Numbers of a law for a body of given mass, in the form that both engines use."""

    kind: LawKind  # branch of the equations
    stiffness: float  # stiffness of one copy of the law [N/m, or N/m^exponent]
    damping: float = 0.0  # Kelvin-Voigt dashpot [N s/m]
    exponent: float = 1.0  # power of the depth [-]
    viscosity: float = 0.0  # Hunt-Crossley chi [s/m]
    rebound: float = 1.0  # velocity ratio of plastic unloading [-]


class ContactLaw(ABC):
    """Normal force of a contact point. It is never tensile.

    A contact point has `share` copies of the law. Forces, stiffness and damping are proportional to `share`.
    """

    @abstractmethod
    def numbers(self, mass: float) -> LawNumbers:
        """Return the numerical parameters of the law for a body.

        Parameters
        ----------
        mass : float
            Mass of the body [kg], which a damping ratio needs.

        Returns
        -------
        LawNumbers
            Stiffness, damping and other numbers in SI units.
        """


def force(law: LawNumbers, depth: FloatArray, speed: FloatArray, deepest: FloatArray) -> FloatArray:
    """Return the force of one copy of a law [N]."""
    # Kelvin-Voigt: ``F = max(0, k d + c d')``. Hunt-Crossley: ``F = k d^n max(0, 1 + chi d')``. Plastic unloading: ``F
    # = max(0, min(k d, k / e^2 (d - d_p)))`` with the set ``d_p = (1 - e^2) d_max``. The forces are zero for d <= 0.
    # See docs/theory/contact_bed.md, and Walton and Braun (1986) for the unloading branch.
    # depth: depths d of the points [m]
    # speed: rates d' of the depths, positive during loading [m/s]
    # deepest: largest depths up to now, for plastic unloading [m]
    # The result contains the forces on the body, upwards [N].
    pressed = np.maximum(depth, 0.0)
    if law.kind is LawKind.KELVIN_VOIGT:
        value = law.stiffness * depth + law.damping * speed  # Eq. 117
    elif law.kind is LawKind.HUNT_CROSSLEY:
        value = law.stiffness * pressed**law.exponent * (1.0 + law.viscosity * speed)  # Eq. 118
    else:
        value = law.stiffness * depth
        if law.rebound > 0.0:
            square = law.rebound**2
            unloading = law.stiffness / square * (depth - (1.0 - square) * deepest)  # Eq. 120
            value = np.where(depth < deepest, np.minimum(value, unloading), value)
        else:
            value = np.where((depth >= deepest) & (speed > 0.0), value, 0.0)
    return np.where(depth > 0.0, np.maximum(value, 0.0), 0.0)


def stored(law: LawNumbers, depth: FloatArray, deepest: FloatArray) -> FloatArray:
    """Return the elastic energy of one copy of a law [J]."""
    pressed = np.maximum(depth, 0.0)
    if law.kind is LawKind.PLASTIC:
        if law.rebound == 0.0:
            return np.zeros_like(pressed)
        value = force(law, depth, np.zeros_like(depth), np.maximum(deepest, depth))
        return np.asarray(0.5 * value**2 * law.rebound**2 / law.stiffness)  # Eq. 121
    return np.asarray(law.stiffness * pressed ** (law.exponent + 1.0) / (law.exponent + 1.0))  # Eq. 121


def depth_absorbing(law: LawNumbers, copies: float, energy: float, speed: float) -> float:
    """Return the depth at which a law absorbs an energy at constant speed [m]. It is the depth scale of an impact."""
    order = law.exponent + 1.0
    spring = float((order * energy / (copies * law.stiffness)) ** (1.0 / order)) if law.stiffness > 0.0 else math.inf
    return min(spring, energy / (copies * law.damping * speed)) if law.damping > 0.0 else spring


@dataclass(frozen=True)
class KelvinVoigt(ContactLaw):
    """Linear spring and dashpot: F = k d + c d' if this is above zero and d > 0, otherwise zero.

    Parameters
    ----------
    stiffness : float
        k of one copy of the law [N/m]; zero for a dashpot without spring.
    damping : float, optional
        c of one copy of the law [N s/m]. By default, c results from `damping_ratio`.
    damping_ratio : float, optional
        zeta [-], which gives c = 2 zeta sqrt(k m) with the mass m of the body.

    Raises
    ------
    InvalidValueError
        If a value is negative, if both damping parameters are given, or if the law has no force.

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
            raise InvalidValueError("use damping or damping_ratio, not both")
        if self.damping is not None:
            checks.within("damping", self.damping, 0.0, 1e18, unit="N s/m")
        if self.damping_ratio is not None:
            checks.within("damping_ratio", self.damping_ratio, 0.0, 1e6)
        if self.stiffness == 0.0 and not self.damping:
            raise InvalidValueError("stiffness must be > 0 N/m without a dashpot, got 0")

    @classmethod
    def from_layer(
        cls, modulus: float, area: float, thickness: float, *, damping_ratio: float = 0.0, confinement: float = 1.0
    ) -> Self:
        """Return the law of an elastic layer under the base: k = E_eff A / t (docs/theory/contact_bed.md).

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
            E_eff / E [-]. It is above 1 for a layer that cannot bulge sideways.

        Returns
        -------
        KelvinVoigt
            The law of the bed.

        Examples
        --------
        >>> KelvinVoigt.from_layer(2e9, area=0.05, thickness=0.01).stiffness
        10000000000.0
        """
        modulus = checks.positive("modulus", modulus, "Pa", hint="in Pa, not GPa")
        area = checks.positive("area", area, "m2")
        thickness = checks.length("thickness", thickness)
        return cls(  # Eq. 115
            checks.positive("confinement", confinement) * modulus * area / thickness, damping_ratio=damping_ratio
        )

    def numbers(self, mass: float) -> LawNumbers:
        ratio = self.damping_ratio or 0.0
        damping = 2.0 * ratio * (self.stiffness * mass) ** 0.5 if self.damping is None else self.damping  # Eq. 116
        return LawNumbers(LawKind.KELVIN_VOIGT, float(self.stiffness), float(damping))


@dataclass(frozen=True)
class HuntCrossley(ContactLaw):
    """Power-law spring with damping proportional to the spring force: F = k d^n (1 + chi d').

    Hunt and Crossley 1975, J. Appl. Mech. 42:440.

    Parameters
    ----------
    stiffness : float
        k of one copy of the law [N/m^n].
    exponent : float
        n [-], which is 1.5 for round points.
    viscosity : float
        chi [s/m], about 3 (1 - e) / (2 v) for a velocity ratio e near 1 at the landing speed v.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
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
        checks.positive("modulus", self.modulus, "Pa", hint="in Pa, not GPa")
        checks.length("radius", self.radius)

    def numbers(self, mass: float) -> LawNumbers:
        return LawNumbers(LawKind.HUNT_CROSSLEY, 4.0 / 3.0 * self.modulus * self.radius**0.5, exponent=1.5)  # Eq. 119


@dataclass(frozen=True)
class PlasticUnloading(ContactLaw):
    """Linear loading and steeper unloading.

    The stiffness is k for first loading, and k / e^2 for unloading and reloading.

    A single point rebounds with the velocity ratio e. Every point has its own largest depth. With e = 0, there is no
    rebound (plastic Winkler bed of docs/theory/restitution.md). Use e = 0 only for impulsive impacts, because the
    contact chatters under a permanent load.

    Parameters
    ----------
    stiffness : float
        k of one copy of the law [N/m].
    rebound : float
        e, the ratio of velocities after and before for a single point [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    stiffness: float
    rebound: float = 0.1

    def __post_init__(self) -> None:
        checks.within("stiffness", self.stiffness, 0.0, 1e18, unit="N/m", open_low=True)
        checks.within("rebound", self.rebound, 0.0, 1.0)

    def numbers(self, mass: float) -> LawNumbers:
        return LawNumbers(LawKind.PLASTIC, float(self.stiffness), rebound=float(self.rebound))
