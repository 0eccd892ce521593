r"""Rolling of a round base on its rim without slip, one Taylor step at a time.

With Z the vertical in body axes, n the direction of its horizontal part there and h one over the length of that part
(the sine of the tilt), the lowest point of the rim is s = -b n, and rho = C - s changes as the body rolls:

    I_s w' = -w x I_s w - m rho x (w x rho') + m rho x R^T G,     rho' = b n',
    n' = h (t . Z') t,   h' = -h^2 (n . Z'),   Z' = Z x w,   t = (-n_y, n_x),

where I_s is the inertia about the contact (angular momentum about the centre of mass; for a cylinder these are the
equations of Srinivasan and Ruina 2008). Everything is a product of series again, but for one linear solution an order.
The place of the contact on the ground follows from P' = -b R n'.
"""

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.spatial.attitude import ROTATION_MAP
from rocking.dynamics.spatial.flow import CROSS, RATE_MAP
from rocking.dynamics.spatial.rocker import SpatialBody

_CROSS = CROSS.reshape(3, 9)
_UP = ROTATION_MAP[2]
_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


def _sum(left: FloatArray, right: FloatArray, k: int) -> FloatArray:
    """Coefficient k of the product of two series of vectors: every component with every other."""
    return np.asarray(left[: k + 1].T @ right[k::-1])


def _crossed(left: FloatArray, right: FloatArray, k: int) -> FloatArray:
    return np.asarray(_CROSS @ _sum(left, right, k).ravel())


class _Series:
    """The series of one step, filled in order by order."""

    def __init__(self, order: int) -> None:
        def rows(*shape: int) -> FloatArray:
            return np.zeros((order + 1, *shape))

        self.q, self.w, self.squares, self.up = rows(4), rows(3), rows(16), rows(3)
        self.n, self.h, self.place = rows(2), rows(1), rows(2)
        self.rate_up, self.slip, self.bend = rows(3), rows(1), rows(2)
        self.arm, self.arm_rate, self.speed, self.momentum = rows(3), rows(3), rows(3), rows(3)
        self.drift, self.weight, self.rotation = rows(3), rows(3), rows(3, 3)
        self.inertia, self.spin = rows(3, 3), rows(3)


class RollingFlow:
    """Rolling of a round base.

    Parameters
    ----------
    body : SpatialBody
        With a round base.
    """

    def __init__(self, body: SpatialBody) -> None:
        self.body = body

    def series(
        self,
        state: tuple[FloatArray, FloatArray, FloatArray],
        length: float,
        field: FloatArray,
        order: int,
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return the Taylor series of a step, over a unit of time that is the step.

        Parameters
        ----------
        state : tuple of ndarray
            Attitude (4,) [-], angular velocity in body axes (3,) [rad/s], place of the contact on the ground (2,) [m].
        length : float
            Duration of the step [s].
        field : ndarray, shape (3, degree + 1)
            Gravity less the acceleration of the ground over the step, coefficients by power [m/s2].
        order : int
            Highest power.

        Returns
        -------
        quaternions, velocities, squares, places : ndarray
            Coefficients by power; shapes (order + 1, 4), (order + 1, 3), (order + 1, 16), (order + 1, 2).
        """
        s = _Series(order)
        s.q[0], s.w[0], s.place[0] = state
        level = (_UP @ np.outer(s.q[0], s.q[0]).ravel())[:2]
        sine = float(np.hypot(*level))
        s.n[0], s.h[0] = level / sine, 1.0 / sine
        for k in range(order + 1):
            s.squares[k] = _sum(s.q, s.q, k).ravel()
            s.up[k], s.rotation[k] = _UP @ s.squares[k], (ROTATION_MAP @ s.squares[k])
            if k == order:
                break
            self._contact(s, k)
            self._dynamics(s, k, field)
            step = length / (k + 1)
            s.q[k + 1] = step * (RATE_MAP @ _sum(s.q, s.w, k).ravel())
            s.w[k + 1] = step * s.spin[k]
            s.n[k + 1], s.h[k + 1] = step * s.bend[k], step * -self._flattening(s, k)
            s.place[k + 1] = -step * self.body.radius * self._traced(s, k)
        return s.q, s.w, s.squares, s.place

    def _contact(self, s: _Series, k: int) -> None:
        """How fast the lowest point moves along the rim."""
        s.rate_up[k] = _crossed(s.up, s.w, k)
        sideways = _sum(s.n, s.rate_up[:, :2], k)
        s.slip[k] = sideways[0, 1] - sideways[1, 0]  # t . Z'
        s.bend[k] = _TURN @ _sum(s.n, self._scaled(s, k), k)[:, 0]
        s.arm[k, :2] = self.body.radius * s.n[k]
        if k == 0:
            s.arm[0] += self.body.centre
        s.arm_rate[k, :2] = self.body.radius * s.bend[k]

    @staticmethod
    def _scaled(s: _Series, k: int) -> FloatArray:
        """Series of h (t . Z') up to order k."""
        s.drift[k, 0] = _sum(s.slip, s.h, k)[0, 0]
        return np.asarray(s.drift[:, :1])

    @staticmethod
    def _flattening(s: _Series, k: int) -> FloatArray:
        """Coefficient k of h^2 (n . Z')."""
        s.drift[k, 1] = _sum(s.h, s.h, k)[0, 0]
        s.drift[k, 2] = np.trace(_sum(s.n, s.rate_up[:, :2], k))
        return np.asarray(_sum(s.drift[:, 1:2], s.drift[:, 2:3], k)[0])

    @staticmethod
    def _traced(s: _Series, k: int) -> FloatArray:
        """Coefficient k of the horizontal part of R n'."""
        return np.asarray(sum(s.rotation[j, :2, :2] @ s.bend[k - j] for j in range(k + 1)))

    def _dynamics(self, s: _Series, k: int, field: FloatArray) -> None:
        """Angular acceleration."""
        body = self.body
        s.speed[k] = _crossed(s.w, s.arm, k)
        s.momentum[k] = body.inertia @ s.w[k] + body.mass * _crossed(s.arm, s.speed, k)
        for j in range(min(k, field.shape[1] - 1) + 1):
            s.weight[k] += s.rotation[k - j].T @ field[:, j]
        # m rho x (R^T G - w x rho')
        s.weight[k] -= _crossed(s.w, s.arm_rate, k)
        outer = _sum(s.arm, s.arm, k)
        s.inertia[k] = body.mass * (np.trace(outer) * np.eye(3) - outer)
        torque = body.mass * _crossed(s.arm, s.weight, k) - _crossed(s.w, s.momentum, k)
        if k == 0:
            s.inertia[0] += body.inertia
            self.solve = np.linalg.inv(s.inertia[0])
        for j in range(1, k + 1):
            torque -= s.inertia[j] @ s.spin[k - j]
        s.spin[k] = self.solve @ torque
