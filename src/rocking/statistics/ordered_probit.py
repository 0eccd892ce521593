"""Nested states of one body. Separate curves may cross, but curves with a common dispersion do not."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal, Self, get_args

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.statistics.counts import StateCounts, count_states
from rocking.statistics.lognormal import (
    LognormalFit,
    difference_extremes,
    fit_lognormal,
    levels_of,
    lognormal_probability,
)
from rocking.statistics.maximum_likelihood import LogScale, maximise
from rocking.statistics.probit import Derivatives, tails

Curve = tuple[float, float]  # median [unit of the levels] and dispersion [-]
OrderedMethod = Literal["separate", "common-dispersion"]
ORDERED_METHODS: tuple[OrderedMethod, ...] = get_args(OrderedMethod)


@dataclass(frozen=True, eq=False)
class OrderedProbit:
    """Log likelihood of states with decreasing thresholds a1 > a2 > ... and one slope b. It is concave (Pratt 1981)."""

    position: FloatArray  # positions of the levels [-]
    ended: FloatArray  # number of trials by final state (rows, mildest state first) and level [-]

    def rows(self, index: Any) -> Self:
        """Return the function itself, because there is only one."""
        return self

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return value and derivatives at one row, which contains the thresholds and the slope."""
        thresholds, slope = theta[0, :-1], theta[0, -1]
        if np.any(np.diff(thresholds) >= 0.0):
            order = theta.shape[1]
            return Derivatives(np.array([-np.inf]), np.zeros((1, order)), np.zeros((1, order, order)))
        eta = thresholds[:, None] + slope * self.position
        top, bottom = tails(eta[0]), tails(eta[-1])
        high, low, between = eta[:-1], eta[1:], self.ended[1:-1]
        width = _log_difference(high, low)
        p, q = (np.exp(-0.5 * x**2 - 0.5 * np.log(2.0 * np.pi) - width) for x in (high, low))
        value = np.sum(self.ended[0] * top.log_survival + self.ended[-1] * bottom.log_failure)
        first, bend = np.zeros_like(eta), np.zeros_like(eta)
        first[0] -= self.ended[0] * top.survival_rate
        first[-1] += self.ended[-1] * bottom.failure_rate
        first[:-1] += between * p
        first[1:] -= between * q
        bend[0] += self.ended[0] * top.survival_bend
        bend[-1] += self.ended[-1] * bottom.failure_bend
        bend[:-1] += between * p * (high + p)
        bend[1:] += between * q * (q - low)
        return self._collected(float(value + np.sum(between * width)), first, bend, -between * p * q)  # Eq. 216

    def _collected(self, value: float, first: FloatArray, bend: FloatArray, across: FloatArray) -> Derivatives:
        """Convert derivatives with respect to the variates to derivatives with respect to thresholds and slope."""
        count = first.shape[0]
        moves = np.zeros((count, count + 1, self.position.size))
        moves[np.arange(count), np.arange(count)] = 1.0
        moves[:, -1] = self.position
        gradient = np.einsum("kpm,km->p", moves, first)
        curvature = np.einsum("kpm,km,kqm->pq", moves, bend, moves)
        mixed = np.einsum("kpm,km,kqm->pq", moves[:-1], across, moves[1:])
        return Derivatives(np.array([value]), gradient[None], (curvature + mixed + mixed.T)[None])


def nested_curves(levels: FloatArray, reached: FloatArray, trials: FloatArray) -> list[Curve]:
    """Return the curves of nested states with one dispersion, from the counts of trials that reached the states."""
    fits = [fit_lognormal(levels, counts, trials) for counts in reached]
    has_equal = any(np.array_equal(lesser, worse) for lesser, worse in pairwise(reached))
    if has_equal or any(fit.method != "maximum-likelihood" for fit in fits):
        raise InvalidValueError(
            "{parameter}='common-dispersion' requires overlapping states and trials in each state; {verdicts}",
            parameter="method", value="common-dispersion",
            verdicts=" ".join(f"state {k}: {fit.verdict}" for k, fit in enumerate(fits, 1)),
        )  # fmt: skip
    scale = LogScale.of(fits[0].counts)
    ended = -np.diff(np.vstack([trials, reached, np.zeros_like(trials)]), axis=0)
    best = maximise(OrderedProbit(scale.position(levels), ended), _start(fits, scale))
    *thresholds, slope = best.theta[0]
    if not best.proven[0] or slope <= 0.0:
        raise InvalidValueError("outcomes do not determine one dispersion: the maximum cannot be proven")
    return [(float(np.exp(scale.log_level(np.array(-a / slope)))), float(scale.spread / slope)) for a in thresholds]


def _start(fits: list[LognormalFit], scale: LogScale) -> FloatArray:
    medians, dispersions = zip(*(fit.curve for fit in fits if fit.curve), strict=True)
    slope = scale.spread / float(np.mean(dispersions))
    start = [-float(scale.position(np.array(median))) * slope for median in medians]
    for k in range(1, len(start)):
        start[k] = min(start[k], start[k - 1] - 0.1)
    return np.array([[*start, slope]])


