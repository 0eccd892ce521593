"""All equilibria of a convex body on horizontal ground, with passes and energy barriers of its stable poses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.equilibria.polytope import FLAT, Polytope, polytope
from rocking.bodies.equilibria.poses import (
    Equilibrium,
    Kind,
    Pass,
    Ring,
    StablePose,
    azimuths,
    tilt_towards,
    tilted,
)
from rocking.conventions import FloatArray, IntArray, g
from rocking.errors import InvalidValueError
from rocking.messages import Message, Option

Path = Literal["straight", "lowest"]
_CLOSE = 1e-9
_SHALLOW = 1e-3
_SAME = 1e-6
_MANY = 100


@dataclass(frozen=True, eq=False)
class Equilibria:
    """All equilibria of a body on horizontal ground, and the passes between stable poses.

    Parameters
    ----------
    mass : float
        Mass [kg].
    centre : ndarray, shape (3,)
        Centre of mass, in the body's coordinates [m].
    stable : tuple of StablePose
        Stable poses, sorted by the height of the centre of mass.
    saddles, summits : tuple of Equilibrium
        Equilibria on an edge and on a vertex of the hull, sorted by the height of the centre of mass.
    rings : tuple of Ring
        Circles of equilibria of a body of revolution, not contained in the other tuples.
    notes : tuple of str
        Ignored poses and uncertain equilibria, as texts.
    min_barrier : float
        Stable poses with a smaller energy barrier are ignored: rise of the centre of mass [m].
    hull : Polytope
        Facets, edges and vertices of the convex hull about the centre of mass.
    surface : ndarray, shape (n, 3)
        All given points of the surface relative to the centre of mass, including points inside the hull [m].
    basins : dict of int to int
        Index of the final pose of each stable facet of the hull. The indices of rings follow the indices of stable
        poses.
    links : tuple of (int, int, Equilibrium)
        Two poses and the saddle between them, sorted by height.

    Examples
    --------
    >>> from rocking.bodies.solid import Solid, box
    >>> result = Solid(box(1.0, 2.0, 3.0)).equilibria()
    >>> len(result.stable), len(result.saddles), len(result.summits)
    (6, 12, 8)
    >>> round(result.stable[0].height, 12), round(result.stable[0].barrier, 12)
    (0.5, 0.61803398875)
    """

    mass: float
    centre: FloatArray
    stable: tuple[StablePose, ...]
    saddles: tuple[Equilibrium, ...]
    summits: tuple[Equilibrium, ...]
    rings: tuple[Ring, ...]
    notes: tuple[str, ...]
    min_barrier: float
    hull: Polytope = field(repr=False)
    surface: FloatArray = field(repr=False)  # points of the surface relative to the centre of mass, shape (n, 3) [m]
    basins: dict[int, int] = field(repr=False)  # index of the final pose by index of the stable facet
    links: tuple[tuple[int, int, Equilibrium], ...] = field(repr=False)  # two poses and their saddle, sorted by height

    @property
    def hull_vertices(self) -> FloatArray:
        """Vertices of the convex hull in the body's coordinates, shape (n, 3) [m]."""
        return self.hull.vertices + self.centre

    @property
    def flatness(self) -> float:
        """Largest distance of the corners of one facet from its plane [m]."""
        return FLAT * float(np.ptp(self.hull.vertices, axis=0).max())

    def height(self, down: ArrayLike) -> FloatArray:
        """Return the height of the centre of mass for given downward directions.

        Parameters
        ----------
        down : array_like, shape (..., 3)
            Downward directions in the body's frame, nonzero vectors [-].

        Returns
        -------
        ndarray, shape (...)
            Heights above the ground [m].
        """
        unit = _directions(down)
        flat, corners = unit.reshape(-1, 3), self.hull.vertices.T
        step = max(1, 4_000_000 // corners.shape[1])
        chunks = [(flat[i : i + step] @ corners).max(axis=1) for i in range(0, len(flat), step)]  # Eq. 242
        heights: FloatArray = np.concatenate(chunks).reshape(unit.shape[:-1])
        return heights

    def settling(self, down: ArrayLike) -> StablePose:
        """Return the stable pose that the body reaches from an initial attitude.

        Parameters
        ----------
        down : array_like, shape (3,)
            Initial downward direction in the body's frame [-].

        Returns
        -------
        StablePose
            End of the steepest descent of the centre of mass. A body in motion can move beyond this pose.

        Raises
        ------
        InvalidValueError
            If the body comes to rest on a ring.
        """
        unit = _directions(down)
        if unit.shape != (3,):
            raise InvalidValueError(
                "{parameter} must be {allowed}, got the shape {shape}", parameter="down",
                allowed="one direction of three numbers", shape=unit.shape,
            )  # fmt: skip
        basin = self._basin(unit)
        if basin >= len(self.stable):
            raise InvalidValueError("The body comes to rest on a ring of poses, not in an isolated stable pose.")
        return self.stable[basin]

    def neighbours(self, pose: StablePose) -> tuple[Pass, ...]:
        """Return the passes to the adjacent stable poses.

        Parameters
        ----------
        pose : StablePose
            Pose of the body.

        Returns
        -------
        tuple of Pass
            Lowest pass to each neighbour, sorted by height; the indices of rings follow the indices of stable poses.
        """
        self._check(pose)
        passes: dict[int, Pass] = {}
        for *ends, saddle in self.links:
            if pose.number in ends:
                end = ends[1 - ends.index(pose.number)]
                passes.setdefault(end, self._pass(pose, end, saddle))
        return tuple(passes.values())

    def lowest_pass(self, start: StablePose, end: StablePose) -> Pass:
        """Return the lowest pass from one pose to another; the path can cross other poses.

        Parameters
        ----------
        start, end : StablePose
            Two different poses.

        Returns
        -------
        Pass
            Highest saddle of the path with the lowest maximum.

        Raises
        ------
        InvalidValueError
            If both are the same pose.
        """
        self._check(start)
        self._check(end)
        return self._lowest(start, end.number)

    def barrier(self, pose: StablePose, azimuth: ArrayLike, *, path: Path = "straight") -> FloatArray:
        """Return the energy barrier of overturning towards an azimuth, as a rise of the centre of mass.

        Parameters
        ----------
        pose : StablePose
            Pose of the body.
        azimuth : array_like
            Direction of the tilt, counter-clockwise from x of the body in this pose [rad].
        path : {"straight", "lowest"}
            Straight tilt into another pose, or lowest pass to the pose at the end of the straight tilt.

        Returns
        -------
        ndarray
            Rise of the centre of mass [m]; infinite if the body does not reach another pose.

        Raises
        ------
        InvalidValueError
            If `path` is neither "straight" nor "lowest".
        """
        path_name, angles = checks.one_of("path", path, get_args(Path)), azimuths(azimuth)
        self._check(pose)
        rises = [self._over(pose, angle, path_name) for angle in angles.ravel().tolist()]
        return np.array(rises).reshape(angles.shape)

    def toppled(self, pose: StablePose, azimuth: float) -> StablePose | None:
        """Return the pose that a body reaches after a straight tilt towards an azimuth.

        Parameters
        ----------
        pose : StablePose
            Pose of the body.
        azimuth : float
            Direction of the tilt, counter-clockwise from x of the body in this pose [rad].

        Returns
        -------
        StablePose or None
            First other pose; None if the body rolls along a ring or returns.
        """
        self._check(pose)
        end = self._straight(pose, checks.number("azimuth", azimuth, "rad"))[1]
        return None if end >= len(self.stable) or end == pose.number else self.stable[end]

    def _check(self, pose: StablePose) -> None:
        candidate: object = pose
        if isinstance(candidate, StablePose) and candidate.number < len(self.stable):
            own = self.stable[candidate.number]
            if np.linalg.norm(own.down - candidate.down) < _SAME and math.isclose(
                own.height, candidate.height, rel_tol=1e-6
            ):
                return
        raise InvalidValueError("pose must be a stable pose of these equilibria, got {pose}", pose=f"{pose!r:.60}")

    def _over(self, pose: StablePose, azimuth: float, path: str) -> float:
        rise, end = self._straight(pose, azimuth)
        return rise if path == "straight" or end == pose.number else self._lowest(pose, end).rise

    def _lowest(self, pose: StablePose, end: int) -> Pass:
        joined = np.arange(1 + max(self.basins.values()))
        for first, second, saddle in self.links:  # Eq. 246
            joined[joined == joined[second]] = joined[first]
            if joined[pose.number] == joined[end] and end != pose.number:
                return self._pass(pose, end, saddle)
        raise InvalidValueError("start and end are the same pose, {pose}. Use two different poses.", pose=pose.number)

    def _straight(self, pose: StablePose, azimuth: float) -> tuple[float, int]:
        """Return the rise of the centre of mass on the straight path to another pose [m], and the index of the pose."""
        from scipy.spatial import ConvexHull

        horizontal = tilted(pose, azimuth)
        # the projection along the tilt axis is a clockwise polygon: x in the direction of the tilt, y downward
        flat = self.hull.vertices @ np.stack([horizontal, pose.down], axis=1)
        ring = flat[ConvexHull(flat).vertices[::-1]]
        chords = np.roll(ring, -1, axis=0) - ring
        before, after = (ring * np.roll(chords, 1, axis=0)).sum(axis=1), (ring * chords).sum(axis=1)
        crests = ring[(before > 0.0) & (after < 0.0)]  # Eq. 247
        valleys = chords[(after < 0.0) & (np.roll(before, -1) > 0.0)] @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        at_crest, at_valley = (np.arctan2(*points.T) % (2.0 * math.pi) for points in (crests, valleys))
        heights = np.hypot(*crests.T)
        for angle in np.sort(at_valley[(at_valley > _CLOSE) & (at_valley < 2.0 * math.pi - _CLOSE)]).tolist():
            end = self._basin(math.cos(angle) * pose.down + math.sin(angle) * horizontal)
            if end != pose.number:
                return float(heights[at_crest < angle].max()) - pose.height, end
        return math.inf, pose.number

    def _basin(self, down: FloatArray) -> int:
        lowest = int(np.argmax(self.hull.vertices @ down))
        return self.basins[self.hull.descent(lowest, down)]

    def _pass(self, pose: StablePose, end: int, top: Equilibrium) -> Pass:
        rise = top.height - pose.height
        tilt, azimuth = tilt_towards(pose, top.down)
        return Pass(pose.number, end, top.height, rise, self.mass * g * rise, tilt, azimuth, top.down)


def equilibria(
    points: ArrayLike,
    centre: ArrayLike,
    mass: float,
    *,
    faces: IntArray | None = None,
    min_barrier: float = 0.0,
    standing: ArrayLike | None = None,
) -> Equilibria:
    """Return all equilibria of a body from its surface, centre of mass and mass.

    The result is exact on the convex hull of the points. Coplanar facets, within 1e-7 of the size, are merged.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Points of the surface, including all vertices of the convex hull [m].
    centre : array_like, shape (3,)
        Centre of mass, inside the hull [m].
    mass : float
        Mass [kg].
    faces : ndarray of int, shape (m, 3), optional
        Triangles of the surface as three point indices each, counter-clockwise seen from outside. They make the
        computation faster for a convex surface.
    min_barrier : float
        Ignore stable poses with a smaller energy barrier towards a lower pose, and summits with a smaller height
        difference [m]. Facets with more than 100 corners, which are flat faces of round bodies, always remain.
    standing : array_like, shape (3,), optional
        Present downward direction [-]. The facet in this direction remains a pose for any energy barrier.

    Returns
    -------
    Equilibria
        All equilibria; their numbers satisfy stable - saddles + summits = 2.

    Raises
    ------
    GeometryError
        If the points span no volume.
    InvalidValueError
        If the centre of mass is not inside the hull of the points, or a number is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> result = equilibria(corners, corners.mean(axis=0), 1.0)
    >>> len(result.stable), len(result.saddles), len(result.summits)
    (4, 6, 4)
    """
    kilograms = checks.positive("mass", mass, "kg")
    min_rise = checks.within("min_barrier", min_barrier, 0.0, checks.LARGEST, unit="m")
    surface, centre_of_mass = checks.real_array("points", points, "m"), checks.real_array("centre", centre, "m")
    if surface.ndim != 2 or surface.shape[1:] != (3,) or not np.isfinite(surface).all():
        raise InvalidValueError(
            "{parameter} must be finite and have the shape (n, 3), got {shape}", parameter="points", shape=surface.shape
        )
    if centre_of_mass.shape != (3,) or not np.isfinite(centre_of_mass).all():
        raise InvalidValueError(parameter="centre", allowed="three finite numbers (x, y, z) [m]", value=centre)
    hull = polytope(surface, centre_of_mass, faces)
    if hull.heights.min() <= 0.0:
        raise InvalidValueError(
            "the centre of mass {centre} m must lie inside the convex hull of the points, and is {outside:.3g} m "
            "outside", parameter="centre", centre=centre_of_mass.tolist(), outside=float(-hull.heights.min()),
            hint="check that centre of mass and points have the same axes and unit",
        )  # fmt: skip
    down = None if standing is None else _directions(standing)
    return _equilibria_of_hull(hull, centre_of_mass, kilograms, min_rise, surface - centre_of_mass, down)


def _equilibria_of_hull(
    hull: Polytope, centre: FloatArray, mass: float, min_rise: float, surface: FloatArray, down: FloatArray | None
) -> Equilibria:
    facets = _by_height(np.flatnonzero(hull.stable), hull.heights)
    saddle_heights = np.linalg.norm(hull.feet, axis=1)
    edges = _by_height(np.flatnonzero(hull.saddles), saddle_heights)
    distances = np.linalg.norm(hull.vertices, axis=1)
    corners = _by_height(np.flatnonzero(hull.summits), -distances)[::-1]
    ends = [[hull.rolled(int(side)) for side in hull.sides[edge]] for edge in edges]
    always = {facet for facet in facets.tolist() if min_rise > 0.0 and len(hull.corners(facet)) > _MANY}
    if down is not None:
        always |= {facet for facet in facets.tolist() if np.linalg.norm(np.cross(hull.normals[facet], down)) < _SAME}
    lead_of_facet, cancelled = _simplified(facets, hull.heights, edges, saddle_heights, ends, min_rise, always=always)
    kept_facets = [facet for facet in facets.tolist() if lead_of_facet[facet] == facet]
    kept_edges = [edge for edge in edges.tolist() if edge not in cancelled]
    if min_rise > 0.0:
        rising = [[hull.climbed(int(end)) for end in hull.ends[edge]] for edge in kept_edges]
        rest_of_corner, cancelled = _simplified(
            corners, -distances, np.array(kept_edges[::-1]), -saddle_heights, rising[::-1], min_rise, always=set()
        )
        corners = np.array([corner for corner in corners.tolist() if rest_of_corner[corner] == corner])
        kept_edges = [edge for edge in kept_edges if edge not in cancelled]
    index_of_facet = {facet: i for i, facet in enumerate(kept_facets)}
    basins = {facet: index_of_facet[lead] for facet, lead in lead_of_facet.items()}
    low = float(hull.heights[kept_facets[0]])

    def equilibrium_of(kind: Kind, down: FloatArray, height: float, points: IntArray) -> Equilibrium:
        return Equilibrium(kind, down, height, mass * g * (height - low), hull.vertices[points] + centre)  # Eq. 243

    ends_of_edge = dict(zip(edges.tolist(), ends, strict=True))
    saddles = tuple(
        equilibrium_of("saddle", hull.feet[e] / saddle_heights[e], float(saddle_heights[e]), hull.ends[e])
        for e in kept_edges
    )
    paired = [tuple(basins[end] for end in ends_of_edge[edge]) for edge in kept_edges]
    links = [(first, second, top) for (first, second), top in zip(paired, saddles, strict=True) if first != second]
    exits = {pose: top.height for *pair, top in reversed(links) for pose in pair}
    stable = []
    for i, facet in enumerate(kept_facets):
        pose = equilibrium_of("stable", hull.normals[facet], float(hull.heights[facet]), hull.corners(facet)[::-1])
        barrier = exits.get(i, math.inf) - pose.height
        stable.append(StablePose(pose.kind, pose.down, pose.height, pose.energy, pose.points, i, centre, barrier))
    summits = tuple(
        equilibrium_of("summit", hull.vertices[v] / distances[v], float(distances[v]), np.array([v]))
        for v in corners.tolist()
    )
    notes = _notes(hull, stable, len(facets) - len(stable), min_rise)
    poses, all_links = tuple(stable), tuple(links)
    return Equilibria(mass, centre, poses, saddles, summits, (), notes, min_rise, hull, surface, basins, all_links)


def _directions(values: ArrayLike) -> FloatArray:
    """Return checked directions as unit vectors."""
    towards = checks.real_array("down", values)
    if towards.shape[-1:] != (3,) or not np.isfinite(towards).all() or not towards.any(axis=-1).all():
        raise InvalidValueError(parameter="down", allowed="three finite numbers (x, y, z), not all zero", value=values)
    unit: FloatArray = towards / np.linalg.norm(towards, axis=-1, keepdims=True)
    return unit


def _by_height(members: IntArray, heights: FloatArray) -> IntArray:
    return members[np.lexsort((members, heights[members]))]


def _simplified(
    minima: IntArray,
    heights: FloatArray,
    edges: IntArray,
    tops: FloatArray,
    ends: Sequence[Sequence[int]],
    min_rise: float,
    *,
    always: set[int],
) -> tuple[dict[int, int], set[int]]:
    """Return the remaining minimum of each minimum without barriers below `min_rise`, and the removed edges."""
    joined = {minimum: minimum for minimum in minima.tolist()}
    leads = dict(joined)
    cancelled = set()

    def end_of(links: dict[int, int], minimum: int) -> int:
        while links[minimum] != minimum:
            minimum = links[minimum]
        return minimum

    for edge, (first, second) in zip(edges.tolist(), ends, strict=True):
        roots = end_of(joined, first), end_of(joined, second)
        if roots[0] == roots[1]:
            continue
        # the basin with the higher minimum joins the other basin
        (low, lower), (high, _) = sorted(zip(roots, (first, second), strict=True), key=lambda end: heights[end[0]])
        joined[high] = low
        if tops[edge] - heights[high] < min_rise and high not in always:
            leads[high] = lower
            cancelled.add(edge)
    return {minimum: end_of(leads, minimum) for minimum in leads}, cancelled


def _notes(hull: Polytope, stable: Sequence[StablePose], left_out: int, min_rise: float) -> tuple[str, ...]:
    size = float(np.ptp(hull.vertices, axis=0).max())
    at_edge = (np.abs(hull.inward) <= _CLOSE * size).any(axis=1)
    at_end = (np.abs(hull.beyond) <= _CLOSE * size).any(axis=1)
    is_inside = (hull.inward > -_CLOSE * size).all(axis=1)
    crossed = (hull.beyond[:, 0] < _CLOSE * size) & (hull.beyond[:, 1] > -_CLOSE * size)
    notes: list[str] = []
    if count := int(((at_edge & crossed) | (at_end & is_inside)).sum()):
        notes.append(
            f"{count} projections of the centre of mass lie on an edge or a corner of a facet, within {_CLOSE:g} of "
            "the size: rounding decides on these poses"
        )
    if count := sum(pose.barrier < _SHALLOW * size for pose in stable):
        notes.append(Message(
            "{count} of {total} stable poses have an energy barrier below {barrier:.2g} mm: the body is round or rough "
            "there; {option} ignores such poses",
            {"count": count, "total": len(stable), "barrier": 1e3 * _SHALLOW * size, "option": Option("min_barrier")},
        ))  # fmt: skip
    if left_out:
        notes.append(f"{left_out} stable poses with an energy barrier below {1e3 * min_rise:.2g} mm are ignored")
    return tuple(notes)
