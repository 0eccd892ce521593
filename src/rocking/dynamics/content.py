"""What a thing is made of, as plain values: so that two which differ never bear one name."""

import hashlib
import math
from dataclasses import fields
from typing import Any

import numpy as np

from rocking.errors import InvalidValueError


def hash_of(values: np.ndarray) -> str:
    """Return the SHA-256 of an array of numbers; 64 hexadecimal digits, the same on every machine."""
    little = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    made = hashlib.sha256(str((little.dtype.str, little.shape)).encode())
    made.update(little.view(np.uint8).data)
    return made.hexdigest()


def full_name(kind: type) -> str:
    """Return the name of a class: ours alone, since no two share one; of others with its module, where two may."""
    module = "rocking" if kind.__module__.startswith("rocking.") else kind.__module__
    return f"{module}.{kind.__qualname__}"


def fields_of(thing: object) -> dict[str, Any]:
    """Return the fields of a dataclass as plain values, arrays as their SHA-256."""
    # without `times` that is a model: what a law multiplies is in the coefficients already
    kind = type(thing)
    if "__dataclass_fields__" not in vars(kind) or _closes_over_something(kind):
        raise InvalidValueError(
            _ADVICE + "; {type} is no dataclass, or its functions hold other values", type=full_name(kind)
        )
    found = {each.name: getattr(thing, each.name, None) for each in fields(thing)}  # type: ignore[arg-type]
    return {name: _plain(kind, name, value) for name, value in found.items() if name != "times" or _word(value)}


_ADVICE = "a law of your own must say what makes it, by content()"


def _plain(kind: type, name: str, value: object) -> Any:
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
        return hash_of(value)
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (list, tuple)):
        return [_plain(kind, name, each) for each in value]
    if _word(value):
        return value
    raise InvalidValueError(
        _ADVICE + "; {field} of {type} is {content}", field=name, type=full_name(kind), content=f"{value!r:.60}"
    )


def _word(value: object) -> bool:
    if isinstance(value, np.generic):
        value = value.item()
    return isinstance(value, (bool, int, str, type(None))) or (isinstance(value, float) and math.isfinite(value))


def _closes_over_something(kind: type) -> bool:
    """Whether a function of the class sees variables of a function around it; `super` sees the class, which is fine."""
    written = [each for name, each in vars(kind).items() if not name.startswith("__")]  # others the decorator made
    functions = [getattr(each, "__func__", getattr(each, "fget", each)) for each in written]
    codes = [each.__code__ for each in functions if hasattr(each, "__code__")]
    return any(set(code.co_freevars) - {"__class__"} for code in codes)
