"""Maximum-likelihood curves with proof of the maximum, and sentences on the existence of curves."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from typing import Any, Protocol, Self

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.messages import Message
from rocking.statistics.counts import Counts
from rocking.statistics.probit import Derivatives, PenalisedProbit, Probit, starts, tails

FLATNESS = 1e-13  # smaller relative trends are rounding [-]
LEVEL = 0.95  # confidence level of the bounds in a verdict [-]


class Separation(Enum):
    """Arrangement of failures and survivals along the levels. The values are sentences for users."""

    OVERLAP = (
        "failures and survivals overlap, and failures increase with the level: the maximum-likelihood curve exists"
    )
    COMPLETE = "complete separation: all survived up to one level and all failed from the next: any step between fits"
    QUASI_COMPLETE = "quasi-complete separation: all survived below one level and all failed above it"
    NONE_FAILED = "no failures: the curve lies above the levels"
    ALL_FAILED = "no survivals: the curve lies below the levels"
    SINGLE_LEVEL = "one level only: the dispersion is undetermined"
    FLAT = "failures do not depend on the level: the dispersion would be infinite"
    DECREASING = "failures decrease with the level: no lognormal fragility in this measure"
    DECREASING_SEPARATED = "all failed below one level and survived above it: no lognormal fragility in this measure"

    @cached_property
    def number(self) -> int:
        """Index in the order of definition, as returned by `classify`."""
        return list(Separation).index(self)

    @property
    def step(self) -> bool:
        """True if the likelihood increases towards a step at a level (dispersion 0)."""
        return self in {Separation.COMPLETE, Separation.QUASI_COMPLETE}


def classify(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> IntArray:
    """Return the indices of the separation of many data sets, one row per data set, along ascending levels."""
    failed, survived = failures > 0.0, trials > failures
    last = levels.size - 1
    first_failed, last_failed = np.argmax(failed, axis=1), last - np.argmax(failed[:, ::-1], axis=1)
    first_survived, last_survived = np.argmax(survived, axis=1), last - np.argmax(survived[:, ::-1], axis=1)
    trend, largest = _trend(levels, failures, trials)
    # the first true condition applies
    cases = (
        (Separation.NONE_FAILED, ~failed.any(axis=1)),
        (Separation.ALL_FAILED, ~survived.any(axis=1)),
        (Separation.SINGLE_LEVEL, (trials > 0.0).sum(axis=1) == 1),
        (Separation.COMPLETE, last_survived < first_failed),  # Eq. 200
        (Separation.QUASI_COMPLETE, last_survived == first_failed),  # Eq. 200
        (Separation.DECREASING_SEPARATED, last_failed <= first_survived),
        (Separation.FLAT, np.abs(trend) <= FLATNESS * largest),
        (Separation.DECREASING, trend < 0.0),
    )
    conditions, numbers = [condition for _, condition in cases], [kind.number for kind, _ in cases]
    return np.select(conditions, numbers, Separation.OVERLAP.number).astype(np.int64)


def separation_of(counts: Counts) -> Separation:
    """Return the separation of one data set.

    >>> from rocking.statistics.counts import count_outcomes
    >>> separation_of(count_outcomes([0.1, 0.2, 0.3, 0.4], [0, 0, 1, 1])).name
    'COMPLETE'
    """
    return list(Separation)[int(classify(counts.levels, counts.failures[None], counts.trials[None])[0])]


def median_interval(counts: Counts, separation: Separation) -> tuple[float | None, float | None]:
    """Return `LognormalFit.median_interval` of outcomes."""
    survived, failed = counts.levels[counts.survivals > 0.0], counts.levels[counts.failures > 0.0]
    if separation is Separation.NONE_FAILED:
        return float(survived[-1]), None
    if separation is Separation.ALL_FAILED:
        return None, float(failed[0])
    return (float(survived[-1]), float(failed[0])) if separation.step else (None, None)


def _trend(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the score at slope zero, which has the sign of the slope, and its largest possible value."""
    u = np.log(levels / levels[0])
    total = np.maximum(trials.sum(axis=1), 1.0)
    distance = u - ((trials @ u) / total)[:, None]
    return np.sum(failures * distance, axis=1), np.sum(trials * np.abs(distance), axis=1)  # Eq. 201


