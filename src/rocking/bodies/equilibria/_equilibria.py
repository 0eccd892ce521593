"""All equilibria of a convex body on level ground, the passes between its stable poses, and the barriers around one."""

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

Path = Literal["straight", "lowest"]
_CLOSE = 1e-9
_SHALLOW = 1e-3
_SAME = 1e-6
_MANY = 100


@dataclass(frozen=True, eq=False)
class Equilibria:
    """In how many ways a body can stand or be balanced on level ground, and what lies between these ways.

    Parameters
    ----------
    mass : float
        Mass [kg].
    centre : ndarray, shape (3,)
        Centre of mass, in the body's coordinates [m].
    stable : tuple of StablePose
        Poses in which it stands by itself, the lowest centre first.
    saddles, summits : tuple of Equilibrium
        Balanced on an edge and on a vertex of the hull, the lowest first.
    rings : tuple of Ring
        Circles of equilibria of a body of revolution, which are not counted among the others.
    notes : tuple of str
        What the numbers leave out, and what hangs on the last digits, in words.
    min_barrier : float
        Poses that a smaller rise of the centre leaves are not counted [m].
    hull : Polytope
        Facets, edges and vertices of the convex hull about the centre of mass.
    surface : ndarray, shape (n, 3)
        Points of the surface that were given, from the centre of mass, those inside the hull too [m].
    basins : dict of int to int
        Number of the pose to which each stable facet of the hull leads; rings count on after the stable poses.
    links : tuple of (int, int, Equilibrium)
        The two poses that each saddle joins, the lowest first.

    Examples
    --------
    >>> from rocking.bodies.solid import Solid, box
    >>> found = Solid(box(1.0, 2.0, 3.0)).equilibria()
    >>> len(found.stable), len(found.saddles), len(found.summits)
    (6, 12, 8)
    >>> round(found.stable[0].height, 12), round(found.stable[0].barrier, 12)
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
    surface: FloatArray = field(repr=False)  # points of the surface, from the centre, shape (n, 3) [m]
    basins: dict[int, int] = field(repr=False)  # the pose to which every stable facet leads
    links: tuple[tuple[int, int, Equilibrium], ...] = field(
        repr=False
    )  # poses that each saddle joins, the lowest first

    @property
    def hull_vertices(self) -> FloatArray:
        """Vertices of the convex hull in the body's coordinates, shape (n, 3) [m]."""
        return self.hull.vertices + self.centre

    @property
    def flatness(self) -> float:
        """How far from one plane corners may lie of what is one facet [m]."""
        return FLAT * float(np.ptp(self.hull.vertices, axis=0).max())

    def height(self, down: ArrayLike) -> FloatArray:
        """Return how high the centre of mass is with directions downward.

        Parameters
        ----------
        down : array_like, shape (..., 3)
            Directions in the body's frame, of any length above zero [-].

        Returns
        -------
        ndarray, shape (...)
            Heights over the ground [m].
        """
        unit = _directions(down)
        flat, corners = unit.reshape(-1, 3), self.hull.vertices.T
        step = max(1, 4_000_000 // corners.shape[1])
        parts = [(flat[i : i + step] @ corners).max(axis=1) for i in range(0, len(flat), step)]  # Eq. 242
        found: FloatArray = np.concatenate(parts).reshape(unit.shape[:-1])
        return found

    def settling(self, down: ArrayLike) -> StablePose:
        """Return the stable pose into which the body settles, let go with a direction downward.

        Parameters
        ----------
        down : array_like, shape (3,)
            Direction in the body's frame [-].

        Returns
        -------
        StablePose
            The end of the steepest descent of its centre; in motion it may overshoot.

        Raises
        ------
        InvalidValueError
            If the body rests on a ring there.
        """
        unit = _directions(down)
        if unit.shape != (3,):
            raise InvalidValueError(
                "{parameter} must be {allowed}, got the shape {shape}", parameter="down",
                allowed="one direction of three numbers", shape=unit.shape,
            )  # fmt: skip
        basin = self._basin(unit)
        if basin >= len(self.stable):
            raise InvalidValueError("the body comes to rest on a ring of poses there, in none of the isolated ones")
        return self.stable[basin]

    def neighbours(self, pose: StablePose) -> tuple[Pass, ...]:
        """Return the passes into the poses that are one saddle away.

        Parameters
        ----------
        pose : StablePose
            Where the body stands.

        Returns
        -------
        tuple of Pass
            The lowest to each neighbour, the lowest first; rings of stable poses count on after the stable poses.
        """
        self._check(pose)
        found: dict[int, Pass] = {}
        for *ends, saddle in self.links:
            if pose.number in ends:
                end = ends[1 - ends.index(pose.number)]
                found.setdefault(end, self._pass(pose, end, saddle))
        return tuple(found.values())

    def lowest_pass(self, start: StablePose, end: StablePose) -> Pass:
        """Return the lowest way from one pose into another, whatever poses lie between.

        Parameters
        ----------
        start, end : StablePose
            Two different poses.

        Returns
        -------
        Pass
            Its highest saddle: no other way has a lower one.

        Raises
        ------
        InvalidValueError
            If both are the same pose.
        """
        self._check(start)
        self._check(end)
        return self._lowest(start, end.number)

    def barrier(self, pose: StablePose, azimuth: ArrayLike, *, path: Path = "straight") -> FloatArray:
        """Return how much the centre of mass must rise for the body to topple towards an azimuth.

        Parameters
        ----------
        pose : StablePose
            Where the body stands.
        azimuth : array_like
            Direction towards which it tilts, counter-clockwise from x of the body as set down [rad].
        path : {"straight", "lowest"}
            Tilting straight on until it settles in another pose; or by the lowest pass into that pose, whatever way.

        Returns
        -------
        ndarray
            Rise [m]; infinite if it never settles in another.

        Raises
        ------
        InvalidValueError
            If `path` is another word.
        """
        way, angles = checks.one_of("path", path, get_args(Path)), azimuths(azimuth)
        self._check(pose)
        rises = [self._over(pose, angle, way) for angle in angles.ravel().tolist()]
        return np.array(rises).reshape(angles.shape)

    def toppled(self, pose: StablePose, azimuth: float) -> StablePose | None:
        """Return the pose into which a body topples that is tilted straight towards an azimuth.

        Parameters
        ----------
        pose : StablePose
            Where it stands.
        azimuth : float
            Direction towards which it tilts, counter-clockwise from x of the body as set down [rad].

        Returns
        -------
        StablePose or None
            The first other pose; None if it rolls on a ring or back.
        """
        self._check(pose)
        end = self._straight(pose, checks.number("azimuth", azimuth, "rad"))[1]
        return None if end >= len(self.stable) or end == pose.number else self.stable[end]

    def _check(self, pose: StablePose) -> None:
        known: object = pose
        if isinstance(known, StablePose) and known.number < len(self.stable):
            own = self.stable[known.number]
            if np.linalg.norm(own.down - known.down) < _SAME and math.isclose(own.height, known.height, rel_tol=1e-6):
                return
        raise InvalidValueError(
            "pose must be one of the stable poses of these equilibria, got {pose}", pose=f"{pose!r:.60}"
        )

    def _over(self, pose: StablePose, azimuth: float, path: str) -> float:
        rise, end = self._straight(pose, azimuth)
        return rise if path == "straight" or end == pose.number else self._lowest(pose, end).rise

    def _lowest(self, pose: StablePose, end: int) -> Pass:
        joined = np.arange(1 + max(self.basins.values()))
        for one, other, saddle in self.links:  # Eq. 246
            joined[joined == joined[other]] = joined[one]
            if joined[pose.number] == joined[end] and end != pose.number:
                return self._pass(pose, end, saddle)
        raise InvalidValueError("there is no pass from pose {pose} to itself", pose=pose.number)

    def _straight(self, pose: StablePose, azimuth: float) -> tuple[float, int]:
        """Return the rise of the centre on the straight way into another pose, and which."""
        from scipy.spatial import ConvexHull

        towards = tilted(pose, azimuth)
        # seen along the axis of the tilt the body is a polygon: to the side x, downward y, clockwise
        flat = self.hull.vertices @ np.stack([towards, pose.down], axis=1)
        ring = flat[ConvexHull(flat).vertices[::-1]]
        chords = np.roll(ring, -1, axis=0) - ring
        before, after = (ring * np.roll(chords, 1, axis=0)).sum(axis=1), (ring * chords).sum(axis=1)
        crests = ring[(before > 0.0) & (after < 0.0)]  # Eq. 247
        valleys = chords[(after < 0.0) & (np.roll(before, -1) > 0.0)] @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        at_crest, at_valley = (np.arctan2(*each.T) % (2.0 * math.pi) for each in (crests, valleys))
        heights = np.hypot(*crests.T)
        for angle in np.sort(at_valley[(at_valley > _CLOSE) & (at_valley < 2.0 * math.pi - _CLOSE)]).tolist():
            end = self._basin(math.cos(angle) * pose.down + math.sin(angle) * towards)
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
    """Return all equilibria of a body of which the surface, the centre of mass and the mass are known.

    Exact on the convex hull of the points. Facets within 1e-7 of the size of one plane are one.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Points of its surface, at least those of its convex hull [m].
    centre : array_like, shape (3,)
        Centre of mass, inside the hull [m].
    mass : float
        Mass [kg].
    faces : ndarray of int, shape (m, 3), optional
        Triangles of the surface, each of three numbers of points, counter-clockwise seen from outside: a surface that
        is convex is its own hull, and the answer comes sooner.
    min_barrier : float
        Stable poses from which a smaller rise of the centre leads into a lower one are not poses of their own, and
        summits that stand out by less no summits [m]. Facets of more than 100 corners, which are flats of round
        bodies, are left as they are.
    standing : array_like, shape (3,), optional
        Direction that is downward now: the facet there stays a pose, however little it takes to leave it [-].

    Returns
    -------
    Equilibria
        The numbers obey stable - saddles + summits = 2.

    Raises
    ------
    GeometryError
        If the points span no volume.
    InvalidValueError
        If the centre is not inside their hull, or a number is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> found = equilibria(corners, corners.mean(axis=0), 1.0)
    >>> len(found.stable), len(found.saddles), len(found.summits)
    (4, 6, 4)
    """
    kilograms = checks.positive("mass", mass, "kg")
    least = checks.within("min_barrier", min_barrier, 0.0, checks.LARGEST, unit="m")
    surface, middle = checks.real_array("points", points, "m"), checks.real_array("centre", centre, "m")
    if surface.ndim != 2 or surface.shape[1:] != (3,) or not np.isfinite(surface).all():
        raise InvalidValueError(
            "{parameter} must be finite and have the shape (n, 3), got {shape}", parameter="points", shape=surface.shape
        )
    if middle.shape != (3,) or not np.isfinite(middle).all():
        raise InvalidValueError(parameter="centre", allowed="three finite numbers (x, y, z) [m]", value=centre)
    hull = polytope(surface, middle, faces)
    if hull.heights.min() <= 0.0:
        raise InvalidValueError(
            "the centre of mass {centre} m must lie inside the convex hull of the points: it is {outside:.3g} m "
            "outside", parameter="centre", centre=middle.tolist(), outside=float(-hull.heights.min()),
            hint="are both in the same frame and unit?",
        )  # fmt: skip
    down = None if standing is None else _directions(standing)
    return _found(hull, middle, kilograms, least, surface - middle, down)


def _found(
    hull: Polytope, centre: FloatArray, mass: float, least: float, surface: FloatArray, down: FloatArray | None
) -> Equilibria:
    facets = _by_height(np.flatnonzero(hull.stable), hull.heights)
    tops = np.linalg.norm(hull.feet, axis=1)
    edges = _by_height(np.flatnonzero(hull.saddles), tops)
    reach = np.linalg.norm(hull.vertices, axis=1)
    corners = _by_height(np.flatnonzero(hull.summits), -reach)[::-1]
    ends = [[hull.rolled(int(side)) for side in hull.sides[edge]] for edge in edges]
    always = {each for each in facets.tolist() if least > 0.0 and len(hull.corners(each)) > _MANY}
    if down is not None:
        always |= {each for each in facets.tolist() if np.linalg.norm(np.cross(hull.normals[each], down)) < _SAME}
    leads, cut = _simplified(facets, hull.heights, edges, tops, ends, least, always=always)
    kept_facets = [facet for facet in facets.tolist() if leads[facet] == facet]
    kept_edges = [edge for edge in edges.tolist() if edge not in cut]
    if least > 0.0:
        rising = [[hull.climbed(int(end)) for end in hull.ends[edge]] for edge in kept_edges]
        rests, cut = _simplified(corners, -reach, np.array(kept_edges[::-1]), -tops, rising[::-1], least, always=set())
        corners = np.array([corner for corner in corners.tolist() if rests[corner] == corner])
        kept_edges = [edge for edge in kept_edges if edge not in cut]
    number = {facet: i for i, facet in enumerate(kept_facets)}
    basins = {facet: number[lead] for facet, lead in leads.items()}
    low = float(hull.heights[kept_facets[0]])

    def one(kind: Kind, down: FloatArray, height: float, points: IntArray) -> Equilibrium:
        return Equilibrium(kind, down, height, mass * g * (height - low), hull.vertices[points] + centre)  # Eq. 243

    whither = dict(zip(edges.tolist(), ends, strict=True))
    saddles = tuple(one("saddle", hull.feet[e] / tops[e], float(tops[e]), hull.ends[e]) for e in kept_edges)
    paired = [tuple(basins[end] for end in whither[edge]) for edge in kept_edges]
    links = [(one, other, top) for (one, other), top in zip(paired, saddles, strict=True) if one != other]
    exits = {pose: top.height for *pair, top in reversed(links) for pose in pair}
    stable = []
    for i, facet in enumerate(kept_facets):
        made = one("stable", hull.normals[facet], float(hull.heights[facet]), hull.corners(facet)[::-1])
        barrier = exits.get(i, math.inf) - made.height
        stable.append(StablePose(made.kind, made.down, made.height, made.energy, made.points, i, centre, barrier))
    summits = tuple(
        one("summit", hull.vertices[v] / reach[v], float(reach[v]), np.array([v])) for v in corners.tolist()
    )
    notes = _notes(hull, stable, len(facets) - len(stable), least)
    poses, ways = tuple(stable), tuple(links)
    return Equilibria(mass, centre, poses, saddles, summits, (), notes, least, hull, surface, basins, ways)


def _directions(values: ArrayLike) -> FloatArray:
    """Return directions of unit length, after a check."""
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
    least: float,
    *,
    always: set[int],
) -> tuple[dict[int, int], set[int]]:
    """Return where minima lead if barriers below `least` do not count but of those in `always`, and edges cancelled."""
    joined = {each: each for each in minima.tolist()}
    leads = dict(joined)
    cut = set()

    def found(links: dict[int, int], each: int) -> int:
        while links[each] != each:
            each = links[each]
        return each

    for edge, (one, other) in zip(edges.tolist(), ends, strict=True):
        roots = found(joined, one), found(joined, other)
        if roots[0] == roots[1]:
            continue
        # the one with the higher minimum ends here
        (low, lower), (high, _) = sorted(zip(roots, (one, other), strict=True), key=lambda end: heights[end[0]])
        joined[high] = low
        if tops[edge] - heights[high] < least and high not in always:
            leads[high] = lower
            cut.add(edge)
    return {each: found(leads, each) for each in leads}, cut


