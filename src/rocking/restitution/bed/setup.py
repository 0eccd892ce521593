"""Setup of an impact for both engines, and rigid rocking on the points of a bed as a reference."""

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.bodies.frame import refuse_frame
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.portable import dot
from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.laws import LawKind, LawNumbers, depth_absorbing, stored


@dataclass(frozen=True)
class RigidRocking:
    """Body on rigid points: pivot, potential and inertia as functions of the rotation."""

    mass: float  # mass, inertia: mass [kg] and polar moment about the centre of mass [kg m2]
    inertia: float
    height: float  # height of the centre of mass over the base line [m]
    gravity: float  # vertical acceleration g + a_z [m/s2]
    bed: ContactBed  # points, profile and kinematics

    @classmethod
    def of_body(cls, body: Body, bed: ContactBed, gravity: float) -> "RigidRocking":
        refuse_frame(body)
        moments = body.local_moments
        return cls(moments.mass, moments.polar, moments.y, gravity, bed)

    def pivot(self, rotation: float) -> int:
        """Return the index of the point in contact at a rotation [rad]."""
        return int(np.argmax(self._lifts(rotation)))

    def lift(self, rotation: float) -> float:
        """Return the height of the base centre above the ground [m] at a rotation [rad]."""
        return float(self._lifts(rotation).max())

    def _lifts(self, rotation: float) -> FloatArray:
        if self.bed.kinematics == "small":
            return np.asarray(self.bed.positions * rotation - self.bed.heights)
        return np.asarray(self.bed.positions * math.sin(rotation) - self.bed.heights * math.cos(rotation))

    def potential(self, rotation: float) -> float:
        """Return the potential energy relative to the body at rest on the bed, m g (lift + h (cos theta - 1)) [J]."""
        fall = 2.0 * self.height * math.sin(0.5 * rotation) ** 2
        return self.mass * self.gravity * (self.lift(rotation) - self.lift(0.0) - fall)  # Eq. 126

    def inertia_about(self, point: int) -> float:
        """Return the inertia of rocking about a point, I_c + m (h^2 + s^2) [kg m2]."""
        return float(self.inertia + self.mass * (self.height**2 + self.bed.positions[point] ** 2))

    def support(self, rotation: float, velocity: float) -> float:
        """Return the force on the pivot during rocking [N]."""
        point = self.pivot(rotation)
        s, h = float(self.bed.positions[point]), self.height
        small = self.bed.kinematics == "small"
        lever = s if small else s * math.cos(rotation) - h * math.sin(rotation)
        turning = self.mass * self.gravity * (h * math.sin(rotation) - s * (1.0 if small else math.cos(rotation)))
        spin = 0.0 if small else (s * math.sin(rotation) + h * math.cos(rotation)) * velocity**2
        return self.mass * (self.gravity + lever * turning / self.inertia_about(point) - spin)  # Eq. 127

    def furthest(self, side: float) -> float:
        """Return |theta| of the largest potential on a side, at most pi/4 [rad].

        Beyond this rotation, the body overturns.
        """
        reach = max(side * self.bed.ends[1 if side > 0 else 0], 0.0)
        angle = (
            math.asin(min(reach / self.height, 1.0))
            if self.bed.kinematics == "small"
            else math.atan2(reach, self.height)
        )
        return min(angle, 0.25 * math.pi)


def settlement(rigid: RigidRocking, law: LawNumbers, rotation: float, load: float) -> tuple[float, float]:
    """Return the static depth of the pivot below rigid rocking [m], and the elastic energy [J], under a load [N]."""
    bed, pivot = rigid.bed, rigid.pivot(rotation)
    tilt = rotation if bed.kinematics == "small" else math.sin(rotation)
    turned = 1.0 if bed.kinematics == "small" else math.cos(rotation)
    above = rigid.lift(rotation) - (bed.positions * tilt - bed.heights * turned)
    alone = max(load / float(bed.shares[pivot]), 0.0)
    depth = deepest = float((alone / law.stiffness) ** (1.0 / law.exponent)) if law.stiffness else 0.0
    shallow = np.delete(above, pivot).min() >= deepest
    # the load is a convex increasing function of depth, so that Newton's method converges from above, from one foot
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


END_AT_PEAK, END_AT_PARTING = 0, 1

RESULTS: Final = (
    "y", "rotation", "u", "w", "angular_velocity", "time", "travel", "bed_loss", "friction_loss", "energy_start",
    "energy_end", "stored", "residual", "peak_force", "deepest", "touch", "parting", "impulse", "impulse_moment",
    "shear_impulse", "slid",
)  # fmt: skip
"""Columns of the results of an impact."""

