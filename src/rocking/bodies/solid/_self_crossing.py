"""Does a closed surface pass through itself? Asked of its faces, and of how often it winds round points beside them."""

from collections.abc import Callable

import numpy as np

from rocking.bodies.solid._changes import in_words
from rocking.bodies.solid._piercing import DEPTH, Piercing, pierced
from rocking.bodies.solid.surfaces import area_vectors, boxes
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import GeometryError

_TILES = 24
_MOST_PAIRS = 2_000_000


def inside(points: FloatArray, triangles: FloatArray) -> BoolArray:
    """Return which points lie inside a closed, oriented surface."""
    # Upward faces above a point count +1, downward ones -1; inside, the sum is 1. Points and faces are sorted into
    # tiles of the plan first, so that each point meets the faces near its own plumb line only.
    return winding(points, triangles) > 0.5


def winding(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """Return how many times a closed, oriented surface winds round each point."""
    result = np.zeros(len(points))
    if not len(points):
        return result
    # an irrational nudge keeps plumb lines off edges and vertices of regular meshes
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
        for some in np.split(members, range(step, len(members), step)):
            result[some] = _plumbed(nudged[some], triangles[near])
    return result


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


PROBED = 500  # faces beside which the winding number is asked for [-]

_REPAIR = (
    "what it encloses is not defined: repair it in the program that made it, for instance by a boolean union or by "
    "removing self-intersections"
)


def check_crossings(
    triangles: FloatArray, place_words: Callable[[FloatArray], str] = in_words, found: Piercing | None = None
) -> bool:
    """Refuse a surface that passes through itself; return whether every pair of faces could be tried."""
    # Every pair of faces is tried, to a millionth of the size. Beside 500 faces, chosen by their area, the surface must
    # wind once or not at all round points on either side: that finds lobes that are inside out and overlaps that meet
    # in corners and edges of the mesh only. Not seen are such lobes where they take less than about a hundredth of the
    # surface, folds within one plane, which enclose nothing, and crossings shallower than a millionth of the size.
    low, high = boxes(triangles)
    middle = 0.5 * np.array([low[:, i].min() + high[:, i].max() for i in range(3)])
    centred = triangles - middle
    found = pierced(centred) if found is None else found
    if found.pairs:
        raise GeometryError(
            f"the surface passes through itself, most plainly near {place_words(middle + found.place)}; "
            f"{found.pairs} pair(s) of faces cross; {_REPAIR}"
        )
    points = _beside(centred)
    times = winding(points, centred)
    suspects = np.flatnonzero((times != 0.0) & (times != 1.0))
    # a plumb line through an edge may miscount: only what all three axes say is believed
    for axes in ([1, 2, 0], [2, 0, 1]):
        again = winding(points[suspects][:, axes], centred[..., axes])
        suspects = suspects[(again != 0.0) & (again != 1.0)]
    if len(suspects):
        worst = suspects[0]
        raise GeometryError(
            f"the surface passes through itself or is inside out in part: it winds {int(times[worst])} times round the "
            f"point near {place_words(middle + points[worst])}, where a body has 1 and its surroundings 0; {_REPAIR}"
        )
    return found.complete


def _beside(triangles: FloatArray) -> FloatArray:
    """Points a little inside and outside some faces, not near their edges."""
    generator = np.random.default_rng(0)
    vectors = area_vectors(triangles)
    areas = np.linalg.norm(vectors, axis=1)
    size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
    usable = np.flatnonzero(areas > 1e-12 * size**2)
    count = min(PROBED, len(usable))
    chosen = generator.choice(usable, count, replace=False, p=areas[usable] / areas[usable].sum())
    shares = generator.dirichlet((4.0, 4.0, 4.0), count)
    on = np.einsum("kc,kci->ki", shares, triangles[chosen])
    # farther than what counts as touching
    off = vectors[chosen] / areas[chosen, None] * (3.0 * DEPTH * size)
    return np.concatenate([on - off, on + off])
