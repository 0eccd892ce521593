"""What share of an answer's variance each of its inputs explains: Sobol indices, by Saltelli's design."""

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
    """Share of the variance of an answer that one input explains, with 95 % intervals [-]."""

    first: float  # first-order index: what would go if this input alone were known
    first_low: float
    first_high: float
    total: float  # total index: what would stay if everything but this input were known
    total_low: float
    total_high: float


@dataclass(frozen=True, eq=False)
class SaltelliDesign:
    """Points of the unit cube at which an answer is asked: two samples, and mixtures of them for every input."""

    count: int  # points of either sample, a power of two
    inputs: Mapping[str, int]  # how many numbers from 0 to 1 each input takes
    seed: int = 0  # of the scrambled Sobol sequence

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
        """The two samples one after the other, then for each input the first sample with that input of the second."""
        size = sum(self.inputs.values())
        if not size:
            return np.empty((2 * self.count, 0))
        both = scrambled_sobol(2 * size, self.count, self.seed)
        first, second = both[:, :size], both[:, size:]
        mixed, at = [], 0
        for width in self.inputs.values():
            one = first.copy()
            one[:, at : at + width] = second[:, at : at + width]
            mixed.append(one)
            at += width
        return np.vstack([first, second, *mixed])

    def shares(self, answers: FloatArray, repetitions: int = REPETITIONS) -> dict[str, VarianceShare]:
        """Return the shares of the inputs, all zero where nothing varies."""
        # First-order indices by Saltelli's estimator (2010), exactly zero where an input does nothing, total ones by
        # Jansen's (1999); intervals by drawing the points again. answers: what was found at `points`; with several
        # columns, such as motions, which of them it is counts as one input more, `case`. A point without an answer,
        # NaN, is left out.
        found = np.asarray(answers, dtype=np.float64)
        found = found[:, None] if found.ndim == 1 else found
        rows = (2 + len(self.inputs)) * self.count
        if found.ndim != 2 or len(found) != rows:
            raise InvalidValueError(
                "{parameter} must be one for each of {points} points, got shape {shape}", parameter="answers",
                points=rows, shape=found.shape,
            )  # fmt: skip
        stacked = found.reshape(2 + len(self.inputs), self.count, -1)
        stacked = stacked[:, ~np.isnan(stacked).any(axis=(0, 2))]
        random, kept = np.random.default_rng(self.seed), stacked.shape[1]
        if not kept:
            raise InvalidValueError("no point of the design has all its answers")
        drawn = random.multinomial(kept, np.full(kept, 1.0 / kept), size=checks.whole("repetitions", repetitions, 1))
        weights = np.vstack([np.ones(kept), drawn]) / kept
        names = [*self.inputs, *(["case"] if stacked.shape[2] > 1 else [])]
        return {
            name: VarianceShare(*(float(v) for pair in both for v in (pair[0], *np.quantile(pair[1:], (0.025, 0.975)))))
            for name, both in zip(names, _estimates(stacked, weights), strict=True)
        }


def _estimates(stacked: FloatArray, weights: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """First-order and total indices of every input, then of the case, for each row of weights."""
    first, second, mixed = stacked[0], stacked[1], stacked[2:]
    mean = weights @ (0.5 * (first + second).mean(axis=1))
    variance = weights @ (0.5 * (first**2 + second**2).mean(axis=1)) - mean**2
    middle = stacked.mean(axis=2)  # over the cases
    scale = np.where(variance > 1e-12 * (1.0 + mean**2), variance, np.inf)
    found = []
    for k, one in enumerate(mixed):
        step = middle[2 + k] - middle[0]
        alone = weights @ (middle[1] * step) - mean * (weights @ step)  # Eq. 262
        found.append((alone / scale, weights @ (0.5 * ((first - one) ** 2).mean(axis=1)) / scale))  # Eq. 263
    if stacked.shape[2] > 1:
        alone = ((weights @ first) * (weights @ second)).mean(axis=1)
        alone -= (weights @ middle[0]) * (weights @ middle[1])
        within = weights @ (0.5 * (first.var(axis=1) + second.var(axis=1)))
        found.append((alone / scale, within / scale))
    return found
