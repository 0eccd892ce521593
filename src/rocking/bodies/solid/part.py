"""One shape of one material in its place: what a solid is made of."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.surfaces import Shape, Surface, placed_points, vector
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import GeometryError
from rocking.portable import applied, norm, times

_ORTHOGONAL = 1e-9


def rotation_about(axis: ArrayLike, angle: float) -> FloatArray:
    """Return the rotation about an axis through the origin (Rodrigues).

    Parameters
    ----------
    axis : array_like, shape (3,)
        Direction of the axis, of any length [-].
    angle : float
        Angle, counter-clockwise seen against the axis [rad].

    Returns
    -------
    ndarray, shape (3, 3)
        Rotation matrix [-].

    Raises
    ------
    GeometryError
        If the axis has no direction.

    Examples
    --------
    >>> rotation_about([0, 0, 1], np.pi / 2).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    direction = vector("axis", axis, "-")
    size = norm(np.asarray(direction))
    if size == 0.0:
        raise GeometryError("axis must have a direction, got (0, 0, 0)")
    turn = checks.number("angle", angle, "rad")
    cross = np.cross(direction / size, np.eye(3)).T
    result: FloatArray = np.eye(3) + np.sin(turn) * cross + (1.0 - np.cos(turn)) * times(cross, cross)
    return result


def rotation_matrix(value: ArrayLike | None) -> FloatArray:
    """Return `value` as a rotation matrix."""
    if value is None:
        return np.eye(3)
    matrix = checks.real_array("rotation", value)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise GeometryError("rotation must be a finite 3 x 3 matrix")
    if np.abs(matrix @ matrix.T - np.eye(3)).max() > _ORTHOGONAL or np.linalg.det(matrix) < 0.0:
        raise GeometryError(
            "rotation must be a rotation matrix: orthogonal, without a mirror; rotation_about makes one"
        )
    return matrix.copy()


@dataclass(frozen=True, eq=False, init=False)
class Part:
    """One shape of one material, rotated, then translated.

    Parameters
    ----------
    shape : Shape
        The volume, in a frame of its own.
    density : float
        Density [kg/m3].
    rotation : array_like, shape (3, 3), optional
        Rotation matrix [-].
    translation : array_like, shape (3,)
        Displacement of the shape's origin [m].

    Raises
    ------
    GeometryError
        If this is no shape, no rotation, or no displacement.
    InvalidValueError
        If the density is not a finite number above zero.

    Examples
    --------
    >>> from rocking.bodies.solid import box
    >>> Part(box(1.0, 1.0, 2.0), 1000.0).moved(0.0, 0.0, 1.0).moments().centre.tolist()
    [0.0, 0.0, 2.0]
    """

    shape: Shape
    density: float
    rotation: FloatArray
    translation: FloatArray

    def __init__(
        self,
        shape: Shape,
        density: float = DEFAULT_DENSITY,
        *,
        rotation: ArrayLike | None = None,
        translation: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        given: object = shape
        if not isinstance(given, Shape):
            raise GeometryError(
                "a Part needs a {parameter} (box, cylinder, extrusion, mesh ...), got {value}", parameter="shape",
                value=shape,
            )  # fmt: skip
        object.__setattr__(self, "shape", shape)
        object.__setattr__(self, "density", checks.density("density", density))
        object.__setattr__(self, "rotation", rotation_matrix(rotation))
        object.__setattr__(self, "translation", vector("translation", translation))

    def moved(self, dx: float, dy: float, dz: float) -> "Part":
        """Return the part moved.

        Parameters
        ----------
        dx, dy, dz : float
            Displacement [m].

        Returns
        -------
        Part
            The same shape elsewhere.
        """
        return self._with(self.shape, self.rotation, self.translation + vector("displacement", (dx, dy, dz)))

    def turned(self, axis: ArrayLike, angle: float) -> "Part":
        """Return the part turned about an axis through the origin.

        Parameters
        ----------
        axis : array_like, shape (3,)
            Direction [-].
        angle : float
            Angle, counter-clockwise seen against the axis [rad].

        Returns
        -------
        Part
            The same shape, turned with its place.
        """
        turn = rotation_about(axis, angle)
        return self._with(self.shape, times(turn, self.rotation), applied(turn, self.translation))

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Part":
        """Return the part with all lengths times `size`, about the origin, and its density times `density`.

        Parameters
        ----------
        size, density : float
            Factors [-].

        Returns
        -------
        Part
            The scaled part.
        """
        value = type(self.density)(self.density * checks.positive("density", density))
        return self._with(self.shape.scaled(size), self.rotation, self.translation * size, value)

    def mirrored(self) -> "Part":
        """Return the part seen in the mirror x -> -x.

        Returns
        -------
        Part
            The mirror image.
        """
        mirror = np.array([-1.0, 1.0, 1.0])
        return self._with(self.shape.mirrored(), mirror[:, None] * self.rotation * mirror, mirror * self.translation)

    def moments(self) -> SolidMoments:
        """Return mass, centre and second moments in place.

        Returns
        -------
        SolidMoments
            Exact up to rounding.
        """
        return self.shape.moments().times(self.density).placed(self.rotation, self.translation)

    def surfaces(self) -> list[Surface]:
        """Return the surface in place.

        Returns
        -------
        list of Surface
            Its pieces.
        """
        return self.shape.surfaces(self.rotation, self.translation)

    def box(self) -> FloatArray:
        """Return the bounding box in place.

        Returns
        -------
        ndarray, shape (2, 3)
            Lowest and highest coordinates [m].
        """
        box: FloatArray = self.shape.extent(self.rotation) + self.translation
        return box

    def contains(self, points: FloatArray) -> BoolArray:
        """Return which points lie inside.

        Parameters
        ----------
        points : ndarray, shape (n, 3)
            Points [m].

        Returns
        -------
        ndarray of bool, shape (n,)
            True inside.
        """
        return self.shape.contains(times(points - self.translation, self.rotation))

    def _with(
        self, shape: Shape, rotation: FloatArray, translation: FloatArray, density: float | None = None
    ) -> "Part":
        return Part(shape, self.density if density is None else density, rotation=rotation, translation=translation)


def footprint(part: Part, ground: float, tolerance: float) -> tuple[FloatArray, list[tuple[FloatArray, float]]]:
    """Return the corners, and centre and radius of the round faces, with which a part stands on a level ground [m]."""
    corners, round_faces = part.shape.footprint()
    points = placed_points(corners, part.rotation, part.translation)
    upright = abs(abs(float(part.rotation[2, 2])) - 1.0) <= 1e-12
    discs = [(placed_points(centre, part.rotation, part.translation), radius) for centre, radius in round_faces]
    standing = [(c[:2], r) for c, r in discs if upright and abs(float(c[2]) - ground) <= tolerance]
    return points[np.abs(points[:, 2] - ground) <= tolerance, :2], standing
