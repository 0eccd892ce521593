"""How often a closed surface of triangles winds round points: count the faces above them."""

import numpy as np

from rocking.conventions import BoolArray, FloatArray

_TILES = 24
_MOST_PAIRS = 2_000_000


def inside(points: FloatArray, triangles: FloatArray) -> BoolArray:
    """Return which points lie inside a closed, oriented surface.

    Upward faces above a point count +1, downward ones -1; inside, the sum is 1. Points and faces are sorted into tiles
    of the plan first, so that each point meets the faces near its own plumb line only.

    points: points [m]; triangles: corners, counter-clockwise seen from outside [m].

    >>> from rocking.bodies.solid import box
    >>> inside(np.array([[0.1, 0.1, 0.5], [0.1, 0.1, 1.5]]), box(1.0, 1.0, 1.0).corners).tolist()
    [True, False]
    """
    return winding(points, triangles) > 0.5


def winding(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """Return how many times a closed, oriented surface winds round each point.

    points: points [m]; triangles: corners, counter-clockwise seen from outside [m]. Returns 1 inside a body, 0 outside;
    anything else where the surface overlaps itself or is inside out [-].

    >>> from rocking.bodies.solid import box
    >>> cube = box(1.0, 1.0, 1.0).corners
    >>> winding(np.array([[0.1, 0.1, 0.5]]), np.concatenate([cube, cube])).tolist()
    [2.0]
    """
    result = np.zeros(len(points))
    if not len(points):
        return result
    # an irrational nudge keeps plumb lines off edges and vertices of regular meshes
    size = float(np.ptp(triangles, axis=(0, 1)).max())
    nudged = points + size * 1e-10 * np.array([np.sqrt(2.0), np.sqrt(3.0), 0.0])
    low, high = triangles[..., :2].min(axis=1), triangles[..., :2].max(axis=1)
    start, width = low.min(axis=0), np.maximum(np.ptp(triangles[..., :2], axis=(0, 1)) / _TILES, 1e-300)
    tile = np.floor((nudged[:, :2] - start) / width).astype(np.int64)
    order = np.lexsort(tile.T)
    cuts = np.flatnonzero(np.any(np.diff(tile[order], axis=0), axis=1)) + 1
    for members in np.split(order, cuts):
        corner = start + tile[members[0]] * width
        near = ((low <= corner + width) & (high >= corner)).all(axis=1)
        result[members] = _counted(nudged[members], triangles[near])
    return result


def _counted(points: FloatArray, triangles: FloatArray) -> FloatArray:
    if not len(triangles):
        return np.zeros(len(points))
    step = max(1, _MOST_PAIRS // len(triangles))
    pieces = [_plumbed(points[i : i + step], triangles) for i in range(0, len(points), step)]
    return np.concatenate(pieces)


def _plumbed(points: FloatArray, triangles: FloatArray) -> FloatArray:
    flat = triangles[None, :, :, :2] - points[:, None, None, :2]
    x, y = flat[..., 0], flat[..., 1]
    # shares of the corners: the areas that the plumb line cuts off opposite each
    shares = np.stack([x[..., i - 2] * y[..., i - 1] - x[..., i - 1] * y[..., i - 2] for i in range(3)], axis=-1)
    twice = shares.sum(axis=-1)
    hit = ((shares > 0.0).all(axis=-1) | (shares < 0.0).all(axis=-1)) & (twice != 0.0)
    height = np.einsum("pti,ti->pt", shares, triangles[..., 2])
    above = height > points[:, None, 2] * twice
    above = np.where(twice > 0.0, above, ~above)
    counts: FloatArray = np.where(hit & above, np.sign(twice), 0.0).sum(axis=1)
    return counts
