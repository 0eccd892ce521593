"""Prior and posterior of an identification: a mixture of normal distributions over a grid of scatter and noise."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from scipy.special import ndtr

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot, IntArray
from rocking.errors import InvalidValueError
from rocking.identification import state_space
from rocking.identification.state_space import SHARED, Laplace, Model, Observer, laplace

SCATTERS: Final = (1e-4, 0.3)
"""Smallest and largest standard deviation of ln r at an impact, if ln r scatters [-]."""

NO_SCATTER: Final = 0.2
"""Prior probability that ln r does not scatter [-]."""

_SMALL_SCATTER = 0.02
"""The prior is flat in a smaller scatter, and flat in the logarithm of a larger scatter; usual: 1 to 3 % [-]."""

_COARSE, _FINE, _NEGLIGIBLE = (9, 7), (11, 9), 1e-4
_BELOW_ROUNDING = 1e-19  # weight of a node that changes no probability of a mixture of a hundred nodes

Nodes = tuple[FloatArray, FloatArray]
"""Values of a scatter or a noise, and the logarithms of their prior probabilities."""


@dataclass(frozen=True)
class Noise:
    """Prior of the noise: median, and standard deviation of the logarithm (0 for a known noise)."""

    median: float
    dispersion: float = 0.0


@dataclass(frozen=True, eq=False)
class Posterior:
    """Weighted normal distributions of the unknowns, one per pair of scatter and noise in a grid of size g."""

    model: Model
    weights: FloatArray  # weights of the distributions, shape (g,)
    scatter: FloatArray  # standard deviation of ln r at an impact, shape (g,)
    noise: FloatArray  # standard deviation of the noise, shape (g,)
    u: FloatArray  # means of the d unknowns, shape (g, d)
    covariance: FloatArray  # covariances of the unknowns, shape (g, d, d)
    residuals: FloatArray  # measured minus computed values, shape (g, m)
    evidence: float  # ln of the probability density of the measurement
    converged: bool

    def normal(self, slopes: FloatArray, offset: float = 0.0) -> "Mixture":
        """Return the distribution of offset + slopes . u, for slopes of shape (d,) or (g, d)."""
        slopes = np.broadcast_to(slopes, self.u.shape)
        spread = np.sqrt(np.einsum("gi,gij,gj->g", slopes, self.covariance, slopes))
        return Mixture(self.weights, offset + (slopes * self.u).sum(axis=1), spread)

    def shared(self, *terms: tuple[int, float]) -> "Mixture":
        """Return the distribution of a weighted sum of the parameters shared by all impacts."""
        slopes = np.zeros(self.model.size)
        for which, factor in terms:
            slopes[which] = factor * self.model.deviation[which]
        return self.normal(slopes, sum(factor * float(self.model.mean[which]) for which, factor in terms))

    def explained(self, which: int, by: Sequence[int]) -> float:
        """Return the fraction of the standard deviation of a shared parameter that other shared parameters explain."""
        across, among = self.covariance[:, which, by], self.covariance[:, by][:, :, by]
        variance = np.einsum("gi,gij,gj->g", across, np.linalg.pinv(among, hermitian=True), across)
        return float(self.model.deviation[which] * np.sqrt(self.weights @ variance))

    def standardized_residuals(self, observer: Observer) -> FloatArray:
        """Return each residual divided by its standard deviation [-]."""
        best = [int(np.argmax(self.weights))]
        residual, slopes = observer.residuals(self.model.path(self.u[best], self.scatter[best]))
        noise, slopes = float(self.noise[best[0]]), slopes[0]
        leverage = np.einsum("mi,ij,mj->m", slopes, self.covariance[best[0]], slopes) / noise**2
        return np.asarray(residual[0] / (noise * np.sqrt(np.maximum(1.0 - leverage, 1e-9))))  # Eq. 325

    @property
    def no_scatter(self) -> float:
        """Probability that ln r does not scatter [-]."""
        return float(self.weights[self.scatter == 0.0].sum())

    def average(self, values: FloatArray) -> FloatArray:
        """Return the mean over the grid."""
        return np.asarray(np.tensordot(self.weights, values, axes=1))


@dataclass(frozen=True, eq=False)
class Mixture:
    """A mixture of normal distributions."""

    weights: FloatArray
    means: FloatArray
    deviations: FloatArray

    @property
    def mean(self) -> float:
        """Mean."""
        return float(self.weights @ self.means)

    @property
    def deviation(self) -> float:
        """Standard deviation."""
        return float(np.sqrt(self.weights @ (self.deviations**2 + (self.means - self.mean) ** 2)))

    def below(self, value: float) -> float:
        """Return the probability of values below `value`."""
        return float(self.weights @ ndtr((value - self.means) / np.maximum(self.deviations, 1e-300)))

    def quantiles(self, *levels: float) -> tuple[float, ...]:
        """Return the quantiles at the given probabilities."""
        low = np.full(len(levels), (self.means - 9.0 * self.deviations).min())
        high = np.full(len(levels), (self.means + 9.0 * self.deviations).max())
        kept = self.weights > _BELOW_ROUNDING
        weights, means, deviations = self.weights[kept], self.means[kept], np.maximum(self.deviations[kept], 1e-300)
        for _ in range(60):
            middle = 0.5 * (low + high)
            under = ndtr((middle[:, None] - means) / deviations) @ weights < np.array(levels)
            low, high = np.where(under, middle, low), np.where(under, high, middle)
        return tuple((0.5 * (low + high)).tolist())


def posterior(
    model: Model, observer: Observer, scatter: float | None, noise: Noise, start: Callable[[FloatArray], FloatArray]
) -> Posterior:
    """Return the posterior. `scatter` is a known scatter of ln r. `start` gives first unknowns for scatters."""
    scatters = _first_nodes(_COARSE[0]) if scatter is None else (np.array([scatter]), np.zeros(1))
    noise_ends = np.log(noise.median) + noise.dispersion * np.array([-3.0, 3.0])
    coarse = _on_grid(model, observer, scatters, _noise_nodes(noise, noise_ends, _COARSE[1]), start)
    if scatter is not None and noise.dispersion == 0.0:
        return coarse
    best = int(np.argmax(coarse.weights))

    def near(scatters: FloatArray) -> FloatArray:
        return rescaled(coarse.u[best], float(coarse.scatter[best]), scatters)

    if scatter is None:
        scatters = scatter_nodes(_narrowed(np.log(SCATTERS), coarse.scatter, coarse.weights), _FINE[0])
    if noise.dispersion > 0.0:
        noise_ends = _narrowed(noise_ends, coarse.noise, coarse.weights)
    return _on_grid(model, observer, scatters, _noise_nodes(noise, noise_ends, _FINE[1]), near)


def rescaled(u: FloatArray, at: float, scatters: FloatArray) -> FloatArray:
    """Return the unknowns of the impacts in units of other scatters; zero for a scatter of zero."""
    rows = np.repeat(u[None, :], scatters.size, axis=0)
    rows[:, len(SHARED) :] *= np.divide(at, scatters, out=np.zeros_like(scatters), where=scatters > 0.0)[:, None]
    return rows


def scatter_nodes(ends: FloatArray, count: int) -> Nodes:
    """Return a scatter of zero and scatters between two ends with prior probabilities; the ends are logarithms."""
    values, step = np.exp(np.linspace(ends[0], ends[1], count)), (ends[1] - ends[0]) / (count - 1)
    ln = np.log1p(-NO_SCATTER) + _ln_scatter_density(values) + np.log(step)  # Eq. 324
    return np.concatenate([[0.0], values]), np.concatenate([[np.log(NO_SCATTER)], ln])


def _first_nodes(count: int) -> Nodes:
    """Return the scatters of the first grid. The smallest scatter also has the probability of no scatter."""
    values, ln = scatter_nodes(np.log(SCATTERS), count)
    return values[1:], np.concatenate([[np.logaddexp(ln[0], ln[1])], ln[2:]])


def _ln_scatter_density(scatters: FloatArray) -> FloatArray:
    """Return ln of the density of ln(scatter): flat in small scatters, and flat in the logarithm of large scatters."""
    low, high = (np.log(limit + _SMALL_SCATTER) for limit in SCATTERS)
    return np.asarray(np.log(scatters / (scatters + _SMALL_SCATTER) / (high - low)))  # Eq. 273


def _noise_nodes(noise: Noise, ends: FloatArray, count: int) -> Nodes:
    """Return noises between two ends with their prior probabilities; the ends are logarithms."""
    if noise.dispersion == 0.0:
        return np.array([noise.median]), np.zeros(1)
    values, step = np.exp(np.linspace(ends[0], ends[1], count)), (ends[1] - ends[0]) / (count - 1)
    z = np.log(values / noise.median) / noise.dispersion
    return values, -0.5 * z * z + np.log(step / (noise.dispersion * np.sqrt(2.0 * np.pi)))


def interval_of_nodes(values: FloatArray, weights: FloatArray) -> tuple[float, float, float]:
    """Return median, 2.5 % and 97.5 % quantile of a scatter or a noise with weights on a grid.

    The median and the lower quantile are zero if zero has at least this probability. The upper quantile is that of the
    positive values, so that it limits an undetected scatter.
    """
    nodes = np.unique(values)
    mass = np.array([weights[values == node].sum() for node in nodes])
    at_zero, is_positive = float(mass[nodes == 0.0].sum()), nodes > 0.0
    nodes, mass = nodes[is_positive], mass[is_positive]
    if nodes.size < 2 or mass.sum() == 0.0:
        return (float(nodes[0]),) * 3 if nodes.size else (0.0, 0.0, 0.0)
    middle = np.cumsum(mass) - 0.5 * mass
    levels = [0.5 - at_zero, 0.025 - at_zero, 0.975 * mass.sum()]
    median, low, high = np.exp(np.interp(levels, middle, np.log(nodes))).tolist()
    return 0.0 if at_zero >= 0.5 else median, 0.0 if at_zero >= 0.025 else low, high


def _narrowed(ends: FloatArray, values: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the logarithms of the smallest and largest node above zero with relevant weight."""
    levels = np.unique(values[values > 0.0])
    mass = np.array([weights[values == level].sum() for level in levels])
    kept = np.flatnonzero(mass >= _NEGLIGIBLE * mass.max())
    step = np.diff(np.log(levels)).mean()
    low, high = np.log(levels[kept[0]]) - 0.5 * step, np.log(levels[kept[-1]]) + 0.5 * step
    return np.array([max(low, ends[0]), min(high, ends[1])])


