"""How r converges with the number of contact points and with the step."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_impacts, setup_of
from rocking.studies.impact_laboratory.beds import Laboratory, coefficients


@dataclass(frozen=True, eq=False)
class Convergence:
    """A sequence of coefficients and the orders that it shows."""

    at: FloatArray  # contact intervals, or tolerances [-]
    coefficient: FloatArray  # r there [-]
    error: FloatArray  # distance from the limit [-]
    order: FloatArray  # between neighbours: power of the spacing with which the error falls [-]
    limit: float  # r it tends to: extrapolated, or of the finest step [-]


def points_convergence(
    counts: Sequence[int] = (11, 21, 41, 81, 161), *, slenderness: float = 2.0, limit: float | None = None
) -> Convergence:
    """Return the convergence of the viscous bed with its points.

    Dashpots without springs absorb an impact in one contact: no hop hides the order.

    counts: contact points, three of them or more, each with twice the intervals of the one before [-]; slenderness: h/b
    of the block [-]; limit: the exact r; by default extrapolated from the last two with order 2 [-]. Returns the order
    is near 2 for half shares at the ends.

    >>> points_convergence((21, 41, 81)).order.round(0).tolist()
    [2.0, 2.0]
    """
    intervals = np.array(counts, dtype=np.float64) - 1.0
    if intervals.size < 3 or not bool((intervals[1:] == 2.0 * intervals[:-1]).all()):
        raise InvalidValueError(f"counts must be three or more with doubled intervals: 11, 21, 41; got {counts}")
    block = Laboratory(slenderness=slenderness).block
    law = KelvinVoigt(0.0, damping=1e12 * block.mass)
    r = bed_impacts(
        [setup_of(block, ContactBed.uniform(block, n, law), angular_velocity=0.5, impulsive=True) for n in counts]
    ).coefficient
    end = float(r[-1] + (r[-1] - r[-2]) / 3.0) if limit is None else checks.number("limit", limit)
    return _converged(intervals, r, end, np.full(intervals.size - 1, 2.0))


def step_convergence(tolerances: Any = (1e-4, 1e-5, 1e-6, 1e-7), laboratory: Laboratory | None = None) -> Convergence:
    """Return the convergence of r with the tolerance of a step.

    tolerances: falling, above 1e-11 [-]. Returns against a tolerance of 1e-12; the order is a power of the tolerance.
    """
    row = np.atleast_1d(checks.positive_array("tolerances", tolerances))
    start = laboratory or Laboratory()
    r = coefficients(start.but(tolerance=float(tolerance)) for tolerance in (*row, 1e-12))
    return _converged(row, r[:-1], float(r[-1]), row[:-1] / row[1:])


def _converged(at: FloatArray, r: FloatArray, limit: float, ratio: FloatArray) -> Convergence:
    error = np.abs(r - limit)
    with np.errstate(divide="ignore", invalid="ignore"):
        order = np.log(error[:-1] / error[1:]) / np.log(ratio)  # Eq. 132
    return Convergence(at, r, error, order, limit)
