"""Profile-likelihood intervals and bands, which contain all values that the data do not reject."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.statistics.maximum_likelihood import maximise, maximise_from
from rocking.statistics.probit import SLOPES, Derivatives, Probit, start_positions

FARTHEST = 300.0  # an end at a larger distance is open [-]
ROOT = 1e-10  # tolerance of the root of the likelihood decrease at an end [-]


class Line(NamedTuple):
    """Curves with one constraint: theta = origin + t direction."""

    origin: FloatArray  # origin, direction: rows of a and b [-]
    direction: FloatArray
    moves: FloatArray  # the derivative of theta with respect to the fixed quantity is `moves` + t `turns` [-]
    turns: FloatArray  # see `moves` [-]


@dataclass(frozen=True, eq=False)
class OnLine:
    """The likelihood along lines, as a function of t only."""

    model: Probit  # the likelihood, with one common row or one row per end
    line: Line  # the lines, one line per row

    def rows(self, index: Any) -> Self:
        return type(self)(self.model.rows(index), Line(*(field[index] for field in self.line)))

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the values and derivatives with respect to t, one per row."""
        full, direction = self.model.derivatives(self.line.origin + theta * self.line.direction), self.line.direction
        bend = np.einsum("si,sij,sj->s", direction, full.curvature, direction)
        return Derivatives(full.value, np.sum(full.gradient * direction, axis=1)[:, None], bend[:, None, None])


def flat_line(model: Probit) -> tuple[FloatArray, FloatArray]:
    """Return the maximum-likelihood variates of constant probability, and their log likelihoods."""
    ones = np.ones((model.failures.shape[0], 2))
    line = Line(0.0 * ones, ones * [1.0, 0.0], 0.0 * ones, 0.0 * ones)
    best = maximise(OnLine(model, line), np.zeros((ones.shape[0], 1)))
    return best.theta[:, 0], best.value


@dataclass(frozen=True, eq=False)
class Constraint(ABC):
    """A quantity of the curve with fixed values, one value per row."""

    rising = True
    """True if the free coefficient is the slope b, which must not become negative."""

    @abstractmethod
    def line(self, value: FloatArray) -> Line:
        """Return the curves with given values of the quantity."""

    @abstractmethod
    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the limit of the profile log likelihood at the end of its range; minus infinity if none."""

    def starts(self, model: Probit, value: FloatArray, free: FloatArray) -> FloatArray:
        """Return start values of the free coefficients (first axis). A concave likelihood has one start value."""
        others = np.zeros((0, free.size)) if model.concave else self._others(model, value)
        return np.concatenate([free[None], others])[:, :, None]

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return np.repeat(np.append(0.0, SLOPES)[:, None], value.size, axis=1)

    def rows(self, index: Any) -> Self:
        return type(self)(*(value[index] for value in vars(self).values()))


@dataclass(frozen=True, eq=False)
class FractileConstraint(Constraint):
    """The position u at which the curve has given probabilities."""

    variate: FloatArray  # standard normal variates of the probabilities, one per row [-]

    def line(self, value: FloatArray) -> Line:
        """Return the curves through the probability at given positions."""
        zeros, ones = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(self.variate, zeros), _pair(-value, ones), _pair(zeros, zeros), _pair(-ones, zeros))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the largest likelihood of a constant probability below (above) the given probability."""
        flat = flat_line(model)[0]
        height = np.where(side > 0.0, np.minimum(flat, self.variate), np.maximum(flat, self.variate))
        return model.derivatives(_pair(height, np.zeros_like(side))).value


@dataclass(frozen=True, eq=False)
class ProbabilityConstraint(Constraint):
    """The variate a + b u of the probability at given positions."""

    position: FloatArray  # u, one per row [-]

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given variates at the positions."""
        zeros, ones = np.zeros_like(value), np.ones_like(value)
        return Line(_pair(value, zeros), _pair(-self.position, ones), _pair(ones, zeros), _pair(zeros, zeros))

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return minus infinity, because overlapping data exclude probabilities of 0 and 1."""
        return np.full_like(side, -np.inf)


