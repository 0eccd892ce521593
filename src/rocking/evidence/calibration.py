"""The calibrated default: an interface factor times the shifted impulse, inferred from the 39 measurements.

Model and priors are in docs/theory/evidence.md. The scatter grows with a power of the energy loss. On the 39
measurements, its BIC is 20 lower than that of a constant scatter (277 and 297), so the power is inferred too.
"""

import hashlib
import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot
from rocking.evidence.likelihood import fit_scatter, interval_log_likelihood, normal_cdf
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.restitution import ImpactGeometry, Interface, RestitutionModel, ShiftedImpulse, model, models
from rocking.restitution._implied import energy_bound
from rocking.restitution.calibrated import NAMES, kept, scatter
from rocking.restitution.shifted_impulse import shifted

CALIBRATED_RANGE = (1.5, 9.75)  # measured range of h/b; outside this range, an interval is an extrapolation
LEVEL = 0.95
KEPT = Path(__file__).parent / "data" / "calibration.npz"
"""Stored posterior and misfits of all models, written by `make calibration`; only for the published measurements."""

_ETA = np.linspace(0.9655, 0.9999, 32)
_K = np.linspace(0.30, 0.80, 26)
_LOG_S = np.linspace(math.log(0.02), math.log(0.60), 20)
_GAMMA = np.linspace(0.20, 1.50, 12)
_SAMPLES = 4000
FIELDS = ("samples", "marginals", "joint", "summary")


@dataclass(frozen=True, eq=False)
class Nodes:
    """The grid of a posterior."""

    eta: FloatArray  # interface factor [-]
    k: FloatArray  # position of the impulse [-]
    log_s: FloatArray  # logarithm of the scatter scale
    gamma: FloatArray  # exponent of the energy loss in the scatter model [-]


NODES = Nodes(_ETA, _K, _LOG_S, _GAMMA)


@dataclass(frozen=True, eq=False)
class PredictedCoefficient:
    """Coefficients of restitution with their intervals."""

    coefficient: FloatArray  # expected coefficient [-]
    low: FloatArray  # low, high: ends of the interval for a single measured body [-]
    high: FloatArray
    standard_deviation: FloatArray  # standard deviation for a single measured body [-]
    level: float = LEVEL  # probability of the interval [-]


