"""Nested states by one likelihood: as many curves as there are states, with one dispersion, which never cross."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Self

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.fragility.estimate import LogScale
from rocking.studies.fragility.likelihood import Derivatives, tails
from rocking.studies.fragility.lognormal import LognormalFit, fit_lognormal
from rocking.studies.fragility.maximum import maximise

Curve = tuple[float, float]
"""Median [unit of the levels] and dispersion [-]."""


@dataclass(frozen=True, eq=False)
class OrderedProbit:
    """Log likelihood of states with falling thresholds a1 > a2 > ... and one slope b, concave in all (Pratt 1981)."""

    position: FloatArray  # positions of the levels [-]
    ended: FloatArray  # how many trials ended in each state at each level, the harmless one first; one row a state [-]

    def rows(self, index: Any) -> Self:
        """Return itself: it is one function."""
        return self

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the value and derivatives.

        theta: one row: the thresholds, and the slope [-].
        """
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
        """Return the derivatives by thresholds and slope from those by the variate of each curve at each level."""
        count = first.shape[0]
        moves = np.zeros((count, count + 1, self.position.size))
        moves[np.arange(count), np.arange(count)] = 1.0
        moves[:, -1] = self.position
        gradient = np.einsum("kpm,km->p", moves, first)
        curvature = np.einsum("kpm,km,kqm->pq", moves, bend, moves)
        mixed = np.einsum("kpm,km,kqm->pq", moves[:-1], across, moves[1:])
        return Derivatives(np.array([value]), gradient[None], (curvature + mixed + mixed.T)[None])


def nested_curves(levels: FloatArray, reached: FloatArray, trials: FloatArray) -> list[Curve]:
    """Return the curves of nested states with one dispersion for all.

    levels: distinct levels, ascending [any unit]; reached: how many trials reached each state or a worse one at each
    level, from the least state to the worst [-]; trials: all trials at each level [-]. Returns median [unit of the
    levels] and dispersion [-] of each state.
    """
    fits = [fit_lognormal(levels, counts, trials) for counts in reached]
    same = any(np.array_equal(one, other) for one, other in pairwise(reached))
    if same or any(fit.method != "maximum-likelihood" for fit in fits):
        raise InvalidValueError(
            "method must not be 'common-dispersion' unless all states overlap with what is below them, and some trials"
            f" end in each; {' '.join(f'state {k}: {fit.verdict}' for k, fit in enumerate(fits, 1))}"
        )
    scale = LogScale.of(fits[0].counts)
    ended = -np.diff(np.vstack([trials, reached, np.zeros_like(trials)]), axis=0)
    best = maximise(OrderedProbit(scale.position(levels), ended), _start(fits, scale))
    *thresholds, slope = best.theta[0]
    if not best.proven[0] or slope <= 0.0:
        raise InvalidValueError("outcomes must fix one dispersion, got a likelihood whose maximum cannot be proven")
    return [(float(np.exp(scale.log_level(np.array(-a / slope)))), float(scale.spread / slope)) for a in thresholds]


def _start(fits: list[LognormalFit], scale: LogScale) -> FloatArray:
    medians, dispersions = zip(*((fit.intervals.fractile(0.5), fit.intervals.dispersion) for fit in fits), strict=True)
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
