"""Coefficients of the next impacts: a joint draw for both feet, and the scatter from impact to impact."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, Foot
from rocking.dynamics import RandomRestitution
from rocking.identification.posterior import Mixture
from rocking.restitution._implied import energy_bound

_DRAWS = 4096
_LEVELS = (np.arange(1025) + 0.5) / 1025.0  # probabilities of the quantiles of a law


@dataclass(frozen=True, eq=False)
class NextImpacts:
    """Joint distribution of the coefficients of both feet and of the scatter; all mixtures have one grid."""

    mean: Mixture  # mean of ln r of both feet
    half: Mixture  # half the difference of ln r, right minus left
    right: Mixture  # ln r of landings right, the sum of both
    scatter: FloatArray  # standard deviation of ln r from impact to impact, by node of the grid
    ln_bounds: dict[Foot, float]  # logarithm of the energy bound of each foot

    @classmethod
    def of(cls, mean: Mixture, half: Mixture, right: Mixture, scatter: FloatArray, body: Body | None) -> "NextImpacts":
        """Return the distribution, bounded by the energy bounds of a body; 1 for an unknown body."""
        bounds = {foot: 0.0 if body is None else math.log(energy_bound(body, foot)) for foot in FEET}
        return cls(mean, half, right, scatter, bounds)

    def law(self, seed: int) -> RandomRestitution:
        """Return a law with one draw of the coefficients of both feet, and with the scatter at each impact."""
        ln, scatter = self._draw(checks.whole("seed", seed, 0, 2**64 - 1))
        quantiles = {foot: np.exp(np.minimum(ln[foot] + scatter * ndtri(_LEVELS), math.log(10.0))) for foot in FEET}
        return RandomRestitution(quantiles, seed)  # Eq. 274

    def _draw(self, seed: int) -> tuple[dict[Foot, float], float]:
        """Return ln r by foot and the scatter: the first draw of a sample whose impacts create no energy."""
        random = np.random.default_rng(seed)
        node = random.choice(self.scatter.size, size=_DRAWS, p=self.mean.weights)
        first, second = random.standard_normal((2, _DRAWS))
        spread, across = self.mean.deviations, self.half.deviations
        covariance = 0.5 * (self.right.deviations**2 - spread**2 - across**2)
        slope = covariance / np.maximum(spread, 1e-300)
        remainder = np.sqrt(np.maximum(across**2 - slope**2, 0.0))
        mean = self.mean.means[node] + spread[node] * first
        half = self.half.means[node] + slope[node] * first + remainder[node] * second
        ln: dict[Foot, FloatArray] = {"right": mean + half, "left": mean - half}
        excess = np.maximum(ln["right"] - self.ln_bounds["right"], ln["left"] - self.ln_bounds["left"])
        chosen = int(np.argmin(np.maximum(excess, 0.0)))
        return {foot: float(ln[foot][chosen]) for foot in FEET}, float(self.scatter[node[chosen]])
