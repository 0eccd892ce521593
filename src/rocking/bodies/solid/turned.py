"""Bodies of revolution: cylinders, cones, ellipsoids, sphere caps, and profiles rotated about an axis."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies import region
from rocking.bodies.moments import SolidMoments
from rocking.bodies.region import triangulated
from rocking.bodies.solid.surfaces import Footprint, Shape, Surface, TriangleSurface, TurnedSurface, gauss
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import GeometryError


@dataclass(frozen=True, slots=True, eq=False)
class Meridian:
    """One piece of the rotated profile."""

    data: FloatArray  # meridian of `TurnedSurface`; shape (2, 2)
    arc: bool = False  # True for an arc of an ellipse

    def at(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return radius and height at a fraction of the piece [-]."""
        first, second = self.data
        if self.arc:
            polar = first[0] + (first[1] - first[0]) * fraction
            return np.sin(polar), second[0] + second[1] * np.cos(polar)
        return first[0] + (second[0] - first[0]) * fraction, first[1] + (second[1] - first[1]) * fraction

    def scaled(self, size: float) -> "Meridian":
        """Return the piece with heights multiplied by `size`, and unchanged radii."""
        factors = np.array([[1.0, 1.0], [size, size]] if self.arc else [[1.0, size], [1.0, size]])
        return Meridian(self.data * factors, self.arc)


