"""Mass, centre and second moments of plane parts, and how parts add up."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray


@dataclass(frozen=True, slots=True)
class PlaneMoments:
    """Zeroth, first and central second moments of a plane mass distribution."""

    mass: float  # integral of dm [kg], or of dA [m2] for a bare ring; negative for a hole
    x: float  # x, y: centre [m]
    y: float
    xx: float  # xx, yy: integrals of (x - centre)**2 dm and of (y - centre)**2 dm [kg m2]
    yy: float

    @property
    def polar(self) -> float:
        """Polar moment about the centre [kg m2]."""
        return self.xx + self.yy

    def times(self, weight: float) -> "PlaneMoments":
        """Return the same shape with `weight` times the mass.

        Returns scaled mass and second moments, same centre.
        """
        return PlaneMoments(self.mass * weight, self.x, self.y, self.xx * weight, self.yy * weight)


def ring_moments(ring: FloatArray) -> PlaneMoments:
    """Exact moments of the area inside a closed ring of straight edges (Green's theorem).

    The ring is moved to the middle of its own box first, so that nothing cancels far from the origin.

    ring: vertices [m], the first one not repeated; counter-clockwise gives a positive area.
    """
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


def combined(parts: Iterable[PlaneMoments]) -> PlaneMoments:
    """Moments of several parts together (parallel-axis theorem); holes have negative mass."""
    m, x, y, xx, yy = np.array([(p.mass, p.x, p.y, p.xx, p.yy) for p in parts]).T
    mass = float(m.sum())
    cx, cy = float((m * x).sum()) / mass, float((m * y).sum()) / mass
    return PlaneMoments(mass, cx, cy, float((xx + m * (x - cx) ** 2).sum()), float((yy + m * (y - cy) ** 2).sum()))
