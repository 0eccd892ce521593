"""Winding number of a closed surface around points."""

import numpy as np

from rocking.bodies.solid.surfaces import boxes
from rocking.conventions import BoolArray, FloatArray

_TILES = 24  # number of tiles along each side of the plan [-]
_MOST_PAIRS = 2_000_000  # largest number of pairs of points and faces that are compared together [-]


def inside(points: FloatArray, triangles: FloatArray) -> BoolArray:
    """Return True for points inside a closed, oriented surface, shape (n,)."""
    # An upward face above a point adds 1, and a downward face subtracts 1; the sum is 1 inside. Points and faces are
    # sorted into tiles of the plan, so only the faces near the vertical line of a point are checked.
    return winding(points, triangles) > 0.5


def winding(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """Return the winding number of a closed, oriented surface around each point."""
    result = np.zeros(len(points))
    if not len(points):
        return result
    # an irrational shift keeps vertical lines away from edges and vertices of regular meshes
    low, high = boxes(triangles)
    start = np.array([low[:, i].min() for i in range(3)])
    extent = np.array([high[:, i].max() for i in range(3)]) - start
    nudged = points + float(extent.max()) * 1e-10 * np.array([np.sqrt(2.0), np.sqrt(3.0), 0.0])
    start, width = start[:2], np.maximum(extent[:2] / _TILES, 1e-300)
    tile = np.floor((nudged[:, :2] - start) / width).astype(np.int64)
    order = np.lexsort(tile.T)
    cuts = np.flatnonzero(np.any(np.diff(tile[order], axis=0), axis=1)) + 1
    column, strip = None, np.zeros(0, dtype=np.int64)
    for members in np.split(order, cuts):
        corner = start + tile[members[0]] * width
        if tile[members[0], 1] != column:
            column = tile[members[0], 1]
            strip = np.flatnonzero((low[:, 1] <= corner[1] + width[1]) & (high[:, 1] >= corner[1]))
        near = strip[(low[strip, 0] <= corner[0] + width[0]) & (high[strip, 0] >= corner[0])]
        step = max(1, _MOST_PAIRS // max(1, len(near)))
        for chunk in np.split(members, range(step, len(members), step)):
            result[chunk] = _plumbed(nudged[chunk], triangles[near])
    return result


def _plumbed(points: FloatArray, triangles: FloatArray) -> FloatArray:
    flat = triangles[None, :, :, :2] - points[:, None, None, :2]
    x, y = flat[..., 0], flat[..., 1]
    # weights of the corners: areas of the opposite triangles at the vertical line
    corner_weights = np.stack(
        [x[..., i - 2] * y[..., i - 1] - x[..., i - 1] * y[..., i - 2] for i in range(3)], axis=-1
    )
    twice = corner_weights.sum(axis=-1)
    hit = ((corner_weights > 0.0).all(axis=-1) | (corner_weights < 0.0).all(axis=-1)) & (twice != 0.0)
    height = np.einsum("pti,ti->pt", corner_weights, triangles[..., 2])
    above = height > points[:, None, 2] * twice
    above = np.where(twice > 0.0, above, ~above)
    counts: FloatArray = np.where(hit & above, np.sign(twice), 0.0).sum(axis=1)
    return counts
