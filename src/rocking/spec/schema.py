"""Schema numbers of input files, and the keys that each schema renamed."""

from collections.abc import Iterator
from typing import Any

from rocking.errors import InvalidValueError

SCHEMA = 2  # current schema; a file without a number has schema 1

RENAMED: dict[int, dict[str, str]] = {
    1: {
        "export.crossing": "crossing_curves",
        "export.measures": "ims",
        "fragility.factor": "scale",
        "fragility.measure": "im",
        "fragility.states": "limit_states",
        "inventory.columns": "map_columns",
        "minimum.highest": "max_pga",
        "minimum.levels": "bisections",
        "minimum.lowest": "min_pga",
        "minimum.points": "samples",
        "predict.shares": "contributions",
        "response.bounce": "normal_restitution",
        "response.bounce_law": "normal_restitution_law",
        "response.free": "initial_rotation",
        "settings.bounce": "normal_restitution",
        "settings.bounce_law": "normal_restitution_law",
    },
}
"""New names of keys, by schema number of the old name and by path of the old key, such as ``table.key``."""

_FORMS = {"range": "minimum", "unknown": "predict"}  # names of tables, by their name in the form of an assessment
_FORM_KEYS = {
    "decide": {"what": "command"},
    "measure": {"known": "body", "what": "command"},
    "records": {"asked": "sent"},
    "space": {"asked": "analysis"},
}
"""New names of keys, by form of a project and by old name."""


def migrated(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a file of any schema, converted to the current schema.

    >>> migrated({"fragility": {"measure": "pgv"}}), migrated({"schema": 2, "fragility": {"measure": "pgv"}})
    ({'fragility': {'im': 'pgv'}}, {'fragility': {'measure': 'pgv'}})
    """
    number = tables.get("schema", 1)
    if type(number) is not int or not 1 <= number <= SCHEMA:
        hint = "a later version of rocking reads this file" if type(number) is int and number > SCHEMA else ""
        allowed = f"a whole number from 1 to {SCHEMA}"
        raise InvalidValueError(parameter="schema", value=number, allowed=allowed, hint=hint)
    tables = {name: table for name, table in tables.items() if name != "schema"}
    for step in range(number, SCHEMA):
        for path, new in RENAMED[step].items():
            tables = _renamed(tables, path.split("."), new)
    return tables


def migrated_document(document: dict[str, Any]) -> dict[str, Any]:
    """Return the document of a project with the current keys in inputs and forms."""
    inputs, forms = document.get("inputs"), document.get("forms")
    if isinstance(inputs, dict):
        document = {**document, "inputs": migrated(inputs)}
    if isinstance(forms, dict):
        forms = {**forms, **migrated({"inventory": forms["inventory"]} if "inventory" in forms else {})}
        if isinstance(decide := forms.get("decide"), dict):
            tables = migrated({table: decide[form_name] for form_name, table in _FORMS.items() if form_name in decide})
            parts = {form_name: tables[table] for form_name, table in _FORMS.items() if table in tables}
            forms = {**forms, "decide": {**decide, **parts}}
        for name, keys in _FORM_KEYS.items():
            if isinstance(form := forms.get(name), dict):
                forms = {**forms, name: {keys.get(key, key): value for key, value in form.items()}}
        document = {**document, "forms": forms}
    return document


def _renamed(table: dict[str, Any], path: list[str], new: str) -> dict[str, Any]:
    """Return a table with the last key of a path renamed, in all tables of a list."""
    key, *inner = path
    if key not in table:
        return table
    if not inner:
        if new in table:
            raise InvalidValueError("{old} and {new} are the same key. Remove {old}.", old=key, new=new)
        return {new if name == key else name: value for name, value in table.items()}
    value = table[key]
    if isinstance(value, list):
        value = [_renamed(item, inner, new) if isinstance(item, dict) else item for item in value]
    elif isinstance(value, dict):
        value = _renamed(value, inner, new)
    return {**table, key: value}


def renamed_keys() -> Iterator[tuple[str, str]]:
    """Yield the old and the new path of every renamed key, in alphabetic order."""
    for step in RENAMED.values():
        for path, new in sorted(step.items()):
            table, _, _ = path.rpartition(".")
            yield path, f"{table}.{new}"
