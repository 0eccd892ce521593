"""Lognormal fragility by maximum likelihood: P(failure | im) = Phi(ln(im / median) / dispersion).

J. W. Baker, Efficient analytical fragility function fitting using dynamic structural analysis, Earthquake Spectra 31
(2015) 579-599, whose likelihood this maximises; inside, the curve is Phi(a + b ln im), in which it is concave.
"""

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
from scipy.special import ndtr

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.statistics.bootstrap import BootstrapSample, CapacitySample, Resampling, bootstrap, draw_capacities
from rocking.statistics.confidence_intervals import INTERVAL_METHODS, ConfidenceIntervals, IntervalMethod
from rocking.statistics.counts import Counts, count_outcomes
from rocking.statistics.goodness import Goodness, goodness_of
from rocking.statistics.maximum_likelihood import FittedCurves, LogScale, find_curves, log_fractile
from rocking.statistics.separation import Separation, median_interval, separation_of, verdict_of

Method = Literal["auto", "maximum-likelihood", "penalised"]
LARGEST_LOGARITHM = 690.0
"""Beyond this a median is no float64 [-]."""


@dataclass(frozen=True, eq=False)
class LognormalFit:
    """What outcomes say about a lognormal fragility curve; `fit_lognormal` makes one.

    Where no curve was fitted, `median` and `dispersion` are None, `verdict` says why, and what needs a curve raises.

    Parameters
    ----------
    counts : Counts
        The outcomes.
    separation : Separation
        How failures and survivals lie along the levels; its value is a sentence.
    method : {"maximum-likelihood", "penalised", "none"}
        What was maximised; "none" where there is no curve.
    scale : LogScale, optional
        Scale of the coefficients; None with a single level.
    curves : FittedCurves, optional
        The one curve; None where there is none.
    """

    counts: Counts
    separation: Separation
    method: str
    scale: LogScale | None = None
    curves: FittedCurves | None = None

    @property
    def exists(self) -> bool:
        """Whether a curve was fitted."""
        return self.curves is not None

    @property
    def median(self) -> float | None:
        """Level that half of the trials survive [unit of the levels]."""
        return self.intervals.fractile(0.5) if self.exists else None

    @property
    def dispersion(self) -> float | None:
        """Standard deviation of the natural logarithm of the level at failure, beta [-]."""
        return self.intervals.dispersion if self.exists else None

    @property
    def log_likelihood(self) -> float | None:
        """Logarithm of the likelihood at the curve, without binomial coefficients and without penalty [-]."""
        return self.intervals.log_likelihood if self.exists else None

    @property
    def observations(self) -> int:
        """Number of trials in all [-]."""
        return self.counts.observations

    @property
    def median_interval(self) -> tuple[float | None, float | None]:
        """Largest level survived and smallest failed, where no single median is likeliest [unit of the levels].

        After quasi-complete separation both are the level with mixed outcomes: the limit of the likelihood, not a
        certainty. None where the data bound nothing; both None where a median is likeliest, or no curve rises.
        """
        return median_interval(self.counts, self.separation)

    @property
    def covariance(self) -> FloatArray | None:
        """Covariance of (ln median, dispersion), from the observed information [-]."""
        return self.intervals.covariance if self.exists else None

    @property
    def standard_errors(self) -> dict[str, float] | None:
        """Standard errors of `median` [unit of the levels] and `dispersion` [-], by the delta method."""
        return self.intervals.standard_errors if self.exists else None

    @cached_property
    def verdict(self) -> str:
        """What can be claimed, in plain words."""
        median, dispersion = self.median, self.dispersion
        curve = None if median is None or dispersion is None else (median, dispersion)
        rise = self.intervals.rise if self.exists and self.method == "maximum-likelihood" else None
        return verdict_of(self.counts, self.separation, curve, rise)

    @property
    def interval_method(self) -> IntervalMethod:
        """How intervals are found unless another way is asked for.

        The bootstrap of whole clusters where a cluster has more than one outcome, since the likelihood takes them for
        independent; the profile likelihood elsewhere, and where the clusters are too few (`verdict` says so).
        """
        return "bootstrap" if self.counts.is_clustered and not self.counts.scarcity else "profile"

    @cached_property
    def intervals(self) -> ConfidenceIntervals:
        """What the curve's coefficients mean, and how far the data let them move.

        Raises
        ------
        InvalidValueError
            If no curve was fitted.
        """
        if self.curves is None or self.scale is None:
            raise InvalidValueError(f"a fragility curve is needed, got none: {self.verdict}")
        return ConfidenceIntervals(self.counts, self.scale, self.curves)

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
        return self.intervals.probability(im)

    def fractile(self, probability: float) -> float:
        """Return the level at which a probability of failure is reached.

        Parameters
        ----------
        probability : float
            Between 0 and 1, both excluded [-].

        Returns
        -------
        float
            The level [unit of the levels].
        """
        return self.intervals.fractile(probability)

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
            A number is the probability of a fractile [-].
        level : float
            Confidence level, between 0 and 1 [-].
        method : {"profile", "bootstrap", "wald"}, optional
            By the likelihood; by repeating the study as `bootstrap` does unless a kind is given; or from standard
            errors on the logarithmic scale. `interval_method`, if not given.
        repetitions : int
            Number of repetitions of the bootstrap.
        seed : int
            Seed of the bootstrap.

        Returns
        -------
        tuple of float
            Both ends [unit of the levels, or - for the dispersion]; 0 or infinite where the data leave it open.
        """
        used, sample = self._how(method, repetitions, seed)
        return self.intervals.interval(parameter, level, used, sample)

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
        repetitions : int
            Number of repetitions of the bootstrap.
        seed : int
            Seed of the bootstrap.

        Returns
        -------
        tuple of ndarray
            Lower and upper ends, of the shape of `im` [-].
        """
        used, sample = self._how(method, repetitions, seed)
        return self.intervals.band(im, level, used, sample)

    def _how(
        self, method: IntervalMethod | None, repetitions: int, seed: int
    ) -> tuple[str, BootstrapSample | CapacitySample | None]:
        """Return the method of an interval, and the bootstrap that it needs."""
        used = self.interval_method if method is None else checks.one_of("method", method, INTERVAL_METHODS)
        return used, self._sample(repetitions, seed) if used == "bootstrap" else None

    @cached_property
    def _samples(self) -> dict[tuple[float, int], BootstrapSample | CapacitySample]:
        return {}

    def _sample(self, repetitions: int, seed: int) -> BootstrapSample | CapacitySample:
        """Return a bootstrap, made once: both ends of all parameters come from the same one."""
        key = checks.within("repetitions", repetitions, 1, 10**7), seed
        if key not in self._samples:
            self._samples[key] = self.bootstrap(repetitions=repetitions, seed=seed)
        return self._samples[key]

    def bootstrap(
        self, kind: Resampling | Literal["capacities"] | None = None, *, repetitions: int = 1000, seed: int = 0
    ) -> BootstrapSample | CapacitySample:
        """Return the study repeated many times.

        Parameters
        ----------
        kind : {"parametric", "cases", "clusters", "capacities"}, optional
            How to draw. By default capacities from the curve where every cluster was tried once at every level and
            fewer than 30 of them, whole clusters where they were named otherwise, else parametric.
        repetitions : int
            How many.
        seed : int
            Seed of the random numbers.

        Returns
        -------
        BootstrapSample or CapacitySample
            What finds the intervals.

        Raises
        ------
        InvalidValueError
            If the kind is unknown, or the outcomes do not come as it needs them.
        """
        own, counts = self.intervals, self.counts
        if kind == "capacities" or (kind is None and counts.draws_capacities):
            return draw_capacities(counts, own.curves, own.scale, repetitions, seed)
        usual: Resampling = "parametric" if counts.cluster_trials is None else "clusters"
        return bootstrap(counts, own.curves, own.scale, kind or usual, repetitions, seed)

    def goodness(self, *, groups: int = 10, repetitions: int = 1000, seed: int = 0) -> Goodness:
        """Return how well the curve agrees with the outcomes.

        Parameters
        ----------
        groups : int
            Most groups of neighbouring levels that outcomes are gathered in.
        repetitions : int
            Number of data sets drawn from the curve and refitted.
        seed : int
            Seed of the random numbers.

        Returns
        -------
        Goodness
            Statistics with their p-values, and observed beside expected failures.
        """
        own = self.intervals
        return goodness_of(self.counts, own.curves, own.scale, groups, repetitions, seed)

    def summary(self) -> dict[str, Any]:
        """Return the fit as plain numbers and words.

        Returns
        -------
        dict
            Ready for JSON: None where something does not exist or an interval is open.
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
    """Fit a lognormal fragility curve to outcomes, or say why there is none.

    Parameters
    ----------
    levels : array_like
        Level of the intensity measure of each entry, in any order, > 0 [any unit].
    failures : array_like
        How many trials of each entry failed; 0 or 1, or booleans, without `trials` [-].
    trials : array_like, optional
        How many trials each entry holds, at least 1; 1 each by default [-].
    method : {"auto", "maximum-likelihood", "penalised"}
        "auto" maximises the likelihood where a maximum exists, and Firth's penalised one where the outcomes form a
        step.
    clusters : iterable, optional
        Name of the cluster of each entry, such as its record: outcomes of one cluster are not independent.

    Returns
    -------
    LognormalFit
        The fit; check `exists` or read `verdict`.

    Raises
    ------
    InvalidValueError
        If a value is refused, or "maximum-likelihood" is asked for where no maximum exists.

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
    """Fit a lognormal fragility curve to outcomes that are counted already, or say why there is none.

    Parameters
    ----------
    counts : Counts
        The outcomes.
    method : {"auto", "maximum-likelihood", "penalised"}
        As for `fit_lognormal`.

    Returns
    -------
    LognormalFit
        The fit; check `exists` or read `verdict`.
    """
    chosen = checks.one_of("method", method, get_args(Method))
    separation = separation_of(counts)
    if chosen == "maximum-likelihood" and separation is not Separation.OVERLAP:
        raise InvalidValueError(
            f'method must not be "maximum-likelihood" for these outcomes, whose likelihood has no maximum among'
            f" lognormal curves; {separation.value}"
        )
    if separation is not Separation.OVERLAP and not separation.step:
        return LognormalFit(counts, separation, "none")
    scale = LogScale.of(counts)
    curves = find_curves(
        counts.levels, scale, counts.failures[None], counts.trials[None], penalised=chosen == "penalised"
    )
    if not curves.found[0] and not curves.penalised[0]:
        raise InvalidValueError(
            "outcomes must overlap by more than rounding for a maximum to be proven, got levels of failures and"
            " survivals that all but coincide; round the levels"
        )
    if not curves.found[0] or abs(float(log_fractile(curves.theta, scale, 0.0)[0])) > LARGEST_LOGARITHM:
        return LognormalFit(counts, separation, "none")
    used: str = "penalised" if curves.penalised[0] else "maximum-likelihood"
    return LognormalFit(counts, separation, used, scale, curves)


def lognormal_probability(level: FloatArray, median: float, dispersion: float) -> FloatArray:
    """Return the probability of failure at levels >= 0 [unit of the median]; zero at zero [-]."""
    with np.errstate(divide="ignore"):
        return np.asarray(ndtr(np.log(level / median) / dispersion))  # Eq. 190
