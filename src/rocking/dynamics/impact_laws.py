"""How the coefficient of restitution may change from impact to impact: not at all, with speed, or at random."""

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
# as of a coefficient: what exceeds the bound of a side is cut off, and that may be above 1 on one of two
_MOST_BY_SIDE = 10.0


class ImpactLaw:
    """A factor on the coefficient of restitution of the side onto which the body lands; the base of all laws.

    A law of your own overrides `factor`, and `largest` if the factor can exceed one; it runs on the reference engine.
    For studies it also says what makes it: as a dataclass of numbers, words and arrays, or by `content`.

    Attributes
    ----------
    kind : int
        0 constant, 1 a table over the speed, 2 a random number; -1 a law that only `factor` knows.
    per_history : bool
        Whether all impacts of a history share one draw; such a law has `draws` for many histories at once.
    at, factors : ndarray
        The table, of laws that have one.
    seed : int
        Seed of the random numbers.
    """

    kind: ClassVar[int] = -1
    per_history: ClassVar[bool] = False
    at: FloatArray
    factors: FloatArray
    seed: int

    def __init__(self) -> None:
        if type(self) is ImpactLaw:
            raise InvalidValueError(
                "ImpactLaw is the base of the laws: take ConstantRestitution, SpeedRestitution or RandomRestitution, "
                "or override factor() in a class of your own"
            )

    @property
    def tabulated(self) -> bool:
        """Whether the fast engine knows it; a class of your own is known by its `factor` alone."""
        return type(self).__module__ == __name__

    @property
    def largest(self) -> float:
        """Largest factor it can give [-]."""
        factors = getattr(self, "factors", None)
        return 1.0 if factors is None else float(factors.max())

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return the factor for an impact.

        Parameters
        ----------
        speed : float
            Angular velocity before the impact, without its sign [rad/s].
        stream : int
            Number of the history.
        impact : int
            Impacts that the history has had before.

        Returns
        -------
        float
            Factor on the side's coefficient [-].
        """
        raise NotImplementedError

    def content(self) -> dict[str, Any]:
        """Return what makes this law this one, beside its class: two that differ in it may give different factors.

        Returns
        -------
        dict
            Plain values: the seed and the hashes of the tables; of a dataclass of your own, its fields.
        """
        return self._tables() if self.tabulated else fields_of(self)

    def _tables(self) -> dict[str, Any]:
        tables = {name: hash_of(np.asarray(getattr(self, name))) for name in ("at", "factors") if hasattr(self, name)}
        return {"seed": int(getattr(self, "seed", 0)), **tables}

    def draws(self, numbers: Any) -> FloatArray:
        """Return the factors of many histories, of a law that draws once for each.

        Parameters
        ----------
        numbers : array_like of int
            Numbers of histories.

        Returns
        -------
        ndarray
            Factors on the side's coefficient [-].
        """
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class ConstantRestitution(ImpactLaw):
    """The coefficient of the side, always.

    Parameters
    ----------
    at, factors : ndarray, optional
        Zero and one: nothing changes with the speed.
    seed : int, optional
        Not used: nothing is drawn.
    """

    kind: ClassVar[int] = 0
    at: FloatArray = field(default_factory=lambda: np.zeros(1))
    factors: FloatArray = field(default_factory=lambda: np.ones(1))
    seed: int = 0

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return one."""
        return 1.0


