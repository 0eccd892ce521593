"""The ground, a plane that may be tilted or bounded, and its acceleration. Vectors and quaternions are tuples."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking import checks, conventions
from rocking.dynamics.rolling.ground import SpatialGround, ground_of

Vector = tuple[float, float, float]
Frame = tuple[Vector, Vector, Vector]
"""Rows of a matrix. The matrix of an attitude has the axes of the ground in body axes as rows."""

ZERO: Vector = (0.0, 0.0, 0.0)


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def plus(a: Vector, b: Vector) -> Vector:
    """Return the sum."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    """Return the difference."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def scaled(s: float, a: Vector) -> Vector:
    """Return s times a vector."""
    return s * a[0], s * a[1], s * a[2]


def added(a: Vector, s: float, b: Vector) -> Vector:
    """Return the sum of the vector a and s times the vector b."""
    return a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]


def length(a: Vector) -> float:
    """Return the length."""
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def unit(a: Vector) -> Vector:
    """Return the unit vector along a vector; a zero vector remains zero."""
    size = length(a)
    return scaled(1.0 / size, a) if size > 0.0 else ZERO


def applied(m: Frame, a: Vector) -> Vector:
    """Return a matrix times a vector. An attitude converts a vector from body axes to axes of the ground."""
    return dot(m[0], a), dot(m[1], a), dot(m[2], a)


def back(m: Frame, a: Vector) -> Vector:
    """Return the transpose of a matrix times a vector.

    For an attitude, this converts from axes of the ground to body axes.
    """
    return (
        m[0][0] * a[0] + m[1][0] * a[1] + m[2][0] * a[2],
        m[0][1] * a[0] + m[1][1] * a[1] + m[2][1] * a[2],
        m[0][2] * a[0] + m[1][2] * a[1] + m[2][2] * a[2],
    )


def frame(q: tuple[float, ...]) -> Frame:
    """Return the rotation matrix of a unit quaternion (s, x, y, z), from body axes to axes of the ground."""
    s, x, y, z = q
    return (
        (s * s + x * x - y * y - z * z, 2.0 * (x * y - s * z), 2.0 * (x * z + s * y)),  # Eq. 79
        (2.0 * (x * y + s * z), s * s - x * x + y * y - z * z, 2.0 * (y * z - s * x)),
        (2.0 * (x * z - s * y), 2.0 * (y * z + s * x), s * s - x * x - y * y + z * z),
    )


def product(p: tuple[float, ...], q: tuple[float, ...]) -> tuple[float, float, float, float]:
    """Return the Hamilton product of two quaternions."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],  # Eq. 80
        p[0] * q[1] + q[0] * p[1] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] + q[0] * p[2] + p[3] * q[1] - p[1] * q[3],
        p[0] * q[3] + q[0] * p[3] + p[1] * q[2] - p[2] * q[1],
    )


def normalised(q: tuple[float, ...]) -> tuple[float, ...]:
    """Return a quaternion with unit length."""
    size = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return tuple(c / size for c in q)


@dataclass(frozen=True, eq=False)
class HullGround:
    """Plane under a body, and its motion."""

    x: Any = None  # x, y, vertical: GroundMotion, pulse or None, in level axes [m/s2]
    y: Any = None
    vertical: Any = None
    slope: float = 0.0  # angle of the plane from the horizontal [rad]
    azimuth: float = 0.0  # direction of descent, from x towards y [rad]
    # half sizes of the plane along its two axes; there is no contact at its edges and beyond; None for an
    # infinite plane [m]
    shelf: tuple[float, float] | None = None
    gravity: float = conventions.g  # [m/s2]
    motion: SpatialGround = field(init=False, repr=False)  # the three components, with common segments of time
    level: Frame = field(init=False, repr=False)  # level axes to axes of the plane

    def __post_init__(self) -> None:
        checks.within("slope", self.slope, 0.0, 0.5 * math.pi, unit="rad", open_high=True)
        checks.within("gravity", self.gravity, 0.0, 1e6, unit="m/s2", open_low=True)
        object.__setattr__(self, "motion", ground_of(self.x, self.y, self.vertical))
        c, s, cc, ss = math.cos(self.azimuth), math.sin(self.azimuth), math.cos(self.slope), math.sin(self.slope)
        # rotation about the horizontal line normal to the direction of descent
        rows: Frame = (
            (c * c * cc + s * s, c * s * (cc - 1.0), -c * ss),
            (c * s * (cc - 1.0), s * s * cc + c * c, -s * ss),
            (c * ss, s * ss, cc),
        )
        object.__setattr__(self, "level", rows)

    @classmethod
    def placed(cls, motion: SpatialGround, level: Any, shelf: Any, gravity: float) -> "HullGround":
        """Return a ground from its motion, its axes (9 numbers) and the half sizes of its shelf (inf: no shelf)."""
        ends = float(shelf[0]), float(shelf[1])
        ground = cls(shelf=None if ends == (math.inf, math.inf) else ends, gravity=gravity)
        object.__setattr__(ground, "motion", motion)
        a, b, c = (tuple(map(float, row)) for row in np.reshape(level, (3, 3)))
        object.__setattr__(ground, "level", (a, b, c))
        return ground

    @property
    def weight(self) -> Vector:
        """Gravity, in axes of the plane [m/s2]."""
        return applied(self.level, (0.0, 0.0, -self.gravity))

    def field(self, stretch: int, start: float, span: float) -> list[Vector]:
        """Return gravity minus ground acceleration in plane axes, as a polynomial of the time divided by `span`."""
        rows = self.motion.segment(stretch, start, span)
        vectors = []
        for k in range(rows.shape[1]):
            a = applied(self.level, (float(rows[0, k]), float(rows[1, k]), float(rows[2, k])))
            vectors.append(minus(self.weight if k == 0 else (0.0, 0.0, 0.0), a))
        return vectors

    def under(self, position: Vector) -> bool:
        """Return True if a point is above the ground, within the shelf."""
        return self.shelf is None or self.inside(position) >= 0.0

    def inside(self, position: Vector) -> float:
        """Return the distance of a point from the nearest edge of the shelf; negative beyond the shelf [m]."""
        assert self.shelf is not None
        return min(self.shelf[0] - abs(position[0]), self.shelf[1] - abs(position[1]))
