"""Published code methods with their inputs; `LEFT_OUT` lists the methods without a readable source."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FEET, BoolArray, FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.components import leading
from rocking.motions.intensity import MEASURES, RockingScale, sampled
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import response_spectrum


@dataclass(frozen=True)
class BodySides:
    """Dimensions of bodies about their feet: one row per body, columns for the right and the left foot."""

    half_width: FloatArray  # horizontal distance b from the foot to the centre of mass [m]
    height: FloatArray  # height h of the centre of mass [m]
    frequency_parameter: FloatArray  # p [rad/s]
    gravity: float = g  # [m/s2]

    @classmethod
    def of(cls, bodies: Sequence[Body], gravity: float = g) -> "BodySides":
        """Return the dimensions of plane bodies at an acceleration of gravity [m/s2]."""
        for body in bodies:
            if not isinstance(body, Body):
                raise InvalidValueError(
                    "code methods need plane bodies, got {value}", parameter="body", value=body,
                    hint="Use in_plane(azimuth) of a solid.",
                )  # fmt: skip
        sides = [[body.side(foot, gravity) for foot in FEET[::-1]] for body in bodies]
        names = "half_width", "centre_height", "frequency_parameter"
        b, h, p = (np.array([[getattr(side, name) for side in pair] for pair in sides]) for name in names)
        return cls(b, h, p, gravity)

    @property
    def slope(self) -> FloatArray:
        """The ratio b / h, the tangent of the slenderness angle [-]."""
        return self.half_width / self.height

    @property
    def angle(self) -> FloatArray:
        """Slenderness angle [rad]."""
        return np.arctan(self.slope)

    @property
    def inertia(self) -> FloatArray:
        """Ratio of the moment of inertia about the foot to m h^2 [-]."""
        h, p = self.height, self.frequency_parameter
        return np.asarray(self.gravity * np.hypot(self.half_width, h) / (p * h) ** 2)

    @property
    def symmetric(self) -> BoolArray:
        """True for bodies with feet at equal distances from the centre of mass."""
        right, left = self.half_width.T
        return np.asarray(np.isclose(right, left, rtol=1e-9, atol=0.0))

    @property
    def rectangle(self) -> BoolArray:
        """True for bodies with the dynamics of a rectangle: symmetric, with 4/3 m R^2 about a foot."""
        has_inertia = np.isclose(self.inertia, 4.0 / 3.0 * (1.0 + self.slope**2), rtol=1e-6)
        return np.asarray(self.symmetric & has_inertia.all(axis=1))

    @property
    def uplift(self) -> FloatArray:
        """Horizontal acceleration that lifts a body about the foot [m/s2]."""
        return self.gravity * self.slope


@dataclass(frozen=True)
class Shaking:
    """Motions of the methods, with their peaks and spectra."""

    motions: tuple[GroundMotion, ...]

    @classmethod
    def of(cls, motions: Any) -> "Shaking":
        """Return the leading components of motions; pulses are sampled finely."""
        return cls(tuple(sampled(leading(motions[k])) for k in range(len(motions))))

    def _peaks(self, name: str) -> FloatArray:
        return MEASURES[name].values(self.motions, RockingScale())[:, None, None]

    @cached_property
    def acceleration(self) -> FloatArray:
        """PGA, of shape (motions, 1, 1) [m/s2]."""
        return self._peaks("pga")

    @cached_property
    def velocity(self) -> FloatArray:
        """PGV, of shape (motions, 1, 1) [m/s]."""
        return self._peaks("pgv")

    @cached_property
    def vertical(self) -> BoolArray:
        """True for motions with a vertical component, of shape (motions, 1)."""
        components = [getattr(motion, "vertical", None) for motion in self.motions]
        return np.array([[component is not None and bool(np.any(component))] for component in components])

    def uplift_demand(self, slope: FloatArray) -> FloatArray:
        """Return the largest value of |horizontal| - slope * vertical acceleration of each motion, by slope [m/s2].

        The vertical acceleration is positive upwards. Downward acceleration reduces the weight of the body.
        """
        demand = np.broadcast_to(self.acceleration, (len(self.motions), *slope.shape)).copy()
        for k in np.flatnonzero(self.vertical):
            horizontal, upward = np.abs(self.motions[k].acceleration), np.asarray(self.motions[k].vertical)
            demand[k] = (horizontal - slope[..., None] * upward).max(axis=-1)
        return demand

    def spectra(self, periods: FloatArray, damping: float) -> FloatArray:
        """Return pseudo-spectral accelerations of all motions [m/s2] at periods [s] and a damping ratio [-]."""
        return np.array([response_spectrum(motion, periods, damping).pseudo_acceleration for motion in self.motions])


class VerticalMotion(Enum):
    """Treatment of vertical motion by a code method; the value completes a sentence about the method."""

    CONSIDERED = "considers vertical motion"
    OWN_RULE = "considers vertical motion by its own rule"
    EXCLUDED = "excludes vertical motion from its domain"
    NOT_CONSIDERED = "does not consider vertical motion"


class CodeMethod(ABC):
    """Base of published overturning criteria, which need no history.

    Class attributes contain the source and the reliability of the reading. An unsymmetric body is checked on both
    sides, and the worse side decides.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    reference: ClassVar[str]  # source with clause or equation
    domain: ClassVar[str]
    reading: ClassVar[str]  # reliability of the source as it was read: original text, secondary source or example
    example: ClassVar[str] = "none of the source was available"  # example for a comparison with the source
    vertical: ClassVar[VerticalMotion] = VerticalMotion.NOT_CONSIDERED
    vertical_rule: ClassVar[str] = ""  # rule of vertical motion, or reason of its exclusion

    @property
    def vertical_motion(self) -> str:
        """Treatment of vertical motion with its rule, as continuation of the name of the method."""
        return ": ".join(filter(None, (self.vertical.value, self.vertical_rule)))

    @abstractmethod
    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Return the scale factor of every motion at the limit; the shape broadcasts to (motions, bodies, 2) [-]."""

    def exclusions(self, sides: BodySides, shaking: Shaking) -> dict[str, BoolArray]:
        """Return flags of excluded bodies and motions by reason; the shape broadcasts to (motions, bodies)."""
        return {}

    def holds(self, sides: BodySides, shaking: Shaking) -> BoolArray:
        """Return True for motions and bodies in the domain, of shape (motions, bodies)."""
        excluded = np.zeros((len(shaking.motions), len(sides.slope)), dtype=np.bool_)
        for flags in self.exclusions(sides, shaking).values():
            excluded |= flags
        return ~excluded

    def outside(self, sides: BodySides, shaking: Shaking) -> str:
        """Return the reasons for bodies or motions outside the domain as text; empty if all are in the domain."""
        return ", ".join(reason for reason, flags in self.exclusions(sides, shaking).items() if np.any(flags))

    def capacity(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Return the limit factor of every motion for the worse side of a body [-]; NaN outside the domain."""
        shape = (len(shaking.motions), *sides.slope.shape)
        worse = np.broadcast_to(self.of_sides(sides, shaking), shape).min(axis=2)
        return np.where(self.holds(sides, shaking), worse, np.nan)