@dataclass(frozen=True, eq=False)
class SpeedRestitution(ImpactLaw):
    """A coefficient that depends on the speed of the impact: straight lines through points, constant outside them.

    Parameters
    ----------
    at : array_like
        Angular velocities before the impact, without sign, increasing [rad/s].
    factors : array_like
        Coefficients there; factors, if `times` is given [-].
    times : optional
        What they multiply: a coefficient, a model or its name; 1 if not given.
    seed : int, optional
        Not used: nothing is drawn.

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
        speeds = checks.finite("at", self.at, "rad/s", least=2)
        if speeds[0] < 0.0 or np.any(np.diff(speeds) <= 0.0):
            raise InvalidValueError(
                parameter="at", allowed="speeds >= 0 that increase [rad/s]", value=speeds[:4].tolist()
            )
        factors = checks.finite("factors", self.factors, least=2)
        if factors.size != speeds.size:
            raise InvalidValueError(
                "{parameter} must be as many as the speeds, {speeds}, got {count}", parameter="factors",
                speeds=speeds.size, count=factors.size,
            )  # fmt: skip
        object.__setattr__(self, "at", speeds)
        object.__setattr__(self, "factors", _factors(factors))

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return the coefficient at a speed."""
        return interpolated(self.at, self.factors, speed)


