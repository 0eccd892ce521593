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

        value: the quantity, one a row [-].
        """

    @abstractmethod
    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return what the profile tends to as the quantity goes to the end of its range.

        Returns log likelihoods; minus infinity where it falls without end [-].
        """

    def starts(self, model: Probit, value: FloatArray, free: FloatArray) -> FloatArray:
        """Return free coefficients to start from.

        value: the quantity, one a row [-]; free: A good guess, one a row; it is enough where the likelihood is concave
        [-]. Returns first axis the starts, second the rows, third of length one [-].
        """
        others = np.zeros((0, free.size)) if model.concave else self._others(model, value)
        return np.concatenate([free[None], others])[:, :, None]

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return np.repeat(np.append(0.0, SLOPES)[:, None], value.size, axis=1)

    def rows(self, index: Any) -> Self:
        """Return the constraint of some rows."""
        return type(self)(*(value[index] for value in vars(self).values()))


@dataclass(frozen=True, eq=False)
class FractileConstraint(Constraint):
    """The position u where the curve reaches given probabilities."""

    variate: FloatArray  # standard normal variate of the probability, one a row [-]

    def line(self, value: FloatArray) -> Line:
        """Return the curves through the probability at given positions.

        value: positions u [-].
        """
        none, one = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(self.variate, none), _pair(-value, one), _pair(none, none), _pair(-one, none))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the likelihood of the likeliest flat line that stays below (above) the probability.

        Returns log likelihoods [-].
        """
        flat = flat_line(model)[0]
        height = np.where(side > 0.0, np.minimum(flat, self.variate), np.maximum(flat, self.variate))
        return model.derivatives(_pair(height, np.zeros_like(side))).value


@dataclass(frozen=True, eq=False)
class ProbabilityConstraint(Constraint):
    """The variate a + b u of the probability at given positions."""

    position: FloatArray  # u, one a row [-]

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given variates at the positions.

        value: standard normal variates [-].
        """
        none, one = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(value, none), _pair(-self.position, one), _pair(one, none), _pair(none, none))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return minus infinity: no probability that tends to 0 or 1 survives overlapping data.

        Returns log likelihoods [-].
        """
        return np.full_like(side, -np.inf)


@dataclass(frozen=True, eq=False)
class SlopeConstraint(Constraint):
    """The logarithm of the slope b, that is minus that of the dispersion."""

    rising = False

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given slopes.

        value: logarithms of b [-].
        """
        none, one, slope = np.zeros_like(value), np.ones_like(value), np.exp(value)
        return Line(_pair(none, slope), _pair(one, none), _pair(none, slope), _pair(none, none))

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return -np.exp(value) * places(model.position[0])[:, None]

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the likelihood of the likeliest flat line; a step is refused without end.

        Returns log likelihoods [-].
        """
        return np.where(side > 0.0, -np.inf, flat_line(model)[1])


def _pair(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.stack([first, second], axis=1)
