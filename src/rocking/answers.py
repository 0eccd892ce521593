"""Answers: results for display, by quantity name. Numbers are shown in the units of the reader."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from rocking.conventions import UNITS, percent
from rocking.messages import messages_of
from rocking.quantities import QUANTITIES, Quantity, quantity


@dataclass(frozen=True, eq=False)
class AnswerRows:
    """A table of an answer.

    >>> AnswerRows({"time": [0.1, 0.2], "foot": ["left", "right"]}).records[0]
    {'time': 0.1, 'foot': 'left'}
    """

    columns: Mapping[str, Sequence[Any]]  # columns of equal length by the names of their quantities

    @classmethod
    def of_records(cls, records: Iterable[Mapping[str, Any]]) -> "AnswerRows":
        """Return a table of records. A record contains values by quantity name; missing values become None."""
        listed = list(records)
        names = dict.fromkeys(name for record in listed for name in record)
        return cls({name: [record.get(name) for record in listed] for name in names})

    @classmethod
    def of(cls, records: np.ndarray, *, without: Sequence[str] = ()) -> "AnswerRows":
        """Return a table of a structured array. The fields of the array are quantities."""
        return cls({name: records[name].tolist() for name in records.dtype.names or () if name not in without})

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    @property
    def records(self) -> list[dict[str, Any]]:
        """Rows of the table. A row contains values by quantity name."""
        return [dict(zip(self.columns, row, strict=True)) for row in zip(*self.columns.values(), strict=True)]

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """Columns for files. A column contains numbers or text; lists become text with dashes."""
        return {name: _array(name, values) for name, values in self.columns.items()}


@dataclass(frozen=True, eq=False)
class Answer:
    """The displayed values of a result.

    >>> block = Answer({"kind": "Block", "sides": {"left": {"semi_diagonal": 0.5}}})
    >>> block.plain()
    {'kind': 'Block', 'sides': {'left': {'semi_diagonal': 0.5}}, 'units': {'semi_diagonal': 'm'}}
    """

    # under the name of a quantity: a number, array, text or message, None if missing, or a mapping from labels to these
    # under the name of a section: another answer, rows, or a mapping with these values
    values: Mapping[str, Any]
    quantities: Mapping[str, Quantity] = field(
        default_factory=dict
    )  # quantities of this answer only, such as Sa(0.5 s)

    def __getitem__(self, name: str) -> Any:
        return self.values[name]

    def __contains__(self, name: str) -> bool:
        return name in self.values

    def __or__(self, more: "Mapping[str, Any] | Answer") -> "Answer":
        """Return this answer with additional values."""
        other = more if isinstance(more, Answer) else Answer(more)
        return Answer({**self.values, **other.values}, {**self.quantities, **other.quantities})

    def plain(self) -> dict[str, Any]:
        """Return values, units and messages for JSON. Numbers that are not finite become null."""
        own = dict(self.quantities)
        tree = plain(self, own)
        owners = dict.fromkeys(name for _, name in _owners(tree, (), own) if name)
        units = {name: entry.unit for name in owners if (entry := quantity(name, own)) and entry.unit}
        beside = {"units": units, "messages": messages_of(tree)}
        return {**tree, **{name: table for name, table in beside.items() if table}}

    @property
    def bare(self) -> list[str]:
        """Keys of the numbers that have no entry in `rocking.quantities`. A correct answer has no such keys."""
        own = dict(self.quantities)
        tree = plain(self, own)
        return [path for path, name in _owners(tree, (), own) if not name]


def _array(name: str, values: Sequence[Any]) -> np.ndarray:
    entry = QUANTITIES[name]
    if codes := {word: code for code, word in entry.codes.items()}:
        return np.array([codes[word if word in codes else entry.spelled[word]] for word in values], dtype=np.int8)
    if entry.is_text:
        return np.array([value if isinstance(value, str) else "-".join(map(str, value)) for value in values], dtype=str)
    array = np.array(values)
    return array.astype(np.int8) if array.dtype == bool else array


def plain(value: Any, own: dict[str, Quantity] | None = None) -> Any:
    """Return a value for JSON; numbers that are not finite become null. Quantities of answers are added to `own`."""
    own = {} if own is None else own
    if isinstance(value, Answer):
        own |= value.quantities
        return plain(value.values, own)
    if isinstance(value, AnswerRows):
        return plain(value.records, own)
    if isinstance(value, Mapping):
        return {str(name): plain(item, own) for name, item in value.items()}
    if hasattr(value, "tolist"):
        is_finite = getattr(getattr(value, "dtype", None), "kind", "") in "iub" or np.isfinite(value).all()
        return value.tolist() if is_finite else plain(value.tolist(), own)
    if isinstance(value, (list, tuple)):
        return [plain(item, own) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _owners(value: Any, path: tuple[str, ...], own: Mapping[str, Quantity]) -> Iterator[tuple[str, str]]:
    """Yield the path of keys of every number, and the last key that is a quantity (empty text if there is none)."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _owners(item, (*path, name), own)
    elif isinstance(value, list):
        # all numbers of a list have one quantity
        number = next((item for item in value if isinstance(item, (int, float)) and not isinstance(item, bool)), None)
        for item in value if number is None else [number]:
            yield from _owners(item, path, own)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        name, entry = next(((item, entry) for item in reversed(path) if (entry := quantity(item, own))), ("", None))
        has_unit = entry is not None and (isinstance(value, int) or bool(entry.unit))
        yield ".".join(path), name if has_unit else ""


