"""Lyapunov exponents of harmonic rocking, with standard errors."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.studies.longrun.attractors import start_states
from rocking.studies.longrun.system import DEFAULTS, NONE, HarmonicRocking, Numerics, over_periods

ALIGNED = 60  # periods in which tangent vectors align before growth is counted
MOST_DRAWS = 2**16  # random states for small basins of attraction, at least 16 per orbit


@dataclass(frozen=True, eq=False)
class LyapunovExponents:
    """Lyapunov exponents of one system from several orbits.

    Parameters
    ----------
    system : HarmonicRocking
        Body and ground motion.
    by_orbit : ndarray
        Both exponents of each orbit [1/s], shape (orbits, 2); minus infinity for an orbit that comes to rest again and
        again, NaN for one that overturns.
    impact_rate : ndarray
        Impacts per second of each orbit, shape (orbits,).
    duration : float
        Time over which growth was counted [s].
    """

    system: HarmonicRocking
    by_orbit: FloatArray
    impact_rate: FloatArray
    duration: float

    @property
    def overturned(self) -> int:
        """Number of orbits that overturn."""
        return int(np.isnan(self.by_orbit[:, 0]).sum())

    @property
    def sticking(self) -> int:
        """Number of orbits that come to rest: a rest erases all differences, the exponents are minus infinity."""
        return int(np.isneginf(self.by_orbit[:, 0]).sum())

    @property
    def finite(self) -> FloatArray:
        """Exponents of the other orbits [1/s], shape (orbits, 2)."""
        return self.by_orbit[np.isfinite(self.by_orbit).all(axis=1)]

    @property
    def values(self) -> FloatArray:
        """Mean exponents [1/s], the largest first, shape (2,); NaN if no orbit has finite ones."""
        return self.finite.mean(axis=0) if len(self.finite) else np.full(2, np.nan)

    @property
    def standard_errors(self) -> FloatArray:
        """Standard errors of the means [1/s], shape (2,); NaN for fewer than two orbits."""
        number = len(self.finite)
        return self.finite.std(axis=0, ddof=1) / math.sqrt(number) if number > 1 else np.full(2, np.nan)

    @property
    def sum_rule(self) -> FloatArray:
        """Sum of the exponents less 2 ln r times the impact rate [1/s]: zero for a symmetric body with a constant r."""
        # Eq. 337
        r = np.log(self.system.sides[2]) + np.log(self.system.sides[5])
        return np.asarray(self.by_orbit.sum(axis=1) - r * self.impact_rate)


def lyapunov_exponents(
    system: HarmonicRocking,
    *,
    starts: FloatArray | None = None,
    orbits: int = 64,
    settled: int = 1500,
    kept: int = 1500,
    seed: int = 0,
    numerics: Numerics = DEFAULTS,
) -> LyapunovExponents:
    """Return the exponents of orbits from times, rotations and velocities, shape (orbits, 3), or random states.

    Random states that overturn while tangent vectors align are replaced, with at most `MOST_DRAWS` states.
    """
    settled, kept = checks.whole("settled", settled, ALIGNED), checks.whole("kept", kept, 1)
    if starts is None:
        starts = _random_starts(system, checks.whole("orbits", orbits, 1), checks.whole("seed", seed), numerics)
    result = over_periods(system, starts, settled=settled, kept=kept, vectors=2, numerics=numerics)
    duration = kept * system.excitation.period
    exponents = result.growth / duration
    exponents[result.rests > 0] = -np.inf
    exponents[result.ending != NONE] = np.nan
    return LyapunovExponents(system, exponents, result.impacts / duration, duration)


def _random_starts(system: HarmonicRocking, orbits: int, seed: int, numerics: Numerics) -> FloatArray:
    """Return random states after an impact, first those that do not overturn while tangent vectors align."""
    generator, last = np.random.default_rng(seed), max(MOST_DRAWS, 16 * orbits)
    alive, lost, drawn = np.empty((0, 3)), np.empty((0, 3)), 0
    while len(alive) < orbits and drawn < last:
        starts = start_states(system, generator.random((16 * orbits, 2)) * [2.0 * math.pi, 1.0])
        remains = over_periods(system, starts, kept=ALIGNED, numerics=numerics).ending == NONE
        alive, lost = np.concatenate([alive, starts[remains]]), np.concatenate([lost, starts[~remains]])[:orbits]
        drawn += len(starts)
    return np.concatenate([alive, lost])[:orbits]
