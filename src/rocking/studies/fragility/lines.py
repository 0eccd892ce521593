"""The likelihood along lines of curves, where one coefficient is free and another quantity is held."""

from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.fragility.likelihood import Derivatives, Probit
from rocking.studies.fragility.maximum import maximise


class Line(NamedTuple):
    """Curves that obey one constraint: theta = origin + t direction."""

    origin: FloatArray  # origin, direction: rows of a and b [-]
    direction: FloatArray
    moves: FloatArray  # derivative of theta with respect to the fixed quantity: this plus t times `turns` [-]
    turns: FloatArray  # see `moves` [-]


@dataclass(frozen=True, eq=False)
class OnLine:
    """The likelihood along lines, a function of t alone."""

    model: Probit  # the likelihood, one row that all share, or one row an end
    line: Line  # the lines, one a row

    def rows(self, index: Any) -> Self:
        """Return some of the functions."""
        return type(self)(self.model.rows(index), Line(*(part[index] for part in self.line)))

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the values and derivatives with respect to t.

        theta: one t a row [-].
        """
        full, direction = self.model.derivatives(self.line.origin + theta * self.line.direction), self.line.direction
        bend = np.einsum("si,sij,sj->s", direction, full.curvature, direction)
        return Derivatives(full.value, np.sum(full.gradient * direction, axis=1)[:, None], bend[:, None, None])


def flat_line(model: Probit) -> tuple[FloatArray, FloatArray]:
    """Return the likeliest variates that do not depend on the level, and their log likelihoods.

    Returns variates and log likelihoods, one a row of the likelihood [-].
    """
    one = np.ones((model.failures.shape[0], 2))
    line = Line(0.0 * one, one * [1.0, 0.0], 0.0 * one, 0.0 * one)
    best = maximise(OnLine(model, line), np.zeros((one.shape[0], 1)))
    return best.theta[:, 0], best.value
