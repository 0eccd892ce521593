"""Errors of models on measurements, and comparison of two models by a paired bootstrap of their errors.

Rows of one block, or of one pair of materials in Table 1, are not independent (pseudo-replication). The bootstrap
resamples specimens with all their rows, within data sets. Both models have the same samples (Efron & Tibshirani 1993).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rocking.conventions import FloatArray
from rocking.evidence.measurements import DataSet, blocks
from rocking.restitution import RestitutionModel

_RESAMPLES = 4000
_SEED = 20240710
FEWEST = 5  # minimum number of specimens; four specimens agree by chance with probability 1/8

MEASURES: dict[str, Callable[[FloatArray], FloatArray]] = {
    "r": lambda r: r,
    "absolute error of the loss": lambda r: r**2,
    "relative error of the loss": lambda r: np.log1p(-(r**2)),
}
"""Functions of r for the root mean square differences."""


@dataclass(frozen=True, slots=True)
class Difference:
    """A difference, and its 95 % bootstrap interval."""

    value: float  # value, low, high: the difference and the ends of its interval
    low: float
    high: float

    @classmethod
    def of(cls, values: FloatArray) -> "Difference":
        """Return the difference with its interval, from its value and the values of the resamples."""
        return cls(float(values[0]), *np.quantile(values[1:], [0.025, 0.975]).tolist())

    @property
    def sign(self) -> int:
        """1 if the interval is above zero, -1 if it is below, 0 if it includes zero."""
        return int(self.low > 0.0) - int(self.high < 0.0)

    def __str__(self) -> str:
        return f"{self.value:+.4f} ({self.low:+.4f} to {self.high:+.4f})"


@dataclass(frozen=True, slots=True)
class Comparison(Difference):
    """Error of a model minus error of another model; the paired bootstrap interval is infinite for few specimens."""

    first: float  # first, second: root mean square errors [-]
    second: float
    by_group: "dict[str, Comparison]"  # comparisons within the data sets

    def sentence(self, first_name: str, second_name: str) -> str:
        numbers = (
            f"{self.first:.4f} for {first_name} against {self.second:.4f} for {second_name}, difference "
            f"{self.value:+.4f}, 95 % interval {self.low:+.4f} to {self.high:+.4f}"
        )
        outcome = {-1: f"{first_name} is closer", 0: "not resolved", 1: f"{second_name} is closer"}
        groups = "; ".join(
            f"{'Table 1' if name == 'table1' else name}: {outcome[comparison.sign]}"
            for name, comparison in self.by_group.items()
        )
        return f"{outcome[self.sign]} ({numbers}{'; by group: ' if groups else ''}{groups})"


def compare(data: DataSet, first: FloatArray, second: FloatArray, measure: str = "r") -> Comparison:
    """Compare the predictions of two models. An exchange of the models changes only the signs."""
    transform = MEASURES[measure]
    with np.errstate(divide="ignore"):
        squares = [(transform(np.asarray(r)) - transform(data.coefficient)) ** 2 for r in (first, second)]
    names = tuple(dict.fromkeys(data.group))
    groups = {name: np.array([group == name for group in data.group]) for name in names} if len(names) > 1 else {}
    return _compared(squares, drawn(data), {name: (rows, drawn(data.rows(rows))) for name, rows in groups.items()})


def _compared(
    squares: list[FloatArray], weight: FloatArray, groups: dict[str, tuple[FloatArray, FloatArray]]
) -> Comparison:
    first, second = (float(np.sqrt(errors.mean())) for errors in squares)
    first_errors, second_errors = (resampled(errors, weight) for errors in squares)
    with np.errstate(invalid="ignore"):
        low, high = np.nanquantile(first_errors - second_errors, [0.025, 0.975]).tolist()
    if len({column.tobytes() for column in weight.T}) < FEWEST:
        low, high = -np.inf, np.inf
    by_group = {
        name: _compared([errors[rows] for errors in squares], group_weight, {})
        for name, (rows, group_weight) in groups.items()
    }
    return Comparison(first - second, low, high, first, second, by_group)


def errors_of_groups(
    model: RestitutionModel, first_group: str, second_group: str, reference: RestitutionModel | None = None
) -> Difference:
    """Return the difference of a model's RMSE of r between two groups of blocks, resampled independently."""
    data = blocks()
    weight, group = np.vstack([np.ones(len(data)), drawn(data)]), np.array(data.group)
    error = np.zeros((2, len(weight)))
    for sign, signed_model in ((1.0, model), (-1.0, reference)):
        if signed_model is not None:
            squares = (signed_model.of_slenderness(data.slenderness) - data.coefficient) ** 2
            error += [sign * resampled(squares, weight * (group == name)) for name in (first_group, second_group)]
    return Difference.of(error[0] - error[1])


