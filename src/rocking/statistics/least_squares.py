"""Regression line of points, with the uncertainty of slope and scatter."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ndtr, stdtr

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError


@dataclass(frozen=True, eq=False)
class Regression:
    """A line y = intercept + slope x by least squares."""

    intercept: float  # intercept [unit of y] and slope [unit of y over unit of x] of the line
    slope: float
    scatter: float  # standard deviation of the residuals, with n - 2 degrees of freedom [unit of y]
    slope_error: float  # standard error of the slope [unit of the slope]
    determination: float  # R squared: fraction of the variance of y explained by the line [-]
    residuals: FloatArray  # residuals of the points [unit of y]

    @property
    def count(self) -> int:
        """Number of points."""
        return int(self.residuals.size)

    def at(self, x: Any) -> FloatArray:
        """Return the values of the line [unit of y] at x [unit of x]."""
        return np.asarray(self.intercept + self.slope * np.asarray(x, dtype=np.float64))

    def probability_above(self, y: float, x: Any) -> FloatArray:
        """Return the probability that a new point at x [unit of x] is above y [unit of y] [-]."""
        # for normal residuals; the uncertainty of the line is not included
        margin = self.at(x) - y
        if self.scatter == 0.0:
            return np.asarray(margin > 0.0, dtype=np.float64)
        return np.asarray(ndtr(margin / self.scatter))  # Eq. 220

    @property
    def p_value(self) -> float:
        """p-value of the slope: Student's t with n - 2 degrees of freedom."""
        if self.slope_error == 0.0:
            return 1.0 if self.slope == 0.0 else 0.0
        return float(2.0 * stdtr(self.count - 2, -abs(self.slope) / self.slope_error))  # Eq. 219

    def summary(self) -> dict[str, Any]:
        """Return the line as plain values, with the p-value of the slope and the number of points."""
        names = ("intercept", "slope", "scatter", "slope_error", "determination", "p_value", "count")
        return {name: getattr(self, name) for name in names}


def regression(x: FloatArray, y: FloatArray) -> Regression:
    """Return the line of least squares.

    Parameters
    ----------
    x, y : ndarray
        At least three points with different x [any units].

    Returns
    -------
    Regression
        The line.

    Examples
    --------
    >>> line = regression(np.array([0.0, 1.0, 2.0]), np.array([1.0, 3.0, 5.0]))
    >>> line.slope, line.intercept, line.scatter
    (2.0, 1.0, 0.0)
    """
    count = int(np.size(x))
    if count < 3 or np.shape(x) != np.shape(y):
        raise InvalidValueError(
            "a line needs at least 3 points, got {count}", count=count,
            hint="Too few histories rocked clearly without overturning.",
        )  # fmt: skip
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise InvalidValueError("points of a line must be finite, got NaN or infinity")
    dx, dy = x - x.mean(), y - y.mean()
    spread, total = float(dx @ dx), float(dy @ dy)
    if not spread > (1e-12 * max(1.0, float(np.abs(x).max()))) ** 2 * count:
        raise InvalidValueError(
            "a line needs points with different x, got {count} at {position:g}", count=count,
            position=float(x.mean()),
        )  # fmt: skip
    slope = float(dx @ dy) / spread  # Eq. 218
    residuals = dy - slope * dx
    left = float(residuals @ residuals)
    scatter = math.sqrt(left / (count - 2))  # Eq. 218
    explained = 1.0 - left / total if total > 0.0 else 0.0
    intercept = float(y.mean() - slope * x.mean())
    return Regression(intercept, slope, scatter, scatter / math.sqrt(spread), explained, residuals)
