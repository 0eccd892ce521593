"""Taylor steps of a body that turns about a fixed point or edge, and of a round base that rolls on its rim.

In body axes, every term is a product of a series and the angular velocity. A rolling rim needs one linear solution per
order. Additions have a fixed order and do not use BLAS, so that results are equal on all processors.
"""

from collections.abc import Iterable, Sequence
from itertools import zip_longest
from operator import mul

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.rolling.attitude import matrix
from rocking.dynamics.rolling.body import SpatialBody
from rocking.portable import applied, dot, inverse, norm, powers


def cross_of(products: Sequence[Sequence[float]]) -> list[float]:
    """Return the vector product of two vectors, or a term of its series, from products of their components."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = products
    return [yz - zy, zx - xz, xy - yx]


def turned(products: Sequence[Sequence[float]], factor: float) -> list[float]:
    """Return a term of the rate of a quaternion, q (0, w) / 2."""
    (sx, sy, sz), (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = products
    half = 0.5 * factor
    return [-half * (xx + yy + zz), half * (sx + yz - zy), half * (sy + zx - xz), half * (sz + xy - yx)]  # Eq. 22


def carried(quaternion: FloatArray, field: FloatArray) -> list[float]:
    """Return the vertical, the field G and the derivatives of G in body axes at the start of a step."""
    # these vectors rotate backwards, v' = v x w; a derivative of G contains the next lower derivative
    back, factorials = matrix(quaternion).T, np.multiply.accumulate([1.0, *range(1, field.shape[1])])
    vectors = [back[:, 2], *[applied(back, g) for g in (field * factorials).T]]
    return [float(x) for vector in vectors for x in vector.tolist()]


class PivotFlow:
    """Motion about a fixed point of the body [m], or about a horizontal axis through this point; in body axes."""

    def __init__(self, body: SpatialBody, pivot: FloatArray, axis: FloatArray | None = None) -> None:
        inertia = body.inertia_about(pivot)
        about = None if axis is None else np.outer(axis, axis) / dot(axis, applied(inertia, axis))
        self.mobility = inverse(inertia) if about is None else about
        self.gyroscopic = inertia  # inertia for the term w x I w
        self.arm = body.mass * (body.centre - pivot)

    def series(
        self, quaternion: FloatArray, velocity: FloatArray, length: float, field: FloatArray, order: int
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the Taylor series of a step: quaternions, velocities (order + 1, 4), vertical (order + 1, 3)."""
        inertia, mobility, (x, y, z) = self.gyroscopic.tolist(), self.mobility.tolist(), self.arm.tolist()
        w, state = velocity.tolist(), [*quaternion.tolist(), *carried(quaternion, field)]
        rows = np.zeros((order + 1, 6 + len(state)))
        for k in range(order + 1):
            rows[k] = [*w, *[sum(map(mul, row, w)) for row in inertia], *state]
            if k == order:
                break
            # term k of the products of w with I w, q, the vertical, G and the derivatives of G
            products = np.add.reduce(rows[: k + 1, 3:, None] * rows[k::-1, None, :3], axis=0).tolist()
            (gx, gy, gz), (fx, fy, fz), factor = cross_of(products[:3]), state[7:10], length / (k + 1)
            torque = [gx + y * fz - z * fy, gy + z * fx - x * fz, gz + x * fy - y * fx]  # Eq. 22
            w = [factor * sum(map(mul, row, torque)) for row in mobility]
            across = [component for i in range(7, len(products), 3) for component in cross_of(products[i : i + 3])]
            derivatives = [0.0, 0.0, 0.0, *state[10:], 0.0, 0.0, 0.0]
            state = turned(products[3:7], factor)
            state += [
                factor * component + derivative / (k + 1)
                for component, derivative in zip(across, derivatives, strict=True)
            ]
        return rows[:, 6:10], rows[:, :3], rows[:, 10:13]


def terms_needed(rate: float, most: int) -> int:
    """Return the number of terms of an exponential series that are above rounding.

    `rate` is the rate of change times the length of the step [-].

    >>> terms_needed(0.01, 30), terms_needed(1.0, 30)
    (8, 20)
    """
    term, k = 1.0, 0
    while term > 1e-18 and k < most:
        k += 1
        term *= rate / k
    return max(min(k, most), min(6, most))


def trusted_part(quaternions: FloatArray, velocities: FloatArray, length: float, tolerance: float) -> float:
    """Return the fraction of a step over which the last two terms are below a tolerance (0 if not finite)."""
    if not (np.isfinite(quaternions).all() and np.isfinite(velocities).all()):
        return 0.0
    fraction, last = 1.0, len(quaternions) - 1
    spin = max(1.0, length * float(np.abs(velocities[0]).max()))
    for k in (last - 1, last):
        size = max(float(np.abs(quaternions[k]).max()), length * float(np.abs(velocities[k]).max()) / spin)
        if size > tolerance:
            fraction = min(fraction, (tolerance / size) ** (1.0 / k))  # Eq. 52
    return fraction


def value(series: FloatArray, at: float) -> FloatArray:
    """Return the value of series of vectors."""
    if at == 1.0:
        return np.asarray(series[::-1].sum(axis=0))
    return np.asarray((powers(at, len(series))[:, None] * series)[::-1].sum(axis=0))


def stretched(series: FloatArray, fraction: float) -> FloatArray:
    """Return series over a fraction of their unit of time, with this fraction as the new unit."""
    return series if fraction == 1.0 else series * powers(fraction, len(series))[:, None]


Terms = list[float]


