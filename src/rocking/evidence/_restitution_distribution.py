"""Distribution of the coefficient of one body from the measurements, for sampling."""

import math
from collections.abc import Mapping
from dataclasses import astuple, dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks, plausibility
from rocking.bodies import Block, Body
from rocking.conventions import FEET, FloatArray, Foot, percent
from rocking.dynamics.impact_laws import RandomRestitution
from rocking.errors import InvalidValueError
from rocking.evidence.calibration import CALIBRATED_RANGE, Calibration
from rocking.evidence.hierarchy import calibrate_hierarchy
from rocking.messages import Range
from rocking.portable import trapezoid
from rocking.restitution import ImpactGeometry
from rocking.restitution._implied import energy_bound
from rocking.restitution.calibrated import scatter
from rocking.restitution.shifted_impulse import shifted

if TYPE_CHECKING:
    from rocking.studies.sensitivity.restitutions import SampledRestitution

_POINTS = 1025
_GRID = 2001
_STRIDE = 50  # stride of the points in the search for the used range of the grid
_ROUNDS = 3
_PIECE = 64


@dataclass(frozen=True, eq=False, repr=False)
class RestitutionDistribution:
    """Posterior predictive distribution of the coefficient of restitution of one body.

    The distribution contains the uncertainty of the parameters of the calibrated model and the scatter of bodies. Its
    condition is 0 <= r <= bound; the bound excludes a gain of energy. The truncated probability is stored.

    Parameters
    ----------
    tables : dict of str to ndarray
        Coefficients by foot, at equally spaced probabilities from 0 to 1; the end points are a quarter of a step
        inside [-].
    cut : dict of str to float
        Truncated probability outside [0, bound], by foot [-].
    bounds : dict of str to float
        Largest coefficient without a gain of energy, by landing foot [-].
    foot : {"left", "right"}
        Landing foot of mean, quantiles and samples.
    extrapolated : bool
        True if the slenderness is outside the measured range.
    """

    tables: Mapping[Foot, FloatArray]
    cut: Mapping[Foot, float]
    bounds: Mapping[Foot, float]
    foot: Foot
    extrapolated: bool

    def __repr__(self) -> str:
        cut = ", ".join(f"{foot}={percent(self.cut[foot])} outside [0, {self.bounds[foot]:.6g}]" for foot in FEET)
        return (
            f"RestitutionDistribution(foot={self.foot!r}, mean={self.mean:.4g}, "
            f"standard_deviation={self.standard_deviation:.2g}, cut off: {cut}, extrapolated={self.extrapolated})"
        )

    @property
    def quantiles(self) -> FloatArray:
        """Coefficients at equally spaced probabilities from 0 to 1 [-]."""
        return self.tables[self.foot]

    @property
    def mean(self) -> float:
        """Expected coefficient [-]."""
        return trapezoid(self.quantiles, 1.0 / (self.quantiles.size - 1))

    @property
    def standard_deviation(self) -> float:
        """Standard deviation [-]."""
        moved = (self.quantiles - self.mean) ** 2
        return float(np.sqrt(trapezoid(moved, 1.0 / (self.quantiles.size - 1))))

    def quantile(self, probability: Any, foot: Foot | None = None) -> FloatArray:
        """Return the quantiles of the coefficient.

        Parameters
        ----------
        probability : float or array_like
            Probabilities in [0, 1] [-].
        foot : {"left", "right"}, optional
            Landing foot; default: that of the distribution.

        Returns
        -------
        ndarray
            Coefficients with the same shape [-].

        Raises
        ------
        InvalidValueError
            If a probability is outside [0, 1].
        """
        p = checks.real_array("probability", probability)
        if not ((p >= 0.0) & (p <= 1.0)).all():
            raise InvalidValueError(parameter="probability", allowed=Range(0.0, 1.0), value=probability)
        table = self.tables[self.foot if foot is None else checks.foot("foot", foot)]
        return np.interp(p, np.linspace(0.0, 1.0, table.size), table)

    def sample(self, count: int, seed: int, foot: Foot | None = None) -> FloatArray:
        """Return sampled coefficients.

        Parameters
        ----------
        count : int
            Number of samples.
        seed : int
            Random seed; samples for both feet have equal probabilities.
        foot : {"left", "right"}, optional
            Landing foot; default: that of the distribution.

        Returns
        -------
        ndarray
            Coefficients [-].
        """
        return self.quantile(np.random.default_rng(seed).random(int(checks.within("count", count, 0, 1e9))), foot)

    def per_history(self, seed: int) -> "SampledRestitution":
        """Return a restitution with one sampled coefficient per history.

        Both feet have the same probability: a high coefficient on one foot means a high coefficient on the other foot.

        Parameters
        ----------
        seed : int
            Random seed.

        Returns
        -------
        SampledRestitution
            Restitution for `simulate`, maps, spectra and fragility analyses.
        """
        from rocking.studies.sensitivity.restitutions import SampledRestitution

        return SampledRestitution(dict(self.tables), seed, cut=(self.cut["left"], self.cut["right"]))

    def per_impact(self, seed: int) -> RandomRestitution:
        """Return a restitution with one sampled coefficient per impact.

        Parameters
        ----------
        seed : int
            Random seed.

        Returns
        -------
        RandomRestitution
            Restitution for `simulate`, maps, spectra and fragility analyses.
        """
        return RandomRestitution(dict(self.tables), seed, cut=(self.cut["left"], self.cut["right"]))


