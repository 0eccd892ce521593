"""Laws of the coefficient of restitution: constant, dependent on speed, or random."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np

from rocking import checks
from rocking.conventions import FEET, FloatArray, Foot
from rocking.dynamics.content import fields_of, hash_of
from rocking.errors import InvalidValueError

_MASK = (1 << 64) - 1
_MOST_POINTS = 100_000
# limit of coefficients by side; the energy bound of one side may exceed 1, and values above the bound are truncated
_MOST_BY_SIDE = 10.0


class ImpactLaw:
    """Base class of the laws. A law gives a factor on the coefficient of restitution of the side of landing.

    A user-defined law overrides `factor`, and `largest` if the factor can exceed 1. It runs on the reference engine.
    For studies, a user-defined law must be a dataclass of numbers, texts and arrays, or define `content`.

    Attributes
    ----------
    kind : int
        0: constant; 1: table over the speed; 2: random number; -1: law defined by `factor` only.
    per_history : bool
        True if all impacts of a history use the same random number. The law then defines `draws` for many histories.
    at, factors : ndarray
        The table, for laws with a table.
    seed : int
        Seed of the draws.
    """

    kind: ClassVar[int] = -1
    per_history: ClassVar[bool] = False
    at: FloatArray
    factors: FloatArray
    seed: int

    def __init__(self) -> None:
        if type(self) is ImpactLaw:
            raise InvalidValueError(
                "ImpactLaw is a base class; use ConstantRestitution, SpeedRestitution, RandomRestitution or a subclass "
                "with factor()"
            )

    @property
    def tabulated(self) -> bool:
        """True if the fast engine supports the law. User-defined laws run on the reference engine."""
        return type(self).__module__ == __name__

    @property
    def largest(self) -> float:
        """Largest possible factor [-]."""
        factors = getattr(self, "factors", None)
        return 1.0 if factors is None else float(factors.max())

    @property
    def smallest(self) -> float:
        """Smallest possible factor; 0 for a law without a table [-]."""
        factors = getattr(self, "factors", None)
        return 0.0 if factors is None else float(factors.min())

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return the factor on the coefficient of restitution for one impact.

        Parameters
        ----------
        speed : float
            Angular velocity before the impact, without its sign [rad/s].
        stream : int
            Number of the history.
        impact : int
            Number of earlier impacts of the history.

        Returns
        -------
        float
            Factor on the side's coefficient [-].
        """
        raise NotImplementedError

    def content(self) -> dict[str, Any]:
        """Return the values that, together with the class, define the law.

        Returns
        -------
        dict
            Plain values: the seed and the hashes of the tables. For a user-defined dataclass, its fields.
        """
        return self._tables() if self.tabulated else fields_of(self)

    def _tables(self) -> dict[str, Any]:
        tables = {name: hash_of(np.asarray(getattr(self, name))) for name in ("at", "factors") if hasattr(self, name)}
        return {"seed": int(getattr(self, "seed", 0)), **tables}

    def draws(self, numbers: Any) -> FloatArray:
        """Return the factors on the coefficient of restitution, for a law with one random number per history.

        Parameters
        ----------
        numbers : array_like of int
            Indices of the histories.

        Returns
        -------
        ndarray
            Factors on the side's coefficient [-].
        """
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class ConstantRestitution(ImpactLaw):
    """Constant coefficient of restitution of each side.

    Parameters
    ----------
    at, factors : ndarray, optional
        [0] and [1]: the factor does not depend on speed.
    seed : int, optional
        Not used.
    """

    kind: ClassVar[int] = 0
    at: FloatArray = field(default_factory=lambda: np.zeros(1))
    factors: FloatArray = field(default_factory=lambda: np.ones(1))
    seed: int = 0

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return 1 [-]."""
        return 1.0


@dataclass(frozen=True, eq=False)
class SpeedRestitution(ImpactLaw):
    """Coefficient that depends on impact speed: linear between the given points, constant outside.

    Parameters
    ----------
    at : array_like
        Absolute values of the angular velocity before the impact, increasing [rad/s].
    factors : array_like
        Coefficients at these velocities [-]. If `times` is given, factors on `times`.
    times : optional
        Coefficient, model or name of a model, which the factors multiply; default 1.
    seed : int, optional
        Not used.

    Raises
    ------
    InvalidValueError
        If the speeds do not increase, or a coefficient is outside [0, 1].

    Examples
    --------
    >>> SpeedRestitution([0.0, 1.0], [0.75, 0.25]).factor(0.5, 0, 0)
    0.5
    """

    kind: ClassVar[int] = 1
    at: FloatArray
    factors: FloatArray
    times: Any = 1.0
    seed: int = 0

    def __post_init__(self) -> None:
        speeds = checks.finite("at", self.at, "rad/s", minimum=2)
        if speeds[0] < 0.0 or np.any(np.diff(speeds) <= 0.0):
            raise InvalidValueError(
                parameter="at", allowed="speeds >= 0 that increase [rad/s]", value=speeds[:4].tolist()
            )
        factors = checks.finite("factors", self.factors, minimum=2)
        if factors.size != speeds.size:
            raise InvalidValueError(
                "{parameter} must have one value per speed, {speeds}, got {count}", parameter="factors",
                speeds=speeds.size, count=factors.size,
            )  # fmt: skip
        object.__setattr__(self, "at", speeds)
        object.__setattr__(self, "factors", _factors(factors))

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return the coefficient at a speed [-]."""
        return interpolated(self.at, self.factors, speed)


