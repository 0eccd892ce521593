"""Firth's penalised likelihood: the likelihood times Jeffreys' prior, whose maximum exists for separated data too.

D. Firth, Bias reduction of maximum likelihood estimates, Biometrika 80 (1993) 27-38; for probit, I. Kosmidis and
D. Firth, Jeffreys-prior penalty, finiteness and shrinkage in binomial-response generalized linear models, Biometrika
108 (2021) 71-82, who prove that the estimates are always finite. For probit the prior takes most of the bias of
maximum likelihood away, not exactly its leading term as it does for the logit.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.studies.fragility.likelihood import Derivatives, Probit, Tails, tails

SLOPES = np.array([0.3, 1.0, 3.0, 10.0, 30.0])
"""Slopes b that the search for the maximum starts from [-]."""

PLACES = 9
"""Number of positions that the search starts from [-]."""


def places(position: FloatArray) -> FloatArray:
    """Return positions, spread evenly over the levels and the gaps between, where a curve may reach one half.

    position: u, ascending [-]. Returns positions [-].
    """
    known = np.sort(np.concatenate([position, 0.5 * (position[1:] + position[:-1])]))
    return known[np.linspace(0, known.size - 1, PLACES).round().astype(np.int64)]


def starts(position: FloatArray) -> FloatArray:
    """Return coefficients to start from, since the penalised likelihood may have more than one maximum.

    position: u, ascending [-]. Returns rows of a and b [-].
    """
    place, slope = (part.ravel() for part in np.meshgrid(places(position), SLOPES))
    return np.stack([-slope * place, slope], axis=1)


@dataclass(frozen=True, eq=False)
class PenalisedProbit(Probit):
    """Log likelihood plus half the logarithm of the determinant of the Fisher information, one row a data set.

    It need not be concave: a maximum that is found is proven to be a local one, the largest from all `starts`.
    """

    concave: ClassVar[bool] = False

    def derivatives(self, theta: FloatArray) -> Derivatives:
        """Return the penalised log likelihood with its gradient and minus its Hessian.

        theta: rows of a and b [-]. Returns one row a data set; minus infinity where the information vanishes.
        """
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
    """Return the derivative of the determinant with respect to coefficient i (a shifts no power of u, b one)."""
    return p[:, i] * m[:, 2] + m[:, 0] * p[:, 2 + i] - 2.0 * m[:, 1] * p[:, 1 + i]  # Eq. 203


def _bend(m: FloatArray, p: FloatArray, s: FloatArray, i: int, j: int) -> FloatArray:
    """Return the second derivative of the determinant with respect to coefficients i and j."""
    own = s[:, i + j] * m[:, 2] + m[:, 0] * s[:, 2 + i + j] - 2.0 * m[:, 1] * s[:, 1 + i + j]
    return own + p[:, i] * p[:, 2 + j] + p[:, j] * p[:, 2 + i] - 2.0 * p[:, 1 + i] * p[:, 1 + j]