def _term(left: Terms, right: Terms, k: int) -> float:
    """Return coefficient k of the product of two series."""
    return float(sum(map(mul, left, right[k::-1])))


def _back(vector: list[Terms], k: int) -> list[Terms]:
    """Return the coefficients of every component, from power k down to power 0."""
    return [series[k::-1] for series in vector]


def _crossed(left: list[Terms], back: list[Terms]) -> list[float]:
    """Return a coefficient of the vector product of two series, from the second series by `_back`."""
    (a, b, c), (x, y, z) = left, back
    return [
        sum(map(mul, b, z)) - sum(map(mul, c, y)),
        sum(map(mul, c, x)) - sum(map(mul, a, z)),
        sum(map(mul, a, y)) - sum(map(mul, b, x)),
    ]


def _add(series: list[Terms], terms: Iterable[float]) -> None:
    for component, term in zip(series, terms, strict=True):
        component.append(term)


class _Series:
    """Series of one step: one list per component, extended one order at a time."""

    def __init__(self, state: tuple[FloatArray, FloatArray, FloatArray], field: FloatArray) -> None:
        def empty(count: int) -> list[Terms]:
            return [[] for _ in range(count)]

        self.q, self.w, self.ground_point = ([[x] for x in component.tolist()] for component in state)
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
        """Return the Taylor series of a step: attitude, velocity, vertical, and contact point on the ground (2,)."""
        s = _Series(state, field)
        for k in range(order):
            back = _back(s.w, k)
            self._contact(s, k, back)
            self._dynamics(s, k)
            self._advance(s, k, length / (k + 1), back)
        return np.array(s.q).T, np.array(s.w).T, np.array(s.up).T, np.array(s.ground_point).T

    def _advance(self, s: _Series, k: int, factor: float, back: list[Terms]) -> None:
        """Add the next power of all integrated series."""
        fall, traced = self._flattening(s, k), self._traced(s, k)
        _add(s.q, turned([[sum(map(mul, series, term)) for term in back] for series in s.q], factor))
        for row in s.level:
            _add(row, [factor * term for term in _crossed(row, back)])
        _add(s.up, [factor * rate[k] for rate in s.rate_up])
        for vector, derivative in zip_longest(s.field, s.field[1:]):
            derivatives = [series[k] / (k + 1) for series in derivative] if derivative else (0.0, 0.0, 0.0)
            _add(
                vector,
                [
                    factor * term + increment
                    for term, increment in zip(_crossed(vector, back), derivatives, strict=True)
                ],
            )
        _add(s.w, [factor * spin[k] for spin in s.spin])
        _add([*s.n, s.h], [factor * s.bend[0][k], factor * s.bend[1][k], -factor * fall])
        _add(s.ground_point, [-factor * self.body.radius * term for term in traced])  # Eq. 100

    def _contact(self, s: _Series, k: int, back: list[Terms]) -> None:
        """Add the terms of the motion of the lowest point along the rim."""
        radius, centre = self.body.radius, self.body.centre.tolist() if k == 0 else (0.0, 0.0, 0.0)
        _add(s.rate_up, _crossed(s.up, back))
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
        """Return coefficient k of h^2 (n . Z')."""
        s.h2.append(_term(s.h, s.h, k))
        return _term(s.h2, s.falling, k)

    @staticmethod
    def _traced(s: _Series, k: int) -> list[float]:
        """Return coefficient k of the horizontal components of R n'."""
        return [_term(row[0], s.bend[0], k) + _term(row[1], s.bend[1], k) for row in s.level]

    def _dynamics(self, s: _Series, k: int) -> None:
        """Add the terms of the angular acceleration."""
        mass, inertia = self.body.mass, self.body.inertia.tolist()
        w, body_inertia = [series[k] for series in s.w], inertia if k == 0 else [[0.0] * 3] * 3
        _add(s.speed, _crossed(s.w, _back(s.arm, k)))
        swept = _crossed(s.arm, _back(s.speed, k))
        _add(s.momentum, [sum(map(mul, row, w)) + mass * term for row, term in zip(inertia, swept, strict=True)])
        # m rho x (R^T G - w x rho')
        shed = _crossed(s.w, _back(s.arm_rate, k))
        _add(s.weight, [force[k] - term for force, term in zip(s.field[0], shed, strict=True)])
        x, y, z = s.arm
        xx, yy, zz, yz, xz, xy = (_term(a, b, k) for a, b in ((x, x), (y, y), (z, z), (y, z), (x, z), (x, y)))
        for row, base, steiner in zip(
            s.inertia, body_inertia, ((yy + zz, -xy, -xz), (-xy, xx + zz, -yz), (-xz, -yz, xx + yy)), strict=True
        ):
            _add(row, [a + mass * b for a, b in zip(base, steiner, strict=True)])
        if k == 0:
            self.solve = inverse(np.array(s.inertia)[:, :, 0]).tolist()
        # coupling of lower-order accelerations with the variable inertia
        earlier = _back(s.spin, k)
        coupling = [
            sum(map(mul, a[1:], u)) + sum(map(mul, b[1:], v)) + sum(map(mul, c[1:], w))
            for (a, b, c), (u, v, w) in ((row, earlier) for row in s.inertia)
        ]
        pull, turn = _crossed(s.arm, _back(s.weight, k)), _crossed(s.w, _back(s.momentum, k))
        torque = [mass * a - b - c for a, b, c in zip(pull, turn, coupling, strict=True)]  # Eq. 23
        _add(s.spin, [sum(map(mul, row, torque)) for row in self.solve])