def _log_difference(high: FloatArray, low: FloatArray) -> FloatArray:
    """Return ln(Phi(high) - Phi(low)) without cancellation in the upper tail."""
    flip = low > 0.0
    above, below = np.where(flip, -low, high), np.where(flip, -high, low)
    larger, smaller = tails(above).log_failure, tails(below).log_failure
    return np.asarray(larger + np.log(-np.expm1(smaller - larger)))  # Eq. 216


@dataclass(frozen=True, eq=False)
class OrderedFit:
    """Curves of rocking (or worse) and of overturning, from `fit_ordered`."""

    counts: StateCounts  # the outcomes
    separate: tuple[LognormalFit, LognormalFit]  # separate fits of rocking (or worse) and overturning
    method: str  # method of `rocked` and `overturned`
    # rocked, overturned: median [unit of the levels] and dispersion [-] of rocking (or worse) and of overturning, or
    # None
    rocked: Curve | None
    overturned: Curve | None

    @property
    def crossing(self) -> float | None:
        """Level at which the curves cross [unit of the levels]; None if they do not cross."""
        if self.rocked is None or self.overturned is None:
            return None
        (m, s), (n, t) = self.rocked, self.overturned
        if s == t:
            return None
        with np.errstate(over="ignore", under="ignore"):
            level = float(np.exp((t * np.log(m) - s * np.log(n)) / (t - s)))
        return level if 0.0 < level < np.inf else None

    @property
    def excess(self) -> float | None:
        """Largest excess of the probability of overturning over the probability of rocking, between the levels [-]."""
        if self.rocked is None or self.overturned is None:
            return None
        ends = np.log(self.counts.levels[[0, -1]])
        medians, dispersions = np.array([self.rocked, self.overturned]).T
        log_levels = np.concatenate([ends, np.clip(difference_extremes(np.log(medians), dispersions), *ends)])
        over, rocked = (lognormal_probability(np.exp(log_levels), *curve) for curve in (self.overturned, self.rocked))
        return max(0.0, float((over - rocked).max()))

    @property
    def verdict(self) -> str:
        """Conclusions as sentences."""
        sentences = [
            f"{name}: {fit.verdict}" for name, fit in zip(("Rocking", "Overturning"), self.separate, strict=True)
        ]
        excess, crossing = self.excess, self.crossing
        if excess is None:
            sentences.append("A curve is missing.")
        elif crossing is None:
            sentences.append("The curves do not cross.")
        elif excess > 0.0:
            sentences.append(
                f"The curves cross at {crossing:.4g}, between the levels: the probability of overturning would exceed"
                f" that of rocking by up to {excess:.2g}. Use a common dispersion."
            )
        else:
            sentences.append(f"The curves cross at {crossing:.4g}, outside the levels.")
        return " ".join(sentences)

    def probabilities(self, im: Any) -> FloatArray:
        """Return the probabilities of no rocking, rocking and overturned at levels >= 0, along the last axis [-]."""
        # beyond a crossing, the probability of overturning is limited to the probability of rocking
        if self.rocked is None or self.overturned is None:
            raise InvalidValueError("two fragility curves are needed, got fewer: {verdict}", verdict=self.verdict)
        level, _ = levels_of(im)
        rocked = lognormal_probability(level, *self.rocked)
        worst = np.minimum(lognormal_probability(level, *self.overturned), rocked)
        return np.stack([1.0 - rocked, rocked - worst, worst], axis=-1)  # Eq. 217


def fit_ordered(
    levels: Any, rocked: Any, overturned: Any, trials: Any = None, *, method: OrderedMethod = "separate"
) -> OrderedFit:
    """Fit the curves of rocking (or worse) and of overturning.

    Parameters
    ----------
    levels : array_like
        Level of the intensity measure of each entry, in any order, > 0 [any unit].
    rocked : array_like
        Number of trials of each entry that rocked to the chosen level or further, including overturned ones [-].
    overturned : array_like
        Number of trials of each entry that overturned [-].
    trials : array_like, optional
        Number of trials of each entry, at least 1; default 1 [-].
    method : {"separate", "common-dispersion"}
        Separate curves, or one common dispersion from the likelihood of all three states (ordered probit).

    Returns
    -------
    OrderedFit
        The curves and their crossing.

    Raises
    ------
    InvalidValueError
        If a value is invalid, or if a common dispersion is requested and the likelihood has no maximum.

    Examples
    --------
    >>> counts = {"rocked": [2, 9, 18, 20], "overturned": [0, 3, 9, 16], "trials": [20] * 4}
    >>> fit = fit_ordered([0.2, 0.4, 0.6, 0.8], **counts, method="common-dispersion")
    >>> fit.crossing is None, fit.rocked[1] == fit.overturned[1]
    (True, True)
    """
    checked = checks.one_of("method", method, ORDERED_METHODS)
    counts = count_states(levels, rocked, overturned, trials)
    rocking, overturning = (fit_lognormal(counts.levels, z, counts.trials) for z in (counts.rocked, counts.overturned))
    if checked == "separate":
        return OrderedFit(counts, (rocking, overturning), checked, rocking.curve, overturning.curve)
    curves = nested_curves(counts.levels, np.stack([counts.rocked, counts.overturned]), counts.trials)
    return OrderedFit(counts, (rocking, overturning), checked, curves[0], curves[1])