_NO_CURVE = "{outcomes} give no curve: the maximum-likelihood curve rises too little and has no median."
_MAXIMUM = "{outcomes} give median {median}, dispersion {dispersion:.3g}: a proven maximum of the likelihood."
_PENALISED = (
    "{outcomes} give median {median}, dispersion {dispersion:.3g}: the highest computed maximum of the penalised "
    "likelihood."
)
_STEP_BETWEEN = (
    "{outcomes} have no maximum-likelihood curve: the likelihood increases towards a step between {low} and {high}, "
    "with dispersion 0."
)
_STEP_AT = (
    "{outcomes} have no maximum-likelihood curve: the likelihood increases towards a step at {low}, with dispersion 0."
)
_CONVENTION = "The penalised likelihood gives median {median}, dispersion {dispersion:.3g}: a convention, not a result."
_NONE_FAILED = (
    "At {level} 0 of {trials:g} failed: the probability of failure is below {probability:.3g} (confidence "
    "{confidence})."
)
_NONE_SURVIVED = (
    "At {level} 0 of {trials:g} survived: the probability of failure is above {probability:.3g} (confidence "
    "{confidence})."
)


def verdict_of(
    counts: Counts, separation: Separation, curve: tuple[float, float] | None, rise: float | None,
    level: Callable[..., str], *, clusters: bool,
) -> str:  # fmt: skip
    """Return the conclusions from the outcomes and the limits of the likelihood as sentences."""
    # curve: median and dispersion
    # rise: likelihood ratio of the curve against a line that does not depend on the level, a chi-square variable of one
    # degree of freedom; None for a penalised fit
    # level: function that writes a level with its unit
    parts = [_finding(counts, separation, curve, level, penalised=rise is None)]
    if rise is not None and rise < 3.841:
        parts.append("The increase with the level is not significant (5 % test): intervals may be open.")
    if clusters and curve is not None and counts.is_clustered:
        parts.append(_clustered(counts))
    return Message.joined(parts)


def _clustered(counts: Counts) -> str:
    if counts.scarcity:
        return Message(
            "The intervals are from the likelihood and may be much too narrow, because the outcomes of one cluster are "
            "treated as independent. The number of clusters is too small for a bootstrap of clusters ({reason}).",
            {"reason": counts.scarcity},
        )
    if counts.draws_capacities:
        return (
            "Outcomes of one cluster are not independent: intervals are from the bootstrap with a sampled capacity per "
            "cluster; likelihood intervals would be too narrow."
        )
    return (
        "Outcomes of one cluster are not independent: intervals are from the bootstrap of whole clusters; likelihood "
        "intervals would be too narrow."
    )


def _finding(
    counts: Counts, separation: Separation, curve: tuple[float, float] | None, level: Callable[..., str],
    *, penalised: bool,
) -> str:  # fmt: skip
    levels, sentence = counts.levels, f"{separation.value[0].upper()}{separation.value[1:]}."
    facts: dict[str, Any] = {"outcomes": counts.observations, "count": levels.size}
    size = Message("{outcomes} outcomes at {count} level", facts, "{outcomes} outcomes at {count} levels")
    facts = {"outcomes": size}
    if curve is not None:
        facts |= {"median": level(curve[0], 4), "dispersion": curve[1]}
    if separation is Separation.OVERLAP:
        return Message(_NO_CURVE if curve is None else _PENALISED if penalised else _MAXIMUM, facts)
    if separation.step:
        low, high = levels[counts.survivals > 0.0][-1], levels[counts.failures > 0.0][0]
        step = Message(_STEP_BETWEEN if high > low else _STEP_AT, {**facts, "low": level(low), "high": level(high)})
        return Message.joined([sentence, step, Message(_CONVENTION, facts) if curve else ""])
    if separation in {Separation.NONE_FAILED, Separation.ALL_FAILED}:
        return Message.joined([sentence, _bound(counts, separation, level), "No curve is fitted."])
    return Message.joined([sentence, Message("No curve is fitted to {outcomes}.", facts)])