class StaticOverturning(CodeMethod):
    """West's criterion: an acceleration that lifts a body for long enough overturns it."""

    name = "static"
    title = "static overturning (West)"
    reference = "West's criterion, a = g b/h: equilibrium of moments about the foot"
    domain = "any body; the limit is uplift, so it is safe for every motion"
    vertical = VerticalMotion.CONSIDERED
    vertical_rule = "the vertical acceleration changes the weight at each sample"
    reading = "certain: it is the equilibrium of moments about the foot"
    example = "closed form: the acceleration of uplift"

    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Eq. 329, which is Eq. 294 without vertical motion."""
        demand = shaking.uplift_demand(sides.slope)
        with np.errstate(divide="ignore"):
            return np.asarray(sides.uplift / np.maximum(demand, 0.0))  # Eq. 329


class AsceComponents(CodeMethod):
    """ASCE/SEI 7-22, chapter 13: overturning of a nonstructural component on the ground, strength level."""

    name = "asce-7-strength"
    title = "ASCE/SEI 7-22 chapter 13, strength level"
    reference = "ASCE/SEI 7-22, Eqs. 13.3-1 to 13.3-3 with combination 7 of 2.3.6: F_p against (0.9 - 0.2 S_DS) D"
    domain = (
        "body on the ground (H_f = R_mu = 1), I_p = 1, C_AR / R_po = 1, since an unanchored body has no overstrength; "
        "that the PGA of the motion is 0.4 S_DS is our choice; chapter 13 requires that components are anchored"
    )
    reading = (
        "medium: the standard itself was not read; Eq. 13.3-1 and its limits are those of public design aids of the "
        "2022 edition, the load combinations those of aids of the editions of 2005 and 2016"
    )
    vertical = VerticalMotion.OWN_RULE
    vertical_rule = "E_v = 0.2 S_DS D upwards, whatever the vertical motion is"
    demand: ClassVar[float] = 1.0  # factor on F_p [-]
    dead: ClassVar[float] = 0.9  # factor on the weight [-]

    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Eq. 330."""
        relief = self.demand * 0.2 * 2.5 * sides.slope  # S_DS = 2.5 PGA / g
        return self.dead * sides.uplift / ((self.demand + relief) * shaking.acceleration)  # Eq. 330


