"""What is not known exactly: a number, a range, a distribution or a sample, drawn by probabilities from 0 to 1."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

_WAYS = ({"low", "high"}, {"mean", "deviation"}, {"median", "dispersion"}, {"values"})
_HINT = (
    "a number, a pair (low, high), a sample of more numbers, or one of the tables low and high, mean and deviation, "
    "median and dispersion, values"
)


@dataclass(frozen=True, eq=False)
class Uncertain:
    """A number that is known, or its distribution.

    Parameters
    ----------
    words : str
        What it is, for people.
    quantile : callable
        Takes probabilities from 0 to 1, returns the values that are not exceeded with them.
    fixed : bool
        Whether it is one number.
    """

    words: str
    quantile: Callable[[FloatArray], FloatArray]
    fixed: bool = False

    @classmethod
    def of(cls, name: str, given: Any, low: float, high: float, unit: str = "-") -> "Uncertain":
        """Return what was given: a number, a range, a distribution or a sample.

        Parameters
        ----------
        name : str
            What it is called, for errors.
        given : float, pair, sequence, mapping or frozen distribution of scipy.stats
            A number; ``(low, high)``, all between alike; three numbers or more, a sample; ``{"low", "high"}``;
            ``{"mean", "deviation"}``, normal; ``{"median", "dispersion"}``, lognormal; ``{"values"}``, a sample; or
            anything with a method `ppf`. Normal and lognormal are cut where values make no sense.
        low, high : float
            Least and largest value that make sense.
        unit : str
            Unit, for words and errors.

        Returns
        -------
        Uncertain
            Words and quantiles.

        Raises
        ------
        InvalidValueError
            If it is none of these, or a value makes no sense.

        Examples
        --------
        >>> import numpy as np
        >>> found = Uncertain.of("friction", (0.4, 0.8), 0.0, 10.0)
        >>> found.words, found.quantile(np.array([0.25])).tolist()
        ('from 0.4 to 0.8, all alike', [0.5])
        """
        unit = "" if unit == "-" else f" {unit}"

        def number(key: str, value: Any, least: float = low, most: float = high) -> float:
            return checks.within(f"{name}{key}", value, least, most)

        if isinstance(given, Mapping):
            if set(given) not in _WAYS:
                raise InvalidValueError(f"{name} must be {_HINT}, got {', '.join(map(str, given)) or 'an empty table'}")
            if "low" in given:
                return cls.of(name, (given["low"], given["high"]), low, high, unit or "-")
            if "values" in given:
                return cls._of_sample(name, given["values"], number, unit)
            return cls._of_curve(name, given, (low, high), unit)
        if callable(getattr(given, "ppf", None)):
            return cls._of_ppf(name, given, (low, high), unit)
        if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str):
            if len(given) != 2:
                return cls._of_sample(name, given, number, unit)
            least, most = number(" from", given[0]), number(" to", given[1])
            if not least <= most:
                raise InvalidValueError(f"{name} must be a range from low to high, got {least:g} to {most:g}")
            if least == most:
                return cls.of(name, least, low, high, unit or "-")
            return cls(f"from {least:g} to {most:g}{unit}, all alike", lambda u: least + u * (most - least))
        if isinstance(given, (str, bool)) or given is None:
            raise InvalidValueError(f"{name} must be {_HINT}, got {given!r:.60}")
        value = number("", given)
        return cls(f"{value:g}{unit}", lambda u: np.full(u.shape, value), fixed=True)

    @classmethod
    def _of_sample(cls, name: str, given: Any, number: Callable[[str, Any], float], unit: str) -> "Uncertain":
        values = np.sort([number(" value", value) for value in np.ravel(np.asarray(given, dtype=object))])
        if values.size < 2:
            raise InvalidValueError(f"{name} as a sample takes two values or more, got {values.size}")
        words = f"one of {values.size} values from {values[0]:g} to {values[-1]:g}{unit}, each as likely"
        return cls(words, lambda u: values[np.minimum((u * values.size).astype(np.int64), values.size - 1)])

    @classmethod
    def _of_curve(cls, name: str, given: Mapping[str, Any], ends: tuple[float, float], unit: str) -> "Uncertain":
        from scipy.special import ndtr, ndtri

        if "mean" in given:
            middle = checks.within(f"{name} mean", given["mean"], *ends)
            spread = checks.positive(f"{name} deviation", given["deviation"])
            words, make, back = f"normal, {middle:g} +- {spread:g}{unit}", lambda x: x, lambda x: x
        else:
            middle = math.log(checks.within(f"{name} median", given["median"], max(ends[0], 1e-300), ends[1]))
            spread = checks.positive(f"{name} dispersion", given["dispersion"])
            words = f"lognormal, median {given['median']:g}{unit}, dispersion {spread:g}"
            make, back = np.exp, lambda x: math.log(x) if x > 0.0 else -math.inf
        low, high = (float(ndtr((back(end) - middle) / spread)) for end in ends)
        if high - low < 0.5:
            raise InvalidValueError(f"{name}: most of {words} is outside [{ends[0]:g}, {ends[1]:g}]; in other units?")
        return cls(words, lambda u: np.clip(make(middle + spread * ndtri(low + u * (high - low))), *ends))

    @classmethod
    def _of_ppf(cls, name: str, given: Any, ends: tuple[float, float], unit: str) -> "Uncertain":
        nearly = np.asarray(given.ppf(np.array([1e-6, 1.0 - 1e-6])), dtype=np.float64)
        if not (np.isfinite(nearly).all() and ends[0] <= nearly[0] <= nearly[1] <= ends[1]):
            raise InvalidValueError(
                f"{name} must be within [{ends[0]:g}, {ends[1]:g}], got {nearly[0]:g} to {nearly[1]:g}"
            )
        words = f"of a distribution, nearly all from {nearly[0]:.4g} to {nearly[1]:.4g}{unit}"
        return cls(words, lambda u: np.clip(np.asarray(given.ppf(u), dtype=np.float64), *ends))
