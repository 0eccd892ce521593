"""What a profile holds fixed: a fractile, the probability at a level, or the dispersion; a line of curves is left."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.fragility.likelihood import Probit
from rocking.studies.fragility.lines import Line, flat_line
from rocking.studies.fragility.penalised import SLOPES, places


@dataclass(frozen=True, eq=False)
class Constraint(ABC):
    """A quantity of the curve that is held at given values, one a row."""

    rising = True
    """Whether the free coefficient is the slope b, which then must not become negative."""

    @abstractmethod
    def line(self, value: FloatArray) -> Line:
        """Return the curves that have the given values of the quantity.

        Parameters
        ----------
        value : ndarray
            The quantity, one a row [-].

        Returns
        -------
        Line
            The curves.
        """

    @abstractmethod
    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return what the profile tends to as the quantity goes to the end of its range.

        Parameters
        ----------
        model : Probit
            The likelihood, one row that all share, or one row an end.
        side : ndarray
            1 for the upper end, -1 for the lower one.

        Returns
        -------
        ndarray
            Log likelihoods; minus infinity where it falls without end [-].
        """

    def starts(self, model: Probit, value: FloatArray, free: FloatArray) -> FloatArray:
        """Return free coefficients to start from.

        Parameters
        ----------
        model : Probit
            The likelihood.
        value : ndarray
            The quantity, one a row [-].
        free : ndarray
            A good guess, one a row; it is enough where the likelihood is concave [-].

        Returns
        -------
        ndarray
            First axis the starts, second the rows, third of length one [-].
        """
        others = np.zeros((0, free.size)) if model.concave else self._others(model, value)
        return np.concatenate([free[None], others])[:, :, None]

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return np.repeat(np.append(0.0, SLOPES)[:, None], value.size, axis=1)

    def rows(self, index: Any) -> Self:
        """Return the constraint of some rows.

        Parameters
        ----------
        index : array of int or bool
            Which rows.

        Returns
        -------
        Constraint
            Those.
        """
        return type(self)(*(value[index] for value in vars(self).values()))


@dataclass(frozen=True, eq=False)
class FractileConstraint(Constraint):
    """The position u where the curve reaches given probabilities.

    Parameters
    ----------
    variate : ndarray
        Standard normal variate of the probability, one a row [-].
    """

    variate: FloatArray

    def line(self, value: FloatArray) -> Line:
        """Return the curves through the probability at given positions.

        Parameters
        ----------
        value : ndarray
            Positions u [-].

        Returns
        -------
        Line
            The curves.
        """
        none, one = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(self.variate, none), _pair(-value, one), _pair(none, none), _pair(-one, none))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the likelihood of the likeliest flat line that stays below (above) the probability.

        Parameters
        ----------
        model : Probit
            The likelihood, one row that all share, or one row an end.
        side : ndarray
            1 for the upper end, -1 for the lower one.

        Returns
        -------
        ndarray
            Log likelihoods [-].
        """
        flat = flat_line(model)[0]
        height = np.where(side > 0.0, np.minimum(flat, self.variate), np.maximum(flat, self.variate))
        return model.derivatives(_pair(height, np.zeros_like(side))).value


@dataclass(frozen=True, eq=False)
class ProbabilityConstraint(Constraint):
    """The variate a + b u of the probability at given positions.

    Parameters
    ----------
    position : ndarray
        u, one a row [-].
    """

    position: FloatArray

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given variates at the positions.

        Parameters
        ----------
        value : ndarray
            Standard normal variates [-].

        Returns
        -------
        Line
            The curves.
        """
        none, one = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(value, none), _pair(-self.position, one), _pair(one, none), _pair(none, none))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return minus infinity: no probability that tends to 0 or 1 survives overlapping data.

        Parameters
        ----------
        model : Probit
            The likelihood, one row that all share, or one row an end.
        side : ndarray
            1 for the upper end, -1 for the lower one.

        Returns
        -------
        ndarray
            Log likelihoods [-].
        """
        return np.full_like(side, -np.inf)


@dataclass(frozen=True, eq=False)
class SlopeConstraint(Constraint):
    """The logarithm of the slope b, that is minus that of the dispersion."""

    rising = False

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given slopes.

        Parameters
        ----------
        value : ndarray
            Logarithms of b [-].

        Returns
        -------
        Line
            The curves.
        """
        none, one, slope = np.zeros_like(value), np.ones_like(value), np.exp(value)
        return Line(_pair(none, slope), _pair(one, none), _pair(none, slope), _pair(none, none))

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return -np.exp(value) * places(model.position[0])[:, None]

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the likelihood of the likeliest flat line; a step is refused without end.

        Parameters
        ----------
        model : Probit
            The likelihood, one row that all share, or one row an end.
        side : ndarray
            1 for the upper end, -1 for the lower one.

        Returns
        -------
        ndarray
            Log likelihoods [-].
        """
        return np.where(side > 0.0, -np.inf, flat_line(model)[1])


def _pair(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.stack([first, second], axis=1)
