"""Scrambled Sobol points, equal to `scipy.stats.qmc`, whose import takes one second."""

import numpy as np

from rocking.conventions import FloatArray, IntArray

_BITS = 30

# Joe and Kuo (2008), SIAM Journal on Scientific Computing 30(5) 2635, doi:10.1137/070709359: primitive polynomials and
# first direction numbers of the second, third and further dimensions
_DIRECTIONS = (
    (3, 1), (7, 1, 3), (11, 1, 3, 1), (13, 1, 1, 1), (19, 1, 1, 3, 3), (25, 1, 3, 5, 13), (37, 1, 1, 5, 5, 17),
    (41, 1, 1, 5, 5, 5), (47, 1, 1, 7, 11, 19), (55, 1, 1, 5, 1, 1), (59, 1, 1, 1, 3, 11), (61, 1, 3, 5, 5, 31),
    (67, 1, 3, 3, 9, 7, 49), (91, 1, 1, 1, 15, 21, 21), (97, 1, 3, 1, 13, 27, 49), (103, 1, 1, 1, 15, 7, 5),
    (109, 1, 3, 1, 15, 13, 25), (115, 1, 1, 5, 5, 19, 61), (131, 1, 3, 7, 11, 23, 15, 103),
    (137, 1, 3, 7, 13, 13, 15, 69), (143, 1, 1, 3, 13, 7, 35, 63), (145, 1, 3, 5, 9, 1, 25, 53),
    (157, 1, 3, 1, 13, 9, 35, 107), (167, 1, 3, 1, 5, 27, 61, 31), (171, 1, 1, 5, 11, 19, 41, 61),
    (185, 1, 3, 5, 3, 3, 13, 69), (191, 1, 1, 7, 13, 1, 19, 1), (193, 1, 3, 7, 5, 13, 19, 59),
    (203, 1, 1, 3, 9, 25, 29, 41), (211, 1, 3, 5, 13, 23, 1, 55), (213, 1, 3, 7, 3, 13, 59, 17),
)  # fmt: skip
MOST = len(_DIRECTIONS) + 1  # largest number of dimensions


def scrambled_sobol(dimensions: int, count: int, seed: int) -> FloatArray:
    """Return points of the unit cube, shape (count, dimensions). The count must be a power of two."""
    random = np.random.default_rng(seed)
    shift = random.integers(2, size=(dimensions, _BITS), dtype=np.uint32) @ (2 ** np.arange(_BITS, dtype=np.uint32))
    lower = np.tril(random.integers(2, size=(dimensions, _BITS, _BITS), dtype=np.uint32))
    lower[:, range(_BITS), range(_BITS)] = 1
    numbers = np.array([_directions(dimension) for dimension in range(dimensions)])
    shifts = np.arange(_BITS)[::-1]
    bits = numbers[:, :, None] >> shifts & 1  # axes: dimension, number, bit (highest bit first)
    # product of the numbers and a random lower triangular matrix of bits (Matousek 1998), modulo two
    scrambled = ((bits @ lower.transpose(0, 2, 1).astype(np.int64) & 1) << shifts).sum(axis=2)
    points = np.empty((count, dimensions), dtype=np.int64)
    points[0] = shift
    for k in range(
        count.bit_length() - 1
    ):  # Gray code: the second half is the reversed first half, with one number added
        points[1 << k : 2 << k] = points[: 1 << k][::-1] ^ scrambled[:, k]
    return points / 2.0**_BITS


def _directions(dimension: int) -> IntArray:
    """Return the direction numbers of a dimension, as integers of 30 bits."""
    polynomial, *first = _DIRECTIONS[dimension - 1] if dimension else (1, *(1,) * _BITS)
    degree, numbers = polynomial.bit_length() - 1, list(first)
    for i in range(len(numbers), _BITS):
        number = numbers[i - degree] ^ numbers[i - degree] << degree
        for k in range(1, degree):
            number ^= (polynomial >> degree - k & 1) * numbers[i - k] << k
        numbers.append(number)
    return np.array([number << _BITS - 1 - i for i, number in enumerate(numbers)])