@dataclass(frozen=True, eq=False)
class Calibration:
    """Posterior of the calibrated default.

    Parameters
    ----------
    samples : ndarray, shape (n, 4)
        Equally likely values of eta, k, s and gamma.
    marginals : dict of str to (ndarray, ndarray)
        Grid and posterior weight of each parameter.
    joint : ndarray
        Posterior weight on the grid of (eta, k).
    summary : dict of str to dict
        Mean, standard deviation and 95 % credible interval of each parameter.
    """

    samples: FloatArray
    marginals: dict[str, tuple[FloatArray, FloatArray]]
    joint: FloatArray
    summary: dict[str, dict[str, float]]

    @property
    def correlation(self) -> float:
        """Posterior correlation of eta and k [-]."""
        return float(np.corrcoef(self.samples[:, 0], self.samples[:, 1])[0, 1])

    def model(self) -> RestitutionModel:
        """Return the model at the posterior mean of eta and k.

        Returns
        -------
        RestitutionModel
            An interface factor around a shifted impulse.
        """
        facts = self.summary
        return Interface(ShiftedImpulse(k=facts["k"]["mean"]), eta=facts["eta"]["mean"])

    def predict(self, body: Body | Any, *, foot: Foot = "right") -> PredictedCoefficient:
        """Return the posterior predictive coefficient of a body, or of rectangles by slenderness.

        Parameters
        ----------
        body : Body or array_like
            A body, or slenderness ratios h/b [-].
        foot : {"left", "right"}
            Landing foot.

        Returns
        -------
        PredictedCoefficient
            Mean, 95 % interval for a single measured body, standard deviation; within [0, energy bound].

        Raises
        ------
        InvalidValueError
            If a slenderness is not finite and above zero.

        Examples
        --------
        >>> prediction = calibrate().predict([4.0])
        >>> bool(prediction.low[0] < 0.94 < prediction.high[0])
        True
        """
        if isinstance(body, Body):
            values, shape = self._predicted(*geometry_of(body, foot)), ()
        else:
            ratios = checks.positive_array("slenderness_ratio", body)
            values, shape = self._of_ratios(np.ascontiguousarray(ratios).tobytes()), ratios.shape
        mean, low, high, spread = (value.reshape(shape).copy() for value in values)
        return PredictedCoefficient(mean, low, high, spread)

    @lru_cache(maxsize=16)  # noqa: B019 - there is one calibration, and pictures use the same ratios several times
    def _of_ratios(self, ratios: bytes) -> tuple[FloatArray, ...]:
        return self._predicted(*geometry_of(np.frombuffer(ratios), "right"))

    def _predicted(self, geometry: ImpactGeometry, bound: FloatArray) -> tuple[FloatArray, ...]:
        samples, weight = self._distinct
        eta, k, s, gamma = samples.T[:, :, None]
        mean = np.clip(eta * shifted(geometry, k), 0.0, bound)
        sd = scatter(mean, s, gamma)
        low, high = (_quantile(mean, sd, weight, p) for p in (0.5 * (1.0 - LEVEL), 0.5 * (1.0 + LEVEL)))
        middle = (weight * mean).sum(axis=0)
        spread = np.sqrt((weight * (sd**2 + (mean - middle) ** 2)).sum(axis=0))
        return middle, np.clip(low, 0.0, bound), np.clip(high, 0.0, bound), spread

    @cached_property
    def _distinct(self) -> tuple[FloatArray, FloatArray]:
        """Distinct samples on the grid, and their fractions as a column."""
        samples, count = np.unique(self.samples, axis=0, return_counts=True)
        return samples, (count / count.sum())[:, None]

    def draw(self, count: int, seed: int) -> FloatArray:
        """Sample parameters from the posterior.

        Parameters
        ----------
        count : int
            Number of samples.
        seed : int
            Random seed.

        Returns
        -------
        ndarray, shape (count, 4)
            Columns eta, k, s, gamma.
        """
        rows = np.random.default_rng(seed).integers(len(self.samples), size=count)
        return np.asarray(self.samples[rows])


@lru_cache(maxsize=1)
def calibrate() -> Calibration:
    """Return the calibration on all 39 measurements.

    Returns
    -------
    Calibration
        Posterior on a fixed grid, without random numbers.

    Examples
    --------
    >>> facts = calibrate().summary
    >>> bool(0.97 < facts["eta"]["mean"] < 1.0), bool(0.4 < facts["k"]["mean"] < 0.7)
    (True, True)
    """
    data = all_measurements()
    stored = kept(KEPT)
    if stored["inputs"] != fingerprint(data):
        return calibrate_on(data)
    return Calibration(**{name: stored[name] for name in FIELDS})


def fingerprint(data: DataSet, *more: str) -> str:
    """Return the hash of the inputs of a posterior, such as measurements, grid and number of samples."""
    arrays = (data.slenderness, data.low, data.high, _ETA, _K, _LOG_S, _GAMMA)
    text = [[f"{value:.12g}" for value in values.tolist()] for values in arrays]
    return hashlib.sha256(repr((text, _SAMPLES, *more)).encode()).hexdigest()


def keep(path: Path) -> None:
    """Compute and write the stored values of `calibrate` and `interval_for`."""
    data = all_measurements()
    calibration = calibrate_on(data)
    named = [model(name) for name in models() if name not in ("calibrated", "fixed")]
    predictions = np.array([item.of_slenderness(data.slenderness) for item in named])
    arrays: dict[str, Any] = {
        "inputs": fingerprint(data),
        **arrays_of(calibration),
        "labels": [item.label for item in named],
        "predictions": predictions,
        "misfits": [fit_scatter(data, item)[:2] for item in predictions],
    }
    np.savez_compressed(path, **arrays)


def arrays_of(calibration: Calibration) -> dict[str, Any]:
    """Return a posterior as arrays for storage."""
    arrays: dict[str, Any] = {"samples": calibration.samples, "joint": calibration.joint}
    for name, (grid, weight) in calibration.marginals.items():
        arrays |= {f"{name}_grid": grid, f"{name}_weight": weight}
    return {**arrays, "summary": [list(facts.values()) for facts in calibration.summary.values()]}


