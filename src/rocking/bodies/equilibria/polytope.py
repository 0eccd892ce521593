"""The convex hull of a body as a polyhedron about its centre of mass: facets, edges, vertices, coplanar ones merged."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError

FLAT = 1e-7
"""Facets whose neighbours' corners lie this close to their plane are one facet, relative to the body's size."""

_DIRECTIONS = 200
_MANY = 20_000


@dataclass(frozen=True, eq=False)
class Polytope:
    """A convex polyhedron, the centre of mass at the origin; an edge runs counter-clockwise round its left facet."""

    vertices: FloatArray  # [m]; shape (n, 3)
    normals: FloatArray  # outward unit normals of the facets [-]; shape (f, 3)
    heights: FloatArray  # distances of their planes from the centre [m]; shape (f,)
    ends: IntArray  # vertices where edges start and end; shape (e, 2)
    sides: IntArray  # facets left and right of them; shape (e, 2)

    @cached_property
    def along(self) -> FloatArray:
        """Unit vectors along the edges [-]; shape (e, 3)."""
        start, end = self.vertices[self.ends.T]
        chord = end - start
        unit: FloatArray = chord / np.linalg.norm(chord, axis=1, keepdims=True)
        return unit

    @cached_property
    def inward(self) -> FloatArray:
        """How far the centre's foot on the left and on the right facet lies inside each edge [m]; shape (e, 2)."""
        start, sign = self.vertices[self.ends[:, 0]], np.array([-1.0, 1.0])
        across = np.cross(self.normals[self.sides], self.along[:, None, :])
        distance: FloatArray = sign * (start[:, None, :] * across).sum(axis=2)  # Eq. 241
        return distance

    @cached_property
    def beyond(self) -> FloatArray:
        """Places of both ends along each edge, from the centre's foot on its line [m]; shape (e, 2)."""
        place: FloatArray = (self.vertices[self.ends] * self.along[:, None, :]).sum(axis=2)
        return place

    @cached_property
    def feet(self) -> FloatArray:
        """The centre's feet on the lines of the edges [m]; shape (e, 3)."""
        foot: FloatArray = self.vertices[self.ends[:, 0]] - self.beyond[:, :1] * self.along
        return foot

    @cached_property
    def stable(self) -> BoolArray:
        """Which facets hold the centre's foot; shape (f,)."""
        held = np.ones(len(self.normals), dtype=bool)
        held[self.sides[self.inward <= 0.0]] = False
        return held

    @cached_property
    def saddles(self) -> BoolArray:
        """Which edges hold the centre's foot, and are supported across the direction to it; shape (e,)."""
        held: BoolArray = (self.inward > 0.0).all(axis=1) & (self.beyond[:, 0] < 0.0) & (self.beyond[:, 1] > 0.0)
        return held

    @cached_property
    def summits(self) -> BoolArray:
        """Which vertices are supported across the direction from the centre to them; shape (n,)."""
        held = np.zeros(len(self.vertices), dtype=bool)
        held[self.ends] = True
        held[self.ends[self.beyond * np.array([-1.0, 1.0]) <= 0.0]] = False
        return held

    @cached_property
    def _by_facet(self) -> tuple[IntArray, IntArray]:
        return _grouped(self.sides, len(self.normals))

    @cached_property
    def _by_vertex(self) -> tuple[IntArray, IntArray]:
        return _grouped(self.ends, len(self.vertices))

    def edges_of(self, facet: int) -> tuple[IntArray, IntArray]:
        """Return the edges of a facet, and on which side of each (0 left, 1 right) it lies."""
        order, first = self._by_facet
        return np.divmod(order[first[facet] : first[facet + 1]], 2)

    def edges_at(self, vertex: int) -> tuple[IntArray, IntArray]:
        """Return the edges at a vertex, and which end of each (0 start, 1 end) it is."""
        order, first = self._by_vertex
        return np.divmod(order[first[vertex] : first[vertex + 1]], 2)

    def corners(self, facet: int) -> IntArray:
        """Return the vertices of a facet, counter-clockwise seen from outside."""
        edges, side = self.edges_of(facet)
        after = dict(zip(self.ends[edges, side].tolist(), self.ends[edges, 1 - side].tolist(), strict=True))
        ring = [min(after)]
        while len(ring) < len(after):
            ring.append(after[ring[-1]])
        return np.array(ring)

    def descent(self, vertex: int, down: FloatArray) -> int:
        """Return the stable facet to which the steepest descent of the centre leads, from a contact on a vertex.

        vertex: the lowest one where `down` (unit vector, in the body's frame) is downward.
        """
        for _ in range(4 * len(self.ends) + 8):
            lever = down * float(down @ self.vertices[vertex]) - self.vertices[vertex]
            edges, end = self.edges_at(vertex)
            others = self.ends[edges, 1 - end]
            chords = self.vertices[others] - self.vertices[vertex]
            rate = chords @ lever
            gap = np.where(rate > 0.0, np.maximum(-(chords @ down), 0.0) / np.where(rate > 0.0, rate, 1.0), np.inf)
            first = int(np.argmin(gap))  # Eq. 242
            turned = down + float(gap[first]) * lever
            down = turned / np.linalg.norm(turned)
            edge, vertex = int(edges[first]), int(others[first])
            if self.beyond[edge, 0] < 0.0 < self.beyond[edge, 1]:
                # a valley between two vertices: on along the edge, away from the direction of its foot
                left = self.normals[self.sides[edge, 0]]
                falls = float(self.feet[edge] @ (left - down * float(left @ down))) < 0.0
                return self.rolled(int(self.sides[edge, 0 if falls else 1]))
        raise GeometryError("the descent of the centre of mass does not end: is the hull degenerate?")

    def rolled(self, facet: int) -> int:
        """Return the stable facet to which the steepest descent leads from a facet: itself, if it is stable."""
        for _ in range(len(self.normals) + 1):
            if self.stable[facet]:
                return facet
            edges, side = self.edges_of(facet)
            outside = self.inward[edges, side] <= 0.0
            facing = outside & (self.beyond[edges, 0] <= 0.0) & (self.beyond[edges, 1] >= 0.0)
            if not facing.any():
                corners = np.unique(self.ends[edges])
                foot = self.heights[facet] * self.normals[facet]
                nearest = np.argmin(((self.vertices[corners] - foot) ** 2).sum(axis=1))
                return self.descent(int(corners[nearest]), self.normals[facet])
            which = int(np.argmax(facing))
            facet = int(self.sides[edges[which], 1 - side[which]])
        raise GeometryError("the descent of the centre of mass does not end: is the hull degenerate?")

    def climbed(self, vertex: int) -> int:
        """Return the summit to which the centre climbs from a vertex, each towards the one that is then lowest."""
        while not self.summits[vertex]:
            vertex = int(np.argmax(self.vertices @ self.vertices[vertex]))
        return vertex


