"""Likelihood of measurements that were rounded before they were printed."""

import math
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.measurements import DataSet
from rocking.restitution.calibrated import scatter

_erfc = np.frompyfunc(math.erfc, 1, 1)


def interval_log_likelihood(low: FloatArray, high: FloatArray, mean: FloatArray, sd: FloatArray) -> FloatArray:
    """Return the logarithm of the probability of a normal value in the interval of rounding."""
    # ``ln(Phi((high - mean)/sd) - Phi((low - mean)/sd))`` in a form that is stable far in the tails; arrays broadcast
    from scipy.special import log_ndtr, ndtr

    a, b = (low - mean) / sd, (high - mean) / sd
    # if both ends are on one side of zero, the lower tail has full precision
    flip = a > 0.0
    a, b = np.where(flip, -b, a), np.where(flip, -a, b)
    probability = ndtr(b) - ndtr(a)  # Eq. 134
    deep = ~(probability > 1e-290)  # here the probability underflows, but not its logarithm
    if not deep.any():
        return np.log(probability)
    upper, lower = log_ndtr(b[deep]), log_ndtr(a[deep])
    logarithm = np.log(probability, where=~deep, out=np.empty_like(probability))
    logarithm[deep] = upper + np.log1p(-np.exp(np.minimum(lower - upper, -1e-300)))  # Eq. 134
    return logarithm


def normal_cdf(z: FloatArray) -> FloatArray:
    """Return the cumulative normal distribution, without the import time of scipy."""
    return 0.5 * np.asarray(_erfc(-math.sqrt(0.5) * z), dtype=np.float64)


def fit_scatter(data: DataSet, mean: FloatArray) -> tuple[float, float, float]:
    """Fit the parameters of `scatter` around predictions; return them and the logarithm of the largest likelihood."""
    from scipy.optimize import minimize

    def misfit(parameters: FloatArray) -> float:
        sd = scatter(mean, math.exp(parameters[0]), float(parameters[1]))
        return -float(interval_log_likelihood(data.low, data.high, mean, sd).sum())

    options: Any = {"xatol": 1e-8, "fatol": 1e-10}
    result = minimize(misfit, np.array([-2.3, 0.8]), method="Nelder-Mead", options=options)
    log_floor, slope = result.x.tolist()
    return math.exp(log_floor), slope, -float(result.fun)


def rounding_bic(data: DataSet, mean: FloatArray, parameters: int) -> float:
    """Return the BIC of the likelihood with rounding, -2 ln L + (parameters + 2) ln n; 2 for the scatter parameters."""
    return -2.0 * fit_scatter(data, mean)[2] + (parameters + 2) * math.log(len(data))  # Eq. 138
