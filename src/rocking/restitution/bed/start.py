"""How an impact begins: on the old foot, with the energy of the rotation or velocity that was asked for."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.restitution.bed.law import LawNumbers, depth_absorbing
from rocking.restitution.bed.rigid import RigidRocking
from rocking.restitution.bed.settlement import settlement


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


def start_of(
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
