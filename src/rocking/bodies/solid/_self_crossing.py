"""Does a closed surface pass through itself? Asked of its faces, and of how often it winds round points beside them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from rocking.bodies.solid._changes import in_words
from rocking.bodies.solid.surfaces import area_vectors, boxes
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError

DEPTH = 1e-6  # faces that reach through each other by less of the size are said to touch [-]
MOST_PAIRS = 20_000_000  # so many pairs of faces whose boxes meet are tried [-]
_THINNEST = 1e-7


@dataclass(frozen=True)
class Piercing:
    """Where faces of a surface pass through each other."""

    pairs: int  # pairs of faces that do
    place: FloatArray  # middle of the longest line in which two of them cross [m]; shape (3,)
    faces: IntArray  # those that do
    complete: bool  # whether every pair could be tried


def pierced(triangles: FloatArray) -> Piercing:
    """Return where triangles pass through each other; those that share corners or edges, or touch, do not."""
    # Two triangles cross if each has corners on both sides of the other's plane and the pieces of the common line of
    # both planes that lie in them overlap (T. Moeller, "A fast triangle-triangle intersection test", 1997), all by more
    # than 1e-6 of the size. Triangles in one plane do not cross, nor do those that are thinner than 1e-7 of the size.
    low, high = boxes(triangles)
    size = float(max(high[:, i].max() - low[:, i].min() for i in range(3)))
    doubled = area_vectors(triangles) * 2.0
    length = np.linalg.norm(doubled, axis=1)
    sides = [np.linalg.norm(triangles[:, i] - triangles[:, i - 1], axis=1) for i in range(3)]
    longest = np.maximum(np.maximum(sides[0], sides[1]), sides[2])
    broad = length > _THINNEST * size * longest
    kept, normals = triangles[broad], doubled[broad] / length[broad, None]
    best, place, count, tried = 0.0, np.zeros(3), 0, 0
    crossed = np.zeros(len(kept), dtype=bool)
    pairs = meeting_boxes(low[broad], high[broad]) if len(kept) > 1 else ()
    for first, second in pairs:
        tried += len(first)
        if tried > MOST_PAIRS:
            break
        one, two, lengths, places = _lines(kept, normals, first, second, DEPTH * size)
        count += int((lengths > 0.0).sum())
        crossed[one[lengths > 0.0]] = crossed[two[lengths > 0.0]] = True
        if len(lengths) and lengths.max() > best:
            best, place = float(lengths.max()), places[int(np.argmax(lengths))]
    return Piercing(count, place, np.flatnonzero(broad)[crossed], tried <= MOST_PAIRS)


def _lines(
    triangles: FloatArray, normals: FloatArray, one: IntArray, two: IntArray, slack: float
) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Pairs that may cross, lengths and middles of the lines in which they do, by more than `slack` or zero."""
    first, keep = _heights(triangles[one], triangles[two, 0], normals[two], slack)
    one, two, first = one[keep], two[keep], first[keep]
    second, keep = _heights(triangles[two], triangles[one, 0], normals[one], slack)
    one, two, first, second = one[keep], two[keep], first[keep], second[keep]
    along = np.cross(normals[one], normals[two])
    along /= np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    start, end, ends = _within(triangles[one], first, along)
    other_start, other_end, _ = _within(triangles[two], second, along)
    begin, finish = np.maximum(start, other_start), np.minimum(end, other_end)
    place = ends + along * (0.5 * (begin + finish) - start)[:, None]
    return one, two, np.where(finish - begin > slack, finish - begin, 0.0), place


def _heights(corners: FloatArray, point: FloatArray, normal: FloatArray, slack: float) -> tuple[FloatArray, BoolArray]:
    """Heights of corners over a plane, and of which triangles they lie on both sides of it."""
    heights = np.einsum("kci,ki->kc", corners - point[:, None], normal)
    above, below = heights > slack, heights < -slack
    return heights, (above[:, 0] | above[:, 1] | above[:, 2]) & (below[:, 0] | below[:, 1] | below[:, 2])


def _within(corners: FloatArray, heights: FloatArray, along: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Start and end along the common line of the piece inside the triangle, and the point where it starts."""
    before, above = np.roll(corners, 1, axis=1), np.roll(heights, 1, axis=1)
    crosses = (heights > 0.0) != (above > 0.0)
    share = np.divide(heights, heights - above, out=np.zeros_like(heights), where=crosses)
    points = corners + share[..., None] * (before - corners)
    places = np.einsum("kci,ki->kc", points, along)
    first = np.where(crosses, places, np.inf)
    at = np.argmin(first, axis=1)
    rows = np.arange(len(at))
    return first[rows, at], np.where(crosses, places, -np.inf).max(axis=1), points[rows, at]


_CHUNK = 200_000


def meeting_boxes(low: FloatArray, high: FloatArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Return the pairs of boxes that have a point in common, a piece at a time."""
    # The boxes are halved at the median of their middles, along the longest side of each half, down to single ones; the
    # tree is then walked against itself from its root. Memory stays bounded, however many pairs there are.
    order = _halved(0.5 * (low + high))
    layers = _layers(order, low, high)
    stack = [(0, np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64))]
    while stack:
        depth, one, two = stack.pop()
        if depth + 1 == len(layers):
            apart = one != two
            yield order[one[apart]], order[two[apart]]
            continue
        left = np.concatenate([2 * one, 2 * one, 2 * one + 1, 2 * one + 1])
        right = np.concatenate([2 * two, 2 * two + 1, 2 * two, 2 * two + 1])
        one, two = left[left <= right], right[left <= right]
        bottom, top = layers[depth + 1]
        keep = np.ones(len(one), dtype=bool)
        for low_, high_ in zip(bottom.T, top.T, strict=True):
            keep &= (low_[one] <= high_[two]) & (low_[two] <= high_[one])
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
        # an axis at a time: that is what is quick
        axis = np.argmax([np.ptp(places[..., i], axis=1) for i in range(3)], axis=0)
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
            "the surface passes through itself, most plainly near {point}; {pairs} pair(s) of faces cross",
            point=place_words(middle + found.place), pairs=found.pairs, hint=_REPAIR,
        )  # fmt: skip
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
            "the surface passes through itself or is inside out in part: it winds {turns} times round the point near "
            "{point}, where a body has 1 and its surroundings 0", turns=int(times[worst]),
            point=place_words(middle + points[worst]), hint=_REPAIR,
        )  # fmt: skip
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