def restitution_distribution(
    body: Body | float, *, foot: Foot = "right", calibration: Calibration | None = None
) -> RestitutionDistribution:
    """Return the distribution of a body's coefficient of restitution from the calibrated model, on a new interface.

    Parameters
    ----------
    body : Body or float
        A body, or the slenderness ratio h/b of a rectangle [-].
    foot : {"left", "right"}
        Landing foot of the quantiles; laws of impact apply to both feet.
    calibration : Calibration, optional
        Posterior of the model; default: `calibrate_hierarchy` of the published measurements.

    Returns
    -------
    RestitutionDistribution
        Quantiles, and laws of impact from them.

    Raises
    ------
    InvalidValueError
        If the slenderness is not finite and above zero.

    Examples
    --------
    >>> distribution = restitution_distribution(4.0)
    >>> low, high = distribution.quantile([0.025, 0.975])
    >>> bool(low < distribution.mean < high)
    True
    """
    posterior = calibrate_hierarchy() if calibration is None else calibration
    known_body: Body = (
        body if isinstance(body, Body) else Block(width=1.0, height=checks.positive("slenderness_ratio", body))
    )
    checks.foot("foot", foot)
    low, high = CALIBRATED_RANGE
    outside = not all(low <= known_body.side(side).slenderness_ratio <= high for side in FEET)
    bounds = {side: energy_bound(known_body, side) for side in FEET}
    feet = (foot,) if known_body.is_symmetric else FEET
    geometries = {side: ImpactGeometry.of_body(known_body, side) for side in feet}
    truncated = {
        side: _truncated(posterior, tuple(map(float, astuple(geometries[side]))), bounds[side]) for side in feet
    }
    for side, (_, cut) in truncated.items():
        plausibility.warn(plausibility.of_truncation(cut, side, bounds[side]))
    both = {side: truncated.get(side, truncated[foot]) for side in FEET}
    tables, cuts = {side: both[side][0] for side in FEET}, {side: both[side][1] for side in FEET}
    return RestitutionDistribution(tables, cuts, bounds, foot, outside)


@lru_cache(maxsize=64)
def _truncated(posterior: Calibration, geometry: tuple[float, ...], bound: float) -> tuple[FloatArray, float]:
    """Return the quantiles under the condition 0 <= r <= bound, and the probability outside this range."""
    eta, k, s, gamma = posterior.samples.T
    mean = np.clip(eta * shifted(ImpactGeometry(*map(np.asarray, geometry)), k), 0.0, bound)
    sd = scatter(mean, s, gamma)
    low, high = _below(np.array([0.0, bound]), mean, sd).tolist()
    return np.clip(_quantiles(mean, sd, low, high), 0.0, bound), 1.0 - (high - low)


def _quantiles(mean: FloatArray, sd: FloatArray, low: float, high: float) -> FloatArray:
    """Return quantiles of an equal mixture of normals between two probabilities, from a grid and Newton iteration."""
    levels = np.linspace(0.0, 1.0, _POINTS)
    # the end levels are a quarter of a step inside, because the ends of a normal are infinite
    levels[[0, -1]] = 0.25 / _POINTS, 1.0 - 0.25 / _POINTS
    levels = low + (high - low) * levels
    grid = np.linspace((mean - 8.0 * sd).min(), (mean + 8.0 * sd).max(), _GRID)
    ends = np.searchsorted(_below(grid[::_STRIDE], mean, sd), levels[[0, -1]]) * _STRIDE
    used = grid[max(ends[0] - _STRIDE, 0) : ends[1] + 1]
    r = np.interp(levels, _below(used, mean, sd), used)
    step = grid[1] - grid[0]
    for _ in range(_ROUNDS):
        below, density = _below(r, mean, sd), _density(r, mean, sd)
        r = r - np.clip((below - levels) / np.maximum(density, 1e-300), -step, step)
    return np.maximum.accumulate(r)


def _below(at: FloatArray, mean: FloatArray, sd: FloatArray) -> FloatArray:
    """Return the cumulative distribution of the mixture, computed in pieces that fit into the cache."""
    from scipy.special import ndtr

    pieces = np.split(at, range(_PIECE, at.size, _PIECE))
    return np.concatenate([ndtr((piece[:, np.newaxis] - mean) / sd).mean(axis=1) for piece in pieces])  # Eq. 137


def _density(at: FloatArray, mean: FloatArray, sd: FloatArray) -> FloatArray:
    """Return the density of the mixture, computed in pieces that fit into the cache."""
    pieces = ((piece[:, np.newaxis] - mean) / sd for piece in np.split(at, range(_PIECE, at.size, _PIECE)))
    return np.concatenate([(np.exp(-0.5 * z**2) / sd).mean(axis=1) for z in pieces]) / math.sqrt(2.0 * math.pi)
