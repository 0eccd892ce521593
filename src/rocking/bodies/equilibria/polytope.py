"""The convex hull of a body as a polyhedron about its centre of mass: facets, edges, vertices, coplanar ones merged."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError

FLAT = 1e-7  # facets whose neighbours' corners lie this close to their plane are one facet, relative to the body's size
_DIRECTIONS = (30, 200)
_MANY = 20_000
_COARSE = 1e-9

_ENDLESS = "the descent of the centre of mass does not end: is the hull degenerate?"

Surface = tuple[FloatArray, IntArray, IntArray]


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
        distance: FloatArray = sign * (start[:, None, :] * across).sum(axis=2)  # Eq. 244
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
        corner, _, first = self.borders
        return corner[first[facet] : first[facet + 1]]

    @cached_property
    def borders(self) -> tuple[IntArray, IntArray, IntArray]:
        """Corners of all facets, counter-clockwise seen from outside, the facets beyond their edges, where each starts.

        A corner is followed by the facet that lies beyond the edge which starts there.
        """
        order, first = self._by_facet
        edge, side = np.divmod(order, 2)
        owner = np.repeat(np.arange(len(self.normals)), np.diff(first))
        corner = self.ends[edge, side]
        arms = (
            self.vertices[corner]
            - (np.add.reduceat(self.vertices[corner], first[:-1]) / np.diff(first)[:, None])[owner]
        )
        ahead = arms[np.lexsort((corner, owner))[first[:-1]]][owner]
        across = np.cross(self.normals[owner], ahead)
        turned = np.lexsort((np.arctan2((arms * across).sum(axis=1), (arms * ahead).sum(axis=1)), owner))
        return corner[turned], self.sides[edge, 1 - side][turned], first

    def descent(self, vertex: int, down: FloatArray) -> int:
        """Return the stable facet to which the steepest descent of the centre leads, from a contact on a vertex."""
        # vertex: the lowest one where `down` (unit vector, in the body's frame) is downward
        return self.rolled(self._swung(vertex, down))

    def rolled(self, facet: int) -> int:
        """Return the stable facet to which the steepest descent leads from a facet: itself, if it is stable."""
        for _ in range(len(self.normals)):
            if self.stable[facet]:
                return facet
            edges, side = self.edges_of(facet)
            facing = np.flatnonzero(self._facing[edges, side])
            facet = int(self.sides[edges[facing[0]], 1 - side[facing[0]]]) if len(facing) else self._tipped(facet)
        raise GeometryError(_ENDLESS)

    @cached_property
    def rolls(self) -> IntArray:
        """The stable facet to which the steepest descent leads from each facet; shape (f,)."""
        order, first = self._by_facet
        edge, side = np.divmod(order, 2)
        owner = np.repeat(np.arange(len(self.normals)), np.diff(first))
        hits = np.flatnonzero(self._facing[edge, side])
        found, place = np.unique(owner[hits], return_index=True)
        following = np.arange(len(self.normals))
        following[found] = self.sides[edge, 1 - side][hits[place]]
        for facet in np.setdiff1d(np.flatnonzero(~self.stable), found).tolist():
            following[facet] = self._tipped(facet)
        following[self.stable] = np.flatnonzero(self.stable)
        for _ in range(len(self.normals).bit_length()):
            following = following[following]
        if not self.stable[following].all():
            raise GeometryError(_ENDLESS)
        return following

    @cached_property
    def _facing(self) -> BoolArray:
        """Over which edges, left or right, the centre's foot leaves a facet between their ends; shape (e, 2)."""
        outside: BoolArray = (self.inward <= 0.0) & ((self.beyond[:, :1] <= 0.0) & (self.beyond[:, 1:] >= 0.0))
        return outside

    def _tipped(self, facet: int) -> int:
        """Return where the descent leads from a facet that it leaves over a corner."""
        corners = np.unique(self.ends[self.edges_of(facet)[0]])
        foot = self.heights[facet] * self.normals[facet]
        nearest = np.argmin(((self.vertices[corners] - foot) ** 2).sum(axis=1))
        return self._swung(int(corners[nearest]), self.normals[facet])

    def _swung(self, vertex: int, down: FloatArray) -> int:
        """Return the facet that the steepest descent reaches first."""
        for _ in range(len(self.ends)):
            lever = down * float(down @ self.vertices[vertex]) - self.vertices[vertex]
            edges, end = self.edges_at(vertex)
            others = self.ends[edges, 1 - end]
            chords = self.vertices[others] - self.vertices[vertex]
            rate = chords @ lever
            gap = np.where(rate > 0.0, np.maximum(-(chords @ down), 0.0) / np.where(rate > 0.0, rate, 1.0), np.inf)
            first = int(np.argmin(gap))  # Eq. 245
            if not math.isfinite(gap[first]):  # on a summit it falls any way
                return int(self.sides[edges[first], 0])
            turned = down + float(gap[first]) * lever
            down = turned / np.linalg.norm(turned)
            edge, vertex = int(edges[first]), int(others[first])
            if self.beyond[edge, 0] < 0.0 < self.beyond[edge, 1]:
                # a valley between two vertices: on along the edge, away from the direction of its foot
                ahead = self.normals[self.sides[edge]] @ (self.feet[edge] - down * float(down @ self.feet[edge]))
                return int(self.sides[edge, int(np.argmin(ahead))])
        raise GeometryError(_ENDLESS)

    def climbed(self, vertex: int) -> int:
        """Return the summit to which the centre climbs from a vertex, each towards the one that is then lowest."""
        while not self.summits[vertex]:
            vertex = int(np.argmax(self.vertices @ self.vertices[vertex]))
        return vertex


