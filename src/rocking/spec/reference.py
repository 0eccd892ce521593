"""The documentation of the keys of a question, made from its tables: docs/questions.md."""

import types
from collections.abc import Iterator
from typing import Any, Literal, Union, get_args, get_origin

from pydantic_core import PydanticUndefined

from rocking.spec import document
from rocking.spec.fields import JobTable, Values

_TABLES: dict[str, tuple[type[JobTable], str]] = {
    "response": (document.ResponseTable, "`rocking simulate`"),
    "motion": (document.ComponentsTable, "`rocking simulate`, `rocking motion`; [[motions]] of a study has records and "
               "count, and pulse may be a list"),
    "restitution": (document.RestitutionTable, "every question"),
    "settings": (document.SettingsTable, "every question"),
    "map": (document.MapTable, "`rocking map`"),
    "minimum": (document.MinimumTable, "`rocking minimum`"),
    "spectrum": (document.SpectrumTable, "`rocking spectrum`"),
    "fragility": (document.FragilityTable, "`rocking fragility`"),
    "inventory": (document.InventoryTable, "`rocking inventory`"),
    "histories": (document.HistoriesTable, "campaigns of kind histories"),
    "campaign": (document.CampaignTable, "`rocking campaign`"),
    "export": (document.ExportTable, "`rocking campaign export`"),
}  # fmt: skip


def reference() -> str:
    """Return a table of keys for every table of a question: name, kind, what it has if left out, meaning and unit."""
    return "\n".join(_lines()) + "\n"


def _lines() -> Iterator[str]:
    for name, (table, where) in _TABLES.items():
        yield f"### [{name}]"
        yield f"\n{(table.__doc__ or '').splitlines()[0]} Of {where}.\n"
        yield "| key | kind | if left out | meaning |"
        yield "|---|---|---|---|"
        for key, field in table.model_fields.items():
            usual = "needed" if field.is_required() else _usual(field.default)
            yield f"| `{field.alias or key}` | {_kind(field.annotation)} | {usual} | {field.description or ''} |"
        yield ""


def _usual(value: Any) -> str:
    if value is None or value is PydanticUndefined or isinstance(value, JobTable):
        return ""
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _kind(annotation: Any) -> str:
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        return ", ".join(str(one).lower() if isinstance(one, bool) else str(one) for one in inner)
    if origin in {Union, types.UnionType}:
        return " or ".join(dict.fromkeys(_kind(one) for one in inner if one is not type(None)))
    if origin is list:
        return f"list of {_kind(inner[0])}"
    if isinstance(annotation, type) and issubclass(annotation, Values):
        return "numbers" if annotation is Values else "axis and numbers"
    if isinstance(annotation, type) and issubclass(annotation, JobTable):
        return "table"
    names = {str: "text", float: "number", int: "whole number", bool: "true or false"}
    return names.get(annotation, _kind(inner[0]) if inner else "any")
