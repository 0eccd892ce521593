"""Columns with units, tables of them, and results over dimensions that are handed out piece by piece."""

import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rocking.errors import InvalidValueError, RockingError
from rocking.messages import plain_texts
from rocking.quantities import QUANTITIES, Quantity

PIECE = 1 << 16
"""Rows that are in memory at once as Python objects: they take many times the room of their numbers."""

Cell = str | int | float | None
Arrays = Mapping[str, np.ndarray]
Block = tuple[tuple[slice, ...], slice]

_FORMULA = ("=", "+", "-", "@", "\uff1d", "\uff0b", "\uff0d", "\uff20", "\t", "\r", "\n")  # the wide ones count too


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """Values of one kind, and what they are.

    >>> Column.of("rotation", np.zeros(2)).attributes
    {'units': 'rad', 'long_name': 'rotation theta, positive clockwise'}
    """

    values: np.ndarray  # numbers, NaN where there is nothing, or text
    unit: str = "1"  # the unit; ``1`` for numbers without one, or empty
    meaning: str = ""  # what the values are
    variable: str | None = None  # the name in netCDF and MATLAB files, where it differs
    dims: tuple[str, ...] = ()  # dimensions of the values, where they are not the rows of a table
    codes: Mapping[int, str] = field(default_factory=dict)  # what whole numbers stand for
    # which of the values each row has; the values stand in the order of the rows if not given
    index: np.ndarray | None = None
    standard_name: str = ""  # the name in the table of the CF conventions, where that has it

    @classmethod
    def of(cls, name: str, values: np.ndarray) -> "Column":
        """Return values of what has an entry in `rocking.quantities`."""
        entry = QUANTITIES[name]
        if np.asarray(values).dtype.kind == "U":
            return cls(values, "", entry.meaning)
        return cls(values, entry.unit, entry.meaning, codes=entry.codes, standard_name=entry.standard_name)

    @property
    def array(self) -> np.ndarray:
        """The value of each row."""
        return self.values if self.index is None else self.values[self.index]

    @property
    def is_text(self) -> bool:
        """Whether the values are text."""
        return self.values.dtype.kind not in "iufb"

    @property
    def attributes(self) -> dict[str, Any]:
        """Unit, meaning and codes, as xarray and the CF conventions name them."""
        return Quantity("", self.unit, self.meaning, dict(self.codes), self.standard_name).attributes

    def __len__(self) -> int:
        return int(self.values.size if self.index is None else self.index.size)

    @property
    def decoded(self) -> "Column":
        """What the codes of the rows stand for: text, empty where a number is no code."""
        codes = np.array(sorted(self.codes), dtype=np.float64)
        place = np.minimum(np.searchsorted(codes, self.values), codes.size - 1)
        index = np.where(codes[place] == self.values, place, codes.size)
        return Column(text_array([*(self.codes[code] for code in sorted(self.codes)), ""]), "", index=index)

    def cells(self, rows: slice, *, blank: bool = True) -> list[Cell]:
        """Return some rows as cells: all digits, text that no spreadsheet takes for a formula, None for nothing."""
        values = self.array[rows]
        cells: list[Cell] = values.tolist()
        if self.is_text:
            return [safe_cell(cell) if isinstance(cell, str) else cell for cell in cells]
        if not blank or (finite := np.isfinite(values)).all():
            return cells
        return [cell if known else None for cell, known in zip(cells, finite.tolist(), strict=True)]


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """Columns of one length, and where they come from.

    >>> Table("sample", {"rotation": Column.of("rotation", np.zeros(2))}).header
    ['rotation [rad]']
    """

    row: str  # what a row is: the dimension in netCDF files
    columns: Mapping[str, Column]  # the columns by name
    provenance: Mapping[str, Any] = field(default_factory=dict)  # what was computed from what: plain values
    # further tables of the same result, by what one of their rows is
    beside: Mapping[str, "Table"] = field(default_factory=dict)
    no_unit: str = ""  # what headings say in brackets of numbers without unit; no brackets if empty

    def __post_init__(self) -> None:
        object.__setattr__(self, "provenance", plain_texts(self.provenance))

    @classmethod
    def of(cls, row: str, arrays: Arrays, **more: Any) -> "Table":
        """Return a table of arrays that have entries in `rocking.quantities`; more: its other fields."""
        return cls(row, {name: Column.of(name, values) for name, values in arrays.items()}, **more)

    @classmethod
    def of_rows(cls, row: str, header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> "Table":
        """Return a table of cells whose headings say the units already."""
        if len(set(header)) < len(header):
            raise InvalidValueError("headings of a table must differ, got {headings}", headings=", ".join(header))
        cells = [list(map(_checked, each)) for each in rows]
        columns = {name: text_array([each[k] for each in cells]) for k, name in enumerate(header)}
        return cls(row, {name: Column(values, "") for name, values in columns.items()})

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    @property
    def header(self) -> list[str]:
        """Names of the columns with their units; what codes stand for has a column of its own after them."""
        return _header(self.columns, self.no_unit)

    @property
    def rows(self) -> list[tuple[Any, ...]]:
        """All rows, as plain values."""
        return list(zip(*(column.values.tolist() for column in self.columns.values()), strict=True))

    def cells(self, *, blank: bool = True) -> Iterator[tuple[Cell, ...]]:
        """Return the rows of a file, harmless to spreadsheets; blank: cells without a finite number are empty."""
        columns = decoded(self.columns).values()
        for first in range(0, len(self), PIECE):
            part = slice(first, first + PIECE)
            yield from zip(*(each.cells(part, blank=blank) for each in columns), strict=True)

    def pieces(self) -> Iterator["Table"]:
        """Return the table as a stream of tables."""
        yield self


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Results over dimensions that may be larger than the memory: they come piece by piece."""

    row: str  # what the results are of, in the plural
    dims: Mapping[str, int]  # length of every dimension; the last one changes fastest
    coordinates: Mapping[str, Column]  # what is known along dimensions: columns with `dims`
    results: Mapping[str, Any]  # types of the results, by their names in `rocking.quantities`
    # returns an iterator over first row, last row (not included) and arrays of the results between them
    arrays: Callable[[], Iterator[tuple[int, int, Arrays]]]
    provenance: Mapping[str, Any] = field(default_factory=dict)  # what was computed from what: plain values

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of every dimension."""
        return tuple(self.dims.values())

    def __len__(self) -> int:
        return math.prod(self.shape)

    @property
    def columns(self) -> dict[str, Column]:
        """Columns of the rows, none of them filled."""
        return dict(self._piece(0, 0, {name: np.empty(0, kind) for name, kind in self.results.items()}).columns)

    @property
    def header(self) -> list[str]:
        """Names of the columns with their units; what codes stand for has a column of its own after them."""
        return _header(self.columns, "")

    def pieces(self) -> Iterator[Table]:
        """Return a row for each place, as a stream of tables."""
        for first, last, arrays in self.arrays():
            yield self._piece(first, last, arrays)

    def blocks(self) -> Iterator[tuple[str, tuple[slice, ...], np.ndarray]]:
        """Return the results in rectangular blocks: name, place and values."""
        for first, last, arrays in self.arrays():
            for place, part in blocks(first, last, self.shape):
                for name, values in arrays.items():
                    yield name, place, np.asarray(values)[part].reshape([each.stop - each.start for each in place])

    def _piece(self, first: int, last: int, arrays: Arrays) -> Table:
        places = dict(zip(self.dims, np.unravel_index(np.arange(first, last, dtype=np.int64), self.shape), strict=True))
        columns = {}
        for name, each in self.coordinates.items():
            index = np.ravel_multi_index(tuple(places[dim] for dim in each.dims), each.values.shape)
            columns[name] = Column(each.values.ravel(), each.unit, each.meaning, codes=each.codes, index=index)
        columns |= {name: Column.of(name, np.asarray(values)) for name, values in arrays.items()}
        return Table(self.row, columns)


def blocks(first: int, last: int, shape: tuple[int, ...]) -> Iterator[Block]:
    """Return the rectangular blocks that entries first to last, numbered row by row, fill: where, and which entries."""
    at = first
    while at < last:
        place = [int(i) for i in np.unravel_index(at, shape)]
        # the longest run that starts here: whole rows of the innermost dimensions, as far as they are at their start
        axis, width = len(shape) - 1, 1
        while axis > 0 and place[axis] == 0 and at + width * shape[axis] <= last:
            width *= shape[axis]
            axis -= 1
        run = max(1, min(shape[axis] - place[axis], (last - at) // width))
        where = [slice(i, i + 1) for i in place]
        where[axis] = slice(place[axis], place[axis] + run)
        where[axis + 1 :] = [slice(0, n) for n in shape[axis + 1 :]]
        yield tuple(where), slice(at - first, at - first + run * width)
        at += run * width


def safe_cell(cell: Cell) -> Cell:
    """Return a cell that no spreadsheet takes for a formula.

    >>> safe_cell("=1+1"), safe_cell(-1.5)
    ("'=1+1", -1.5)
    """
    if isinstance(cell, str):
        clean = "".join(c if c.isprintable() else " " for c in cell)
        return f"'{clean}" if escaped(cell) != cell else clean
    return _checked(cell)


def _checked(cell: Cell) -> Cell:
    if isinstance(cell, float) and not math.isfinite(cell):
        raise InvalidValueError("cells of a table must be finite, got {cell}", cell=cell)
    return cell


def escaped(text: str) -> str:
    """Return text that no spreadsheet takes for a formula.

    >>> escaped("=1+1"), escaped("vase")
    ("'=1+1", 'vase')
    """
    return f"'{text}" if text.lstrip(" ").startswith(_FORMULA) else text


def target_of(path: str | os.PathLike[str]) -> Path:
    """Return the path of a file that can be written."""
    other: object = path
    if not isinstance(other, (str, os.PathLike)):
        raise InvalidValueError(parameter="path", allowed="the path of a file", value=path)
    target = Path(path)
    if target.is_dir():
        raise InvalidValueError(
            "{parameter} must be the path of a file, got the folder {folder}", parameter="path", folder=target
        )
    if not target.parent.is_dir():
        raise InvalidValueError("no folder {folder} to write {file} into", folder=target.parent, file=target.name)
    return target


@contextmanager
def writing(path: Path | str) -> Iterator[None]:
    """Say which file or folder could not be written, and why, where the system refuses it."""
    try:
        yield
    except OSError as error:
        raise RockingError("cannot write {path}: {fault}", path=path, fault=error.strerror or str(error)) from error


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Give the name under which to write a file that is there as a whole or not at all."""
    unfinished = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield unfinished
        with unfinished.open("rb+") as file:
            os.fsync(file.fileno())
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


def text_array(values: Sequence[Any]) -> np.ndarray:
    """Return text as an array."""
    array = np.empty(len(values), dtype=object)
    array[:] = [str(value) if isinstance(value, str) else value for value in values]  # no messages
    return array


def prefixed(prefix: str, columns: Mapping[str, Column]) -> dict[str, Column]:
    """Return columns under names by which several tables fit into one file."""
    return {
        name: Column(each.values, each.unit, each.meaning, f"{prefix}_{each.variable or name}")
        for name, each in columns.items()
    }


def decoded(columns: Mapping[str, Column]) -> dict[str, Column]:
    """Return columns as people read them: after each column of codes one that says what they stand for."""
    every = {}
    for name, each in columns.items():
        every[name] = each
        if each.codes:
            every[f"{name}_meaning"] = each.decoded
    return every


def _header(columns: Mapping[str, Column], no_unit: str) -> list[str]:
    units = {name: no_unit if each.unit in {"1", "-"} else each.unit for name, each in decoded(columns).items()}
    return [f"{name} [{unit}]" if unit else name for name, unit in units.items()]
