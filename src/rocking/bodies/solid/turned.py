"""Volumes with a round or elliptical plan: a profile turned about an axis."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.solid.moments import SolidMoments
from rocking.bodies.solid.shape import Footprint, Shape
from rocking.bodies.solid.surfaces import Surface, gauss
from rocking.bodies.solid.triangle_surface import TriangleSurface
from rocking.bodies.solid.triangulation import triangulated
from rocking.bodies.solid.turned_surface import TurnedSurface
from rocking.conventions import BoolArray, FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Meridian:
    """One piece of the profile that is turned."""

    data: FloatArray  # as `TurnedSurface` takes it; shape (2, 2)
    arc: bool = False  # whether it is an arc of an ellipse

    def at(self, share: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return radius and height along the piece.

        share: position along it, 0 to 1 [-]. Returns radius [-] and height [m].
        """
        first, second = self.data
        if self.arc:
            polar = first[0] + (first[1] - first[0]) * share
            return np.sin(polar), second[0] + second[1] * np.cos(polar)
        return first[0] + (second[0] - first[0]) * share, first[1] + (second[1] - first[1]) * share

    def scaled(self, size: float) -> "Meridian":
        """Return the piece with its heights times `size`, its radii as they are.

        size: factor [-]. Returns the piece of the larger or smaller shape.
        """
        factors = np.array([[1.0, 1.0], [size, size]] if self.arc else [[1.0, size], [1.0, size]])
        return Meridian(self.data * factors, self.arc)


class Turned(Shape):
    """A profile turned about the z axis, its plan stretched to an ellipse where asked for.

    Parameters
    ----------
    meridians : tuple of Meridian
        Profile from the axis at the bottom, counter-clockwise, to the axis at the top.
    half_axes : (float, float)
        Stretch along x and y [m].
    """

    def __init__(self, meridians: tuple[Meridian, ...], half_axes: tuple[float, float]) -> None:
        self.meridians, self.half_axes = meridians, half_axes

    def __repr__(self) -> str:
        """Pieces and volume."""
        return f"Turned({len(self.meridians)} pieces, {self.moments().mass:g} m3)"

    def moments(self) -> SolidMoments:
        """Return volume, centre and second moments, in closed form for every piece.

        ``V = pi a b Int rho^2 dz``, ``Int x^2 dV = pi a^3 b/4 Int rho^4 dz``: rho or its square is a polynomial of
        the height, and three Gauss points integrate degree five exactly.
        """
        (a, b), (nodes, weights) = self.half_axes, gauss(3)
        sums = np.zeros(4)
        middle = 0.5 * float(self.extent(np.eye(3))[:, 2].sum())
        for piece in self.meridians:
            (_, z0), (_, z1) = (tuple(float(v[0]) for v in piece.at(np.array([end]))) for end in (0.0, 1.0))
            z = z0 + (z1 - z0) * nodes
            squared = self._squared(piece, z, nodes)
            up = z - middle
            sums += (weights * (z1 - z0) * np.array([squared, squared * up, squared * up * up, squared**2])).sum(axis=1)
        volume = math.pi * a * b * float(sums[0])
        height = float(sums[1] / sums[0])
        around = 0.25 * math.pi * a * b * float(sums[3])
        vertical = math.pi * a * b * float(sums[2] - sums[0] * height**2)
        second = np.diag([around * a * a, around * b * b, vertical])
        return SolidMoments(volume, np.array([0.0, 0.0, middle + height]), second)

    @staticmethod
    def _squared(piece: Meridian, z: FloatArray, share: FloatArray) -> FloatArray:
        if piece.arc:
            centre, half = piece.data[1]
            arc: FloatArray = 1.0 - ((z - centre) / half) ** 2
            return arc
        straight: FloatArray = piece.at(share)[0] ** 2
        return straight

    def surfaces(self, rotation: FloatArray | None = None, translation: FloatArray | None = None) -> list[Surface]:
        """Return the placed surface, one piece for each piece of the profile."""
        turn = np.eye(3) if rotation is None else rotation
        move = np.zeros(3) if translation is None else translation
        return [TurnedSurface(piece.data, self.half_axes, piece.arc, turn, move) for piece in self.meridians]

    def extent(self, rotation: FloatArray) -> FloatArray:
        """Return the box of the rotated shape: of its circles, exact for straight profiles."""
        radius, height = self.profile()
        a, b = self.half_axes
        middle = np.outer(height, rotation[:, 2])
        reach = np.outer(radius, np.hypot(a * rotation[:, 0], b * rotation[:, 1]))
        return np.array([(middle - reach).min(axis=0), (middle + reach).max(axis=0)])

    def profile(self, chords: int = 48) -> tuple[FloatArray, FloatArray]:
        """Return the profile as a polygon in the half plane.

        Parameters
        ----------
        chords : int
            Chords of an arc [-].

        Returns
        -------
        radius, height : ndarray
            Corners, from the axis at the bottom to the axis at the top [-] and [m].
        """
        ends = [piece.at(np.linspace(0.0, 1.0, chords + 1 if piece.arc else 2)[:-1]) for piece in self.meridians]
        last = self.meridians[-1].at(np.array([1.0]))
        radius, height = (np.concatenate([*(end[i] for end in ends), last[i]]) for i in range(2))
        return radius, height

    def footprint(self) -> Footprint:
        """Return the discs at the bottom and at the top, if the plan is round."""
        (a, b), discs, rims = self.half_axes, [], []
        flat = [p for p in self.meridians if not p.arc and p.data[0, 1] == p.data[1, 1]]
        phi = np.linspace(0.0, 2.0 * math.pi, 361)[:-1]
        for piece in flat:
            radius, height = float(piece.data[:, 0].max()), float(piece.data[0, 1])
            if a == b:
                discs.append((np.array([0.0, 0.0, height]), a * radius))
            else:
                rims.append(np.stack([a * radius * np.cos(phi), b * radius * np.sin(phi), 0 * phi + height], axis=1))
        return Footprint(np.concatenate([np.zeros((0, 3)), *rims]), tuple(discs))

    def contains(self, points: FloatArray) -> BoolArray:
        """Return which points lie inside the turned profile."""
        import shapely

        polygon = shapely.Polygon(np.stack(self.profile(), axis=1))
        shapely.prepare(polygon)
        a, b = self.half_axes
        found: BoolArray = shapely.contains_xy(polygon, np.hypot(points[:, 0] / a, points[:, 1] / b), points[:, 2])
        return found

    def scaled(self, size: float) -> "Turned":
        factor, (a, b) = checks.positive("size", size), self.half_axes
        return Turned(tuple(piece.scaled(factor) for piece in self.meridians), (a * factor, b * factor))

    def mirrored(self) -> "Turned":
        """Return the mirror image, which is the shape itself."""
        return self

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray]:
        """Return rings of the profile cut into sectors, with their own centres."""
        flat = _refined(triangulated(np.stack(self.profile(4 * divisions), axis=1)), divisions)
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
        reach, height = np.repeat(second / mean[:, None], len(phi), axis=0).T
        around = np.tile(phi, len(flat))
        return volumes, np.stack(
            [a * chord * reach * np.cos(around), b * chord * reach * np.sin(around), height], axis=1
        )


def _refined(triangles: FloatArray, divisions: int) -> FloatArray:
    lifted = np.concatenate([triangles, np.zeros((*triangles.shape[:2], 1))], axis=2)
    flat: FloatArray = TriangleSurface(lifted).triangles(divisions)[..., :2]
    return flat
