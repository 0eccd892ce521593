"""How good probabilities were, once the outcomes are known: scores, reliability, and the plain curve to be beaten."""

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

REPETITIONS = 2000  # bootstrap samples of an interval


@dataclass(frozen=True)
class Score:
    """A number with its interval: whole clusters, such as all outcomes under one motion, were drawn again."""

    value: float  # the number [-]
    low: float  # low, high: ends of the 95 % interval [-]; NaN where there are fewer than two clusters
    high: float

    @property
    def resolved(self) -> bool:
        """Whether the interval leaves zero out: of a difference, whether one side is better."""
        return self.low > 0.0 or self.high < 0.0


@dataclass(frozen=True, eq=False)
class ReliabilityBin:
    """Outcomes to which about the same probability was given."""

    count: int  # how many there are [-]
    predicted: float  # mean of the probabilities given [-]
    observed: float  # share that happened [-]
    low: float  # low, high: exact 95 % interval of that share [-]
    high: float


class Forecasts:
    """Probabilities that were given before, and what then happened.

    Outcomes without a result, NaN, are left out and counted.

    Parameters
    ----------
    probability : array_like, shape (n,)
        Probability given to each outcome [-].
    outcome : array_like, shape (n,)
        1 where it happened, 0 where not, NaN where nobody knows [-].
    clusters : array_like, shape (n,), optional
        What is not independent of each other, such as the name of the motion; each outcome by itself if not given.
    repetitions : int
        Bootstrap samples of the intervals.
    seed : int
        Of the bootstrap.

    Attributes
    ----------
    left_out : int
        How many had no outcome or no probability.

    Raises
    ------
    InvalidValueError
        If the lengths differ, a probability is outside [0, 1], an outcome is none, or nothing is left.

    Examples
    --------
    >>> given = Forecasts([0.9, 0.2, 0.6, 0.1], [1, 0, 0, 0])
    >>> round(given.brier.value, 3), given.balanced_accuracy.value
    (0.105, 0.8333333333333333)
    """

    def __init__(
        self, probability: Any, outcome: Any, clusters: Any = None, *, repetitions: int = REPETITIONS, seed: int = 0
    ) -> None:
        given, happened = (np.asarray(each, dtype=np.float64) for each in (probability, outcome))
        names = np.arange(given.size) if clusters is None else np.asarray(clusters)
        if given.ndim != 1 or not given.shape == happened.shape == names.shape:
            raise InvalidValueError(
                "probability, outcome and clusters must be rows of one length, got shapes {probability}, {outcome}, "
                "{clusters}", probability=given.shape, outcome=happened.shape, clusters=names.shape,
            )  # fmt: skip
        known = ~(np.isnan(given) | np.isnan(happened))
        self.left_out = int((~known).sum())
        self.probability, self.outcome = given[known], happened[known]
        if not known.any():
            raise InvalidValueError("no outcome is known of {count}: there is nothing to score", count=given.size)
        if (bad := (self.probability < 0.0) | (self.probability > 1.0)).any():
            raise InvalidValueError(
                parameter="probability", allowed=Range(0.0, 1.0), value=float(self.probability[bad][0]),
                hint="in per cent?",
            )  # fmt: skip
        if (bad := (self.outcome != 0.0) & (self.outcome != 1.0)).any():
            raise InvalidValueError(parameter="outcome", allowed="1, 0 or NaN", value=float(self.outcome[bad][0]))
        self.cluster: IntArray = np.unique(names[known], return_inverse=True)[1]
        count = int(self.cluster.max()) + 1
        draws = checks.within("repetitions", repetitions, 1, 10**6)
        random = np.random.default_rng(seed)
        # how often each cluster is in each sample
        self._weights = random.multinomial(count, np.full(count, 1.0 / count), size=int(draws)).astype(np.float64)

    @property
    def brier(self) -> Score:
        """Mean square of probability less outcome; 0 is perfect, 1/4 is a coin's (Brier 1950) [-]."""
        return self._mean(_brier(self.probability, self.outcome))

    @property
    def logarithmic(self) -> Score:
        """Mean of -ln of the probability given to what happened; infinite if one was called impossible [nat]."""
        return self._mean(_surprise(self.probability, self.outcome))

    @property
    def accuracy(self) -> Score:
        """Share foreseen, a probability of one half and more being a yes [-]."""
        return self._mean(self._foreseen())

    @property
    def balanced_accuracy(self) -> Score:
        """Mean of the shares foreseen of what happened and of what did not; 1/2 is chance [-]."""
        foreseen, yes = self._foreseen(), self.outcome == 1.0
        return self._score(lambda sums: 0.5 * (sums(foreseen, yes) + sums(foreseen, ~yes)))  # Eq. 232

    def skill(self, other: "Forecasts | float", measure: str = "brier") -> Score:
        """Return by how much a score is better than that of another forecast of the same outcomes.

        Parameters
        ----------
        other : Forecasts or float
            The other forecast, or one probability given to all [-].
        measure : str
            The score, "brier" or "logarithmic".

        Returns
        -------
        Score
            Score of the other less that of this one, above zero where this one is better; drawn in pairs [- or nat].

        Raises
        ------
        InvalidValueError
            If the other one is of other outcomes, or there is no such score.
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
        """Mean of probability less outcome; above zero where more was said than happened [-]."""
        return self._mean(self.probability - self.outcome)

    @property
    def sureness(self) -> Score:
        """Mean of the terms above the fraction of `calibration`: above zero where forecasts are too sure [-]."""
        return self._mean((self.outcome - self.probability) * (1.0 - 2.0 * self.probability))

    @property
    def calibration(self) -> float:
        """Spiegelhalter's statistic: about standard normal if the probabilities are right as often as they say [-]."""
        p = self.probability
        excess = float(((self.outcome - p) * (1.0 - 2.0 * p)).sum())
        spread = float(((1.0 - 2.0 * p) ** 2 * p * (1.0 - p)).sum())
        return excess / spread**0.5 if spread > 0.0 else (np.inf if excess else 0.0)  # Eq. 233

    def reliability(self, bins: int = 10) -> list[ReliabilityBin]:
        """Return the reliability diagram: what was said, and how often it then happened.

        Parameters
        ----------
        bins : int
            How many equal steps of probability from 0 to 1; those without an outcome are left out.

        Returns
        -------
        list of ReliabilityBin
            From the least probability up.
        """
        steps = int(checks.within("bins", bins, 1, 1000))
        step = np.minimum((self.probability * steps).astype(np.int64), steps - 1)
        found = []
        for k in np.unique(step):
            p, happened = self.probability[step == k], self.outcome[step == k]
            interval = share_interval(float(happened.sum()), happened.size)
            found.append(ReliabilityBin(p.size, float(p.mean()), float(happened.mean()), *interval))
        return found

    def _foreseen(self) -> FloatArray:
        return np.where((self.probability >= 0.5) == (self.outcome == 1.0), 1.0, 0.0)

    def _mean(self, values: FloatArray) -> Score:
        return self._score(lambda sums: sums(values, np.ones(values.size, dtype=bool)))

    def _score(self, made: "Callable[[Callable[[FloatArray, BoolArray], FloatArray]], FloatArray]") -> Score:
        """Return a statistic of means over parts, of the outcomes as they are and of every sample of clusters."""
        once = np.ones((1, self._weights.shape[1]))

        def means(weights: FloatArray) -> "Callable[[FloatArray, BoolArray], FloatArray]":
            def mean(values: FloatArray, part: BoolArray) -> FloatArray:
                total, count = (
                    np.bincount(self.cluster, each, weights.shape[1])
                    for each in (np.where(part, values, 0.0), part.astype(np.float64))
                )
                with np.errstate(invalid="ignore", divide="ignore"):
                    return np.asarray((weights @ total) / (weights @ count))

            return mean

        value = float(made(means(once))[0])
        if self._weights.shape[1] < 2:
            return Score(value, np.nan, np.nan)
        drawn = made(means(self._weights))  # NaN: samples without one of the two outcomes
        return Score(value, *quantiles(drawn, (0.025, 0.975)).tolist())