def _bound(counts: Counts, separation: Separation, level: Callable[..., str]) -> str:
    none = separation is Separation.NONE_FAILED
    index = -1 if none else 0
    trials = counts.trials[index]
    # one-sided Clopper-Pearson bound for 0 failures, about 3 / trials for 95 %
    bound = float(1.0 - (1.0 - LEVEL) ** (1.0 / float(trials)))  # Eq. 227
    facts = {"level": level(counts.levels[index]), "trials": trials, "confidence": f"{LEVEL:.0%}"}
    if none:
        return Message(_NONE_FAILED, {**facts, "probability": bound})
    return Message(_NONE_SURVIVED, {**facts, "probability": 1.0 - bound})


DECREMENT = 1e-18  # tolerance of the squared distance to the maximum, in standard errors [-]
SEARCH_STEPS = 60  # largest number of steps per start in a search from several starts [-]
STEPS = 200  # largest number of steps; about 12 are typical [-]
DEFINITE = 1e-13  # smallest relative determinant of a definite curvature, over the product of the diagonal [-]
MIN_VARIANCE = 1e-12  # smallest relative variance in any direction [-], so that the covariance has an inverse
MAX_NUMBERS = 2_000_000  # largest number of values in memory


class Objective(Protocol):
    """Objective of a maximisation: many functions of a few coefficients, one function per row."""

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return values and derivatives of the functions at rows of coefficients."""

    def rows(self, index: Any) -> Self:
        """Return a subset of the functions."""


@dataclass(frozen=True, eq=False)
class Maximum:
    """Maxima of many functions."""

    theta: FloatArray  # rows of coefficients [-]
    value: FloatArray  # values at the maxima [-]
    curvature: FloatArray  # negative Hessians at the maxima [-]
    proven: BoolArray  # True if the squared distance is below 1e-18 and the curvature is positive definite


def maximise(objective: Objective, start: FloatArray, *, steps: int = STEPS) -> Maximum:
    """Return the maxima of many functions, from rows of start coefficients. Every function must have a maximum."""
    # the existence of the maximum must be known, because for an unbounded function the steps diverge to zero gradient
    # and curvature
    theta = np.array(start, dtype=np.float64)
    count, order = theta.shape
    value, decrement = np.full(count, -np.inf), np.full(count, np.inf)
    curvature = np.zeros((count, order, order))
    active, step, factor = np.arange(count), np.zeros_like(theta), np.ones(count)
    running = objective
    for _ in range(steps):
        trial = theta[active] + factor[:, None] * step
        with np.errstate(over="ignore", invalid="ignore"):  # a trial that is too far away is rejected by its value
            at = running.derivatives(trial)
        # rounding errors of the sum must not stop the last steps
        better = at.value >= value[active] - 1e-12 * (1.0 + np.abs(at.value))
        accepted = active[better]
        theta[accepted], value[accepted], curvature[accepted] = trial[better], at.value[better], at.curvature[better]
        step[better], decrement[accepted] = _newton_step(at.gradient[better], at.curvature[better])
        factor = np.where(better, 1.0, 0.5 * factor)
        keep = ~(better & (decrement[active] <= DECREMENT)) & (factor > 1e-12)
        if not keep.all():
            active, step, factor, running = active[keep], step[keep], factor[keep], running.rows(keep)
        if not active.size:
            break
    proven = (decrement <= DECREMENT) & np.isfinite(value) & np.isfinite(theta).all(axis=1)
    return Maximum(theta, value, curvature, proven)


def maximise_from(objective: Objective, starts: FloatArray) -> Maximum:
    """Return the largest of the maxima from several starts (first axis)."""
    several, count, order = starts.shape
    rows = objective.rows(np.tile(np.arange(count), several))
    maxima = maximise(rows, starts.reshape(-1, order), steps=STEPS if several == 1 else SEARCH_STEPS)
    value = np.where(maxima.proven, maxima.value, -np.inf).reshape(several, count)
    best = np.argmax(value, axis=0) * count + np.arange(count)
    return Maximum(*(field[best] for field in vars(maxima).values()))


def _newton_step(gradient: FloatArray, curvature: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the step to the top of the parabola (uphill if there is no top), and the decrement."""
    definite = positive_definite(curvature)
    order = gradient.shape[1]
    scale = np.trace(np.abs(curvature), axis1=1, axis2=2) + np.linalg.norm(gradient, axis=1) + 1e-150
    uphill = scale[:, None, None] * np.eye(order)
    step = _solve(np.where(definite[:, None, None], curvature, uphill), gradient)
    return step, np.where(definite, np.sum(gradient * step, axis=1), np.inf)  # Eq. 199