def resampled(squares: FloatArray, weight: FloatArray) -> FloatArray:
    """Return root mean squares of the resamples."""
    # a sum in place of a matrix product gives equal results on all processors
    return np.asarray(np.sqrt((weight * squares).sum(axis=1) / weight.sum(axis=1)))  # Eq. 139


def drawn(data: DataSet) -> FloatArray:
    """Return the multiplicity of each row in each resample of specimens within data sets, with a fixed seed."""
    return _drawn(data.group, data.labels)


@lru_cache(maxsize=32)
def _drawn(group: tuple[str, ...], label: tuple[str, ...]) -> FloatArray:
    random, weight = np.random.default_rng(_SEED), np.zeros((_RESAMPLES, len(group)))
    for name in dict.fromkeys(group):
        rows = [i for i in range(len(group)) if group[i] == name]
        specimens = list(dict.fromkeys(label[i] for i in rows))
        count = random.multinomial(len(specimens), np.full(len(specimens), 1.0 / len(specimens)), size=_RESAMPLES)
        weight[:, rows] = count[:, [specimens.index(label[i]) for i in rows]]
    return weight


def rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square error of r [-]."""
    return float(np.sqrt(np.mean((model - measured) ** 2)))


def bias(model: FloatArray, measured: FloatArray) -> float:
    """Mean of model minus experiment, positive for a too elastic model [-]."""
    return float(np.mean(model - measured))


def correlation(model: FloatArray, measured: FloatArray) -> float:
    """Pearson's correlation coefficient, independent of bias and scale; NaN if the model is constant."""
    dm, de = model - model.mean(), measured - measured.mean()
    scale = float(np.sqrt((dm @ dm) * (de @ de)))
    return float(dm @ de) / scale if scale > 0.0 else float("nan")


def rank_correlation(first: FloatArray, second: FloatArray) -> tuple[float, float]:
    """Return Spearman's rank correlation, and its p-value by Student's t."""
    from scipy.special import stdtr

    rho = correlation(_ranks(first), _ranks(second))
    freedom = first.size - 2
    return rho, float(2.0 * stdtr(freedom, -abs(rho) * np.sqrt(freedom / max((1.0 + rho) * (1.0 - rho), 1e-300))))


def _ranks(values: FloatArray) -> FloatArray:
    """Return ranks from 1; equal values have their mean rank."""
    _, index, count = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(count) - 0.5 * (count - 1))[index]


def concordance(model: FloatArray, measured: FloatArray) -> float:
    """Lin's concordance (Biometrics 45, 1989), a correlation with penalties for bias and scale."""
    covariance = float(np.mean((model - model.mean()) * (measured - measured.mean())))
    return 2.0 * covariance / float(model.var() + measured.var() + (model.mean() - measured.mean()) ** 2)


def loss_rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square error of the energy loss 1 - r^2 [-]."""
    return rmse(model**2, measured**2)


def log_loss_rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square of ln((1 - r_model^2) / (1 - r_measured^2)), about the relative error of the energy loss."""
    with np.errstate(divide="ignore"):
        return rmse(np.log1p(-(model**2)), np.log1p(-(measured**2)))


def relative_error(model: FloatArray, measured: FloatArray) -> FloatArray:
    """Relative error by the definition of the paper, |measured - model| / measured [-]."""
    return np.asarray(np.abs(measured - model) / measured)


def zone(error: FloatArray) -> list[str]:
    """Sort relative errors into the zones of the paper: I below 1 %, II from 1 to 5 %, III above 5 %.

    >>> zone(np.array([0.005, 0.03, 0.2]))
    ['I', 'II', 'III']
    """
    return ["I" if e < 0.01 else "II" if e < 0.05 else "III" for e in error.tolist()]
