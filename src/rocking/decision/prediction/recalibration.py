"""Factors of one body from tests with known outcomes: posterior, and prediction of omitted earthquakes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit, logit

from rocking.conventions import FloatArray, IntArray
from rocking.decision.prediction.mechanics import SampledBodies
from rocking.decision.prediction.model_error import (
    ORDERS,
    SCATTERS,
    STEEPEST_SLOPE,
    BodyEvidence,
    FurtherBody,
    ModelError,
    mixed,
    sharpened,
)
from rocking.messages import Message
from rocking.statistics.sobol import scrambled_sobol

WIDE = ModelError((0.0, 0.0), ((0.09, 0.0), (0.0, 0.36)), "proposal")
"""Distribution from which the factors of the tests are sampled; weights convert it to narrower distributions."""

SLOPE_DEVIATION, LEAST = 0.5, 1e-6
"""Standard deviation of the prior of the calibration slope, and smallest probability of its fit [-]."""

_STEPS = np.linspace(-0.9, 0.9, 19)
OF_HISTORY = {"restitution", "friction", "level", "azimuth", "polarity", "model_error"}
"""Inputs that do not change the shape of a body; they have new samples for each test."""


@dataclass(frozen=True, eq=False)
class BodyTests:
    """Tests of one body: sampled histories with widely sampled factors, and observed outcomes.

    Parameters
    ----------
    logarithms : ndarray, shape (tests, samples, 2)
        Ln of the sampled factors on uplift acceleration and energy barrier [-].
    overturned : ndarray, shape (tests, samples)
        1 with overturning, 0 without, NaN without a result [-].
    observed : ndarray, shape (tests,)
        1 if the body overturned, 0 if not, NaN if unknown [-].
    earthquakes : ndarray, shape (tests,)
        Name of the earthquake of each test; tests of one earthquake are dependent.
    """

    logarithms: FloatArray
    overturned: FloatArray
    observed: FloatArray
    earthquakes: Any

    @cached_property
    def nodes(self) -> FloatArray:
        """Grid of ln of both factors, and of the scatter between repeated tests; shape (nodes, 3)."""
        grid = np.meshgrid(_STEPS * ORDERS[0], _STEPS * ORDERS[1], SCATTERS, indexing="ij")
        return np.stack([values.ravel() for values in grid], axis=1)

    @cached_property
    def probabilities(self) -> FloatArray:
        """Probability of overturning of each test at each node, shape (tests, nodes), by weighted samples.

        Each estimate includes the estimate with the next larger scatter as one effective sample. The estimate with the
        largest scatter includes the fraction of all samples, (h + 1/2) / (n + 1) as in `score`, as one sample.
        """
        centres = self.nodes[:: len(SCATTERS), :2]  # the index of the scatter varies fastest
        return np.array([_smoothed(*test, centres) for test in zip(self.logarithms, self.overturned, strict=True)])

    @cached_property
    def likelihood(self) -> FloatArray:
        """Logarithm of the likelihood of the outcomes under each earthquake at each node, shape (earthquakes, nodes).

        The tests of one earthquake count as one test, because their motions differ only in scale.
        """
        p, happened = self.probabilities, self.observed[:, None]
        terms = np.where(happened == 1.0, np.log(p), np.log(1.0 - p))
        terms = np.where(np.isfinite(happened), terms, 0.0)
        return np.array([terms[self._index == k].mean(axis=0) for k in range(self._index.max() + 1)])

    @cached_property
    def _index(self) -> IntArray:
        """Index of the earthquake of each test."""
        return np.unique(self.earthquakes, return_inverse=True)[1]

    def weights(self, prior: FurtherBody | None, *omitted: int) -> FloatArray:
        """Return the posterior probabilities of the nodes without omitted earthquakes; the default prior is flat."""
        used = np.ones(len(self.likelihood), dtype=bool)
        used[list(omitted)] = False
        logarithms = self.likelihood[used].sum(axis=0)
        if prior is not None:
            off = self.nodes[:, :2] - prior.mean
            logarithms = logarithms - 0.5 * np.einsum("ki,ij,kj->k", off, np.linalg.inv(prior.covariance), off)
        weights = np.exp(logarithms - logarithms.max())
        return np.asarray(weights / weights.sum())

    def slope(self, prior: FurtherBody, *omitted: int) -> float:
        """Return the calibration slope from predictions of each earthquake by all others, without omitted ones."""
        probability = np.full(len(self.observed), np.nan)
        for k in set(range(len(self.likelihood))) - {*omitted}:
            probability[self._index == k] = self.probabilities[self._index == k] @ self.weights(prior, k, *omitted)
        used = np.isfinite(probability) & np.isfinite(self.observed)
        return calibration_slope(probability[used], self.observed[used])

    def left_out(self, prior: FurtherBody) -> FloatArray:
        """Return the probability of each test from the tests of all other earthquakes."""
        probability = np.empty(len(self.observed))
        for k in range(len(self.likelihood)):
            out = self._index == k
            probability[out] = sharpened(self.probabilities[out] @ self.weights(prior, k), self.slope(prior, k))
        return probability

    def without(self, prior: FurtherBody) -> FloatArray:
        """Return the probability of each test from the prior alone."""
        off = self.nodes[:, :2] - prior.mean
        weights = np.exp(-0.5 * np.einsum("ki,ij,kj->k", off, np.linalg.inv(prior.covariance), off))
        return np.asarray(self.probabilities @ (weights / weights.sum()))

    def error(self, prior: FurtherBody) -> ModelError:
        """Return the model error of a further test of this body."""
        mean, covariance, scatter = self._moments(self.weights(prior))
        facts = {"tests": int(np.isfinite(self.observed).sum())}
        source = Message("{tests} tests of this body", facts)
        return FurtherBody(mean, covariance, scatter).error(source, self.slope(prior))

    def tested(self, name: str, kind: str) -> BodyEvidence:
        """Return the factors only from these tests, as evidence for further bodies."""
        mean, covariance, scatter = self._moments(self.weights(None))
        scored = np.isfinite(self.observed)
        count = np.unique(np.asarray(self.earthquakes)[scored]).size
        return BodyEvidence(name, kind, int(scored.sum()), int(count), mean, covariance, scatter)

    def _moments(self, weights: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Return mean and covariance of ln of the factors, and the mean square of the scatter."""
        nodes = self.nodes
        step = (_STEPS[1] - _STEPS[0]) * ORDERS
        within = np.tile(np.diag(step**2 / 12.0), (len(nodes), 1, 1))  # covariance within a cell of the grid
        with np.errstate(divide="ignore"):
            mean, covariance = mixed(np.log(weights), nodes[:, :2], within)
        return mean, covariance, float(weights @ nodes[:, 2] ** 2)


