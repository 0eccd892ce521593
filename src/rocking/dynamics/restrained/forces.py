"""Forces and energy of a response with restraints at its samples."""

import math
from dataclasses import dataclass

import numpy as np

from rocking.bodies.restrained import Restrained
from rocking.bodies.restraints import Wall
from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane import equations
from rocking.dynamics.plane.equations import EventKind
from rocking.dynamics.restrained.levers import Lever
from rocking.dynamics.restrained.reference import RestrainedTrajectory


@dataclass(frozen=True, repr=False)
class RestrainedForces:
    """Forces of the ground and of the foundation, and energy, at the samples."""

    horizontal_force: FloatArray  # force of the ground on the body alone, parallel to the floor and normal [N]
    vertical_force: FloatArray
    base_shear: FloatArray  # force of body and restraints on the foundation [N]
    overturning_moment: FloatArray  # moment on the foundation about the middle of the base, clockwise [N m]
    kinetic_energy: FloatArray  # [J]
    potential_energy: FloatArray
    energy_lost: FloatArray  # energy lost at impacts [J]

    @classmethod
    def of(  # noqa: PLR0913, PLR0917 - a history and its inputs
        cls,
        body: Restrained,
        parameters: RockingParameters,
        run: RestrainedTrajectory,
        time: FloatArray,
        states: tuple[FloatArray, FloatArray, FloatArray],
        horizontal: FloatArray,
        vertical: FloatArray,
        gravity: float,
        *,
        linear: bool,
    ) -> "RestrainedForces":
        """Return the forces at times.

        `states` are rotation, angular velocity and forces of restraints, `horizontal` and `vertical` are accelerations
        of the ground [m/s2].
        """
        count, mass = time.size, body.mass
        rotation, velocity, force = states
        moving = np.where(rotation != 0.0, rotation, velocity)
        side = np.where(moving < 0.0, -1, 1)
        alpha, p, radius = (
            np.where(side > 0, getattr(parameters.right, name), getattr(parameters.left, name))
            for name in ("slenderness_angle", "frequency_parameter", "semi_diagonal")
        )
        inertia = mass * gravity * radius / p**2
        arms, pull_x, pull_z = (np.zeros_like(force) for _ in range(3))
        for i, restraint in enumerate(body.restraints):
            levers = {sign: Lever.of(restraint, body.body, sign, linear=linear) for sign in (1, -1)}
            for k in range(count):
                lever = levers[int(side[k])]
                arms[k, i] = lever.slope(float(rotation[k]))
                if isinstance(restraint, Wall):
                    pull_x[k, i] = restraint.sign
                    continue
                pull_x[k, i], pull_z[k, i] = direction_of(
                    restraint.ends, body.body.feet, int(side[k]), float(rotation[k])
                )
        push, weight = horizontal / gravity, 1.0 + vertical / gravity
        acceleration = equations.angular_acceleration(rotation, side, alpha, p, push, weight, linear=linear)
        acceleration = np.where(moving != 0.0, acceleration - (force * arms).sum(axis=1) / inertia, 0.0)
        acceleration = np.where((velocity == 0.0) & (rotation != 0.0) & (time > 0.0), 0.0, acceleration)
        sine, cosine = math.sin(body.floor_slope), math.cos(body.floor_slope)
        along = cosine * horizontal + sine * (gravity + vertical)  # parallel to the floor, and normal
        across = cosine * (gravity + vertical) - sine * horizontal
        from_normal = alpha - side * body.floor_slope
        total_x, total_z = equations.reactions(
            rotation, velocity, acceleration, side, from_normal, radius, along, across
        )
        psi = from_normal - side * rotation
        left, right = body.body.feet
        pivot = np.where(side > 0, right, left) - 0.5 * (left + right)
        x, z = pivot - side * radius * np.sin(psi), radius * np.cos(psi)
        central = mass * radius**2
        moment = mass * (total_x * z - total_z * x) + (inertia - central) * acceleration
        kinetic = 0.5 * inertia * velocity**2
        energy = mass * gravity * radius * equations.energy(rotation, velocity, alpha, p, linear=linear)
        return cls(
            mass * total_x + (force * pull_x).sum(axis=1), mass * total_z + (force * pull_z).sum(axis=1),
            mass * total_x, moment, kinetic, energy - kinetic, losses(run, parameters, mass, gravity, time),
        )  # fmt: skip


def losses(
    run: RestrainedTrajectory, parameters: RockingParameters, mass: float, gravity: float, time: FloatArray
) -> FloatArray:
    """Return the energy lost at impacts up to every time [J]."""
    inertia = {
        sign: mass * gravity * side.semi_diagonal / side.frequency_parameter**2
        for sign in (1, -1)
        for side in (parameters.side(sign),)
    }
    impacts = [event for event in run.events if event.kind is EventKind.IMPACT]
    rests = {event.time for event in run.events if event.kind is EventKind.REST}
    lost = []
    for e in impacts:
        old = 1 if e.before < 0.0 else -1
        after = 0.0 if e.time in rests else e.after
        lost.append(0.5 * inertia[old] * e.before**2 - 0.5 * inertia[e.side] * after**2)
    totals = np.concatenate([[0.0], np.cumsum(lost)])
    return np.asarray(totals[np.searchsorted([e.time for e in impacts], time, side="right")])


def direction_of(
    ends: tuple[tuple[float, float], tuple[float, float]], feet: tuple[float, float], side: int, rotation: float
) -> tuple[float, float]:
    """Return the unit vector from the point of the ground to the point of the body."""
    (ground_x, ground_z), (point_x, point_z) = ends
    foot = feet[side > 0]
    d_x, d_z = point_x - foot, point_z
    cosine, sine = math.cos(rotation), math.sin(rotation)
    x = foot + d_x * cosine + d_z * sine - ground_x
    z = d_z * cosine - d_x * sine - ground_z
    length = math.hypot(x, z)
    if length > 1e-6 * math.hypot(d_x, d_z) or math.hypot(ground_x - point_x, ground_z - point_z):
        return (x / length, z / length) if length else (0.0, 0.0)
    sign = -math.copysign(1.0, d_x * side) if d_x else 0.0  # coincident points: the direction at half the angle
    return sign * math.sin(0.5 * rotation), sign * math.cos(0.5 * rotation)  # Eq. 354
