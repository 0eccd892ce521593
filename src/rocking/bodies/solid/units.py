"""Division of a solid into units: small pieces with lumped masses."""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.solid import Solid
from rocking.bodies.solid.surfaces import placed_points
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError

MOST_UNITS = 20_000_000  # largest number of units [-]
_SUBGRID = 3
_Pieces = tuple[FloatArray, FloatArray, int]  # masses [kg], centres [m], and order of convergence of the pieces


@dataclass(frozen=True, eq=False)
class Units:
    """Pieces of a body.

    Parameters
    ----------
    mass : ndarray, shape (n,)
        Mass of each unit [kg].
    centre : ndarray, shape (n, 3)
        Centre of mass of each unit, in the user's coordinates [m].
    part : ndarray of int, shape (n,)
        Index of the part of each unit.
    declared_order : int
        Order of convergence of sums over units to the exact integrals: 2 if the units fill every part exactly, 1 if
        voxels cut the surface.
    """

    mass: FloatArray
    centre: FloatArray
    part: IntArray
    declared_order: int

    def __len__(self) -> int:
        return len(self.mass)


def divided(solid: Solid, divisions: int) -> Units:
    """Return the units of a body, which conform to the shape of each part if possible.

    Boxes give grids, extrusions give wedges, and bodies of revolution give sectors of rings. Polyhedra whose whole
    surface is visible from the centre of mass give pieces of pyramids. Other meshes give voxels.

    Parameters
    ----------
    solid : Solid
        The body.
    divisions : int
        Approximate number of units along each direction of a part [-].

    Returns
    -------
    Units
        Units with the total mass of the body, up to the accuracy of voxels.

    Raises
    ------
    InvalidValueError
        If `divisions` is not a whole number above zero, or gives too many units.

    Examples
    --------
    >>> from rocking.bodies.solid import Solid, box
    >>> len(divided(Solid(box(1.0, 1.0, 4.0)), 4))
    64
    """
    count = _whole(divisions)
    pieces = []
    for part in solid.local_parts:
        cells = part.shape.cells(count)
        if cells is None:
            pieces.append(_voxels_of(part, float(np.ptp(part.box(), axis=0).max()) / count))
        else:
            pieces.append((part.density * cells[0], placed_points(cells[1], part.rotation, part.translation), 2))
    return _assembled(solid, pieces)


def voxels(solid: Solid, divisions: int) -> Units:
    """Return the body divided into cubes of one grid.

    A cube on the surface is divided into 27 subcubes. Its mass and centre are those of the subcubes with their middle
    inside the body.

    Parameters
    ----------
    solid : Solid
        The body.
    divisions : int
        Number of cubes along the longest side of the body [-].

    Returns
    -------
    Units
        Units of order 1, because the surface cuts cubes.
    """
    step = solid.size / _whole(divisions)
    return _assembled(solid, [_voxels_of(part, step) for part in solid.local_parts])


def _assembled(solid: Solid, pieces: list[_Pieces]) -> Units:
    masses, centres, orders = zip(*pieces, strict=True)
    numbers = [np.full(len(mass), i) for i, mass in enumerate(masses)]
    return Units(np.concatenate(masses), np.concatenate(centres) + solid.origin, np.concatenate(numbers), min(orders))


def _whole(divisions: int) -> int:
    return checks.whole("divisions", divisions, 1, round(MOST_UNITS ** (1 / 3)))


def _voxels_of(part: Part, step: float) -> _Pieces:
    low, high = part.box()
    counts = np.maximum(np.ceil((high - low) / step - 1e-9).astype(int), 1)
    if counts.prod() * _SUBGRID**3 > MOST_UNITS * 10:
        raise InvalidValueError(
            "{parameter} gives {voxels} voxels, more than the limit", parameter="divisions", voxels=int(counts.prod()),
            hint="use fewer divisions",
        )  # fmt: skip
    fine = counts * _SUBGRID
    axes = [start + (np.arange(n) + 0.5) * step / _SUBGRID for start, n in zip(low, fine, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    index = np.stack(np.unravel_index(np.arange(len(points)), tuple(fine)), axis=1) // _SUBGRID
    number = np.ravel_multi_index(tuple(index.T), tuple(counts))
    is_inside = part.contains(points)
    number, points = number[is_inside], points[is_inside]
    count = np.bincount(number, minlength=int(counts.prod()))
    used = count > 0
    sums = np.stack([np.bincount(number, weights=points[:, i], minlength=len(count)) for i in range(3)], axis=1)
    mass: FloatArray = part.density * count[used].astype(np.float64) * (step / _SUBGRID) ** 3
    return mass, sums[used] / count[used, None], 1
