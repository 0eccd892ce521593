"""Free rocking between two impacts in closed form: how long it takes, how high it goes, where it is meanwhile.

`y` is the speed after an impact over the one that would just overturn the body, `alpha` the slenderness angle over the
foot on which it stands; times are multiplied by the frequency parameter p.
"""

import numpy as np
from scipy.special import ellipj, elliprd, elliprf

from rocking.conventions import FloatArray


def overturning_speed(alpha: FloatArray) -> FloatArray:
    """Return the angular velocity over p from which a body just overturns [-]."""
    return np.asarray(2.0 * np.sin(0.5 * alpha))  # Eq. 264


def duration(y: FloatArray, alpha: FloatArray) -> FloatArray:
    """Return p T, T the time from one impact to the next [-].

    >>> round(float(duration(np.array(0.8), np.array(1e-9)) - 2.0 * np.arctanh(0.8)), 12)
    0.0
    """
    return np.asarray(2.0 * y * elliprf(*_arguments(y, alpha)))  # Eq. 265


def duration_and_slopes(y: FloatArray, alpha: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return p T, its derivative by ln y at the same alpha, and that by alpha at the same y."""
    a, b, c = _arguments(y, alpha)
    q, s2 = 1.0 - y * y, np.sin(0.5 * alpha) ** 2
    by_a, by_b, by_c = -elliprd(b, c, a) / 6.0, -elliprd(a, c, b) / 6.0, -elliprd(a, b, c) / 6.0
    found = 2.0 * y * elliprf(a, b, c)
    by_y = (s2 - 1.0) * by_a + (s2 * q - c) * by_b + s2 * by_c  # over 2 y
    by_s2 = -q * (by_a + q * by_b + by_c)
    return found, found + 4.0 * y**3 * by_y, y * np.sin(alpha) * by_s2


def speed(taken: FloatArray, alpha: FloatArray) -> FloatArray:
    """Return y, from p T: the inverse of `duration`."""
    goal = np.log(np.asarray(taken, dtype=np.float64))
    y = np.tanh(0.5 * np.exp(goal))
    for _ in range(30):
        found, slope, _ = duration_and_slopes(y, alpha)
        # in ln T over atanh y, in which it is nearly straight
        step = (np.log(found) - goal) * found / slope * y / (1.0 - y * y)
        y = np.tanh(np.maximum(np.arctanh(y) - step, 0.5 * np.arctanh(y)))
        if np.all(np.abs(step) <= 1e-14 * np.arctanh(y)):
            break
    return np.asarray(y)


def peak(y: FloatArray, alpha: FloatArray) -> FloatArray:
    """Return the largest rotation until the next impact [rad]."""
    s = np.sin(0.5 * alpha)
    return np.asarray(alpha - 2.0 * np.arcsin(s * np.sqrt(1.0 - y * y)))  # Eq. 266


def rotation(since: FloatArray, y: FloatArray, alpha: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return rotation [rad] and angular velocity over p [-]; since: p times the time since the impact."""
    low = np.sin(0.5 * alpha) * np.sqrt(1.0 - y * y)  # of half the angle at the highest point
    m = 1.0 - low * low
    sn, _, dn, _ = ellipj(since - 0.5 * duration(y, alpha), m)
    return alpha - 2.0 * np.arcsin(np.minimum(low / dn, 1.0)), -2.0 * low * np.sqrt(m) * sn / dn  # Eq. 267


def viscous_loss(y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return by how much ln y falls until the next impact for each unit of the damping ratio, of slender bodies.

    Also its derivative by ln y; y is the geometric mean of those at both ends.
    """
    small = y < 0.05
    z = np.where(small, 0.5, y)
    exact = 2.0 * (z - (1.0 - z * z) * np.arctanh(z)) / (z * z)  # Eq. 268
    slope = 4.0 * (np.arctanh(z) - z) / (z * z)
    return np.where(small, 4.0 * y / 3.0 + 4.0 * y**3 / 15.0, exact), np.where(small, 4.0 * y / 3.0 + 0.8 * y**3, slope)


def _arguments(y: FloatArray, alpha: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    q, s2 = 1.0 - y * y, np.sin(0.5 * alpha) ** 2
    m = 1.0 - s2 * q
    return (1.0 - s2) * q, m * q, m
