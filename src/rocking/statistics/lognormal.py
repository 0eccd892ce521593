"""Lognormal fragility by maximum likelihood: P(failure | im) = Phi(ln(im / median) / dispersion)."""

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
from scipy.special import ndtr, ndtri

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.statistics.bootstrap import (
    BootstrapSample,
    CapacitySample,
    Resampling,
    bootstrap,
    curve_probability,
    draw_capacities,
)
from rocking.statistics.counts import Counts, count_outcomes
from rocking.statistics.goodness import Goodness, goodness_of
from rocking.statistics.maximum_likelihood import (
    FittedCurves,
    LogScale,
    Separation,
    find_curves,
    log_dispersion,
    log_fractile,
    log_quantity,
    median_interval,
    quadratic_error,
    separation_of,
    standard_errors,
    verdict_of,
)
from rocking.statistics.probit import PenalisedProbit, Probit
from rocking.statistics.profiles import FractileConstraint, ProbabilityConstraint, Profile, SlopeConstraint, flat_line

Method = Literal["auto", "maximum-likelihood", "penalised"]
IntervalMethod = Literal["profile", "bootstrap", "wald"]
SIDES = np.array([-1.0, 1.0])
LARGEST_LOGARITHM = 690.0  # a larger logarithm gives no float64 median [-]


