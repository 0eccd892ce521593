"""Pieces of the surface of a solid, and how each is split and sampled."""

from abc import ABC, abstractmethod
from functools import cache

import numpy as np

from rocking.conventions import FloatArray
from rocking.portable import gauss_legendre, gauss_rule


class Surface(ABC):
    """A batch of surface cells that can be split in four and sampled by a Gauss rule.

    A cell array holds one cell a row; what a row means is the subclass's own business.
    """

    @abstractmethod
    def cells(self) -> FloatArray:
        """Return the coarse cells that cover the surface once."""

    @abstractmethod
    def outline(self, cells: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return points that span each cell, with the area vectors they stand for.

        Returns points: the middle first [m] (shape (n, m, 3)); areas: outward normal times the area of the whole cell,
        as it is at each of the points [m2] (shape (n, m, 3)).
        """

    @abstractmethod
    def split(self, cells: FloatArray) -> FloatArray:
        """Return four cells for each."""

    @abstractmethod
    def sample(self, cells: FloatArray, order: int) -> tuple[FloatArray, FloatArray]:
        """Return Gauss points of the cells with their area vectors.

        Returns points [m] and weighted outward normals [m2] (shape (n order^2, 3)).
        """

    @abstractmethod
    def triangles(self, divisions: int) -> FloatArray:
        """Return triangles that picture the surface.

        Returns Corners, counter-clockwise seen from outside [m].
        """


@cache
def gauss(order: int) -> tuple[FloatArray, FloatArray]:
    """Return the Gauss-Legendre rule on [0, 1].

    Returns exact for polynomials of degree ``2 order - 1``.
    """
    nodes, weights = gauss_legendre(order)
    return 0.5 * (1.0 + nodes), 0.5 * weights


@cache
def gauss_triangle(order: int) -> tuple[FloatArray, FloatArray]:
    """Return a rule for the triangle: a Gauss square collapsed onto it.

    Towards the corner that the square collapses to, the nodes are those of the weight u (Gauss-Jacobi, by Golub and
    Welsch's eigenvalues), so that nothing of the order is lost to the collapse.

    Returns shares: shares of the three corners [-] (shape (n^2, 3)); weights: weights of sum 1; exact for polynomials
    of degree ``2 n - 1`` (shape (n^2,)).
    """
    k = np.arange(1.0, order)
    side = np.sqrt(k * (k + 1.0)) / (2.0 * k + 1.0)
    i = np.arange(order)
    roots, shares_of_roots = gauss_rule(1.0 / ((2.0 * i + 1.0) * (2.0 * i + 3.0)), side)
    nodes, weights = gauss(order)
    u, v = (grid.ravel() for grid in np.meshgrid(0.5 * (1.0 + roots), nodes, indexing="ij"))
    shares = np.stack([1.0 - u, u * (1.0 - v), u * v], axis=1)
    return shares, np.outer(shares_of_roots, weights).ravel()


@cache
def gauss_square(order: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the product rule on the unit square.

    Returns nodes and weights (shape (order^2,)).
    """
    nodes, weights = gauss(order)
    u, v = np.meshgrid(nodes, nodes, indexing="ij")
    return u.ravel(), v.ravel(), np.outer(weights, weights).ravel()


def area_vectors(triangles: FloatArray) -> FloatArray:
    """Return normals of triangles times their areas.

    triangles: corners [m]. Returns area vectors [m2].
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    vectors: FloatArray = 0.5 * np.cross(b - a, c - a)
    return vectors