def _on_grid(
    model: Model, observer: Observer, scatter: Nodes, noise: Nodes, start: Callable[[FloatArray], FloatArray]
) -> Posterior:
    scatters, noises = (grid.ravel() for grid in np.meshgrid(scatter[0], noise[0], indexing="ij"))
    approximation: Laplace = laplace(model, observer, scatters, noises, start(scatters))
    prior = np.add.outer(scatter[1], noise[1]).ravel()
    ln = np.where(np.isfinite(approximation.evidence), approximation.evidence + prior, -np.inf)
    top = ln.max()
    weights = np.exp(ln - top)
    total = weights.sum()
    return Posterior(
        model, weights / total, scatters, noises, approximation.u, approximation.covariance, approximation.residuals,
        float(top + np.log(total)), bool(approximation.converged[weights > 0.05].all()),
    )  # fmt: skip


LEVEL: Final = math.radians(0.3)
"""Standard deviation of the tilt of an ordinary floor [rad]."""

UNKNOWN_FREQUENCIES: Final = (1.3, 2.0, 3.1, 4.8, 7.4, 11.5)
"""Tried frequency parameters of an unknown body [rad/s]."""

_UNKNOWN = (0.25, 0.22, 0.5)  # for an unknown body: deviation of ln p, slenderness angle, deviation of its logarithm