def calibrate_on(data: DataSet) -> Calibration:
    """Return the calibration on given measurements."""
    grid = posterior_grid(data)
    return summarised(normalised(grid.log_prior + grid.terms.sum(axis=-1)))  # Eq. 136


@dataclass(frozen=True, eq=False)
class PosteriorGrid:
    """Terms of the posterior on the grid of (eta, k, s, gamma)."""

    log_prior: FloatArray  # logarithm of the prior; shape (a, b, 1, 1)
    terms: FloatArray  # logarithm of the likelihood of each row; shape (a, b, c, d, n)
    mean: FloatArray  # predicted coefficients [-]; shape (a, b, 1, 1, n)
    sd: FloatArray  # scatter of the coefficients [-]; shape (a, b, c, d, n)


def posterior_grid(data: DataSet) -> PosteriorGrid:
    """Return the likelihood of each row and the prior on the grid; rows can be omitted without a new evaluation."""
    base = shifted(ImpactGeometry.of_slenderness(data.slenderness), _K[:, None])
    mean = (_ETA[:, None, None] * base)[:, :, None, None, :]
    sd = np.exp(_LOG_S)[:, None, None] * scatter(mean, 1.0, 1.0) ** _GAMMA[:, None]
    terms = np.empty_like(sd)
    for i in range(len(_ETA)):
        terms[i] = interval_log_likelihood(data.low, data.high, mean[i], sd[i])
    return PosteriorGrid(log_prior(NODES), terms, mean, sd)


def log_prior(nodes: Nodes) -> FloatArray:
    """Return the logarithm of the prior on nodes, without its constant; shape (a, b, 1, 1)."""
    eta: FloatArray = 0.5 * np.log1p(-nodes.eta) + 97.5 * np.log(nodes.eta)  # Eq. 135
    k: FloatArray = -0.5 * ((nodes.k - 0.6) / 0.12) ** 2  # Eq. 135
    return eta[:, None, None, None] + k[None, :, None, None]


def marginal_quantiles(grid: FloatArray, weight: FloatArray, levels: tuple[float, ...]) -> list[float]:
    """Return quantiles of a marginal posterior at given probabilities [-], interpolated between grid nodes."""
    # the logarithm of the density is a cubic spline through the nodes, with an error of fourth order in their distance
    from scipy.interpolate import CubicSpline

    even = np.allclose(np.diff(grid, 2), 0.0, atol=1e-9 * abs(grid[-1]))
    axis = grid if even else np.log(grid)
    held = weight > 1e-200 * weight.max()
    fine = np.linspace(axis[held][0], axis[held][-1], 64 * grid.size + 1)
    density = np.exp(CubicSpline(axis[held], np.log(weight[held] / weight.max()))(fine))
    below = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    quantiles = np.interp(levels, below / below[-1], fine)
    return [float(value) for value in (quantiles if even else np.exp(quantiles))]


def normalised(log_weight: FloatArray) -> FloatArray:
    """Return weights that add up to 1."""
    weight = np.exp(log_weight - log_weight.max())
    return np.asarray(weight / weight.sum())  # Eq. 136


def geometry_of(body: Body | Any, foot: Foot) -> tuple[ImpactGeometry, FloatArray]:
    """Return the impact of a body, or of rectangles by slenderness [-], and the energy bound of r [-]."""
    if isinstance(body, Body):
        return ImpactGeometry.of_body(body, foot), np.array([energy_bound(body, foot)])
    ratios = np.atleast_1d(checks.positive_array("slenderness_ratio", body)).ravel()
    return ImpactGeometry.of_slenderness(ratios), np.ones(ratios.shape)


def summarised(weight: FloatArray, nodes: Nodes = NODES) -> Calibration:
    """Return the calibration from weights on nodes."""
    grids = (nodes.eta, nodes.k, np.exp(nodes.log_s), nodes.gamma)
    axes = range(weight.ndim)
    marginals = {
        name: (grid, weight.sum(axis=tuple(j for j in axes if j != i)))
        for i, (name, grid) in enumerate(zip(NAMES, grids, strict=True))
    }
    # systematic resampling gives equally likely points without random numbers
    steps = np.cumsum(weight.ravel())
    positions = np.searchsorted(steps, (np.arange(_SAMPLES) + 0.5) / _SAMPLES * steps[-1])
    indices = np.unravel_index(np.minimum(positions, steps.size - 1), weight.shape)
    samples = np.column_stack([grid[index] for grid, index in zip(grids, indices, strict=True)])
    summary = {name: _facts(*marginal) for name, marginal in marginals.items()}
    return Calibration(samples, marginals, weight.sum(axis=(2, 3)), summary)


