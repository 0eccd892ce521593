"""Content of objects as plain values, and hashes of arrays."""

import hashlib
import math
from dataclasses import fields
from typing import Any

import numpy as np

from rocking.errors import InvalidValueError


def hash_of(values: np.ndarray) -> str:
    """Return the SHA-256 of an array of numbers, as 64 hexadecimal digits. All machines give the same hash."""
    ordered = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    digest = hashlib.sha256(str((ordered.dtype.str, ordered.shape)).encode())
    digest.update(ordered.view(np.uint8).data)
    return digest.hexdigest()


def full_name(kind: type) -> str:
    """Return the name of a class. The name includes the module if the class is not part of rocking."""
    module = "rocking" if kind.__module__.startswith("rocking.") else kind.__module__
    return f"{module}.{kind.__qualname__}"


def fields_of(instance: object) -> dict[str, Any]:
    """Return the fields of a dataclass as plain values by name. Arrays are replaced by their SHA-256."""
    # a model in `times` is omitted, because the coefficients already contain its influence
    cls = type(instance)
    if "__dataclass_fields__" not in vars(cls) or _has_closure(cls):
        raise InvalidValueError(
            "{type} is not a dataclass, or its functions hold other values; " + _ADVICE, type=full_name(cls)
        )
    values = {entry.name: getattr(instance, entry.name, None) for entry in fields(instance)}  # type: ignore[arg-type]
    return {name: _plain(cls, name, value) for name, value in values.items() if name != "times" or _is_plain(value)}


_ADVICE = "define content() for a law of your own"


def _plain(kind: type, name: str, value: object) -> Any:
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
        return hash_of(value)
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (list, tuple)):
        return [_plain(kind, name, item) for item in value]
    if _is_plain(value):
        return value
    raise InvalidValueError(
        "{field} of {type} must be a number, a text or an array, got {content}; " + _ADVICE,
        field=name,
        type=full_name(kind),
        content=f"{value!r:.60}",
    )


def _is_plain(value: object) -> bool:
    if isinstance(value, np.generic):
        value = value.item()
    return isinstance(value, (bool, int, str, type(None))) or (isinstance(value, float) and math.isfinite(value))


def _has_closure(kind: type) -> bool:
    """Return True if a function of the class uses variables of an enclosing function; `super` is allowed."""
    members = [member for name, member in vars(kind).items() if not name.startswith("__")]
    functions = [getattr(member, "__func__", getattr(member, "fget", member)) for member in members]
    codes = [member.__code__ for member in functions if hasattr(member, "__code__")]
    return any(set(code.co_freevars) - {"__class__"} for code in codes)
