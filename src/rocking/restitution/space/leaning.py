"""The impact of a body that need not stand upright: given by its moments, with or without its distribution of mass."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

from rocking.bodies.solid import Corner, Edge, Solid, SolidMoments
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.portable import dot
from rocking.restitution.space.geometry import UP
from rocking.restitution.space.rigid import RigidImpact

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
