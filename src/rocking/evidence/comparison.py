"""How well models agree with measurements, and the one rule that compares two: a paired bootstrap of their errors.

Rows of one block, or of one pair of materials in Table 1, are not independent (pseudo-replication): what is drawn
again is the specimen with all its rows, within its data set. Both models meet the same draws (Efron & Tibshirani 1993).
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
FEWEST = 5  # specimens; of four that agree, one in eight does so by chance

MEASURES: dict[str, Callable[[FloatArray], FloatArray]] = {
    "r": lambda r: r,
    "absolute error of the loss": lambda r: r**2,
    "relative error of the loss": lambda r: np.log1p(-(r**2)),
}
"""What is compared: root mean square differences of these functions of r."""


@dataclass(frozen=True, slots=True)
class Difference:
    """A difference, and its 95 % bootstrap interval."""

    value: float  # value, low, high: the difference and the ends of its interval
    low: float
    high: float

    @classmethod
    def of(cls, values: FloatArray) -> "Difference":
        """Return it from its value and those of the resamples."""
        return cls(float(values[0]), *np.quantile(values[1:], [0.025, 0.975]).tolist())

    @property
    def sign(self) -> int:
        """1 where the interval is above zero, -1 where it is below, 0 where it includes zero."""
        return int(self.low > 0.0) - int(self.high < 0.0)

    def __str__(self) -> str:
        return f"{self.value:+.4f} ({self.low:+.4f} to {self.high:+.4f})"


@dataclass(frozen=True, slots=True)
class Comparison(Difference):
    """Error of one model minus that of another, the interval of a paired bootstrap: infinite from few specimens."""

    first: float  # first, second: root mean square errors [-]
    second: float
    by_group: "dict[str, Comparison]"  # the same within each data set

    def sentence(self, one: str, other: str) -> str:
        numbers = (
            f"{self.first:.4f} for {one} against {self.second:.4f} for {other}, difference "
            f"{self.value:+.4f}, 95 % interval {self.low:+.4f} to {self.high:+.4f}"
        )
        outcome = {-1: f"{one} is closer", 0: "not resolved", 1: f"{other} is closer"}
        groups = "; ".join(
            f"{'Table 1' if name == 'table1' else name}: {outcome[each.sign]}" for name, each in self.by_group.items()
        )
        return f"{outcome[self.sign]} ({numbers}{'; by group: ' if groups else ''}{groups})"


def compare(data: DataSet, one: FloatArray, other: FloatArray, measure: str = "r") -> Comparison:
    """Compare the predictions of two models; to exchange them changes the signs and nothing else."""
    of = MEASURES[measure]
    with np.errstate(divide="ignore"):
        squares = [(of(np.asarray(r)) - of(data.coefficient)) ** 2 for r in (one, other)]
    names = tuple(dict.fromkeys(data.group))
    groups = {name: np.array([group == name for group in data.group]) for name in names} if len(names) > 1 else {}
    return _compared(squares, drawn(data), {name: (rows, drawn(data.rows(rows))) for name, rows in groups.items()})


def _compared(
    squares: list[FloatArray], weight: FloatArray, groups: dict[str, tuple[FloatArray, FloatArray]]
) -> Comparison:
    first, second = (float(np.sqrt(each.mean())) for each in squares)
    one, other = (resampled(each, weight) for each in squares)
    with np.errstate(invalid="ignore"):
        low, high = np.nanquantile(one - other, [0.025, 0.975]).tolist()
    if len({column.tobytes() for column in weight.T}) < FEWEST:
        low, high = -np.inf, np.inf
    by_group = {name: _compared([each[rows] for each in squares], own, {}) for name, (rows, own) in groups.items()}
    return Comparison(first - second, low, high, first, second, by_group)


def errors_of_groups(
    model: RestitutionModel, one: str, other: str, against: RestitutionModel | None = None
) -> Difference:
    """Return how much larger a model's RMSE of r is in one group of blocks than in another, drawn independently."""
    data = blocks()
    weight, group = np.vstack([np.ones(len(data)), drawn(data)]), np.array(data.group)
    error = np.zeros((2, len(weight)))
    for sign, each in ((1.0, model), (-1.0, against)):
        if each is not None:
            squares = (each.of_slenderness(data.slenderness) - data.coefficient) ** 2
            error += [sign * resampled(squares, weight * (group == name)) for name in (one, other)]
    return Difference.of(error[0] - error[1])


def resampled(squares: FloatArray, weight: FloatArray) -> FloatArray:
    """Return root mean squares of the resamples."""
    # a sum and no product of matrices: the same on every processor
    return np.asarray(np.sqrt((weight * squares).sum(axis=1) / weight.sum(axis=1)))  # Eq. 139


def drawn(data: DataSet) -> FloatArray:
    """Return how often each row is in each resample: specimens drawn within their data sets, by a fixed seed."""
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
    """Mean of model minus experiment, positive where the model is too elastic [-]."""
    return float(np.mean(model - measured))


def correlation(model: FloatArray, measured: FloatArray) -> float:
    """Pearson's correlation coefficient, blind to bias and scale; NaN if the model is constant."""
    dm, de = model - model.mean(), measured - measured.mean()
    scale = float(np.sqrt((dm @ dm) * (de @ de)))
    return float(dm @ de) / scale if scale > 0.0 else float("nan")


def rank_correlation(one: FloatArray, other: FloatArray) -> tuple[float, float]:
    """Spearman's rank correlation, and the probability of one as far from zero by chance, by Student's t."""
    from scipy.special import stdtr

    rho = correlation(_ranks(one), _ranks(other))
    freedom = one.size - 2
    return rho, float(2.0 * stdtr(freedom, -abs(rho) * np.sqrt(freedom / max((1.0 + rho) * (1.0 - rho), 1e-300))))


def _ranks(values: FloatArray) -> FloatArray:
    """Ranks from 1 on; equal values share the mean of theirs."""
    _, place, count = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(count) - 0.5 * (count - 1))[place]


def concordance(model: FloatArray, measured: FloatArray) -> float:
    """Lin's concordance (Biometrics 45, 1989): correlation that also pays for bias and scale."""
    covariance = float(np.mean((model - model.mean()) * (measured - measured.mean())))
    return 2.0 * covariance / float(model.var() + measured.var() + (model.mean() - measured.mean()) ** 2)


def loss_rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square error of the energy loss 1 - r^2 [-]."""
    return rmse(model**2, measured**2)


def log_loss_rmse(model: FloatArray, measured: FloatArray) -> float:
    """Root mean square of ln((1 - r_model^2) / (1 - r_measured^2)): relative error of the loss, .1 is about 10 %."""
    with np.errstate(divide="ignore"):
        return rmse(np.log1p(-(model**2)), np.log1p(-(measured**2)))


def relative_error(model: FloatArray, measured: FloatArray) -> FloatArray:
    """Relative error as the paper defines it, |measured - model| / measured [-]."""
    return np.asarray(np.abs(measured - model) / measured)


def zone(error: FloatArray) -> list[str]:
    """Sort relative errors into the paper's zones: I below 1 %, II to 5 %, III above.

    >>> zone(np.array([0.005, 0.03, 0.2]))
    ['I', 'II', 'III']
    """
    return ["I" if e < 0.01 else "II" if e < 0.05 else "III" for e in error.tolist()]
