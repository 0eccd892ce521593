"""Mass, centre of mass and second moments in 2D and 3D, and their sums over parts."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.portable import applied, gram, times


@dataclass(frozen=True, slots=True)
class PlaneMoments:
    """Zeroth, first and central second moments of a 2D mass distribution."""

    mass: float  # integral of dm [kg], or of dA [m2] for a bare ring; negative for a hole
    x: float  # x, y: coordinates of the centre of mass [m]
    y: float
    xx: float  # xx, yy: integrals of (x - centre)**2 dm and of (y - centre)**2 dm [kg m2]
    yy: float

    @property
    def polar(self) -> float:
        """Polar moment about the centre of mass [kg m2]."""
        return self.xx + self.yy

    def times(self, weight: float) -> "PlaneMoments":
        """Return the moments of the shape with `weight` times the mass."""
        return PlaneMoments(self.mass * weight, self.x, self.y, self.xx * weight, self.yy * weight)


def ring_moments(ring: FloatArray) -> PlaneMoments:
    """Return exact moments of the area inside a ring, positive if counter-clockwise, by Green's theorem."""
    # the origin is the middle of the bounding box; this prevents cancellation far from the user's origin
    middle = 0.5 * (ring.min(axis=0) + ring.max(axis=0))
    x, y = (ring - middle).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    cross = x * y1 - x1 * y
    area = 0.5 * float(cross.sum())
    cx = float((cross * (x + x1)).sum()) / (6.0 * area)
    cy = float((cross * (y + y1)).sum()) / (6.0 * area)
    xx = float((cross * (x * x + x * x1 + x1 * x1)).sum()) / 12.0 - area * cx * cx
    yy = float((cross * (y * y + y * y1 + y1 * y1)).sum()) / 12.0 - area * cy * cy
    return PlaneMoments(area, float(middle[0]) + cx, float(middle[1]) + cy, xx, yy)


def combined_plane(parts: Iterable[PlaneMoments]) -> PlaneMoments:
    """Return the sum of the moments of parts (parallel-axis theorem); holes have negative mass."""
    m, x, y, xx, yy = np.array([(p.mass, p.x, p.y, p.xx, p.yy) for p in parts]).T
    mass = float(m.sum())
    cx, cy = float((m * x).sum()) / mass, float((m * y).sum()) / mass
    return PlaneMoments(mass, cx, cy, float((xx + m * (x - cx) ** 2).sum()), float((yy + m * (y - cy) ** 2).sum()))


def quarters(
    moments: PlaneMoments, box: tuple[float, float, float, float]
) -> tuple[list[FloatArray], FloatArray, FloatArray]:
    """Return a mass distribution within a box with the given moments, as in `Body.assumed`."""
    # Returns rectangles, counter-clockwise from the centre of mass [m], the corners of the box, shape (4, 2) [m], and
    # the masses in rectangles and corners, shape (2, 4) [kg]. Masses in the complete quarters have a third of the
    # moment of the same masses in the corners.
    centre = np.array([moments.x, moments.y])
    left, low, right, high = box
    corners = np.array([[left, low], [right, low], [right, high], [left, high]])
    arms = corners - centre
    weights = np.abs(arms[[2, 3, 0, 1]]).prod(axis=1) / ((right - left) * (high - low))
    spread = 3.0 * moments.polar / (moments.mass * float((weights[:, None] * arms**2).sum()))
    # Eq. 241
    outside = min(max(0.0, 0.5 * (spread - 1.0)), 1.0)
    reach = math.sqrt(min(1.0, spread)) * arms
    rings = [centre + np.array([[0.0, 0.0], [dx, 0.0], [dx, dy], [0.0, dy]]) for dx, dy in reach.tolist()]
    return rings, corners, moments.mass * weights * np.array([[1.0 - outside], [outside]])


@dataclass(frozen=True, slots=True, eq=False)
class SolidMoments:
    """Zeroth, first and central second moments of a 3D mass distribution."""

    mass: float  # integral of dm [kg], or of dV [m3] for a bare shape
    centre: FloatArray  # centre of mass [m]; shape (3,)
    second: FloatArray  # integral of (S - centre)(S - centre)^T dm [kg m2]; shape (3, 3)

    @property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the centre of mass, ``tr(J) 1 - J`` with J the second moments [kg m2]."""
        return _inertia(self.second)

    def times(self, weight: float) -> "SolidMoments":
        """Return the moments of the shape with `weight` times the mass."""
        return SolidMoments(self.mass * weight, self.centre, self.second * weight)

    def placed(self, rotation: FloatArray, translation: FloatArray) -> "SolidMoments":
        """Return the moments after a rotation [-] and then a translation [m]."""
        return SolidMoments(
            self.mass, applied(rotation, self.centre) + translation, times(times(rotation, self.second), rotation.T)
        )

    def second_about(self, point: FloatArray) -> FloatArray:
        """Return the integral of ``(S - point)(S - point)^T dm`` (parallel axes) [kg m2]."""
        arm = self.centre - point
        return self.second + self.mass * np.outer(arm, arm)

    def inertia_about(self, point: FloatArray) -> FloatArray:
        """Return the inertia tensor about a point [kg m2]."""
        return _inertia(self.second_about(point))


def _inertia(second: FloatArray) -> FloatArray:
    tensor: FloatArray = float(np.trace(second)) * np.eye(3) - second
    return tensor


def combined(parts: Iterable[SolidMoments]) -> SolidMoments:
    """Return the sum of the moments of parts; holes have negative mass."""
    listed = list(parts)
    masses = np.array([moments.mass for moments in listed])
    centres = np.array([moments.centre for moments in listed])
    mass = float(masses.sum())
    centre = (masses[:, None] * centres).sum(axis=0) / mass
    second = np.sum([moments.second_about(centre) for moments in listed], axis=0)
    return SolidMoments(mass, centre, second)


def polyhedron_moments(triangles: FloatArray) -> SolidMoments:
    """Return exact moments of the volume inside a closed surface of triangles, by the divergence theorem."""
    # The density is 1. The origin is the middle of the bounding box to prevent cancellation. Each triangle (a, b, c)
    # and the origin form a tetrahedron of signed volume V = a.(b x c)/6 and second moments
    # V/20 (a a^T + b b^T + c c^T + s s^T) with s = a + b + c. Outward faces are counter-clockwise and count positive.
    middle = np.array([0.5 * (triangles[..., i].min() + triangles[..., i].max()) for i in range(3)])
    a, b, c = np.moveaxis(triangles - middle, 1, 0)
    volumes = (a * np.cross(b, c)).sum(axis=1) / 6.0
    volume = float(volumes.sum())
    total = a + b + c
    if volume == 0.0:
        return SolidMoments(0.0, middle, np.zeros((3, 3)))
    centre = (volumes[:, None] * total).sum(axis=0) / (4.0 * volume)
    second = sum(gram(v, volumes / 20.0) for v in (a, b, c, total))
    return SolidMoments(volume, middle + centre, second - volume * np.outer(centre, centre))
