r"""Rolling of a round base on its rim without slip, one Taylor step at a time.

With Z the vertical in body axes, n the direction of its horizontal part there and h one over the length of that part
(the sine of the tilt), the lowest point of the rim is s = -b n, and rho = C - s changes as the body rolls:

    I_s w' = -w x I_s w - m rho x (w x rho') + m rho x R^T G,     rho' = b n',
    n' = h (t . Z') t,   h' = -h^2 (n . Z'),   Z' = Z x w,   t = (-n_y, n_x),

where I_s is the inertia about the contact (angular momentum about the centre of mass; for a cylinder these are the
equations of Srinivasan and Ruina 2008). Everything is a product of series again, but for one linear solution an order.
The place of the contact on the ground follows from P' = -b R n'.
"""

from collections.abc import Iterable
from itertools import zip_longest
from operator import mul

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space.attitude import matrix
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.pivot_motion import carried, turned
from rocking.portable import inverse, norm

Terms = list[float]


def _term(left: Terms, right: Terms, k: int) -> float:
    """Coefficient k of the product of two series."""
    return float(sum(map(mul, left, right[k::-1])))


def _back(vector: list[Terms], k: int) -> list[Terms]:
    """Components from the power k downwards."""
    return [series[k::-1] for series in vector]


def _crossed(left: list[Terms], right: list[Terms], k: int) -> list[float]:
    """Coefficient k of the vector product of two series."""
    (a, b, c), (x, y, z) = left, _back(right, k)
    return [
        sum(map(mul, b, z)) - sum(map(mul, c, y)),
        sum(map(mul, c, x)) - sum(map(mul, a, z)),
        sum(map(mul, a, y)) - sum(map(mul, b, x)),
    ]


def _add(series: list[Terms], terms: Iterable[float]) -> None:
    for component, term in zip(series, terms, strict=True):
        component.append(term)


class _Series:
    """The series of one step, a list for every component, filled in order by order."""

    def __init__(self, state: tuple[FloatArray, FloatArray, FloatArray], field: FloatArray) -> None:
        def empty(count: int) -> list[Terms]:
            return [[] for _ in range(count)]

        self.q, self.w, self.place = ([[x] for x in part.tolist()] for part in state)
        self.level = [[[x] for x in row] for row in matrix(state[0])[:2].tolist()]
        first = [[x] for x in carried(state[0], field)]
        self.up, self.field = first[:3], [first[i : i + 3] for i in range(3, len(first), 3)]
        sine = norm(np.array(self.up[:2]).ravel())
        self.n, self.h = [[x[0] / sine] for x in self.up[:2]], [1.0 / sine]
        self.rate_up, self.bend = empty(3), empty(2)
        self.slip, self.drift, self.falling, self.h2 = empty(4)
        self.arm, self.arm_rate, self.speed, self.momentum, self.weight = (empty(3) for _ in range(5))
        self.inertia, self.spin = [empty(3) for _ in range(3)], empty(3)


