"""What the measurements say about the coefficient of one body, as a distribution to draw from."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body
from rocking.conventions import FloatArray, Foot, opposite
from rocking.dynamics.impact_law import RandomRestitution
from rocking.errors import AsymmetricBodyError, InvalidValueError
from rocking.evidence.calibration import CALIBRATED_RANGE, Calibration, calibrate
from rocking.evidence.likelihood import scatter
from rocking.restitution import ImpactGeometry
from rocking.restitution.shifted_impulse import shifted
from rocking.studies.sensitivity.sampled import SampledRestitution

_POINTS = 1025
_GRID = 2001
_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class RestitutionDistribution:
    """Posterior predictive distribution of the coefficient of restitution of one body.

    It holds both that the parameters of the calibrated model are not known exactly, and that bodies scatter about it.

    Parameters
    ----------
    quantiles : ndarray
        Coefficients at equally spaced probabilities from 0 to 1, the outermost a quarter of a step inside [-].
    symmetric : bool
        Whether landing on the other foot is the same.
    extrapolated : bool
        Whether the slenderness is outside what was measured.
    """

    quantiles: FloatArray
    symmetric: bool
    extrapolated: bool

    @property
    def mean(self) -> float:
        """Expected coefficient [-]."""
        return float(np.trapezoid(self.quantiles, dx=1.0 / (self.quantiles.size - 1)))

    @property
    def standard_deviation(self) -> float:
        """Standard deviation [-]."""
        moved = (self.quantiles - self.mean) ** 2
        return float(np.sqrt(np.trapezoid(moved, dx=1.0 / (self.quantiles.size - 1))))

    def quantile(self, probability: Any) -> FloatArray:
        """Return the coefficients that are not exceeded with given probabilities.

        Parameters
        ----------
        probability : float or array_like
            Probabilities in [0, 1] [-].

        Returns
        -------
        ndarray
            Coefficients, of the same shape [-].

        Raises
        ------
        InvalidValueError
            If a probability is outside [0, 1].
        """
        p = checks.real_array("probability", probability)
        if not ((p >= 0.0) & (p <= 1.0)).all():
            raise InvalidValueError(f"probability must be in [0, 1], got {probability!r:.60}")
        return np.interp(p, np.linspace(0.0, 1.0, self.quantiles.size), self.quantiles)

    def sample(self, count: int, seed: int) -> FloatArray:
        """Return coefficients drawn from the distribution.

        Parameters
        ----------
        count : int
            How many.
        seed : int
            Seed; the same one gives the same draws.

        Returns
        -------
        ndarray
            Coefficients [-].
        """
        return self.quantile(np.random.default_rng(seed).random(int(checks.within("count", count, 0, 1e9))))

    def per_history(self, seed: int) -> SampledRestitution:
        """Return the restitution of a body whose coefficient is not known: one draw for every history.

        Parameters
        ----------
        seed : int
            Seed of the draws.

        Returns
        -------
        SampledRestitution
            For `simulate`, maps, spectra and fragility analyses.

        Raises
        ------
        AsymmetricBodyError
            If the coefficient depends on the side.
        """
        return SampledRestitution(self._both_sides(), seed)

    def per_impact(self, seed: int) -> RandomRestitution:
        """Return the restitution of a body whose every impact is another draw.

        Parameters
        ----------
        seed : int
            Seed of the draws.

        Returns
        -------
        RandomRestitution
            For `simulate`, maps, spectra and fragility analyses.

        Raises
        ------
        AsymmetricBodyError
            If the coefficient depends on the side.
        """
        return RandomRestitution(self._both_sides(), seed)

    def _both_sides(self) -> FloatArray:
        if not self.symmetric:
            raise AsymmetricBodyError(
                "the distribution of the coefficient depends on the side of this body, and a draw serves both sides; "
                "take the quantiles of each side, or a body with equal sides"
            )
        return self.quantiles


def restitution_distribution(
    body: Body | float, *, onto: Foot = "right", calibration: Calibration | None = None
) -> RestitutionDistribution:
    """Return the distribution of a body's coefficient of restitution from the calibrated model.

    Parameters
    ----------
    body : Body or float
        A body, or the slenderness ratio h/b of a rectangle [-].
    onto : {"left", "right"}
        The foot on which it lands.
    calibration : Calibration, optional
        Posterior of the model; that of all measurements if not given.

    Returns
    -------
    RestitutionDistribution
        Quantiles, and laws of impact made of them.

    Raises
    ------
    InvalidValueError
        If the slenderness is not finite and above zero.

    Examples
    --------
    >>> found = restitution_distribution(4.0)
    >>> low, high = found.quantile([0.025, 0.975])
    >>> bool(low < found.mean < high)
    True
    """
    posterior = calibrate() if calibration is None else calibration
    known: Body = (
        body if isinstance(body, Body) else Block(width=1.0, height=checks.positive("slenderness_ratio", body))
    )
    old, new = known.side(opposite(checks.foot("onto", onto))), known.side(onto)
    bound = math.sqrt(old.moment_of_inertia / new.moment_of_inertia)
    eta, k, s, gamma = posterior.samples.T
    mean = np.clip(eta * shifted(ImpactGeometry.of_body(known, onto), k), 0.0, bound)
    quantiles = np.clip(_quantiles(mean, scatter(mean, s, gamma)), 0.0, bound)
    low, high = CALIBRATED_RANGE
    outside = not all(low <= side.slenderness_ratio <= high for side in (old, new))
    return RestitutionDistribution(quantiles, known.is_symmetric, outside)


def _quantiles(mean: FloatArray, sd: FloatArray) -> FloatArray:
    """Return the quantiles of an even mixture of normal distributions: read from a grid, then made exact by Newton."""
    levels = np.linspace(0.0, 1.0, _POINTS)
    # the normal's ends are infinite: the outermost levels stand a quarter of a step inside
    levels[[0, -1]] = 0.25 / _POINTS, 1.0 - 0.25 / _POINTS
    grid = np.linspace((mean - 8.0 * sd).min(), (mean + 8.0 * sd).max(), _GRID)
    r = np.interp(levels, _mixture(grid, mean, sd)[0], grid)
    step = grid[1] - grid[0]
    for _ in range(_ROUNDS):
        below, density = _mixture(r, mean, sd)
        r = r - np.clip((below - levels) / np.maximum(density, 1e-300), -step, step)
    return np.maximum.accumulate(r)


def _mixture(at: FloatArray, mean: FloatArray, sd: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return distribution and density of the mixture, in pieces that stay in the cache."""
    from scipy.special import ndtr

    below, density = np.empty_like(at), np.empty_like(at)
    for first in range(0, at.size, 64):
        part = slice(first, first + 64)
        z = (at[part, np.newaxis] - mean) / sd
        below[part] = ndtr(z).mean(axis=1)
        density[part] = (np.exp(-0.5 * z**2) / sd).mean(axis=1) / math.sqrt(2.0 * math.pi)
    return below, density
