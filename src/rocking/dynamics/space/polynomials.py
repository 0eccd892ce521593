"""Series of one step as polynomials: products, roots, and where they first fall below zero."""

import math
from operator import mul

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.taylor import first_fall
from rocking.portable import convolved

NOTHING = 1e-13
"""Coefficients below this share of the largest one are rounding."""


def first_zero(series: FloatArray, *, started: bool, floor: float = 0.0) -> float | None:
    """Return where a series first falls below zero.

    Returns from 0 to 1; None if it does not fall.
    """
    terms = series.tolist()
    if started:
        small = NOTHING * max(map(abs, terms))
        first = next((k for k, c in enumerate(terms) if k and abs(c) > (max(floor, small) if k < 3 else small)), None)
        if first is None:
            return None
        terms = terms[first:]
    elif terms[0] == 0.0 and len(terms) > 1:
        terms = terms[1:]
    if not all(map(math.isfinite, terms)):
        return None
    if terms[0] < 0.0:
        return 0.0
    terms[0] = terms[0] or 5e-324
    return first_fall(terms)


def cauchy(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the product of two series, up to the order of the first."""
    return convolved(left, right[: len(left)])[: len(left)]


def dot(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the scalar product of two series of vectors."""
    return np.asarray(sum(cauchy(left[:, i], right[:, i]) for i in range(left.shape[1])))


def square_root(square: FloatArray) -> FloatArray:
    """Return the square root of a series that starts above zero."""
    root = [math.sqrt(square[0])]
    for k, term in enumerate(square.tolist()[1:], 1):
        root.append((term - sum(map(mul, root[1:k], root[k - 1 : 0 : -1]))) / (2.0 * root[0]))
    return np.array(root)


def padded(series: FloatArray, count: int) -> FloatArray:
    """Return a series of another length."""
    return np.pad(series, (0, max(0, count - len(series))))[:count]
