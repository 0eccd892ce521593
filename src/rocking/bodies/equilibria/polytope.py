"""The convex hull of a body about its centre of mass: facets (coplanar ones merged), edges and vertices."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError

FLAT = 1e-7  # largest distance of corners from the common plane of merged facets / size of the body
_DIRECTIONS = (30, 200)
_MANY = 20_000
_COARSE = 1e-9

_ENDLESS = "The descent of the centre of mass does not end. Check for a degenerate hull."

Surface = tuple[FloatArray, IntArray, IntArray]


@dataclass(frozen=True, eq=False)
class Polytope:
    """A convex polyhedron with the centre of mass at the origin; edges are counter-clockwise on their left facet."""

    vertices: FloatArray  # positions of the vertices [m]; shape (n, 3)
    normals: FloatArray  # outward unit normals of the facets [-]; shape (f, 3)
    heights: FloatArray  # distances of the facets from the centre of mass [m]; shape (f,)
    ends: IntArray  # start and end vertex of each edge; shape (e, 2)
    sides: IntArray  # left and right facet of each edge; shape (e, 2)

    @cached_property
    def along(self) -> FloatArray:
        """Unit vectors along the edges [-]; shape (e, 3)."""
        start, end = self.vertices[self.ends.T]
        chord = end - start
        unit: FloatArray = chord / np.linalg.norm(chord, axis=1, keepdims=True)
        return unit

    @cached_property
    def inward(self) -> FloatArray:
        """Distances of edges from projections of the centre of mass on the left and right facet [m]; shape (e, 2)."""
        start, sign = self.vertices[self.ends[:, 0]], np.array([-1.0, 1.0])
        across = np.cross(self.normals[self.sides], self.along[:, None, :])
        distance: FloatArray = sign * (start[:, None, :] * across).sum(axis=2)  # Eq. 244
        return distance

    @cached_property
    def beyond(self) -> FloatArray:
        """Positions of both ends of edges, from the projection of the centre of mass on the line [m]; shape (e, 2)."""
        position: FloatArray = (self.vertices[self.ends] * self.along[:, None, :]).sum(axis=2)
        return position

    @cached_property
    def feet(self) -> FloatArray:
        """Projections of the centre of mass on the lines of the edges [m]; shape (e, 3)."""
        foot: FloatArray = self.vertices[self.ends[:, 0]] - self.beyond[:, :1] * self.along
        return foot

    @cached_property
    def stable(self) -> BoolArray:
        """True for facets that contain the projection of the centre of mass; shape (f,)."""
        is_stable = np.ones(len(self.normals), dtype=bool)
        is_stable[self.sides[self.inward <= 0.0]] = False
        return is_stable

    @cached_property
    def saddles(self) -> BoolArray:
        """True for edges with a saddle: edge and both facets contain a projection of the centre of mass; shape (e,)."""
        is_saddle: BoolArray = (self.inward > 0.0).all(axis=1) & (self.beyond[:, 0] < 0.0) & (self.beyond[:, 1] > 0.0)
        return is_saddle

    @cached_property
    def summits(self) -> BoolArray:
        """True for vertices with a summit: farther from the centre of mass than all nearby points; shape (n,)."""
        is_summit = np.zeros(len(self.vertices), dtype=bool)
        is_summit[self.ends] = True
        is_summit[self.ends[self.beyond * np.array([-1.0, 1.0]) <= 0.0]] = False
        return is_summit

    @cached_property
    def _by_facet(self) -> tuple[IntArray, IntArray]:
        return _grouped(self.sides, len(self.normals))

    @cached_property
    def _by_vertex(self) -> tuple[IntArray, IntArray]:
        return _grouped(self.ends, len(self.vertices))

    def edges_of(self, facet: int) -> tuple[IntArray, IntArray]:
        """Return the edges of a facet, and the position of the facet relative to each edge (0 left, 1 right)."""
        order, first = self._by_facet
        return np.divmod(order[first[facet] : first[facet + 1]], 2)

    def edges_at(self, vertex: int) -> tuple[IntArray, IntArray]:
        """Return the edges at a vertex, and the position of the vertex on each edge (0 start, 1 end)."""
        order, first = self._by_vertex
        return np.divmod(order[first[vertex] : first[vertex + 1]], 2)

    def corners(self, facet: int) -> IntArray:
        """Return the vertices of a facet, counter-clockwise seen from outside."""
        corner, _, first = self.borders
        return corner[first[facet] : first[facet + 1]]

    @cached_property
    def borders(self) -> tuple[IntArray, IntArray, IntArray]:
        """Corners of all facets, the adjacent facet at the edge after each corner, and the first index of each facet.

        The corners are counter-clockwise seen from outside.
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
        """Return the stable facet after the steepest descent of the centre of mass from a contact on a vertex."""
        # `vertex` is the lowest vertex for the downward unit vector `down` in the body's frame
        return self.rolled(int(self._swung(np.array([vertex]), np.asarray(down)[None])[0]))

    def rolled(self, facet: int) -> int:
        """Return the stable facet at the end of the steepest descent from a facet; for a stable facet, itself."""
        for _ in range(len(self.normals)):
            if self.stable[facet]:
                return facet
            edges, side = self.edges_of(facet)
            facing = np.flatnonzero(self._facing[edges, side])
            if len(facing):
                facet = int(self.sides[edges[facing[0]], 1 - side[facing[0]]])
            else:
                facet = int(self._tipped(np.array([facet]))[0])
        raise GeometryError(_ENDLESS)

    @cached_property
    def rolls(self) -> IntArray:
        """Stable facet at the end of the steepest descent from each facet; shape (f,)."""
        order, first = self._by_facet
        edge, side = np.divmod(order, 2)
        owner = np.repeat(np.arange(len(self.normals)), np.diff(first))
        hits = np.flatnonzero(self._facing[edge, side])
        tilting, first_hit = np.unique(owner[hits], return_index=True)
        following = np.arange(len(self.normals))
        following[tilting] = self.sides[edge, 1 - side][hits[first_hit]]
        tipping = np.setdiff1d(np.flatnonzero(~self.stable), tilting)
        following[tipping] = self._tipped(tipping)
        following[self.stable] = np.flatnonzero(self.stable)
        for _ in range(len(self.normals).bit_length()):
            following = following[following]
        if not self.stable[following].all():
            raise GeometryError(_ENDLESS)
        return following

    @cached_property
    def _facing(self) -> BoolArray:
        """True if the projection of the centre of mass leaves the left or right facet at the edge; shape (e, 2)."""
        outside: BoolArray = (self.inward <= 0.0) & ((self.beyond[:, :1] <= 0.0) & (self.beyond[:, 1:] >= 0.0))
        return outside

    def _tipped(self, facets: IntArray) -> IntArray:
        """Return the next facet of each descent that leaves a facet through a corner."""
        corner, _, first = self.borders
        owner, index = _listed(first, facets)
        corners, feet = corner[index], self.heights[facets, None] * self.normals[facets]
        distance = ((self.vertices[corners] - feet[owner]) ** 2).sum(axis=1)
        order = np.lexsort((corners, distance, owner))
        nearest = corners[order][np.unique(owner, return_index=True)[1]]
        return self._swung(nearest, self.normals[facets])

    def _swung(self, vertices: IntArray, down: FloatArray) -> IntArray:
        """Return the first facet of the steepest descent from each vertex."""
        facets, active = np.full(len(vertices), -1, dtype=np.int64), np.arange(len(vertices))
        order, first = self._by_vertex
        for _ in range(len(self.ends)):
            owner, index = _listed(first, vertices)
            edges, end = np.divmod(order[index], 2)
            others, start = self.ends[edges, 1 - end], self.vertices[vertices]
            lever = down * (down * start).sum(axis=1, keepdims=True) - start
            chords = self.vertices[others] - start[owner]
            rate = (chords * lever[owner]).sum(axis=1)
            fall = np.maximum(-(chords * down[owner]).sum(axis=1), 0.0)
            gap = np.where(rate > 0.0, fall / np.where(rate > 0.0, rate, 1.0), np.inf)
            smallest = np.minimum.reduceat(gap, np.flatnonzero(np.diff(owner, prepend=-1)))
            hits = np.flatnonzero(gap == smallest[owner])
            earliest = hits[np.flatnonzero(np.diff(owner[hits], prepend=-1))]  # Eq. 245
            edges, vertices, gap = edges[earliest], others[earliest], gap[earliest]
            summit = ~np.isfinite(gap)  # at a local maximum of the height, any direction leads down
            turned = down + np.where(summit, 0.0, gap)[:, None] * lever
            down = turned / np.linalg.norm(turned, axis=1, keepdims=True)
            # in a valley between two vertices, continue along the edge, away from the projection of the centre of mass
            valley = ~summit & (self.beyond[edges, 0] < 0.0) & (self.beyond[edges, 1] > 0.0)
            flat = self.feet[edges] - down * (down * self.feet[edges]).sum(axis=1, keepdims=True)
            ahead = (self.normals[self.sides[edges]] * flat[:, None]).sum(axis=2)
            following = np.where(
                summit, self.sides[edges, 0], self.sides[edges, (ahead[:, 1] < ahead[:, 0]).astype(int)]
            )
            done = summit | valley
            facets[active[done]] = following[done]
            active, vertices, down = active[~done], vertices[~done], down[~done]
            if not len(active):
                return facets
        raise GeometryError(_ENDLESS)

    def moved(self, shift: FloatArray) -> "Polytope":
        """Return the polytope about a centre of mass that is shifted from the present centre of mass [m]."""
        heights = self.heights - (self.normals * shift).sum(axis=1)
        other = Polytope(self.vertices - shift, self.normals, heights, self.ends, self.sides)
        other.__dict__.update({name: getattr(self, name) for name in ("along", "borders", "_by_facet")})
        return other

    def climbed(self, vertex: int) -> int:
        """Return the summit at the end of the ascent from a vertex, always to the next lowest vertex."""
        while not self.summits[vertex]:
            vertex = int(np.argmax(self.vertices @ self.vertices[vertex]))
        return vertex