class RollingFlow:
    """Rolling of a round base."""

    def __init__(self, body: SpatialBody) -> None:
        self.body = body

    def series(
        self,
        state: tuple[FloatArray, FloatArray, FloatArray],
        length: float,
        field: FloatArray,
        order: int,
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return the Taylor series of a step: attitude, velocity, vertical, and place of contact on the ground (2,)."""
        s = _Series(state, field)
        for k in range(order):
            self._contact(s, k)
            self._dynamics(s, k)
            self._advance(s, k, length / (k + 1))
        return np.array(s.q).T, np.array(s.w).T, np.array(s.up).T, np.array(s.place).T

    def _advance(self, s: _Series, k: int, share: float) -> None:
        """Add the next power of everything that has a rate."""
        fall, traced = self._flattening(s, k), self._traced(s, k)
        back = _back(s.w, k)
        _add(s.q, turned([[sum(map(mul, series, part)) for part in back] for series in s.q], share))
        for row in s.level:
            _add(row, [share * part for part in _crossed(row, s.w, k)])
        _add(s.up, [share * rate[k] for rate in s.rate_up])
        for vector, more in zip_longest(s.field, s.field[1:]):
            follows = [series[k] / (k + 1) for series in more] if more else (0.0, 0.0, 0.0)
            _add(vector, [share * part + by for part, by in zip(_crossed(vector, s.w, k), follows, strict=True)])
        _add(s.w, [share * spin[k] for spin in s.spin])
        _add([*s.n, s.h], [share * s.bend[0][k], share * s.bend[1][k], -share * fall])
        _add(s.place, [-share * self.body.radius * part for part in traced])  # Eq. 100

    def _contact(self, s: _Series, k: int) -> None:
        """How fast the lowest point moves along the rim."""
        radius, centre = self.body.radius, self.body.centre.tolist() if k == 0 else (0.0, 0.0, 0.0)
        _add(s.rate_up, _crossed(s.up, s.w, k))
        (nx, ny), (x, y) = s.n, _back(s.rate_up[:2], k)
        # Eq. 99
        s.slip.append(sum(map(mul, nx, y)) - sum(map(mul, ny, x)))  # t . Z'
        s.falling.append(sum(map(mul, nx, x)) + sum(map(mul, ny, y)))  # n . Z'
        s.drift.append(_term(s.slip, s.h, k))
        _add(s.bend, [-_term(s.n[1], s.drift, k), _term(s.n[0], s.drift, k)])
        _add(s.arm, [radius * s.n[0][k] + centre[0], radius * s.n[1][k] + centre[1], centre[2]])
        _add(s.arm_rate, [radius * s.bend[0][k], radius * s.bend[1][k], 0.0])

    @staticmethod
    def _flattening(s: _Series, k: int) -> float:
        """Coefficient k of h^2 (n . Z')."""
        s.h2.append(_term(s.h, s.h, k))
        return _term(s.h2, s.falling, k)

    @staticmethod
    def _traced(s: _Series, k: int) -> list[float]:
        """Coefficient k of the horizontal part of R n'."""
        return [_term(row[0], s.bend[0], k) + _term(row[1], s.bend[1], k) for row in s.level]

    def _dynamics(self, s: _Series, k: int) -> None:
        """Angular acceleration."""
        mass, inertia = self.body.mass, self.body.inertia.tolist()
        w, own = [series[k] for series in s.w], inertia if k == 0 else [[0.0] * 3] * 3
        _add(s.speed, _crossed(s.w, s.arm, k))
        swept = _crossed(s.arm, s.speed, k)
        _add(s.momentum, [sum(map(mul, row, w)) + mass * part for row, part in zip(inertia, swept, strict=True)])
        # m rho x (R^T G - w x rho')
        shed = _crossed(s.w, s.arm_rate, k)
        _add(s.weight, [force[k] - part for force, part in zip(s.field[0], shed, strict=True)])
        x, y, z = s.arm
        xx, yy, zz, yz, xz, xy = (_term(a, b, k) for a, b in ((x, x), (y, y), (z, z), (y, z), (x, z), (x, y)))
        for row, base, steiner in zip(
            s.inertia, own, ((yy + zz, -xy, -xz), (-xy, xx + zz, -yz), (-xz, -yz, xx + yy)), strict=True
        ):
            _add(row, [a + mass * b for a, b in zip(base, steiner, strict=True)])
        if k == 0:
            self.solve = inverse(np.array(s.inertia)[:, :, 0]).tolist()
        # what earlier accelerations take of the inertia that changes
        earlier = _back(s.spin, k)
        taken = [
            sum(map(mul, a[1:], u)) + sum(map(mul, b[1:], v)) + sum(map(mul, c[1:], w))
            for (a, b, c), (u, v, w) in ((row, earlier) for row in s.inertia)
        ]
        pull, turn = _crossed(s.arm, s.weight, k), _crossed(s.w, s.momentum, k)
        torque = [mass * a - b - c for a, b, c in zip(pull, turn, taken, strict=True)]  # Eq. 23
        _add(s.spin, [sum(map(mul, row, torque)) for row in self.solve])
