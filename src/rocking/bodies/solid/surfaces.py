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
        """Return the coarse cells that cover the surface once.

        Returns
        -------
        ndarray, shape (n, ...)
            The cells.
        """

    @abstractmethod
    def outline(self, cells: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return points that span each cell, with the area vectors they stand for.

        Parameters
        ----------
        cells : ndarray, shape (n, ...)
            Cells.

        Returns
        -------
        points : ndarray, shape (n, m, 3)
            The middle first [m].
        areas : ndarray, shape (n, m, 3)
            Outward normal times the area of the whole cell, as it is at each of the points [m2].
        """

    @abstractmethod
    def split(self, cells: FloatArray) -> FloatArray:
        """Return four cells for each.

        Parameters
        ----------
        cells : ndarray, shape (n, ...)
            Cells.

        Returns
        -------
        ndarray, shape (4 n, ...)
            Their quarters.
        """

    @abstractmethod
    def sample(self, cells: FloatArray, order: int) -> tuple[FloatArray, FloatArray]:
        """Return Gauss points of the cells with their area vectors.

        Parameters
        ----------
        cells : ndarray, shape (n, ...)
            Cells.
        order : int
            Points in each of the two directions.

        Returns
        -------
        points, areas : ndarray, shape (n order^2, 3)
            Points [m] and weighted outward normals [m2].
        """

    @abstractmethod
    def triangles(self, divisions: int) -> FloatArray:
        """Return triangles that picture the surface.

        Parameters
        ----------
        divisions : int
            Divisions of a quarter turn, and of a flat piece.

        Returns
        -------
        ndarray, shape (n, 3, 3)
            Corners, counter-clockwise seen from outside [m].
        """


@cache
def gauss(order: int) -> tuple[FloatArray, FloatArray]:
    """Return the Gauss-Legendre rule on [0, 1].

    Parameters
    ----------
    order : int
        Number of points.

    Returns
    -------
    nodes, weights : ndarray
        Exact for polynomials of degree ``2 order - 1``.
    """
    nodes, weights = gauss_legendre(order)
    return 0.5 * (1.0 + nodes), 0.5 * weights


@cache
def gauss_triangle(order: int) -> tuple[FloatArray, FloatArray]:
    """Return a rule for the triangle: a Gauss square collapsed onto it.

    Towards the corner that the square collapses to, the nodes are those of the weight u (Gauss-Jacobi, by Golub and
    Welsch's eigenvalues), so that nothing of the order is lost to the collapse.

    Parameters
    ----------
    order : int
        Points in each direction, n.

    Returns
    -------
    shares : ndarray, shape (n^2, 3)
        Shares of the three corners [-].
    weights : ndarray, shape (n^2,)
        Weights of sum 1; exact for polynomials of degree ``2 n - 1``.
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

    Parameters
    ----------
    order : int
        Points in each direction.

    Returns
    -------
    u, v, weights : ndarray, shape (order^2,)
        Nodes and weights.
    """
    nodes, weights = gauss(order)
    u, v = np.meshgrid(nodes, nodes, indexing="ij")
    return u.ravel(), v.ravel(), np.outer(weights, weights).ravel()


def area_vectors(triangles: FloatArray) -> FloatArray:
    """Return normals of triangles times their areas.

    Parameters
    ----------
    triangles : ndarray, shape (n, 3, 3)
        Corners [m].

    Returns
    -------
    ndarray, shape (n, 3)
        Area vectors [m2].
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    vectors: FloatArray = 0.5 * np.cross(b - a, c - a)
    return vectors
