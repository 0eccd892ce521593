"""Taylor series of the equation of motion by recursion, and zeros of polynomials for the location of events."""

import math
from collections.abc import Sequence
from itertools import pairwise
from operator import mul

_SMALLEST = 1e-22
_NEAR = 1e-9
_MAX_ITERATIONS = 80


def series(
    u: float, rate: float, kappa: float, push: Sequence[float], weight: Sequence[float], order: int, *, linear: bool
) -> list[float]:
    """Return coefficients of ``u'' = kappa { weight * S + push * C }``, S = sin u, C = cos u."""
    # the series ends when the terms are below rounding
    coefficients, rates = [u, rate], [rate]
    if linear:
        sines, cosines = coefficients, [1.0]
    else:
        sines, cosines = [math.sin(u)], [math.cos(u)]
    floor = _SMALLEST * (abs(u) + abs(rate))
    small = 0
    for k in range(order - 1):
        force = sum(map(mul, weight, sines[k::-1])) + sum(map(mul, push, cosines[k::-1]))  # Eq. 48
        rates.append(kappa * force / (k + 1))
        coefficients.append(rates[-1] / (k + 2))
        small = small + 1 if abs(rates[-1]) <= floor and k >= len(push) + len(weight) else 0
        if small == 3:
            break
        if linear:
            cosines.append(0.0)
        else:
            sine = sum(map(mul, rates, cosines[k::-1])) / (k + 1)  # Eq. 49
            cosine = -sum(map(mul, rates, sines[k::-1])) / (k + 1)  # Eq. 50
            sines.append(sine)
            cosines.append(cosine)
    return coefficients


def shifted(polynomial: Sequence[float], to: float, width: float) -> list[float]:
    """Return a polynomial of x as a polynomial of y, with x = to + width * y."""
    c = list(polynomial)
    n = len(c)
    for k in range(n - 1):
        for j in range(n - 2, k - 1, -1):
            c[j] += to * c[j + 1]  # Eq. 51
    return [value * width**k for k, value in enumerate(c)]


def value(polynomial: Sequence[float], x: float) -> float:
    """Return the value of a polynomial."""
    total = 0.0
    for c in reversed(polynomial):
        total = total * x + c
    return total


def slope(polynomial: Sequence[float], x: float) -> float:
    """Return the derivative of a polynomial."""
    total = 0.0
    for k in range(len(polynomial) - 1, 0, -1):
        total = total * x + k * polynomial[k]
    return total


def first_fall(polynomial: Sequence[float]) -> float | None:
    """Return the first x in (0, 1] at which a polynomial that is positive at 0 becomes negative, or None."""
    # a double zero is not counted
    if polynomial[0] + sum(min(c, 0.0) for c in polynomial[1:]) > 0.0:
        return None
    return next((x for x in _zeros(polynomial) if 0.0 < x <= 1.0 and slope(polynomial, x) < 0.0), None)


def last_fall(polynomial: Sequence[float]) -> float | None:
    """Return the last x in [0, 1) at which a polynomial becomes negative that is negative at 1.

    None if the polynomial is negative everywhere.
    """
    if polynomial[0] + sum(max(c, 0.0) for c in polynomial[1:]) < 0.0:
        return None
    # after reversing x and the sign, this is the first fall
    back = first_fall([-c for c in shifted(polynomial, 1.0, -1.0)])
    return None if back is None else 1.0 - back


def turning_points(polynomial: Sequence[float], until: float) -> list[float]:
    """Return the zeros of the slope on (0, until], in order. A double zero may be missing."""
    return [min(x, until) for x in _zeros(_slopes(polynomial)) if 0.0 < x <= until + _NEAR]


def _slopes(polynomial: Sequence[float]) -> list[float]:
    return [k * c for k, c in enumerate(polynomial)][1:]


def _zeros(polynomial: Sequence[float]) -> list[float]:
    """Return the changes of sign on [0, 1 + 1e-9]. At most one zero is between two adjacent zeros of the slope."""
    start, tail = polynomial[0], polynomial[1:]
    if start == 0.0 and tail:  # a zero at 0 itself is not a change of sign
        return _zeros(tail)
    if not tail or start + sum(min(c, 0.0) for c in tail) > 0.0 or start + sum(max(c, 0.0) for c in tail) < 0.0:
        return []
    stops = [0.0, *_zeros(_slopes(polynomial)), 1.0 + _NEAR]
    below = [value(polynomial, x) < 0.0 for x in stops]
    pairs = zip(pairwise(stops), pairwise(below), strict=True)
    return [_zero_between(polynomial, *limits) for limits, (first, last) in pairs if first is not last]


def _zero_between(polynomial: Sequence[float], low: float, high: float) -> float:
    """Return a zero between two points of opposite signs, by Newton's method with bisection."""
    is_rising = value(polynomial, low) < 0.0
    x = 0.5 * (low + high)
    for _ in range(_MAX_ITERATIONS):
        residual, rate = value(polynomial, x), slope(polynomial, x)
        low, high = (x, high) if (residual < 0.0) is is_rising else (low, x)
        x_next = x - residual / rate if rate else low  # Eq. 56
        x_next = x_next if low < x_next < high else 0.5 * (low + high)
        if abs(x_next - x) <= 2e-16 * abs(x):
            break
        x = x_next
    return x
