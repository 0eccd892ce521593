"""Elongation of a restraint as a function of the rotation about a pivot, exact or linear."""

import math
from dataclasses import dataclass

from rocking.bodies import Body
from rocking.bodies.restraints import COINCIDENT, Restraint, Wall


@dataclass(frozen=True, slots=True)
class Lever:
    """Distance L of two points after a rotation theta about a pivot.

    L^2 = L0^2 + 4 s (B s - C c), with s and c the sine and cosine of theta / 2. An infinite L0 means a fixed
    direction parallel to the floor; B and C are then divided by L0.
    """

    side: int  # pivot: 1 right, -1 left
    length: float  # L0 [m]
    along: float  # B = a . d [m2]; a, d: ground point and point of the body from the pivot
    across: float  # C = a_x d_z - a_z d_x [m2]
    is_linear: bool = False

    @classmethod
    def of(cls, restraint: Restraint, body: Body, side: int, *, linear: bool) -> "Lever":
        """Return the lever of a restraint about a foot."""
        (ground_x, ground_z), (point_x, point_z) = restraint.ends
        foot = body.feet[side > 0]
        a_x, a_z, d_x, d_z = ground_x - foot, ground_z, point_x - foot, point_z
        if isinstance(restraint, Wall):
            return cls(side, math.inf, -restraint.sign * d_x, -restraint.sign * d_z, linear)
        size = max(abs(value) for value in (a_x, a_z, d_x, d_z, 1e-300))
        length = math.hypot(a_x - d_x, a_z - d_z)
        if length <= COINCIDENT * size:  # coincident points have no direction; use the direction at half the angle
            return cls(side, 0.0, d_x * d_x + d_z * d_z, 0.0, linear)
        return cls(side, length, a_x * d_x + a_z * d_z, a_x * d_z - a_z * d_x, linear)

    @property
    def is_parallel(self) -> bool:
        """True for a fixed direction parallel to the floor."""
        return self.length == math.inf

    @property
    def radius(self) -> float:
        """Signed distance D of coincident points from the pivot [m]."""
        return self.side * math.sqrt(self.along)

    @property
    def at_rest(self) -> float:
        """Slope de/dtheta at zero rotation [m]."""
        if self.is_parallel:
            return -self.across
        return -self.across / self.length if self.length else self.radius

    def row(self) -> tuple[float, float, float]:
        """Return the constants for the compiled engine."""
        return self.length, self.along, self.across

    def elongation(self, rotation: float) -> float:
        """Return e [m]."""
        if self.is_linear:
            return self.at_rest * rotation
        sine, cosine = math.sin(0.5 * rotation), math.cos(0.5 * rotation)
        if not self.length:
            return 2.0 * self.radius * sine  # Eq. 344
        change = 4.0 * sine * (self.along * sine - self.across * cosine)
        if self.is_parallel:
            return 0.5 * change  # Eq. 364
        return change / (self.length + math.sqrt(self.length**2 + change))  # Eq. 343

    def slope(self, rotation: float) -> float:
        """Return de/dtheta [m]."""
        if self.is_linear:
            return self.at_rest
        if not self.length:
            return self.radius * math.cos(0.5 * rotation)
        along = self.along * math.sin(rotation) - self.across * math.cos(rotation)
        return along if self.is_parallel else along / (self.length + self.elongation(rotation))  # Eq. 345
