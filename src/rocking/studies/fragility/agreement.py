"""What goes with a curve into files: how well it agrees with the outcomes, and intervals from the bootstrap."""

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from rocking.studies.fragility.fit import LognormalFit

Ends = tuple[float | None, float | None]
"""Both ends of an interval; None where it is open."""

STATISTICS = {
    "deviance": "twice the log likelihood lost against a curve free at every level",
    "pearson": "sum over levels of squared differences over variances",
    "hosmer_lemeshow": "the same over groups of neighbouring levels",
    "kolmogorov": "largest distance between the share of failures in a group and the curve",
}
"""Statistics of the goodness of fit, and what they are."""

REPETITIONS, FEWEST = 1000, 99
"""Data sets that are drawn from a curve for its p-values, and how few will do."""

MOST_DRAWN = 2_000_000
"""Levels times data sets that are drawn for p-values without being asked for: seconds of work."""

MOST_REPEATED = 50_000_000
"""Levels times data sets of a bootstrap that are held at once: about a gigabyte."""

_NONE = (math.nan, math.nan)


@dataclass(frozen=True)
class Agreement:
    """Goodness of fit as plain numbers."""

    # value and p-value of each of `STATISTICS`; NaN where there is none [-]
    numbers: dict[str, tuple[float, float]] = field(default_factory=lambda: dict.fromkeys(STATISTICS, _NONE))
    words: str = ""  # what the p-values rest on, or why there is none


@dataclass(frozen=True, eq=False)
class Repeated:
    """Intervals from the study repeated many times."""

    # median_95, dispersion_95: ends of the 95 % intervals, None where one is open; None if there is no interval [as
    # median, dispersion]
    median_95: Ends | None = None
    dispersion_95: Ends | None = None
    # lower and upper ends of the 95 % intervals of the probability at the levels; None if there is none [-]
    band: tuple[FloatArray, FloatArray] | None = None
    words: str = ""  # how the study was repeated, or why there is none

    def band_at(self, size: int) -> FloatArray:
        """Return the band, filled with NaN where there is none.

        Returns lower and upper ends [-].
        """
        return np.full((2, size), math.nan) if self.band is None else np.stack(self.band)


def ends_of(interval: Ends | None) -> tuple[float, float]:
    """Return an interval as numbers.

    Returns NaN where an end is open, or there is no interval.

    >>> ends_of((0.5, None)), ends_of(None)
    ((0.5, nan), (nan, nan))
    """
    low, high = (math.nan if end is None else end for end in interval or (None, None))
    return low, high


def agreement_of(fit: "LognormalFit", seed: int = 0) -> Agreement:
    """Return how well a curve agrees with its outcomes, where the p-values cost little.

    Returns with 1000 data sets, fewer where there are many levels; without numbers where there are too many, or the
    data sets cannot be refitted.
    """
    levels = fit.counts.levels.size
    repetitions = min(REPETITIONS, MOST_DRAWN // levels)
    if repetitions < FEWEST:
        return Agreement(words=f"none: {levels} levels are too many to draw and refit; goodness() does it on request")
    try:
        found = fit.goodness(repetitions=repetitions, seed=seed)
    except InvalidValueError as error:
        return Agreement(words=f"none: {error}")
    words = f"p-values from {found.repetitions} data sets drawn from the curve and refitted, seed {seed}"
    if fit.counts.is_clustered:
        words += "; they take the outcomes of one motion for independent"
    return Agreement({name: tuple(getattr(found, name)) for name in STATISTICS}, words)


def repeated_of(fit: "LognormalFit", levels: FloatArray, repetitions: int, seed: int = 0) -> Repeated:
    """Return intervals of a curve from the bootstrap, as `LognormalFit.interval` and `LognormalFit.band` have them.

    levels: levels of the band [unit of the measure]. Returns without numbers where the clusters are too few to be drawn
    again, or the levels are too many.
    """
    held = repetitions * max(fit.counts.levels.size, levels.size)
    if held > MOST_REPEATED:
        size = fit.counts.levels.size
        return Repeated(words=f"none: {repetitions} repetitions at {size} levels take too much memory; take fewer")
    how: dict[str, Any] = {"repetitions": repetitions, "seed": seed}
    try:
        sample = fit.bootstrap(**how)
        ends = [fit.interval(name, 0.95, "bootstrap", **how) for name in ("median", "dispersion")]
        band = fit.band(levels, 0.95, "bootstrap", **how)
    except InvalidValueError as error:
        return Repeated(words=f"none: {error}")
    words = f"{sample.kind}, {sample.repetitions} repetitions, seed {seed}, {sample.ends} ends"
    if sample.undetermined:
        words += f"; {sample.undetermined} repetitions have no rising curve and widen the intervals"
    return Repeated(_closed(*ends[0]), _closed(*ends[1]), band, words)


def _closed(low: float, high: float) -> Ends:
    return (low if low > 0.0 else None), (high if math.isfinite(high) else None)
