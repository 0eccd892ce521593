"""Probit likelihood of many data sets, plain or penalised. It is stable in the far tails."""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from scipy.special import erfcx

from rocking.conventions import FloatArray

FAR = 300.0  # number of standard deviations [-]; beyond, a series avoids cancellation in the curvature
WIDEST = 1 << 16  # largest number of levels processed together; intermediate arrays need 100 bytes per level
SLOPES = np.array([0.3, 1.0, 3.0, 10.0, 30.0])  # start slopes b for the search of the maximum [-]
POSITIONS = 9  # number of start positions of the search [-]


class Tails(NamedTuple):
    """Both tails of the normal distribution: failure (lower tail) and survival (upper tail)."""

    log_failure: FloatArray  # log_failure, log_survival: ln Phi(eta) and ln Phi(-eta) [-]
    log_survival: FloatArray
    # failure_rate, survival_rate: phi(eta) / Phi(eta) and phi(eta) / Phi(-eta), the slopes of the two logarithms, up to
    # sign [-]
    failure_rate: FloatArray
    survival_rate: FloatArray
    # failure_bend, survival_bend: negative second derivatives of the two logarithms, between 0 and 1 [-]
    failure_bend: FloatArray
    survival_bend: FloatArray


def tails(eta: FloatArray) -> Tails:
    """Return logarithms, slopes and curvatures of both normal tails, with errors of 1e-15 (far curvatures 1e-11)."""
    t = np.abs(eta)
    scaled = erfcx(np.sqrt(0.5) * t)
    bell = np.exp(-0.5 * t * t)
    tail = 0.5 * scaled * bell
    log_tail, log_body = np.log(0.5 * scaled) - 0.5 * t * t, np.log1p(-tail)  # Eq. 198
    tail_rate = np.sqrt(2.0 / np.pi) / scaled
    body_rate = bell / np.sqrt(2.0 * np.pi) / (1.0 - tail)
    tail_bend = tail_rate * (tail_rate - t)
    if t.size and t.max() > FAR:
        u = 1.0 / np.maximum(t, FAR) ** 2
        tail_bend = np.where(t > FAR, 1.0 - u + 6.0 * u * u, tail_bend)
    body_bend = body_rate * (body_rate + t)
    low = eta < 0.0
    pairs = ((log_tail, log_body), (tail_rate, body_rate), (tail_bend, body_bend))
    return Tails(*(np.where(low, *pair) if first else np.where(low, *pair[::-1]) for pair in pairs for first in (1, 0)))


class Derivatives(NamedTuple):
    """A function of a few coefficients with first and second derivatives, one row per data set."""

    value: FloatArray  # values of the function [-]
    gradient: FloatArray  # gradient of the function [-]; the last axis is the coefficient
    curvature: FloatArray  # negative Hessian of the function [-]; positive definite for a strictly concave function