class AsceComponentsAllowable(AsceComponents):
    """ASCE/SEI 7-22, chapter 13, with the combinations of allowable stress design."""

    name = "asce-7-allowable"
    title = "ASCE/SEI 7-22 chapter 13, allowable stress"
    reference = "ASCE/SEI 7-22, Eqs. 13.3-1 to 13.3-3 with combination 10 of 2.4.5: 0.7 F_p against (0.6 - 0.14 S_DS) D"
    demand = 0.7
    dead = 0.6


class ItalianLinearKinematic(CodeMethod):
    """Italian linear kinematic check of a free-standing body on the ground, with q = 2."""

    name = "italian-linear"
    title = "Italian linear kinematic check, q = 2"
    reference = "NTC 2008, Circ. 617/2009 C8A.4; NTC 2018, Circ. 7/2019 C8.7.1.2: a0* = alpha0 g / (e* CF) >= a_g S / q"
    domain = (
        "rigid body on the ground, no filter by a storey; e* = 1 (one body), CF = 1; a_g S is the PGA of the motion"
    )
    reading = "high: clause and formula as in secondary sources; the text of the circular itself was not consulted"
    behaviour_factor = 2.0  # q [-]

    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Eq. 295."""
        return self.behaviour_factor * sides.uplift / shaking.acceleration  # Eq. 295


class AsceRocking(CodeMethod):
    """Energy method of ASCE/SEI 43: a linear oscillator of the frequency and damping that belong to a rotation."""

    name = "asce-43"
    title = "ASCE/SEI 43 rocking, energy method"
    reference = (
        "ASCE/SEI 43-05, A.2, approximate method for rocking of an unanchored rigid body, Eq. A-5; 43-19 likewise"
    )
    domain = (
        "symmetric body of one mass (F_H = 1), no vertical motion (F_V = 1), C_R > 0; safe if at the angle alpha the "
        "capacity is no less than the demand, without the standard's factors of safety"
    )
    reading = (
        "low: structure and symbols from the head of A.2, equations derived here from the energy of the body; margins "
        "were not read, nor the choice between several balanced rotations: the largest here, as in A.1 for sliding "
        "(lowest frequency); with any rotation up to alpha, limits would be up to several times as high"
    )
    example = "closed form: C_R of a rectangle is Housner's coefficient"
    vertical = VerticalMotion.EXCLUDED
    vertical_rule = "F_V = 1 as read"

    def exclusions(self, sides: BodySides, shaking: Shaking) -> dict[str, BoolArray]:
        """Unequal sides, vertical motion, and impacts without a coefficient."""
        stops = np.asarray((self.restitution(sides) <= 0.0).any(axis=1))
        return {"unequal sides": ~sides.symmetric, "vertical motion": shaking.vertical, "C_R not above 0": stops}

    @staticmethod
    def restitution(sides: BodySides) -> FloatArray:
        """Return C_R of every side [-]."""
        a = sides.slope
        return 1.0 - 2.0 * a**2 / sides.inertia  # Eq. 296

    def damping(self, sides: BodySides) -> FloatArray:
        """Return beta_e of every side; NaN where C_R is not above zero [-]."""
        r = self.restitution(sides)
        gamma = -2.0 * np.log(np.where(r > 0.0, r, np.nan))
        return np.asarray(gamma / np.hypot(2.0 * math.pi, gamma))  # Eq. 297

    @staticmethod
    def oscillator(sides: BodySides, rotation: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return period [s] and capacity [m/s2] at a rotation of every side [rad]."""
        a, h = sides.slope, sides.height
        half = 0.5 * rotation
        f1 = 2.0 * np.sin(half) * (a * np.cos(half) - np.sin(half))  # cos + a sin - 1 in a form without cancellation
        work = 2.0 * sides.gravity * f1
        period = 2.0 * math.pi * rotation * np.sqrt(sides.inertia * h / work)  # Eq. 298
        return period, work / rotation  # Eq. 299

    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Eqs. 296 to 299, at the rotation that overturns."""
        beta, (period, capacity) = self.damping(sides), self.oscillator(sides, sides.angle)
        factors = np.full((len(shaking.motions), *beta.shape), np.nan)
        dampings = np.round(beta, 12)  # sides with equal damping share spectra
        for value in np.unique(dampings[np.isfinite(dampings)]):
            selected = dampings == value
            periods, inverse = np.unique(period[selected], return_inverse=True)
            factors[:, selected] = capacity[selected] / shaking.spectra(periods, float(value))[:, inverse.ravel()]
        return factors


class IshiyamaCriteria(CodeMethod):
    """Ishiyama: overturning needs both the acceleration of uplift and a velocity."""

    name = "ishiyama"
    title = "Ishiyama's criteria, acceleration and velocity"
    reference = "Ishiyama 1982, Criteria for overturning of rigid bodies by sinusoidal and earthquake excitations"
    domain = (
        "lower limits: a body below one of both does not overturn; the factor 0.4 is for rectangles on a rigid floor"
    )
    reading = (
        "medium: the summary of the paper states criteria of velocity and acceleration; the formula is from "
        "secondary sources, and both of its forms (with R, and 10 B / sqrt(H) in cm) agree within 2.5 %"
    )
    velocity_ratio = 0.4  # limit over the overturning velocity of a single impulse [-]

    def velocity(self, sides: BodySides) -> FloatArray:
        """Return the limit of the ground velocity without overturning, by side [m/s]."""
        alpha, p = sides.angle, sides.frequency_parameter
        impulse = 2.0 * np.sin(0.5 * alpha) * sides.gravity / (p * np.cos(alpha))
        return np.asarray(self.velocity_ratio * impulse)  # Eq. 300

    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Eq. 300; overturning exceeds both limits."""
        uplift_factor = sides.uplift / shaking.acceleration  # Eq. 294
        return np.maximum(uplift_factor, self.velocity(sides) / shaking.velocity)


