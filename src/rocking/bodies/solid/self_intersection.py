"""Detection of self-intersections of a closed surface, by pairs of faces and by winding numbers near faces."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from rocking.bodies.solid.surfaces import area_vectors, boxes, coordinates_text
from rocking.bodies.solid.triangles import largest_extent
from rocking.bodies.solid.winding import winding
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError

DEPTH = 1e-6  # largest crossing length / size of touching faces [-]
MOST_PAIRS = 20_000_000  # largest number of checked pairs of faces with overlapping boxes [-]
PROBED = 500  # number of faces with a check of the winding number [-]
_THINNEST = 1e-7  # smallest height / size of a checked triangle [-]
_CHUNK = 200_000  # number of pairs of tree nodes that are compared together [-]


@dataclass(frozen=True)
class Crossings:
    """Crossing faces of a surface."""

    pairs: int  # number of crossing pairs
    location: FloatArray  # middle of the longest line of intersection [m]; shape (3,)
    faces: IntArray  # indices of the crossing faces
    complete: bool  # True if every pair was checked


def find_crossings(triangles: FloatArray) -> Crossings:
    """Return the crossing triangles. Touching triangles, and triangles with common corners or edges, do not cross."""
    # Two triangles cross if each has corners on both sides of the other's plane, and if their segments of the common
    # line of both planes overlap (T. Moeller, "A fast triangle-triangle intersection test", 1997), all by more than
    # 1e-6 of the size. Triangles in one plane, and triangles thinner than 1e-7 of the size, do not cross.
    low, high = boxes(triangles)
    size = float(max(high[:, i].max() - low[:, i].min() for i in range(3)))
    doubled = area_vectors(triangles) * 2.0
    length = np.linalg.norm(doubled, axis=1)
    sides = [np.linalg.norm(triangles[:, i] - triangles[:, i - 1], axis=1) for i in range(3)]
    longest = np.maximum(np.maximum(sides[0], sides[1]), sides[2])
    is_broad = length > _THINNEST * size * longest
    kept, normals = triangles[is_broad], doubled[is_broad] / length[is_broad, None]
    longest_line, location, count, tried = 0.0, np.zeros(3), 0, 0
    crossed = np.zeros(len(kept), dtype=bool)
    pairs = overlapping_boxes(low[is_broad], high[is_broad]) if len(kept) > 1 else ()
    for first, second in pairs:
        tried += len(first)
        if tried > MOST_PAIRS:
            break
        left, right, lengths, locations = _lines(kept, normals, first, second, DEPTH * size)
        count += int((lengths > 0.0).sum())
        crossed[left[lengths > 0.0]] = crossed[right[lengths > 0.0]] = True
        if len(lengths) and lengths.max() > longest_line:
            longest_line, location = float(lengths.max()), locations[int(np.argmax(lengths))]
    return Crossings(count, location, np.flatnonzero(is_broad)[crossed], tried <= MOST_PAIRS)


def _lines(
    triangles: FloatArray, normals: FloatArray, left: IntArray, right: IntArray, slack: float
) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Return candidate pairs, and lengths and middles of their lines of intersection. Lengths up to `slack` are 0."""
    first, keep = _heights(triangles[left], triangles[right, 0], normals[right], slack)
    left, right, first = left[keep], right[keep], first[keep]
    second, keep = _heights(triangles[right], triangles[left, 0], normals[left], slack)
    left, right, first, second = left[keep], right[keep], first[keep], second[keep]
    along = np.cross(normals[left], normals[right])
    along /= np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    start, end, ends = _within(triangles[left], first, along)
    other_start, other_end, _ = _within(triangles[right], second, along)
    begin, finish = np.maximum(start, other_start), np.minimum(end, other_end)
    middle = ends + along * (0.5 * (begin + finish) - start)[:, None]
    return left, right, np.where(finish - begin > slack, finish - begin, 0.0), middle


def _heights(corners: FloatArray, point: FloatArray, normal: FloatArray, slack: float) -> tuple[FloatArray, BoolArray]:
    """Return heights of corners over a plane, and True for triangles with corners on both sides."""
    heights = np.einsum("kci,ki->kc", corners - point[:, None], normal)
    above, below = heights > slack, heights < -slack
    return heights, (above[:, 0] | above[:, 1] | above[:, 2]) & (below[:, 0] | below[:, 1] | below[:, 2])


