"""Numbers with units, as they are typed, and as they are printed."""

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.bodies import Block
from rocking.cli.page import Page
from rocking.conventions import UNITS, FloatArray
from rocking.errors import InvalidValueError
from rocking.spec.fields import Values, kinds_of, meaning_and_unit

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from rocking.answers import Answer, Display

SIDE = ("slenderness_angle", "semi_diagonal", "frequency_parameter")
"""Quantities of a body at the head of a page."""

MOST_VALUES = 100_000  # no row of values has more


def values_table(name: str, text: str, unit: str, spacing: str = "linear") -> tuple[dict[str, Any], str]:
    """Return a row of values as the table of a document, and the unit in which all were written, empty if none.

    text: numbers with commas between, or FIRST:LAST:COUNT, or that with :log or :linear.

    >>> values_table("pga", "1:3:3", "m/s2")
    ({'from': 1.0, 'to': 3.0, 'count': 3, 'spacing': 'linear'}, '')
    >>> values_table("periods", "1,2,4", "s")
    ({'values': [1.0, 2.0, 4.0]}, '')
    """
    pieces = text.split(":")
    if len(pieces) == 1:
        values, written = _quantities(name, text.split(","), unit)
        return {"values": values}, written
    if len(pieces) not in {3, 4} or (len(pieces) == 4 and pieces[3].strip() not in {"linear", "log"}):
        raise InvalidValueError(parameter=name, allowed="FIRST:LAST:COUNT, or that with :log, or A,B,C", value=text)
    (first, last), written = _quantities(name, pieces[:2], unit)
    if not re.fullmatch(r"\s*[0-9]{1,9}\s*", pieces[2]) or not 2 <= int(pieces[2]) <= MOST_VALUES:
        raise InvalidValueError(
            "{parameter} must have a COUNT from 2 to {limit}, got {value}", parameter=name, limit=MOST_VALUES,
            value=pieces[2],
        )  # fmt: skip
    spacing = pieces[3].strip() if len(pieces) == 4 else spacing
    if spacing == "log" and min(first, last) <= 0.0:
        raise InvalidValueError(parameter=name, allowed="above 0 to be spaced by equal ratios", value=text)
    return {"from": first, "to": last, "count": int(pieces[2]), "spacing": spacing}, written


def row(name: str, text: str, unit: str, spacing: str = "linear") -> tuple[FloatArray, str]:
    """Return a row of values [unit], and the unit in which all were written, empty if none."""
    table, written = values_table(name, text, unit, spacing)
    return Values.model_validate(table).numbers(), written


def numbers_in(name: str, text: str) -> list[float]:
    """Return numbers with commas between; name: the option, for the refusal."""
    try:
        return [float(word) for word in text.split(",")]
    except ValueError as error:
        raise InvalidValueError(
            parameter=name, allowed="numbers with commas between, such as 0.42,0.7", value=text
        ) from error


def value_of(field: "FieldInfo", option: str, typed: Any) -> Any:
    """Return the value of a key of a table from what was typed for its option."""
    if not isinstance(typed, str):
        return typed
    kind, (_, unit) = kinds_of(field)[0], meaning_and_unit(field.description or "")
    if kind is float:
        return checks.quantity(option, typed, unit)[0]
    if kind is Values:
        return values_table(option, typed, unit if unit in UNITS else "1")[0]
    return numbers_in(option, typed) if kind == list[float] else typed


def _quantities(name: str, texts: list[str], unit: str) -> tuple[list[float], str]:
    if len(texts) > MOST_VALUES:
        raise InvalidValueError(
            "{parameter} must have at most {limit} values, got {count}", parameter=name, limit=MOST_VALUES,
            count=len(texts),
        )  # fmt: skip
    pairs = [checks.quantity(name, text, unit) for text in texts]
    written = [one for _, one in pairs]
    if "" in written and any(written):  # 0.1:1g could mean either
        why = checks.number_hint(",".join(texts))
        raise InvalidValueError(
            "{parameter} must have a unit at every number or at none, got {value}", parameter=name,
            value=":".join(texts), hint=why,
        )  # fmt: skip
    return [value for value, _ in pairs], written[0]


def units_of(text: str | None, *kinds: Mapping[str, float]) -> tuple[str | None, ...]:
    """Return the unit of every kind in a text such as ``mm,g``, None where none was given.

    >>> from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS
    >>> units_of("g, mm", LENGTH_UNITS, ACCELERATION_UNITS), units_of(None, LENGTH_UNITS)
    (('mm', 'g'), (None,))
    """
    units: list[str | None] = [None] * len(kinds)
    for part in [] if text is None else text.split(","):
        name = checks.one_of("--units", part.strip(), [each for kind in kinds for each in kind])
        place = next(k for k, kind in enumerate(kinds) if name in kind)
        if units[place] is not None:
            raise InvalidValueError(
                "{parameter} must have one unit of a kind, got {first} and {second}", parameter="--units",
                first=units[place], second=name,
            )  # fmt: skip
        units[place] = name
    return tuple(units)


def beside_g(unit: str) -> str:
    """Return the unit in which an acceleration is written where it stands in g too: m/s2 in place of g."""
    return "m/s2" if unit == "g" else unit


def number_or_name(text: str | None) -> float | str | None:
    """Return a coefficient where a number was typed, else the name of a model, or none."""
    with suppress(TypeError, ValueError):
        return float(text or "")
    return text


def recommendation_values(found: Any) -> dict[str, Any]:
    """Return a recommendation for an answer; nothing where none was asked for."""
    return {} if found is None else {"recommendation": found.answer()}


def show_recommendation(page: Page, found: Any) -> None:
    """Write a recommendation on a page, if there is one."""
    if found is None:
        return
    from rocking.evidence.recommendation import LEGEND

    page.line("\nWhich model to use", "bold")
    head, rows = found.table
    if found.judgement is not None:
        # coefficients and intervals stand above
        shown = [k for k, name in enumerate(head) if name.split()[0] != "r"]
        chosen = {k for k, row in enumerate(rows) if row[0] == found.prediction}
        words = [[row[k] for k in shown] for row in rows]
        page.table([head[k] for k in shown], words, ("model", "standing"), bold=chosen)
        page.line(LEGEND, "dim")
    for sentence in found.evidence:
        page.line(sentence)
    for sentence in found.advice:
        page.line(sentence, "bold")


def body_line(body: Any, answer: "Answer", display: "Display", names: Sequence[str] = SIDE[:1]) -> str:
    """Return size, mass and some quantities of a body in one line."""
    line = answer["name"] or "Solid" if "name" in answer else answer["kind"]
    if isinstance(body, Block):
        line += f" {display.cell('size', body.width)} x {display.text('size', body.height)}"
    elif "size" in answer:
        line += f", {' x '.join(display.cell('size', side) for side in answer['size'])} {display.length}"
    parts = answer.values.get("parts") if "parts" in names else None
    count = [f"{parts} part{'s' * (parts != 1)}"] if parts is not None else []
    listed = (f"{label} {text}" for label, text in display.lines(answer.values, [n for n in names if n != "parts"]))
    return ", ".join([line, display.text("mass", answer["mass"]), *count, *listed])
