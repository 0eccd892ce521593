"""The likelihood along lines of curves, where one coefficient is free and another quantity is held."""

from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.fragility.likelihood import Derivatives, Probit
from rocking.studies.fragility.maximum import maximise


class Line(NamedTuple):
    """Curves that obey one constraint: theta = origin + t direction.

    Parameters
    ----------
    origin, direction : ndarray
        Rows of a and b [-].
    moves : ndarray
        Derivative of theta with respect to the fixed quantity: this plus t times `turns` [-].
    turns : ndarray
        See `moves` [-].
    """

    origin: FloatArray
    direction: FloatArray
    moves: FloatArray
    turns: FloatArray


@dataclass(frozen=True, eq=False)
class OnLine:
    """The likelihood along lines, a function of t alone.

    Parameters
    ----------
    model : Probit
        The likelihood, one row that all share, or one row an end.
    line : Line
        The lines, one a row.
    """

    model: Probit
    line: Line

    def rows(self, index: Any) -> Self:
        """Return some of the functions.

        Parameters
        ----------
        index : array of int or bool
            Which ones.

        Returns
        -------
        OnLine
            Those.
        """
        return type(self)(self.model.rows(index), Line(*(part[index] for part in self.line)))

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the values and derivatives with respect to t.

        Parameters
        ----------
        theta : ndarray
            One t a row [-].

        Returns
        -------
        Derivatives
            One row a line.
        """
        full, direction = self.model.derivatives(self.line.origin + theta * self.line.direction), self.line.direction
        bend = np.einsum("si,sij,sj->s", direction, full.curvature, direction)
        return Derivatives(full.value, np.sum(full.gradient * direction, axis=1)[:, None], bend[:, None, None])


def flat_line(model: Probit) -> tuple[FloatArray, FloatArray]:
    """Return the likeliest variates that do not depend on the level, and their log likelihoods.

    Parameters
    ----------
    model : Probit
        The likelihood.

    Returns
    -------
    tuple of ndarray
        Variates and log likelihoods, one a row of the likelihood [-].
    """
    one = np.ones((model.failures.shape[0], 2))
    line = Line(0.0 * one, one * [1.0, 0.0], 0.0 * one, 0.0 * one)
    best = maximise(OnLine(model, line), np.zeros((one.shape[0], 1)))
    return best.theta[:, 0], best.value
