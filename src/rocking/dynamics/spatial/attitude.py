"""Attitudes as unit quaternions (s, x, y, z): body axes to axes of the ground, x and y horizontal, z up."""

import math

import numpy as np

from rocking.conventions import FloatArray


def _rotation_map() -> FloatArray:
    """R[a, b] = sum of map[a, b, i, j] q_i q_j, homogeneous of degree two."""
    made = np.zeros((3, 3, 4, 4))
    for a in range(3):
        for i in range(4):
            made[a, a, i, i] = 1.0 if i in {0, a + 1} else -1.0
        b, c = (a + 1) % 3, (a + 2) % 3
        for row, column, other, sign in ((a, b, c, -1.0), (a, c, b, 1.0)):
            made[row, column, row + 1, column + 1] = 2.0
            made[row, column, 0, other + 1] = 2.0 * sign
    return made.reshape(3, 3, 16)


ROTATION_MAP = _rotation_map()
"""The rotation matrix as a linear map of the sixteen products of two components of a quaternion."""


_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def cross(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the vector product, at a fraction of the cost of numpy's for single vectors.

    Parameters
    ----------
    left, right : ndarray, shape (..., 3)
        Vectors.

    Returns
    -------
    ndarray, shape (..., 3)
        Their product.
    """
    return np.asarray(left[..., _NEXT] * right[..., _LAST] - left[..., _LAST] * right[..., _NEXT])


def matrix(quaternion: FloatArray) -> FloatArray:
    """Return the rotation matrices of quaternions.

    Parameters
    ----------
    quaternion : ndarray, shape (..., 4)
        Unit quaternions (s, x, y, z) [-].

    Returns
    -------
    ndarray, shape (..., 3, 3)
        Body axes to axes of the ground [-].

    Examples
    --------
    >>> matrix(turn([0.0, 0.0, 1.0], 0.5 * math.pi)).round(12)[:, 0].tolist()  # a quarter turn takes x to y
    [0.0, 1.0, 0.0]
    """
    products = np.einsum("...i,...j->...ij", quaternion, quaternion).reshape(*quaternion.shape[:-1], 16)
    return np.asarray(np.einsum("abm,...m->...ab", ROTATION_MAP, products))


def turn(axis: FloatArray | list[float], angle: float) -> FloatArray:
    """Return the quaternion of a rotation about an axis.

    Parameters
    ----------
    axis : array_like, shape (3,)
        Any length above zero [-].
    angle : float
        By the right hand [rad].

    Returns
    -------
    ndarray, shape (4,)
        Unit quaternion [-].
    """
    unit = np.asarray(axis, dtype=np.float64) / np.linalg.norm(axis)
    return np.concatenate([[math.cos(0.5 * angle)], math.sin(0.5 * angle) * unit])


def product(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the rotation `right` followed by the rotation `left`, both in axes of the ground.

    Parameters
    ----------
    left, right : ndarray, shape (4,)
        Unit quaternions [-].

    Returns
    -------
    ndarray, shape (4,)
        Their Hamilton product [-].
    """
    scalar = left[0] * right[0] - left[1:] @ right[1:]
    return np.concatenate([[scalar], left[0] * right[1:] + right[0] * left[1:] + cross(left[1:], right[1:])])


def normalised(quaternion: FloatArray) -> FloatArray:
    """Return a quaternion of unit length.

    Parameters
    ----------
    quaternion : ndarray, shape (4,)
        Not zero [-].

    Returns
    -------
    ndarray, shape (4,)
        Of unit length [-].
    """
    return np.asarray(quaternion / math.sqrt(float(quaternion @ quaternion)))


def flat(quaternion: FloatArray) -> FloatArray:
    """Return the attitude of a body on its whole base: what is left of an attitude without its tilt.

    Parameters
    ----------
    quaternion : ndarray, shape (4,)
        Attitude, tilted by less than half a turn [-].

    Returns
    -------
    ndarray, shape (4,)
        Turned about the vertical only [-].
    """
    return normalised(np.array([quaternion[0], 0.0, 0.0, quaternion[3]]))


def levelled(quaternion: FloatArray, axis: FloatArray) -> FloatArray:
    """Return an attitude turned by the least angle so that an axis of the body is horizontal.

    Parameters
    ----------
    quaternion : ndarray, shape (4,)
        Attitude [-].
    axis : ndarray, shape (3,)
        Unit vector in body axes, nearly horizontal [-].

    Returns
    -------
    ndarray, shape (4,)
        Attitude [-].
    """
    direction = matrix(quaternion) @ axis
    rise = float(direction[2])
    if rise == 0.0:
        return quaternion
    upwards = np.array([direction[1], -direction[0], 0.0])  # turns the axis towards the vertical
    return normalised(product(turn(upwards, -math.asin(rise)), quaternion))


def tilt(quaternion: FloatArray) -> FloatArray:
    """Return the angles between the axis of the body and the vertical.

    Parameters
    ----------
    quaternion : ndarray, shape (..., 4)
        Attitudes [-].

    Returns
    -------
    ndarray
        Tilt, from 0 to pi [rad].

    Examples
    --------
    >>> round(float(tilt(turn([1.0, 1.0, 0.0], 0.3))), 12)
    0.3
    """
    s, x, y, z = np.moveaxis(quaternion, -1, 0)
    return np.asarray(2.0 * np.arctan2(np.hypot(x, y), np.hypot(s, z)))


def azimuth(quaternion: FloatArray) -> FloatArray:
    """Return the directions in which bodies lean: of the horizontal part of their axis.

    Parameters
    ----------
    quaternion : ndarray, shape (..., 4)
        Attitudes [-].

    Returns
    -------
    ndarray
        From x towards y, in (-pi, pi]; zero for a body that does not lean [rad].
    """
    s, x, y, z = np.moveaxis(quaternion, -1, 0)
    return np.asarray(np.arctan2(y * z - s * x, x * z + s * y))
