"""What is refused at the door: one function per kind of value, one sentence per refusal."""

import difflib
import math
import os
import re
from collections.abc import Iterable
from typing import Any, TypeVar

import numpy as np

from rocking.conventions import FEET, LENGTH_UNITS, UNITS, Assumed, FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.messages import Message, Range

Word = TypeVar("Word", bound=str)
SMALLEST, LARGEST = 1e-9, 1e9
"""No body is smaller or larger than this [m]: squares and fourth powers stay far from overflow."""


def number(name: str, value: Any, unit: str = "-") -> float:
    """Return `value` as a finite float."""
    if isinstance(value, (bool, np.bool_, str, bytes, complex)) or value is None:
        raise InvalidValueError(parameter=name, allowed=Message("a number [{unit}]", {"unit": unit}), value=value)
    try:
        if getattr(value, "ndim", 0):
            raise TypeError  # numpy before 2.4 takes an array of one number for it
        result = float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidValueError(
            parameter=name, allowed=Message("one number [{unit}]", {"unit": unit}), value=value
        ) from error
    if not math.isfinite(result):
        raise InvalidValueError(parameter=name, allowed=Message("finite [{unit}]", {"unit": unit}), value=result)
    return result


def of_kind(name: str, value: object, kind: type | tuple[type, ...], words: str) -> None:
    """Refuse what is of another kind than the one that the words say."""
    if not isinstance(value, kind):
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {given}", parameter=name, allowed=words, value=value,
            given=given(name, value),
        )  # fmt: skip


_READERS = {"motion": "read_motion", "motions": "read_motion", "body": "read_body", "bodies": "read_body"}


def given(name: str, value: object, where: str = "") -> str:
    """Return what was given for a parameter, and the function that makes a motion or a body of it.

    >>> given("motion", "x.at2"), given("body", 3.0)
    ("'x.at2'; rocking.read_motion('x.at2') reads a file", '3.0')
    """
    reader, shown = _READERS.get(name), f"{value!r:.60}{where}"
    if reader and isinstance(value, (str, os.PathLike)):
        path = str(value)
        if reader == "read_motion" and re.match(r"[a-z-]+:\w+=", path):
            return f"{shown}; rocking.pulses.pulse({path!r:.60}) makes a pulse of words"
        return f"{shown}; rocking.{reader}({path!r:.60}) reads a file"
    if reader == "read_motion" and isinstance(value, (list, np.ndarray)) and not np.ndim(value) > 1:
        return f"{shown}; rocking.GroundMotion(acceleration, time_step) makes a motion of samples [m/s2] and step [s]"
    return shown


def whole(name: str, value: Any, low: int = 0, high: int = 2**63 - 1) -> int:
    """Return `value` as a whole number between `low` and `high`."""
    is_whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not is_whole or not low <= int(value) <= high:
        top = f"{high}]" if high < 2**53 else f"2^{high.bit_length()})"
        beyond = high != 2**63 - 1 or (is_whole and int(value) > high)
        in_range = Message("a whole number in {limits}", {"limits": f"[{low}, {top}"})
        above = Message("a whole number >= {low}", {"low": low})
        raise InvalidValueError(parameter=name, allowed=in_range if beyond else above, value=value)
    return int(value)


def positive(name: str, value: Any, unit: str = "-", hint: str = "") -> float:
    """Return `value` as a finite float above zero."""
    return within(name, value, 0.0, math.inf, unit=unit, open_low=True, hint=hint)


def length(name: str, value: Any) -> float:
    """Return `value` as a length that a body can have [m]."""
    positive(name, value, "m")
    return within(name, value, SMALLEST, LARGEST, unit="m", hint="wrong unit?")


def density(name: str, value: Any) -> float:
    """Return `value` as a density that a body can have [kg/m3]."""
    result = positive(name, value, "kg/m3")
    within(name, result, 0.0, LARGEST, unit="kg/m3", open_low=True, hint="wrong unit?")
    return value if isinstance(value, Assumed) else result


