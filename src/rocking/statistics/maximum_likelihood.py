"""Likeliest curves, each with the proof that it is a maximum, and whether the data fix one at all, in words."""

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

FLATNESS = 1e-13  # trend over the largest possible one below which it is rounding [-]
LEVEL = 0.95  # confidence level of the bounds that a verdict states [-]


class Separation(Enum):
    """How failures and survivals lie along the levels; the values are the sentences that a user reads."""

    OVERLAP = "failures and survivals overlap and failures grow with the level: one lognormal curve is likeliest"
    COMPLETE = "complete separation: all survived up to one level and all failed from the next, so any step between"
    QUASI_COMPLETE = "quasi-complete separation: all survived below one level and all failed above it"
    NONE_FAILED = "nothing failed: the data only say that the curve lies above the levels tried"
    ALL_FAILED = "everything failed: the data only say that the curve lies below the levels tried"
    SINGLE_LEVEL = "one level only: a dispersion cannot be told from it"
    FLAT = "failures do not depend on the level: the dispersion would be infinite"
    DECREASING = "failures become fewer as the level grows: no lognormal fragility in this measure"
    DECREASING_SEPARATED = "all failed below one level and survived above it: no lognormal fragility in this measure"

    @cached_property
    def number(self) -> int:
        """Place in the order of definition, as `classify` returns it."""
        return list(Separation).index(self)

    @property
    def step(self) -> bool:
        """Whether the likelihood grows without end towards a step at some level: dispersion 0."""
        return self in {Separation.COMPLETE, Separation.QUASI_COMPLETE}


