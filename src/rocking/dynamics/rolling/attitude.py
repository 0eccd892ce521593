"""Attitudes as unit quaternions (s, x, y, z), from body axes to axes of the ground (x and y horizontal, z up)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.portable import applied, dot, each, norm

Rows = list[list[Any]]


def rows_of(products: Sequence[Sequence[Any]]) -> Rows:
    """Return the rotation matrix from the products of the components of a quaternion."""
    (ss, sx, sy, sz), (_, xx, xy, xz), (_, _, yy, yz), (_, _, _, zz) = products
    return [
        [ss + xx - yy - zz, 2.0 * (xy - sz), 2.0 * (xz + sy)],  # Eq. 79
        [2.0 * (xy + sz), ss - xx + yy - zz, 2.0 * (yz - sx)],
        [2.0 * (xz - sy), 2.0 * (yz + sx), ss - xx - yy + zz],
    ]


_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def cross(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the vector product. For single vectors, this function is faster than numpy."""
    if left.ndim == right.ndim == 1:
        (a, b, c), (x, y, z) = left.tolist(), right.tolist()
        return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
    return np.asarray(left[..., _NEXT] * right[..., _LAST] - left[..., _LAST] * right[..., _NEXT])


def matrix(quaternion: FloatArray) -> FloatArray:
    """Return the rotation matrices of unit quaternions (s, x, y, z), from body axes to axes of the ground [-]."""
    q = quaternion.tolist() if quaternion.ndim == 1 else list(np.moveaxis(quaternion, -1, 0))
    rotation: FloatArray = np.array(rows_of([[a * b for b in q] for a in q]))
    return rotation if quaternion.ndim == 1 else np.moveaxis(rotation, (0, 1), (-2, -1))


def vertical(quaternion: FloatArray) -> FloatArray:
    """Return the vertical in body axes, the last row of `matrix` [-]."""
    s, x, y, z = quaternion.tolist()
    return np.array([2.0 * (x * z - s * y), 2.0 * (y * z + s * x), s * s - x * x - y * y + z * z])


def turn(axis: FloatArray | list[float], angle: float) -> FloatArray:
    """Return the unit quaternion of a right-handed rotation [rad] about an axis of any length."""
    unit = np.asarray(axis, dtype=np.float64)
    unit = unit / norm(unit)
    return np.concatenate([[math.cos(0.5 * angle)], math.sin(0.5 * angle) * unit])