COUNTS: Final = ("status", "steps", "rejected", "switches", "contacts", "forced")  # integer columns

SAMPLES: Final = (
    "time", "travel", "normal", "shear", "moment", "bed_loss", "friction_loss", "y", "rotation", "u", "w",
    "angular_velocity",
)  # fmt: skip
"""Columns of the history of an impact."""


Results = dict[str, Any]  # numbers or columns by the names in `RESULTS` and `COUNTS`

Run = tuple[Results, dict[str, FloatArray], FloatArray, FloatArray]
"""Results of one impact, columns of `SAMPLES`, forces of the points, and intervals of contact."""


def named(results: FloatArray, counts: IntArray) -> Results:
    """Return the results of one impact, or of many, by name."""
    values = [*results.T, *counts.T] if results.ndim > 1 else [*results.tolist(), *counts.tolist()]
    return dict(zip(RESULTS + COUNTS, values, strict=True))


@dataclass(frozen=True)
class Setup:
    """Setup of one impact for the engines."""

    rigid: RigidRocking  # body and bed
    law: LawNumbers  # contact law under this body
    # initial state: height y of the base centre [m], rotation [rad], velocities u, w along and across the base [m/s],
    # rotation rate [rad/s]
    state: tuple[float, float, float, float, float]
    landing_velocity: float  # theta_dot of rigid rocking on the old foot at theta = 0 [rad/s]
    energy: float  # kinetic energy of rigid rocking at theta = 0 [J]
    # scales of the impact: depth of the bed [m], speed of the new foot [m/s], half the length of the bed [m]
    depth: float
    speed: float
    half_base: float
    old_foot: int  # indices of the points in contact before and after the impact
    new_foot: int
    impulsive: bool  # True for an impact without gravity
    push: float  # horizontal ground acceleration [m/s2]
    tolerance: float  # relative error of a step [-]
    longest: float  # time limit of the computation [s]

    @property
    def gravity(self) -> float:
        """Vertical acceleration during the impact [m/s2]."""
        return 0.0 if self.impulsive else self.rigid.gravity

    @property
    def end(self) -> int:
        """End of the impact: a peak or the end of contact."""
        return END_AT_PARTING if self.impulsive else END_AT_PEAK

    @property
    def farthest(self) -> float:
        """Rotation beyond which the body overturns [rad]."""
        return max(self.rigid.furthest(1.0), self.rigid.furthest(-1.0)) * (1.0 + 1e-9)


def setup_of(
    body: Body,
    bed: ContactBed,
    *,
    rotation: float | None = None,
    angular_velocity: float | None = None,
    impulsive: bool = False,
    ground_acceleration: tuple[float, float] = (0.0, 0.0),
    tolerance: float = 1e-9,
    gravity: float = conventions.g,
) -> Setup:
    """Return the setup of an impact after checks. The parameters are those of `bed_impact`.

    Parameters
    ----------
    body : Body
        The body.
    bed : ContactBed
        Bed of the body.
    rotation, angular_velocity : float, optional
        Either the initial rotation [rad] or the angular velocity at landing [rad/s].
    impulsive : bool
        True for an impact without gravity.
    ground_acceleration : (float, float)
        Horizontal and vertical acceleration [m/s2].
    tolerance : float
        Relative error of a step [-].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    Setup
        The impact.

    Raises
    ------
    InvalidValueError
        If a value is outside its range or the law cannot carry the body.
    """
    arguments: tuple[object, object] = (body, bed)
    if not (isinstance(arguments[0], Body) and isinstance(arguments[1], ContactBed)):
        raise InvalidValueError(
            "body and bed must be a Body and a ContactBed, got {body} and {bed}", body=f"{body!r:.40}",
            bed=f"{bed!r:.40}",
        )  # fmt: skip
    push, lift = _accelerations(ground_acceleration)
    total = checks.positive("gravity", gravity, "m/s2") + lift
    total = checks.positive("gravity + vertical ground acceleration", total, "m/s2", hint="the body floats")
    tolerance = checks.within("tolerance", tolerance, 1e-13, 1e-3)
    law = bed.law.numbers(body.mass)
    if not impulsive and (law.stiffness == 0.0 or (law.kind is LawKind.PLASTIC and law.rebound == 0.0)):
        raise InvalidValueError(
            "a law without stiffness or without rebound cannot carry the weight; "
            "use impulsive=True, or stiffness and rebound > 0"
        )
    rigid = RigidRocking.of_body(body, bed, total)
    angle, landing = _release(rigid, rotation, angular_velocity)
    old = rigid.pivot(-1e-9 if impulsive else angle)
    new = rigid.pivot(1e-9 if impulsive else min(0.5 * rigid.furthest(1.0), -angle))
    inertia = rigid.inertia_about(old)
    energy = 0.5 * inertia * landing**2
    if impulsive:
        state = (rigid.lift(0.0), 0.0, 0.0, float(bed.positions[old]) * landing, landing)
    else:
        state = _on_the_old_foot(rigid, law, old, angle, landing)
    reach = bed.ends[1] - bed.ends[0]
    speed = landing * reach
    depth = min(depth_absorbing(law, float(np.sum(bed.shares)), energy, speed), reach)
    longest = 30.0 * (inertia / (rigid.mass * total * rigid.height)) ** 0.5
    if impulsive:
        longest = min(longest, 1e6 * depth / speed)
    return Setup(
        rigid, law, state, landing, energy, depth, speed, 0.5 * reach, old, new, impulsive, push, tolerance, longest
    )


