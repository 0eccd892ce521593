"""Profile-likelihood intervals and bands: every value that the data do not reject, however lopsided."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.statistics.maximum_likelihood import maximise, maximise_from
from rocking.statistics.probit import SLOPES, Derivatives, Probit, places

FARTHEST = 300.0  # distance at which an end counts as open [-]
ROOT = 1e-10  # error of the root of the fall at which an end is found [-]


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
        return type(self)(self.model.rows(index), Line(*(part[index] for part in self.line)))

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the values and derivatives with respect to t, one a row."""
        full, direction = self.model.derivatives(self.line.origin + theta * self.line.direction), self.line.direction
        bend = np.einsum("si,sij,sj->s", direction, full.curvature, direction)
        return Derivatives(full.value, np.sum(full.gradient * direction, axis=1)[:, None], bend[:, None, None])


def flat_line(model: Probit) -> tuple[FloatArray, FloatArray]:
    """Return the likeliest variates that do not depend on the level, and their log likelihoods."""
    one = np.ones((model.failures.shape[0], 2))
    line = Line(0.0 * one, one * [1.0, 0.0], 0.0 * one, 0.0 * one)
    best = maximise(OnLine(model, line), np.zeros((one.shape[0], 1)))
    return best.theta[:, 0], best.value


@dataclass(frozen=True, eq=False)
class Constraint(ABC):
    """A quantity of the curve that is held at given values, one a row."""

    rising = True
    """Whether the free coefficient is the slope b, which then must not become negative."""

    @abstractmethod
    def line(self, value: FloatArray) -> Line:
        """Return the curves that have the given values of the quantity."""

    @abstractmethod
    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the log likelihood that the profile tends to at the end of its range; minus infinity for none."""

    def starts(self, model: Probit, value: FloatArray, free: FloatArray) -> FloatArray:
        """Return free coefficients to start from (first axis); a good guess is enough where all is concave."""
        others = np.zeros((0, free.size)) if model.concave else self._others(model, value)
        return np.concatenate([free[None], others])[:, :, None]

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return np.repeat(np.append(0.0, SLOPES)[:, None], value.size, axis=1)

    def rows(self, index: Any) -> Self:
        return type(self)(*(value[index] for value in vars(self).values()))


@dataclass(frozen=True, eq=False)
class FractileConstraint(Constraint):
    """The position u where the curve reaches given probabilities."""

    variate: FloatArray  # standard normal variate of the probability, one a row [-]

    def line(self, value: FloatArray) -> Line:
        """Return the curves through the probability at given positions."""
        none, one = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(self.variate, none), _pair(-value, one), _pair(none, none), _pair(-one, none))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the likelihood of the likeliest flat line that stays below (above) the probability."""
        flat = flat_line(model)[0]
        height = np.where(side > 0.0, np.minimum(flat, self.variate), np.maximum(flat, self.variate))
        return model.derivatives(_pair(height, np.zeros_like(side))).value


@dataclass(frozen=True, eq=False)
class ProbabilityConstraint(Constraint):
    """The variate a + b u of the probability at given positions."""

    position: FloatArray  # u, one a row [-]

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given variates at the positions."""
        none, one = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(value, none), _pair(-self.position, one), _pair(one, none), _pair(none, none))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return minus infinity: no probability that tends to 0 or 1 survives overlapping data."""
        return np.full_like(side, -np.inf)


@dataclass(frozen=True, eq=False)
class SlopeConstraint(Constraint):
    """The logarithm of the slope b, that is minus that of the dispersion."""

    rising = False

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given logarithms of slopes."""
        none, one, slope = np.zeros_like(value), np.ones_like(value), np.exp(value)
        return Line(_pair(none, slope), _pair(one, none), _pair(none, slope), _pair(none, none))

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return -np.exp(value) * places(model.position[0])[:, None]

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the likelihood of the likeliest flat line; a step is refused without end."""
        return np.where(side > 0.0, -np.inf, flat_line(model)[1])


def _pair(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.stack([first, second], axis=1)


@dataclass(frozen=True, eq=False)
class Profile:
    """What to descend from, and how far."""

    model: Probit  # the likelihood, penalised or not; one row that all ends share, or one row an end
    value: FloatArray  # its maxima, one or as many [-]
    theta: FloatArray  # rows of a and b there [-]
    quantile: float  # root of the chi-square quantile: 1.96 for 95 % [-]

    def rows(self, index: IntArray) -> "Profile":
        """Return what some of the ends descend from."""
        value, theta = (part if part.shape[0] == 1 else part[index] for part in (self.value, self.theta))
        return Profile(self.model.rows(index), value, theta, self.quantile)

    def ends(self, constraint: Constraint, start: FloatArray, error: FloatArray, side: FloatArray) -> FloatArray:
        """Return where the profile has fallen by the quantile, one end a row; infinite where it never does."""
        # over rising curves the confidence region is convex, so that what it allows is one interval
        result = side * np.inf
        closed = np.flatnonzero(self._root(constraint.limit(self.model, side)) > self.quantile)
        if closed.size:
            # a stride that is a standard error of badly fixed data would leave the range of float64
            stride = side[closed] * np.minimum(error[closed] * self.quantile, 1.0)
            result[closed] = self.rows(closed)._descend(constraint.rows(closed), start[closed], stride)
        return result

    def _root(self, value: FloatArray) -> FloatArray:
        return np.asarray(np.sqrt(2.0 * np.maximum(self.value - value, 0.0)))  # Eq. 204

    def _descend(self, constraint: Constraint, start: FloatArray, stride: FloatArray) -> FloatArray:
        """Return where the root of the fall is the quantile: Newton's method on the root, which is nearly linear."""
        low, high, most = np.zeros_like(start), np.full_like(start, np.inf), FARTHEST / np.abs(stride)
        distance = np.minimum(1.0, most)
        t = np.zeros_like(start) + self.theta[:, 1 if constraint.rising else 0]
        for _ in range(200):
            root, slope, t = self._fall(constraint, start + distance * stride, t)
            miss = root - self.quantile
            low, high = np.where(miss <= 0.0, distance, low), np.where(miss >= 0.0, distance, high)
            tight = np.isfinite(high) & (high - low <= 1e-14 * np.where(np.isfinite(high), high, 0.0))
            if np.all((np.abs(miss) <= ROOT) | tight | (low >= most)):
                break
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                guess = distance - miss / (slope * stride)
            inside = (guess > low) & (guess < high) & (guess < 4.0 * distance)
            other = np.where(np.isinf(high), 2.0 * distance, 0.5 * (low + np.where(np.isinf(high), low, high)))
            distance = np.where(np.abs(miss) <= ROOT, distance, np.minimum(np.where(inside, guess, other), most))
        return np.where(low < most, start + distance * stride, np.sign(stride) * np.inf)

    def _fall(self, constraint: Constraint, at: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the root of the fall at fixed values, its slope, and the free coefficient."""
        line = constraint.line(at)
        best = maximise_from(OnLine(self.model, line), constraint.starts(self.model, at, t))
        # a concave function that is largest at a negative slope is, over rising curves, largest at the flat one
        free = np.maximum(best.theta, 0.0) if constraint.rising else best.theta
        full = self.model.derivatives(line.origin + free * line.direction)
        root = self._root(full.value)
        change = np.sum(full.gradient * (line.moves + free * line.turns), axis=1)
        return root, -change / np.maximum(root, 1e-300), free[:, 0]