class KanekoHayashi(CodeMethod):
    """Kaneko and Hayashi: the floor acceleration at which half of the bodies overturn."""

    name = "kaneko-hayashi"
    title = "Kaneko and Hayashi's A_R50"
    reference = "Kaneko & Hayashi, overturning ratio of furniture: A_R50 and f_b"
    domain = "rectangles, furniture on floors; half of the bodies overturn at its limit by its own account"
    reading = (
        "medium: from secondary sources, in cm and s; the original text was not consulted, nor its frequency "
        "PGA / (2 pi PGV); f_b is taken where both branches meet, 15.61 for its 15.6"
    )

    def exclusions(self, sides: BodySides, shaking: Shaking) -> dict[str, BoolArray]:
        """All bodies except rectangles."""
        return {"not a rectangle": ~sides.rectangle}

    @staticmethod
    def acceleration(sides: BodySides, frequency: FloatArray) -> FloatArray:
        """Return A_R50 of every side [m/s2] at a frequency of the floor motion [Hz]. In m and s, its factor 10 is 1."""
        ratio = sides.slope
        width, height = 2.0 * sides.half_width, 2.0 * sides.height
        slow = sides.gravity * ratio * (1.0 + ratio)
        quick = width / np.sqrt(height) * (1.0 + ratio) ** 2.5 * 2.0 * math.pi * frequency
        return np.maximum(slow, quick)  # Eq. 301

    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Eq. 301; scaling does not change the frequency of a motion."""
        frequency = shaking.acceleration / (2.0 * math.pi * shaking.velocity)
        return self.acceleration(sides, frequency) / shaking.acceleration


class HousnerPulse(CodeMethod):
    """Housner's rectangular pulse of constant acceleration, with duration PGV / PGA."""

    name = "housner-pulse"
    title = "Housner's rectangular pulse"
    reference = "Housner 1963, Bull. Seismol. Soc. Am. 53(2) 403-417, constant acceleration of duration t1"
    domain = (
        "slender bodies (alpha up to 20 degrees on the weaker side), linearised; the duration PGV / PGA is ours, not "
        "Housner's"
    )
    reading = "certain for the pulse: it follows from the linear equation of motion"
    example = "our own engine under the pulse (tests), in the limit of slender bodies"

    widest = math.radians(20.0)  # alpha [rad]

    def exclusions(self, sides: BodySides, shaking: Shaking) -> dict[str, BoolArray]:
        """Slenderness angles above 20 degrees on the weaker side."""
        return {"slenderness angle above 20 degrees": np.asarray(sides.angle.min(axis=1) > self.widest)}

    @staticmethod
    def acceleration(sides: BodySides, duration: FloatArray) -> FloatArray:
        """Return the overturning acceleration of a pulse of given duration [s], by side [m/s2]."""
        ratio = 0.5 * (1.0 + 1.0 / np.tanh(0.5 * sides.frequency_parameter * duration))
        return np.asarray(ratio * sides.gravity * sides.angle)  # Eq. 302

    def of_sides(self, sides: BodySides, shaking: Shaking) -> FloatArray:
        """Eq. 302; scaling does not change the duration of a motion."""
        return self.acceleration(sides, shaking.velocity / shaking.acceleration) / shaking.acceleration


CODE_METHODS: dict[str, CodeMethod] = {
    method.name: method
    for method in (
        StaticOverturning(), ItalianLinearKinematic(), AsceRocking(), IshiyamaCriteria(), KanekoHayashi(),
        HousnerPulse(), AsceComponents(), AsceComponentsAllowable(),
    )
}  # fmt: skip
"""Every method, by name."""

LEFT_OUT = {
    "Reggiani Manzo and Vassiliou's size-independent estimate": "only the summary of the paper could be read",
    "Housner's equal-velocity spectrum, half of the bodies overturn": "the equation could not be read at its source",
    "Italian non-linear kinematic check": "the text of neither edition could be read",
    "NZSEE C8, displacement method for face loads": "its text could not be read",
    "margins of ASCE/SEI 43 over its best estimate": "the clauses could not be read",
}
"""Methods without a readable source, with the reasons for their exclusion."""