@dataclass(frozen=True, eq=False)
class DrawnRestitution(ImpactLaw):
    """Base class of random coefficients. Quantiles define the distribution.

    Values that would create energy are excluded: the distribution is truncated at the energy bound of each side. Both
    sides use the same random number, so that a coefficient is large on both sides or small on both sides. For the
    parameters see `RandomRestitution`.
    """

    kind: ClassVar[int] = 2
    factors: Any  # an array after the checks: one row for both sides, or two rows, right side first
    seed: int
    times: Any = 1.0
    cut: tuple[float, float] = (0.0, 0.0)
    at: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        quantiles = _by_side(self.factors)
        if np.any(np.diff(quantiles) < 0.0):
            raise InvalidValueError("factors must be quantiles, and must not decrease")
        object.__setattr__(self, "seed", checks.whole("seed", self.seed, 0, _MASK))
        cut = checks.finite("cut", self.cut, shape=(2,))
        if not np.all((cut >= 0.0) & (cut < 1.0)):
            raise InvalidValueError(
                parameter="cut", allowed="two probabilities in [0, 1), left and right", value=self.cut
            )
        object.__setattr__(self, "cut", (float(cut[0]), float(cut[1])))
        object.__setattr__(self, "factors", quantiles)
        object.__setattr__(self, "at", np.linspace(0.0, 1.0, quantiles.shape[-1]))

    @classmethod
    def normal(cls, mean: float, deviation: float, *, seed: int, times: Any = 1.0, points: int = 1025) -> Self:
        """Return a law with a normal distribution truncated to [0, 1].

        Parameters
        ----------
        mean, deviation : float
            Mean and standard deviation of the distribution before truncation [-].
        seed : int
            Seed of the draws.
        times : optional
            Coefficient, model or name of a model, which the random values multiply.
        points : int
            Number of quantiles, from 2 to 100,000.

        Returns
        -------
        DrawnRestitution
            The law, of the class on which the method is called.

        Raises
        ------
        InvalidValueError
            If a value is outside its range.
        """
        from scipy.special import ndtr, ndtri

        points = checks.whole("points", points, 2, _MOST_POINTS)
        mean = checks.within("mean", mean, 0.0, 1.0)
        deviation = checks.within("deviation", deviation, 0.0, 1.0, open_low=True)
        low, high = ndtr((0.0 - mean) / deviation), ndtr((1.0 - mean) / deviation)
        levels = low + (high - low) * np.linspace(0.0, 1.0, points)
        # the ends of a normal distribution are infinite; therefore, the outermost levels are moved inwards by 1/4 step
        inside = np.clip(levels, low + 0.25 * (high - low) / points, high - 0.25 * (high - low) / points)
        return cls(np.clip(mean + deviation * ndtri(inside), 0.0, 1.0), seed, times)

    @classmethod
    def of_sample(cls, values: Any, *, seed: int, times: Any = 1.0) -> Self:
        """Return a law with the distribution of measured or simulated values, for example a posterior.

        Parameters
        ----------
        values : array_like, or mapping of foot to array_like
            Values of the coefficient or factor, for both sides or by foot [-].
        seed : int
            Seed of the draws.
        times : optional
            Coefficient, model or name of a model, which the random values multiply.

        Returns
        -------
        DrawnRestitution
            The law, of the class on which the method is called.
        """
        if isinstance(values, Mapping):
            return cls({foot: _quantiles_of(sample) for foot, sample in values.items()}, seed, times)
        return cls(_quantiles_of(values), seed, times)

    @property
    def truncates(self) -> bool:
        """True if the law truncates at the energy bound.

        Laws of other classes raise an error if they exceed the bound.
        """
        return type(self).__module__.partition(".")[0] == "rocking"

    def table(self, foot: Foot | None = None) -> FloatArray:
        """Return the quantiles for landings on a foot, at equally spaced probabilities from 0 to 1 [-]."""
        if self.factors.ndim == 1:
            return np.asarray(self.factors)
        if foot is None:
            raise InvalidValueError("this law has one table per foot; give foot='left' or foot='right'")
        return np.asarray(self.factors[int(checks.foot("foot", foot) == "left")])

    def quantile(self, probability: float, foot: Foot | None = None) -> float:
        """Return the quantile of a probability [-]."""
        return interpolated(self.at, self.table(foot), probability)

    def share_within(self, most: float, foot: Foot) -> float:
        """Return the probability of values up to a bound [-]."""
        table = self.table(foot)
        k = int(np.searchsorted(table, most, side="right"))
        if k in {0, table.size}:
            return float(k > 0)
        fraction = (most - table[k - 1]) / (table[k] - table[k - 1])
        return float(self.at[k - 1] + (self.at[k] - self.at[k - 1]) * fraction)  # Eq. 42

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return the random value for an impact, for a law with the same table on both sides [-]."""
        return self.draw(stream, impact)

    def draw(self, stream: int, impact: int, foot: Foot | None = None, share: float = 1.0) -> float:
        """Return the random value for an impact on a foot, from the lower fraction `share` of the distribution [-]."""
        return self.quantile(share * uniform(self.seed, stream, 0 if self.per_history else impact), foot)  # Eq. 41


class RandomRestitution(DrawnRestitution):
    """Random coefficient for every impact. Equal seed, history and impact give an equal coefficient.

    Coefficients that would increase the energy are excluded. Each side has its own bound, see `DrawnRestitution`.

    Parameters
    ----------
    factors : array_like, or mapping of foot to array_like
        Quantiles of the distribution at equally spaced probabilities from 0 to 1, for both sides or by
        ``{"left": .., "right": ..}`` [-].
    seed : int
        Seed of the draws.
    times : optional
        Coefficient, model or name of a model, which the random values multiply; default 1.
    cut : (float, float)
        Probability that was truncated from the quantiles, for the left and the right foot [-].

    Raises
    ------
    InvalidValueError
        If the quantiles decrease or are outside [0, 1] (by side: outside [0, 10]), or if the seed is not a whole number
        from 0 to 2^64 - 1.

    Examples
    --------
    >>> law = RandomRestitution.normal(0.9, 0.02, seed=1)
    >>> law.factor(1.0, 0, 3) == law.factor(2.0, 0, 3) != law.factor(1.0, 0, 4)
    True
    """


def interpolated(at: FloatArray, values: FloatArray, x: float) -> float:
    """Return the linear interpolation between points; the values are constant outside the points."""
    if not x > at[0]:
        return float(values[0])
    if x >= at[-1]:
        return float(values[-1])
    k = int(np.searchsorted(at, x, side="right"))
    return float(values[k - 1] + (values[k] - values[k - 1]) * ((x - at[k - 1]) / (at[k] - at[k - 1])))  # Eq. 44


def uniform(seed: int, stream: int, impact: int) -> float:
    """Return a number in [0, 1) that depends on seed, history and impact only (splitmix64)."""
    return (_mixed(_mixed(_mixed(seed) + stream & _MASK) + impact & _MASK) >> 11) * 2.0**-53  # Eq. 43


def _mixed(z: int) -> int:
    z = z + 0x9E3779B97F4A7C15 & _MASK
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & _MASK
    z = (z ^ z >> 27) * 0x94D049BB133111EB & _MASK
    return z ^ z >> 31


def _factors(values: Any, most: float = 1.0) -> FloatArray:
    row = checks.finite("factors", values, minimum=2)
    if row.min() < 0.0 or row.max() > most:
        raise InvalidValueError(
            "factors must be in [0, {most:g}], got {smallest:g} to {largest:g}",
            most=most,
            smallest=row.min(),
            largest=row.max(),
        )
    return row


def _by_side(values: Any) -> FloatArray:
    """Return quantiles as one row, or as two rows if the sides differ, right side first.

    One of two rows may exceed 1.
    """
    if isinstance(values, Mapping):
        if set(values) != set(FEET):
            raise InvalidValueError(
                "{parameter} by side are {allowed}, got {value}", parameter="factors",
                allowed='{"left": .., "right": ..}', value=values,
            )  # fmt: skip
        values = [values["right"], values["left"]]
    elif not (isinstance(values, np.ndarray) and values.ndim == 2 and len(values) == 2):
        return _factors(values)
    right, left = (_factors(row, _MOST_BY_SIDE) for row in values)
    if right.size != left.size:
        raise InvalidValueError(
            "{parameter} must have equal length for both sides, got {left} left and {right} right", parameter="factors",
            left=left.size, right=right.size,
        )  # fmt: skip
    if np.array_equal(right, left) and right[-1] <= 1.0:
        return right
    both = np.stack([right, left])
    both.setflags(write=False)
    return both


def _quantiles_of(values: Any) -> FloatArray:
    return np.quantile(checks.finite("values", values, minimum=2), np.linspace(0.0, 1.0, 1025))
