r"""The motion of a body about a fixed point or a fixed edge, one Taylor step at a time.

With the pivot A fixed on the ground, ``rho`` from A to the centre of mass in body axes, and G(t) gravity less the
acceleration of the ground in axes of the ground,

    q' = q (0, w) / 2,      I_A w' + w x I_A w = rho x m R(q)^T G(t)

(Euler's equations about a fixed point); about an edge e the same projected on e. In body axes the vertical and G turn
backwards, Z' = Z x w and F' = F x w + R^T G', so every term is a product of series with w, and the coefficients follow
from one another by sums of products alone (Cauchy): added in their own order, not by BLAS, so that a history is the
same on every processor.
"""

from collections.abc import Sequence
from operator import mul

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space.attitude import matrix
from rocking.dynamics.space.body import SpatialBody
from rocking.portable import applied, dot, inverse, powers


def cross_of(products: Sequence[Sequence[float]]) -> list[float]:
    """Return the vector product of two vectors, or a term of its series, from the products of their components."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = products
    return [yz - zy, zx - xz, xy - yx]


def turned(products: Sequence[Sequence[float]], share: float) -> list[float]:
    """Return a term of q (0, w) / 2, the rate of a quaternion."""
    (sx, sy, sz), (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = products
    half = 0.5 * share
    return [-half * (xx + yy + zz), half * (sx + yz - zy), half * (sy + zx - xz), half * (sz + xy - yx)]  # Eq. 22


def carried(quaternion: FloatArray, field: FloatArray) -> list[float]:
    """Return the vertical, G and its derivatives in body axes at the start of a step."""
    # they turn backwards, v' = v x w, and each derivative of G changes by what the one before does as well
    back, factorials = matrix(quaternion).T, np.multiply.accumulate([1.0, *range(1, field.shape[1])])
    vectors = [back[:, 2], *[applied(back, g) for g in (field * factorials).T]]
    return [float(x) for vector in vectors for x in vector.tolist()]


class PivotFlow:
    """Motion about a fixed point of the body [m], or about a fixed horizontal axis through it, both in body axes."""

    def __init__(self, body: SpatialBody, pivot: FloatArray, axis: FloatArray | None = None) -> None:
        inertia = body.inertia_about(pivot)
        about = None if axis is None else np.outer(axis, axis) / dot(axis, applied(inertia, axis))
        self.mobility = inverse(inertia) if about is None else about
        self.gyroscopic = inertia  # the angular momentum of w x I w
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
            # term k of the products with w of I w, q, the vertical, G and its derivatives
            made = np.add.reduce(rows[: k + 1, 3:, None] * rows[k::-1, None, :3], axis=0).tolist()
            (gx, gy, gz), (fx, fy, fz), share = cross_of(made[:3]), state[7:10], length / (k + 1)
            torque = [gx + y * fz - z * fy, gy + z * fx - x * fz, gz + x * fy - y * fx]  # Eq. 22
            w = [share * sum(map(mul, row, torque)) for row in mobility]
            across = [part for i in range(7, len(made), 3) for part in cross_of(made[i : i + 3])]
            follows = [0.0, 0.0, 0.0, *state[10:], 0.0, 0.0, 0.0]
            state = turned(made[3:7], share)
            state += [share * part + more / (k + 1) for part, more in zip(across, follows, strict=True)]
        return rows[:, 6:10], rows[:, :3], rows[:, 10:13]


def terms_needed(rate: float, most: int) -> int:
    """Return how many terms of an exponential series of a rate are above rounding.

    rate: rate of change times the length of the step [-].

    >>> terms_needed(0.01, 30), terms_needed(1.0, 30)
    (8, 20)
    """
    term, k = 1.0, 0
    while term > 1e-18 and k < most:
        k += 1
        term *= rate / k
    return max(min(k, most), min(6, most))


def trusted_part(quaternions: FloatArray, velocities: FloatArray, length: float, tolerance: float) -> float:
    """Return the part of a step, 0 (not finite) to 1, over which the last two terms stay below a tolerance."""
    if not (np.isfinite(quaternions).all() and np.isfinite(velocities).all()):
        return 0.0
    part, last = 1.0, len(quaternions) - 1
    spin = max(1.0, length * float(np.abs(velocities[0]).max()))
    for k in (last - 1, last):
        size = max(float(np.abs(quaternions[k]).max()), length * float(np.abs(velocities[k]).max()) / spin)
        if size > tolerance:
            part = min(part, (tolerance / size) ** (1.0 / k))  # Eq. 52
    return part


def value(series: FloatArray, at: float) -> FloatArray:
    """Return the value of series of vectors."""
    if at == 1.0:
        return np.asarray(series[::-1].sum(axis=0))
    return np.asarray((powers(at, len(series))[:, None] * series)[::-1].sum(axis=0))


def stretched(series: FloatArray, part: float) -> FloatArray:
    """Return series over a part of their unit of time as series over a unit."""
    return series if part == 1.0 else series * powers(part, len(series))[:, None]
