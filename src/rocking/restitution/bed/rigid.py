"""Rigid rocking on the points of a bed, and how deep it settles: what an emergent coefficient is measured against."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.portable import dot
from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.laws import LawNumbers, stored


@dataclass(frozen=True)
class RigidRocking:
    """The body on rigid points: pivot, potential and inertia at each rotation."""

    mass: float  # mass, inertia: mass [kg] and polar moment about the centre of mass [kg m2]
    inertia: float
    height: float  # height of the centre of mass over the base line [m]
    gravity: float  # vertical acceleration g + a_z [m/s2]
    bed: ContactBed  # points, profile and kinematics

    @classmethod
    def of_body(cls, body: Body, bed: ContactBed, gravity: float) -> "RigidRocking":
        moments = body.local_moments
        return cls(moments.mass, moments.polar, moments.y, gravity, bed)

    def pivot(self, rotation: float) -> int:
        """Return the point that touches at a rotation."""
        return int(np.argmax(self._lifts(rotation)))

    def lift(self, rotation: float) -> float:
        """Return how far the base centre is above the ground at a rotation [rad, m]."""
        return float(self._lifts(rotation).max())

    def _lifts(self, rotation: float) -> FloatArray:
        if self.bed.kinematics == "small":
            return np.asarray(self.bed.positions * rotation - self.bed.heights)
        return np.asarray(self.bed.positions * math.sin(rotation) - self.bed.heights * math.cos(rotation))

    def potential(self, rotation: float) -> float:
        """Return the potential energy above standing upright on the bed, m g (lift + h (cos theta - 1)) [J]."""
        fall = 2.0 * self.height * math.sin(0.5 * rotation) ** 2
        return self.mass * self.gravity * (self.lift(rotation) - self.lift(0.0) - fall)  # Eq. 126

    def inertia_about(self, point: int) -> float:
        """Return the inertia of rocking about a point, I_c + m (h^2 + s^2) [kg m2]."""
        return float(self.inertia + self.mass * (self.height**2 + self.bed.positions[point] ** 2))

    def support(self, rotation: float, velocity: float) -> float:
        """Return the force on the pivot while the body rocks."""
        point = self.pivot(rotation)
        s, h = float(self.bed.positions[point]), self.height
        small = self.bed.kinematics == "small"
        lever = s if small else s * math.cos(rotation) - h * math.sin(rotation)
        turning = self.mass * self.gravity * (h * math.sin(rotation) - s * (1.0 if small else math.cos(rotation)))
        spin = 0.0 if small else (s * math.sin(rotation) + h * math.cos(rotation)) * velocity**2
        return self.mass * (self.gravity + lever * turning / self.inertia_about(point) - spin)  # Eq. 127

    def furthest(self, side: float) -> float:
        """Return |theta| of greatest potential on a side, at most pi/4 of a squat body [rad]: beyond it, it topples."""
        reach = max(side * self.bed.ends[1 if side > 0 else 0], 0.0)
        angle = (
            math.asin(min(reach / self.height, 1.0))
            if self.bed.kinematics == "small"
            else math.atan2(reach, self.height)
        )
        return min(angle, 0.25 * math.pi)


def settlement(rigid: RigidRocking, law: LawNumbers, rotation: float, load: float) -> tuple[float, float]:
    """Return the static depth of the pivot below rigid rocking [m] and the elastic energy [J] under a load [N]."""
    bed, pivot = rigid.bed, rigid.pivot(rotation)
    tilt = rotation if bed.kinematics == "small" else math.sin(rotation)
    turned = 1.0 if bed.kinematics == "small" else math.cos(rotation)
    above = rigid.lift(rotation) - (bed.positions * tilt - bed.heights * turned)
    alone = max(load / float(bed.shares[pivot]), 0.0)
    depth = deepest = float((alone / law.stiffness) ** (1.0 / law.exponent)) if law.stiffness else 0.0
    shallow = np.delete(above, pivot).min() >= deepest
    # the load carried grows with the depth and curves upwards: Newton's method comes down from one foot alone
    for _ in range(0 if shallow else 60):
        pressed = np.maximum(depth - above, 0.0)
        slope = law.exponent * law.stiffness * pressed ** (law.exponent - 1.0)
        excess = dot(bed.shares, law.stiffness * pressed**law.exponent) - load  # Eq. 129
        down = excess / dot(bed.shares, np.where(pressed > 0.0, slope, 0.0))
        depth -= down
        if down <= 1e-15 * depth:
            break
    depths = np.maximum(depth - above, 0.0)
    return depth, dot(bed.shares, stored(law, depths, depths))
