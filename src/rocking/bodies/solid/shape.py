"""What every shape in space answers: the volume that a part is made of."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.moments import SolidMoments
from rocking.bodies.solid.surfaces import Surface
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import GeometryError
from rocking.portable import applied


@dataclass(frozen=True, slots=True, eq=False)
class Footprint:
    """What a shape leaves on the plane it may stand on."""

    points: FloatArray  # corners that may touch the ground [m]; shape (n, 3)
    # centre [m] and radius [m] of round faces that may stand flat on it
    discs: tuple[tuple[FloatArray, float], ...] = ()


class Shape(ABC):
    """A closed volume in a frame of its own, z up where the shape has an axis."""

    @abstractmethod
    def moments(self) -> SolidMoments:
        """Return volume, centre and second moments, at unit density.

        Returns
        -------
        SolidMoments
            Exact up to rounding.
        """

    @abstractmethod
    def surfaces(self, rotation: FloatArray | None = None, translation: FloatArray | None = None) -> list[Surface]:
        """Return the placed surface, normals outward.

        Parameters
        ----------
        rotation : ndarray, shape (3, 3), optional
            Rotation matrix [-].
        translation : ndarray, shape (3,), optional
            Displacement [m].

        Returns
        -------
        list of Surface
            Its pieces.
        """

    @abstractmethod
    def extent(self, rotation: FloatArray) -> FloatArray:
        """Return the box of the rotated shape.

        Parameters
        ----------
        rotation : ndarray, shape (3, 3)
            Rotation matrix [-].

        Returns
        -------
        ndarray, shape (2, 3)
            Lowest and highest coordinates [m].
        """

    @abstractmethod
    def footprint(self) -> Footprint:
        """Return the corners and round faces that may stand on the ground.

        Returns
        -------
        Footprint
            In the shape's own frame.
        """

    @abstractmethod
    def contains(self, points: FloatArray) -> BoolArray:
        """Return which points lie inside.

        Parameters
        ----------
        points : ndarray, shape (n, 3)
            Points in the shape's own frame [m].

        Returns
        -------
        ndarray of bool, shape (n,)
            True inside; either on the surface.
        """

    @abstractmethod
    def scaled(self, size: float) -> "Shape":
        """Return the shape with all lengths times `size`.

        Parameters
        ----------
        size : float
            Factor [-].

        Returns
        -------
        Shape
            The larger or smaller shape.
        """

    @abstractmethod
    def mirrored(self) -> "Shape":
        """Return the shape seen in the mirror x -> -x of its own frame.

        Returns
        -------
        Shape
            The mirror image.
        """

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray] | None:
        """Return units that fill the shape without gaps, if it can be divided so.

        Parameters
        ----------
        divisions : int
            Units a direction, more or less.

        Returns
        -------
        (ndarray, ndarray) or None
            Volumes (n,) [m3] and centres (n, 3) [m]; None where only voxels serve.
        """
        return None


def vector(name: str, value: Any, unit: str = "m") -> FloatArray:
    """Return `value` as three finite numbers."""
    array = checks.real_array(name, value, unit)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise GeometryError(f"{name} must be three finite numbers (x, y, z) [{unit}], got {value!r:.60}")
    return array.copy()


def placed_points(points: FloatArray, rotation: FloatArray | None, translation: FloatArray | None) -> FloatArray:
    """Return points rotated, then translated."""
    turned = points if rotation is None else applied(rotation, points)
    return turned if translation is None else turned + translation
