"""Vectors of three and quaternions as tuples: plain sums and products, in the order in which C++ will have them."""

import math

Vector = tuple[float, float, float]
Frame = tuple[Vector, Vector, Vector]
"""A matrix by its rows; of an attitude the axes of the ground, in axes of the body."""

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
    """Return a multiple."""
    return s * a[0], s * a[1], s * a[2]


def added(a: Vector, s: float, b: Vector) -> Vector:
    """Return a vector and a multiple of another one."""
    return a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]


def length(a: Vector) -> float:
    """Return the length."""
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def unit(a: Vector) -> Vector:
    """Return the direction; zero of a vector without length."""
    size = length(a)
    return scaled(1.0 / size, a) if size > 0.0 else ZERO


def applied(m: Frame, a: Vector) -> Vector:
    """Return a matrix times a vector: of an attitude, from axes of the body to those of the ground."""
    return dot(m[0], a), dot(m[1], a), dot(m[2], a)


def back(m: Frame, a: Vector) -> Vector:
    """Return the transpose of a matrix times a vector: of an attitude, from axes of the ground to those of the body."""
    return (
        m[0][0] * a[0] + m[1][0] * a[1] + m[2][0] * a[2],
        m[0][1] * a[0] + m[1][1] * a[1] + m[2][1] * a[2],
        m[0][2] * a[0] + m[1][2] * a[1] + m[2][2] * a[2],
    )


def frame(q: tuple[float, ...]) -> Frame:
    """Return the rotation of a unit quaternion (s, x, y, z), from axes of the body to those of the ground."""
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
