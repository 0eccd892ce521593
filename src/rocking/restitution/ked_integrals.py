"""The integral of KED, Int y^4 / |S - O'|^2 dm: closed form for rectangles, boundary sum for polygons."""

import math

import numpy as np

from rocking.conventions import BoolArray, FloatArray
from rocking.portable import each, gauss_legendre

# Below this slenderness the closed form loses more than two digits and the series is summed instead.
_SERIES_BELOW = 0.3
_SERIES = np.array([(-1.0) ** j / ((2 * j - 1) * (2 * j + 3)) for j in range(14, 0, -1)])
# Edges whose end angles differ little are summed by Gauss-Legendre: the closed form would cancel.
_NODES, _WEIGHTS = gauss_legendre(12)
_GAUSS_BEYOND = 5.0
_FEW = 256


def fill_rectangles(ratio: FloatArray, least: float, out: FloatArray) -> None:
    """Write KED's coefficients of homogeneous rectangles (Eq. 17, Mao et al. 2024, in closed form).

    ``r^2 = N/D`` with ``N/B^4 = l^3/12 - l/4 + atan(l)/4 + (l^4/4) atan(1/l)`` and ``D/B^4 = l (1 + l^2)/3``.

    ratio: slenderness ratios l = h/b > 0 [-]; least: the least of them, or less [-]; out: of the same shape; receives
    r, relative error below 3e-14 [-].
    """
    # N/D in partial fractions, t = 1/l: r^2 = 1/4 + (3 pi t/8 - 1) / (1 + l^2) + 3/4 atan(t) (l - t)
    t = np.divide(1.0, ratio, out=np.empty(ratio.shape))
    np.subtract(ratio, t, out=out)
    # numpy's own arctan is quick; the last digit of many at once hangs on the processor
    room = each(math.atan, t) if t.size <= _FEW else np.arctan(t, out=np.empty(ratio.shape))
    with np.errstate(over="ignore", invalid="ignore"):
        out *= room
        out *= 0.75
        np.multiply(ratio, ratio, out=room)
        room += 1.0
        t *= 0.375 * np.pi
        t -= 1.0
        t /= room
        out += t
        out += 0.25  # Eq. 7; Eq. 17, Mao et al. 2024
        np.sqrt(out, out=out)
    if least < _SERIES_BELOW:
        squat = ratio < _SERIES_BELOW
        out[squat] = _series(ratio[squat])


def _series(t: FloatArray) -> FloatArray:
    # N/B^4 = pi l^4/8 - l^5/5 + l^7/21 - l^9/45 + ...
    t2 = t * t
    return np.sqrt(3.0 * t * t2 * (np.pi / 8.0 + np.polyval(_SERIES, t2) * t) / (1.0 + t2))  # Eq. 7


def ring_integral(ring: FloatArray) -> float:
    """Return the exact integral of y^4 / (x^2 + y^2) over the area inside a ring.

    By Green's theorem it is a quarter of the integral of y^4 d(phi) along the boundary, phi the polar angle: an
    elementary integral for every straight edge.

    ring: vertices about the new foot [m]; counter-clockwise counts positive. Returns the integral [m4].
    """
    start, end = ring, np.roll(ring, -1, axis=0)
    length = np.sqrt(np.square(end - start).sum(axis=1))
    tau = (end - start) / length[:, None]
    offset = tau[:, 1] * start[:, 0] - tau[:, 0] * start[:, 1]
    u0, u1 = (tau * start).sum(axis=1), (tau * end).sum(axis=1)
    radial = np.abs(offset) <= 1e-300
    smooth = ~radial & _is_smooth(offset, u0, u1)
    sharp = ~(radial | smooth)
    total = _by_gauss(*(values[smooth] for values in (start[:, 1], end[:, 1], offset, u0, u1)))
    total += _by_formula(*(values[sharp] for values in (tau[:, 0], tau[:, 1], offset, u0, u1)))
    return 0.25 * total  # Eq. 8


def _is_smooth(offset: FloatArray, u0: FloatArray, u1: FloatArray) -> BoolArray:
    # size of the Bernstein ellipse through the pole u = i * offset; 12 nodes err by its power -24
    z = (1j * np.abs(offset) - 0.5 * (u0 + u1)) / (0.5 * (u1 - u0))
    root = np.sqrt(z * z - 1.0)
    return np.maximum(np.abs(z + root), np.abs(z - root)) > _GAUSS_BEYOND


def _by_gauss(y0: FloatArray, y1: FloatArray, offset: FloatArray, u0: FloatArray, u1: FloatArray) -> float:
    share = 0.5 * (1.0 + _NODES)[:, None]
    y = y0 + (y1 - y0) * share
    u = u0 + (u1 - u0) * share
    integrand = (y * y) ** 2 * offset / (offset**2 + u**2)
    return float((0.5 * (u1 - u0) * (_WEIGHTS[:, None] * integrand).sum(axis=0)).sum())


def _by_formula(c_x: FloatArray, c: FloatArray, p: FloatArray, u0: FloatArray, u1: FloatArray) -> float:
    # y = s p + c u along the edge, with s = -tau_x and c = tau_y
    s, c2, s2, p2 = -c_x, c * c, c_x * c_x, p * p
    powers = (
        c2 * c2 * p * (u1 - u0) * (u0 * u0 + u0 * u1 + u1 * u1) / 3.0
        + 2.0 * c2 * c * s * p2 * (u1 - u0) * (u1 + u0)
        + (6.0 * c2 * s2 - c2 * c2) * p2 * p * (u1 - u0)
    )
    logs = 2.0 * c * s * (s2 - c2) * p2 * p2 * each(math.log, (p2 + u1 * u1) / (p2 + u0 * u0))
    turn = each(math.atan2, p * (u1 - u0), p2 + u0 * u1)
    angles = (s2 * s2 - 6.0 * c2 * s2 + c2 * c2) * p2 * p2 * turn
    return float((powers + logs + angles).sum())  # Eq. 114
