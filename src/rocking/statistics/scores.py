"""Scores of forecast probabilities: Brier, logarithmic, reliability, and a logistic reference forecast."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import expit, xlogy

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.messages import Range
from rocking.statistics.counts import share_interval
from rocking.statistics.quantiles import quantiles

REPETITIONS = 2000  # number of bootstrap samples for an interval


@dataclass(frozen=True)
class Score:
    """A number with an interval from resampled clusters.

    A cluster contains, for example, all outcomes under one motion.
    """

    value: float  # the number [-]
    low: float  # low, high: ends of the 95 % interval [-]; NaN for fewer than two clusters
    high: float

    @property
    def resolved(self) -> bool:
        """True if the interval excludes zero, so that the difference is significant."""
        return self.low > 0.0 or self.high < 0.0


@dataclass(frozen=True, eq=False)
class ReliabilityBin:
    """Outcomes with similar forecast probabilities."""

    count: int  # number of outcomes [-]
    predicted: float  # mean forecast probability [-]
    observed: float  # observed fraction [-]
    low: float  # low, high: exact 95 % interval of the observed fraction [-]
    high: float


class Forecasts:
    """Forecast probabilities and observed outcomes.

    Outcomes without a result (NaN) are omitted and counted.

    Parameters
    ----------
    probability : array_like, shape (n,)
        Forecast probabilities of the outcomes [-].
    outcome : array_like, shape (n,)
        1 for an event, 0 for no event, NaN if unknown [-].
    clusters : array_like, shape (n,), optional
        Names of groups of dependent outcomes, such as the motion. Default: independent outcomes.
    repetitions : int
        Number of bootstrap samples for the intervals.
    seed : int
        Random seed of the bootstrap.

    Attributes
    ----------
    left_out : int
        Number of entries without outcome or probability.

    Raises
    ------
    InvalidValueError
        If the lengths differ, if a probability is outside [0, 1], if an outcome is invalid, or if no entry is complete.

    Examples
    --------
    >>> forecasts = Forecasts([0.9, 0.2, 0.6, 0.1], [1, 0, 0, 0])
    >>> round(forecasts.brier.value, 3), forecasts.balanced_accuracy.value
    (0.105, 0.8333333333333333)
    """

    def __init__(
        self, probability: Any, outcome: Any, clusters: Any = None, *, repetitions: int = REPETITIONS, seed: int = 0
    ) -> None:
        forecast, happened = (np.asarray(values, dtype=np.float64) for values in (probability, outcome))
        names = np.arange(forecast.size) if clusters is None else np.asarray(clusters)
        if forecast.ndim != 1 or not forecast.shape == happened.shape == names.shape:
            raise InvalidValueError(
                "probability, outcome and clusters must be rows of one length, got shapes {probability}, {outcome}, "
                "{clusters}", probability=forecast.shape, outcome=happened.shape, clusters=names.shape,
            )  # fmt: skip
        complete = ~(np.isnan(forecast) | np.isnan(happened))
        self.left_out = int((~complete).sum())
        self.probability, self.outcome = forecast[complete], happened[complete]
        if not complete.any():
            raise InvalidValueError(
                "all {count} outcomes are unknown, but a score needs a known outcome", count=forecast.size
            )
        if (bad := (self.probability < 0.0) | (self.probability > 1.0)).any():
            raise InvalidValueError(
                parameter="probability", allowed=Range(0.0, 1.0), value=float(self.probability[bad][0]),
                hint="Use fractions, not percent.",
            )  # fmt: skip
        if (bad := (self.outcome != 0.0) & (self.outcome != 1.0)).any():
            raise InvalidValueError(parameter="outcome", allowed="1, 0 or NaN", value=float(self.outcome[bad][0]))
        self.cluster: IntArray = np.unique(names[complete], return_inverse=True)[1]
        count = int(self.cluster.max()) + 1
        draws = checks.within("repetitions", repetitions, 1, 10**6)
        random = np.random.default_rng(seed)
        # number of copies of the clusters in the samples
        self._weights = random.multinomial(count, np.full(count, 1.0 / count), size=int(draws)).astype(np.float64)

    @property
    def brier(self) -> Score:
        """Mean square of probability minus outcome (Brier 1950) [-]. 0 is perfect; a probability of 0.5 gives 1/4."""
        return self._mean(_brier(self.probability, self.outcome))

    @property
    def logarithmic(self) -> Score:
        """Mean of -ln of the probability of the outcome [nat]; infinite if an outcome had probability 0."""
        return self._mean(_surprise(self.probability, self.outcome))

    @property
    def accuracy(self) -> Score:
        """Fraction of correct forecasts [-]. A probability of at least 0.5 forecasts the event."""
        return self._mean(self._correct())

    @property
    def balanced_accuracy(self) -> Score:
        """Mean of the fractions of correct forecasts of events and of non-events [-]. Chance gives 1/2."""
        correct, events = self._correct(), self.outcome == 1.0
        return self._score(lambda sums: 0.5 * (sums(correct, events) + sums(correct, ~events)))  # Eq. 232

    def skill(self, other: "Forecasts | float", measure: str = "brier") -> Score:
        """Return the improvement of a score over the score of another forecast of the same outcomes.

        Parameters
        ----------
        other : Forecasts or float
            The other forecast, or one probability for all outcomes [-].
        measure : str
            The score, "brier" or "logarithmic".

        Returns
        -------
        Score
            Paired difference: score of the other forecast minus score of this forecast [- or nat]. It is positive if
            this forecast is better.

        Raises
        ------
        InvalidValueError
            If the other forecast has other outcomes, or if the score is unknown.
        """
        loss = _LOSSES[checks.one_of("measure", measure, _LOSSES)]
        if isinstance(other, Forecasts):
            if not np.array_equal(other.outcome, self.outcome):
                raise InvalidValueError("the other forecast must be of the same outcomes in the same order")
            theirs = other.probability
        else:
            theirs = np.full(self.outcome.size, checks.within("other", other, 0.0, 1.0))
        return self._mean(loss(theirs, self.outcome) - loss(self.probability, self.outcome))

    @property
    def bias(self) -> Score:
        """Mean of probability minus outcome [-]; positive if events are overpredicted."""
        return self._mean(self.probability - self.outcome)

    @property
    def sureness(self) -> Score:
        """Mean of the terms in the numerator of `calibration`: positive if overconfident [-]."""
        return self._mean((self.outcome - self.probability) * (1.0 - 2.0 * self.probability))

    @property
    def calibration(self) -> float:
        """Spiegelhalter's statistic [-]. It is approximately standard normal for calibrated probabilities."""
        p = self.probability
        excess = float(((self.outcome - p) * (1.0 - 2.0 * p)).sum())
        spread = float(((1.0 - 2.0 * p) ** 2 * p * (1.0 - p)).sum())
        return excess / spread**0.5 if spread > 0.0 else (np.inf if excess else 0.0)  # Eq. 233

    def reliability(self, bins: int = 10) -> list[ReliabilityBin]:
        """Return the reliability diagram: forecast probabilities and observed fractions.

        Parameters
        ----------
        bins : int
            Number of equal bins of probability from 0 to 1. Empty bins are omitted.

        Returns
        -------
        list of ReliabilityBin
            Bins in increasing order of probability.
        """
        steps = int(checks.within("bins", bins, 1, 1000))
        step = np.minimum((self.probability * steps).astype(np.int64), steps - 1)
        diagram = []
        for k in np.unique(step):
            p, happened = self.probability[step == k], self.outcome[step == k]
            interval = share_interval(float(happened.sum()), happened.size)
            diagram.append(ReliabilityBin(p.size, float(p.mean()), float(happened.mean()), *interval))
        return diagram

    def _correct(self) -> FloatArray:
        return np.where((self.probability >= 0.5) == (self.outcome == 1.0), 1.0, 0.0)

    def _mean(self, values: FloatArray) -> Score:
        return self._score(lambda sums: sums(values, np.ones(values.size, dtype=bool)))

    def _score(self, statistic: "Callable[[Callable[[FloatArray, BoolArray], FloatArray]], FloatArray]") -> Score:
        """Return a statistic of subset means, with an interval from samples of clusters."""
        once = np.ones((1, self._weights.shape[1]))

        def means(weights: FloatArray) -> "Callable[[FloatArray, BoolArray], FloatArray]":
            def mean(values: FloatArray, subset: BoolArray) -> FloatArray:
                total, count = (
                    np.bincount(self.cluster, terms, weights.shape[1])
                    for terms in (np.where(subset, values, 0.0), subset.astype(np.float64))
                )
                with np.errstate(invalid="ignore", divide="ignore"):
                    return np.asarray((weights @ total) / (weights @ count))

            return mean

        value = float(statistic(means(once))[0])
        if self._weights.shape[1] < 2:
            return Score(value, np.nan, np.nan)
        samples = statistic(means(self._weights))  # NaN for samples without one of the two outcomes
        return Score(value, *quantiles(samples, (0.025, 0.975)).tolist())


