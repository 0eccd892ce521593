"""The base of a solid: corners and edges that it may rock about, or a circle."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.portable import applied, norm


@dataclass(frozen=True, slots=True, eq=False)
class Corner:
    """A point on the ground that a body turns about.

    Parameters
    ----------
    point : ndarray, shape (3,)
        Its place [m].
    """

    point: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Edge:
    """A line on the ground that a body turns about.

    Parameters
    ----------
    point : ndarray, shape (3,)
        A point on it [m].
    direction : ndarray, shape (3,)
        Unit vector along it, counter-clockwise around the base seen from above [-]; a body that turns outward over
        this edge has an angular velocity along it.
    """

    point: FloatArray
    direction: FloatArray


class Base(ABC):
    """Where a solid stands."""

    height: float

    @abstractmethod
    def margin(self, point: FloatArray) -> float:
        """Return how far inside the base a point of the ground lies.

        Parameters
        ----------
        point : ndarray, shape (2,)
            Its place (x, y) [m].

        Returns
        -------
        float
            Distance to the nearest edge, negative outside [m].
        """

    @property
    @abstractmethod
    def size(self) -> float:
        """Largest extent of the base [m]."""

    @abstractmethod
    def edge(self, which: float) -> Edge:
        """Return one edge.

        Parameters
        ----------
        which : float
            Number of the edge of a polygon; for a circle the direction of the tangent point from the centre [rad].

        Returns
        -------
        Edge
            The edge.
        """

    @abstractmethod
    def changed(self, matrix: FloatArray, shift: FloatArray) -> "Base":
        """Return the base under a similarity of the plane.

        Parameters
        ----------
        matrix : ndarray, shape (2, 2)
            Rotation, mirror or scale [-].
        shift : ndarray, shape (3,)
            Displacement [m].

        Returns
        -------
        Base
            The base in its new place.
        """


@dataclass(frozen=True, eq=False)
class RoundBase(Base):
    """A circle that a solid stands on.

    Parameters
    ----------
    centre : ndarray, shape (2,)
        Centre (x, y) [m].
    radius : float
        Radius [m].
    height : float
        Height of the ground [m].
    """

    centre: FloatArray
    radius: float
    height: float = 0.0

    @property
    def size(self) -> float:
        """Diameter [m]."""
        return 2.0 * self.radius

    def edge(self, which: float) -> Edge:
        """Return the tangent of the circle."""
        angle = checks.number("edge", which, "rad")
        outward = np.array([math.cos(angle), math.sin(angle)])
        point = np.array([*(self.centre + self.radius * outward), self.height])
        return Edge(point, np.array([-outward[1], outward[0], 0.0]))

    def margin(self, point: FloatArray) -> float:
        return self.radius - norm(point - self.centre)

    def changed(self, matrix: FloatArray, shift: FloatArray) -> "RoundBase":
        scale = math.sqrt(abs(float(matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0])))
        return RoundBase(applied(matrix, self.centre) + shift[:2], self.radius * scale, self.height * scale + shift[2])