def positive_definite(matrix: FloatArray) -> BoolArray:
    """Return True for small symmetric matrices that are positive definite beyond rounding."""
    diagonal = np.diagonal(matrix, axis1=1, axis2=2)
    finite: BoolArray = np.isfinite(matrix).all(axis=(1, 2)) & np.all(diagonal > 0.0, axis=1)
    if matrix.shape[1] <= 2:
        determinant = matrix[:, 0, 0] if matrix.shape[1] == 1 else _determinant(matrix)
        return np.asarray(finite & (determinant > DEFINITE * np.prod(np.maximum(diagonal, 0.0), axis=1)))
    safe = np.where(finite[:, None, None], matrix, np.eye(matrix.shape[1]))
    lowest = np.linalg.eigvalsh(safe)[:, 0]
    return np.asarray(finite & (lowest > DEFINITE * np.max(np.diagonal(safe, axis1=1, axis2=2), axis=1)))


def _solve(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solve many small systems. Sizes one and two use Cramer's rule, which is 100 times faster than a loop."""
    if matrix.shape[1] == 1:
        return right / matrix[:, 0]
    if matrix.shape[1] > 2:
        return np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0], dtype=np.float64)
    first = matrix[:, 1, 1] * right[:, 0] - matrix[:, 0, 1] * right[:, 1]
    second = matrix[:, 0, 0] * right[:, 1] - matrix[:, 1, 0] * right[:, 0]
    return np.stack([first, second], axis=1) / _determinant(matrix)[:, None]


def _determinant(matrix: FloatArray) -> FloatArray:
    return matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] * matrix[:, 1, 0]


@dataclass(frozen=True)
class LogScale:
    """Scale of the logarithms of levels: u = (ln level - center) / spread."""

    center: float  # center, spread: mean and standard deviation of the logarithms over the trials [-]
    spread: float

    @classmethod
    def of(cls, counts: Counts) -> "LogScale":
        """Return the scale of data."""
        logarithm = np.log(counts.levels)
        center = float(np.average(logarithm, weights=counts.trials))
        return cls(center, float(np.sqrt(np.average((logarithm - center) ** 2, weights=counts.trials))))

    def position(self, levels: FloatArray) -> FloatArray:
        """Return u of levels."""
        return (np.log(levels) - self.center) / self.spread  # Eq. 191

    def log_level(self, position: FloatArray) -> FloatArray:
        """Return the logarithms of levels at u."""
        return self.center + self.spread * position


@dataclass(frozen=True, eq=False)
class FittedCurves:
    """Curves Phi(a + b u) of many data sets with common levels."""

    theta: FloatArray  # rows of a and b; NaN without a rising curve [-]
    curvature: FloatArray  # observed information of the curves [-]
    value: FloatArray  # log likelihood of the curves, including the penalty of penalised fits [-]
    exists: BoolArray  # True for a rising curve with a proven maximum
    penalised: BoolArray  # True for penalised fits
    separation: IntArray  # `Separation.number` of the data sets


def find_curves(
    levels: FloatArray, scale: LogScale, failures: FloatArray, trials: FloatArray, *, penalised: bool = False
) -> FittedCurves:
    """Return the maximum-likelihood curves of many data sets, one per row. Steps get penalised curves."""
    kinds = classify(levels, failures, trials)
    step = np.isin(kinds, [kind.number for kind in Separation if kind.step])
    overlap = kinds == Separation.OVERLAP.number
    count = kinds.size
    firth = (overlap | step) if penalised else step
    theta, value = np.full((count, 2), np.nan), np.full(count, np.nan)
    curvature, exists = np.full((count, 2, 2), np.nan), np.zeros(count, dtype=bool)
    position = scale.position(levels)[None]
    for model, selected in ((Probit, overlap & ~firth), (PenalisedProbit, firth)):
        start = np.zeros((1, 2)) if model.concave else starts(position[0])
        for rows in _pieces(np.flatnonzero(selected), levels.size * len(start)):
            data = model(position, failures[rows], trials[rows] - failures[rows])
            best = maximise_from(data, np.repeat(start[:, None], rows.size, axis=1))
            theta[rows], curvature[rows], value[rows] = best.theta, best.curvature, best.value
            exists[rows] = best.proven & (best.theta[:, 1] > 0.0)
    theta[~exists] = np.nan
    return FittedCurves(theta, curvature, value, exists, firth, kinds)


