"""The table of the model `contact-bed`, from impacts resolved in time."""

from collections.abc import Callable

import numpy as np

from rocking.conventions import FloatArray
from rocking.restitution.bed.scaled import ScaledImpact, resolved_coefficients
from rocking.restitution.bed_table import POINTS, STEP, BedTable, nodes


def impulse_position(coefficient: FloatArray, flatness: FloatArray, offset: FloatArray) -> FloatArray:
    """Return where an impulse acts that gives a coefficient, from angular momentum about its position.

    coefficient: theta_dot_after / theta_dot_before [-]; flatness, offset: of the bodies [-]. Returns kappa [-].
    """
    gyration = 1.0 / flatness - 1.0
    arm = gyration * (1.0 - coefficient) / (1.0 + offset + coefficient * (1.0 - offset))  # Eq. 4
    return np.asarray(arm + offset)


def resolved(cases: FloatArray, points: int, *, threads: int = 1) -> FloatArray:
    """Return coefficients of restitution resolved in time.

    cases: flatness, offset, damping, hardness [-]. Returns theta_dot_after / theta_dot_before, by the next peak [-].
    """
    impacts = [
        ScaledImpact(flatness, offset, points, damping, hardness)
        for flatness, offset, damping, hardness in cases.tolist()
    ]
    return resolved_coefficients(impacts, threads=threads)


def tabulated(*, threads: int = 1, progress: Callable[[int], None] | None = None) -> BedTable:
    """Compute the table of the model `contact-bed`; takes minutes."""
    axes = nodes()
    shape = tuple(axis.size for axis in axes)
    cases = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    planes = []
    for points in POINTS:
        r = np.concatenate(
            [_told(resolved(piece, points, threads=threads), progress) for piece in np.array_split(cases, 40)]
        )
        planes.append(impulse_position(r, cases[:, 0], cases[:, 1]).reshape(shape))
    return BedTable(*axes, np.array(planes))


def stored(table: BedTable) -> np.ndarray[tuple[int, ...], np.dtype[np.int16]]:
    """Return the positions as they are shipped.

    Returns whole multiples of `bed_table.STEP`, to be written with `numpy.save`.
    """
    return np.asarray(np.rint(np.clip(table.positions, -3.9, 3.9) / STEP).astype(np.int16))


def _told(values: FloatArray, progress: Callable[[int], None] | None) -> FloatArray:
    if progress is not None:
        progress(values.size)
    return values