def _brier(p: FloatArray, yes: FloatArray) -> FloatArray:
    return np.asarray((p - yes) ** 2)  # Eq. 230


def _surprise(p: FloatArray, yes: FloatArray) -> FloatArray:
    return np.asarray(-xlogy(yes, p) - xlogy(1.0 - yes, 1.0 - p), dtype=np.float64)  # Eq. 231


_LOSSES = {"brier": _brier, "logarithmic": _surprise}


def logistic_left_out(features: Any, outcome: Any, clusters: Any) -> FloatArray:
    """Return forecasts of every cluster by a logistic curve that is fitted to all other clusters.

    With the logarithms of PGA and PGV as features, these forecasts are the reference for mechanical forecasts. Firth's
    penalty, half the logarithm of the information, keeps the curve finite for separated outcomes and removes the bias
    for few outcomes.

    Parameters
    ----------
    features : array_like, shape (n, k)
        Features of the outcomes, such as ln PGA and ln PGV. Without columns, the forecast is the fraction of events in
        the other clusters, with 0.5 added to both counts.
    outcome : array_like, shape (n,)
        1, 0, or NaN if unknown [-].
    clusters : array_like, shape (n,)
        Names of the groups that are omitted together, such as the motion.

    Returns
    -------
    ndarray, shape (n,)
        Probabilities of the outcomes by the curve without their cluster [-]; NaN if there are no other outcomes.

    Raises
    ------
    InvalidValueError
        If the lengths differ, or if a feature is not finite.

    Examples
    --------
    >>> x = [[0.1], [0.2], [0.6], [0.9], [1.4], [1.5]]
    >>> p = logistic_left_out(x, [0, 0, 0, 1, 1, 1], clusters=range(6))
    >>> bool((p[:2] < 0.5).all() and (p[4:] > 0.5).all())
    True
    """
    table, happened, names = (
        np.asarray(features, dtype=np.float64),
        np.asarray(outcome, np.float64),
        np.asarray(clusters),
    )
    if table.ndim != 2 or not table.shape[0] == happened.size == names.size:
        raise InvalidValueError(
            "{parameter} must have one row per outcome, got shape {shape} for {outcomes} outcomes",
            parameter="features", shape=table.shape, outcomes=happened.size,
        )  # fmt: skip
    if not np.isfinite(table).all():
        raise InvalidValueError("features must be finite. Check for logarithms of zero.")
    probability = np.full(happened.size, np.nan)
    for name in np.unique(names):
        out = names == name
        training = ~out & np.isfinite(happened)
        if training.any():
            middle, spread = table[training].mean(axis=0), table[training].std(axis=0)
            scaled = (table - middle) / np.where(spread > 0.0, spread, 1.0)
            design = np.column_stack([np.ones(len(table)), scaled])
            probability[out] = expit(design[out] @ _firth(design[training], happened[training]))
    return probability


def _firth(design: FloatArray, outcome: FloatArray, steps: int = 100) -> FloatArray:
    """Return the coefficients of a logistic curve by maximum penalised likelihood (Firth 1993)."""
    theta = np.zeros(design.shape[1])

    def value(at: FloatArray) -> float:
        eta = design @ at
        weight = expit(eta) * expit(-eta)
        information = np.linalg.slogdet(design.T @ (weight[:, None] * design) + 1e-12 * np.eye(at.size))[1]
        return float((outcome * eta - np.logaddexp(0.0, eta)).sum() + 0.5 * information)  # Eq. 234

    best = value(theta)
    for _ in range(steps):
        p = expit(design @ theta)
        weighted = np.sqrt(p * (1.0 - p))[:, None] * design
        covariance = np.linalg.pinv(weighted.T @ weighted)
        leverage = np.einsum("ij,jk,ik->i", weighted, covariance, weighted)
        step = covariance @ (design.T @ (outcome - p + leverage * (0.5 - p)))  # Eq. 235
        while (new := value(theta + step)) < best - 1e-12 and np.abs(step).max() > 1e-10:
            step = 0.5 * step
        theta, best = theta + step, max(best, new)
        if np.abs(step).max() <= 1e-8:
            break
    return theta