def polytope(points: FloatArray, centre: FloatArray, tolerance: float | None = None) -> Polytope:
    """Return the convex hull of points about a centre, coplanar facets merged.

    tolerance: how far from a facet's plane the corners of its neighbours lie that are one with it [m]; by default
    1e-7 of the size. It is lowered until no merged facet departs from its plane by more than ten times as much.
    """
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(_outer(points - centre))
    except QhullError as error:
        raise GeometryError("the points span no volume: are they flat, or too few?") from error
    corners, flat = hull.points, FLAT * float(np.ptp(hull.points, axis=0).max())
    flat = flat if tolerance is None else tolerance
    normals, triangles = hull.equations[:, :3], hull.simplices.astype(np.int64)
    a, b, c = np.moveaxis(corners[triangles], 1, 0)
    areas = np.cross(b - a, c - a)
    turn = (areas * normals).sum(axis=1) < 0.0
    triangles[turn] = triangles[turn][:, [0, 2, 1]]
    neighbours = hull.neighbors.astype(np.int64)
    neighbours[turn] = neighbours[turn][:, [0, 2, 1]]
    areas[turn] *= -1.0
    label, normals, heights = _merged(corners, triangles, neighbours, normals, areas, flat)
    return _edges(corners, triangles, label[neighbours], label, normals, heights)