def within(
    name: str,
    value: Any,
    low: float,
    high: float,
    *,
    unit: str = "-",
    open_low: bool = False,
    open_high: bool = False,
    hint: str = "",
) -> float:
    """Return `value` as a float between `low` and `high`."""
    result = number(name, value, unit)
    allowed = Range(low, high, "" if unit == "-" else unit, open_low, open_high)
    if result not in allowed:
        raise InvalidValueError(parameter=name, allowed=allowed, value=result, hint=hint)
    return result


def increasing(name: str, values: FloatArray, unit: str = "-") -> None:
    """Refuse a row of values that does not increase: the first value that is not above the one before."""
    falls = np.flatnonzero(np.diff(values) <= 0.0)
    if falls.size:
        before, after = values[falls[0] : falls[0] + 2].tolist()
        descending = values.size > 1 and bool((np.diff(values) < 0.0).all())
        hint = "these decrease: reverse them" if descending else f"{after:g} follows {before:g} at index {falls[0] + 1}"
        shown = "" if unit in {"-", "1", ""} else f" [{unit}]"
        raise InvalidValueError(
            "{parameter} must increase{unit} from value to value", parameter=name, hint=hint, unit=shown
        )


def positive_array(name: str, values: Any, unit: str = "-") -> FloatArray:
    """Return `values` as float64 of the same shape, finite and above zero; no copy if they already are."""
    result = real_array(name, values, unit)
    all_positive(name, result, unit)
    return result


def real_array(name: str, values: Any, unit: str = "-") -> FloatArray:
    """Return `values` as float64 of the same shape, finite or not; no copy if they already are."""
    try:
        given = np.asarray(values)
    except ValueError as error:
        raise InvalidValueError(parameter=name, allowed=f"numbers [{unit}]", value=values) from error
    if given.dtype.kind not in "iuf":
        raise InvalidValueError(parameter=name, allowed=f"numbers [{unit}]", value=values)
    return np.asarray(given, dtype=np.float64)


def finite(
    name: str, values: Any, unit: str = "-", shape: tuple[int | None, ...] = (None,), least: int = 1
) -> FloatArray:
    """Return `values` as a frozen copy of finite numbers of a shape; None is any size of at least `least`."""
    result = real_array(name, values, unit).copy()
    wanted = [max(count, least) if size is None else size for count, size in zip(result.shape, shape, strict=False)]
    if result.ndim != len(shape) or list(result.shape) != wanted:
        words = " x ".join(f"at least {least}" if size is None else f"{size}" for size in shape)
        row = "a row of " if len(shape) == 1 else ""
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter=name, value=values, shape=result.shape,
            allowed=f"{row}{words} finite numbers [{unit}]",
        )  # fmt: skip
    bad = np.argwhere(~np.isfinite(result)).tolist()
    if bad:
        where = bad[0] if len(shape) > 1 else bad[0][0]
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {value} at index {index}", parameter=name, allowed=f"finite [{unit}]",
            value=float(result[tuple(bad[0])]), index=where,
        )  # fmt: skip
    result.setflags(write=False)
    return result


def all_positive(name: str, values: FloatArray, unit: str = "-") -> None:
    """Refuse an array that holds anything but finite numbers above zero."""
    # min() and max() carry NaN along, so two reductions settle it
    if not values.size or (values.min() > 0.0 and values.max() < math.inf):
        return
    bad = tuple(int(i) for i in np.argwhere(~((values > 0.0) & np.isfinite(values)))[0])
    raise InvalidValueError(
        "{parameter} must be {allowed}, got {value} at index {index}" if bad else "",
        parameter=name, allowed=f"finite and > 0{'' if unit == '-' else f' {unit}'}", value=float(values[bad]),
        index=bad[0] if len(bad) == 1 else bad,
    )  # fmt: skip