def _facts(grid: FloatArray, weight: FloatArray) -> dict[str, float]:
    mean = float((grid * weight).sum())
    low, high = marginal_quantiles(grid, weight, (0.5 * (1.0 - LEVEL), 0.5 * (1.0 + LEVEL)))
    return {"mean": mean, "sd": math.sqrt(float(((grid - mean) ** 2 * weight).sum())), "low": low, "high": high}


def _quantile(mean: FloatArray, sd: FloatArray, weight: FloatArray, level: float) -> FloatArray:
    """Return a quantile of mixtures of normals, one per column, by bracketed Newton iteration; `weight` is a column."""
    low, high = (mean - 8.0 * sd).min(axis=0), (mean + 8.0 * sd).max(axis=0)
    value = (weight * mean).sum(axis=0)
    active = np.arange(value.size)  # columns that have not converged
    for _ in range(100):
        current, spread = value[active], sd[:, active]
        z = (current - mean[:, active]) / spread
        excess = (weight * normal_cdf(z)).sum(axis=0) - level  # Eq. 137
        low, high = np.where(excess < 0.0, current, low), np.where(excess < 0.0, high, current)
        slope = (weight * np.exp(-0.5 * z * z) / spread).sum(axis=0) / math.sqrt(2.0 * math.pi)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = excess / slope
        # near the root, rounding can give a step out of the bracket
        moved = ~(np.abs(step) < 1e-13)
        following = current - step
        inside = ~moved | ((following > low) & (following < high))
        value[active] = np.where(inside, following, 0.5 * (low + high))
        if not moved.any():
            break
        active, low, high = active[moved], low[moved], high[moved]
    return np.asarray(value)


@dataclass(frozen=True, slots=True)
class Coverage:
    """Numbers of omitted measurements inside their intervals."""

    rows: int  # number of measurements
    one_by_one: int  # number of measurements inside the interval of a calibration without this measurement
    # number inside and total number by data set, for a calibration without this data set
    by_group: dict[str, tuple[int, int]]

    @property
    def sentence(self) -> str:
        groups = ", ".join(
            f"{inside} of {count} of {'Table 1' if name == 'table1' else 'group ' + name}"
            for name, (inside, count) in self.by_group.items()
        )
        return (
            f"With one measurement left out, {self.one_by_one} of the {self.rows} measurements are inside their "
            f"{100.0 * LEVEL:.0f} % intervals. With one data set left out, {groups} are inside. If these fractions are "
            "too low, the interval is too narrow for a new laboratory or interface."
        )


def coverage(data: DataSet | None = None) -> Coverage:
    """Return the coverage of measurements that are omitted from a calibration."""
    # the posterior without some rows is the posterior divided by the likelihood of these rows, so one grid is enough
    data = all_measurements() if data is None else data
    grid = posterior_grid(data)
    log_posterior = grid.log_prior + grid.terms.sum(axis=-1)
    one_by_one = sum(_inside(data, grid, i, normalised(log_posterior - grid.terms[..., i])) for i in range(len(data)))
    groups = {}
    for name in dict.fromkeys(data.group):
        rows = [i for i, group in enumerate(data.group) if group == name]
        weight = normalised(log_posterior - grid.terms[..., rows].sum(axis=-1))
        groups[name] = sum(_inside(data, grid, i, weight) for i in rows), len(rows)
    return Coverage(len(data), one_by_one, groups)


def _inside(data: DataSet, grid: PosteriorGrid, row: int, weight: FloatArray) -> bool:
    from scipy.special import ndtr

    below = ndtr((data.coefficient[row] - grid.mean[..., row]) / grid.sd[..., row])
    share = float((weight * below).sum())
    return bool(0.5 * (1.0 - LEVEL) <= share <= 0.5 * (1.0 + LEVEL))
