"""Basins of harmonic rocking: which starts overturn, come to rest or keep rocking; stability, erosion and dimension."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import stats

from rocking import checks
from rocking.conventions import FloatArray
from rocking.studies.longrun.attractors import start_states
from rocking.studies.longrun.system import DEFAULTS, NONE, REST, HarmonicRocking, Numerics, over_impacts, over_periods

LOST, SMALL, SETTLED, FAILURE = range(4)
KINDS = ("overturned", "small", "settled", "failed")
"""Ends of the histories of a basin: a history is small once its speed after an impact is below a limit."""


def basin_stability(kinds: Any, level: float = 0.95) -> tuple[float, float, float]:
    """Return the fraction of initial states without overturning, with its interval for random initial states.

    Parameters
    ----------
    kinds : array_like of int
        Final states, as of `rocking.basin`: 0 for overturning.
    level : float, optional
        Level of the interval (Clopper and Pearson) [-].

    Returns
    -------
    fraction, low, high : float
        Fraction and interval [-].

    Examples
    --------
    >>> basin_stability([0, 2, 2, 1])[0]
    0.75
    """
    kinds = np.asarray(kinds)
    safe = int((kinds != LOST).sum())
    interval = stats.binomtest(safe, kinds.size).proportion_ci(level, method="exact")
    return safe / kinds.size, float(interval.low), float(interval.high)


def box_dimension(kinds: Any) -> float:
    """Return the box-counting dimension of the boundary between initial states with and without overturning.

    Parameters
    ----------
    kinds : array_like of int
        Final states, as of `rocking.basin`: 0 for overturning, shape (phases, speeds).

    Returns
    -------
    float
        Slope of the number of boxes with both final states against the box size, in logarithms, between 1 and 2. NaN
        without a boundary, or with fewer than 64 cells along an axis.

    Examples
    --------
    >>> import numpy as np
    >>> round(box_dimension(np.triu(np.ones((256, 256)))), 1)
    1.0
    """
    lost = np.asarray(kinds) == LOST
    sizes, numbers = 2 ** np.arange(1, (min(lost.shape) // 8).bit_length()), []
    for size in sizes.tolist():
        rows, columns = (n // size * size for n in lost.shape)
        boxes = lost[:rows, :columns].reshape(rows // size, size, columns // size, size)
        numbers.append(int((boxes.any(axis=(1, 3)) & ~boxes.all(axis=(1, 3))).sum()))
    if len(sizes) < 3 or min(numbers) == 0:
        return math.nan
    return float(-np.polyfit(np.log(sizes), np.log(numbers), 1)[0])


def ends_of(
    system: HarmonicRocking, phase: Any, speed: Any, *, impacts: int = 120, small: float = 0.02,
    numerics: Numerics = DEFAULTS,
) -> Any:  # fmt: skip
    """Return the kinds (index in `KINDS`) of histories from phases and speeds / (alpha p) after an impact.

    A speed of 0 is a start at rest; such a history is small if the body rests in the last of impacts / 2 periods.
    """
    phase, speed = np.broadcast_arrays(*np.atleast_1d(phase, speed))
    event, at_rest = np.full(phase.shape, NONE), speed == 0.0
    if not at_rest.all():
        options: Any = {"parameter": "none", "numerics": replace(numerics, rest_speed=small)}
        event[~at_rest] = over_impacts(system, phase[~at_rest], speed[~at_rest], impacts, **options).event
    if at_rest.any():
        starts = start_states(system, np.column_stack([phase, speed])[at_rest])
        result = over_periods(system, starts, settled=(impacts - 1) // 2, numerics=numerics)
        rests = (result.ending == NONE) & ((result.rests > 0) | (result.peak == 0.0))
        event[at_rest] = np.where(rests, REST, result.ending)
    return np.array([SETTLED, SETTLED, SMALL, LOST, FAILURE])[event]


def cells(phases: int, speeds: int, highest: float) -> tuple[FloatArray, FloatArray]:
    """Return the phases [rad] and speeds / (alpha p) of the centres of cells; 0 speeds: that of a start at rest."""
    phase = (np.arange(checks.whole("phases", phases, 1)) + 0.5) * 2.0 * math.pi / phases
    speed = (np.arange(checks.whole("speeds", speeds, 0)) + 0.5) * checks.positive("highest", highest) / max(speeds, 1)
    return phase, speed if speeds else np.zeros(1)


def checked_ends(
    system: HarmonicRocking, phase: Any, speed: Any, *, impacts: int = 120, small: float = 0.02,
    numerics: Numerics = DEFAULTS, check: bool = True,
) -> Any:  # fmt: skip
    """Return the final states, and the final states with 30 times the step error, shape (2, rows)."""
    steps = [numerics, replace(numerics, step_error=30.0 * numerics.step_error)][: 1 + check]
    kinds = [ends_of(system, phase, speed, impacts=impacts, small=small, numerics=step) for step in steps]
    return np.array([kinds[0], kinds[-1]])


@dataclass(frozen=True)
class UncertaintyExponent:
    """Uncertainty exponent of the boundary of overturning.

    Parameters
    ----------
    value, standard_error : float
        The exponent; the dimension of the boundary is 2 less the exponent. The error includes that all distances use
        the same starts.
    distance : ndarray
        Distances in phase [rad], shape (distances,).
    fraction : ndarray
        Fraction of starts for which a neighbour at this distance ends otherwise, shape (distances,).
    """

    value: float
    standard_error: float
    distance: FloatArray
    fraction: FloatArray


def uncertainty_exponent(
    system: HarmonicRocking,
    *,
    samples: int = 30000,
    distances: Any = None,
    highest: float = 2.0,
    impacts: int = 120,
    seed: int = 0,
    numerics: Numerics = DEFAULTS,
) -> UncertaintyExponent:
    """Return the uncertainty exponent of the basin boundary between overturning and non-overturning initial states.

    Parameters
    ----------
    system : HarmonicRocking
        Body and ground motion.
    samples : int, optional
        Number of random starts, uniform in phase and speed.
    distances : array_like, optional
        Distances of the neighbours in phase [rad]; 10^-4 to 10^-1.5 by default.
    highest : float, optional
        Upper end of the speeds / (alpha p) [-].
    impacts : int, optional
        Number of impacts that are followed.
    seed : int, optional
        Random seed of the starts.
    numerics : Numerics, optional
        Numerical settings.

    Returns
    -------
    UncertaintyExponent
        The exponent and the fractions from which it was fitted, weighted with their counts; NaN where no neighbour of
        one distance ends otherwise.

    References
    ----------
    Grebogi, McDonald, Ott and Yorke (1983), Phys. Lett. A 99:415-418.
    """
    distance = np.logspace(-4.0, -1.5, 6) if distances is None else checks.positive_array("distances", distances, "rad")
    draws = np.random.default_rng(checks.whole("seed", seed)).random((2, checks.whole("samples", samples, 2)))
    phase, speed = draws[0] * 2.0 * math.pi, draws[1] * highest

    def are_lost(phase: FloatArray) -> Any:
        return ends_of(system, phase, speed, impacts=impacts, numerics=numerics) == LOST

    is_lost = are_lost(phase)
    uncertain = np.array([(are_lost(phase - d) != is_lost) | (are_lost(phase + d) != is_lost) for d in distance])
    fraction = uncertain.mean(axis=1)
    if not fraction.all():
        return UncertaintyExponent(math.nan, math.nan, distance, fraction)
    weights = fraction / (1.0 - fraction)  # inverse variance of the logarithm of a binomial fraction, up to a factor
    x = np.log(distance) - np.average(np.log(distance), weights=weights)
    slopes = weights * x / float((weights * x * x).sum())  # Eq. 341
    by_start = (slopes / fraction) @ uncertain
    error = float(by_start.std(ddof=1)) / math.sqrt(samples)
    return UncertaintyExponent(float(slopes @ np.log(fraction)), error, distance, fraction)