def all_within(name: str, values: FloatArray, low: float, high: float, whole: FloatArray) -> float:
    """Refuse an array that holds anything but numbers between two positive ends; return the least of them."""
    if not values.size:
        return high
    least = float(values.min())
    if least >= low and values.max() <= high:
        return least
    all_positive(name, whole)
    bad = tuple(int(i) for i in np.argwhere((whole < low) | (whole > high))[0])
    raise InvalidValueError(parameter=name, allowed=Range(low, high), value=float(whole[bad]))


def foot(name: str, value: Any) -> Foot:
    """Return `value` as a foot."""
    if not isinstance(value, str) or value not in FEET:
        raise InvalidValueError(parameter=name, allowed='"left" or "right"', value=value)
    return value


def length_unit(value: Any) -> float:
    """Return the length of a unit in metres."""
    return LENGTH_UNITS[one_of("length unit", value, LENGTH_UNITS)]


def one_of(name: str, value: Any, known: Iterable[Word]) -> Word:
    """Return the one of some words that was meant, upper or lower case alike, as it is spelt there.

    >>> one_of("engine", "Fast", ["auto", "fast"])
    'fast'
    """
    words = list(known)
    found = spelling(value, words)
    if not isinstance(found, str) or found not in words:  # an array has no truth value
        raise InvalidValueError(
            parameter=name, allowed=f"one of {', '.join(words)}", value=value, hint=nearest(value, words)
        )
    return found


def spelling(word: Any, known: Iterable[str]) -> Any:
    """Return a word as it is spelt among some others if capitals alone differ; otherwise as it is."""
    if not isinstance(word, str):
        return word
    words = list(known)
    return word if word in words else next((each for each in words if each.casefold() == word.strip().casefold()), word)


def nearest(word: Any, known: Iterable[str]) -> str:
    """Return the hint about an unknown word: what was probably meant; empty if nothing is near.

    >>> nearest("housener", ["housner", "ked"]), nearest("0,9", ["housner", "ked"])
    ("did you mean 'housner'?", 'numbers have a decimal point: 0.9')
    """
    if not isinstance(word, str):
        return ""
    if comma := number_hint(word):
        return comma
    near = difflib.get_close_matches(word[:60].casefold(), list(known), n=1)
    return Message("did you mean {name}?", {"name": f"{near[0]!r}"}) if near else ""


def number_hint(words: str) -> str:
    """Return the hint about words in which a number has a decimal comma, or a unit; empty for others.

    >>> number_hint("sine:amplitude=0,5,period=1"), number_hint("50 cm")
    ('numbers have a decimal point: 0.5', 'it takes no unit behind the number, 50: the help says how to give one')
    """
    if unit := re.fullmatch(r"([+-]?[0-9.]+) ?(?!e\d+$)([a-zA-Z][a-zA-Z/0-9]*)", words):
        return Message("it takes no unit behind the number, {unit}: the help says how to give one", {"unit": unit[1]})
    found = re.search(r"(?<![\d.,])([+-]?\d+),(\d+)(?!,?[\d.])", words)
    return (
        Message("numbers have a decimal point: {whole}.{fraction}", {"whole": found[1], "fraction": found[2]})
        if found
        else ""
    )


_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([A-Za-z/][A-Za-z0-9/]*)?")


def quantity(name: str, text: str, unit: str) -> tuple[float, str]:
    """Return one number [unit], and the unit in which it was written, empty if none.

    >>> quantity("semi_diagonal", "40cm", "m"), quantity("scale", "2", "1")
    ((0.4, 'cm'), (2.0, ''))
    """
    match, known = _NUMBER.fullmatch(text.strip()), UNITS[unit]
    if match is None or (match[2] and match[2] not in known):
        allowed = f", alone or with one of {', '.join(known)}" if known else " without a unit"
        hint = "" if match else number_hint(text)
        raise InvalidValueError(parameter=name, allowed=f"a number{allowed}", value=text, hint=hint)
    value = float(match[1]) * (known[match[2]] if match[2] else 1.0)
    if not math.isfinite(value):
        raise InvalidValueError(parameter=name, allowed="a finite number", value=text)
    return value, match[2] or ""
