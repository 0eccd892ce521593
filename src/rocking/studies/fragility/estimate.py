"""One curve found in the data: its coefficients in a scale near one, what they mean, and their standard errors."""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.studies.fragility.counts import Counts
from rocking.studies.fragility.likelihood import Probit
from rocking.studies.fragility.maximum import maximise_from
from rocking.studies.fragility.penalised import PenalisedProbit, starts
from rocking.studies.fragility.separation import Separation, classify


@dataclass(frozen=True)
class LogScale:
    """From logarithms of levels to numbers near one: u = (ln level - center) / spread."""

    center: float  # center, spread: mean and standard deviation of the logarithms over the trials [-]
    spread: float

    @classmethod
    def of(cls, counts: Counts) -> "LogScale":
        """Return the scale of some data."""
        logarithm = np.log(counts.levels)
        center = float(np.average(logarithm, weights=counts.trials))
        return cls(center, float(np.sqrt(np.average((logarithm - center) ** 2, weights=counts.trials))))

    def position(self, levels: FloatArray) -> FloatArray:
        """Return u.

        levels: levels, > 0 [any unit]. Returns their positions [-].
        """
        return (np.log(levels) - self.center) / self.spread  # Eq. 191

    def log_level(self, position: FloatArray) -> FloatArray:
        """Return the logarithms of levels.

        position: u [-]. Returns ln level [-].
        """
        return self.center + self.spread * position


@dataclass(frozen=True, eq=False)
class FittedCurves:
    """Curves Phi(a + b u) found in many data sets of the same levels."""

    theta: FloatArray  # rows of a and b; NaN where there is no rising curve [-]
    curvature: FloatArray  # observed information of each [-]
    value: FloatArray  # log likelihood of each, penalised where that was maximised [-]
    found: BoolArray  # whether a rising curve was found and proven to be a maximum
    penalised: BoolArray  # whether the penalised likelihood was maximised
    separation: IntArray  # `Separation.number` of each data set


def find_curves(
    levels: FloatArray, scale: LogScale, failures: FloatArray, trials: FloatArray, *, penalised: bool = False
) -> FittedCurves:
    """Return the likeliest curves of many data sets; of those with a step, the penalised one.

    levels: distinct levels, ascending [any unit]; failures, trials: one row a data set, one column a level [-].
    """
    kinds = classify(levels, failures, trials)
    step = np.isin(kinds, [kind.number for kind in Separation if kind.step])
    overlap = kinds == Separation.OVERLAP.number
    count = kinds.size
    firth = (overlap | step) if penalised else step
    theta, value = np.full((count, 2), np.nan), np.full(count, np.nan)
    curvature, found = np.full((count, 2, 2), np.nan), np.zeros(count, dtype=bool)
    position = scale.position(levels)[None]
    for model, which in ((Probit, overlap & ~firth), (PenalisedProbit, firth)):
        start = np.zeros((1, 2)) if model.concave else starts(position[0])
        for rows in _pieces(np.flatnonzero(which), levels.size * len(start)):
            data = model(position, failures[rows], trials[rows] - failures[rows])
            best = maximise_from(data, np.repeat(start[:, None], rows.size, axis=1))
            theta[rows], curvature[rows], value[rows] = best.theta, best.curvature, best.value
            found[rows] = best.proven & (best.theta[:, 1] > 0.0)
    theta[~found] = np.nan
    return FittedCurves(theta, curvature, value, found, firth, kinds)


def _pieces(rows: IntArray, width: int) -> list[IntArray]:
    """Return the rows in pieces that keep an array below a few megabytes."""
    size = max(1, 400_000 // width)
    return [rows[start : start + size] for start in range(0, rows.size, size)]


def log_fractile(theta: FloatArray, scale: LogScale, variate: float | FloatArray) -> FloatArray:
    """Return the logarithm of the level where curves reach a probability.

    theta: rows of a and b [-]; variate: standard normal variate of the probability [-]. Returns ln level [-].
    """
    return scale.log_level((variate - theta[:, 0]) / theta[:, 1])  # Eq. 192


def log_dispersion(theta: FloatArray, scale: LogScale) -> FloatArray:
    """Return the logarithm of the dispersion of curves.

    theta: rows of a and b, b > 0 [-]. Returns ln beta [-].
    """
    return np.log(scale.spread / theta[:, 1])  # Eq. 193


def standard_errors(theta: FloatArray, curvature: FloatArray, scale: LogScale, variate: float | None) -> FloatArray:
    """Return the standard errors of a logarithmic fractile or of the logarithmic dispersion.

    theta: rows of a and b [-]; curvature: their observed information [-]; variate: standard normal variate of the
    fractile; the dispersion without [-]. Returns standard errors [-].
    """
    a, b = theta[:, 0], theta[:, 1]
    if variate is None:
        slope = np.stack([np.zeros_like(b), -1.0 / b], axis=1)
    else:
        slope = scale.spread * np.stack([-1.0 / b, (a - variate) / b**2], axis=1)
    return quadratic_error(slope, curvature)


def quadratic_error(slope: FloatArray, curvature: FloatArray) -> FloatArray:
    """Return the standard errors of functions of the coefficients (delta method).

    slope: rows of derivatives with respect to a and b [-]; curvature: observed information, one matrix a row [-].
    Returns standard errors [-].
    """
    h = curvature
    determinant = h[:, 0, 0] * h[:, 1, 1] - h[:, 0, 1] ** 2
    first, second = slope[:, 0], slope[:, 1]
    form = h[:, 1, 1] * first**2 - 2.0 * h[:, 0, 1] * first * second + h[:, 0, 0] * second**2
    return np.asarray(np.sqrt(form / determinant))  # Eq. 207
