"""Impulse positions of a contact bed, by linear interpolation in a table of impacts resolved in time."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from importlib.resources import files
from typing import Final

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.portable import each

POINTS: Final = (2, 3, 5, 11, 41)  # tabulated numbers of contact points
DAMPING: Final = (0.05, 5.0)  # range of the damping ratio [-]
HARDNESS: Final = (30.0, 1000.0)  # range of the hardness [-]
STEP: Final = 2.0**-13  # resolution of the stored positions [-]

BANDS: Final = (0.05, 0.1, 0.3, 0.5, 1.0)
"""Lower limits of the damping ratio for the rows of `STATED_ERRORS`, and for `DAMPED` [-]."""

SQUATNESS: Final = (0.0, 0.2, 0.3, 0.35)
"""Lower limits of flatness for the columns of `STATED_ERRORS` [-].

The limits correspond to all bodies, and to rectangles with h/b < 1.7, 1.2, 1.1.
"""

STATED_ERRORS: Final = {
    2: ((0.04, 0.2, 0.19, 0.05), (0.03, 0.17, 0.17, 0.17), (0.0095, 0.03, 0.12, 0.14), (0.001, 0.006, 0.025, 0.09)),
    3: (
        (0.03, 0.045, 0.15, 0.17),
        (0.025, 0.03, 0.09, 0.14),
        (0.004, 0.015, 0.017, 0.02),
        (0.001, 0.005, 0.0069, 0.008),
    ),
    5: (
        (0.03, 0.045, 0.05, 0.14),
        (0.015, 0.03, 0.045, 0.11),
        (0.003, 0.015, 0.016, 0.026),
        (0.001, 0.003, 0.009, 0.009),
    ),
    11: (
        (0.02, 0.04, 0.053, 0.15),
        (0.016, 0.033, 0.05, 0.05),
        (0.003, 0.014, 0.018, 0.02),
        (0.001, 0.0031, 0.0095, 0.012),
    ),
    41: (
        (0.02, 0.04, 0.052, 0.05),
        (0.016, 0.034, 0.038, 0.047),
        (0.006, 0.012, 0.019, 0.025),
        (0.002, 0.006, 0.008, 0.013),
    ),
}
"""Largest difference in r from an impact resolved in time [-].

The keys are numbers of points, the rows are bands of damping below 1, and the columns are bands of flatness.


The median is at most 2e-3. Linear interpolation has larger errors at two singularities: the number of hops changes on
lightly damped beds, and r of a squat body that almost stops decreases to zero like a square root."""

DAMPED: Final = (0.001, 0.001, 0.0015, 0.002)
"""Largest difference in r for damping >= 1 and all numbers of points, by band of flatness [-]."""


def stated_error(points: int, damping: float, flatness: FloatArray | float) -> FloatArray:
    """Return the stated error of the table [-]."""
    band = np.searchsorted(BANDS, damping, side="right") - 1
    errors = DAMPED if band == len(BANDS) - 1 else STATED_ERRORS[points][int(band)]
    return np.asarray(errors)[np.searchsorted(SQUATNESS, flatness, side="right") - 1]


Bed = tuple[IntArray, FloatArray, FloatArray]  # cell of the table, and fractions in it along hardness and damping


@dataclass(frozen=True, eq=False)
class BedTable:
    """Table of impulse positions kappa over half the base, from the middle of the base (0) to the new foot (1)."""

    # nodes of 1 / (1 + rho) [-], rho = (I_C + m h^2) / (m w^2), w: half of the distance between the feet
    flatness: FloatArray
    offset: FloatArray  # nodes of the distance from the plumb line back to the middle of the base, over w [-]
    damping: FloatArray  # nodes of the damping ratio [-]
    hardness: FloatArray  # nodes of the dimensionless landing speed v sqrt(k / m) / g [-]
    positions: FloatArray  # kappa by point count, flatness, offset, damping and hardness [-]

    def bed(self, points: IntArray | int, damping: FloatArray | float, hardness: FloatArray | float) -> Bed:
        """Return the positions of beds in the table. Arguments are broadcast."""
        (low, across), (lower, along) = map(
            _between, self._logarithms, (each(math.log, hardness), each(math.log, damping))
        )
        cell = self.positions[0].size * np.searchsorted(POINTS, points) + lower * self.hardness.size + low
        return cell, across, along

    def position(self, bed: Bed, flatness: FloatArray, offset: FloatArray | float) -> FloatArray:
        """Return the impulse positions for bodies on beds, broadcast [-]. Outside the table, the value at its edge."""
        cell, across, along = bed
        (j, aside), (i, up) = _between(self.offset, offset), _between(self.flatness, flatness)
        cells = np.asarray(cell + (i * self.offset.size + j) * (self.damping.size * self.hardness.size))
        values = self.positions.ravel()[self._corners.reshape(2, 2, 2, 2, *(1,) * cells.ndim) + cells]
        for fraction in (across, along, aside, up):
            values = (1.0 - fraction) * values[0] + fraction * values[1]
        return np.asarray(values)

    @cached_property
    def _corners(self) -> IntArray:
        """Index offsets of the corners of a cell by hardness, damping, offset and flatness."""
        strides = np.array(self.positions.strides[:0:-1]) // self.positions.itemsize
        return np.tensordot(strides, np.indices((2, 2, 2, 2)), axes=1)

    @cached_property
    def _logarithms(self) -> tuple[FloatArray, FloatArray]:
        return each(math.log, self.hardness), each(math.log, self.damping)


def nodes() -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the nodes of the table."""
    return (
        # nodes are dense for squat bodies, because they almost stop on two points, where r is not smooth
        np.linspace(0.005, 0.45, 15)[:13],
        np.linspace(-1.0, 1.0, 5) / 3.0,
        # with light damping, the body hops; changes of the number of hops need finer nodes
        np.concatenate([np.geomspace(0.05, 1.0, 25)[:-1], np.geomspace(1.0, 5.0, 9)]),
        np.geomspace(*HARDNESS, 41),
    )


@lru_cache(maxsize=1)
def bed_table() -> BedTable:
    """Return the table of the package."""
    # `studies.impact_laboratory.tabulated` recomputes the table
    with files(__package__).joinpath("data", "contact_bed.npy").open("rb") as file:
        stored = np.load(file, allow_pickle=False)
    return BedTable(*nodes(), stored.astype(np.float64) * STEP)


def _between(
    axis: FloatArray, value: FloatArray | float
) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.intp]], FloatArray]:
    limited = np.minimum(np.maximum(value, axis[0]), axis[-1])
    low = np.searchsorted(axis[1:-1], limited, side="right")
    return low, np.asarray((limited - axis[low]) / (axis[low + 1] - axis[low]))