def _outer(points: FloatArray) -> FloatArray:
    """Return the points that may lie on the hull: those outside the hull of the farthest ones in many directions."""
    if len(points) < _MANY:
        return points
    from scipy.spatial import ConvexHull, QhullError

    turn = np.arange(_DIRECTIONS) + 0.5
    z, phi = 1.0 - 2.0 * turn / _DIRECTIONS, np.pi * (1.0 + np.sqrt(5.0)) * turn
    around = np.stack([np.cos(phi), np.sin(phi)]) * np.sqrt(1.0 - z * z)
    farthest = np.unique([int(np.argmax(points @ direction)) for direction in np.array([*around, z]).T])
    try:
        inner = ConvexHull(points[farthest])
    except QhullError:
        return points
    slack = 1e-9 * float(np.ptp(points, axis=0).max())
    outside = np.zeros(len(points), dtype=bool)
    for plane in inner.equations:
        outside |= points @ plane[:3] > -plane[3] - slack
    return points[outside]


def _merged(
    corners: FloatArray, triangles: IntArray, neighbours: IntArray, planes: FloatArray, areas: FloatArray, flat: float
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the facet of every triangle, and the facets' normals and heights."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    heights = (corners[triangles[:, 0]] * planes).sum(axis=1)
    mine = np.repeat(np.arange(len(triangles)), 3)
    theirs = neighbours.ravel()
    # how far the farthest corner of a neighbour lies below the plane
    drop = heights[mine] - (corners[triangles[theirs]] * planes[mine][:, None, :]).sum(axis=2).min(axis=1)
    while True:
        level = drop <= flat
        graph = coo_array((level[level], (mine[level], theirs[level])), shape=(len(triangles),) * 2)
        count, label = connected_components(graph, directed=False)
        total = np.stack([np.bincount(label, areas[:, i], count) for i in range(3)], axis=1)
        normals = total / np.linalg.norm(total, axis=1, keepdims=True)
        place = (corners[triangles] * normals[label][:, None, :]).sum(axis=2)
        top, bottom = np.full(count, -np.inf), np.full(count, np.inf)
        np.maximum.at(top, label, place.max(axis=1))
        np.minimum.at(bottom, label, place.min(axis=1))
        if flat == 0.0 or (top - bottom).max() <= 10.0 * flat:
            return label.astype(np.int64), normals, top
        flat = flat / 100.0 if flat > 1e-20 else 0.0


def _edges(
    corners: FloatArray,
    triangles: IntArray,
    beside: IntArray,
    label: IntArray,
    normals: FloatArray,
    heights: FloatArray,
) -> Polytope:
    left = np.repeat(label, 3)
    right, start, end = beside.ravel(), np.roll(triangles, -1, 1).ravel(), np.roll(triangles, -2, 1).ravel()
    once = left < right
    left, right, start, end = left[once], right[once], start[once], end[once]
    # pieces of one straight edge, between the same two facets, are put together
    line = np.cross(normals[left], normals[right])
    pair = left * len(normals) + right
    first = np.lexsort(((corners[start] * line).sum(axis=1), pair))
    last = np.lexsort((-(corners[end] * line).sum(axis=1), pair))
    _, where = np.unique(pair[first], return_index=True)
    ends = np.stack([start[first[where]], end[last[where]]], axis=1)
    sides = np.stack([left[first[where]], right[first[where]]], axis=1)
    used, number = np.unique(ends, return_inverse=True)
    return Polytope(corners[used], normals, heights, number.reshape(ends.shape), sides)


def _grouped(members: IntArray, count: int) -> tuple[IntArray, IntArray]:
    flat = members.ravel()
    order = np.argsort(flat, kind="stable")
    return order, np.searchsorted(flat[order], np.arange(count + 1))