def polytope(points: FloatArray, centre: FloatArray, faces: IntArray | None = None) -> Polytope:
    """Return the convex hull of points about a centre of mass; coplanar facets, within 1e-7 of the size, are merged."""
    # `faces` are triangles of the surface; a convex surface is used without a search for the hull
    around = points - centre
    flat = FLAT * float(np.ptp(around, axis=0).max())
    if faces is not None and (surface := _closed(around, faces)) is not None:
        slopes = _slopes(*surface)
        if float(slopes.drop.min()) > -0.01 * flat:
            return _merged(*surface, slopes, flat)
    surface = _hull(_outer(around))
    return _merged(*surface, _slopes(*surface), flat)


def _hull(points: FloatArray) -> Surface:
    """Return corners, triangles counter-clockwise seen from outside, and their neighbours opposite to each corner."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(points)
    except QhullError as error:
        raise GeometryError("The points span no volume. Check for coplanar or missing points.") from error
    triangles, neighbours = hull.simplices.astype(np.int64), hull.neighbors.astype(np.int64)
    a, b, c = (hull.points[column] for column in triangles.T)
    turn = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    triangles[turn], neighbours[turn] = triangles[turn][:, [0, 2, 1]], neighbours[turn][:, [0, 2, 1]]
    return hull.points, triangles, neighbours


def _closed(points: FloatArray, faces: IntArray) -> Surface | None:
    """Return a surface with the neighbours of its triangles, or None for a surface that is not closed like a sphere."""
    start, end = np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
    if len(faces) % 2 or np.count_nonzero(np.bincount(start)) != len(faces) // 2 + 2:
        return None
    key = np.minimum(start, end) * len(points) + np.maximum(start, end)
    first, second = np.argsort(key, kind="stable").reshape(-1, 2).T
    if not (np.diff(key[first]).all() and (key[first] == key[second]).all() and (start[first] == end[second]).all()):
        return None
    neighbours = np.empty(len(key), dtype=np.int64)
    neighbours[first], neighbours[second] = second // 3, first // 3
    return points, faces, neighbours.reshape(faces.shape)


def _outer(points: FloatArray) -> FloatArray:
    """Return the points that can be on the hull: points outside the hull of the extreme points in a few directions."""
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
    # three products without BLAS read a million points only once
    height: FloatArray = columns[0] * direction[0] + columns[1] * direction[1] + columns[2] * direction[2]
    return height


@dataclass(frozen=True, eq=False)
class Slopes:
    """Normals of triangles, and positions of their neighbours."""

    areas: FloatArray  # 2 x area vectors [m2]; shape (m, 3)
    normals: FloatArray  # unit normals [-]; shape (m, 3)
    heights: FloatArray  # distances of the planes from the origin [m]; shape (m,)
    drop: FloatArray  # depth of the opposite corner of each neighbour below the plane [m]; shape (m, 3)


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
    """Return the polytope of triangles with merged coplanar triangles."""
    # the tolerance is reduced until the distance of all corners from their facets is at most 10 x tolerance
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    normals, heights = slopes.normals, slopes.heights
    count, label = len(triangles), np.arange(len(triangles))
    while (slopes.drop <= flat).any():
        mine, side = np.nonzero(slopes.drop <= flat)
        # a matrix, because SciPy 1.11 does not accept sparse arrays with 64-bit indices
        graph = coo_matrix((np.ones(len(mine), dtype=bool), (mine, beside[mine, side])), shape=(len(triangles),) * 2)
        count, labels = connected_components(graph, directed=False)
        label = labels.astype(np.int64)
        total = np.stack([np.bincount(label, slopes.areas[:, i], count) for i in range(3)], axis=1)
        normals = total / np.linalg.norm(total, axis=1, keepdims=True)
        distance = np.stack([(corners[column] * normals[label]).sum(axis=1) for column in triangles.T], axis=1)
        heights, bottom = np.full(count, -np.inf), np.full(count, np.inf)
        np.maximum.at(heights, label, distance.max(axis=1))
        np.minimum.at(bottom, label, distance.min(axis=1))
        if flat == 0.0 or (heights - bottom).max() <= 10.0 * flat:
            break
        flat = flat / 100.0 if flat > 1e-20 else 0.0
    left, right = np.repeat(label, 3), label[beside].ravel()
    once = left < right
    left, right = left[once], right[once]
    start, end = (np.roll(triangles, -i, axis=1).ravel()[once] for i in (1, 2))
    if count < len(triangles):
        # pieces of one straight edge between the same two facets are joined
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
    """Return the indices of members sorted by value, and the first position of each value in this list."""
    from scipy.sparse import coo_matrix

    indices = np.arange(members.size)
    # a sparse matrix sorts its rows by counting
    rows = coo_matrix((indices, (members.ravel(), indices)), shape=(count, members.size)).tocsr()
    return rows.data, rows.indptr.astype(np.int64)


def _listed(first: IntArray, groups: IntArray) -> tuple[IntArray, IntArray]:
    """Return the group number of each member of some groups, and the position of each member in the sorted list."""
    sizes = first[groups + 1] - first[groups]
    owner = np.repeat(np.arange(len(groups)), sizes)
    index = np.arange(len(owner)) + np.repeat(first[groups] - np.cumsum(sizes) + sizes, sizes)
    return owner, index
