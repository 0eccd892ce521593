"""Answers: every result that is shown, by the names of its quantities, and its numbers as a reader sees them."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking.conventions import UNITS
from rocking.messages import messages_of
from rocking.quantities import QUANTITIES, Quantity, quantity


@dataclass(frozen=True, eq=False)
class AnswerRows:
    """A table of an answer.

    >>> AnswerRows({"time": [0.1, 0.2], "onto": ["left", "right"]}).records[0]
    {'time': 0.1, 'onto': 'left'}
    """

    columns: Mapping[str, Sequence[Any]]  # columns of one length by the names of their quantities

    @classmethod
    def of_records(cls, records: Iterable[Mapping[str, Any]]) -> "AnswerRows":
        """Return values by the names of their quantities as a table; what a record lacks does not exist."""
        listed = list(records)
        names = dict.fromkeys(name for record in listed for name in record)
        return cls({name: [record.get(name) for record in listed] for name in names})

    @classmethod
    def of(cls, records: np.ndarray, *, without: Sequence[str] = ()) -> "AnswerRows":
        """Return a structured array whose fields are quantities."""
        return cls({name: records[name].tolist() for name in records.dtype.names or () if name not in without})

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    @property
    def records(self) -> list[dict[str, Any]]:
        """AnswerRows, as values by the names of their quantities."""
        return [dict(zip(self.columns, row, strict=True)) for row in zip(*self.columns.values(), strict=True)]

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """Columns as files contain them: numbers, or text; lists as text with dashes between."""
        return {name: _array(name, values) for name, values in self.columns.items()}


@dataclass(frozen=True, eq=False)
class Answer:
    """What is shown of a result.

    >>> block = Answer({"kind": "Block", "sides": {"left": {"semi_diagonal": 0.5}}})
    >>> block.plain()
    {'kind': 'Block', 'sides': {'left': {'semi_diagonal': 0.5}}, 'units': {'semi_diagonal': 'm'}}
    """

    # by the name of a quantity a number, array, word, message, or such values by a label; None for what does not
    # exist; by the name of a part another answer, rows, or such values
    values: Mapping[str, Any]
    quantities: Mapping[str, Quantity] = field(default_factory=dict)  # those of the answer alone, such as Sa(0.5 s)

    def __getitem__(self, name: str) -> Any:
        return self.values[name]

    def __contains__(self, name: str) -> bool:
        return name in self.values

    def __or__(self, more: "Mapping[str, Any] | Answer") -> "Answer":
        """Return the answer with more values."""
        other = more if isinstance(more, Answer) else Answer(more)
        return Answer({**self.values, **other.values}, {**self.quantities, **other.quantities})

    def plain(self) -> dict[str, Any]:
        """Return the values as JSON has them, null where there is no finite number, with units and messages beside."""
        own = dict(self.quantities)
        tree = plain(self, own)
        owners = dict.fromkeys(name for _, name in _owners(tree, (), own) if name)
        units = {name: entry.unit for name in owners if (entry := quantity(name, own)) and entry.unit}
        beside = {"units": units, "messages": messages_of(tree)}
        return {**tree, **{name: table for name, table in beside.items() if table}}

    @property
    def bare(self) -> list[str]:
        """Numbers without an entry in `rocking.quantities`, by their keys; none if all is well."""
        own = dict(self.quantities)
        tree = plain(self, own)
        return [path for path, name in _owners(tree, (), own) if not name]


def _array(name: str, values: Sequence[Any]) -> np.ndarray:
    entry = QUANTITIES[name]
    if codes := {word: code for code, word in entry.codes.items()}:
        return np.array([codes[word if word in codes else entry.spelled[word]] for word in values], dtype=np.int8)
    if entry.is_text:
        return np.array([each if isinstance(each, str) else "-".join(map(str, each)) for each in values], dtype=str)
    array = np.array(values)
    return array.astype(np.int8) if array.dtype == bool else array


def plain(value: Any, own: dict[str, Quantity] | None = None) -> Any:
    """Return a value as JSON has it, null where there is no finite number; own: takes quantities of answers in it."""
    own = {} if own is None else own
    if isinstance(value, Answer):
        own |= value.quantities
        return plain(value.values, own)
    if isinstance(value, AnswerRows):
        return plain(value.records, own)
    if isinstance(value, Mapping):
        return {str(name): plain(each, own) for name, each in value.items()}
    if hasattr(value, "tolist"):
        whole = getattr(getattr(value, "dtype", None), "kind", "") in "iub" or np.isfinite(value).all()
        return value.tolist() if whole else plain(value.tolist(), own)
    if isinstance(value, (list, tuple)):
        return [plain(each, own) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _owners(value: Any, path: tuple[str, ...], own: Mapping[str, Quantity]) -> Iterator[tuple[str, str]]:
    """Yield the keys of every number, and the last of them that is a quantity; empty if none is."""
    if isinstance(value, dict):
        for name, each in value.items():
            yield from _owners(each, (*path, name), own)
    elif isinstance(value, list):
        # the numbers of a list have one quantity
        number = next((each for each in value if isinstance(each, (int, float)) and not isinstance(each, bool)), None)
        for each in value if number is None else [number]:
            yield from _owners(each, path, own)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        name, entry = next(((each, entry) for each in reversed(path) if (entry := quantity(each, own))), ("", None))
        has_unit = entry is not None and (isinstance(value, int) or bool(entry.unit))
        yield ".".join(path), name if has_unit else ""


@dataclass(frozen=True)
class Display:
    """Units in which a reader sees lengths, accelerations and angles.

    >>> display = Display(length="mm")
    >>> display.text("semi_diagonal", 0.5), display.text("slenderness_angle", 0.25), display.heading("duration")
    ('500 mm', '14.3 deg', 'duration [s]')
    """

    length: str = "m"
    acceleration: str = "m/s2"
    angle: str = "deg"

    def unit(self, entry: Quantity) -> str:
        """Return the unit of a quantity for the reader; empty for numbers without one."""
        own = {"m": self.length, "m/s2": self.acceleration, "rad": self.angle, "1": ""}
        return own.get(entry.unit, entry.unit)

    def heading(self, name: str) -> str:
        """Return the heading of a column: label and unit."""
        entry = _entry(name)
        return f"{entry.heading} [{unit}]" if (unit := self.unit(entry)) else entry.heading

    def cell(self, name: str, value: Any) -> str:  # noqa: PLR0911 - one a kind
        """Return a value in the unit of the reader, without the unit; what does not exist is a dash."""
        if value is None or (isinstance(value, float) and math.isnan(value)):
            return "-"
        entry = _entry(name)
        if isinstance(value, bool):
            return "yes" if value else "no"
        if isinstance(value, str):
            return entry.spelled.get(value, value.replace("_", " "))
        if isinstance(value, (list, tuple)):
            return ("-" if entry.is_text else ", ").join(self.cell(name, each) for each in value)
        if math.isinf(value):
            return "infinite"
        size = UNITS.get(entry.unit, {}).get(self.unit(entry), 1.0)
        if isinstance(value, int) and size == 1.0:
            return str(value)
        return format(value / size + 0.0, entry.digits).replace("%", " %")

    def text(self, name: str, value: Any) -> str:
        """Return a value with its unit."""
        cell, unit = self.cell(name, value), self.unit(_entry(name))
        return f"{cell} {unit}" if unit and cell != "-" else cell

    def lines(self, values: Mapping[str, Any], names: Sequence[str]) -> Iterator[tuple[str, str]]:
        """Return label and text of those of some quantities that an answer has."""
        for name in names:
            if (value := values.get(name)) is not None and not (isinstance(value, float) and math.isnan(value)):
                yield _entry(name).heading, self.text(name, value)

    def table(self, rows: AnswerRows | Iterable[Mapping[str, Any]], names: Sequence[str] = ()) -> "list[ShownColumn]":
        """Return the columns of a table as a reader sees them: of those named that it has; of all if none are named.

        A quantity with an interval, as value, low and high or in columns of their own, has a second column for it.

        >>> rows = [{"observed": 0.5, "observed_low": 0.25, "observed_high": 0.75}]
        >>> [(column.heading, column.cells) for column in Display().table(rows)]
        [('observed', ['0.50']), ('95 %', ['0.25 to 0.75'])]
        """
        rows = rows if isinstance(rows, AnswerRows) else AnswerRows.of_records(rows)
        ends = {f"{name}{end}" for name in rows.columns for end in ("_low", "_high")}
        shown = names or [name for name in rows.columns if name not in ends]
        return [each for name in shown if name in rows.columns for each in self._columns(name, rows)]

    def _columns(self, name: str, rows: AnswerRows) -> "Iterator[ShownColumn]":
        values, lows, highs = (rows.columns.get(f"{name}{end}") for end in ("", "_low", "_high"))
        if any(isinstance(each, Mapping) for each in values or ()):
            values, lows, highs = ([each[key] for each in values or ()] for key in ("value", "low", "high"))
        yield ShownColumn(self.heading(name), [self.cell(name, each) for each in values or ()], _entry(name).is_text)
        if lows is not None and highs is not None:
            ends = ([self.cell(name, each) for each in column] for column in (lows, highs))
            yield ShownColumn("95 %", ["-" if "-" in pair else " to ".join(pair) for pair in zip(*ends, strict=True)])


@dataclass(frozen=True)
class ShownColumn:
    """A column of a table as a reader sees it."""

    heading: str
    cells: list[str]
    is_text: bool = False  # whether its cells are words, set flush left


def _entry(name: str) -> Quantity:
    """Return the quantity of a column; a part or a label is text."""
    return quantity(name) or Quantity(name, "", "")
