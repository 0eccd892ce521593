"""An impact in space before any model speaks: who turns about what, and where it lands."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking.bodies.solid import Corner, Edge, RoundBase, Solid, SolidMoments, SupportPolygon
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.restitution.spatial.rigid import RigidImpact

UP = np.array([0.0, 0.0, 1.0])
"""Normal of the ground."""

_RIM = 64


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
        """Mass, centre and second moments of the body, relative to the landing point [kg, m, kg m2]."""
        found = self.solid.local_moments
        return SolidMoments(found.mass, found.centre - self.onto.point, found.second)

    @property
    def placed_solid(self) -> tuple[Solid, Corner | Edge]:
        """The body and the landing place."""
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
