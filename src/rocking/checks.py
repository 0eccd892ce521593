"""Checks of input values: one function per kind of value, with one error each."""

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
"""Smallest and largest dimension of a body [m]: fourth powers do not overflow."""


def number(name: str, value: Any, unit: str = "-") -> float:
    """Return `value` as a finite float."""
    if isinstance(value, (bool, np.bool_, str, bytes, complex)) or value is None:
        raise InvalidValueError(parameter=name, allowed=Message("a number [{unit}]", {"unit": unit}), value=value)
    try:
        if getattr(value, "ndim", 0):
            raise TypeError  # numpy before 2.4 converts an array of one number
        result = float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidValueError(
            parameter=name, allowed=Message("one number [{unit}]", {"unit": unit}), value=value
        ) from error
    if not math.isfinite(result):
        raise InvalidValueError(parameter=name, allowed=Message("finite [{unit}]", {"unit": unit}), value=result)
    return result


def of_kind(name: str, value: object, kind: type | tuple[type, ...], description: str) -> None:
    """Raise an error if the type of `value` is not `kind`; `description` describes the allowed type."""
    if not isinstance(value, kind):
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {given}", parameter=name, allowed=description, value=value,
            given=given(name, value),
        )  # fmt: skip


_READERS = {"motion": "read_motion", "motions": "read_motion", "body": "read_body", "bodies": "read_body"}


def given(name: str, value: object, where: str = "") -> str:
    """Return the text of an input value. It also names the function that converts the value to a motion or a body.

    >>> given("motion", "x.at2"), given("body", 3.0)
    ("'x.at2'; rocking.read_motion('x.at2') reads a file", '3.0')
    """
    reader, text = _READERS.get(name), f"{value!r:.60}{where}"
    if reader and isinstance(value, (str, os.PathLike)):
        path = str(value)
        if reader == "read_motion" and re.match(r"[a-z-]+:\w+=", path):
            return f"{text}; rocking.pulses.pulse({path!r:.60}) creates the pulse"
        return f"{text}; rocking.{reader}({path!r:.60}) reads a file"
    if reader == "read_motion" and isinstance(value, (list, np.ndarray)) and not np.ndim(value) > 1:
        return f"{text}; rocking.GroundMotion(acceleration, time_step) creates a motion [m/s2, s]"
    return text


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
    """Return `value` as a valid length of a body [m]."""
    positive(name, value, "m")
    result = within(name, value, SMALLEST, LARGEST, unit="m", hint="check the unit")
    return value if isinstance(value, Assumed) else result


def density(name: str, value: Any) -> float:
    """Return `value` as a valid density of a body [kg/m3]."""
    result = positive(name, value, "kg/m3")
    within(name, result, 0.0, LARGEST, unit="kg/m3", open_low=True, hint="check the unit")
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
    """Raise an error unless the values increase. The error contains the first value that does not increase."""
    wrong = np.flatnonzero(np.diff(values) <= 0.0)
    if wrong.size:
        before, after = values[wrong[0] : wrong[0] + 2].tolist()
        descending = values.size > 1 and bool((np.diff(values) < 0.0).all())
        hint = (
            "reverse the order: the values decrease"
            if descending
            else f"{after:g} follows {before:g} at index {wrong[0] + 1}"
        )
        shown = "" if unit in {"-", "1", ""} else f" [{unit}]"
        raise InvalidValueError(
            "{parameter} must increase{unit} from value to value", parameter=name, hint=hint, unit=shown
        )


def positive_array(name: str, values: Any, unit: str = "-") -> FloatArray:
    """Return `values` as a float64 array, finite and above zero. The array is not copied if it already is float64."""
    result = real_array(name, values, unit)
    all_positive(name, result, unit)
    return result


def real_array(name: str, values: Any, unit: str = "-") -> FloatArray:
    """Return `values` as a float64 array, finite or not. The array is not copied if it already is float64."""
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise InvalidValueError(parameter=name, allowed=f"numbers [{unit}]", value=values) from error
    if array.dtype.kind not in "iuf":
        raise InvalidValueError(parameter=name, allowed=f"numbers [{unit}]", value=values)
    return np.asarray(array, dtype=np.float64)


def finite(
    name: str, values: Any, unit: str = "-", shape: tuple[int | None, ...] = (None,), minimum: int = 1
) -> FloatArray:
    """Return a read-only copy of `values`, which must be finite and have the given shape.

    None in `shape` allows any size >= `minimum`.
    """
    result = real_array(name, values, unit).copy()
    expected = [max(count, minimum) if size is None else size for count, size in zip(result.shape, shape, strict=False)]
    if result.ndim != len(shape) or list(result.shape) != expected:
        sizes = " x ".join(f"at least {minimum}" if size is None else f"{size}" for size in shape)
        row = "a row of " if len(shape) == 1 else ""
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter=name, value=values, shape=result.shape,
            allowed=f"{row}{sizes} finite numbers [{unit}]",
        )  # fmt: skip
    bad = np.argwhere(~np.isfinite(result)).tolist()
    if bad:
        index = bad[0] if len(shape) > 1 else bad[0][0]
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {value} at index {index}", parameter=name, allowed=f"finite [{unit}]",
            value=float(result[tuple(bad[0])]), index=index,
        )  # fmt: skip
    result.setflags(write=False)
    return result