@dataclass(frozen=True, eq=False, repr=False)
class LognormalFit:
    """Lognormal fragility curve of outcomes, from `fit_lognormal`.

    If there is no curve, `median` and `dispersion` are None, and `verdict` contains the reason. Methods that need a
    curve then raise an error.

    Parameters
    ----------
    counts : Counts
        The outcomes.
    separation : Separation
        Arrangement of failures and survivals along the levels. The value is a sentence.
    method : {"maximum-likelihood", "penalised", "none"}
        Likelihood that was maximised; "none" if there is no curve.
    scale : LogScale, optional
        Scale of the coefficients; None if there is a single level.
    curves : FittedCurves, optional
        The curve; None if there is none.
    """

    counts: Counts
    separation: Separation
    method: str
    scale: LogScale | None = None
    curves: FittedCurves | None = None

    def __repr__(self) -> str:
        curve = "no curve" if self.curve is None else "median {:.4g}, dispersion {:.3g}".format(*self.curve)
        return f"<LognormalFit: {curve}, from {self.observations:g} outcomes>"

    @property
    def exists(self) -> bool:
        """True if a curve was fitted."""
        return self.curves is not None

    @property
    def curve(self) -> tuple[float, float] | None:
        """Median [unit of the levels] and dispersion [-]; None without a curve."""
        if self.curves is None or self.scale is None:
            return None
        return self.fractile(0.5), float(np.exp(log_dispersion(self.curves.theta, self.scale)[0]))

    @property
    def median(self) -> float | None:
        """Level with a probability of failure of 0.5 [unit of the levels]."""
        return None if self.curve is None else self.curve[0]

    @property
    def dispersion(self) -> float | None:
        """Dispersion beta, the standard deviation of the natural logarithm of the level at failure [-]."""
        return None if self.curve is None else self.curve[1]

    @property
    def log_likelihood(self) -> float | None:
        """Logarithm of the likelihood at the curve, without binomial coefficients and without penalty [-]."""
        if self.curves is None:
            return None
        return float(Probit(*self._data).derivatives(self.curves.theta).value[0])

    @property
    def observations(self) -> int:
        """Total number of trials [-]."""
        return self.counts.observations

    @property
    def median_interval(self) -> tuple[float | None, float | None]:
        """Largest survived level and smallest failed level, if the median is not unique [unit of the levels].

        After quasi-complete separation, both are the level with mixed outcomes, which is a limit of the likelihood, not
        a certainty. A missing bound is None. Both are None for a unique median, or if there is no rising curve.
        """
        return median_interval(self.counts, self.separation)

    @property
    def covariance(self) -> FloatArray | None:
        """Covariance of (ln median, dispersion), from the observed information [-]."""
        if self.curves is None or self.scale is None:
            return None
        a, b = self.curves.theta[0]
        turn = self.scale.spread * np.array([[-1.0 / b, a / b**2], [0.0, -1.0 / b**2]])
        return np.asarray(turn @ np.linalg.inv(self.curves.curvature[0]) @ turn.T)  # Eq. 207

    @property
    def standard_errors(self) -> dict[str, float] | None:
        """Standard errors of `median` [unit of the levels] and `dispersion` [-], by the delta method."""
        if self.covariance is None:
            return None
        errors = np.sqrt(np.diag(self.covariance))
        return {"median": float(self.fractile(0.5) * errors[0]), "dispersion": float(errors[1])}

    @cached_property
    def verdict(self) -> str:
        """Conclusions as sentences. Levels are numbers without a unit."""
        return self.verdict_in("")

    def verdict_in(self, unit: str, size: float = 1.0, *, clusters: bool = True) -> str:
        """Return the verdict with levels in a unit.

        Parameters
        ----------
        unit : str
            Name of the unit in the text; empty for no unit.
        size : float
            Size of the unit of the levels in this unit [-].
        clusters : bool
            True to include the sentence about outcomes of one cluster.

        Returns
        -------
        str
            Conclusions as sentences.
        """
        rise = None
        if self.curves is not None and self.method == "maximum-likelihood":
            rise = float(2.0 * (self.curves.value - flat_line(self._model)[1])[0])  # Eq. 205

        def level(value: float, digits: int = 6) -> str:
            return f"{value * size:.{digits}g} {unit}".rstrip()

        return verdict_of(self.counts, self.separation, self.curve, rise, level, clusters=clusters)

    @property
    def interval_method(self) -> IntervalMethod:
        """Default method of intervals.

        If a cluster has more than one outcome, the method is the bootstrap of entire clusters, because the likelihood
        assumes independent outcomes. Otherwise, and if there are too few clusters (see `verdict`), the method is the
        profile likelihood.
        """
        return "bootstrap" if self.counts.is_clustered and not self.counts.scarcity else "profile"

    @property
    def _fitted(self) -> tuple[LogScale, FittedCurves]:
        """The curve and its scale. Raises an error if there is no curve."""
        if self.curves is None or self.scale is None:
            raise InvalidValueError("a fragility curve is needed, got none: {verdict}", verdict=self.verdict)
        return self.scale, self.curves

    @property
    def _data(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        position = self._fitted[0].position(self.counts.levels)
        return position[None], self.counts.failures[None], self.counts.survivals[None]

    @cached_property
    def _model(self) -> Probit:
        """The likelihood that was maximised."""
        return (PenalisedProbit if self._fitted[1].penalised[0] else Probit)(*self._data)

    def probability(self, im: Any) -> FloatArray:
        """Return the probability of failure.

        Parameters
        ----------
        im : array_like
            Levels of the intensity measure, >= 0 [unit of the levels].

        Returns
        -------
        ndarray
            Probabilities, of the same shape [-].
        """
        scale, curves = self._fitted
        levels, positive = levels_of(im)
        result = np.zeros_like(levels)
        result[positive] = curve_probability(curves, scale, levels[positive])
        return result

    def fractile(self, probability: float) -> float:
        """Return the level with a given probability of failure.

        Parameters
        ----------
        probability : float
            Probability of failure, between 0 and 1, both excluded [-].

        Returns
        -------
        float
            The level [unit of the levels].
        """
        scale, curves = self._fitted
        level = float(_exp(log_fractile(curves.theta, scale, _variate(probability)))[0])
        if not 0.0 < level < np.inf:
            dispersion = float(np.exp(log_dispersion(curves.theta, scale)[0]))
            raise InvalidValueError(
                "fractile {probability:g} must be a float64, got {level}; the dispersion is {dispersion:.3g}",
                probability=probability, level=level, dispersion=dispersion,
            )  # fmt: skip
        return level

    def interval(
        self,
        parameter: str | float,
        level: float = 0.95,
        method: IntervalMethod | None = None,
        *,
        repetitions: int = 1000,
        seed: int = 0,
    ) -> tuple[float, float]:
        """Return a confidence interval.

        Parameters
        ----------
        parameter : {"median", "dispersion"} or float
            Parameter of the curve. A number is the probability of a fractile [-].
        level : float
            Confidence level, between 0 and 1 [-].
        method : {"profile", "bootstrap", "wald"}, optional
            Profile likelihood, default `bootstrap`, or standard errors on the logarithmic scale. Default:
            `interval_method`.
        repetitions, seed : int
            Number of repetitions of the bootstrap, and its seed.

        Returns
        -------
        tuple of float
            Both ends [unit of the levels, or - for the dispersion]. An open end is 0 or infinite.
        """
        used, sample = self._method_of(method, repetitions, seed)
        scale, curves = self._fitted
        quantile, variate = _quantile(level), _parameter(parameter)
        error = standard_errors(curves.theta, curves.curvature, scale, variate)[0]
        if sample is not None:
            ends = np.array(sample.log_interval(variate, level))
        elif used == "profile":
            ends = self._profile(variate, quantile, error)
        else:
            ends = log_quantity(curves.theta, scale, variate)[0] + SIDES * quantile * error  # Eq. 206
        low, high = _exp(ends)
        return float(low), float(high)

    def _profile(self, variate: float | None, quantile: float, error: float) -> FloatArray:
        scale, curves = self._fitted
        a, b = curves.theta[0]
        profile = Profile(self._model, curves.value, curves.theta, quantile)
        if variate is None:
            ends = profile.ends(SlopeConstraint(), np.full(2, np.log(b)), np.full(2, error), -SIDES)
            return np.asarray(np.log(scale.spread) - ends)
        fractile, start = FractileConstraint(np.full(2, variate)), np.full(2, (variate - a) / b)
        return scale.log_level(profile.ends(fractile, start, np.full(2, error / scale.spread), SIDES))

    def band(
        self,
        im: Any,
        level: float = 0.95,
        method: IntervalMethod | None = None,
        *,
        repetitions: int = 1000,
        seed: int = 0,
    ) -> tuple[FloatArray, FloatArray]:
        """Return pointwise confidence intervals of the probability of failure.

        Parameters
        ----------
        im : array_like
            Levels of the intensity measure, >= 0 [unit of the levels].
        level : float
            Confidence level, between 0 and 1 [-].
        method : {"profile", "bootstrap", "wald"}, optional
            See `interval`.
        repetitions, seed : int
            Number of repetitions of the bootstrap, and its seed.

        Returns
        -------
        tuple of ndarray
            Lower and upper ends, of the shape of `im` [-].
        """
        used, sample = self._method_of(method, repetitions, seed)
        scale, _ = self._fitted
        quantile, (levels, positive) = _quantile(level), levels_of(im)
        position = scale.position(levels[positive])
        ends = self._variates(position, quantile, used) if sample is None else sample.variate_band(position, level)
        result = np.zeros((2, *levels.shape))
        result[:, positive] = ndtr(np.stack(ends))
        return result[0], result[1]

    def _variates(self, position: FloatArray, quantile: float, method: str) -> tuple[FloatArray, FloatArray]:
        _, curves = self._fitted
        count = position.size
        middle = curves.theta[0, 0] + curves.theta[0, 1] * position
        slope = np.stack([np.ones_like(position), position], axis=1)
        error = quadratic_error(slope, np.broadcast_to(curves.curvature, (count, 2, 2)))
        if method != "profile" or not count:
            return middle - quantile * error, middle + quantile * error
        start = Profile(self._model, curves.value, curves.theta, quantile)
        constraint = ProbabilityConstraint(np.tile(position, 2))
        ends = start.ends(constraint, np.tile(middle, 2), np.tile(error, 2), np.repeat(SIDES, count))
        return ends[:count], ends[count:]

    def _method_of(
        self, method: IntervalMethod | None, repetitions: int, seed: int
    ) -> tuple[str, BootstrapSample | CapacitySample | None]:
        """Return the method of an interval, and the bootstrap that is common to all parameters."""
        used = self.interval_method if method is None else checks.one_of("method", method, get_args(IntervalMethod))
        if used != "bootstrap":
            return used, None
        key = checks.within("repetitions", repetitions, 1, 10**7), seed
        if key not in self._samples:
            self._samples[key] = self.bootstrap(repetitions=repetitions, seed=seed)
        return used, self._samples[key]

    @cached_property
    def _samples(self) -> dict[tuple[float, int], BootstrapSample | CapacitySample]:
        return {}

    def bootstrap(
        self, kind: Resampling | Literal["capacities"] | None = None, *, repetitions: int = 1000, seed: int = 0
    ) -> BootstrapSample | CapacitySample:
        """Return bootstrap samples of the fitted curve.

        Parameters
        ----------
        kind : {"parametric", "cases", "clusters", "capacities"}, optional
            Kind of resampling. Default: capacities from the curve for fewer than 30 clusters with one trial at every
            level, entire clusters for other named clusters, otherwise parametric.
        repetitions, seed : int
            Number of repetitions and random seed.

        Returns
        -------
        BootstrapSample or CapacitySample
            Sample with methods for intervals.

        Raises
        ------
        InvalidValueError
            If the kind is unknown, or if the outcomes do not fit the kind.
        """
        (scale, curves), counts = self._fitted, self.counts
        if kind == "capacities" or (kind is None and counts.draws_capacities):
            return draw_capacities(counts, curves, scale, repetitions, seed)
        default: Resampling = "parametric" if counts.cluster_trials is None else "clusters"
        return bootstrap(counts, curves, scale, kind or default, repetitions, seed)

    def goodness(self, *, groups: int = 10, repetitions: int = 1000, seed: int = 0) -> Goodness:
        """Return the goodness of fit of the curve.

        Parameters
        ----------
        groups : int
            Largest number of groups of neighbouring levels.
        repetitions, seed : int
            Number of data sets simulated with the curve and refitted, and the random seed.

        Returns
        -------
        Goodness
            Statistics with p-values, and observed and expected failures.
        """
        scale, curves = self._fitted
        return goodness_of(self.counts, curves, scale, groups, repetitions, seed)

    def summary(self) -> dict[str, Any]:
        """Return the fit as plain values.

        Returns
        -------
        dict
            Values for JSON: None for missing values and open ends.
        """
        ends = {name: self.interval(name) if self.exists else (0.0, np.inf) for name in ("median", "dispersion")}
        closed = {
            name: [low if low > 0.0 else None, high if np.isfinite(high) else None]
            for name, (low, high) in ends.items()
        }
        return {
            "median": self.median,
            "dispersion": self.dispersion,
            "median_95": closed["median"],
            "dispersion_95": closed["dispersion"],
            "interval_method": self.interval_method if self.exists else None,
            "standard_errors": self.standard_errors,
            "log_likelihood": self.log_likelihood,
            "method": self.method,
            "separation": self.separation.value,
            "median_interval": list(self.median_interval),
            "observations": self.observations,
            "failures": int(self.counts.failures.sum()),
            "levels": int(self.counts.levels.size),
            "verdict": self.verdict,
        }


def fit_lognormal(
    levels: Any,
    failures: Any,
    trials: Any = None,
    *,
    method: Method = "auto",
    clusters: Iterable[Hashable] | None = None,
) -> LognormalFit:
    """Fit a lognormal fragility curve to outcomes. If there is no curve, the verdict contains the reason.

    Parameters
    ----------
    levels : array_like
        Level of the intensity measure of each entry, in any order, > 0 [any unit].
    failures : array_like
        Number of failures of each entry; 0 or 1, or booleans, without `trials` [-].
    trials : array_like, optional
        Number of trials of each entry, at least 1; default 1 [-].
    method : {"auto", "maximum-likelihood", "penalised"}
        "auto" maximises the likelihood if a maximum exists, and Firth's penalised likelihood in case of a step.
    clusters : iterable, optional
        Name of the cluster of each entry, such as its record: outcomes of one cluster are not independent.

    Returns
    -------
    LognormalFit
        The fit. Check `exists` or read `verdict`.

    Raises
    ------
    InvalidValueError
        If a value is invalid, or if "maximum-likelihood" is requested and there is no maximum.

    Examples
    --------
    >>> fit = fit_lognormal([0.2, 0.4, 0.6, 0.8], failures=[1, 8, 14, 19], trials=[20, 20, 20, 20])
    >>> round(fit.median, 4), round(fit.dispersion, 4), fit.separation.name
    (0.4419, 0.4454, 'OVERLAP')
    >>> fit_lognormal([0.2, 0.4, 0.6, 0.8], [0, 0, 1, 1]).median_interval
    (0.4, 0.6)
    """
    return fit_counts(count_outcomes(levels, failures, trials, clusters), method)


def fit_counts(counts: Counts, method: Method = "auto") -> LognormalFit:
    """Return the lognormal curve of counted outcomes. The methods are those of `fit_lognormal`."""
    checked = checks.one_of("method", method, get_args(Method))
    separation = separation_of(counts)
    if checked == "maximum-likelihood" and separation is not Separation.OVERLAP:
        raise InvalidValueError(
            '{parameter} must not be "maximum-likelihood" for these outcomes, whose likelihood has no maximum among '
            "lognormal curves", parameter="method", value=checked, hint=separation.value,
        )  # fmt: skip
    if separation is not Separation.OVERLAP and not separation.step:
        return LognormalFit(counts, separation, "none")
    scale = LogScale.of(counts)
    curves = find_curves(
        counts.levels, scale, counts.failures[None], counts.trials[None], penalised=checked == "penalised"
    )
    if not curves.exists[0] and not curves.penalised[0]:
        raise InvalidValueError(
            "the maximum cannot be proven: failures and survivals overlap by rounding only. Round the levels."
        )
    if not curves.exists[0] or abs(float(log_fractile(curves.theta, scale, 0.0)[0])) > LARGEST_LOGARITHM:
        return LognormalFit(counts, separation, "none")
    used: str = "penalised" if curves.penalised[0] else "maximum-likelihood"
    return LognormalFit(counts, separation, used, scale, curves)


def lognormal_probability(level: FloatArray, median: float, dispersion: float) -> FloatArray:
    """Return the probability of failure [-] at levels >= 0 [unit of the median]. It is zero at level zero."""
    with np.errstate(divide="ignore"):
        return np.asarray(ndtr(np.log(level / median) / dispersion))  # Eq. 190


def difference_extremes(log_median: FloatArray, dispersion: FloatArray) -> FloatArray:
    """Return ln level of both extremes of the difference of two lognormal curves. A single extreme is repeated.

    >>> difference_extremes(np.zeros(2), np.array([0.5, 0.25])).round(4).tolist()
    [0.3399, -0.3399]
    """
    (m, n), (s, t) = log_median, dispersion
    # the densities are equal if ((u - m)/s)^2 - ((u - n)/t)^2 + 2 ln(s/t) = 0; here u is measured from m
    a, b = t**2 - s**2, s**2 * (n - m)
    c = -(s**2) * (n - m) ** 2 + 2.0 * (s * t) ** 2 * np.log(s / t)  # Eq. 189
    root = np.sqrt(np.maximum(b**2 - a * c, 0.0))
    q = -(b + np.where(b < 0.0, -root, root))
    with np.errstate(divide="ignore", invalid="ignore"):
        log_levels = m + np.array([np.where(a != 0.0, q / a, np.inf), np.where(q != 0.0, c / q, 0.0)])
    return np.asarray(np.where(np.isfinite(log_levels), log_levels, m))


def levels_of(im: Any) -> tuple[FloatArray, Any]:
    """Return finite levels >= 0, and True for those above zero."""
    levels = checks.real_array("im", im)
    if not (np.isfinite(levels) & (levels >= 0.0)).all():
        raise InvalidValueError("im must be finite and >= 0")
    return levels, levels > 0.0


def _parameter(parameter: str | float) -> float | None:
    """Return the variate of a fractile, or None for the dispersion."""
    if isinstance(parameter, str):
        if parameter not in {"median", "dispersion"}:
            raise InvalidValueError(
                parameter="parameter", allowed="'median', 'dispersion' or the probability of a fractile",
                value=parameter,
            )  # fmt: skip
        return 0.0 if parameter == "median" else None
    return _variate(parameter)


def _variate(probability: float) -> float:
    return float(ndtri(checks.within("probability", probability, 0.0, 1.0, open_low=True, open_high=True)))


def _quantile(level: float) -> float:
    return _variate(0.5 * (1.0 + checks.within("level", level, 0.0, 1.0, open_low=True, open_high=True)))


def _exp(logarithm: FloatArray) -> FloatArray:
    with np.errstate(over="ignore", under="ignore"):
        return np.asarray(np.exp(logarithm))