def _notes(hull: Polytope, stable: Sequence[StablePose], left_out: int, least: float) -> tuple[str, ...]:
    size = float(np.ptp(hull.vertices, axis=0).max())
    at_edge = (np.abs(hull.inward) <= _CLOSE * size).any(axis=1)
    at_end = (np.abs(hull.beyond) <= _CLOSE * size).any(axis=1)
    held = (hull.inward > -_CLOSE * size).all(axis=1)
    crossed = (hull.beyond[:, 0] < _CLOSE * size) & (hull.beyond[:, 1] > -_CLOSE * size)
    notes = []
    if count := int(((at_edge & crossed) | (at_end & held)).sum()):
        notes.append(
            f"the centre's foot lies on an edge or a corner of a facet in {count} places, to {_CLOSE:g} of the size: "
            "whether these are poses hangs on the last digits"
        )
    if count := sum(pose.barrier < _SHALLOW * size for pose in stable):
        notes.append(
            f"{count} of {len(stable)} stable poses are left by a rise of less than {1e3 * _SHALLOW * size:.2g} mm: "
            "the body is round or rough there; a least barrier takes such poses together"
        )
    if left_out:
        notes.append(
            f"{left_out} shallow poses do not count, out of which the centre must rise less than {1e3 * least:.2g} mm"
        )
    return tuple(notes)