class Turned(Shape):
    """A counter-clockwise profile from axis to axis, rotated about z; half_axes: scale of its plan [m]."""

    def __init__(self, meridians: tuple[Meridian, ...], half_axes: tuple[float, float]) -> None:
        self.meridians, self.half_axes = meridians, half_axes

    def __repr__(self) -> str:
        return f"Turned({len(self.meridians)} pieces, {self.moments().mass:g} m3)"

    def moments(self) -> SolidMoments:
        """Return volume, centre and second moments, exact for every piece."""
        # ``V = pi a b Int rho^2 dz``, ``Int x^2 dV = pi a^3 b/4 Int rho^4 dz``. Rho or its square is a polynomial of
        # the height. Three Gauss points are exact up to degree five.
        (a, b), (nodes, weights) = self.half_axes, gauss(3)
        sums = np.zeros(4)
        middle = 0.5 * float(self.extent(np.eye(3))[:, 2].sum())
        for piece in self.meridians:
            (_, z0), (_, z1) = (tuple(float(v[0]) for v in piece.at(np.array([end]))) for end in (0.0, 1.0))
            z = z0 + (z1 - z0) * nodes
            squared = piece.at(nodes)[0] ** 2
            if piece.arc:
                centre, half = piece.data[1]
                squared = 1.0 - ((z - centre) / half) ** 2
            up = z - middle
            sums += (weights * (z1 - z0) * np.array([squared, squared * up, squared * up * up, squared**2])).sum(axis=1)
        volume = math.pi * a * b * float(sums[0])
        height = float(sums[1] / sums[0])
        around = 0.25 * math.pi * a * b * float(sums[3])
        vertical = math.pi * a * b * float(sums[2] - sums[0] * height**2)
        second = np.diag([around * a * a, around * b * b, vertical])
        return SolidMoments(volume, np.array([0.0, 0.0, middle + height]), second)

    def surfaces(self, rotation: FloatArray | None = None, translation: FloatArray | None = None) -> list[Surface]:
        """Return the surface after rotation and translation, one surface per piece of the profile."""
        turn = np.eye(3) if rotation is None else rotation
        move = np.zeros(3) if translation is None else translation
        return [TurnedSurface(piece.data, self.half_axes, piece.arc, turn, move) for piece in self.meridians]

    def extent(self, rotation: FloatArray) -> FloatArray:
        """Return the box of the circles of the rotated shape, exact for straight profiles, shape (2, 3) [m]."""
        radius, height = self.profile()
        a, b = self.half_axes
        middle = np.outer(height, rotation[:, 2])
        reach = np.outer(radius, np.hypot(a * rotation[:, 0], b * rotation[:, 1]))
        return np.array([(middle - reach).min(axis=0), (middle + reach).max(axis=0)])

    def profile(self, chords: int = 48) -> tuple[FloatArray, FloatArray]:
        """Return radius [-] and height [m] of corners from the axis at the bottom to the axis at the top."""
        # `chords` is the number of chords of an arc
        ends = [piece.at(np.linspace(0.0, 1.0, chords + 1 if piece.arc else 2)[:-1]) for piece in self.meridians]
        last = self.meridians[-1].at(np.array([1.0]))
        radius, height = (np.concatenate([*(end[i] for end in ends), last[i]]) for i in range(2))
        return radius, height

    def hull_points(self) -> FloatArray:
        """Return 360 points around the axis for every corner of the profile; arcs have 180 chords."""
        (a, b), (radius, height) = self.half_axes, self.profile(180)
        phi = np.arange(360) * (2.0 * math.pi / 360.0)
        x, y = (half * np.outer(radius, around) for half, around in ((a, np.cos(phi)), (b, np.sin(phi))))
        return np.stack([x, y, np.broadcast_to(height[:, None], x.shape)], axis=-1).reshape(-1, 3)

    def footprint(self) -> Footprint:
        """Return the discs at bottom and top for a round plan, and points on their rims for an elliptical plan."""
        (a, b), discs, rims = self.half_axes, [], []
        flat = [p for p in self.meridians if not p.arc and p.data[0, 1] == p.data[1, 1]]
        phi = np.linspace(0.0, 2.0 * math.pi, 361)[:-1]
        for piece in flat:
            radius, height = float(piece.data[:, 0].max()), float(piece.data[0, 1])
            if a == b:
                discs.append((np.array([0.0, 0.0, height]), a * radius))
            else:
                rims.append(np.stack([a * radius * np.cos(phi), b * radius * np.sin(phi), 0 * phi + height], axis=1))
        return np.concatenate([np.zeros((0, 3)), *rims]), tuple(discs)

    def contains(self, points: FloatArray) -> BoolArray:
        """Return True for points inside the rotated profile."""
        import shapely

        polygon = shapely.Polygon(np.stack(self.profile(), axis=1))
        shapely.prepare(polygon)
        a, b = self.half_axes
        is_inside: BoolArray = shapely.contains_xy(polygon, np.hypot(points[:, 0] / a, points[:, 1] / b), points[:, 2])
        return is_inside

    def scaled(self, size: float) -> "Turned":
        factor, (a, b) = checks.positive("size", size), self.half_axes
        return Turned(tuple(piece.scaled(factor) for piece in self.meridians), (a * factor, b * factor))

    def mirrored(self) -> "Turned":
        """Return the shape itself."""
        return self

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray]:
        """Return volumes [m3] and centres [m] of sectors of rings."""
        flat = triangulated(np.stack(self.profile(4 * divisions), axis=1))
        lifted = np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=2)
        flat = TriangleSurface(lifted).triangles(divisions)[..., :2]
        side, other = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
        area = 0.5 * np.abs(side[:, 0] * other[:, 1] - side[:, 1] * other[:, 0])
        radius, total = flat[..., 0], flat.sum(axis=1)
        mean = total[:, 0] / 3.0
        # Int r^2 and Int r z over a triangle, from its corners
        second = ((radius[..., None] * flat).sum(axis=1) + total[:, :1] * total) / 12.0
        sector = 0.5 * math.pi / divisions
        phi = sector * (np.arange(4 * divisions) + 0.5)
        chord = math.sin(0.5 * sector) / (0.5 * sector)
        a, b = self.half_axes
        volumes = np.repeat(a * b * area * mean * sector, len(phi))
        radius_of_centre, height = np.repeat(second / mean[:, None], len(phi), axis=0).T
        around = np.tile(phi, len(flat))
        return volumes, np.stack(
            [a * chord * radius_of_centre * np.cos(around), b * chord * radius_of_centre * np.sin(around), height],
            axis=1,
        )


def revolution(profile: ArrayLike) -> Turned:
    """Return a profile of straight pieces rotated about the z axis.

    Parameters
    ----------
    profile : array_like, shape (n, 2)
        Points (radius, height) from the axis at the bottom to the axis at the top [m]. A flat disc closes a profile
        that starts or ends off the axis.

    Returns
    -------
    Turned
        The shape.

    Raises
    ------
    GeometryError
        If the profile crosses itself or leaves the half plane.

    Examples
    --------
    >>> round(revolution([(1.0, 0.0), (1.0, 2.0)]).moments().mass / np.pi, 12)
    2.0
    """
    points = checks.real_array("profile", profile, "m")
    if points.ndim != 2 or points.shape[1:] != (2,) or len(points) < 2 or not np.isfinite(points).all():
        raise GeometryError("profile must be at least two finite points (radius, height) in m")
    if (points[:, 0] < 0.0).any():
        raise GeometryError(
            "radii of the {parameter} must be >= 0 m, got {radius:g}", parameter="profile",
            radius=float(points[:, 0].min()),
        )  # fmt: skip
    first, last = points[0, 1], points[-1, 1]
    if last <= first:
        raise GeometryError(
            "the {parameter} must end above its start, got heights {start:g} and {end:g} m", parameter="profile",
            start=float(first), end=float(last),
        )  # fmt: skip
    closed = region.checked_ring("profile", np.concatenate([[(0.0, first)], points, [(0.0, last)]]))
    region.check_polygon("profile", closed, ())
    checks.length("largest dimension of the profile", float(np.ptp(closed, axis=0).max()))
    start = int(np.flatnonzero((closed == (0.0, first)).all(axis=1))[0])
    ordered = np.roll(closed, -start, axis=0)
    return Turned(tuple(Meridian(ordered[i : i + 2].copy()) for i in range(len(ordered) - 1)), (1.0, 1.0))


