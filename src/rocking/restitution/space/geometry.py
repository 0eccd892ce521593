"""An impact in space before any model speaks: who turns about what, and where it lands."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking.bodies.solid import Corner, Edge, RoundBase, Solid, SolidMoments, SupportPolygon
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.portable import norm
from rocking.restitution.space.rigid import RigidImpact

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
