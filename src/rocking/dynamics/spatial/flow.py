r"""The motion of a body about a fixed point or a fixed edge, one Taylor step at a time.

With the pivot A fixed on the ground, ``rho`` from A to the centre of mass in body axes, and G(t) gravity less the
acceleration of the ground in axes of the ground,

    q' = q (0, w) / 2,      I_A w' + w x I_A w = rho x m R(q)^T G(t)

(Euler's equations about a fixed point); about an edge e the same projected on e. R is quadratic in q, so every term
is a product of series, and the coefficients follow from one another by sums of products alone (Cauchy). A step is
three small matrix products and three linear maps an order, which is all that another engine has to copy.
"""

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.spatial.attitude import ROTATION_MAP
from rocking.dynamics.spatial.rocker import SpatialBody

CROSS = np.zeros((3, 3, 3))
"""(a x b)_i = CROSS[i, j, k] a_j b_k."""
for _i in range(3):
    CROSS[_i, (_i + 1) % 3, (_i + 2) % 3] = 1.0
    CROSS[_i, (_i + 2) % 3, (_i + 1) % 3] = -1.0


def _rate_map() -> FloatArray:
    """Return the map from the products q_i w_j to q'."""
    made = np.zeros((4, 4, 3))
    made[0, 1:, :] = -0.5 * np.eye(3)
    made[1:, 0, :] = 0.5 * np.eye(3)
    made[1:, 1:, :] = 0.5 * CROSS
    return made.reshape(4, 12)


RATE_MAP = _rate_map()
"""The rate of a quaternion as a linear map of the twelve products with the angular velocity in body axes."""


class PivotFlow:
    """Motion about a fixed point of the body, or about an axis through it.

    Parameters
    ----------
    body : SpatialBody
        The body.
    pivot : ndarray, shape (3,)
        The fixed point, in body axes [m].
    axis : ndarray, shape (3,), optional
        Unit vector of a fixed axis, in body axes and horizontal [-].
    """

    def __init__(self, body: SpatialBody, pivot: FloatArray, axis: FloatArray | None = None) -> None:
        inertia = body.inertia_about(pivot)
        mobility = np.linalg.inv(inertia) if axis is None else np.outer(axis, axis) / (axis @ inertia @ axis)
        arm = body.mass * (body.centre - pivot)
        # products of w with w, and of q with q, to w'
        self.gyroscopic = -np.einsum("oi,ijk,kl->ojl", mobility, CROSS, inertia).reshape(3, 9)
        self.weight = np.einsum("oi,ijk,j,akm->oam", mobility, CROSS, arm, ROTATION_MAP)

    def series(
        self, quaternion: FloatArray, velocity: FloatArray, length: float, field: FloatArray, order: int
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the Taylor series of a step, over a unit of time that is the step.

        Parameters
        ----------
        quaternion : ndarray, shape (4,)
            Attitude at the start [-].
        velocity : ndarray, shape (3,)
            Angular velocity in body axes at the start [rad/s].
        length : float
            Duration of the step [s].
        field : ndarray, shape (3, degree + 1)
            Gravity less the acceleration of the ground over the step, coefficients by power [m/s2].
        order : int
            Highest power.

        Returns
        -------
        quaternions, velocities : ndarray, shape (order + 1, 4) and (order + 1, 3)
            Coefficients by power.
        squares : ndarray, shape (order + 1, 16)
            Coefficients of the products of the quaternion with itself.
        """
        maps = length * np.einsum("oam,aj->jom", self.weight, field)
        gyroscopic, rate = length * self.gyroscopic, length * RATE_MAP
        q, w, squares = np.zeros((order + 1, 4)), np.zeros((order + 1, 3)), np.zeros((order + 1, 16))
        q[0], w[0] = quaternion, velocity
        degree = field.shape[1] - 1
        for k in range(order + 1):
            before, back = slice(k + 1), slice(k, None, -1)
            squares[k] = (q[before].T @ q[back]).ravel()
            if k == order:
                break
            spin = gyroscopic @ (w[before].T @ w[back]).ravel()
            for j in range(min(k, degree) + 1):
                spin += maps[j] @ squares[k - j]
            q[k + 1] = rate @ (q[before].T @ w[back]).ravel() / (k + 1)
            w[k + 1] = spin / (k + 1)
        return q, w, squares


def terms_needed(rate: float, most: int) -> int:
    """Return how many terms of an exponential series of a rate are above rounding.

    Parameters
    ----------
    rate : float
        Rate of change times the length of the step [-].
    most : int
        Never more than these.

    Returns
    -------
    int
        Order of a Taylor step.

    Examples
    --------
    >>> terms_needed(0.01, 30), terms_needed(1.0, 30)
    (8, 20)
    """
    term, k = 1.0, 0
    while term > 1e-18 and k < most:
        k += 1
        term *= rate / k
    return max(min(k, most), min(6, most))


def trusted_part(quaternions: FloatArray, velocities: FloatArray, length: float, tolerance: float) -> float:
    """Return the part of a step over which the last two terms of its series stay below a tolerance.

    Parameters
    ----------
    quaternions, velocities : ndarray, shape (order + 1, 4) and (order + 1, 3)
        Coefficients by power.
    length : float
        Duration of the step [s].
    tolerance : float
        For quaternions of unit length [-].

    Returns
    -------
    float
        From 0, where a coefficient is not finite, to 1.
    """
    if not (np.isfinite(quaternions).all() and np.isfinite(velocities).all()):
        return 0.0
    part, last = 1.0, len(quaternions) - 1
    spin = max(1.0, length * float(np.abs(velocities[0]).max()))
    for k in (last - 1, last):
        size = max(float(np.abs(quaternions[k]).max()), length * float(np.abs(velocities[k]).max()) / spin)
        if size > tolerance:
            part = min(part, (tolerance / size) ** (1.0 / k))
    return part


def value(series: FloatArray, at: float) -> FloatArray:
    """Return the value of series of vectors.

    Parameters
    ----------
    series : ndarray, shape (order + 1, n)
        Coefficients by power.
    at : float
        Where, from 0 to 1.

    Returns
    -------
    ndarray, shape (n,)
        The value.
    """
    if at == 1.0:
        return np.asarray(series[::-1].sum(axis=0))
    return np.asarray(at ** np.arange(len(series)) @ series)


def stretched(series: FloatArray, part: float) -> FloatArray:
    """Return series over a part of their unit of time as series over a unit.

    Parameters
    ----------
    series : ndarray, shape (order + 1, n)
        Coefficients by power.
    part : float
        The part.

    Returns
    -------
    ndarray
        Coefficients by power.
    """
    return series if part == 1.0 else series * (part ** np.arange(len(series)))[:, None]