def _accelerations(values: object) -> tuple[float, float]:
    if not isinstance(values, (tuple, list, np.ndarray)) or np.shape(values) != (2,):
        raise InvalidValueError(
            parameter="ground_acceleration", allowed="two finite numbers, horizontal and vertical [m/s2]", value=values,
            hint="for horizontal acceleration only, use (value, 0.0)",
        )  # fmt: skip
    return (
        checks.number("horizontal ground acceleration", values[0], "m/s2"),
        checks.number("vertical ground acceleration", values[1], "m/s2"),
    )


def _release(rigid: RigidRocking, rotation: float | None, angular_velocity: float | None) -> tuple[float, float]:
    """Return the initial rotation [rad] and the landing velocity [rad/s], of which one is given."""
    # the start has the energy of the requested velocity; it is at rest if half the range of rotations is sufficient
    if (rotation is None) == (angular_velocity is None):
        raise InvalidValueError("use rotation or angular_velocity, exactly one of them")
    if len(rigid.bed.positions) < 2 or not rigid.bed.ends[0] < 0.0 < rigid.bed.ends[1]:
        raise InvalidValueError("the bed must extend to both sides of the plumb line of the centre of mass")
    limit = rigid.furthest(-1.0)
    if rotation is None:
        landing = checks.positive("angular_velocity", angular_velocity, "rad/s")
        return _angle_of(rigid, landing, 0.5 * limit), landing
    angle = -checks.within("rotation", rotation, 0.0, limit, unit="rad", open_low=True, open_high=True)
    landing = math.sqrt(2.0 * max(rigid.potential(angle), 0.0) / rigid.inertia_about(rigid.pivot(angle)))
    if landing == 0.0:
        raise InvalidValueError(
            "{parameter} {value} rad does not lift the centre of mass", parameter="rotation", value=-angle,
            hint="check for a rounded base",
        )  # fmt: skip
    return angle, landing


def _angle_of(rigid: RigidRocking, landing: float, limit: float) -> float:
    """Return the initial rotation for a landing velocity [rad], not above a limit."""

    def missing(angle: float) -> float:
        return 0.5 * rigid.inertia_about(rigid.pivot(angle)) * landing**2 - rigid.potential(angle)

    if rigid.gravity == 0.0 or missing(-limit) >= 0.0:
        return -limit
    low, high = 0.0, limit
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if missing(-middle) > 0.0 else (low, middle)
    return -high


def _on_the_old_foot(
    rigid: RigidRocking, law: LawNumbers, old: int, angle: float, landing: float
) -> tuple[float, float, float, float, float]:
    """Return the state of rigid rocking at an angle. The old foot is at its static depth in the bed."""
    inertia, bed = rigid.inertia_about(old), rigid.bed
    energy = max(0.5 * inertia * landing**2 - rigid.potential(angle), 0.0)
    turning = math.sqrt(2.0 * energy / inertia) if energy > 1e-12 * inertia * landing**2 else 0.0
    load = max(rigid.support(angle, turning), 0.0)
    y = rigid.lift(angle) - settlement(rigid, law, angle, load)[0]
    # the body rotates about the point, so that the velocity of the point vanishes in body axes
    along = -float(bed.heights[old]) * turning if bed.kinematics == "exact" else 0.0
    return (y, angle, along, float(bed.positions[old]) * turning, turning)