@dataclass(frozen=True)
class Knowledge:
    """Prior knowledge. A standard deviation of zero means a certain value."""

    body: Body | None
    size_error: float  # relative standard deviation of a length of the body
    tilt: float  # tilt of the floor [rad]
    tilt_error: float
    asymmetry: float  # standard deviation of the difference of ln r between both feet
    trend: bool
    damping: bool
    first: Foot  # foot in contact after the first impact

    @classmethod
    def checked(
        cls, body: Any, size_error: Any, tilt: Any, asymmetry: Any, *, trend: bool, damping: bool, first: Any
    ) -> "Knowledge":
        """Return the checked input of the user."""
        if body is not None and not isinstance(body, Body):
            raise InvalidValueError(
                parameter="body", allowed="a Block, Section or MassPoints", value=body, hint="in_plane() of a solid"
            )
        angle, error = (0.0, tilt) if np.ndim(tilt) == 0 else tilt
        return cls(
            body,
            checks.within("size_error", size_error, 0.0, 0.2),
            checks.within("tilt", angle, -0.1, 0.1, unit="rad"),
            checks.within("standard deviation of tilt", error, 0.0, 0.1, unit="rad"),
            checks.within("asymmetry", asymmetry, 0.0, 1.0),
            trend,
            damping,
            checks.foot("first", first),
        )

    @property
    def frequencies(self) -> tuple[tuple[float, float], ...]:
        """First mean values of ln p, with their standard deviations."""
        if self.body is None:
            return tuple((math.log(p), _UNKNOWN[0]) for p in UNKNOWN_FREQUENCIES)
        return ((0.5 * math.log(self._p[0] * self._p[1]), 0.5 * self.size_error),)

    @property
    def slenderness_angles(self) -> tuple[float, float]:
        """Slenderness angles for the right and the left foot [rad]."""
        if self.body is None:
            return _UNKNOWN[1], _UNKNOWN[1]
        return self.body.side("right").slenderness_angle, self.body.side("left").slenderness_angle

    @property
    def alternation(self) -> tuple[float, float]:
        """Change of ln y at an impact onto the first side due to unequal sides, and its standard deviation."""
        right, left = self.slenderness_angles
        floor = math.hypot(self.tilt, self.tilt_error) / min(right, left)
        # change of the overturning speed from the second side to the first, for asymmetric bodies
        speeds = [math.log(p * 2.0 * math.sin(0.5 * alpha)) for p, alpha in zip(self._p, (right, left), strict=True)]
        change = speeds[1] - speeds[0]
        return change if self.first == "right" else -change, max(math.hypot(0.5 * self.asymmetry, floor), 0.01)

    @property
    def _p(self) -> tuple[float, float]:
        """Frequency parameters for the right and the left foot; 1 for an unknown body [rad/s]."""
        if self.body is None:
            return 1.0, 1.0
        return self.body.side("right").frequency_parameter, self.body.side("left").frequency_parameter

    def sides(self, count: int) -> IntArray:
        """Return the side of each half cycle: 0 for right, 1 for left."""
        return (np.arange(count) + (self.first == "left")) % 2

    def model(self, sides: IntArray, start: float, speeds: FloatArray, frequency: tuple[float, float]) -> Model:
        """Return the model from the first time, ln of the speeds, and mean and deviation of ln p (`frequency`)."""
        mean, deviation = np.zeros(len(SHARED)), np.zeros(len(SHARED))
        p = np.array([math.exp(frequency[0])] * 2)
        slender = math.sqrt(2.0) * self.size_error
        if self.body is None:
            slender = _UNKNOWN[2]
            frequency = (frequency[0], 3.0 * _UNKNOWN[0])
        else:
            p = np.array(self._p)
        mean[state_space.START], deviation[state_space.START] = start, 1.0
        mean[state_space.SPEED], deviation[state_space.SPEED] = speeds[0], 2.0
        mean[state_space.MEAN], deviation[state_space.MEAN] = -0.1, 0.2
        deviation[state_space.HALF] = 0.5 * self.asymmetry
        deviation[state_space.FREQUENCY] = frequency[1]
        mean[state_space.TILT], deviation[state_space.TILT] = self.tilt, self.tilt_error
        deviation[state_space.SLENDERNESS] = slender
        deviation[state_space.TREND] = 0.05 if self.trend else 0.0
        deviation[state_space.DAMPING] = 0.02 if self.damping else 0.0
        middle = float(speeds[:-1].mean())  # mean over the impacts, the reference of the mean coefficient with a trend
        return Model(sides, self.slenderness_angles, (float(p[0]), float(p[1])), mean, deviation, middle)
