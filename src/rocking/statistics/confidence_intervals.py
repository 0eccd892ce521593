"""A fitted curve read off: fractiles, probabilities, and how far the data let each of them move."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
from scipy.special import ndtr, ndtri

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.statistics.bootstrap import BootstrapSample, CapacitySample, curve_probability
from rocking.statistics.counts import Counts
from rocking.statistics.maximum_likelihood import (
    FittedCurves,
    LogScale,
    log_dispersion,
    log_fractile,
    quadratic_error,
    standard_errors,
)
from rocking.statistics.probit import PenalisedProbit, Probit
from rocking.statistics.profiles import FractileConstraint, ProbabilityConstraint, Profile, SlopeConstraint, flat_line

IntervalMethod = Literal["profile", "bootstrap", "wald"]
INTERVAL_METHODS: tuple[str, ...] = get_args(IntervalMethod)
SIDES = np.array([-1.0, 1.0])


@dataclass(frozen=True, eq=False)
class ConfidenceIntervals:
    """One fitted curve and the likelihood it is the maximum of."""

    counts: Counts  # the outcomes
    scale: LogScale  # scale of the coefficients
    curves: FittedCurves  # the curve: one row

    @cached_property
    def model(self) -> Probit:
        """The likelihood that was maximised."""
        return (PenalisedProbit if self.curves.penalised[0] else Probit)(*self._data)

    @property
    def _data(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        return self.scale.position(self.counts.levels)[None], self.counts.failures[None], self.counts.survivals[None]

    @property
    def dispersion(self) -> float:
        """Dispersion beta [-]."""
        return float(np.exp(log_dispersion(self.curves.theta, self.scale)[0]))

    @property
    def log_likelihood(self) -> float:
        """Log likelihood at the curve, without penalty [-]."""
        return float(Probit(*self._data).derivatives(self.curves.theta).value[0])

    @property
    def rise(self) -> float:
        """Likelihood ratio against a line that does not depend on the level, a chi-square of one degree [-]."""
        return float(2.0 * (self.curves.value - flat_line(self.model)[1])[0])  # Eq. 205

    @property
    def covariance(self) -> FloatArray:
        """Covariance of (ln median, dispersion) [-]."""
        a, b = self.curves.theta[0]
        turn = self.scale.spread * np.array([[-1.0 / b, a / b**2], [0.0, -1.0 / b**2]])
        return np.asarray(turn @ np.linalg.inv(self.curves.curvature[0]) @ turn.T)  # Eq. 207

    @property
    def standard_errors(self) -> dict[str, float]:
        """Standard errors of `median` [unit of the levels] and `dispersion` [-]."""
        errors = np.sqrt(np.diag(self.covariance))
        return {"median": float(self.fractile(0.5) * errors[0]), "dispersion": float(errors[1])}

    def fractile(self, probability: float) -> float:
        """Return the level at which a probability of failure is reached.

        probability: between 0 and 1, both excluded [-]. Returns the level [unit of the levels].
        """
        level = float(_exp(log_fractile(self.curves.theta, self.scale, _variate(probability)))[0])
        if not 0.0 < level < np.inf:
            raise InvalidValueError(
                f"fractile {probability:g} must be a float64, got {level}; the dispersion is {self.dispersion:.3g}"
            )
        return level

    def probability(self, im: Any) -> FloatArray:
        """Return the probability of failure.

        im: levels of the intensity measure, >= 0 [unit of the levels]. Returns probabilities, of the same shape [-].
        """
        given, some = levels_of(im)
        result = np.zeros_like(given)
        result[some] = curve_probability(self.curves, self.scale, given[some])
        return result

    def interval(
        self,
        parameter: str | float,
        level: float,
        method: str,
        sample: BootstrapSample | CapacitySample | None,
    ) -> tuple[float, float]:
        """Return a confidence interval.

        parameter: A number is the probability of a fractile [-]; level: confidence level [-]. Returns both ends [unit
        of the levels, or - for the dispersion]; 0 or infinite where open.
        """
        quantile, variate = _quantile(level), _parameter(parameter)
        if sample is not None:
            ends = np.array(sample.log_interval(variate, level))
        else:
            error = standard_errors(self.curves.theta, self.curves.curvature, self.scale, variate)[0]
            if variate is None:
                middle = log_dispersion(self.curves.theta, self.scale)[0]
            else:
                middle = log_fractile(self.curves.theta, self.scale, variate)[0]
            ends = middle + SIDES * quantile * error  # Eq. 206
            if method == "profile":
                ends = self._profile(variate, quantile, error)
        low, high = _exp(ends)
        return float(low), float(high)

    def _profile(self, variate: float | None, quantile: float, error: float) -> FloatArray:
        a, b = self.curves.theta[0]
        profile = Profile(self.model, self.curves.value, self.curves.theta, quantile)
        if variate is None:
            ends = profile.ends(SlopeConstraint(), np.full(2, np.log(b)), np.full(2, error), -SIDES)
            return np.asarray(np.log(self.scale.spread) - ends)
        start = np.full(2, (variate - a) / b)
        ends = profile.ends(
            FractileConstraint(np.full(2, variate)), start, np.full(2, error / self.scale.spread), SIDES
        )
        return self.scale.log_level(ends)

    def band(
        self, im: Any, level: float, method: str, sample: BootstrapSample | CapacitySample | None
    ) -> tuple[FloatArray, FloatArray]:
        """Return pointwise confidence intervals of the probability of failure.

        im: levels of the intensity measure, >= 0 [unit of the levels]; level: confidence level [-]. Returns lower and
        upper ends, of the shape of `im` [-].
        """
        quantile, (given, some) = _quantile(level), levels_of(im)
        position = self.scale.position(given[some])
        if sample is not None:
            ends = sample.variate_band(position, level)
        else:
            ends = self._variates(position, quantile, profile=method == "profile")
        result = np.zeros((2, *given.shape))
        result[:, some] = ndtr(np.stack(ends))
        return result[0], result[1]

    def _variates(self, position: FloatArray, quantile: float, *, profile: bool) -> tuple[FloatArray, FloatArray]:
        count = position.size
        middle = self.curves.theta[0, 0] + self.curves.theta[0, 1] * position
        slope = np.stack([np.ones_like(position), position], axis=1)
        error = quadratic_error(slope, np.broadcast_to(self.curves.curvature, (count, 2, 2)))
        if not profile or not count:
            return middle - quantile * error, middle + quantile * error
        start = Profile(self.model, self.curves.value, self.curves.theta, quantile)
        both = ProbabilityConstraint(np.tile(position, 2))
        ends = start.ends(both, np.tile(middle, 2), np.tile(error, 2), np.repeat(SIDES, count))
        return ends[:count], ends[count:]


def _variate(probability: float) -> float:
    return float(ndtri(checks.within("probability", probability, 0.0, 1.0, open_low=True, open_high=True)))


def _parameter(parameter: str | float) -> float | None:
    """Return the variate of a fractile, or None for the dispersion."""
    if isinstance(parameter, str):
        if parameter not in {"median", "dispersion"}:
            raise InvalidValueError(
                f"parameter must be 'median', 'dispersion' or the probability of a fractile, got {parameter!r}"
            )
        return 0.0 if parameter == "median" else None
    return _variate(parameter)


def _quantile(level: float) -> float:
    return _variate(0.5 * (1.0 + checks.within("level", level, 0.0, 1.0, open_low=True, open_high=True)))


def levels_of(im: Any) -> tuple[FloatArray, Any]:
    """Return levels that are finite and >= 0, and which of them are above zero."""
    given = checks.real_array("im", im)
    if not (np.isfinite(given) & (given >= 0.0)).all():
        raise InvalidValueError("im must be finite and >= 0, got a value that is not")
    return given, given > 0.0


def _exp(logarithm: FloatArray) -> FloatArray:
    with np.errstate(over="ignore", under="ignore"):
        return np.asarray(np.exp(logarithm))
