"""An impact as both engines take it: how it begins, on the old foot, and the columns of its results."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.errors import InvalidValueError
from rocking.restitution.bed.contact_bed import ContactBed
from rocking.restitution.bed.laws import LawKind, LawNumbers, depth_absorbing
from rocking.restitution.bed.rigid import RigidRocking, settlement


@dataclass(frozen=True)
class ImpactStart:
    """State of the body when the computation begins, and the scales of the impact."""

    # base centre height y [m], rotation [rad], velocities u, w along and across the base [m/s], rotation rate [rad/s]
    state: tuple[float, float, float, float, float]
    landing_velocity: float  # theta_dot of rigid rocking on the old foot as it reaches theta = 0 [rad/s]
    energy: float  # kinetic energy of that rocking [J]
    # depth, speed, half_base: scales of the impact: depth of the bed [m], speed of the new foot [m/s], half the bed's
    # length [m]
    depth: float
    speed: float
    half_base: float
    old_foot: int  # old_foot, new_foot: points that carry the body before and after
    new_foot: int
    impulsive: bool  # whether gravity is left out


END_AT_PEAK, END_AT_PARTING = 0, 1

RESULTS: Final = (
    "y", "rotation", "u", "w", "angular_velocity", "time", "travel", "bed_loss", "friction_loss", "energy_start",
    "energy_end", "stored", "residual", "peak_force", "deepest", "touch", "parting", "impulse", "impulse_moment",
    "shear_impulse", "slid",
)  # fmt: skip
"""Columns of the results of an impact."""

COUNTS: Final = ("status", "steps", "rejected", "switches", "contacts", "forced")
"""Columns of its whole numbers."""

SAMPLES: Final = (
    "time", "travel", "normal", "shear", "moment", "bed_loss", "friction_loss", "y", "rotation", "u", "w",
    "angular_velocity",
)  # fmt: skip
"""Columns of its history."""


@dataclass(frozen=True)
class Setup:
    """One impact, ready to be computed."""

    rigid: RigidRocking  # body and bed
    law: LawNumbers  # contact law under this body
    start: ImpactStart  # initial state and scales
    push: float  # horizontal ground acceleration [m/s2]
    tolerance: float  # relative error of a step [-]
    longest: float  # time after which the computation ends [s]

    @property
    def gravity(self) -> float:
        """Vertical acceleration that acts during the impact [m/s2]."""
        return 0.0 if self.start.impulsive else self.rigid.gravity

    @property
    def end(self) -> int:
        """Where the impact ends."""
        return END_AT_PARTING if self.start.impulsive else END_AT_PEAK

    @property
    def farthest(self) -> float:
        """Rotation that ends the computation: the body topples [rad]."""
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
    """Return an impact, checked and ready to be computed; parameters as in `bed_impact`.

    Parameters
    ----------
    body : Body
        The body.
    bed : ContactBed
        Its bed.
    rotation, angular_velocity : float, optional
        One of the two [rad], [rad/s].
    impulsive : bool
        Whether gravity is left out.
    ground_acceleration : (float, float)
        Horizontal and vertical [m/s2].
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
    given: tuple[object, object] = (body, bed)
    if not (isinstance(given[0], Body) and isinstance(given[1], ContactBed)):
        raise InvalidValueError(f"body and bed must be a Body and a ContactBed, got {body!r:.40} and {bed!r:.40}")
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
    start = _start(rigid, law, rotation=rotation, angular_velocity=angular_velocity, impulsive=impulsive)
    longest = 30.0 * (rigid.inertia_about(start.old_foot) / (rigid.mass * total * rigid.height)) ** 0.5
    if impulsive:
        longest = min(longest, 1e6 * start.depth / start.speed)
    return Setup(rigid, law, start, push, tolerance, longest)


