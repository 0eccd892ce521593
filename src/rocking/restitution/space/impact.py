"""An impact in space before any model speaks: who turns about what, where it lands, momenta and energies."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from rocking.bodies.solid import Corner, Edge, RoundBase, Solid, SolidMoments, SupportPolygon
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
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
    """Return the matrix of a vector product from the left."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def solved(inertia: FloatArray, momentum: FloatArray) -> FloatArray:
    """Return the angular velocity that has a given angular momentum."""
    return solution(inertia, momentum)


UP = np.array([0.0, 0.0, 1.0])
"""Normal of the ground."""


@dataclass(frozen=True)
class SpatialImpact(RigidImpact):
    """A body that stands upright at the moment of the impact: from one point of the ground onto another, or an edge.

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
    up = UP

    def __post_init__(self) -> None:
        if not self.solid.size > 0.0 or not self.speed > 0.0:
            raise InvalidValueError("velocity must not be zero: a body at rest has no impact")
        down = float(np.cross(self.velocity, self._middle - self.pivot)[2])
        if not down < 1e-12 * self.speed * self.solid.size:
            raise InvalidValueError(
                f"velocity must turn the base onto the ground about the pivot; its middle rises at {down:.3g} m/s: "
                "is the sign of the angular velocity wrong? The vector points along the axis, right-handed"
            )

    @cached_property
    def moments(self) -> SolidMoments:
        found = self.solid.local_moments
        return SolidMoments(found.mass, found.centre - self.onto.point, found.second)

    @property
    def placed_solid(self) -> tuple[Solid, Corner | Edge]:
        return self.solid, self.onto

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
        base = self.solid.local_base
        points = base.vertices if isinstance(base, SupportPolygon) else self._middle[None, :2]
        arms = points - self.onto.point[:2]
        least = float((velocity[0] * arms[:, 1] - velocity[1] * arms[:, 0]).min())
        return least - base.radius * norm(velocity[:2]) if isinstance(base, RoundBase) else least

    @property
    def _middle(self) -> FloatArray:
        base = self.solid.local_base
        if isinstance(base, RoundBase):
            flat = base.centre
        else:
            flat = base.vertices.mean(axis=0) if isinstance(base, SupportPolygon) else self.solid.local_moments.centre
        return np.array([flat[0], flat[1], 0.0])


Placed = tuple[Solid, FloatArray]
"""A solid, and the origin of its own frame in axes of the body [m]."""

_UNIT = 1e-9


@dataclass(frozen=True, eq=False)
class LeaningImpact(RigidImpact):
    """A rigid body in any attitude that turns about a point of the ground and lands on a corner or an edge.

    Parameters
    ----------
    body : SolidMoments
        Mass, centre and central second moments, in axes of the body [kg, m, kg m2].
    velocity : ndarray, shape (3,)
        Angular velocity before the impact [rad/s].
    pivot : ndarray, shape (3,)
        A point that is at rest before the impact [m].
    onto : Corner or Edge
        What the body lands on [m].
    up : ndarray, shape (3,)
        Normal of the ground, in axes of the body [-].
    matter : callable, optional
        Returns the body as a solid and the origin of the solid's frame [m]; models that need no distribution of mass
        never ask.

    Raises
    ------
    InvalidValueError
        If the normal is no unit vector.

    Examples
    --------
    A prism 1 x 1 x 4, as moments, from a corner onto the opposite one: 59/71.

    >>> import numpy as np
    >>> from rocking.restitution.space import SpatialHousner
    >>> prism = SolidMoments(4.0, np.array([0.5, 0.5, 2.0]), 4.0 / 12.0 * np.diag([1.0, 1.0, 16.0]))
    >>> impact = LeaningImpact(prism, np.array([-1.0, 1.0, 0.0]), np.zeros(3), Corner(np.array([1.0, 1.0, 0.0])))
    >>> after = SpatialHousner().turned(impact)
    >>> bool(np.abs(71.0 * after - [-59.0, 59.0, 0.0]).max() < 1e-12)
    True
    """

    body: SolidMoments
    velocity: FloatArray
    pivot: FloatArray
    onto: Corner | Edge
    up: FloatArray = field(default_factory=UP.copy)
    matter: Callable[[], Placed] | None = None

    def __post_init__(self) -> None:
        """Check the normal of the ground."""
        if not abs(dot(self.up, self.up) - 1.0) <= _UNIT:
            raise InvalidValueError(f"up must be a unit vector, got {self.up.tolist()}: is it the vertical?")

    @cached_property
    def moments(self) -> SolidMoments:
        return SolidMoments(self.body.mass, self.body.centre - self.onto.point, self.body.second)

    @property
    def placed_solid(self) -> tuple[Solid, Corner | Edge]:
        """The solid that the body came from, and the landing place in its own frame."""
        if self.matter is None:
            raise InvalidValueError(NO_MATTER)
        solid, origin = self.matter()
        point = self.onto.point - origin
        point[2] = 0.0 if abs(point[2]) <= _UNIT * solid.size else point[2]
        return solid, Edge(point, self.onto.direction) if isinstance(self.onto, Edge) else Corner(point)


NO_MATTER = (
    "this model needs the distribution of mass, got a body known by its mass, centre and inertia alone: use a Solid, "
    "SpatialBody.of(solid), SpatialBody.box or SpatialBody.cylinder, or a model that needs no more than these, "
    "'housner-3d' or 'horizontal-momentum-3d'"
)
"""What a body without a solid is told."""