def _within(corners: FloatArray, heights: FloatArray, along: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return start and end of the segment of the common line inside the triangle, and its start point."""
    before, above = np.roll(corners, 1, axis=1), np.roll(heights, 1, axis=1)
    crosses = (heights > 0.0) != (above > 0.0)
    fraction = np.divide(heights, heights - above, out=np.zeros_like(heights), where=crosses)
    points = corners + fraction[..., None] * (before - corners)
    positions = np.einsum("kci,ki->kc", points, along)
    first = np.where(crosses, positions, np.inf)
    index = np.argmin(first, axis=1)
    rows = np.arange(len(index))
    return first[rows, index], np.where(crosses, positions, -np.inf).max(axis=1), points[rows, index]


def overlapping_boxes(low: FloatArray, high: FloatArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield the pairs of overlapping boxes, in chunks."""
    # A binary tree divides the boxes at the median of their middles, along the longest side. The search compares the
    # tree with itself from the root, with bounded memory.
    order = _halved(0.5 * (low + high))
    layers = _layers(order, low, high)
    stack = [(0, np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64))]
    while stack:
        depth, first, second = stack.pop()
        if depth + 1 == len(layers):
            apart = first != second
            yield order[first[apart]], order[second[apart]]
            continue
        left = np.concatenate([2 * first, 2 * first, 2 * first + 1, 2 * first + 1])
        right = np.concatenate([2 * second, 2 * second + 1, 2 * second, 2 * second + 1])
        first, second = left[left <= right], right[left <= right]
        bottom, top = layers[depth + 1]
        keep = np.ones(len(first), dtype=bool)
        for low_, high_ in zip(bottom.T, top.T, strict=True):
            keep &= (low_[first] <= high_[second]) & (low_[second] <= high_[first])
        first, second = first[keep], second[keep]
        stack += [(depth + 1, first[i : i + _CHUNK], second[i : i + _CHUNK]) for i in range(0, len(first), _CHUNK)]


def _halved(middles: FloatArray) -> IntArray:
    """Return the indices of the boxes in the order of the tree; repeated indices give a power of two."""
    full = 1 << max(0, len(middles) - 1).bit_length()
    padded = middles[np.minimum(np.arange(full), len(middles) - 1)]
    order = np.arange(full)
    for depth in range(full.bit_length() - 1):
        groups = order.reshape(1 << depth, -1)
        places = padded[groups]
        # a loop over the axes is faster
        axis = np.argmax([np.ptp(places[..., i], axis=1) for i in range(3)], axis=0)
        along = np.take_along_axis(places, axis[:, None, None], axis=2)[..., 0]
        order = np.take_along_axis(groups, np.argsort(along, axis=1, kind="stable"), axis=1).ravel()
    return order


def _layers(order: IntArray, low: FloatArray, high: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """Return the boxes of the nodes, from the root to the leaves; padding has empty boxes."""
    real = (order < len(low))[:, None]
    numbers = np.minimum(order, len(low) - 1)
    layers = [(np.where(real, low[numbers], np.inf), np.where(real, high[numbers], -np.inf))]
    while len(layers[-1][0]) > 1:
        below = layers[-1]
        layers.append((below[0].reshape(-1, 2, 3).min(axis=1), below[1].reshape(-1, 2, 3).max(axis=1)))
    return layers[::-1]


def check_self_intersection(
    triangles: FloatArray, describe: Callable[[FloatArray], str] = coordinates_text, crossings: Crossings | None = None
) -> bool:
    """Refuse a surface with self-intersections; return True if every pair of faces was checked."""
    # The check of pairs has a resolution of 1e-6 of the size. Near 500 faces, selected by area, the winding number must
    # be 0 or 1 on both sides. This detects inverted lobes, and overlaps that meet in corners and edges only. Not
    # detected: such lobes below about 1 % of the surface, folds within one plane, and crossings below 1e-6 of the size.
    low, high = boxes(triangles)
    middle = 0.5 * np.array([low[:, i].min() + high[:, i].max() for i in range(3)])
    centred = triangles - middle
    crossings = find_crossings(centred) if crossings is None else crossings
    if crossings.pairs:
        raise GeometryError(
            "The surface intersects itself, mainly near {point}; {pairs} pair(s) of faces cross",
            point=describe(middle + crossings.location), pairs=crossings.pairs,
            hint="repair the mesh in the program that wrote it, for instance by a boolean union",
        )  # fmt: skip
    points = _beside(centred)
    turns = winding(points, centred)
    suspects = np.flatnonzero((turns != 0.0) & (turns != 1.0))
    # a line through an edge can give a wrong number, so all three axes must agree
    for axes in ([1, 2, 0], [2, 0, 1]):
        turns_again = winding(points[suspects][:, axes], centred[..., axes])
        suspects = suspects[(turns_again != 0.0) & (turns_again != 1.0)]
    if len(suspects):
        worst = suspects[0]
        raise GeometryError(
            "The surface intersects itself or is partly inverted: its winding number near {point} is {turns}, and must "
            "be 0 or 1", turns=int(turns[worst]),
            point=describe(middle + points[worst]),
            hint="repair the mesh in the program that wrote it, for instance by a boolean union",
        )  # fmt: skip
    return crossings.complete


def _beside(triangles: FloatArray) -> FloatArray:
    """Return points slightly inside and outside some faces, away from their edges."""
    generator = np.random.default_rng(0)
    vectors = area_vectors(triangles)
    areas = np.linalg.norm(vectors, axis=1)
    size = largest_extent(triangles.reshape(-1, 3))
    usable = np.flatnonzero(areas > 1e-12 * size**2)
    count = min(PROBED, len(usable))
    chosen = generator.choice(usable, count, replace=False, p=areas[usable] / areas[usable].sum())
    corner_weights = generator.dirichlet((4.0, 4.0, 4.0), count)
    points = np.einsum("kc,kci->ki", corner_weights, triangles[chosen])
    # this distance is above the limit of touching faces
    offsets = vectors[chosen] / areas[chosen, None] * (3.0 * DEPTH * size)
    return np.concatenate([points - offsets, points + offsets])