def cylinder(diameter: float, height: float) -> Turned:
    """Return an upright cylinder on z = 0.

    Parameters
    ----------
    diameter, height : float
        Full sizes [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(cylinder(2.0, 1.0).moments().mass / np.pi, 12)
    1.0
    """
    return frustum(diameter, diameter, height)


def frustum(lower_diameter: float, upper_diameter: float, height: float) -> Turned:
    """Return an upright frustum of a cone on z = 0.

    Parameters
    ----------
    lower_diameter, upper_diameter : float
        Diameters of base and top [m]; an upper diameter of 0 gives a cone.
    height : float
        Height [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(frustum(2.0, 0.0, 3.0).moments().mass / np.pi, 12)
    1.0
    """
    lower = 0.5 * checks.length("lower_diameter", lower_diameter)
    upper = 0.5 * checks.within("upper_diameter", upper_diameter, 0.0, checks.LARGEST, unit="m")
    high = checks.length("height", height)
    return revolution([(lower, 0.0), (upper, high)])


def cone(diameter: float, height: float) -> Turned:
    """Return an upright cone on z = 0.

    Parameters
    ----------
    diameter, height : float
        Diameter of the base and height [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(float(cone(2.0, 4.0).moments().centre[2]), 12)
    1.0
    """
    return frustum(diameter, 0.0, height)


def ellipsoid(width: float, depth: float, height: float, *, cut_below: float = 0.0, cut_above: float = 0.0) -> Turned:
    """Return an ellipsoid, optionally with horizontal cuts, with its lowest point on z = 0.

    Parameters
    ----------
    width, depth, height : float
        Full axes along x, y and z of the complete ellipsoid [m].
    cut_below, cut_above : float
        Heights of the removed caps [m].

    Returns
    -------
    Turned
        The shape.

    Raises
    ------
    GeometryError
        If the cuts remove the complete ellipsoid.

    Examples
    --------
    >>> round(ellipsoid(2.0, 2.0, 2.0, cut_below=1.0).moments().mass / (2.0 * np.pi / 3.0), 12)
    1.0
    """
    a, b = 0.5 * checks.length("width", width), 0.5 * checks.length("depth", depth)
    half = 0.5 * checks.length("height", height)
    below = checks.within("cut_below", cut_below, 0.0, 2.0 * half, unit="m")
    above = checks.within("cut_above", cut_above, 0.0, 2.0 * half, unit="m")
    if below + above >= 2.0 * half * (1.0 - 1e-9):
        raise GeometryError(
            "Cuts of {below:g} and {above:g} m remove the complete ellipsoid of height {height:g} m.", below=below,
            above=above, height=2.0 * half,
        )  # fmt: skip
    low, high = math.acos(max(below / half - 1.0, -1.0)), math.acos(min(1.0 - above / half, 1.0))
    top = 2.0 * half - below - above
    pieces = [Meridian(np.array([[low, high], [half - below, half]]), arc=True)]
    if below > 0.0:
        pieces.insert(0, Meridian(np.array([[0.0, 0.0], [math.sin(low), 0.0]])))
    if above > 0.0:
        pieces.append(Meridian(np.array([[math.sin(high), top], [0.0, top]])))
    return Turned(tuple(pieces), (a, b))


def sphere_cap(diameter: float, height: float) -> Turned:
    """Return the cap of a sphere above a horizontal cut, with the cut as base.

    Parameters
    ----------
    diameter : float
        Diameter of the sphere [m].
    height : float
        Height of the cap, at most the diameter [m].

    Returns
    -------
    Turned
        The shape.

    Examples
    --------
    >>> round(sphere_cap(2.0, 0.5).moments().mass * 24.0 / np.pi, 12)
    5.0
    """
    high = checks.within("height", height, 0.0, checks.length("diameter", diameter), unit="m", open_low=True)
    return ellipsoid(diameter, diameter, diameter, cut_below=diameter - high)
