"""A solid divided into units: small pieces with the mass in their middle."""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.solid import Solid
from rocking.bodies.solid.surfaces import placed_points
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError

MOST_UNITS = 20_000_000  # finer divisions are refused [-]
_SUBGRID = 3
_Pieces = tuple[FloatArray, FloatArray, int]  # masses [kg], centres [m], order of convergence


@dataclass(frozen=True, eq=False)
class Units:
    """Pieces of a body.

    Parameters
    ----------
    mass : ndarray, shape (n,)
        Mass of each [kg].
    centre : ndarray, shape (n, 3)
        Where it is lumped, in the user's coordinates as `Solid.centre` and `Solid.base` [m].
    part : ndarray of int, shape (n,)
        Part that it belongs to.
    declared_order : int
        Order of convergence of sums over units to the exact integrals: 2 where the units fill every part exactly,
        1 where voxels cut its surface.
    """

    mass: FloatArray
    centre: FloatArray
    part: IntArray
    declared_order: int

    def __len__(self) -> int:
        return len(self.mass)


def divided(solid: Solid, divisions: int) -> Units:
    """Return the body divided into units, conforming to each part where its shape allows.

    Boxes become grids, extrusions wedges, turned shapes sectors of rings, polyhedra that are seen whole from their
    centre become pieces of pyramids; other meshes become voxels.

    Parameters
    ----------
    solid : Solid
        The body.
    divisions : int
        Units along each direction of a part, more or less [-].

    Returns
    -------
    Units
        Their masses add up to that of the body (to the voxels' accuracy where there are some).

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
    """Return the body divided into cubes of one grid, whatever its shape.

    A cube on the surface has the mass and the centre of those of its 27 parts whose middles lie inside.

    Parameters
    ----------
    solid : Solid
        The body.
    divisions : int
        Cubes along the longest side of the body [-].

    Returns
    -------
    Units
        Of order 1, because the surface cuts cubes.
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
            "{parameter} give {voxels} voxels, which are too many", parameter="divisions", voxels=int(counts.prod()),
            hint="take fewer",
        )  # fmt: skip
    fine = counts * _SUBGRID
    axes = [start + (np.arange(n) + 0.5) * step / _SUBGRID for start, n in zip(low, fine, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    index = np.stack(np.unravel_index(np.arange(len(points)), tuple(fine)), axis=1) // _SUBGRID
    number = np.ravel_multi_index(tuple(index.T), tuple(counts))
    held = part.contains(points)
    number, points = number[held], points[held]
    share = np.bincount(number, minlength=int(counts.prod()))
    used = share > 0
    sums = np.stack([np.bincount(number, weights=points[:, i], minlength=len(share)) for i in range(3)], axis=1)
    mass: FloatArray = part.density * share[used].astype(np.float64) * (step / _SUBGRID) ** 3
    return mass, sums[used] / share[used, None], 1