@dataclass(frozen=True, eq=False)
class Probit:
    """Log likelihood of failure with probability Phi(a + b u), one row per data set.

    The log likelihood is concave in (a, b), and strictly concave for data at two levels, so that a stationary point is
    the only maximum. Binomial coefficients are omitted, so that pooling equal levels has no effect.
    """

    position: FloatArray  # u, scaled logarithms of the levels; one row, or one row per data set [-]
    # failures, survivals: numbers of failures and survivals at every level [-]; one row, or one row per data set
    failures: FloatArray
    survivals: FloatArray
    concave: ClassVar[bool] = True

    def rows(self, index: Any) -> Self:
        """Return the likelihood of a subset of the data sets."""
        fields = (self.position, self.failures, self.survivals)
        return type(self)(*(field if field.shape[0] == 1 else field[index] for field in fields))

    def eta(self, theta: FloatArray) -> FloatArray:
        """Return a + b u."""
        return theta[:, :1] + theta[:, 1:2] * self.position  # Eq. 190

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the log likelihood, its gradient, and its negative Hessian (the observed information)."""
        if self.position.shape[1] > WIDEST:
            pieces = (slice(first, first + WIDEST) for first in range(0, self.position.shape[1], WIDEST))
            fields = (self.position, self.failures, self.survivals)
            terms = [type(self)(*(field[:, piece] for field in fields)).derivatives(theta) for piece in pieces]
            return Derivatives(*(np.asarray(np.sum(values, axis=0)) for values in zip(*terms, strict=True)))
        return self._of(tails(self.eta(theta)))

    def _of(self, at: Tails) -> Derivatives:
        # Eq. 194
        value = np.sum(_times(self.failures, at.log_failure) + _times(self.survivals, at.log_survival), axis=1)
        slope = self.failures * at.failure_rate - self.survivals * at.survival_rate  # Eq. 195
        bend = self.failures * at.failure_bend + self.survivals * at.survival_bend  # Eq. 196
        return Derivatives(value, self._moments(slope, 2), _matrix(self._moments(bend, 3)))

    def information(self, theta: FloatArray) -> FloatArray:
        """Return the expected (Fisher) information, one matrix per row."""
        at = tails(self.eta(theta))
        weight = (self.failures + self.survivals) * at.failure_rate * at.survival_rate  # Eq. 197
        return _matrix(self._moments(weight, 3))

    def _moments(self, weight: FloatArray, count: int) -> FloatArray:
        """Return the sums over levels of a weight multiplied by u to the powers 0 to count - 1."""
        sums = [weight.sum(axis=1)]
        for _ in range(count - 1):
            weight = weight * self.position
            sums.append(weight.sum(axis=1))
        return np.stack(sums, axis=1)


def _times(count: FloatArray, logarithm: FloatArray) -> FloatArray:
    """Return count times logarithm. 0 times minus infinity is 0, because missing trials contribute nothing."""
    if np.isfinite(logarithm).all():
        return count * logarithm
    return np.where(count > 0.0, count * np.where(count > 0.0, logarithm, 0.0), 0.0)


def _matrix(moments: FloatArray) -> FloatArray:
    return moments[:, [[0, 1], [1, 2]]]


def start_positions(position: FloatArray) -> FloatArray:
    """Return start positions with probability 0.5, evenly distributed over the levels and their midpoints."""
    candidates = np.sort(np.concatenate([position, 0.5 * (position[1:] + position[:-1])]))
    return candidates[np.linspace(0, candidates.size - 1, POSITIONS).round().astype(np.int64)]


def starts(position: FloatArray) -> FloatArray:
    """Return start coefficients. There are several, because the penalised likelihood may have several maxima."""
    start, slope = (grid.ravel() for grid in np.meshgrid(start_positions(position), SLOPES))
    return np.stack([-slope * start, slope], axis=1)


@dataclass(frozen=True, eq=False)
class PenalisedProbit(Probit):
    """Log likelihood plus half the logarithm of the determinant of the Fisher information, one row per data set.

    This function may not be concave. The result is a proven local maximum, the largest from all `starts`.
    """

    concave: ClassVar[bool] = False

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the penalised value and derivatives. The value is minus infinity for zero information."""
        eta = self.eta(theta)
        at = tails(eta)
        plain, penalty = self._of(at), self._penalty(eta, at)
        return Derivatives(*(first + second for first, second in zip(plain, penalty, strict=True)))

    def _penalty(self, eta: FloatArray, at: Tails) -> Derivatives:
        """Return half the logarithm of the determinant M0 M2 - M1^2, and its derivatives."""
        weight = (self.failures + self.survivals) * at.failure_rate * at.survival_rate
        # logarithmic derivatives of phi^2 / (Phi (1 - Phi)): first q, then q'
        q = at.survival_rate - at.failure_rate - 2.0 * eta
        q_slope = at.failure_bend + at.survival_bend - 2.0
        m = self._moments(weight, 3)
        first, second = self._moments(weight * q, 4), self._moments(weight * (q * q + q_slope), 5)
        determinant = m[:, 0] * m[:, 2] - m[:, 1] ** 2  # Eq. 202
        vanished = ~(determinant > 1e-250)
        determinant = np.where(vanished, 1.0, determinant)
        gradient = np.stack([_slope(m, first, i) for i in range(2)], axis=1) / determinant[:, None]
        bend = np.stack([np.stack([_bend(m, first, second, i, j) for j in range(2)], axis=1) for i in range(2)], axis=1)
        hessian = bend / determinant[:, None, None] - gradient[:, :, None] * gradient[:, None, :]
        # Eq. 202
        return Derivatives(np.where(vanished, -np.inf, 0.5 * np.log(determinant)), 0.5 * gradient, -0.5 * hessian)


def _slope(m: FloatArray, p: FloatArray, i: int) -> FloatArray:
    """Return the derivative of the determinant with respect to coefficient i (b raises the power of u by one)."""
    return p[:, i] * m[:, 2] + m[:, 0] * p[:, 2 + i] - 2.0 * m[:, 1] * p[:, 1 + i]  # Eq. 203


def _bend(m: FloatArray, p: FloatArray, s: FloatArray, i: int, j: int) -> FloatArray:
    """Return the second derivative of the determinant with respect to coefficients i and j."""
    own = s[:, i + j] * m[:, 2] + m[:, 0] * s[:, 2 + i + j] - 2.0 * m[:, 1] * s[:, 1 + i + j]
    return own + p[:, i] * p[:, 2 + j] + p[:, j] * p[:, 2 + i] - 2.0 * p[:, 1 + i] * p[:, 1 + j]
