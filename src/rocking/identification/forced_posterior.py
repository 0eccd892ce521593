"""The posterior for rocking under a known ground motion: one normal distribution per scatter."""

import math

import numpy as np

from rocking.conventions import FloatArray
from rocking.identification.forced_model import SAME_TIME, SIZE, Fit, Forced
from rocking.identification.posterior import SCATTERS, Mixture, interval_of_nodes, scatter_nodes
from rocking.identification.results import IntervalEstimate

_GRID = 61


class ForcedPosterior:
    """Weighted normal distributions of the unknowns, one per scatter, about one linearisation."""

    def __init__(self, problem: Forced, fit: Fit, noise: FloatArray) -> None:
        self.problem, self.fit, self.noise = problem, fit, noise
        self.free = np.isfinite(problem.precision)
        self.scatter, prior = scatter_nodes(np.log(SCATTERS), _GRID)
        drawn, by = fit.terms.draws
        precision = np.where(self.free, problem.precision, 0.0)
        away = np.where(self.free, fit.x - np.concatenate([problem.mean, np.zeros(fit.x.size - SIZE)]), 0.0)
        fixed, pull = fit.terms.normal(noise, 1.0, SAME_TIME)
        fixed = (fixed - by.T @ by + np.diag(precision))[np.ix_(self.free, self.free)]
        scale = 1.0 / np.sqrt(np.diag(fixed))
        self._root = np.linalg.inv(np.linalg.cholesky(fixed * scale[:, None] * scale)) * scale
        self._pull = self._root @ (pull - by.T @ drawn - precision * away)[self.free]
        # in the singular directions of the coefficients, all scatters use one matrix
        self._modes, size, turn = np.linalg.svd(self._root @ by[:, self.free].T, full_matrices=False)
        missed = turn @ drawn - size * (self._modes.T @ self._pull)
        total = self.scatter[:, None] ** 2 + size**2
        self._held, self._steps = size**2 / total, size * missed / total
        ln = prior - 0.5 * (missed**2 / total + np.log(total)).sum(axis=1)  # Eq. 284
        weights = np.exp(ln - ln.max())
        self.weights = weights / weights.sum()
        misfit = fit.terms.value(noise, 1.0, SAME_TIME) - float(drawn @ drawn) + float(precision @ away**2)
        exponent = float(self._pull @ self._pull) - misfit
        self.ln_evidence = float(
            ln.max() + math.log(weights.sum()) + 0.5 * exponent + np.log(np.diag(self._root)).sum()
        )  # sum over all scatters

    def distribution(self, slopes: FloatArray, value: float) -> Mixture:
        """Return the distribution of a quantity from its value and slopes at the linearisation."""
        by = self._root @ slopes[self.free]
        along = self._modes.T @ by
        means = value + float(by @ self._pull) + self._steps @ along
        return Mixture(self.weights, means, np.sqrt(np.maximum(float(by @ by) - self._held @ along**2, 0.0)))

    def shared(self, *terms: tuple[int, float]) -> Mixture:
        """Return the distribution of a weighted sum of the parameters shared by all half cycles."""
        slopes = np.zeros(self.fit.x.size)
        for which, factor in terms:
            slopes[which] = factor
        return self.distribution(slopes, float(slopes @ self.fit.x))

    def explained(self, which: int, by: tuple[int, ...]) -> float:
        """Return the fraction of the standard deviation of a shared parameter that other shared parameters explain."""
        column, held_fraction = np.cumsum(self.free) - 1, self._held[int(np.argmax(self.weights))]
        root = self._root - self._modes @ ((1.0 - np.sqrt(1.0 - held_fraction))[:, None] * (self._modes.T @ self._root))
        target, others = root[:, column[which]], root[:, [column[index] for index in by if self.free[index]]]
        return float(np.linalg.norm(np.linalg.qr(others)[0].T @ target)) if others.size else 0.0

    @property
    def no_scatter(self) -> float:
        """Probability that ln r does not scatter [-]."""
        return float(self.weights[self.scatter == 0.0].sum())

    @property
    def likely_scatter(self) -> IntervalEstimate:
        """Median and 95 % interval of the scatter."""
        return IntervalEstimate(*interval_of_nodes(self.scatter, self.weights))
