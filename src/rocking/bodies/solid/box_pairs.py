"""Which boxes out of many meet: a tree of boxes, walked against itself."""

from collections.abc import Iterator

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray

_CHUNK = 200_000


def meeting_boxes(low: FloatArray, high: FloatArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Return the pairs of boxes that have a point in common, a piece at a time.

    The boxes are halved at the median of their middles, along the longest side of each half, down to single ones; the
    tree is then walked against itself from its root. Memory stays bounded, however many pairs there are.

    low, high: lowest and highest corners [m]. Returns numbers of the boxes; each pair comes once.

    >>> low = np.array([[0.0, 0.0, 0.0], [0.5, 0.5, 0.5], [2.0, 0.0, 0.0]])
    >>> [sorted((int(i), int(j))) for a, b in meeting_boxes(low, low + 1.0) for i, j in zip(a, b, strict=True)]
    [[0, 1]]
    """
    order = _halved(0.5 * (low + high))
    layers = _layers(order, low, high)
    stack = [(0, np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64))]
    while stack:
        depth, one, two = stack.pop()
        if depth + 1 == len(layers):
            apart = one != two
            yield order[one[apart]], order[two[apart]]
            continue
        one, two = _below(one, two)
        keep = _meet(layers[depth + 1], one, two)
        one, two = one[keep], two[keep]
        stack += [(depth + 1, one[i : i + _CHUNK], two[i : i + _CHUNK]) for i in range(0, len(one), _CHUNK)]


def _halved(middles: FloatArray) -> IntArray:
    """Numbers of the boxes from left to right under the tree, repeated to a power of two."""
    full = 1 << max(0, len(middles) - 1).bit_length()
    padded = middles[np.minimum(np.arange(full), len(middles) - 1)]
    order = np.arange(full)
    for depth in range(full.bit_length() - 1):
        groups = order.reshape(1 << depth, -1)
        places = padded[groups]
        axis = np.argmax(np.ptp(places, axis=1), axis=1)
        along = np.take_along_axis(places, axis[:, None, None], axis=2)[..., 0]
        order = np.take_along_axis(groups, np.argsort(along, axis=1, kind="stable"), axis=1).ravel()
    return order


def _layers(order: IntArray, low: FloatArray, high: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """Boxes of the nodes, from the root to the leaves; what only fills up meets nothing."""
    real = (order < len(low))[:, None]
    numbers = np.minimum(order, len(low) - 1)
    layers = [(np.where(real, low[numbers], np.inf), np.where(real, high[numbers], -np.inf))]
    while len(layers[-1][0]) > 1:
        below = layers[-1]
        layers.append((below[0].reshape(-1, 2, 3).min(axis=1), below[1].reshape(-1, 2, 3).max(axis=1)))
    return layers[::-1]


def _below(one: IntArray, two: IntArray) -> tuple[IntArray, IntArray]:
    left = np.concatenate([2 * one, 2 * one, 2 * one + 1, 2 * one + 1])
    right = np.concatenate([2 * two, 2 * two + 1, 2 * two, 2 * two + 1])
    keep = left <= right
    return left[keep], right[keep]


def _meet(layer: tuple[FloatArray, FloatArray], one: IntArray, two: IntArray) -> BoolArray:
    low, high = layer
    found = np.ones(len(one), dtype=bool)
    for axis in range(3):
        bottom, top = low[:, axis], high[:, axis]
        found &= (bottom[one] <= top[two]) & (bottom[two] <= top[one])
    return found
