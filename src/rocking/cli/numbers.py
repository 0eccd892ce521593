"""Input and output of numbers with units."""

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.bodies import Block
from rocking.cli.page import Page, wrap
from rocking.cli.spelling import UsageError
from rocking.conventions import UNITS, FloatArray
from rocking.spec.fields import Angle, Values, kinds_of, meaning_and_unit

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from rocking.answers import Answer, Display

SIDE = ("slenderness_angle", "semi_diagonal", "frequency_parameter")
"""Quantities of a body in its description."""

MOST_VALUES = 100_000  # largest number of values in a row


def values_table(name: str, text: str, unit: str, spacing: str = "linear") -> tuple[dict[str, Any], str]:
    """Return a row of values as a table of an input file, and their given unit, empty if none.

    text: numbers separated by commas, FIRST:LAST:COUNT, FIRST:LAST:COUNT:log or FIRST:LAST:COUNT:linear.

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
        raise UsageError(parameter=name, allowed="FIRST:LAST:COUNT, FIRST:LAST:COUNT:log or A,B,C", value=text)
    (first, last), written = _quantities(name, pieces[:2], unit)
    if not re.fullmatch(r"\s*[0-9]{1,9}\s*", pieces[2]) or not 2 <= int(pieces[2]) <= MOST_VALUES:
        raise UsageError(
            "{parameter} must have a COUNT from 2 to {limit}, got {value}", parameter=name, limit=MOST_VALUES,
            value=pieces[2],
        )  # fmt: skip
    spacing = pieces[3].strip() if len(pieces) == 4 else spacing
    if spacing == "log" and min(first, last) <= 0.0:
        raise UsageError(parameter=name, allowed="above 0 for logarithmic spacing", value=text)
    return {"from": first, "to": last, "count": int(pieces[2]), "spacing": spacing}, written


def row(name: str, text: str, unit: str, spacing: str = "linear") -> tuple[FloatArray, str]:
    """Return a row of values [unit], and their given unit, empty if none."""
    table, written = values_table(name, text, unit, spacing)
    return Values.model_validate(table).numbers(), written


def numbers_in(name: str, text: str) -> list[float]:
    """Return numbers separated by commas; `name` is the option for the error message."""
    try:
        return [float(word) for word in text.split(",")]
    except ValueError as error:
        raise UsageError(parameter=name, allowed="numbers separated by commas, such as 0.42,0.7", value=text) from error


def value_of(field: "FieldInfo", option: str, value: Any) -> Any:
    """Return the value of an input-file key from the text of its option."""
    if not isinstance(value, str):
        return value
    kinds, (_, unit) = kinds_of(field), meaning_and_unit(field.description or "")
    if Angle in kinds:
        return Angle.of(option, value)
    kind = kinds[0]
    if kind is float:
        return checks.quantity(option, value, unit)[0]
    if kind is Values:
        return values_table(option, value, unit if unit in UNITS else "1")[0]
    return numbers_in(option, value) if kind == list[float] else value


def _quantities(name: str, texts: list[str], unit: str) -> tuple[list[float], str]:
    if len(texts) > MOST_VALUES:
        raise UsageError(
            "{parameter} must have at most {limit} values, got {count}", parameter=name, limit=MOST_VALUES,
            count=len(texts),
        )  # fmt: skip
    pairs = [checks.quantity(name, text, unit) for text in texts]
    written = [suffix for _, suffix in pairs]
    if "" in written and any(written):  # the unit of 0.1 in 0.1:1g would be ambiguous
        hint = checks.number_hint(",".join(texts))
        raise UsageError(
            "{parameter} must have a unit at every number or no unit, got {value}", parameter=name,
            value=":".join(texts), hint=hint,
        )  # fmt: skip
    return [value for value, _ in pairs], written[0]


def units_of(text: str | None, *kinds: Mapping[str, float]) -> tuple[str | None, ...]:
    """Return the unit of each kind in a text such as ``mm,g``; None for a kind without a unit.

    >>> from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS
    >>> units_of("g, mm", LENGTH_UNITS, ACCELERATION_UNITS), units_of(None, LENGTH_UNITS)
    (('mm', 'g'), (None,))
    """
    units: list[str | None] = [None] * len(kinds)
    for entry in [] if text is None else text.split(","):
        name = checks.one_of("--units", entry.strip(), [unit for kind in kinds for unit in kind])
        index = next(k for k, kind in enumerate(kinds) if name in kind)
        if units[index] is not None:
            raise UsageError(
                "{parameter} must have one unit per quantity, got {first} and {second}", parameter="--units",
                first=units[index], second=name,
            )  # fmt: skip
        units[index] = name
    return tuple(units)


def beside_g(unit: str) -> str:
    """Return the unit of an acceleration that is also printed in g: m/s2 instead of g."""
    return "m/s2" if unit == "g" else unit


def number_or_name(text: str | None) -> float | str | None:
    """Return a coefficient, or the name of a model, or None."""
    with suppress(TypeError, ValueError):
        return float(text or "")
    return text


def recommendation_values(recommendation: Any) -> dict[str, Any]:
    """Return the values of a recommendation, or no values for None."""
    return {} if recommendation is None else {"recommendation": recommendation.answer()}


_COLUMNS = {
    "kept": "energy after 2 impacts", "to half": "impacts to half energy", "bias": "bias of r", "error": "RMSE of r",
    "standing": "comparison",
}  # fmt: skip
_MOST_RECOMMENDED = 8  # rows without details


def show_recommendation(page: Page, recommendation: Any, *, details: bool = True) -> None:
    """Write a recommendation on a page; nothing for None. With `details` it contains the evidence, and no r."""
    if recommendation is None:
        return
    page.line("\nRecommended model", "bold")
    head, rows = recommendation.table
    if recommendation.judgement is not None:
        # with details, coefficients and intervals are in the table above
        shown = [k for k, name in enumerate(head) if not details or name.split()[0] != "r"]
        chosen = {k for k, row in enumerate(rows) if row[0] == recommendation.prediction}
        cells = [[row[k] for k in shown] for row in rows][: None if details else _MOST_RECOMMENDED]
        names = [_COLUMNS.get(head[k], head[k]) for k in shown]
        page.table([wrap(name, 12) for name in names], cells, ("model", "comparison"), bold=chosen, unfolded={0})
    for sentence in recommendation.evidence if details else ():
        page.line(sentence)
    for sentence in recommendation.advice:
        page.line(sentence, "bold")


def body_line(body: Any, answer: "Answer", display: "Display", names: Sequence[str] = SIDE[:1]) -> str:
    """Return size, mass and the named quantities of a body in one line."""
    line = answer["name"] or "Solid" if "name" in answer else answer["kind"]
    if isinstance(body, Block):
        line += f" {display.cell('size', body.width)} x {display.text('size', body.height)}"
    elif "size" in answer:
        line += f", {' x '.join(display.cell('size', side) for side in answer['size'])} {display.length}"
    parts = answer.values.get("parts") if "parts" in names else None
    count = [f"{parts} part{'s' * (parts != 1)}"] if parts is not None else []
    listed = (f"{label} {text}" for label, text in display.lines(answer.values, [n for n in names if n != "parts"]))
    return ", ".join([line, display.text("mass", answer["mass"]), *count, *listed])