@dataclass(frozen=True, eq=False)
class SlopeConstraint(Constraint):
    """The logarithm of the slope b, which is the negative logarithm of the dispersion."""

    rising = False

    def line(self, value: FloatArray) -> Line:
        """Return the curves with given logarithms of slopes."""
        zeros, ones, slope = np.zeros_like(value), np.ones_like(value), np.exp(value)
        return Line(_pair(zeros, slope), _pair(ones, zeros), _pair(zeros, slope), _pair(zeros, zeros))

    def _others(self, model: Probit, value: FloatArray) -> FloatArray:
        return -np.exp(value) * start_positions(model.position[0])[:, None]

    def limit(self, model: Probit, side: FloatArray) -> FloatArray:
        """Return the largest likelihood of a constant probability; minus infinity for a step."""
        return np.where(side > 0.0, -np.inf, flat_line(model)[1])


def _pair(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.stack([first, second], axis=1)


@dataclass(frozen=True, eq=False)
class Profile:
    """A maximum of the likelihood, and the decrease that defines an interval."""

    model: Probit  # the likelihood, penalised or not, with one common row or one row per end
    value: FloatArray  # maxima of the likelihood [-], one maximum or one per row
    theta: FloatArray  # rows of a and b at the maxima [-]
    quantile: float  # root of the chi-square quantile [-], 1.96 for 95 %

    def rows(self, index: IntArray) -> "Profile":
        """Return a subset of the rows."""
        value, theta = (field if field.shape[0] == 1 else field[index] for field in (self.value, self.theta))
        return Profile(self.model.rows(index), value, theta, self.quantile)

    def ends(self, constraint: Constraint, start: FloatArray, error: FloatArray, side: FloatArray) -> FloatArray:
        """Return the ends at which the profile has decreased by the quantile, one per row. They may be infinite."""
        # for rising curves, the confidence region is convex, so that it is one interval
        result = side * np.inf
        closed = np.flatnonzero(self._root(constraint.limit(self.model, side)) > self.quantile)
        if closed.size:
            # a step of a large standard error would leave the range of float64
            stride = side[closed] * np.minimum(error[closed] * self.quantile, 1.0)
            result[closed] = self.rows(closed)._descend(constraint.rows(closed), start[closed], stride)
        return result

    def _root(self, value: FloatArray) -> FloatArray:
        return np.asarray(np.sqrt(2.0 * np.maximum(self.value - value, 0.0)))  # Eq. 204

    def _descend(self, constraint: Constraint, start: FloatArray, stride: FloatArray) -> FloatArray:
        """Return the ends at which the root of the decrease equals the quantile, by Newton's method (nearly linear)."""
        low, high, largest = np.zeros_like(start), np.full_like(start, np.inf), FARTHEST / np.abs(stride)
        distance = np.minimum(1.0, largest)
        t = np.zeros_like(start) + self.theta[:, 1 if constraint.rising else 0]
        for _ in range(200):
            root, slope, t = self._fall(constraint, start + distance * stride, t)
            miss = root - self.quantile
            low, high = np.where(miss <= 0.0, distance, low), np.where(miss >= 0.0, distance, high)
            tight = np.isfinite(high) & (high - low <= 1e-14 * np.where(np.isfinite(high), high, 0.0))
            if np.all((np.abs(miss) <= ROOT) | tight | (low >= largest)):
                break
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                guess = distance - miss / (slope * stride)
            inside = (guess > low) & (guess < high) & (guess < 4.0 * distance)
            other = np.where(np.isinf(high), 2.0 * distance, 0.5 * (low + np.where(np.isinf(high), low, high)))
            distance = np.where(np.abs(miss) <= ROOT, distance, np.minimum(np.where(inside, guess, other), largest))
        return np.where(low < largest, start + distance * stride, np.sign(stride) * np.inf)

    def _fall(self, constraint: Constraint, at: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the root of the decrease at fixed values, its slope, and the free coefficient."""
        line = constraint.line(at)
        best = maximise_from(OnLine(self.model, line), constraint.starts(self.model, at, t))
        # if a concave function has its maximum at a negative slope, the best rising curve is flat
        free = np.maximum(best.theta, 0.0) if constraint.rising else best.theta
        full = self.model.derivatives(line.origin + free * line.direction)
        root = self._root(full.value)
        change = np.sum(full.gradient * (line.moves + free * line.turns), axis=1)
        return root, -change / np.maximum(root, 1e-300), free[:, 0]
