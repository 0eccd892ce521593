"""Linear filters and elementary functions with the same bits on every processor.

The approximations of exp, log, sin and cos in NumPy and the C library depend on the processor, but sums and products do
not. Therefore, these functions use sums and products only. The compiled module computes the same sums and products in
the same order, and computes recurrences about 100 times as fast. The functions return the same bits without the
compiled module. (`rocking.portable` has such functions for matrices.)
"""

import math
from functools import cache
from types import ModuleType

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray

_INVERSE = tuple(1.0 / math.factorial(k) for k in range(19))
_LOG2 = (6.93147180369123816490e-01, 1.90821492927058770002e-10)
_HALF_PI = (1.57079632673412561417e00, 6.07710050650619224932e-11)
_LANES = 4
NEIGHBOURS = 10  # number of oscillators excited by one impulse; the compiled module has the same constant
MIN_CYCLES = 1e-6  # smallest corner frequency of the high pass [cycles per step], to limit rounding errors


@cache
def compiled() -> ModuleType | None:
    """Return the compiled module; None if it was not built."""
    try:
        from rocking.motions import _filters
    except ImportError:
        return None
    return _filters


def exponential(x: FloatArray) -> FloatArray:
    """Return the exponential function, accurate to about one unit in the last place."""
    if (module := compiled()) is not None:
        out = np.empty(x.shape)
        module.exponentials(x.ravel(), out.ravel())
        return out
    inside = np.minimum(np.maximum(x, -708.0), 709.0)
    k = np.rint(inside * 1.44269504088896338700e00)
    r = (inside - k * _LOG2[0]) - k * _LOG2[1]
    p = np.full_like(r, _INVERSE[13])
    for n in range(12, -1, -1):
        p = p * r + _INVERSE[n]
    return np.where(x < -708.0, 0.0, np.ldexp(p, k.astype(np.int32)))


def logarithm(x: FloatArray) -> FloatArray:
    """Return the natural logarithm, accurate to about one unit in the last place."""
    if (module := compiled()) is not None:
        out = np.empty(x.shape)
        module.logarithms(x.ravel(), out.ravel())
        return out
    m, exponent = np.frexp(x)
    small = m < 0.70710678118654752440
    m, e = np.where(small, 2.0 * m, m), (exponent - small).astype(np.float64)
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    p = np.full_like(s, 2.0 / 23.0)
    for n in range(21, 0, -2):
        p = p * z + 2.0 / n
    return np.where(x >= np.finfo(np.float64).tiny, e * _LOG2[0] + (s * p + e * _LOG2[1]), -np.inf)


def geometric(low: FloatArray | float, high: FloatArray | float, count: int) -> FloatArray:
    """Return numbers with equal ratios along the last axis. Bits of `numpy.geomspace` depend on the processor.

    >>> geometric(1.0, 100.0, 3).round(12).tolist()
    [1.0, 10.0, 100.0]
    """
    first, last = np.broadcast_arrays(np.asarray(low, dtype=np.float64), np.asarray(high, dtype=np.float64))
    span = (logarithm(last) - logarithm(np.maximum(first, np.finfo(np.float64).tiny)))[..., None]
    x = np.linspace(0.0, 1.0, count)
    nearest = np.where(x < 0.5, first[..., None], last[..., None])  # avoids an overflow of the ratio of both ends
    result = nearest * exponential(span * np.where(x < 0.5, x, x - 1.0))
    result[..., :1], result[..., -1:] = first[..., None], last[..., None] if count > 1 else first[..., None]
    return np.asarray(result)


