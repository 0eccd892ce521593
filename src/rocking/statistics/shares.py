"""Contributions of inputs to the variance of a result: Sobol indices by Saltelli's design."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.statistics.sobol import MOST, scrambled_sobol

REPETITIONS = 1000  # bootstrap samples of an interval


@dataclass(frozen=True)
class VarianceShare:
    """Contribution of one input to the variance of a result [-], with 95 % intervals."""

    first: float  # first-order index: reduction of the variance if this input were known
    first_low: float
    first_high: float
    total: float  # total index: remaining variance if all other inputs were known
    total_low: float
    total_high: float


@dataclass(frozen=True, eq=False)
class SaltelliDesign:
    """Points of the unit cube for a result: two samples, and one mixture of both samples per input."""

    count: int  # number of points per sample, a power of two
    inputs: Mapping[str, int]  # number of dimensions by input
    seed: int = 0  # seed of the scrambled Sobol sequence

    def __post_init__(self) -> None:
        count = checks.whole("count", self.count, 2, 1 << 24)
        if count & (count - 1):
            near = 1 << count.bit_length()
            raise InvalidValueError(
                "{parameter} must be a power of two, such as {below} or {above}, got {value}", parameter="count",
                value=count, below=near // 2, above=near,
            )  # fmt: skip
        checks.whole("numbers that the inputs take", sum(self.inputs.values()), 0, MOST // 2)

    @property
    def points(self) -> FloatArray:
        """Both samples, followed for every input by the first sample with this input taken from the second sample."""
        size = sum(self.inputs.values())
        if not size:
            return np.empty((2 * self.count, 0))
        samples = scrambled_sobol(2 * size, self.count, self.seed)
        first, second = samples[:, :size], samples[:, size:]
        mixed, at = [], 0
        for width in self.inputs.values():
            mixture = first.copy()
            mixture[:, at : at + width] = second[:, at : at + width]
            mixed.append(mixture)
            at += width
        return np.vstack([first, second, *mixed])

    def shares(self, answers: FloatArray, repetitions: int = REPETITIONS) -> dict[str, VarianceShare]:
        """Return the contributions of the inputs; all zero if there is no variance."""
        # First-order indices use Saltelli's estimator (2010), which is exactly zero for an input without effect. Total
        # indices use Jansen's estimator (1999). Intervals result from resampling the points.
        # answers: results at `points`; several columns, such as motions, are an additional input, `case`; points
        # without a result (NaN) are omitted
        results = np.asarray(answers, dtype=np.float64)
        results = results[:, None] if results.ndim == 1 else results
        rows = (2 + len(self.inputs)) * self.count
        if results.ndim != 2 or len(results) != rows:
            raise InvalidValueError(
                "{parameter} must have one value for each of the {points} points, got shape {shape}",
                parameter="answers",
                points=rows, shape=results.shape,
            )  # fmt: skip
        stacked = results.reshape(2 + len(self.inputs), self.count, -1)
        stacked = stacked[:, ~np.isnan(stacked).any(axis=(0, 2))]
        random, kept = np.random.default_rng(self.seed), stacked.shape[1]
        if not kept:
            raise InvalidValueError("no point of the design has a complete set of results")
        samples = random.multinomial(kept, np.full(kept, 1.0 / kept), size=checks.whole("repetitions", repetitions, 1))
        weights = np.vstack([np.ones(kept), samples]) / kept
        names = [*self.inputs, *(["case"] if stacked.shape[2] > 1 else [])]
        return {
            name: VarianceShare(
                *(float(v) for pair in estimates for v in (pair[0], *np.quantile(pair[1:], (0.025, 0.975))))
            )
            for name, estimates in zip(names, _estimates(stacked, weights), strict=True)
        }


def _estimates(stacked: FloatArray, weights: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """Return first-order and total indices of all inputs and of the case, for every row of weights."""
    first, second, mixed = stacked[0], stacked[1], stacked[2:]
    mean = weights @ (0.5 * (first + second).mean(axis=1))
    variance = weights @ (0.5 * (first**2 + second**2).mean(axis=1)) - mean**2
    middle = stacked.mean(axis=2)  # mean over the cases
    scale = np.where(variance > 1e-12 * (1.0 + mean**2), variance, np.inf)
    indices = []
    for k, mixture in enumerate(mixed):
        step = middle[2 + k] - middle[0]
        alone = weights @ (middle[1] * step) - mean * (weights @ step)  # Eq. 262
        indices.append((alone / scale, weights @ (0.5 * ((first - mixture) ** 2).mean(axis=1)) / scale))  # Eq. 263
    if stacked.shape[2] > 1:
        alone = ((weights @ first) * (weights @ second)).mean(axis=1)
        alone -= (weights @ middle[0]) * (weights @ middle[1])
        within = weights @ (0.5 * (first.var(axis=1) + second.var(axis=1)))
        indices.append((alone / scale, within / scale))
    return indices