def _brier(p: FloatArray, yes: FloatArray) -> FloatArray:
    return np.asarray((p - yes) ** 2)  # Eq. 230


def _surprise(p: FloatArray, yes: FloatArray) -> FloatArray:
    return np.asarray(-xlogy(yes, p) - xlogy(1.0 - yes, 1.0 - p), dtype=np.float64)  # Eq. 231


_LOSSES = {"brier": _brier, "logarithmic": _surprise}


def logistic_left_out(features: Any, outcome: Any, clusters: Any) -> FloatArray:
    """Return what a logistic curve foresees of each cluster that was fitted to all the others.

    It is the plain forecast that a mechanical one must beat: of outcomes under motions, with the logarithms of PGA and
    PGV as features. Firth's penalty, half the logarithm of the information, keeps it finite where the others are
    separated, and removes the bias of few outcomes.

    Parameters
    ----------
    features : array_like, shape (n, k)
        What is known of each outcome beforehand, such as ln PGA and ln PGV; with no columns the curve is the share of
        the others, one half added to either count.
    outcome : array_like, shape (n,)
        1, 0, or NaN where nobody knows [-].
    clusters : array_like, shape (n,)
        What is left out together, such as the name of the motion.

    Returns
    -------
    ndarray, shape (n,)
        Probability of each outcome by the curve that has not seen its cluster [-]; NaN where nothing is left to fit.

    Raises
    ------
    InvalidValueError
        If the lengths differ or a feature is not finite.

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
            "{parameter} must be a row for each outcome, got shape {shape} for {outcomes} outcomes",
            parameter="features", shape=table.shape, outcomes=happened.size,
        )  # fmt: skip
    if not np.isfinite(table).all():
        raise InvalidValueError("features must be finite; is one the logarithm of zero?")
    probability = np.full(happened.size, np.nan)
    for name in np.unique(names):
        out = names == name
        seen = ~out & np.isfinite(happened)
        if seen.any():
            middle, spread = table[seen].mean(axis=0), table[seen].std(axis=0)
            scaled = (table - middle) / np.where(spread > 0.0, spread, 1.0)
            design = np.column_stack([np.ones(len(table)), scaled])
            probability[out] = expit(design[out] @ _firth(design[seen], happened[seen]))
    return probability


def _firth(design: FloatArray, outcome: FloatArray, steps: int = 100) -> FloatArray:
    """Coefficients that maximise the penalised likelihood of a logistic curve (Firth 1993)."""
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