def _pieces(rows: IntArray, width: int, max_numbers: int = 400_000) -> list[IntArray]:
    """Return the rows in pieces with a limited number of values."""
    size = max(1, max_numbers // width)
    return [rows[start : start + size] for start in range(0, rows.size, size)]


def log_fractile(theta: FloatArray, scale: LogScale, variate: float | FloatArray) -> FloatArray:
    """Return the logarithm of the level at which curves have the probability of a standard normal variate."""
    return scale.log_level((variate - theta[:, 0]) / theta[:, 1])  # Eq. 192


def log_dispersion(theta: FloatArray, scale: LogScale) -> FloatArray:
    """Return the logarithm of the dispersion of curves."""
    return np.log(scale.spread / theta[:, 1])  # Eq. 193


def log_quantity(theta: FloatArray, scale: LogScale, variate: float | None) -> FloatArray:
    """Return the logarithmic fractile of curves at a variate. Without a variate, return the logarithmic dispersion."""
    return log_dispersion(theta, scale) if variate is None else log_fractile(theta, scale, variate)


def standard_errors(theta: FloatArray, curvature: FloatArray, scale: LogScale, variate: float | None) -> FloatArray:
    """Return the standard errors of `log_quantity`."""
    a, b = theta[:, 0], theta[:, 1]
    if variate is None:
        slope = np.stack([np.zeros_like(b), -1.0 / b], axis=1)
    else:
        slope = scale.spread * np.stack([-1.0 / b, (a - variate) / b**2], axis=1)
    return quadratic_error(slope, curvature)


def quadratic_error(slope: FloatArray, curvature: FloatArray) -> FloatArray:
    """Return the standard errors of functions of the coefficients, from derivatives (delta method)."""
    h = curvature
    determinant = h[:, 0, 0] * h[:, 1, 1] - h[:, 0, 1] ** 2
    first, second = slope[:, 0], slope[:, 1]
    form = h[:, 1, 1] * first**2 - 2.0 * h[:, 0, 1] * first * second + h[:, 0, 0] * second**2
    return np.asarray(np.sqrt(form / determinant))  # Eq. 207


def with_cluster_errors(counts: Counts, scale: LogScale, curves: FittedCurves, weights: FloatArray) -> FittedCurves:
    """Return curves whose curvature is the inverse covariance between clusters. `weights` are those of clusters.

    The covariance is H^-1 M H^-1, with the information H and the sum M of the squared scores of entire clusters (Liang
    & Zeger 1986, Biometrika 73:13). The covariance H^-1 of the likelihood applies only to independent outcomes.
    """
    curvature = np.full_like(curves.curvature, np.nan)
    good = np.flatnonzero(curves.exists)
    for rows in _pieces(good, max(1, weights.shape[1]), MAX_NUMBERS):
        spread = _scores_squared(counts, scale, curves.theta[rows], weights[rows])
        inverse = np.linalg.inv(curves.curvature[rows])
        covariance = inverse @ spread @ inverse  # Eq. 212
        minimum = MIN_VARIANCE * np.trace(covariance, axis1=1, axis2=2) + np.finfo(float).tiny ** 0.25
        curvature[rows] = np.linalg.inv(covariance + minimum[:, None, None] * np.eye(2))
    return replace(curves, curvature=curvature)


def _scores_squared(counts: Counts, scale: LogScale, theta: FloatArray, weights: FloatArray) -> FloatArray:
    position = scale.position(counts.levels)
    failures, trials = np.split(counts.distinct_clusters[0], 2, axis=1)
    tail = tails(theta[:, :1] + theta[:, 1:] * position)
    up, down = (
        (tail.failure_rate * weight) @ failures.T - (tail.survival_rate * weight) @ (trials - failures).T
        for weight in (np.ones_like(position), position)
    )
    first, mixed, last = (np.sum(weights * a * b, axis=1) for a, b in ((up, up), (up, down), (down, down)))
    return np.stack([np.stack([first, mixed], axis=1), np.stack([mixed, last], axis=1)], axis=1)
