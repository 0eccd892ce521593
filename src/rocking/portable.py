"""Arithmetic with the same bits on every processor.

IEEE 754 defines the rounding of sums, products, quotients and square roots, and numpy has a fixed order of summation.
BLAS and LAPACK select kernels by processor, with different rounding. In numpy, exp, log, tan, arctan2 and powers have
other versions for AVX-512, which differ by one unit in the last place. Events and results therefore use neither BLAS
nor LAPACK nor these numpy functions. This module computes with three-vectors without a library, and uses the C library
for functions of one number.
"""

import math
from collections.abc import Callable, Iterable
from functools import reduce
from operator import add, mul
from typing import Any

import numpy as np

from rocking.conventions import FloatArray

_FEW, _SHORT = 16, 4


def _sum(terms: Iterable[float]) -> float:
    """Return the sum in the order of the terms. The built-in `sum` rounds differently since Python 3.12."""
    return reduce(add, terms, 0.0)


def dot(left: FloatArray, right: FloatArray) -> float:
    """Return the scalar product of two vectors."""
    if left.size == right.size == 3:
        (a, b, c), (x, y, z) = left.tolist(), right.tolist()
        return float(0.0 + a * x + b * y + c * z)
    return float(_sum(map(mul, left.tolist(), right.tolist())))


def norm(vector: FloatArray) -> float:
    """Return the length of a vector."""
    return math.sqrt(dot(vector, vector))


def applied(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Return the products of matrices and vectors, or the products of points with one vector.

    >>> applied(np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([1.0, -1.0])).tolist()
    [-1.0, -1.0]
    """
    if matrix.ndim == 2 and vector.ndim == 1 and len(matrix) <= _FEW:
        if vector.size == 3:
            x, y, z = vector.tolist()
            return np.array([0.0 + a * x + b * y + c * z for a, b, c in matrix.tolist()], dtype=np.float64)
        other = vector.tolist()
        return np.array([_sum(map(mul, row, other)) for row in matrix.tolist()], dtype=np.float64)
    return np.asarray((matrix * vector[..., None, :]).sum(axis=-1))


def times(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the product of two small matrices."""
    count = right.shape[-2]
    if count > _SHORT:
        return np.asarray((left[..., :, :, None] * right[..., None, :, :]).sum(axis=-2))
    return np.asarray(sum(left[..., j, None] * right[..., None, j, :] for j in range(count)))


def trapezoid(values: FloatArray, widths: FloatArray | float) -> float:
    """Return the integral of samples by the trapezoidal rule, independent of the numpy version.

    >>> trapezoid(np.array([0.0, 1.0, 4.0]), 1.0)
    3.0
    """
    return float((widths * (values[1:] + values[:-1]) / 2.0).sum())


def gram(rows: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the sum of the weighted outer products of vectors with themselves."""
    weighted, result = (rows * weights[:, None]).T.copy(), np.empty((rows.shape[1], rows.shape[1]))
    for i, row in enumerate(rows.T):
        result[i, i:] = result[i:, i] = (weighted[i:] * row).sum(axis=1)
    return result


def convolved(left: FloatArray, right: FloatArray, count: int | None = None) -> FloatArray:
    """Return the coefficients of the product of two polynomials, or the first `count` coefficients.

    >>> convolved(np.array([1.0, 2.0]), np.array([1.0, 0.0, 3.0])).tolist()
    [1.0, 2.0, 3.0, 6.0]
    """
    terms, other = left.tolist(), [*right.tolist(), *[0.0] * (len(left) - 1)]
    return np.array([_sum(map(mul, terms, other[k::-1])) for k in range(len(other))[:count]])


def solution(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Return x of ``A x = b`` by elimination, for a symmetric positive definite A of three rows.

    >>> solution(np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 4.0]]), np.array([3.0, 3.0, 2.0])).tolist()
    [1.0, 1.0, 0.5]
    """
    (a, b, c), (_, d, e), (_, _, f) = matrix.tolist()
    x, y, z = vector.tolist()
    first, second = b / a, c / a
    d, e = d - first * b, e - first * c
    third = e / d
    y = y - first * x
    z = (z - second * x - third * y) / (f - second * c - third * e)
    y = (y - e * z) / d
    return np.array([(x - b * y - c * z) / a, y, z])


def inverse(matrix: FloatArray) -> FloatArray:
    """Return the inverse of a symmetric positive definite matrix of three rows."""
    return np.array([solution(matrix, column) for column in np.eye(3)])


def powers(x: Any, count: int) -> FloatArray:
    """Return the powers 1, x, x^2, ... by repeated multiplication."""
    base = np.repeat(np.asarray(x, dtype=np.float64)[..., None], count, axis=-1)
    base[..., :1] = 1.0
    return np.asarray(np.multiply.accumulate(base, axis=-1))


def each(function: Callable[..., float], *values: Any) -> FloatArray:
    """Apply a function of `math` to every number.

    >>> each(math.atan2, [0.0, 0.0], 1.0).tolist()
    [0.0, 0.0]
    """
    arrays = np.broadcast_arrays(*[np.asarray(v, dtype=np.float64) for v in values])
    results = list(map(function, *[array.ravel().tolist() for array in arrays]))
    return np.array(results, dtype=np.float64).reshape(arrays[0].shape)


def gauss_rule(diagonal: FloatArray, side: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the Gauss rule of a measure of mass one, from the recurrence of its orthogonal polynomials."""
    # nodes are eigenvalues (Golub and Welsch), rounded to eight digits; Newton iterations then give the same bits
    # on every processor, because the last digits of LAPACK have no influence
    x = np.round(np.linalg.eigvalsh(np.diag(diagonal) + np.diag(side, 1) + np.diag(side, -1)), 8)
    ahead = [*side.tolist(), 1.0]  # the scale of the last polynomial is arbitrary
    for _ in range(4):
        before, p, slope_before, slope, size = 0.0 * x, 1.0 + 0.0 * x, 0.0 * x, 0.0 * x, 0.0 * x
        for k, (a, b) in enumerate(zip(diagonal.tolist(), ahead, strict=True)):
            size = size + p * p
            back = ahead[k - 1] if k else 0.0
            before, p, slope_before, slope = (
                p,
                ((x - a) * p - back * before) / b,
                slope,
                (p + (x - a) * slope - back * slope_before) / b,
            )
        weights, x = 1.0 / size, x - p / slope
    return x, weights


def gauss_legendre(count: int) -> tuple[FloatArray, FloatArray]:
    """Return the Gauss rule on [-1, 1], exact for polynomials of degree ``2 count - 1``.

    >>> nodes, weights = gauss_legendre(3)
    >>> (nodes**2).round(12).tolist(), (9.0 * weights).round(12).tolist()
    ([0.6, 0.0, 0.6], [5.0, 8.0, 5.0])
    """
    k = np.arange(1.0, count)
    nodes, weights = gauss_rule(np.zeros(count), k / np.sqrt(4.0 * k * k - 1.0))
    return nodes, 2.0 * weights
