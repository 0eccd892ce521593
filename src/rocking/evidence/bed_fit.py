"""The contact bed fitted to the measurements by maximum likelihood with the rounding of the printed digits."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.agreement import rmse
from rocking.evidence.bed_physics import Physics, explanations
from rocking.evidence.likelihood import interval_log_likelihood, scatter
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.restitution.bed_table import POINTS

_SCATTER = ((-2.3, 0.8), ((-6.0, 0.0), (0.0, 1.5)))
_FIRST, _POLISHED, _AGAIN = 300, 1500, 100


@dataclass(frozen=True, eq=False)
class BedFit:
    """One explanation at its most likely parameters."""

    physics: Physics  # the explanation
    points: int  # most likely number of contact points of those tabulated [-]
    values: dict[str, float]  # most likely parameters
    floor: float  # floor, slope: scatter around the prediction, as `likelihood.scatter` [-]
    slope: float
    log_likelihood: float  # of the printed digits
    bic: float  # -2 ln L + p ln n, p counting the parameters, the number of points and the two of the scatter
    rmse: float  # of r [-]
    predicted: FloatArray  # coefficients [-]

    @property
    def count(self) -> int:
        """Number of fitted parameters: of the bed, its points, and the scatter."""
        return len(self.values) + 3

    @property
    def at_a_limit(self) -> tuple[str, ...]:
        """Parameters that the fit has pushed to the end of their range."""
        pairs = zip(self.values.items(), self.physics.bounds, strict=True)
        return tuple(
            name for (name, value), (low, high) in pairs if min(value - low, high - value) < 2e-3 * (high - low)
        )


def fit_bed(physics: Physics, data: DataSet | None = None, *, points: Sequence[int] = POINTS) -> BedFit:
    """Fit one explanation.

    points: numbers of contact points that are tried [-].

    >>> from rocking.evidence.bed_physics import explanations
    >>> fit = fit_bed(explanations()[0], points=(11,))
    >>> fit.points, fit.rmse < 0.03
    (11, True)
    """
    rows = data or all_measurements()
    first = np.array([*physics.start, *_SCATTER[0]])
    tried = [(*_most_likely(physics, rows, n, first, _FIRST), n) for n in points]
    near, _, n = max(tried, key=lambda each: each[1])
    # a simplex that has collapsed at a bound is started once more
    near, _ = _most_likely(physics, rows, n, near, _POLISHED)
    found, log_likelihood = _most_likely(physics, rows, n, near, _POLISHED)
    mean = physics.predict(found[:-2], rows, n)
    count = len(physics.parameters) + 3
    return BedFit(
        physics, n, dict(zip(physics.parameters, found[:-2].tolist(), strict=True)),
        math.exp(found[-2]), float(found[-1]), log_likelihood,
        count * math.log(len(rows)) - 2.0 * log_likelihood, rmse(mean, rows.coefficient), mean,  # Eq. 138
    )  # fmt: skip


def bed_fits(data: DataSet | None = None) -> tuple[BedFit, ...]:
    """Fit every explanation."""
    return tuple(sorted((fit_bed(each, data) for each in explanations()), key=lambda fit: fit.bic))


def left_out(fit: BedFit, data: DataSet | None = None) -> FloatArray:
    """Return the logarithmic score of each measurement by a fit that has not seen it; the points are kept.

    Returns logarithms of the probability of the printed digits; their sum is comparable between explanations.
    """
    rows = data or all_measurements()
    start = np.array([*fit.values.values(), math.log(fit.floor), fit.slope])
    every = np.arange(len(rows))
    scores = np.empty(len(rows))
    for i in every.tolist():
        seen, unseen = rows.rows((every != i).tolist()), rows.rows([i])
        found, _ = _most_likely(fit.physics, seen, fit.points, start, _AGAIN)
        scores[i] = _log_likelihood(fit.physics, unseen, fit.points, found)
    return scores


def _log_likelihood(physics: Physics, data: DataSet, points: int, at: FloatArray) -> float:
    mean = physics.predict(at[:-2], data, points)
    sd = scatter(mean, math.exp(float(at[-2])), float(at[-1]))
    return float(interval_log_likelihood(data.low, data.high, mean, sd).sum())


def _most_likely(
    physics: Physics, data: DataSet, points: int, start: FloatArray, steps: int
) -> tuple[FloatArray, float]:
    from scipy.optimize import minimize

    limits = np.array([*physics.bounds, *_SCATTER[1]])
    low, span = limits[:, 0], limits[:, 1] - limits[:, 0]

    def inside(free: FloatArray) -> FloatArray:
        return np.asarray(low + span * np.clip(free, 0.0, 1.0))

    def misfit(free: Any) -> float:
        outside = np.abs(free - np.clip(free, 0.0, 1.0)).sum()
        return -_log_likelihood(physics, data, points, inside(free)) + 10.0 * float(outside)

    options: Any = {"xatol": 1e-5, "fatol": 1e-5, "maxfev": steps, "adaptive": True}
    found: Any = minimize(misfit, np.clip((start - low) / span, 0.02, 0.98), method="Nelder-Mead", options=options)
    best = inside(found.x)
    return best, _log_likelihood(physics, data, points, best)
