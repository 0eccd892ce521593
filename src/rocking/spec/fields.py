"""Base class and value types of all tables of a job file.

This module loads pydantic. Import it only to read a file.
"""

import math
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import numpy as np
from pydantic import BeforeValidator, ConfigDict, Field, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from rocking import checks
from rocking.bodies.formats.schema import StrictTable
from rocking.bodies.formats.schema import key as key  # noqa: PLC0414 - the tables import it from here
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.filters import geometric

Positive = Annotated[float, Field(gt=0.0)]
Seed = Annotated[int, Field(ge=0, le=2**63 - 1)]
Text = Annotated[str, Field(min_length=1, max_length=200)]


class Angle(str):
    """Text of an angle between -90 and 90 degrees with its unit, such as 5deg.

    >>> Angle.of("initial_rotation", "0.1rad").radians, Angle.of("initial_rotation", "0.5")
    (0.1, 0.5)
    """

    radians: float

    @classmethod
    def of(cls, name: str, text: str) -> "float | Angle":
        """Return the angle in a text, or the number in a text without a unit."""
        if isinstance(text, cls):
            return text
        number, unit = checks.quantity(name, text, "rad")
        if not unit:
            return number
        if abs(number) >= 0.5 * math.pi:
            raise InvalidValueError(parameter=name, allowed="in (-90, 90) deg", value=text)
        angle = cls(text)
        angle.radians = number
        return angle

    @classmethod
    def __get_pydantic_core_schema__(cls, *_: Any) -> CoreSchema:
        # a text remains a text, because `of` needs the name of its key
        return core_schema.no_info_wrap_validator_function(
            lambda value, check: value if isinstance(value, cls) else check(value), core_schema.str_schema()
        )


def meaning_and_unit(description: str) -> tuple[str, str]:
    """Return the meaning and the unit in a description such as "mass [kg]"; the unit is empty if absent."""
    text = description.rstrip(".")
    meaning, bracket, unit = text.removesuffix("]").rpartition("[")
    return (meaning.strip(), unit) if bracket and text.endswith("]") else (description.strip(), "")


def stated_facts(field: FieldInfo) -> dict[str, str]:
    """Return the facts of a key that `key` states by name: usual, allowed, unit."""
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    return {name: str(text) for name, text in extra.items()}


def kinds_of(field: FieldInfo) -> list[Any]:
    """Return the types of a field without limits and without None."""
    inner = get_args(field.annotation) if get_origin(field.annotation) in {Union, UnionType} else [field.annotation]
    return [get_args(kind)[0] if get_origin(kind) is Annotated else kind for kind in inner if kind is not NoneType]


def limits_of(field: FieldInfo) -> dict[str, float]:
    """Return the limits of a number by name: ge, gt, le, lt."""
    entries = [metadata for kind in (field, *get_args(field.annotation)) for metadata in getattr(kind, "metadata", ())]
    entries += [metadata for kind in get_args(field.annotation) for metadata in getattr(kind, "__metadata__", ())]
    constraints = [
        constraint
        for metadata in entries
        for constraint in (metadata.metadata if isinstance(metadata, FieldInfo) else [metadata])
    ]
    names = ("ge", "gt", "le", "lt")
    return {
        name: value
        for metadata in constraints
        for name in names
        if (value := getattr(metadata, name, None)) is not None
    }


class JobTable(StrictTable):
    """A table of a job file."""

    model_config = ConfigDict(defer_build=True)

    def chosen(self, *names: str) -> str:
        """Return the only stated key of several keys. Raise an error if none or more than one is stated."""
        stated = [name for name in names if getattr(self, name) is not None]
        if len(stated) != 1:
            raise InvalidValueError(
                "Use exactly one of {names}, got {keys}.", names=", ".join(names), keys=" and ".join(stated) or "none",
            )  # fmt: skip
        return stated[0]


class Values(JobTable):
    """A list of numbers, or a range."""

    values: Annotated[list[float], Field(min_length=1, max_length=10_000_000)] | None = None
    start: float | None = Field(default=None, alias="from")
    stop: float | None = Field(default=None, alias="to")
    count: Annotated[int, Field(ge=1, le=10_000_000)] | None = None
    spacing: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def _whole(self) -> "Values":
        ends = {"from": self.start, "to": self.stop, "count": self.count}
        stated = [name for name, value in ends.items() if value is not None]
        if self.values is not None and (stated or "spacing" in self.model_fields_set):
            raise InvalidValueError(
                "Use values or {keys}, not both.", parameter="values", keys=", ".join(stated) or "spacing"
            )
        if self.values is None and len(stated) < len(ends):
            raise InvalidValueError(
                "Use values = [...], or from, to and count. Got {keys}.", keys=", ".join(stated) or "none of them"
            )
        if self.values is None and self.spacing == "log" and min(self.start or 0.0, self.stop or 0.0) <= 0.0:
            raise InvalidValueError(
                "from and to must be > 0 with log spacing, got {start!r} and {stop!r}.", start=self.start,
                stop=self.stop,
            )  # fmt: skip
        if self.count == 1 and self.start != self.stop:
            raise InvalidValueError(
                "{parameter} must be >= 2 if from and to differ, got 1 from {start!r} to {stop!r}.",
                parameter="count", start=self.start, stop=self.stop,
            )  # fmt: skip
        return self

    @property
    def size(self) -> int:
        """Number of values."""
        return len(self.values) if self.values is not None else int(self.count or 0)

    def numbers(self) -> FloatArray:
        if self.values is not None:
            return np.array(self.values, dtype=np.float64)
        start, stop, count = self.start or 0.0, self.stop or 0.0, self.count or 1  # all are stated, as checked above
        if self.spacing == "log":
            return geometric(start, stop, count)
        return np.linspace(start, stop, count)


def _in_table(stated: Any) -> Any:
    if isinstance(stated, list):
        return {"values": stated}
    return {"values": [stated]} if isinstance(stated, (int, float)) and not isinstance(stated, bool) else stated


def in_list(stated: Any) -> Any:
    """Return a single table or text as a list with one item, and any other value unchanged."""
    return [stated] if isinstance(stated, (dict, str)) else stated


Numbers = Annotated[Values, BeforeValidator(_in_table)]

Names = Annotated[list[Text], Field(min_length=1), BeforeValidator(in_list)]