@dataclass(frozen=True, eq=False)
class DrawnRestitution(ImpactLaw):
    """A coefficient drawn from a distribution that is known by its quantiles: what all such laws share.

    Of a body on which the largest draws would create energy, a side draws from what lies within its bound:
    the distribution is truncated, so that the draws are those of r on condition that r is at most the bound. Both
    sides draw with the same number, so that a large draw on one side is a large one on the other. For the parameters
    see `RandomRestitution`.
    """

    kind: ClassVar[int] = 2
    factors: Any  # an array once checked: a row, or those of the right and the left side
    seed: int
    times: Any = 1.0
    cut: tuple[float, float] = (0.0, 0.0)
    at: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        quantiles = _by_side(self.factors)
        if np.any(np.diff(quantiles) < 0.0):
            raise InvalidValueError("factors must be quantiles, which never decrease")
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
        """Return draws from a normal distribution cut to [0, 1].

        Parameters
        ----------
        mean, deviation : float
            Of the distribution before it is cut [-].
        seed : int
            Seed of the draws.
        times : optional
            What the draws multiply.
        points : int
            Quantiles that stand for it, from 2 to 100,000.

        Returns
        -------
        DrawnRestitution
            The law, of the class that is asked.

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
        # the normal's ends are infinite: the outermost levels stand a quarter of a step inside
        inside = np.clip(levels, low + 0.25 * (high - low) / points, high - 0.25 * (high - low) / points)
        return cls(np.clip(mean + deviation * ndtri(inside), 0.0, 1.0), seed, times)

    @classmethod
    def of_sample(cls, values: Any, *, seed: int, times: Any = 1.0) -> Self:
        """Return draws from measured or simulated values, for instance a posterior.

        Parameters
        ----------
        values : array_like, or mapping of foot to array_like
            Values of the coefficient or factor, for both sides or by foot [-].
        seed : int
            Seed of the draws.
        times : optional
            What the draws multiply.

        Returns
        -------
        DrawnRestitution
            The law, of the class that is asked.
        """
        if isinstance(values, Mapping):
            return cls({foot: _quantiles_of(sample) for foot, sample in values.items()}, seed, times)
        return cls(_quantiles_of(values), seed, times)

    @property
    def truncates(self) -> bool:
        """Whether draws beyond an energy bound are cut off; a class of your own may draw otherwise, and is refused."""
        return type(self).__module__.partition(".")[0] == "rocking"

    def table(self, onto: Foot | None = None) -> FloatArray:
        """Return the quantiles for landing on a foot, at equally spaced probabilities from 0 to 1 [-]."""
        if self.factors.ndim == 1:
            return np.asarray(self.factors)
        if onto is None:
            raise InvalidValueError("this law draws for each foot from a table of its own: give onto=, left or right")
        return np.asarray(self.factors[int(checks.foot("onto", onto) == "left")])

    def quantile(self, probability: float, onto: Foot | None = None) -> float:
        """Return what is not exceeded with a probability [-]."""
        return interpolated(self.at, self.table(onto), probability)

    def share_within(self, most: float, onto: Foot) -> float:
        """Return the probability of draws up to a bound [-]."""
        table = self.table(onto)
        k = int(np.searchsorted(table, most, side="right"))
        if k in {0, table.size}:
            return float(k > 0)
        part = (most - table[k - 1]) / (table[k] - table[k - 1])
        return float(self.at[k - 1] + (self.at[k] - self.at[k - 1]) * part)  # Eq. 42

    def factor(self, speed: float, stream: int, impact: int) -> float:
        """Return the draw for an impact, of a law that is the same for both sides."""
        return self.draw(stream, impact)

    def draw(self, stream: int, impact: int, onto: Foot | None = None, share: float = 1.0) -> float:
        """Return the draw for an impact on a foot, from the lowest share of the distribution [-]."""
        return self.quantile(share * uniform(self.seed, stream, 0 if self.per_history else impact), onto)  # Eq. 41


class RandomRestitution(DrawnRestitution):
    """A coefficient drawn anew for every impact from a distribution, the same for the same seed, history and impact.

    Draws that would create energy are cut off, for each side at its own bound: see `DrawnRestitution`.

    Parameters
    ----------
    factors : array_like, or mapping of foot to array_like
        Quantiles of the distribution at equally spaced probabilities from 0 to 1, for both sides or by
        ``{"left": .., "right": ..}`` [-].
    seed : int
        Seed of the draws.
    times : optional
        What they multiply: a coefficient, a model or its name; 1 if not given.
    cut : (float, float)
        Probability that the quantiles onto the left and the right foot leave out already [-].

    Raises
    ------
    InvalidValueError
        If the quantiles decrease or are outside [0, 1], or by side [0, 10], or the seed is not a whole number from 0 to
        2^64 - 1.

    Examples
    --------
    >>> law = RandomRestitution.normal(0.9, 0.02, seed=1)
    >>> law.factor(1.0, 0, 3) == law.factor(2.0, 0, 3) != law.factor(1.0, 0, 4)
    True
    """


def interpolated(at: FloatArray, values: FloatArray, x: float) -> float:
    """Return the value of straight lines through points, constant outside them."""
    if not x > at[0]:
        return float(values[0])
    if x >= at[-1]:
        return float(values[-1])
    k = int(np.searchsorted(at, x, side="right"))
    return float(values[k - 1] + (values[k] - values[k - 1]) * ((x - at[k - 1]) / (at[k] - at[k - 1])))  # Eq. 44


def uniform(seed: int, stream: int, impact: int) -> float:
    """Return a number in [0, 1) that depends on seed, history and impact, on nothing else (splitmix64)."""
    return (_mixed(_mixed(_mixed(seed) + stream & _MASK) + impact & _MASK) >> 11) * 2.0**-53  # Eq. 43


def _mixed(z: int) -> int:
    z = z + 0x9E3779B97F4A7C15 & _MASK
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & _MASK
    z = (z ^ z >> 27) * 0x94D049BB133111EB & _MASK
    return z ^ z >> 31


def _factors(values: Any, most: float = 1.0) -> FloatArray:
    row = checks.finite("factors", values, least=2)
    if row.min() < 0.0 or row.max() > most:
        raise InvalidValueError(
            "factors must be in [0, {most:g}], got {smallest:g} to {largest:g}",
            most=most,
            smallest=row.min(),
            largest=row.max(),
        )
    return row


def _by_side(values: Any) -> FloatArray:
    """Quantiles as a row, or as two where the sides differ, that of the right first, of which one may exceed 1."""
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
            "{parameter} must be as many for both sides, got {left} left and {right} right", parameter="factors",
            left=left.size, right=right.size,
        )  # fmt: skip
    if np.array_equal(right, left) and right[-1] <= 1.0:
        return right
    both = np.stack([right, left])
    both.setflags(write=False)
    return both


def _quantiles_of(values: Any) -> FloatArray:
    return np.quantile(checks.finite("values", values, least=2), np.linspace(0.0, 1.0, 1025))
