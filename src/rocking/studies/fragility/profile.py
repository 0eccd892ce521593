"""Profile-likelihood intervals and bands: every value that the data do not reject, however lopsided.

Each end is where twice the fall of the constrained maximum reaches the chi-square quantile of one degree of freedom
(Wilks 1938). Over rising curves the confidence region is convex, so that what it allows is one interval.
"""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.studies.fragility.constraints import Constraint
from rocking.studies.fragility.likelihood import Probit
from rocking.studies.fragility.lines import OnLine
from rocking.studies.fragility.maximum import maximise_from

FARTHEST = 300.0
"""Distance at which an end counts as open [-]."""

ROOT = 1e-10
"""Error of the root of the fall at which an end is found [-]."""


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
        """Return where the profile has fallen by the quantile, one end a row.

        start: its value at the maximum [-]; error: its standard error, for the first step [-]. Returns the ends;
        infinite where the profile never falls that far.
        """
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
