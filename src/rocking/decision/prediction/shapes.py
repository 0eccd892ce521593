"""Sampled shapes of a 3D body: inset contact points, further contact points, and a moved centre of mass."""

import numpy as np

from rocking.bodies import Solid
from rocking.bodies.equilibria import StablePose
from rocking.conventions import FloatArray
from rocking.decision.prediction.placement import FARTHEST
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.motion import standing
from rocking.dynamics.rolling.attitude import product, turn

ANOTHER = np.cos(np.radians(10.0))
"""Cosine of the smallest angle between two different stable poses; rough bodies have many similar poses."""


class StandingShape:
    """A body in its initial pose; all other poses have the index 1."""

    def __init__(self, body: HullBody) -> None:
        self.facet = body.hull.rolled(body.under((0.0, 0.0, 1.0)))
        self.body = body.with_poses_near(self.facet, ANOTHER)
        self.start = standing(body, facet=self.facet)

    def state(self, azimuth: float) -> list[float]:
        """Return initial attitude, position and velocities."""
        attitude = product(turn([0.0, 0.0, 1.0], azimuth), np.array(self.start.attitude))
        return [*attitude.tolist(), *self.start.position, *self.start.velocity, *self.start.spin]


class SampledShapes:
    """Shapes of a body.

    The hull is computed once per base, because a moved centre of mass changes no vertex of the hull.
    """

    def __init__(self, solid: Solid, pose: StablePose, inertia: FloatArray) -> None:
        equilibria, rotation = solid.equilibria(), pose.rotation
        self.corners, self._surface = (points @ rotation.T for points in (equilibria.hull.vertices, equilibria.surface))
        self._solid, self._mass, self._inertia, self._flat = solid, equilibria.mass, inertia, equilibria.flatness
        self._support, self._height = pose.support, pose.height
        self._hulls: dict[float, HullBody] = {}
        self._shapes: dict[tuple[float, ...], StandingShape] = {}

    def of(self, base: float, centre: float, offset: tuple[float, ...] = (0.0, 0.0)) -> StandingShape:
        """Return the shape with a base [m], and the centre of mass with a factor on its height and an offset [m]."""
        key = (base, centre, *offset)
        if key not in self._shapes:
            if base not in self._hulls:
                self._hulls[base] = HullBody(
                    self.points(base), self._mass, np.zeros(3), self._inertia, self._solid
                )  # fmt: skip
            self._shapes[key] = StandingShape(
                self._hulls[base].moved(np.array([*offset, (centre - 1.0) * self._height]))
            )
        return self._shapes[key]

    def points(self, base: float) -> FloatArray:
        """Return the vertices of the body with a base, from the nominal centre of mass [m]."""
        # negative base: distance of each point inside the outline; positive base: further points touch the ground
        points = self.corners.copy()
        if base <= 0.0:
            points[:, :2] = inset(points[:, :2], base)
            return points
        near = self._surface[self._surface[:, 2] + self._height <= max(base, self._flat)]
        points = np.concatenate([points, near])
        points[points[:, 2] + self._height <= max(base, self._flat), 2] = -self._height
        return points

    def standing(self, base: FloatArray, shift: FloatArray) -> FloatArray:
        """Return the factor, at most 1, on shifts of the plumb line for stable bodies; shape (n,).

        `base` contains insets of the contact points, shape (n,); `shift` contains shifts of the plumb line in the base,
        shape (n, 2) [m].
        """
        factor = np.ones(len(base))
        for k, distance in enumerate(base.tolist()):
            corners = inset(self._support, min(distance, 0.0))
            along = np.roll(corners, -1, axis=0) - corners
            outward = np.column_stack([along[:, 1], -along[:, 0]])
            demand = (outward * shift[k]).sum(axis=1)
            reach = FARTHEST * (outward * corners).sum(axis=1)
            factor[k] = np.min(reach[demand > reach] / demand[demand > reach], initial=1.0)
        return factor


def inset(points: FloatArray, base: float) -> FloatArray:
    """Return points moved towards the plumb line by a distance -base, at most by 90 % [m]; shape (n, 2)."""
    far = np.maximum(np.linalg.norm(points, axis=1, keepdims=True), 1e-300)
    moved: FloatArray = points * (1.0 + np.maximum(base / far, -FARTHEST))
    return moved