def all_positive(name: str, values: FloatArray, unit: str = "-") -> None:
    """Raise an error unless all numbers of an array are finite and above zero."""
    # min() and max() propagate NaN: two reductions suffice
    if not values.size or (values.min() > 0.0 and values.max() < math.inf):
        return
    bad = tuple(int(i) for i in np.argwhere(~((values > 0.0) & np.isfinite(values)))[0])
    raise InvalidValueError(
        "{parameter} must be {allowed}, got {value} at index {index}" if bad else "",
        parameter=name, allowed=f"finite and > 0{'' if unit == '-' else f' {unit}'}", value=float(values[bad]),
        index=bad[0] if len(bad) == 1 else bad,
    )  # fmt: skip


def all_within(name: str, values: FloatArray, low: float, high: float, array: FloatArray) -> float:
    """Raise an error unless all numbers of an array are between two positive limits. Return the smallest number."""
    if not values.size:
        return high
    smallest = float(values.min())
    if smallest >= low and values.max() <= high:
        return smallest
    all_positive(name, array)
    bad = tuple(int(i) for i in np.argwhere((array < low) | (array > high))[0])
    raise InvalidValueError(parameter=name, allowed=Range(low, high), value=float(array[bad]))


def foot(name: str, value: Any) -> Foot:
    """Return `value` as a foot."""
    if not isinstance(value, str) or value not in FEET:
        raise InvalidValueError(parameter=name, allowed='"left" or "right"', value=value)
    return value


def length_unit(value: Any) -> float:
    """Return the length of a unit in metres."""
    return LENGTH_UNITS[one_of("length unit", value, LENGTH_UNITS)]


def one_of(name: str, value: Any, allowed: Iterable[Word]) -> Word:
    """Return the allowed word that equals a value, case-insensitive.

    >>> one_of("engine", "Fast", ["auto", "fast"])
    'fast'
    """
    options = list(allowed)
    match = spelling(value, options)
    if not isinstance(match, str) or match not in options:  # an array cannot be compared with words
        raise InvalidValueError(
            parameter=name, allowed=f"one of {', '.join(options)}", value=value, hint=nearest(value, options)
        )
    return match


def spelling(word: Any, allowed: Iterable[str]) -> Any:
    """Return the allowed word that equals `word` except for case. If there is none, return `word`."""
    if not isinstance(word, str):
        return word
    options = list(allowed)
    return (
        word
        if word in options
        else next((option for option in options if option.casefold() == word.strip().casefold()), word)
    )


def nearest(word: Any, allowed: Iterable[str]) -> str:
    """Return a hint with the allowed word that is most similar to an unknown word; empty if none is similar.

    >>> nearest("housener", ["housner", "ked"]), nearest("0,9", ["housner", "ked"])
    ("did you mean 'housner'?", 'numbers have a decimal point: 0.9')
    """
    if not isinstance(word, str):
        return ""
    if comma := number_hint(word):
        return comma
    near = difflib.get_close_matches(word[:60].casefold(), list(allowed), n=1)
    return Message("did you mean {name}?", {"name": f"{near[0]!r}"}) if near else ""


def number_hint(text: str) -> str:
    """Return a hint for a number with a decimal comma or a unit; empty for other texts.

    >>> number_hint("sine:amplitude=0,5,period=1"), number_hint("50 cm")
    ('numbers have a decimal point: 0.5', 'remove the unit after the number, 50; see the help for units')
    """
    if unit := re.fullmatch(r"([+-]?[0-9.]+) ?(?!e\d+$)([a-zA-Z][a-zA-Z/0-9]*)", text):
        return Message("remove the unit after the number, {unit}; see the help for units", {"unit": unit[1]})
    match = re.search(r"(?<![\d.,])([+-]?\d+),(\d+)(?!,?[\d.])", text)
    return (
        Message("numbers have a decimal point: {whole}.{fraction}", {"whole": match[1], "fraction": match[2]})
        if match
        else ""
    )


_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([A-Za-z/][A-Za-z0-9/]*)?")


def quantity(name: str, text: str, unit: str) -> tuple[float, str]:
    """Return the number of a text, converted to `unit`, and the unit in the text (empty if there is none).

    >>> quantity("semi_diagonal", "40cm", "m"), quantity("scale", "2", "1")
    ((0.4, 'cm'), (2.0, ''))
    """
    match, units = _NUMBER.fullmatch(text.strip()), UNITS[unit]
    if match is None or (match[2] and match[2] not in units):
        allowed = f", without unit or with one of {', '.join(units)}" if units else " without a unit"
        hint = "" if match else number_hint(text)
        raise InvalidValueError(parameter=name, allowed=f"a number{allowed}", value=text, hint=hint)
    value = float(match[1]) * (units[match[2]] if match[2] else 1.0)
    if not math.isfinite(value):
        raise InvalidValueError(parameter=name, allowed="a finite number", value=text)
    return value, match[2] or ""
