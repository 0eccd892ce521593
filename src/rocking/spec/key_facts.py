"""Type, unit, default, range and meaning of a key of a file, from the field of its table."""

from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from rocking.spec.fields import Angle, Values, limits_of, meaning_and_unit, stated_facts

LARGEST_SHOWN = 1e9  # larger limits are limits of memory, not of the quantity
_SIGNS = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}
_TYPES: dict[Any, str] = {str: "text", Angle: "text", float: "number", int: "integer", bool: "boolean"}


def facts(field: FieldInfo) -> tuple[str, str, str, str, str]:
    """Return type, unit, default, range and meaning of a key.

    A field without limits states its range as `allowed`.
    """
    stated = stated_facts(field)
    meaning, unit = meaning_and_unit(field.description or "")
    if '"' in unit:  # the name of a table
        meaning, unit = f"{meaning} [{unit}]", ""
    return (
        type_of(field.annotation),
        stated.get("unit") or unit or "-",
        "required" if field.is_required() else as_code(field.default) or stated.get("usual", "none"),
        stated.get("allowed") or range_of(field.annotation, (field,)),
        meaning,
    )


def as_code(value: Any) -> str:
    """Return a default as code; empty without a default."""
    if value is None or value is PydanticUndefined or isinstance(value, BaseModel):
        return ""
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def type_of(annotation: Any) -> str:
    """Return the type of a key, such as "list of numbers"."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return type_of(inner[0])
    if origin in {Union, UnionType}:
        return " or ".join(dict.fromkeys(type_of(kind) for kind in inner if kind is not NoneType))
    if origin is Literal:
        return type_of(type(inner[0]))
    if origin is list:
        return "list" if inner[0] is Any else f"list of {_plural(type_of(inner[0]))}"
    return _TYPES.get(annotation, _type_of_table(annotation))


def _type_of_table(annotation: Any) -> str:
    if annotation is Any:
        return "number, text, list or table"
    if issubclass(get_origin(annotation) or annotation, Values):
        return "numbers" if annotation is Values else "axis and numbers"
    return "table"


def _plural(item: str) -> str:
    """Return the plural of a type, such as "texts or lists of numbers"."""
    return " or ".join(
        name.replace("list", "lists", 1) if " of " in name else f"{name}s" for name in item.split(" or ")
    )


def range_of(annotation: Any, limits: tuple[Any, ...] = ()) -> str:
    """Return the allowed values of a type with limits, such as "> 0, <= 1"; empty without limits."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return range_of(inner[0], (*limits, *inner[1:]))
    if origin in {Union, UnionType}:
        texts = [range_of(kind, limits) for kind in inner if kind is not NoneType]
        return " or ".join(dict.fromkeys(texts)) if all(texts) else ""
    if origin is Literal or annotation is bool:
        values = inner or (False, True)
        return ", ".join(str(value).lower() if isinstance(value, bool) else str(value) for value in values)
    if origin is list:
        return _range_of_list(inner[0], limits)
    return _range_of_class(annotation, limits)


def _range_of_class(annotation: Any, limits: tuple[Any, ...]) -> str:
    if annotation is str:
        low, high = _length(limits)
        return f"{low} to {high} characters" if high else ""
    if type_of(annotation) == "table":
        return "keys of its table"
    bounds = {name: value for limit in limits for name, value in _bounds(limit).items()}
    return ", ".join(f"{_SIGNS[name]} {bound:,.10g}" for name, bound in bounds.items() if bound < LARGEST_SHOWN)


def _range_of_list(item: Any, limits: tuple[Any, ...]) -> str:
    """Return the number of items with their type and limits; empty for lists of lists."""
    low, high = _length(limits)
    count = f"{low} to {high}" if high else f"{low} or more" if low else "any number of"
    count = f"{low}" if low == high > 0 else count
    kind, inner = type_of(item), range_of(item)
    if kind.startswith("list"):
        return ""
    separator = " of " if get_origin(item) is Literal else ", each " if kind == "text" else " "
    numeric = kind in {"number", "integer", "text"} and inner
    return f"{count} {kind if (low, high) == (1, 1) else _plural(kind)}" + (f"{separator}{inner}" if numeric else "")


def _bounds(limit: Any) -> dict[str, float]:
    """Return the limits of a number in a field or in an annotation."""
    annotation: Any = Annotated[float, limit]
    return limits_of(limit if isinstance(limit, FieldInfo) else FieldInfo.from_annotation(annotation))


def _length(limits: tuple[Any, ...]) -> tuple[int, int]:
    """Return the smallest and the largest length of a list or text; 0 without a limit."""
    entries = [entry for limit in limits for entry in (getattr(limit, "metadata", None) or [limit])]
    low = max((getattr(entry, "min_length", None) or 0 for entry in entries), default=0)
    return low, max((getattr(entry, "max_length", None) or 0 for entry in entries), default=0)