def cosine_sine(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return cosine and sine, for arguments up to about 1000 turns [rad]."""
    if (module := compiled()) is not None:
        c, s = np.empty(x.shape), np.empty(x.shape)
        module.cosines_sines(x.ravel(), c.ravel(), s.ravel())
        return c, s
    k = np.rint(x * 6.36619772367581382433e-01)
    r = (x - k * _HALF_PI[0]) - k * _HALF_PI[1]
    z = r * r
    c, s = np.full_like(r, _INVERSE[18]), np.full_like(r, _INVERSE[17])
    for n in range(16, -1, -2):
        c = _INVERSE[n] - c * z
    for n in range(15, 0, -2):
        s = _INVERSE[n] - s * z
    s = s * r
    quarter = k.astype(np.int64) & 3
    return np.choose(quarter, [c, -s, -c, s]), np.choose(quarter, [s, c, -s, -c])


def recurrence(
    move: FloatArray, start: tuple[float, float], first: FloatArray, second: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return two states over time. Every step multiplies the states by a matrix and adds an input.

    >>> turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    >>> [x.tolist() for x in recurrence(turn, (1.0, 0.0), np.array([0.5, 0.0]), np.zeros(2))]
    [[1.0, 0.5, -1.0], [0.0, 1.0, 0.5]]
    """
    ((m00, m01), (m10, m11)), (a, b) = move.tolist(), start
    if (module := compiled()) is not None:
        z, v = np.empty(first.size + 1), np.empty(first.size + 1)
        z[0], v[0] = start
        module.recurrence(m00, m01, m10, m11, np.ascontiguousarray(first), np.ascontiguousarray(second), z, v)
        return z, v
    states = [(a, b)]
    for p, q in zip(first.tolist(), second.tolist(), strict=True):
        a, b = (m00 * a + m01 * b) + p, (m10 * a + m11 * b) + q
        states.append((a, b))
    z, v = np.array(states).T
    return z, v


def resonances(
    noise: FloatArray,
    omega: FloatArray,
    position: FloatArray,
    shared: bool,
    nodes: tuple[FloatArray, FloatArray],
    lasting: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return the summed response of damped oscillators with fixed frequencies, and the sum of the squared responses.

    An impulse is the product of `noise` and its frequency `omega` [rad/s]. An impulse excites one oscillator, or
    `NEIGHBOURS` oscillators with Lagrange's weights. `position` is the index of the first excited oscillator plus the
    fraction within the middle interval; it never decreases. `nodes` are the decayed cosine and sine of one step. The
    results at a sample are the sum of the decayed sines, and twice the sum of their squares.

    >>> unit = np.ones(1)
    >>> total, squares = resonances(unit, unit, np.zeros(1), False, (0.8 * unit, 0.6 * unit), 9.0 * unit)
    >>> total.tolist(), squares.round(12).tolist()
    ([0.0, 0.6], [0.0, 0.72])
    """
    total, squares = np.zeros(position.size + 1), np.zeros(position.size + 1)
    cosine, sine = nodes
    if (module := compiled()) is not None:
        module.resonances(noise, omega, position, shared, cosine, sine, lasting.astype(np.int64), total, squares)
        return total, squares
    width = NEIGHBOURS if shared else 1
    padding = (0, -cosine.size % _LANES)
    c, s = np.pad(cosine, padding), np.pad(sine, padding)
    q, cc, ss = c * c + s * s, c * c - s * s, 2.0 * (c * s)
    u, v, e, f, g = (np.zeros(c.size) for _ in range(5))
    fed, base = np.zeros(c.size, np.int64), position.astype(np.int64)
    kicks = (noise[: base.size] * omega[: base.size])[:, np.newaxis] * (
        weights := _lagrange_weights(position - base, width)
    )
    gains = (omega[: base.size] * omega[: base.size])[:, np.newaxis] * weights
    low = high = 0
    for n, b in enumerate(base.tolist()):
        near = slice(b, b + width)
        u[near] += kicks[n]
        e[near] += gains[n]
        f[near] += gains[n]
        fed[near] = n
        high = max(high, b + width)
        while low < b and n - fed[low] > lasting[low]:
            low += 1
        on = slice(low // _LANES * _LANES, -(-high // _LANES) * _LANES)
        u[on], v[on] = c[on] * u[on] - s[on] * v[on], s[on] * u[on] + c[on] * v[on]
        e[on] *= q[on]
        f[on], g[on] = cc[on] * f[on] - ss[on] * g[on], ss[on] * f[on] + cc[on] * g[on]
        total[n + 1] = _lanes(v[on])
        squares[n + 1] = _lanes(e[on] - f[on])
    return total, squares


def transition(omega: float, damping: float, step: float) -> FloatArray:
    """Return the transition matrix of displacement and velocity in free vibration over a step [rad/s, -, s]."""
    rate = omega * math.sqrt(1.0 - damping * damping)
    cosine, sine = cosine_sine(np.array([rate * step]))
    # sin(x) / rate has a finite limit at critical damping
    c, s = float(cosine[0]), float(sine[0]) / rate if rate > 0.0 else step
    decay = float(exponential(np.array([-damping * omega * step]))[0])
    own = damping * omega * s
    return decay * np.array([[c + own, s], [-omega * omega * s, c - own]])  # Eq. 167


def highpassed(acceleration: FloatArray, time_step: float, frequency: float) -> FloatArray:
    """Return the acceleration of a critically damped oscillator under a motion from rest [m/s2, s, Hz]."""
    # The acceleration z'' of ``z'' + 2 w z' + w^2 z = a`` is a high pass of the motion: velocity and displacement
    # return to zero (Rezaeian & Der Kiureghian 2008). The samples are exact for straight lines between them.
    low, high = MIN_CYCLES / time_step, 0.5 / time_step
    w = 2.0 * math.pi * checks.within("corner frequency", frequency, low, high, unit="Hz", open_high=True)
    move = transition(w, 1.0, time_step)
    # relative to the moving equilibrium under a line a + b t, the motion is a free vibration
    w2, lag = 1.0 / (w * w), 2.0 / w**3
    a, slope = acceleration[:-1], np.diff(acceleration) / time_step
    equilibrium, end, speed = w2 * a - lag * slope, w2 * acceleration[1:] - lag * slope, w2 * slope
    (m00, m01), (m10, m11) = move.tolist()
    z, v = recurrence(
        move, (0.0, 0.0), end - (m00 * equilibrium + m01 * speed), speed - (m10 * equilibrium + m11 * speed)
    )
    return acceleration - 2.0 * w * v - w * w * z  # Eq. 168


def _lagrange_weights(position: FloatArray, width: int) -> FloatArray:
    """Return Lagrange's weights of `width` neighbours, one row per position from 0 to 1."""
    at = position + (width - 1) // 2
    weights = np.ones((position.size, width))
    for i in range(width):
        for k in range(i):
            weights[:, i] *= at - k
        after, scale = np.ones_like(at), 1.0
        for k in range(width - 1, i, -1):
            after *= at - k
        for k in range(width):
            scale *= i - k if k != i else 1.0
        weights[:, i] = (weights[:, i] * after) * (1.0 / scale)
    return weights


def _lanes(values: FloatArray) -> float:
    a, b, c, d = values.reshape(-1, _LANES).sum(axis=0).tolist()
    return float((a + b) + (c + d))
