"""What every impact of a rigid body in space has: momenta and energies about the place where it lands."""

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np

from rocking.bodies.solid import Corner, Edge, Solid, SolidMoments
from rocking.conventions import FloatArray
from rocking.portable import applied, dot, norm, solution, times


class RigidImpact(ABC):
    """A rigid body that turns about one point of the ground and lands on another, or on an edge.

    Everything is in axes of the body, and the ground may lean in them: a body that falls from a corner onto an edge
    of its base is tilted when it lands.

    Attributes
    ----------
    velocity : ndarray, shape (3,)
        Angular velocity before the impact [rad/s].
    pivot : ndarray, shape (3,)
        A point of the body that is at rest before the impact [m].
    onto : Corner or Edge
        What the body lands on [m].
    up : ndarray, shape (3,)
        Normal of the ground [-].
    """

    velocity: FloatArray
    pivot: FloatArray
    onto: Corner | Edge
    up: FloatArray

    @property
    @abstractmethod
    def moments(self) -> SolidMoments:
        """Mass, centre and second moments of the body, relative to the landing point [kg, m, kg m2]."""

    @property
    @abstractmethod
    def placed_solid(self) -> tuple[Solid, Corner | Edge]:
        """The body as a distribution of mass, and the landing place in the solid's own frame."""

    @cached_property
    def level(self) -> FloatArray:
        """Projection onto the ground, ``P = 1 - n n^T`` [-]."""
        projection: FloatArray = np.eye(3) - np.outer(self.up, self.up)
        return projection

    @cached_property
    def spin(self) -> FloatArray:
        """Matrix W of the angular velocity, ``W s = omega x s`` [rad/s]."""
        return skew(self.velocity)

    @property
    def speed(self) -> float:
        """Magnitude of the angular velocity before the impact [rad/s]."""
        return norm(self.velocity)

    @cached_property
    def landing_velocity(self) -> FloatArray:
        """Velocity of the landing point before the impact, ``omega x (B - A)`` [m/s]."""
        return applied(self.spin, self.onto.point - self.pivot)

    @property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the landing point [kg m2]."""
        second = self._second
        tensor: FloatArray = np.trace(second) * np.eye(3) - second
        return tensor

    @property
    def angular_momentum(self) -> FloatArray:
        """Angular momentum about the landing point, ``I_C omega + m rho_B x (omega x rho_A)`` [kg m2/s]."""
        return self._momentum(np.eye(3))

    @property
    def level_momentum(self) -> FloatArray:
        """Angular momentum of the horizontal velocities about the landing point, ``Int s x P v dm`` [kg m2/s]."""
        return self._momentum(self.level)

    @property
    def energy(self) -> float:
        """Kinetic energy before the impact [J]."""
        return self._energy(np.eye(3))

    @property
    def level_energy(self) -> float:
        """Kinetic energy of the horizontal velocities, what stage 1 of KED leaves [J]."""
        return self._energy(self.level)

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
        return times(points, self.spin.T) + self.landing_velocity

    @cached_property
    def _second(self) -> FloatArray:
        return self.moments.second_about(np.zeros(3))

    def _momentum(self, projection: FloatArray) -> FloatArray:
        # s x (G s) summed over the body needs the second moments alone
        spread = times(self._second, times(projection, self.spin).T)
        turning = np.array([spread[1, 2] - spread[2, 1], spread[2, 0] - spread[0, 2], spread[0, 1] - spread[1, 0]])
        shift = self.moments.mass * applied(skew(self.moments.centre), applied(projection, self.landing_velocity))
        return turning + shift  # Eq. 102

    def _energy(self, projection: FloatArray) -> float:
        gradient, drift, moments = (
            times(projection, self.spin),
            applied(projection, self.landing_velocity),
            self.moments,
        )
        spread = float((times(gradient, self._second) * gradient).sum())
        crossed = 2.0 * moments.mass * dot(drift, applied(gradient, moments.centre))
        return 0.5 * (spread + crossed + moments.mass * dot(drift, drift))


def skew(vector: FloatArray) -> FloatArray:
    """Return the matrix of a vector product from the left.

    Returns K with ``K s = vector x s``.

    >>> applied(skew(np.array([0.0, 0.0, 2.0])), np.array([1.0, 0.0, 0.0])).tolist()
    [0.0, 2.0, 0.0]
    """
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def solved(inertia: FloatArray, momentum: FloatArray) -> FloatArray:
    """Return the angular velocity that has a given angular momentum.

    inertia: inertia tensor about the fixed point [kg m2]; momentum: angular momentum about it [kg m2/s]. Returns
    angular velocity [rad/s].
    """
    return solution(inertia, momentum)
