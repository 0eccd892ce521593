"""Overturning maps refined along the boundaries between modes, and only there."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import conventions
from rocking.bodies import Body
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.dynamics.response import Motion
from rocking.studies.axis import Axis
from rocking.studies.lattice import Lattice
from rocking.studies.plane import Plane

_PIECE = 1 << 17


@dataclass(frozen=True, eq=False)
class Refined:
    """Points of a map that has been refined along the boundaries between modes.

    Parameters
    ----------
    x, y : ndarray
        Coordinates of all points, in the units of the axes.
    modes : ndarray of int
        How each ended: -3 failed, -2 not lifted, -1 survived, n >= 0 overturned after n impacts.
    peak_ratio : ndarray
        Peak rotation over the slenderness angle [-].
    base : ndarray of bool
        Whether a point is one of the map before refinement.
    """

    x: FloatArray
    y: FloatArray
    modes: IntArray
    peak_ratio: FloatArray
    base: BoolArray


def refined(
    plane: Plane, modes: IntArray, levels: int, progress: Callable[[int], None] | None = None, peaks: Any = None
) -> Refined:
    """Return a map that is known, refined wherever its modes differ between neighbours.

    peaks: relative peaks of the map; NaN if not given [-]. Returns all points; the map's own first, in its order.
    """
    return refine(Lattice(plane, levels, progress), modes, peaks)[0]


def refine(lattice: Lattice, modes: IntArray, peaks: Any = None) -> tuple[Refined, tuple[IntArray, IntArray]]:
    """Return a map that is known, refined on a lattice of which nothing is known yet, and its mixed finest cells.

    peaks: relative peaks of the map; NaN if not given [-]. Returns refined: all points; the map's own first, in its
    order; cells: columns and rows of the finest cells whose corners differ: where `rocking.studies._boundary.outlines`
    begins.
    """
    first = lattice.base()
    known = np.full(first.size, np.nan) if peaks is None else np.asarray(peaks, dtype=np.float64).ravel()
    lattice.learn(first, np.asarray(modes, dtype=np.int64).ravel(), known)
    cells = lattice.finest(_whole)
    own = np.zeros(lattice.keys.size, dtype=np.bool_)
    own[np.searchsorted(lattice.keys, first)] = True
    places = np.concatenate([np.flatnonzero(own), np.flatnonzero(~own)])  # the map's own first
    x, y = _coordinates(lattice, places)
    base = np.arange(places.size) < first.size
    return Refined(x, y, lattice.modes[places], lattice.peaks[places], base), cells


def _coordinates(lattice: Lattice, places: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return the coordinates of known points, made piece by piece: on the way they take many times their room."""
    x, y = np.empty(places.size), np.empty(places.size)
    for first in range(0, places.size, _PIECE):
        part = slice(first, first + _PIECE)
        keys = lattice.keys[places[part]]
        x[part], y[part] = lattice.coordinates(keys % lattice.columns, keys // lattice.columns)
    return x, y


def refined_map(
    body: Body,
    motion: Motion,
    x: Axis | tuple[str, Any],
    y: Axis | tuple[str, Any],
    restitution: Any = "ked",
    *,
    levels: int = 3,
    gravity: float = conventions.g,
    progress: Callable[[int], None] | None = None,
    **options: Any,
) -> Refined:
    """Return the points of an overturning map that is refined along the boundaries between modes.

    Cells whose corners have different modes are cut into four, level by level, and only new points are computed. What
    is narrower than a cell and touches no corner of it is not seen.

    Parameters
    ----------
    body : Body
        The body, as it is where the axes do not change it.
    motion : GroundMotion or Pulse
        The motion, as it is where the axes do not change it.
    x, y : Axis or (str, array_like)
        Axes, as for `overturning_map`.
    restitution : as for `simulate`
        Not one drawn at random.
    levels : int
        Levels of refinement; each halves the spacing [-].
    gravity : float
        Acceleration of gravity [m/s2].
    progress : callable, optional
        Called with the number of histories done since the last call.
    **options
        ``threads``, ``engine`` and fields of `Settings`.

    Returns
    -------
    Refined
        All points; the map's own first, x varying fastest.
    """
    plane = Plane.of(body, motion, x, y, restitution, gravity=gravity, **options)
    found, _ = plane.answers(*plane.mesh(), progress=progress)
    return refined(plane, found["mode"], levels, progress, found["peak_ratio"])


def _whole(modes: IntArray) -> IntArray:
    return modes
