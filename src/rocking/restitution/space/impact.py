"""A 3D impact, independent of the model: pivot, landing, momenta and energies."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from rocking.bodies.solid import Base, Corner, Edge, Solid, SolidMoments
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.portable import applied, dot, norm, solution, times

Placed = tuple[Solid, FloatArray]  # a solid, and the origin of the frame of the solid in axes of the body [m]
UP = np.array([0.0, 0.0, 1.0])  # normal of the ground

NO_MATTER = (
    "this model needs the distribution of mass, got a body with mass, centre and inertia only: use a Solid of "
    "parts with densities, SpatialBody.of(solid), SpatialBody.box or SpatialBody.cylinder, or one of the models "
    "'calibrated-3d', 'housner-3d' and 'horizontal-momentum-3d'"
)
"""Message for a body without a solid."""

NO_SOLID = (
    "motion of the base and energy loss of units need a solid: give the impact its matter; "
    "for the angular velocity only, use model.turned(impact)"
)
"""Message for a body without a solid, if base or units are needed."""

_UNIT = 1e-9


@dataclass(frozen=True, eq=False)
class SpatialImpact:
    """Impact of a rigid body in any attitude that turns about a point of the ground and lands on a point or an edge.

    All vectors are in body axes. The ground may be tilted in these axes, because a body that falls from a corner onto
    an edge of its base is tilted at the landing.

    Parameters
    ----------
    body : SolidMoments
        Mass, centre of mass and central second moments [kg, m, kg m2].
    velocity : ndarray, shape (3,)
        Angular velocity before the impact [rad/s].
    pivot : ndarray, shape (3,)
        Point of the body at rest before the impact [m].
    onto : Corner or Edge
        Corner or edge of landing [m].
    up : ndarray, shape (3,)
        Normal of the ground [-].
    matter : callable, optional
        Function that returns the body as a solid, and the origin of the frame of the solid [m]. Models with a
        distribution of mass need this function.
    base : Base, optional
        Base of the body in body axes [m], which calibrated-3d needs.

    Raises
    ------
    InvalidValueError
        If the normal is not a unit vector.

    Examples
    --------
    A prism 1 x 1 x 4, given by moments, falls from a corner onto the opposite corner: 59/71.

    >>> import numpy as np
    >>> from rocking.restitution.space import SpatialHousner
    >>> prism = SolidMoments(4.0, np.array([0.5, 0.5, 2.0]), 4.0 / 12.0 * np.diag([1.0, 1.0, 16.0]))
    >>> impact = SpatialImpact(prism, np.array([-1.0, 1.0, 0.0]), np.zeros(3), Corner(np.array([1.0, 1.0, 0.0])))
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
    base: Base | None = None

    def __post_init__(self) -> None:
        """Check the normal of the ground."""
        if not abs(dot(self.up, self.up) - 1.0) <= _UNIT:
            raise InvalidValueError(
                "{parameter} must be {allowed}, got {value}", parameter="up",
                allowed="a vertical unit vector", value=self.up.tolist(),
            )  # fmt: skip

    @cached_property
    def moments(self) -> SolidMoments:
        """Mass, centre of mass and second moments of the body, relative to the landing point [kg, m, kg m2]."""
        return SolidMoments(self.body.mass, self.body.centre - self.onto.point, self.body.second)

    @cached_property
    def placed_solid(self) -> tuple[Solid, Corner | Edge]:
        """The body as a distribution of mass, and the landing corner or edge in the frame of the solid."""
        solid, origin = self._placed
        if solid.known is not None:
            raise InvalidValueError(NO_MATTER)
        point = self.onto.point - origin
        point[2] = 0.0 if abs(point[2]) <= _UNIT * solid.size else point[2]
        return solid, Edge(point, self.onto.direction) if isinstance(self.onto, Edge) else Corner(point)

    @property
    def solid(self) -> Solid:
        """The body as a distribution of mass."""
        return self.placed_solid[0]

    @property
    def standing_solid(self) -> Placed:
        """The body as an upright solid, and the origin of the frame of the solid [m].

        Raises
        ------
        InvalidValueError
            If there is no solid, or if the ground is tilted in axes of the solid.
        """
        if self.matter is None:
            raise InvalidValueError(NO_SOLID)
        if not float(np.abs(self.up - UP).max()) <= _UNIT:
            raise InvalidValueError(
                "motion of the base and energy loss of units need an upright body with up = (0, 0, 1), got up = "
                "{up}; for the angular velocity of a tilted body, use model.turned(impact)",
                up=self.up.tolist(),
            )  # fmt: skip
        return self._placed

    @property
    def edge(self) -> FloatArray | None:
        """Unit vector along the edge of landing; None for a corner [-]."""
        return self.onto.direction if isinstance(self.onto, Edge) else None

    @cached_property
    def level(self) -> FloatArray:
        """Projection onto the ground, ``P = 1 - n n^T`` [-]."""
        return np.asarray(np.eye(3) - np.outer(self.up, self.up))

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

    @cached_property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the landing point [kg m2]."""
        return np.asarray(np.trace(self._second) * np.eye(3) - self._second)

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
        drift, spin, moments = self.landing_velocity, self.spin, self.moments
        spread = float((times(spin, self._second) * spin).sum())
        crossed = 2.0 * moments.mass * dot(drift, applied(spin, moments.centre))
        return 0.5 * (spread + crossed + moments.mass * dot(drift, drift))

    def with_momentum(self, momentum: FloatArray) -> FloatArray:
        """Return the angular velocity for an angular momentum about the landing corner or edge.

        Parameters
        ----------
        momentum : ndarray, shape (3,)
            Angular momentum about the landing point [kg m2/s]. For an edge, only the component along the edge is used.

        Returns
        -------
        ndarray, shape (3,)
            Angular velocity [rad/s]. For a landing on an edge, it is along the edge.
        """
        along = self.edge
        if along is None:
            return solution(self.inertia, momentum)  # Eqs. 88, 102
        return dot(along, momentum) / dot(along, applied(self.inertia, along)) * along  # Eq. 89

    @cached_property
    def _placed(self) -> Placed:
        if self.matter is None:
            raise InvalidValueError(NO_MATTER)
        return self.matter()

    @cached_property
    def _second(self) -> FloatArray:
        return self.moments.second_about(np.zeros(3))

    def _momentum(self, projection: FloatArray) -> FloatArray:
        # the sum of s x (G s) over the body needs only the second moments
        spread = times(self._second, times(projection, self.spin).T)
        turning = np.array([spread[1, 2] - spread[2, 1], spread[2, 0] - spread[0, 2], spread[0, 1] - spread[1, 0]])
        shift = self.moments.mass * applied(skew(self.moments.centre), applied(projection, self.landing_velocity))
        return turning + shift  # Eqs. 88, 102


def skew(vector: FloatArray) -> FloatArray:
    """Return the matrix of a vector product from the left."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