def classify(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> IntArray:
    """Return how failures and survivals lie along ascending levels, of many data sets, one row each, at once."""
    failed, survived = failures > 0.0, trials > failures
    last = levels.size - 1
    first_failed, last_failed = np.argmax(failed, axis=1), last - np.argmax(failed[:, ::-1], axis=1)
    first_survived, last_survived = np.argmax(survived, axis=1), last - np.argmax(survived[:, ::-1], axis=1)
    trend, largest = _trend(levels, failures, trials)
    # the first that holds is the answer
    answers = (
        (Separation.NONE_FAILED, ~failed.any(axis=1)),
        (Separation.ALL_FAILED, ~survived.any(axis=1)),
        (Separation.SINGLE_LEVEL, (trials > 0.0).sum(axis=1) == 1),
        (Separation.COMPLETE, last_survived < first_failed),  # Eq. 200
        (Separation.QUASI_COMPLETE, last_survived == first_failed),  # Eq. 200
        (Separation.DECREASING_SEPARATED, last_failed <= first_survived),
        (Separation.FLAT, np.abs(trend) <= FLATNESS * largest),
        (Separation.DECREASING, trend < 0.0),
    )
    conditions, numbers = [holds for _, holds in answers], [kind.number for kind, _ in answers]
    return np.select(conditions, numbers, Separation.OVERLAP.number).astype(np.int64)


def separation_of(counts: Counts) -> Separation:
    """Return how failures and survivals of one data set lie along the levels.

    >>> from rocking.statistics.counts import count_outcomes
    >>> separation_of(count_outcomes([0.1, 0.2, 0.3, 0.4], [0, 0, 1, 1])).name
    'COMPLETE'
    """
    return list(Separation)[int(classify(counts.levels, counts.failures[None], counts.trials[None])[0])]


def median_interval(counts: Counts, separation: Separation) -> tuple[float | None, float | None]:
    """Return what `LognormalFit.median_interval` says of outcomes."""
    survived, failed = counts.levels[counts.survivals > 0.0], counts.levels[counts.failures > 0.0]
    if separation is Separation.NONE_FAILED:
        return float(survived[-1]), None
    if separation is Separation.ALL_FAILED:
        return None, float(failed[0])
    return (float(survived[-1]), float(failed[0])) if separation.step else (None, None)


def _trend(levels: FloatArray, failures: FloatArray, trials: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the score of the slope at slope zero, whose sign is the slope's, and the largest it could be."""
    u = np.log(levels / levels[0])
    total = np.maximum(trials.sum(axis=1), 1.0)
    distance = u - ((trials @ u) / total)[:, None]
    return np.sum(failures * distance, axis=1), np.sum(trials * np.abs(distance), axis=1)  # Eq. 201


_NO_CURVE = "{outcomes} give no curve: the likeliest rises so little, if at all, that it has no median."
_LIKELIEST = (
    "{outcomes} give median {median}, dispersion {dispersion:.3g}, where the likelihood is proven to be largest."
)
_PENALISED = (
    "{outcomes} give median {median}, dispersion {dispersion:.3g}, where the penalised likelihood has its highest "
    "maximum found."
)
_STEP_BETWEEN = (
    "{outcomes} have no likeliest curve: the likelihood grows towards a step between {low} and {high}, with dispersion "
    "0."
)
_STEP_AT = "{outcomes} have no likeliest curve: the likelihood grows towards a step at {low}, with dispersion 0."
_CONVENTION = (
    "The penalised likelihood gives median {median}, dispersion {dispersion:.3g}: a convention, not a finding."
)
_NONE_FAILED = (
    "At {level} none of {trials:g} failed: there the probability of failure is below {probability:.3g} (confidence "
    "{confidence})."
)
_NONE_SURVIVED = (
    "At {level} none of {trials:g} survived: there the probability of failure is above {probability:.3g} (confidence "
    "{confidence})."
)


def verdict_of(
    counts: Counts, separation: Separation, curve: tuple[float, float] | None, rise: float | None,
    level: Callable[..., str], *, clusters: bool,
) -> str:  # fmt: skip
    """Return what the outcomes allow to be said, in a sentence or two, and what the likelihood does not know."""
    # The curve is median and dispersion; `rise` its likelihood ratio against a line that does not depend on the level,
    # a chi-square of one degree of freedom; None for a penalised fit. `level` writes a level, with its unit.
    parts = [_finding(counts, separation, curve, level, penalised=rise is None)]
    if rise is not None and rise < 3.841:
        parts.append("Chance alone explains the growth with the level (5 % test): intervals may be open.")
    if clusters and curve is not None and counts.is_clustered:
        parts.append(_clustered(counts))
    return Message.joined(parts)


def _clustered(counts: Counts) -> str:
    if counts.scarcity:
        return Message(
            "Intervals are those of the likelihood and may be much too narrow: they take the outcomes of one cluster "
            "for independent; the bootstrap of whole clusters has too few of them ({reason}).",
            {"reason": counts.scarcity},
        )
    if counts.draws_capacities:
        return (
            "Outcomes of one cluster are not independent: intervals are from the bootstrap, which draws a capacity for "
            "each; likelihood intervals would be too narrow."
        )
    return (
        "Outcomes of one cluster are not independent: intervals are from the bootstrap, which draws whole clusters; "
        "likelihood intervals would be too narrow."
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
        return Message(_NO_CURVE if curve is None else _PENALISED if penalised else _LIKELIEST, facts)
    if separation.step:
        low, high = levels[counts.survivals > 0.0][-1], levels[counts.failures > 0.0][0]
        step = Message(_STEP_BETWEEN if high > low else _STEP_AT, {**facts, "low": level(low), "high": level(high)})
        return Message.joined([sentence, step, Message(_CONVENTION, facts) if curve else ""])
    if separation in {Separation.NONE_FAILED, Separation.ALL_FAILED}:
        return Message.joined([sentence, _bound(counts, separation, level), "No curve is fitted."])
    return Message.joined([sentence, Message("No curve is fitted to {outcomes}.", facts)])


def _bound(counts: Counts, separation: Separation, level: Callable[..., str]) -> str:
    none = separation is Separation.NONE_FAILED
    place = -1 if none else 0
    trials = counts.trials[place]
    # the one-sided Clopper-Pearson bound on a probability of which no trial failed, near 3 / trials for 95 %
    share = float(1.0 - (1.0 - LEVEL) ** (1.0 / float(trials)))  # Eq. 227
    facts = {"level": level(counts.levels[place]), "trials": trials, "confidence": f"{LEVEL:.0%}"}
    if none:
        return Message(_NONE_FAILED, {**facts, "probability": share})
    return Message(_NONE_SURVIVED, {**facts, "probability": 1.0 - share})


DECREMENT = 1e-18  # Largest squared distance to the maximum, in standard errors, that counts as having arrived [-]
SEARCH_STEPS = 60  # most steps from each of several starts [-]
STEPS = 200  # most steps; a dozen are usual [-]
DEFINITE = 1e-13  # smallest determinant, over the product of the diagonal, of a curvature that counts as definite [-]
LEAST = 1e-12  # smallest share of the variance in any direction, so that the inverse of the covariance exists [-]
FULLEST = 2_000_000  # numbers that are held at once


class Objective(Protocol):
    """What can be maximised: many functions of the same few coefficients, one a row."""

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the values and derivatives at rows of coefficients."""

    def rows(self, index: Any) -> Self:
        """Return some of the functions."""


@dataclass(frozen=True, eq=False)
class Maximum:
    """Where many functions are largest."""

    theta: FloatArray  # rows of coefficients [-]
    value: FloatArray  # the functions there [-]
    curvature: FloatArray  # minus their Hessians there [-]
    proven: BoolArray  # whether the squared distance to them is below 1e-18, the curvature positive definite there


def maximise(objective: Objective, start: FloatArray, *, steps: int = STEPS) -> Maximum:
    """Return the maxima of many functions, each of which must have one, from rows of coefficients."""
    # of a function that grows without end the steps get lost far out, where gradient and curvature vanish alike: that
    # the maximum exists must be known beforehand
    theta = np.array(start, dtype=np.float64)
    count, order = theta.shape
    value, decrement = np.full(count, -np.inf), np.full(count, np.inf)
    curvature = np.zeros((count, order, order))
    active, step, factor = np.arange(count), np.zeros_like(theta), np.ones(count)
    running = objective
    for _ in range(steps):
        trial = theta[active] + factor[:, None] * step
        with np.errstate(over="ignore", invalid="ignore"):  # a trial too far out is refused for its value
            at = running.derivatives(trial)
        # rounding of the sum must not stop the last steps
        better = at.value >= value[active] - 1e-12 * (1.0 + np.abs(at.value))
        won = active[better]
        theta[won], value[won], curvature[won] = trial[better], at.value[better], at.curvature[better]
        step[better], decrement[won] = _newton_step(at.gradient[better], at.curvature[better])
        factor = np.where(better, 1.0, 0.5 * factor)
        keep = ~(better & (decrement[active] <= DECREMENT)) & (factor > 1e-12)
        if not keep.all():
            active, step, factor, running = active[keep], step[keep], factor[keep], running.rows(keep)
        if not active.size:
            break
    proven = (decrement <= DECREMENT) & np.isfinite(value) & np.isfinite(theta).all(axis=1)
    return Maximum(theta, value, curvature, proven)


def maximise_from(objective: Objective, starts: FloatArray) -> Maximum:
    """Return the largest of the maxima reached from several starts (first axis), of functions that may have several."""
    several, count, order = starts.shape
    rows = objective.rows(np.tile(np.arange(count), several))
    found = maximise(rows, starts.reshape(-1, order), steps=STEPS if several == 1 else SEARCH_STEPS)
    value = np.where(found.proven, found.value, -np.inf).reshape(several, count)
    best = np.argmax(value, axis=0) * count + np.arange(count)
    return Maximum(*(part[best] for part in vars(found).values()))


def _newton_step(gradient: FloatArray, curvature: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the step to the top of the parabola, or uphill where there is none, and the decrement."""
    definite = positive_definite(curvature)
    order = gradient.shape[1]
    scale = np.trace(np.abs(curvature), axis1=1, axis2=2) + np.linalg.norm(gradient, axis=1) + 1e-150
    uphill = scale[:, None, None] * np.eye(order)
    step = _solve(np.where(definite[:, None, None], curvature, uphill), gradient)
    return step, np.where(definite, np.sum(gradient * step, axis=1), np.inf)  # Eq. 199


def positive_definite(matrix: FloatArray) -> BoolArray:
    """Return which of many small symmetric matrices are positive definite beyond rounding."""
    diagonal = np.diagonal(matrix, axis1=1, axis2=2)
    finite: BoolArray = np.isfinite(matrix).all(axis=(1, 2)) & np.all(diagonal > 0.0, axis=1)
    if matrix.shape[1] <= 2:
        determinant = matrix[:, 0, 0] if matrix.shape[1] == 1 else _determinant(matrix)
        return np.asarray(finite & (determinant > DEFINITE * np.prod(np.maximum(diagonal, 0.0), axis=1)))
    safe = np.where(finite[:, None, None], matrix, np.eye(matrix.shape[1]))
    lowest = np.linalg.eigvalsh(safe)[:, 0]
    return np.asarray(finite & (lowest > DEFINITE * np.max(np.diagonal(safe, axis1=1, axis2=2), axis=1)))


def _solve(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solve many small systems; sizes one and two by Cramer's rule, a hundred times faster than one by one."""
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
        """Return u of levels."""
        return (np.log(levels) - self.center) / self.spread  # Eq. 191

    def log_level(self, position: FloatArray) -> FloatArray:
        """Return the logarithms of levels at u."""
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
    """Return the likeliest curves of many data sets, one row each; of those with a step, the penalised one."""
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


def _pieces(rows: IntArray, width: int, held: int = 400_000) -> list[IntArray]:
    """Return the rows in pieces of so many numbers that arrays stay small."""
    size = max(1, held // width)
    return [rows[start : start + size] for start in range(0, rows.size, size)]


def log_fractile(theta: FloatArray, scale: LogScale, variate: float | FloatArray) -> FloatArray:
    """Return the logarithm of the level where curves reach the probability of a standard normal variate."""
    return scale.log_level((variate - theta[:, 0]) / theta[:, 1])  # Eq. 192


def log_dispersion(theta: FloatArray, scale: LogScale) -> FloatArray:
    """Return the logarithm of the dispersion of curves."""
    return np.log(scale.spread / theta[:, 1])  # Eq. 193


def log_quantity(theta: FloatArray, scale: LogScale, variate: float | None) -> FloatArray:
    """Return a variate's logarithmic fractile of curves; without one the logarithmic dispersion."""
    return log_dispersion(theta, scale) if variate is None else log_fractile(theta, scale, variate)


def standard_errors(theta: FloatArray, curvature: FloatArray, scale: LogScale, variate: float | None) -> FloatArray:
    """Return the standard errors of a variate's logarithmic fractile; without one of the logarithmic dispersion."""
    a, b = theta[:, 0], theta[:, 1]
    if variate is None:
        slope = np.stack([np.zeros_like(b), -1.0 / b], axis=1)
    else:
        slope = scale.spread * np.stack([-1.0 / b, (a - variate) / b**2], axis=1)
    return quadratic_error(slope, curvature)


def quadratic_error(slope: FloatArray, curvature: FloatArray) -> FloatArray:
    """Return the standard errors of functions of the coefficients, from their derivatives (delta method)."""
    h = curvature
    determinant = h[:, 0, 0] * h[:, 1, 1] - h[:, 0, 1] ** 2
    first, second = slope[:, 0], slope[:, 1]
    form = h[:, 1, 1] * first**2 - 2.0 * h[:, 0, 1] * first * second + h[:, 0, 0] * second**2
    return np.asarray(np.sqrt(form / determinant))  # Eq. 207


def with_cluster_errors(counts: Counts, scale: LogScale, curves: FittedCurves, drawn: FloatArray) -> FittedCurves:
    """Return curves whose curvature is the inverse of the covariance between clusters, drawn so often in each data set.

    The covariance is H^-1 M H^-1, with the information H and the sum M of the squared scores of whole clusters
    (Liang & Zeger 1986, Biometrika 73:13): that of the likelihood, H^-1, holds for independent outcomes only.
    """
    curvature = np.full_like(curves.curvature, np.nan)
    good = np.flatnonzero(curves.found)
    for rows in _pieces(good, max(1, drawn.shape[1]), FULLEST):
        spread = _scores_squared(counts, scale, curves.theta[rows], drawn[rows])
        inverse = np.linalg.inv(curves.curvature[rows])
        covariance = inverse @ spread @ inverse  # Eq. 212
        least = LEAST * np.trace(covariance, axis1=1, axis2=2) + np.finfo(float).tiny ** 0.25
        curvature[rows] = np.linalg.inv(covariance + least[:, None, None] * np.eye(2))
    return replace(curves, curvature=curvature)


def _scores_squared(counts: Counts, scale: LogScale, theta: FloatArray, drawn: FloatArray) -> FloatArray:
    position = scale.position(counts.levels)
    failures, trials = np.split(counts.distinct_clusters[0], 2, axis=1)
    tail = tails(theta[:, :1] + theta[:, 1:] * position)
    up, down = (
        (tail.failure_rate * weight) @ failures.T - (tail.survival_rate * weight) @ (trials - failures).T
        for weight in (np.ones_like(position), position)
    )
    first, mixed, last = (np.sum(drawn * a * b, axis=1) for a, b in ((up, up), (up, down), (down, down)))
    return np.stack([np.stack([first, mixed], axis=1), np.stack([mixed, last], axis=1)], axis=1)