def _accelerations(given: object) -> tuple[float, float]:
    if not isinstance(given, (tuple, list, np.ndarray)) or np.shape(given) != (2,):
        raise InvalidValueError(
            f"ground_acceleration must be two finite numbers, horizontal and vertical [m/s2], got {given!r:.60}; "
            "for a horizontal one alone give (value, 0.0)"
        )
    return (
        checks.number("horizontal ground acceleration", given[0], "m/s2"),
        checks.number("vertical ground acceleration", given[1], "m/s2"),
    )


def _start(
    rigid: RigidRocking,
    law: LawNumbers,
    *,
    rotation: float | None = None,
    angular_velocity: float | None = None,
    impulsive: bool = False,
) -> ImpactStart:
    """Return the start of an impact.

    With gravity the body starts as high as it must to land with the velocity asked for, at rest if half its range of
    rotations is enough, its old foot as deep in the bed as the support force asks. An impulsive impact starts flat.

    rotation: rotation about the old foot at which the body is let go [rad]; angular_velocity: theta_dot at which it
    lands [rad/s].
    """
    if (rotation is None) == (angular_velocity is None):
        raise InvalidValueError("give rotation or angular_velocity, one of them: each follows from the other")
    if len(rigid.bed.positions) < 2 or not rigid.bed.ends[0] < 0.0 < rigid.bed.ends[1]:
        raise InvalidValueError("the bed must reach to both sides of the plumb line of the centre of mass")
    limit = rigid.furthest(-1.0)
    if rotation is not None:
        angle = -checks.within("rotation", rotation, 0.0, limit, unit="rad", open_low=True, open_high=True)
        inertia = rigid.inertia_about(rigid.pivot(angle))
        landing = math.sqrt(2.0 * max(rigid.potential(angle), 0.0) / inertia)
        if landing == 0.0:
            raise InvalidValueError(f"rotation {-angle:g} rad does not lift the centre of mass; a rounded base?")
    else:
        landing = checks.positive("angular_velocity", angular_velocity, "rad/s")
        angle = _angle_of(rigid, landing, 0.5 * limit)
    old = rigid.pivot(-1e-9 if impulsive else angle)
    inertia = rigid.inertia_about(old)
    left = max(0.5 * inertia * landing**2 - (0.0 if impulsive else rigid.potential(angle)), 0.0)
    if impulsive:
        state = (rigid.lift(0.0), 0.0, 0.0, float(rigid.bed.positions[old]) * landing, landing)
    else:
        turning = math.sqrt(2.0 * left / inertia) if left > 1e-12 * inertia * landing**2 else 0.0
        state = _on_the_old_foot(rigid, law, old, angle, turning)
    energy = 0.5 * inertia * landing**2
    reach = rigid.bed.ends[1] - rigid.bed.ends[0]
    depth = depth_absorbing(law, float(np.sum(rigid.bed.shares)), energy, landing * reach)
    new = rigid.pivot(1e-9 if impulsive else min(0.5 * rigid.furthest(1.0), -angle))
    return ImpactStart(state, landing, energy, min(depth, reach), landing * reach, 0.5 * reach, old, new, impulsive)


def _angle_of(rigid: RigidRocking, landing: float, most: float) -> float:
    """Return the rotation from which the body falls to the landing velocity, or the most that is allowed."""

    def missing(angle: float) -> float:
        return 0.5 * rigid.inertia_about(rigid.pivot(angle)) * landing**2 - rigid.potential(angle)

    if rigid.gravity == 0.0 or missing(-most) >= 0.0:
        return -most
    low, high = 0.0, most
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if missing(-middle) > 0.0 else (low, middle)
    return -high


def _on_the_old_foot(
    rigid: RigidRocking, law: LawNumbers, old: int, angle: float, turning: float
) -> tuple[float, float, float, float, float]:
    load = max(rigid.support(angle, turning), 0.0)
    y = rigid.lift(angle) - settlement(rigid, law, angle, load)[0]
    s, zeta = float(rigid.bed.positions[old]), float(rigid.bed.heights[old])
    # rotation about the point: in the body's axes its velocity vanishes
    return (y, angle, -zeta * turning if rigid.bed.kinematics == "exact" else 0.0, s * turning, turning)