def polytope(points: FloatArray, centre: FloatArray, faces: IntArray | None = None) -> Polytope:
    """Return the convex hull of points about a centre; facets within 1e-7 of the size of one plane are merged."""
    # faces: triangles of the surface; if it is convex it is its own hull, which is not sought
    around = points - centre
    flat = FLAT * float(np.ptp(around, axis=0).max())
    if faces is not None and (surface := _closed(around, faces)) is not None:
        slopes = _slopes(*surface)
        if float(slopes.drop.min()) > -0.01 * flat:
            return _merged(*surface, slopes, flat)
    surface = _hull(_outer(around))
    return _merged(*surface, _slopes(*surface), flat)


def _hull(points: FloatArray) -> Surface:
    """Return corners, triangles counter-clockwise seen from outside, and their neighbours across from each corner."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(points)
    except QhullError as error:
        raise GeometryError("the points span no volume: are they flat, or too few?") from error
    triangles, beside = hull.simplices.astype(np.int64), hull.neighbors.astype(np.int64)
    a, b, c = (hull.points[column] for column in triangles.T)
    turn = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    triangles[turn], beside[turn] = triangles[turn][:, [0, 2, 1]], beside[turn][:, [0, 2, 1]]
    return hull.points, triangles, beside


def _closed(points: FloatArray, faces: IntArray) -> Surface | None:
    """Return a surface of triangles with their neighbours, if it is closed as a ball's."""
    start, end = np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
    if len(faces) % 2 or np.count_nonzero(np.bincount(start)) != len(faces) // 2 + 2:
        return None
    key = np.minimum(start, end) * len(points) + np.maximum(start, end)
    first, second = np.argsort(key, kind="stable").reshape(-1, 2).T
    if not (np.diff(key[first]).all() and (key[first] == key[second]).all() and (start[first] == end[second]).all()):
        return None
    beside = np.empty(len(key), dtype=np.int64)
    beside[first], beside[second] = second // 3, first // 3
    return points, faces, beside.reshape(faces.shape)


def _outer(points: FloatArray) -> FloatArray:
    """Return the points that may lie on the hull: those outside the hull of the farthest ones in some directions."""
    from scipy.spatial import ConvexHull, QhullError

    kept, size = points, float(np.abs(points).max())
    for count in _DIRECTIONS:
        if len(kept) < _MANY:
            break
        turn = np.arange(count) + 0.5
        z, phi = 1.0 - 2.0 * turn / count, np.pi * (1.0 + np.sqrt(5.0)) * turn
        around = np.stack([np.sqrt(1.0 - z * z) * np.cos(phi), np.sqrt(1.0 - z * z) * np.sin(phi), z], axis=1)
        columns = kept.T.copy()
        farthest = {int(np.argmax(_along(columns, direction))) for direction in around}
        try:
            planes = ConvexHull(kept[sorted(farthest)]).equations
        except QhullError:
            break
        outside = np.zeros(len(kept), dtype=bool)
        for plane in planes:
            outside |= _along(columns, plane) > -plane[3] - _COARSE * size
        if 2 * outside.sum() > len(kept):
            break
        kept = kept[outside]
    return kept


