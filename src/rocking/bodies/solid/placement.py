"""Rotations of parts: from an axis and an angle, and what is refused as one."""

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.solid.shape import vector
from rocking.conventions import FloatArray
from rocking.errors import GeometryError
from rocking.portable import norm, times

_ORTHOGONAL = 1e-9


def rotation_about(axis: ArrayLike, angle: float) -> FloatArray:
    """Return the rotation about an axis through the origin (Rodrigues).

    Parameters
    ----------
    axis : array_like, shape (3,)
        Direction of the axis, of any length [-].
    angle : float
        Angle, counter-clockwise seen against the axis [rad].

    Returns
    -------
    ndarray, shape (3, 3)
        Rotation matrix [-].

    Raises
    ------
    GeometryError
        If the axis has no direction.

    Examples
    --------
    >>> rotation_about([0, 0, 1], np.pi / 2).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    direction = vector("axis", axis, "-")
    size = norm(np.asarray(direction))
    if size == 0.0:
        raise GeometryError("axis must have a direction, got (0, 0, 0)")
    turn = checks.number("angle", angle, "rad")
    cross = np.cross(direction / size, np.eye(3)).T
    result: FloatArray = np.eye(3) + np.sin(turn) * cross + (1.0 - np.cos(turn)) * times(cross, cross)
    return result


def rotation_matrix(value: ArrayLike | None) -> FloatArray:
    """Return `value` as a rotation matrix.

    value: the matrix; None is no rotation [-].
    """
    if value is None:
        return np.eye(3)
    matrix = checks.real_array("rotation", value)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise GeometryError("rotation must be a finite 3 x 3 matrix")
    if np.abs(matrix @ matrix.T - np.eye(3)).max() > _ORTHOGONAL or np.linalg.det(matrix) < 0.0:
        raise GeometryError(
            "rotation must be a rotation matrix: orthogonal, without a mirror; rotation_about makes one"
        )
    return matrix.copy()