def product(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the Hamilton product: the rotation `right` followed by the rotation `left`, both in axes of the ground."""
    scalar = left[0] * right[0] - dot(left[1:], right[1:])  # Eq. 80
    return np.concatenate([[scalar], left[0] * right[1:] + right[0] * left[1:] + cross(left[1:], right[1:])])


def normalised(quaternion: FloatArray) -> FloatArray:
    """Return a quaternion with unit length."""
    return np.asarray(quaternion / norm(quaternion))


def flat(quaternion: FloatArray) -> FloatArray:
    """Return the attitude of a body on its full base, by removing a tilt below half a turn."""
    return normalised(np.array([quaternion[0], 0.0, 0.0, quaternion[3]]))


def levelled(quaternion: FloatArray, axis: FloatArray) -> FloatArray:
    """Return an attitude after the smallest rotation that makes a nearly horizontal body axis horizontal."""
    direction = applied(matrix(quaternion), axis)
    rise = float(direction[2])
    if rise == 0.0:
        return quaternion
    level = math.sqrt(1.0 - rise * rise)
    half = math.sqrt(0.5 * (1.0 + level))  # cosine of half the angle; the sine of half the angle is rise / (2 half)
    back = -rise / (2.0 * half * level) * np.array([direction[1], -direction[0], 0.0])
    return normalised(product(np.concatenate([[half], back]), quaternion))


def tilt(quaternion: FloatArray) -> FloatArray:
    """Return the tilts, the angles between the axis of the body and the vertical, from 0 to pi [rad]."""
    s, x, y, z = np.moveaxis(quaternion, -1, 0)
    return 2.0 * each(math.atan2, np.sqrt(x * x + y * y), np.sqrt(s * s + z * z))  # Eq. 81


def azimuth(quaternion: FloatArray) -> FloatArray:
    """Return the directions of tilt, from x towards y, in (-pi, pi]; zero without tilt [rad]."""
    s, x, y, z = np.moveaxis(quaternion, -1, 0)
    return each(math.atan2, y * z - s * x, x * z + s * y)  # Eq. 82


@dataclass(frozen=True)
class SpatialStart:
    """Initial state of a 3D body. A value out of range causes an error status of the history.

    Parameters
    ----------
    tilt : float
        Angle between the axis of the body and the vertical [rad].
    azimuth : float
        Direction of the tilt, from x towards y [rad].
    yaw : float
        Rotation about the vertical, before the tilt [rad].
    angular_velocity : tuple of float
        Angular velocity in axes of the ground [rad/s].
    height : float
        Height of the lowest point above the ground [m].
    velocity : tuple of float
        Velocity of the lowest point, in axes of the ground [m/s].

    Notes
    -----
    Without friction, `height` and `velocity` must be zero, because the body does not slide or fly.

    Examples
    --------
    >>> SpatialStart(tilt=0.1).quaternion.round(4).tolist()
    [0.9988, 0.0, 0.05, 0.0]
    >>> SpatialStart(tilt=0.1).rocks_alone, SpatialStart(height=0.02).rocks_alone
    (True, False)
    """

    tilt: float = 0.0
    azimuth: float = 0.0
    yaw: float = 0.0
    angular_velocity: Any = (0.0, 0.0, 0.0)
    height: float = 0.0
    velocity: Any = (0.0, 0.0, 0.0)

    @property
    def valid(self) -> bool:
        """True if the numbers are finite and within their ranges."""
        rates = [np.asarray(vector, dtype=np.float64) for vector in (self.angular_velocity, self.velocity)]
        numbers = [self.tilt, self.azimuth, self.yaw, self.height]
        return bool(
            all(vector.shape == (3,) and np.isfinite(vector).all() for vector in rates)
            and all(math.isfinite(value) for value in numbers)
            and 0.0 <= self.tilt < 0.5 * math.pi
            and self.height >= 0.0
        )

    @property
    def rocks_alone(self) -> bool:
        """True if the lowest point is at rest on the ground, as for a body without friction."""
        return not (self.height or np.any(self.velocity))

    @property
    def numbers(self) -> list[float]:
        """All values of the initial state, in the order of the parameters."""
        spin, velocity = (np.ravel(vector).tolist() for vector in (self.angular_velocity, self.velocity))
        return [self.tilt, self.azimuth, self.yaw, *spin, self.height, *velocity]

    def check_grounded(self) -> None:
        """Raise an error for a start with height or velocity of the lowest point."""
        if not self.rocks_alone:
            raise InvalidValueError(
                "height and velocity of the start must be 0 without friction=, got {height} m and {velocity} m/s; "
                "give friction= for sliding and flight", height=f"{self.height!r:.30}",
                velocity=f"{self.velocity!r:.60}",
            )  # fmt: skip

    @property
    def quaternion(self) -> FloatArray:
        """Attitude as a quaternion, from body axes to axes of the ground, shape (4,) [-]."""
        tilting = turn([-math.sin(self.azimuth), math.cos(self.azimuth), 0.0], self.tilt)
        return product(tilting, turn([0.0, 0.0, 1.0], self.yaw))

    @property
    def body_velocity(self) -> FloatArray:
        """Angular velocity in body axes, shape (3,) [rad/s]."""
        return applied(matrix(self.quaternion).T, np.asarray(self.angular_velocity, dtype=np.float64))
