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
    """A closed volume in a frame of its own, z up where the shape has an axis; the methods speak of that frame."""

    @abstractmethod
    def moments(self) -> SolidMoments:
        """Return volume, centre and second moments at unit density, exact up to rounding."""

    @abstractmethod
    def surfaces(self, rotation: FloatArray | None = None, translation: FloatArray | None = None) -> list[Surface]:
        """Return the pieces of the surface, normals outward, rotated [-], then translated [m]."""

    @abstractmethod
    def extent(self, rotation: FloatArray) -> FloatArray:
        """Return lowest and highest coordinates of the rotated shape [m]; shape (2, 3)."""

    @abstractmethod
    def footprint(self) -> Footprint:
        """Return the corners and round faces that may stand on the ground."""

    @abstractmethod
    def hull_points(self) -> FloatArray:
        """Return points whose convex hull is that of the shape, (n, 3) [m]; round faces as those of 360 corners."""

    @abstractmethod
    def contains(self, points: FloatArray) -> BoolArray:
        """Return which points (n, 3) lie inside [m]; on the surface either."""

    @abstractmethod
    def scaled(self, size: float) -> "Shape":
        """Return the shape with all lengths times `size` [-]."""

    @abstractmethod
    def mirrored(self) -> "Shape":
        """Return the shape seen in the mirror x -> -x."""

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray] | None:
        """Return volumes [m3] and centres [m] of units that fill the shape without gaps, so many a direction or about.

        None where only voxels serve.
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
