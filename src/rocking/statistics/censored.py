"""Lognormal distribution of levels of which some are only known to lie above a limit."""

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
    crossings: int  # crossings, censored: levels that are known, and levels that are known to lie above a limit
    censored: int
    method: str  # how it was found, in words

    def probability(self, level: Any) -> FloatArray:
        """Return the share of levels below levels > 0 [their unit]; a step if the dispersion is zero [-]."""
        logs = np.log(checks.positive_array("level", level)) - math.log(self.median)
        return np.asarray(ndtr(logs / self.dispersion)) if self.dispersion else np.asarray(1.0 * (logs >= 0.0))

    def summary(self) -> dict[str, Any]:
        """Return the numbers and the method."""
        return dict(vars(self))


def fit_moments(levels: FloatArray) -> CensoredFit:
    """Return mean and standard deviation (n - 1) of the logarithms, of levels that are all known, at least two."""
    if np.size(levels) < 2:
        raise InvalidValueError("a dispersion needs at least 2 crossings, got {count}", count=np.size(levels))
    logs = np.log(checks.positive_array("levels", levels))
    return CensoredFit(
        float(np.exp(logs.mean())), float(logs.std(ddof=1)), int(logs.size), 0, "moments of the logarithms"
    )


def fit_censored(levels: FloatArray, censored: BoolArray) -> CensoredFit:
    """Return the lognormal fit of maximum likelihood to levels of which some only have a lower bound."""
    # with 1 / sigma and mu / sigma as parameters the likelihood is concave (Olsen 1978, Econometrica 46:1211), so that
    # a vanishing gradient proves the maximum; it is verified
    logs = np.log(checks.positive_array("levels", levels))
    known, bounds = logs[~censored], logs[censored]
    if known.size < 2:
        raise InvalidValueError(
            "a dispersion needs at least 2 crossings, got {count} of {total} motions", count=known.size, total=logs.size
        )
    centre, spread = float(known.mean()), float(known.std())
    if spread == 0.0 and not np.any(bounds > known[0]):
        raise InvalidValueError("a dispersion needs crossings that differ, got {count} equal ones", count=known.size)
    spread = spread or float(bounds.max() - known[0])
    h, d = _maximum((known - centre) / spread, (bounds - centre) / spread)
    median = math.exp(centre + spread * d / h)
    words = "maximum likelihood of the logarithms" + (", motions without a crossing censored" if bounds.size else "")
    return CensoredFit(median, spread / h, int(known.size), int(bounds.size), words)


def fit_crossings(crossings: FloatArray, highest: float) -> CensoredFit | None:
    """Return the lognormal distribution of crossings, of which infinite ones lie above the highest level.

    Parameters
    ----------
    crossings : ndarray
        Levels, infinite where there is none up to the highest [any unit].
    highest : float
        Highest level that was tried [unit of the crossings].

    Returns
    -------
    CensoredFit or None
        By moments if all are finite, else by maximum likelihood; None if the crossings tell no dispersion.
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


def _maximum(known: FloatArray, bounds: FloatArray) -> tuple[float, float]:
    """Return h = 1 / sigma and d = mu / sigma by Newton's method with halved steps."""
    at = np.array([1.0, float(known.mean())])
    value = _likelihood(at, known, bounds)
    for _ in range(_ROUNDS):
        gradient, hessian = _slopes(at, known, bounds)
        if float(np.abs(gradient).max()) < 1e-10 * (known.size + bounds.size):
            return float(at[0]), float(at[1])
        step = -np.linalg.solve(hessian, gradient)
        size = 1.0
        while size > 1e-12:
            trial = at + size * step
            if trial[0] > 0.0 and (found := _likelihood(trial, known, bounds)) >= value:
                at, value = trial, found
                break
            size *= 0.5
        else:
            break
    gradient, _ = _slopes(at, known, bounds)
    if float(np.abs(gradient).max()) < 1e-6 * (known.size + bounds.size):
        return float(at[0]), float(at[1])
    raise InvalidValueError(
        "no lognormal distribution fits {count} crossings and {bounds} bounds", count=known.size, bounds=bounds.size
    )


def _likelihood(at: FloatArray, known: FloatArray, bounds: FloatArray) -> float:
    h, d = at
    z = h * known - d
    return float(known.size * (math.log(h) - _LOG_OF_ROOT) - 0.5 * (z @ z) + log_ndtr(d - h * bounds).sum())  # Eq. 214


def _slopes(at: FloatArray, known: FloatArray, bounds: FloatArray) -> tuple[FloatArray, FloatArray]:
    h, d = at
    z, w = h * known - d, d - h * bounds
    # the hazard phi / Phi, without overflow in the tail
    hazard = np.exp(-0.5 * w * w - _LOG_OF_ROOT - log_ndtr(w))
    bend = hazard * (w + hazard)
    gradient = np.array([known.size / h - z @ known - hazard @ bounds, z.sum() + hazard.sum()])  # Eq. 215
    cross = float(known.sum() + bend @ bounds)
    hh = -known.size / h**2 - known @ known - bend @ (bounds * bounds)
    return gradient, np.array([[hh, cross], [cross, -known.size - bend.sum()]])
