"""Parts of a solid: one shape of one material with its position."""

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
        Angle, counter-clockwise against the axis direction [rad].

    Returns
    -------
    ndarray, shape (3, 3)
        Rotation matrix [-].

    Raises
    ------
    GeometryError
        If the axis is the zero vector.

    Examples
    --------
    >>> rotation_about([0, 0, 1], np.pi / 2).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    direction = vector("axis", axis, "-")
    size = norm(np.asarray(direction))
    if size == 0.0:
        raise GeometryError("axis must be a nonzero vector, got (0, 0, 0)")
    turn = checks.number("angle", angle, "rad")
    cross = np.cross(direction / size, np.eye(3)).T
    result: FloatArray = np.eye(3) + np.sin(turn) * cross + (1.0 - np.cos(turn)) * times(cross, cross)
    return result


def rotation_matrix(value: ArrayLike | None) -> FloatArray:
    """Return a checked rotation matrix [-]; None gives the identity."""
    if value is None:
        return np.eye(3)
    matrix = checks.real_array("rotation", value)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise GeometryError("rotation must be a finite 3 x 3 matrix")
    if np.abs(matrix @ matrix.T - np.eye(3)).max() > _ORTHOGONAL or np.linalg.det(matrix) < 0.0:
        raise GeometryError("rotation must be orthogonal without reflection. Use rotation_about(axis, angle).")
    return matrix.copy()


@dataclass(frozen=True, eq=False, init=False)
class Part:
    """One shape of one material with a rotation and a translation.

    Parameters
    ----------
    shape : Shape
        Volume in its own frame.
    density : float
        Density [kg/m3].
    rotation : array_like, shape (3, 3), optional
        Rotation matrix [-].
    translation : array_like, shape (3,)
        Displacement of the shape's origin [m].

    Raises
    ------
    GeometryError
        If the shape, the rotation or the translation is invalid.
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
        candidate: object = shape
        if not isinstance(candidate, Shape):
            raise GeometryError(
                "A Part needs a {parameter} (box, cylinder, extrusion, mesh ...), got {value}.", parameter="shape",
                value=shape,
            )  # fmt: skip
        object.__setattr__(self, "shape", shape)
        object.__setattr__(self, "density", checks.density("density", density))
        object.__setattr__(self, "rotation", rotation_matrix(rotation))
        object.__setattr__(self, "translation", vector("translation", translation))

    def moved(self, dx: float, dy: float, dz: float) -> "Part":
        """Return the moved part.

        Parameters
        ----------
        dx, dy, dz : float
            Displacement [m].

        Returns
        -------
        Part
            Moved part.
        """
        return self._with(self.shape, self.rotation, self.translation + vector("displacement", (dx, dy, dz)))

    def turned(self, axis: ArrayLike, angle: float) -> "Part":
        """Return the part rotated about an axis through the origin.

        Parameters
        ----------
        axis : array_like, shape (3,)
            Direction of the axis [-].
        angle : float
            Angle, counter-clockwise against the axis direction [rad].

        Returns
        -------
        Part
            Rotated part.
        """
        turn = rotation_about(axis, angle)
        return self._with(self.shape, times(turn, self.rotation), applied(turn, self.translation))

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Part":
        """Return the part scaled about the origin.

        Parameters
        ----------
        size, density : float
            Scale factors of all lengths and of the density [-].

        Returns
        -------
        Part
            Scaled part.
        """
        value = type(self.density)(self.density * checks.positive("density", density))
        return self._with(self.shape.scaled(size), self.rotation, self.translation * size, value)

    def mirrored(self) -> "Part":
        """Return the part mirrored, x -> -x.

        Returns
        -------
        Part
            Mirrored part.
        """
        mirror = np.array([-1.0, 1.0, 1.0])
        return self._with(self.shape.mirrored(), mirror[:, None] * self.rotation * mirror, mirror * self.translation)

    def moments(self) -> SolidMoments:
        """Return mass, centre of mass and second moments at the position of the part.

        Returns
        -------
        SolidMoments
            Moments, exact up to rounding.
        """
        return self.shape.moments().times(self.density).placed(self.rotation, self.translation)

    def surfaces(self) -> list[Surface]:
        """Return the surface at the position of the part.

        Returns
        -------
        list of Surface
            Pieces of the surface.
        """
        return self.shape.surfaces(self.rotation, self.translation)

    def box(self) -> FloatArray:
        """Return the bounding box at the position of the part.

        Returns
        -------
        ndarray, shape (2, 3)
            Lowest and highest coordinates [m].
        """
        box: FloatArray = self.shape.extent(self.rotation) + self.translation
        return box

    def contains(self, points: FloatArray) -> BoolArray:
        """Return True for points inside the part.

        Parameters
        ----------
        points : ndarray, shape (n, 3)
            Points [m].

        Returns
        -------
        ndarray of bool, shape (n,)
            True for points inside.
        """
        return self.shape.contains(times(points - self.translation, self.rotation))

    def _with(
        self, shape: Shape, rotation: FloatArray, translation: FloatArray, density: float | None = None
    ) -> "Part":
        return Part(shape, self.density if density is None else density, rotation=rotation, translation=translation)


def footprint(part: Part, ground: float, tolerance: float) -> tuple[FloatArray, list[tuple[FloatArray, float]]]:
    """Return contact corners (x, y), and centre and radius of round contact faces, on a horizontal ground [m]."""
    corners, round_faces = part.shape.footprint()
    points = placed_points(corners, part.rotation, part.translation)
    is_upright = abs(abs(float(part.rotation[2, 2])) - 1.0) <= 1e-12
    discs = [(placed_points(centre, part.rotation, part.translation), radius) for centre, radius in round_faces]
    contact_discs = [(c[:2], r) for c, r in discs if is_upright and abs(float(c[2]) - ground) <= tolerance]
    return points[np.abs(points[:, 2] - ground) <= tolerance, :2], contact_discs
