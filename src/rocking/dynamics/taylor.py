"""Taylor series of the equation of motion, by recursion, and the zeros of polynomials that locate events."""

from collections.abc import Sequence
from operator import mul

import numpy as np

_SMALLEST = 1e-22
_NEAR = 1e-9


def series(
    u: float, rate: float, kappa: float, push: Sequence[float], weight: Sequence[float], order: int, *, linear: bool
) -> list[float]:
    """Return the series of ``u'' = kappa { weight * S + push * C }`` with S = sin u, C = cos u, over a unit of time.

    Parameters
    ----------
    u : float
        Angle from the top, alpha - |theta| [rad].
    rate : float
        u' per unit of time [rad].
    kappa : float
        p^2 times the unit of time squared [-].
    push, weight : sequence of float
        Series of s a_x / g and of 1 + a_z / g.
    order : int
        Highest power.
    linear : bool
        S = u and C = 1 instead.

    Returns
    -------
    list of float
        Coefficients of u, from the power 0; shorter than `order` where what is left is below rounding.
    """
    coefficients, rates = [u, rate], [rate]
    if linear:
        sines, cosines = coefficients, [1.0]
    else:
        sines, cosines = [float(np.sin(u))], [float(np.cos(u))]
    floor = _SMALLEST * (abs(u) + abs(rate))
    small = 0
    for k in range(order - 1):
        force = sum(map(mul, weight, sines[k::-1])) + sum(map(mul, push, cosines[k::-1]))
        rates.append(kappa * force / (k + 1))
        coefficients.append(rates[-1] / (k + 2))
        small = small + 1 if abs(rates[-1]) <= floor and k >= len(push) + len(weight) else 0
        if small == 3:
            break
        if linear:
            cosines.append(0.0)
        else:
            sine = sum(map(mul, rates, cosines[k::-1])) / (k + 1)
            cosine = -sum(map(mul, rates, sines[k::-1])) / (k + 1)
            sines.append(sine)
            cosines.append(cosine)
    return coefficients


def shifted(polynomial: Sequence[float], to: float, width: float) -> list[float]:
    """Return a polynomial of x as one of y, with x = to + width * y.

    Parameters
    ----------
    polynomial : sequence of float
        Coefficients from the power 0.
    to, width : float
        Where the new variable starts, and its unit.

    Returns
    -------
    list of float
        Coefficients from the power 0.
    """
    c = list(polynomial)
    n = len(c)
    for k in range(n - 1):
        for j in range(n - 2, k - 1, -1):
            c[j] += to * c[j + 1]
    return [value * width**k for k, value in enumerate(c)]


def value(polynomial: Sequence[float], x: float) -> float:
    """Return the value of a polynomial.

    Parameters
    ----------
    polynomial : sequence of float
        Coefficients from the power 0.
    x : float
        Where.

    Returns
    -------
    float
        The value.
    """
    total = 0.0
    for c in reversed(polynomial):
        total = total * x + c
    return total


def slope(polynomial: Sequence[float], x: float) -> float:
    """Return the derivative of a polynomial.

    Parameters
    ----------
    polynomial : sequence of float
        Coefficients from the power 0.
    x : float
        Where.

    Returns
    -------
    float
        The derivative.
    """
    total = 0.0
    for k in range(len(polynomial) - 1, 0, -1):
        total = total * x + k * polynomial[k]
    return total


def first_fall(polynomial: Sequence[float]) -> float | None:
    """Return where on (0, 1] a polynomial that starts above zero first goes below it.

    Parameters
    ----------
    polynomial : sequence of float
        Coefficients from the power 0.

    Returns
    -------
    float, optional
        The zero, to rounding; None if there is none. Touching zero is not falling.
    """
    if polynomial[0] + sum(min(c, 0.0) for c in polynomial[1:]) > 0.0:
        return None
    for guess in _guesses(polynomial):
        x = _polished(polynomial, guess)
        if x is not None and 0.0 < x <= 1.0 and slope(polynomial, x) < 0.0:
            return x
    return None


def last_fall(polynomial: Sequence[float]) -> float | None:
    """Return where on [0, 1) a polynomial that ends below zero last goes below it.

    Parameters
    ----------
    polynomial : sequence of float
        Coefficients from the power 0.

    Returns
    -------
    float, optional
        The zero, to rounding; None if the polynomial is below zero throughout.
    """
    if polynomial[0] + sum(max(c, 0.0) for c in polynomial[1:]) < 0.0:
        return None
    # backwards in time and upside down it is a first fall
    back = first_fall([-c for c in shifted(polynomial, 1.0, -1.0)])
    return None if back is None else 1.0 - back


def turning_points(polynomial: Sequence[float], until: float) -> list[float]:
    """Return where on (0, until] the slope of a polynomial is zero.

    Parameters
    ----------
    polynomial : sequence of float
        Coefficients from the power 0.
    until : float
        End of the range, at most 1.

    Returns
    -------
    list of float
        The zeros of the slope, in order; where it only just touches zero there may be one or none.

    Examples
    --------
    >>> [round(x, 12) for x in turning_points([0.0, 0.5, -1.5, 1.0], 1.0)]
    [0.211324865405, 0.788675134595]
    """
    slopes = [k * c for k, c in enumerate(polynomial)][1:]
    rises = slopes[0] + sum(min(c, 0.0) for c in slopes[1:]) > 0.0
    if rises or slopes[0] + sum(max(c, 0.0) for c in slopes[1:]) < 0.0:
        return []
    found = [_polished(slopes, guess) for guess in _guesses(slopes)]
    return [min(x, until) for x in found if x is not None and 0.0 < x <= until + _NEAR]


def _guesses(polynomial: Sequence[float]) -> list[float]:
    """Zeros on [0, 1], and those that may be there but for rounding, by eigenvalues."""
    rest = sum(map(abs, polynomial[1:]))
    # highest powers first cut away: they are below rounding and would spoil the eigenvalues
    kept = len(polynomial)
    while kept > 2 and abs(polynomial[kept - 1]) <= 1e-20 * rest:
        kept -= 1
    roots = np.roots(polynomial[kept - 1 :: -1])
    return sorted(float(x.real) for x in roots if abs(x.imag) < 1e-6 and -_NEAR < x.real < 1.0 + _NEAR)


def _polished(polynomial: Sequence[float], guess: float) -> float | None:
    """Improve a zero by Newton's method; None where that leads away."""
    x = guess
    for _ in range(50):
        rate = slope(polynomial, x)
        if rate == 0.0:
            break
        step = value(polynomial, x) / rate
        x -= step
        if abs(step) <= 2e-16 * abs(x):
            break
    return x if abs(x - guess) < 1e-3 else None
