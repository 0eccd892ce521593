"""Marching squares: which edges of cells a boundary crosses, and in what order it does."""

import numpy as np

from rocking.conventions import BoolArray, IntArray

# edges of a cell by number: bottom, right, top, left; corners: lower left, lower right, upper right, upper left
_ENDS = ((0, 1), (1, 2), (3, 2), (0, 3))


def crossed_edges(inside: BoolArray) -> BoolArray:
    """Return which edges of cells have one end inside and one outside.

    >>> crossed_edges(np.array([[True, False, False, False]])).tolist()
    [[True, False, False, True]]
    """
    return np.stack([inside[:, a] != inside[:, b] for a, b in _ENDS], axis=1)


def edge_numbers(i: IntArray, j: IntArray, columns: int) -> IntArray:
    """Return the numbers of the edges of cells; neighbours share them.

    Returns twice the number of the left or lower end, plus one for upright edges: bottom, right, top, left.
    """
    here = 2 * (j * columns + i)
    return np.stack([here, here + 3, here + 2 * columns, here + 1], axis=1)


def segments(inside: BoolArray, edges: IntArray, centre: BoolArray) -> IntArray:
    """Return which crossed edges a boundary joins within each cell.

    A saddle, whose inside corners are opposite, is decided by its centre: the inside corners are joined if the centre
    is inside, else the outside ones.

    Returns numbers of the edges at both ends.
    """
    crossed = crossed_edges(inside)
    count = crossed.sum(axis=1)
    plain = edges[count == 2][crossed[count == 2]].reshape(-1, 2)
    saddle = count == 4
    around_right = (inside[saddle, 0] == centre[saddle])[:, None]
    bottom, right, top, left = edges[saddle].T
    first = np.where(around_right, np.stack([bottom, right], 1), np.stack([bottom, left], 1))
    second = np.where(around_right, np.stack([top, left], 1), np.stack([top, right], 1))
    return np.concatenate([plain, first, second])


def chains(joined: IntArray) -> list[list[int]]:
    """Return the polylines that segments make; of closed ones the first edge is repeated at the end.

    Returns numbers of the edges in order; open ones first.

    >>> chains(np.array([[1, 2], [3, 2], [5, 6], [6, 7], [7, 5]]))
    [[1, 2, 3], [5, 6, 7, 5]]
    """
    neighbours: dict[int, list[int]] = {}
    for a, b in joined.tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    starts = [edge for edge, near in neighbours.items() if len(near) == 1]
    seen: set[int] = set()
    found = [_followed(start, neighbours, seen) for start in (*starts, *neighbours) if start not in seen]
    return [chain for chain in found if len(chain) > 1]


def _followed(start: int, neighbours: dict[int, list[int]], seen: set[int]) -> list[int]:
    chain, here = [start], start
    seen.add(start)
    while True:
        onward = [edge for edge in neighbours[here] if edge not in seen]
        if not onward:
            break
        here = onward[0]
        seen.add(here)
        chain.append(here)
    closed = len(chain) > 2 and start in neighbours[here]
    return [*chain, start] if closed else chain
