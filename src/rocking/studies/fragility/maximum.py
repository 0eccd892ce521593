"""Maxima of many smooth functions at once by damped Newton steps, each with the proof that it is one."""

from dataclasses import dataclass
from typing import Any, Protocol, Self

import numpy as np

from rocking.conventions import BoolArray, FloatArray
from rocking.studies.fragility.likelihood import Derivatives

DECREMENT = 1e-18
"""Largest squared distance to the maximum, in standard errors, that counts as having arrived [-]."""

SEARCH_STEPS = 60
"""Most steps from each of several starts [-]."""

STEPS = 200
"""Most steps; a dozen are usual [-]."""

DEFINITE = 1e-13
"""Smallest determinant, over the product of the diagonal, of a curvature that counts as definite [-]."""


class Objective(Protocol):
    """What can be maximised: many functions of the same few coefficients, one a row."""

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the values and derivatives.

        theta: rows of coefficients [-].
        """

    def rows(self, index: Any) -> Self:
        """Return some of the functions."""


@dataclass(frozen=True, eq=False)
class Maximum:
    """Where many functions are largest."""

    theta: FloatArray  # rows of coefficients [-]
    value: FloatArray  # the functions there [-]
    curvature: FloatArray  # minus their Hessians there [-]
    decrement: FloatArray  # gradient times Newton step: the squared distance to the maximum in standard errors [-]
    proven: BoolArray  # whether the decrement is below 1e-18 and the curvature positive definite there


def maximise(objective: Objective, start: FloatArray, *, steps: int = STEPS) -> Maximum:
    """Return the maxima of many functions, each of which must have one.

    Of a function that grows without end the steps get lost far out, where gradient and curvature vanish alike: that the
    maximum exists must be known beforehand.

    start: rows of coefficients to start from [-].
    """
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
    return Maximum(theta, value, curvature, decrement, proven)


def maximise_from(objective: Objective, starts: FloatArray) -> Maximum:
    """Return the largest of the maxima reached from several starts, for functions that may have more than one.

    starts: coefficients to start from: first axis the starts, second the functions [-].
    """
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
