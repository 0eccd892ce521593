"""What is not known exactly: a number, a range, a distribution or a sample, drawn by probabilities from 0 to 1."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

_WAYS = ({"low", "high"}, {"mean", "deviation"}, {"median", "dispersion"}, {"values"})
_Ends = tuple[float, float]
_HINT = (
    "a number, a pair (low, high), a sample of more numbers, or one of the tables low and high, mean and deviation, "
    "median and dispersion, values"
)


@dataclass(frozen=True, eq=False)
class Uncertain:
    """A number that is known, or its distribution."""

    words: str
    quantile: Callable[[FloatArray], FloatArray]  # values that are not exceeded with probabilities
    fixed: bool = False  # whether it is one number

    @classmethod
    def of(cls, name: str, given: Any, low: float, high: float, unit: str = "-") -> "Uncertain":
        """Return what was given; low, high: least and largest value that make sense, where distributions are cut.

        >>> found = Uncertain.of("friction", (0.4, 0.8), 0.0, 10.0)
        >>> found.words, found.quantile(np.array([0.25])).tolist()
        ('from 0.4 to 0.8, all alike', [0.5])
        """
        ends, told = (low, high), "" if unit == "-" else f" {unit}"
        if isinstance(given, Mapping):
            return cls._of_table(name, given, ends, told)
        if callable(getattr(given, "ppf", None)):
            return cls._of_ppf(name, given, ends, told)
        if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str):
            return (cls._of_range if len(given) == 2 else cls._of_sample)(name, given, ends, told)
        if isinstance(given, (str, bool)) or given is None:
            raise InvalidValueError(f"{name} must be {_HINT}, got {given!r:.60}")
        value = checks.within(name, given, low, high)
        return cls(f"{value:g}{told}", lambda u: np.full(u.shape, value), fixed=True)

    @classmethod
    def _of_table(cls, name: str, given: Mapping[str, Any], ends: _Ends, unit: str) -> "Uncertain":
        if set(given) not in _WAYS:
            raise InvalidValueError(f"{name} must be {_HINT}, got {', '.join(map(str, given)) or 'an empty table'}")
        if "low" in given:
            return cls._of_range(name, (given["low"], given["high"]), ends, unit)
        if "values" in given:
            return cls._of_sample(name, given["values"], ends, unit)
        return cls._of_curve(name, given, ends, unit)

    @classmethod
    def _of_range(cls, name: str, given: Any, ends: _Ends, unit: str) -> "Uncertain":
        least, most = (
            checks.within(f"{name} {end}", value, *ends) for end, value in zip(("from", "to"), given, strict=True)
        )
        if not least < most:
            raise InvalidValueError(f"{name} must be a range from low to high, got {least:g} to {most:g}")
        return cls(f"from {least:g} to {most:g}{unit}, all alike", lambda u: least + u * (most - least))

    @classmethod
    def _of_sample(cls, name: str, given: Any, ends: _Ends, unit: str) -> "Uncertain":
        several = list(given) if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str) else [given]
        values = np.sort([checks.within(f"each value of {name}", value, *ends) for value in several])
        if values.size < 2:
            raise InvalidValueError(f"{name} as a sample takes two values or more, got {values.size}")
        words = f"one of {values.size} values from {values[0]:g} to {values[-1]:g}{unit}, each as likely"
        return cls(words, lambda u: values[np.minimum((u * values.size).astype(np.int64), values.size - 1)])

    @classmethod
    def _of_curve(cls, name: str, given: Mapping[str, Any], ends: _Ends, unit: str) -> "Uncertain":
        from scipy.special import ndtr, ndtri

        logarithmic = "median" in given
        kinds = ("median", "dispersion") if logarithmic else ("mean", "deviation")
        middle, spread = checks.within(f"{name} {kinds[0]}", given[kinds[0]], *ends), given[kinds[1]]
        spread = checks.positive(f"{name} {kinds[1]}", spread)
        words = f"normal, {middle:g} +- {spread:g}{unit}"
        scaled = np.array([*ends, middle])
        if logarithmic:
            words = f"lognormal, median {middle:g}{unit}, dispersion {spread:g}"
            with np.errstate(divide="ignore", invalid="ignore"):
                scaled = np.log(np.maximum(scaled, 0.0))
        low, high = ndtr((scaled[:2] - scaled[2]) / spread).tolist()
        if not high - low >= 0.5:
            raise InvalidValueError(f"{name}: most of {words} is outside [{ends[0]:g}, {ends[1]:g}]; in other units?")

        def quantile(u: FloatArray) -> FloatArray:
            found = scaled[2] + spread * ndtri(low + u * (high - low))
            return np.asarray(np.clip(np.exp(found) if logarithmic else found, *ends))

        return cls(words, quantile)

    @classmethod
    def _of_ppf(cls, name: str, given: Any, ends: _Ends, unit: str) -> "Uncertain":
        low, high = np.asarray(given.ppf(np.array([1e-6, 1.0 - 1e-6])), dtype=np.float64).tolist()
        if not ends[0] <= low <= high <= ends[1]:
            raise InvalidValueError(f"{name} must be within [{ends[0]:g}, {ends[1]:g}], got {low:g} to {high:g}")
        words = f"of a distribution, nearly all from {low:.4g} to {high:.4g}{unit}"
        return cls(words, lambda u: np.clip(np.asarray(given.ppf(u), dtype=np.float64), *ends))