def calibration_slope(probability: FloatArray, outcome: FloatArray) -> float:
    """Return the factor on the log-odds of probabilities that fits outcomes best, with a normal prior around 1."""
    odds = logit(np.clip(probability, LEAST, 1.0 - LEAST))

    def gradient(slope: float) -> float:
        return float(odds @ (outcome - expit(slope * odds)) - (slope - 1.0) / SLOPE_DEVIATION**2)

    ends = 1.0 / STEEPEST_SLOPE, STEEPEST_SLOPE
    if gradient(ends[0]) <= 0.0 or gradient(ends[1]) >= 0.0:
        return ends[0] if gradient(ends[0]) <= 0.0 else ends[1]
    return float(brentq(gradient, *ends))


def _smoothed(logarithms: FloatArray, overturned: FloatArray, centres: FloatArray) -> FloatArray:
    """Return the probability of a test at each centre of the factors and each scatter; the scatter varies fastest."""
    valid = np.isfinite(overturned)
    sampled, fell = logarithms[valid], overturned[valid]
    proposal = 0.5 * (sampled**2 / np.array(WIDE.covariance).diagonal()).sum(axis=1)[:, None]
    estimate = np.full(len(centres), (fell.sum() + 0.5) / (fell.size + 1.0))
    estimates = []
    for scatter in SCATTERS[::-1].tolist():
        off = (sampled[:, None, :] - centres) / (scatter * ORDERS)
        exponent = proposal - 0.5 * (off**2).sum(axis=2)
        weights = np.exp(exponent - exponent.max(axis=0, initial=-np.inf))
        total = np.maximum(weights.sum(axis=0), 1e-300)
        effective = total**2 / np.maximum((weights**2).sum(axis=0), 1e-300)
        estimate = (effective * (fell @ weights) / total + estimate) / (effective + 1.0)
        estimates.append(estimate)
    return np.stack(estimates[::-1], axis=1).ravel()


def wide_samples(
    mechanics: SampledBodies, count: int, seed: int = 0, threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Return ln of the sampled factors and the outcomes of histories, one row per motion.

    The mechanics have the model error `WIDE`, and the count is a power of two.
    """
    rows = []
    for motion in range(len(mechanics.names)):
        rows.append(wide_sample(mechanics, motion, count, seed, threads))
        if progress is not None:
            progress(count)
    logarithms, overturned = zip(*rows, strict=True)
    return np.array(logarithms), np.array(overturned)


def wide_sample(
    mechanics: SampledBodies, motion: int, count: int, seed: int, threads: int | None
) -> tuple[FloatArray, FloatArray]:
    """Return ln of the sampled factors and the outcomes of histories under one motion."""
    draws = wide_draws(mechanics.widths, motion, count, seed)
    overturned = mechanics.run(draws, motion, np.ones(count), threads).overturning
    return np.log(mechanics.values(draws)["model_error"]), overturned


def wide_draws(widths: Mapping[str, int], motion: int, count: int, seed: int) -> FloatArray:
    """Return the sample points of a motion: equal shapes for all motions in another order, and new other inputs."""
    size = sum(widths.values())
    draws, shapes = scrambled_sobol(size, count, seed + 1 + motion), scrambled_sobol(size, count, seed)
    order, column = np.random.default_rng([seed, motion]).permutation(count), 0
    for name, width in widths.items():
        if name not in OF_HISTORY:
            draws[:, column : column + width] = shapes[order, column : column + width]
        column += width
    return draws