def _along(columns: FloatArray, direction: FloatArray) -> FloatArray:
    # three products, no BLAS: a million points in columns are read once
    height: FloatArray = columns[0] * direction[0] + columns[1] * direction[1] + columns[2] * direction[2]
    return height


@dataclass(frozen=True, eq=False)
class Slopes:
    """How triangles lie to their neighbours."""

    areas: FloatArray  # twice their area vectors [m2]; shape (m, 3)
    normals: FloatArray  # unit normals [-]; shape (m, 3)
    heights: FloatArray  # distances of their planes from the origin [m]; shape (m,)
    drop: FloatArray  # how far below the plane the far corner of each neighbour lies [m]; shape (m, 3)


def _slopes(corners: FloatArray, triangles: IntArray, beside: IntArray) -> Slopes:
    a, b, c = (corners[column] for column in triangles.T)
    areas = np.cross(b - a, c - a)
    length = np.linalg.norm(areas, axis=1, keepdims=True)
    normals = areas / np.where(length > 0.0, length, 1.0)
    heights, total = (a * normals).sum(axis=1), triangles.sum(axis=1)
    far = total[beside] - (total[:, None] - triangles)
    drop = np.stack([heights - (corners[column] * normals).sum(axis=1) for column in far.T], axis=1)
    return Slopes(areas, normals, heights, drop)


def _merged(corners: FloatArray, triangles: IntArray, beside: IntArray, slopes: Slopes, flat: float) -> Polytope:
    """Return the polytope of triangles, coplanar ones as one facet."""
    # the tolerance is lowered until no facet departs from its plane by more than ten times as much
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    normals, heights = slopes.normals, slopes.heights
    count, label = len(triangles), np.arange(len(triangles))
    while (slopes.drop <= flat).any():
        mine, side = np.nonzero(slopes.drop <= flat)
        # a matrix, since SciPy 1.11 walks no arrays of which the numbers are longer
        graph = coo_matrix((np.ones(len(mine), dtype=bool), (mine, beside[mine, side])), shape=(len(triangles),) * 2)
        count, found = connected_components(graph, directed=False)
        label = found.astype(np.int64)
        total = np.stack([np.bincount(label, slopes.areas[:, i], count) for i in range(3)], axis=1)
        normals = total / np.linalg.norm(total, axis=1, keepdims=True)
        place = np.stack([(corners[column] * normals[label]).sum(axis=1) for column in triangles.T], axis=1)
        heights, bottom = np.full(count, -np.inf), np.full(count, np.inf)
        np.maximum.at(heights, label, place.max(axis=1))
        np.minimum.at(bottom, label, place.min(axis=1))
        if flat == 0.0 or (heights - bottom).max() <= 10.0 * flat:
            break
        flat = flat / 100.0 if flat > 1e-20 else 0.0
    left, right = np.repeat(label, 3), label[beside].ravel()
    once = left < right
    left, right = left[once], right[once]
    start, end = (np.roll(triangles, -i, axis=1).ravel()[once] for i in (1, 2))
    if count < len(triangles):
        # pieces of one straight edge, between the same two facets, are put together
        line = np.cross(normals[left], normals[right])
        order = np.lexsort((((corners[start] + corners[end]) * line).sum(axis=1), left * count + right))
        left, right, start, end = left[order], right[order], start[order], end[order]
        on = (left[1:] == left[:-1]) & (right[1:] == right[:-1]) & (start[1:] == end[:-1])
        first, last = np.r_[True, ~on], np.r_[~on, True]
        left, right, start, end = left[first], right[first], start[first], end[last]
    used = np.zeros(len(corners), dtype=bool)
    used[start] = used[end] = True
    number = np.cumsum(used) - 1
    ends, sides = np.stack([number[start], number[end]], axis=1), np.stack([left, right], axis=1)
    return Polytope(corners[used], normals, heights, ends, sides)


def _grouped(members: IntArray, count: int) -> tuple[IntArray, IntArray]:
    """Return the places of members in the order of their values, and where each value starts."""
    from scipy.sparse import coo_matrix

    places = np.arange(members.size)
    # a sparse matrix sorts its rows by counting
    rows = coo_matrix((places, (members.ravel(), places)), shape=(count, members.size)).tocsr()
    return rows.data, rows.indptr.astype(np.int64)
