"""An impact in space before any model speaks: who turns about what, and where it lands."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking.bodies.solid import Corner, Edge, RoundBase, Solid, SolidMoments, SupportPolygon
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

UP = np.array([0.0, 0.0, 1.0])
"""Normal of the ground."""

LEVEL = np.diag([1.0, 1.0, 0.0])
"""Projection onto the ground, P_h = 1 - n n^T."""

_RIM = 64


@dataclass(frozen=True)
class SpatialImpact:
    """A body that turns about one point of the ground and lands on another, or on an edge.

    Lengths are in the body's own frame, whose origin is `Solid.origin`.

    Parameters
    ----------
    solid : Solid
        The body.
    velocity : ndarray, shape (3,)
        Angular velocity before the impact [rad/s].
    pivot : ndarray, shape (3,)
        A point of the body that is at rest before the impact [m].
    onto : Corner or Edge
        What the body lands on [m].

    Raises
    ------
    InvalidValueError
        If the base does not come down on the ground.
    """

    solid: Solid
    velocity: FloatArray
    pivot: FloatArray
    onto: Corner | Edge

    def __post_init__(self) -> None:
        if not self.solid.size > 0.0 or not self.speed > 0.0:
            raise InvalidValueError("velocity must not be zero: a body at rest has no impact")
        down = float(np.cross(self.velocity, self._middle - self.pivot)[2])
        if not down < 1e-12 * self.speed * self.solid.size:
            raise InvalidValueError(
                f"velocity must turn the base onto the ground about the pivot; its middle rises at {down:.3g} m/s: "
                "is the sign of the angular velocity wrong? The vector points along the axis, right-handed"
            )

    @property
    def speed(self) -> float:
        """Magnitude of the angular velocity before the impact [rad/s]."""
        return float(np.linalg.norm(self.velocity))

    @cached_property
    def moments(self) -> SolidMoments:
        """Mass, centre and second moments of the body, relative to the landing point [kg, m, kg m2]."""
        found = self.solid.local_moments
        return SolidMoments(found.mass, found.centre - self.onto.point, found.second)

    @property
    def landing_velocity(self) -> FloatArray:
        """Velocity of the landing point before the impact, ``omega x (B - A)`` [m/s]."""
        return np.cross(self.velocity, self.onto.point - self.pivot)

    @property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the landing point [kg m2]."""
        return self.moments.inertia_about(np.zeros(3))

    @property
    def angular_momentum(self) -> FloatArray:
        """Angular momentum about the landing point, ``I_C omega + m rho_B x (omega x rho_A)`` [kg m2/s]."""
        moments = self.moments
        centre_velocity = self.landing_velocity + np.cross(self.velocity, moments.centre)
        return moments.inertia @ self.velocity + moments.mass * np.cross(moments.centre, centre_velocity)

    @property
    def level_momentum(self) -> FloatArray:
        """Angular momentum of the horizontal velocities about the landing point [kg m2/s]."""
        # s x (G s) summed over the body needs the second moments alone
        gradient = LEVEL @ np.cross(self.velocity, np.eye(3)).T
        spread = self.moments.second_about(np.zeros(3)) @ gradient.T
        turning = np.array([spread[1, 2] - spread[2, 1], spread[2, 0] - spread[0, 2], spread[0, 1] - spread[1, 0]])
        shift: FloatArray = self.moments.mass * np.cross(self.moments.centre, LEVEL @ self.landing_velocity)
        return turning + shift

    @property
    def energy(self) -> float:
        """Kinetic energy before the impact [J]."""
        moments = self.moments
        centre_velocity = self.landing_velocity + np.cross(self.velocity, moments.centre)
        spin = float(self.velocity @ moments.inertia @ self.velocity)
        return 0.5 * (spin + moments.mass * float(centre_velocity @ centre_velocity))

    @property
    def level_energy(self) -> float:
        """Kinetic energy of the horizontal velocities, what stage 1 of KED leaves [J]."""
        gradient = LEVEL @ np.cross(self.velocity, np.eye(3)).T
        drift, moments = LEVEL @ self.landing_velocity, self.moments
        spread = float(np.trace(gradient @ moments.second_about(np.zeros(3)) @ gradient.T))
        crossed = 2.0 * moments.mass * float(drift @ gradient @ moments.centre)
        return 0.5 * (spread + crossed + moments.mass * float(drift @ drift))

    def velocities(self, points: FloatArray) -> FloatArray:
        """Return the velocities of points of the body before the impact.

        Parameters
        ----------
        points : ndarray, shape (n, 3)
            Points relative to the landing point [m].

        Returns
        -------
        ndarray, shape (n, 3)
            Velocities [m/s].
        """
        field: FloatArray = np.cross(self.velocity, points) + self.landing_velocity
        return field

    def rise(self, velocity: FloatArray) -> float:
        """Return the least vertical velocity of the base, if the body turns about the landing point.

        Parameters
        ----------
        velocity : ndarray, shape (3,)
            Angular velocity [rad/s].

        Returns
        -------
        float
            Vertical velocity [m/s]; below zero the base would go through the ground.
        """
        return float(np.cross(velocity, self._rim() - self.onto.point)[:, 2].min())

    @property
    def _middle(self) -> FloatArray:
        middle: FloatArray = self._rim().mean(axis=0)
        return middle

    def _rim(self) -> FloatArray:
        base = self.solid.local_base
        if isinstance(base, SupportPolygon):
            flat = base.vertices
        elif isinstance(base, RoundBase):
            phi = np.linspace(0.0, 2.0 * np.pi, _RIM, endpoint=False)
            flat = base.centre + base.radius * np.stack([np.cos(phi), np.sin(phi)], axis=1)
        else:
            flat = self.solid.local_moments.centre[None, :2]
        return np.column_stack([flat, np.zeros(len(flat))])


def solved(inertia: FloatArray, momentum: FloatArray) -> FloatArray:
    """Return the angular velocity that has a given angular momentum.

    Parameters
    ----------
    inertia : ndarray, shape (3, 3)
        Inertia tensor about the fixed point [kg m2].
    momentum : ndarray, shape (3,)
        Angular momentum about it [kg m2/s].

    Returns
    -------
    ndarray, shape (3,)
        Angular velocity [rad/s].
    """
    return np.asarray(np.linalg.solve(inertia, momentum), dtype=np.float64)
