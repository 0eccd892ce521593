"""One polygon of one material: what a section is made of."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies import _rings
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.conventions import FloatArray
from rocking.errors import GeometryError


@dataclass(frozen=True, eq=False, init=False)
class Region:
    """One polygon of one material.

    Parameters
    ----------
    outline : array_like, shape (n, 2)
        Vertices (x, y), y up [m], in either sense of rotation; the first need not be repeated at the end.
    density : float
        Density [kg/m3].
    holes : sequence of array_like
        Rings cut out of the outline [m].

    Raises
    ------
    GeometryError
        If a ring crosses itself or another, or a hole lies outside the outline.
    InvalidValueError
        If the density is not a finite number above zero.

    Examples
    --------
    >>> from rocking import Region
    >>> Region([(0, 0), (1, 0), (1, 2), (0, 2)], density=2400.0).outline.shape
    (4, 2)
    """

    outline: FloatArray
    density: float
    holes: tuple[FloatArray, ...]

    def __init__(self, outline: ArrayLike, density: float = DEFAULT_DENSITY, holes: Sequence[ArrayLike] = ()) -> None:
        given: object = holes
        if not isinstance(given, (Sequence, np.ndarray)):
            raise GeometryError("holes must be a list of rings, each a list of (x, y) points in m")
        outer = _rings.checked_ring("outline", outline)
        inner = tuple(_rings.checked_ring(f"hole {i}", hole) for i, hole in enumerate(holes))
        _rings.check_polygon("region", outer, inner)
        self._set(outer, checks.density("density", density), inner)

    def _set(self, outline: FloatArray, density: float, holes: Sequence[FloatArray]) -> None:
        # outline counter-clockwise, holes clockwise: the boundary integrals then add up by themselves
        object.__setattr__(self, "outline", _turned(outline, 1.0))
        object.__setattr__(self, "density", density)
        object.__setattr__(self, "holes", tuple(_turned(hole, -1.0) for hole in holes))

    @property
    def rings(self) -> tuple[FloatArray, ...]:
        """Outline (counter-clockwise) and holes (clockwise) [m]."""
        return (self.outline, *self.holes)

    def moved(self, dx: float, dy: float) -> "Region":
        """Return the region moved by (dx, dy).

        Parameters
        ----------
        dx, dy : float
            Displacement [m].

        Returns
        -------
        Region
            The same shape elsewhere.
        """
        return self.mapped(lambda ring: ring + np.array([dx, dy]))

    def mapped(self, change: Callable[[FloatArray], FloatArray], density: float = 1.0) -> "Region":
        """Return the region under a similarity, with its density times a factor.

        Parameters
        ----------
        change : callable
            Takes a ring (n, 2) and returns it moved, mirrored or scaled.
        density : float
            Factor on the density [-].

        Returns
        -------
        Region
            Not checked again: a similarity keeps a valid region valid.
        """
        region = object.__new__(Region)
        outline, *holes = (change(ring) for ring in self.rings)
        region._set(outline, type(self.density)(self.density * density), holes)
        return region


def _turned(ring: FloatArray, sense: float) -> FloatArray:
    x, y = (ring - ring[0]).T
    twice_area = float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
    result = ring if twice_area * sense > 0.0 else ring[::-1]
    return np.ascontiguousarray(result)
