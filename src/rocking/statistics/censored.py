"""Lognormal distribution of levels. Some levels may be censored, with a known lower bound only."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import log_ndtr, ndtr

from rocking import checks
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import InvalidValueError

_ROUNDS = 100
_LOG_OF_ROOT = 0.5 * math.log(2.0 * math.pi)


@dataclass(frozen=True)
class CensoredFit:
    """Median and dispersion of levels."""

    median: float  # median [unit of the levels]
    dispersion: float  # standard deviation of the natural logarithm [-]
    crossings: int  # crossings, censored: numbers of exact levels, and of levels above a limit
    censored: int
    method: str  # method of the fit, as text

    def probability(self, level: Any) -> FloatArray:
        """Return the probability of levels below a level > 0 [-]. For zero dispersion, this is a step."""
        logs = np.log(checks.positive_array("level", level)) - math.log(self.median)
        return np.asarray(ndtr(logs / self.dispersion)) if self.dispersion else np.asarray(1.0 * (logs >= 0.0))

    def summary(self) -> dict[str, Any]:
        """Return the numbers and the method."""
        return dict(vars(self))


def fit_moments(levels: FloatArray) -> CensoredFit:
    """Return mean and standard deviation (n - 1) of the logarithms of at least two exact levels."""
    if np.size(levels) < 2:
        raise InvalidValueError("a dispersion needs at least 2 crossings, got {count}", count=np.size(levels))
    logs = np.log(checks.positive_array("levels", levels))
    return CensoredFit(
        float(np.exp(logs.mean())), float(logs.std(ddof=1)), int(logs.size), 0, "moments of the logarithms"
    )


def fit_censored(levels: FloatArray, censored: BoolArray) -> CensoredFit:
    """Return the maximum-likelihood lognormal fit to levels, some of which are lower bounds."""
    # the likelihood is concave in 1 / sigma and mu / sigma (Olsen 1978, Econometrica 46:1211); zero gradient proves the
    # maximum, and is verified
    logs = np.log(checks.positive_array("levels", levels))
    exact, bounds = logs[~censored], logs[censored]
    if exact.size < 2:
        raise InvalidValueError(
            "a dispersion needs at least 2 crossings, got {count} of {total} motions", count=exact.size, total=logs.size
        )
    centre, spread = float(exact.mean()), float(exact.std())
    if spread == 0.0 and not np.any(bounds > exact[0]):
        raise InvalidValueError("a dispersion needs different crossings, got {count} equal ones", count=exact.size)
    spread = spread or float(bounds.max() - exact[0])
    h, d = _maximum((exact - centre) / spread, (bounds - centre) / spread)
    median = math.exp(centre + spread * d / h)
    method = "maximum likelihood of the logarithms" + (", motions without a crossing censored" if bounds.size else "")
    return CensoredFit(median, spread / h, int(exact.size), int(bounds.size), method)


def fit_crossings(crossings: FloatArray, highest: float) -> CensoredFit | None:
    """Return the lognormal distribution of crossings. Infinite crossings are above the highest level.

    Parameters
    ----------
    crossings : ndarray
        Levels of the crossings [any unit]; infinite if above the highest level.
    highest : float
        Highest computed level [unit of the crossings].

    Returns
    -------
    CensoredFit or None
        Fit by moments if all crossings are finite, otherwise by maximum likelihood; None if the dispersion is
        undetermined.
    """
    crossed = np.isfinite(crossings)
    if crossed.sum() < 2:
        return None
    if crossed.all():
        return fit_moments(crossings)
    try:
        return fit_censored(np.where(crossed, crossings, highest), ~crossed)
    except InvalidValueError:
        return None


def _maximum(exact: FloatArray, bounds: FloatArray) -> tuple[float, float]:
    """Return h = 1 / sigma and d = mu / sigma by Newton's method with step halving."""
    at = np.array([1.0, float(exact.mean())])
    value = _likelihood(at, exact, bounds)
    for _ in range(_ROUNDS):
        gradient, hessian = _slopes(at, exact, bounds)
        if float(np.abs(gradient).max()) < 1e-10 * (exact.size + bounds.size):
            return float(at[0]), float(at[1])
        step = -np.linalg.solve(hessian, gradient)
        size = 1.0
        while size > 1e-12:
            trial = at + size * step
            if trial[0] > 0.0 and (trial_value := _likelihood(trial, exact, bounds)) >= value:
                at, value = trial, trial_value
                break
            size *= 0.5
        else:
            break
    gradient, _ = _slopes(at, exact, bounds)
    if float(np.abs(gradient).max()) < 1e-6 * (exact.size + bounds.size):
        return float(at[0]), float(at[1])
    raise InvalidValueError(
        "no lognormal distribution fits {count} known and {bounds} censored capacities",
        count=exact.size,
        bounds=bounds.size,
    )


def _likelihood(at: FloatArray, exact: FloatArray, bounds: FloatArray) -> float:
    h, d = at
    z = h * exact - d
    return float(exact.size * (math.log(h) - _LOG_OF_ROOT) - 0.5 * (z @ z) + log_ndtr(d - h * bounds).sum())  # Eq. 214


def _slopes(at: FloatArray, exact: FloatArray, bounds: FloatArray) -> tuple[FloatArray, FloatArray]:
    h, d = at
    z, w = h * exact - d, d - h * bounds
    # hazard phi / Phi, without overflow in the tail
    hazard = np.exp(-0.5 * w * w - _LOG_OF_ROOT - log_ndtr(w))
    bend = hazard * (w + hazard)
    gradient = np.array([exact.size / h - z @ exact - hazard @ bounds, z.sum() + hazard.sum()])  # Eq. 215
    cross = float(exact.sum() + bend @ bounds)
    hh = -exact.size / h**2 - exact @ exact - bend @ (bounds * bounds)
    return gradient, np.array([[hh, cross], [cross, -exact.size - bend.sum()]])
