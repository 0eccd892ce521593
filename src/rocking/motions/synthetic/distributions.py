"""Bounded distributions of the parameters of synthetic motions."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class Distribution(ABC):
    """A distribution between two bounds, in the unit of the parameter. `str` returns a description."""

    low: float
    high: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "low", checks.number("low", self.low))
        object.__setattr__(self, "high", checks.number("high", self.high))
        if not self.low < self.high:
            raise InvalidValueError("low must be below high, got {low:g} and {high:g}", low=self.low, high=self.high)

    def cdf(self, value: FloatArray) -> FloatArray:
        """Return the cumulative distribution function: 0 at the lower bound, 1 at the upper bound [-]."""
        return np.asarray(self._cdf(np.clip(value, self.low, self.high)))

    def quantile(self, share: float) -> float:
        """Return the quantile of a probability from 0 to 1. Quantiles of uniform random numbers are samples."""
        share = checks.within("share", share, 0.0, 1.0, hint="not a percentage")
        return min(max(float(self._quantile(share)), self.low), self.high)

    @abstractmethod
    def _cdf(self, value: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _quantile(self, share: float) -> float: ...


class Uniform(Distribution):
    """A uniform distribution.

    Parameters
    ----------
    low, high : float
        Bounds, in the unit of the parameter.

    Examples
    --------
    >>> Uniform(2.0, 4.0).quantile(0.25), str(Uniform(2.0, 4.0))
    (2.5, 'uniform from 2 to 4')
    """

    def __str__(self) -> str:
        return f"uniform from {self.low:g} to {self.high:g}"

    def _cdf(self, value: FloatArray) -> FloatArray:
        return (value - self.low) / (self.high - self.low)

    def _quantile(self, share: float) -> float:
        return self.low + share * (self.high - self.low)


@dataclass(frozen=True)
class LogUniform(Distribution):
    """A distribution with a uniform logarithm.

    Parameters
    ----------
    low, high : float
        Bounds, above zero.

    Examples
    --------
    >>> round(LogUniform(1.0, 100.0).quantile(0.5), 12)
    10.0
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.positive("low", self.low)

    def __str__(self) -> str:
        return f"log-uniform from {self.low:g} to {self.high:g}"

    def _cdf(self, value: FloatArray) -> FloatArray:
        return np.asarray(np.log(value / self.low) / math.log(self.high / self.low))

    def _quantile(self, share: float) -> float:
        return self.low * math.exp(share * math.log(self.high / self.low))


@dataclass(frozen=True)
class Lognormal(Distribution):
    """A lognormal distribution truncated at two bounds.

    Parameters
    ----------
    low, high : float
        Bounds, above zero.
    median : float
        Median before truncation, between the bounds.
    deviation : float
        Standard deviation of the natural logarithm before truncation [-].

    Examples
    --------
    >>> round(Lognormal(1.0, 9.0, median=3.0, deviation=0.4).quantile(0.5), 12)
    3.0
    """

    median: float
    deviation: float

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.positive("low", self.low)
        checks.within("median", self.median, self.low, self.high)
        checks.positive("deviation", self.deviation)

    def __str__(self) -> str:
        cut = f"between {self.low:g} and {self.high:g}"
        return f"lognormal, median {self.median:g}, deviation of the logarithm {self.deviation:g}, {cut}"

    def _cdf(self, value: FloatArray) -> FloatArray:
        first, last = self._normal(np.array([self.low, self.high]))
        return np.asarray((self._normal(value) - first) / (last - first))

    def _normal(self, value: FloatArray) -> FloatArray:
        from scipy.special import ndtr

        return np.asarray(ndtr(np.log(value / self.median) / self.deviation))

    def _quantile(self, share: float) -> float:
        from scipy.special import ndtri

        first, last = self._normal(np.array([self.low, self.high]))
        return self.median * math.exp(self.deviation * float(ndtri(first + share * (last - first))))  # Eq. 178
