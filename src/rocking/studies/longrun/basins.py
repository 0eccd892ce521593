"""Basins of harmonic rocking: which starts overturn, come to rest or keep rocking; stability, erosion and dimension."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import stats

from rocking import checks
from rocking.conventions import FloatArray
from rocking.studies.longrun.system import DEFAULTS, FAILED, OVERTURNED, REST, HarmonicRocking, Numerics, over_impacts

LOST, SMALL, SETTLED, FAILURE = range(4)
KINDS = ("overturned", "small", "settled", "failed")
"""Ends of the histories of a basin: a history is small once its speed after an impact is below a limit."""


@dataclass(frozen=True, eq=False)
class Basin:
    """Ends of histories over a grid of states after an impact.

    Parameters
    ----------
    phase : ndarray
        Phases of the ground motion at the first impact [rad], shape (phases,).
    speed : ndarray
        Speeds after the first impact over alpha p [-], shape (speeds,).
    kind : ndarray of int
        Index in `KINDS`, shape (phases, speeds).
    is_uncertain : ndarray of bool
        True where the kind changes with the step error of the integration, shape (phases, speeds).
    """

    phase: FloatArray
    speed: FloatArray
    kind: Any
    is_uncertain: Any

    @property
    def counts(self) -> dict[str, int]:
        """Number of cells of each kind."""
        return {name: int((self.kind == number).sum()) for number, name in enumerate(KINDS)}

    def stability(self, level: float = 0.95) -> tuple[float, float, float]:
        """Return the fraction of starts that do not overturn, with its interval for random starts.

        Parameters
        ----------
        level : float, optional
            Level of the interval (Clopper and Pearson) [-].

        Returns
        -------
        fraction, low, high : float
            Fraction and interval [-].
        """
        number, safe = self.kind.size, int((self.kind != LOST).sum())
        interval = stats.binomtest(safe, number).proportion_ci(level, method="exact")
        return safe / number, float(interval.low), float(interval.high)

    def box_dimension(self) -> float:
        """Return the box-counting dimension of the boundary between starts that overturn and others.

        Returns
        -------
        float
            Slope of the number of boxes that contain both over their size, between 1 and 2; NaN without a boundary.
        """
        lost = self.kind == LOST
        sizes, numbers = [], []
        size = 1
        while size <= min(lost.shape) // 8:
            rows, columns = (n // size * size for n in lost.shape)
            blocks = lost[:rows, :columns].reshape(rows // size, size, columns // size, size)
            mixed = blocks.any(axis=(1, 3)) & ~blocks.all(axis=(1, 3))
            if size == 1:  # a cell contains a boundary if a neighbour differs
                mixed = np.zeros_like(lost)
                mixed[:-1] |= lost[:-1] != lost[1:]
                mixed[:, :-1] |= lost[:, :-1] != lost[:, 1:]
            sizes.append(size)
            numbers.append(mixed.sum())
            size *= 2
        if len(sizes) < 3 or min(numbers) == 0:
            return math.nan
        return float(-np.polyfit(np.log(sizes), np.log(numbers), 1)[0])


def ends_of(
    system: HarmonicRocking,
    phase: Any,
    speed: Any,
    *,
    impacts: int = 120,
    small: float = 0.02,
    numerics: Numerics = DEFAULTS,
) -> Any:
    """Return the kinds (index in `KINDS`) of histories from phases and speeds over alpha p after an impact."""
    numerics = replace(numerics, rest_speed=small)
    flight = over_impacts(system, phase, speed, impacts, parameter="none", numerics=numerics)
    kind = np.where(flight.event == REST, SMALL, SETTLED)
    kind[flight.event == OVERTURNED] = LOST
    kind[flight.event == FAILED] = FAILURE
    return kind


def basin(
    system: HarmonicRocking,
    *,
    phases: int = 100,
    speeds: int = 100,
    highest: float = 2.0,
    impacts: int = 120,
    small: float = 0.02,
    check: bool = True,
    numerics: Numerics = DEFAULTS,
) -> Basin:
    """Return the basin over phase and speed after an impact; check: repeat it with another step error."""
    phase, speed = cells(phases, speeds, highest)
    x, y = (axis.ravel() for axis in np.meshgrid(phase, speed, indexing="ij"))
    kind, other = checked_ends(system, x, y, checks.whole("impacts", impacts, 1), small, numerics, check=check)
    return Basin(phase, speed, kind.reshape(phases, speeds), (kind != other).reshape(phases, speeds))


def cells(phases: int, speeds: int, highest: float) -> tuple[FloatArray, FloatArray]:
    """Return the phases [rad] and speeds over alpha p of the centres of cells."""
    phase = (np.arange(checks.whole("phases", phases, 1)) + 0.5) * 2.0 * math.pi / phases
    return phase, (np.arange(checks.whole("speeds", speeds, 1)) + 0.5) * checks.positive("highest", highest) / speeds


def checked_ends(
    system: HarmonicRocking, phase: Any, speed: Any, impacts: int, small: float, numerics: Numerics, *, check: bool
) -> Any:
    """Return the kinds of histories, and those with another step error, shape (2, rows)."""
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
        Upper end of the speeds over alpha p [-].
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