@dataclass(frozen=True)
class Display:
    """Units of lengths, accelerations and angles for the reader.

    >>> display = Display(length="mm")
    >>> display.text("semi_diagonal", 0.5), display.text("slenderness_angle", 0.25), display.heading("duration")
    ('500 mm', '14.32 deg', 'duration [s]')

    An acceleration in another unit is also shown in g.

    >>> display.text("uplift_acceleration", 2.94199), Display(acceleration="g").text("uplift_acceleration", 2.94199)
    ('2.942 m/s2 (0.3 g)', '0.3 g')
    """

    length: str = "m"
    acceleration: str = "m/s2"
    angle: str = "deg"
    own: Mapping[str, Quantity] = field(default_factory=dict)  # quantities of the answer only
    units: Mapping[str, str] = field(default_factory=dict)  # units of single quantities, by name

    def entry(self, name: str) -> Quantity:
        """Return the quantity of a column; sections and labels are text."""
        return quantity(name, self.own) or Quantity(name, "", "")

    def unit(self, entry: Quantity) -> str:
        """Return the unit of a quantity for the reader; empty for dimensionless numbers."""
        own = {"m": self.length, "m/s2": self.acceleration, "rad": self.angle, "1": ""}
        return self.units.get(entry.name) or own.get(entry.unit, entry.unit)

    def heading(self, name: str) -> str:
        """Return the heading of a column: label and unit."""
        entry = self.entry(name)
        return f"{entry.heading} [{unit}]" if (unit := self.unit(entry)) else entry.heading

    def cell(self, name: str, value: Any) -> str:  # noqa: PLR0911 - one per kind
        """Return a value in the unit of the reader, without the unit; a dash for missing values."""
        value = value.tolist() if hasattr(value, "tolist") else value
        if value is None or (isinstance(value, float) and math.isnan(value)):
            return "-"
        entry = self.entry(name)
        if isinstance(value, bool):
            return "yes" if value else "no"
        if isinstance(value, str):
            return entry.spelled.get(value, value.replace("_", " ") if entry.codes else value)
        if isinstance(value, (list, tuple)):
            return ("-" if entry.is_text else ", ").join(self.cell(name, item) for item in value)
        if entry.text_of is not None:
            return entry.text_of(value)
        if math.isinf(value):
            return "infinite"
        size = UNITS.get(entry.unit, {}).get(self.unit(entry), 1.0)
        if isinstance(value, int) and size == 1.0:
            return str(value)
        if entry.digits == "%":
            return percent(round(value, 4))
        return format(value / size + 0.0, entry.digits).replace("%", " %")

    def text(self, name: str, value: Any) -> str:
        """Return a value with its unit."""
        cell, unit = self.cell(name, value), self.unit(self.entry(name))
        in_g = f" ({self._in_g(name).text(name, value)})" if self._is_beside_g(name) and cell != "-" else ""
        return f"{cell} {unit}{in_g}" if unit and cell != "-" else cell

    def lines(
        self, values: Mapping[str, Any], names: Sequence[str], *, in_full: bool = False
    ) -> Iterator[tuple[str, str]]:
        """Yield label and text of the named quantities of an answer. The text of a body may have a value for each side.

        With `in_full`, the label is the meaning of the quantity.

        >>> sides = {"left": {"semi_diagonal": 0.5}, "right": {"semi_diagonal": 0.6}}
        >>> list(Display().lines({"mass": 2.0, "sides": sides}, ("mass", "semi_diagonal")))
        [('mass', '2 kg'), ('R', '0.5 m left, 0.6 m right')]
        """
        for name in names:
            entry = self.entry(name)
            of_sides = {foot: self.text(name, side[name]) for foot, side in values.get("sides", {}).items()
                        if name in side}  # fmt: skip
            value = values.get(name)
            if len({*of_sides.values()}) > 1:
                text = ", ".join(f"{text} {foot}" for foot, text in of_sides.items())
            elif of_sides:
                text = next(iter(of_sides.values()))
            elif value is None or (isinstance(value, float) and math.isnan(value)):
                continue
            else:
                text = self.text(name, value)
            yield entry.meaning if in_full else entry.heading, text

    def table(self, rows: AnswerRows | Iterable[Mapping[str, Any]], names: Sequence[str] = ()) -> "list[ShownColumn]":
        """Return the existing named columns of a table for the reader; all columns if `names` is empty.

        The interval of a quantity is in a second column. An acceleration in another unit also has a column in g.

        >>> rows = [{"observed": 0.5, "observed_low": 0.25, "observed_high": 0.75}]
        >>> [(column.heading, column.cells) for column in Display().table(rows)]
        [('observed', ['0.50']), ('95 %', ['0.25 to 0.75'])]
        """
        rows = rows if isinstance(rows, AnswerRows) else AnswerRows.of_records(rows)
        ends = {f"{name}{end}" for name in rows.columns for end in ("_low", "_high", "_95")}
        shown = names or [name for name in rows.columns if name not in ends]
        columns = [column for name in shown if name in rows.columns for column in self._columns(name, rows)]
        intervals = [k for k, column in enumerate(columns) if column.heading == "95 %"]
        for k in intervals if len(intervals) > 1 else ():  # add the heading of the quantity
            columns[k] = replace(columns[k], heading=f"{columns[k - 1].heading.partition(' [')[0]} 95 %")
        return columns

    def _columns(self, name: str, rows: AnswerRows) -> "Iterator[ShownColumn]":
        values, lows, highs = (rows.columns.get(f"{name}{end}") for end in ("", "_low", "_high"))
        if any(isinstance(value, Mapping) for value in values or ()):
            values, lows, highs = ([value[key] for value in values or ()] for key in ("value", "low", "high"))
        if pairs := rows.columns.get(f"{name}_95"):
            lows, highs = zip(*(value or (None, None) for value in pairs), strict=True)
        entry, cells = self.entry(name), [self.cell(name, value) for value in values or ()]
        yield ShownColumn(self.heading(name), cells, entry.is_text or entry.text_of is not None, name)
        if self._is_beside_g(name):
            yield ShownColumn(f"{entry.heading} [g]", [self._in_g(name).cell(name, value) for value in values or ()])
        if lows is not None and highs is not None:
            end = f"{name}_low" if f"{name}_low" in self.own else name
            ends = ([self.cell(end, value) for value in column] for column in (lows, highs))
            # the text of a missing bound is "open"
            texts = [" to ".join("open" if end == "-" else end for end in pair) for pair in zip(*ends, strict=True)]
            texts = ["-" if text == "open to open" else text for text in texts]
            yield from [ShownColumn("95 %", texts)] if {*texts} != {"-"} else []

    def _is_beside_g(self, name: str) -> bool:
        entry = self.entry(name)
        return entry.unit == "m/s2" and self.unit(entry) != "g"

    def _in_g(self, name: str) -> "Display":
        return replace(self, units={name: "g"})


@dataclass(frozen=True)
class ShownColumn:
    """A column of a table for the reader."""

    heading: str
    cells: list[str]
    is_text: bool = False  # True for left-aligned text
    name: str = ""  # name of the quantity
