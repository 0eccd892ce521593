"""Columns with units, tables of columns, and results over dimensions in pieces."""

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
"""Largest number of rows in memory as Python objects, which are much larger than their numbers."""

Cell = str | int | float | None
Arrays = Mapping[str, np.ndarray]
Block = tuple[tuple[slice, ...], slice]

_FORMULA = (
    "=",
    "+",
    "-",
    "@",
    "\uff1d",
    "\uff0b",
    "\uff0d",
    "\uff20",
    "\t",
    "\r",
    "\n",
)  # including full-width characters


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """Values with unit and meaning.

    >>> Column.of("rotation", np.zeros(2)).attributes
    {'units': 'rad', 'long_name': 'rotation theta, positive clockwise'}
    """

    values: np.ndarray  # numbers (NaN if missing), or text
    unit: str = "1"  # ``1`` or empty for dimensionless values
    meaning: str = ""
    variable: str | None = None  # name in netCDF and MATLAB files, if different
    dims: tuple[str, ...] = ()  # dimensions of the values, unless they are the rows of a table
    codes: Mapping[int, str] = field(default_factory=dict)  # meanings of integer codes
    # for each row, the index of its value; if None, values are in the order of the rows
    index: np.ndarray | None = None
    standard_name: str = ""  # name in the table of the CF conventions, if any

    @classmethod
    def of(cls, name: str, values: np.ndarray) -> "Column":
        """Return the values of a quantity from `rocking.quantities` as a column."""
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
        """True if the values are text."""
        return self.values.dtype.kind not in "iufb"

    @property
    def attributes(self) -> dict[str, Any]:
        """Unit, meaning and codes as attributes of xarray and the CF conventions."""
        return Quantity("", self.unit, self.meaning, dict(self.codes), self.standard_name).attributes

    def __len__(self) -> int:
        return int(self.values.size if self.index is None else self.index.size)

    @property
    def decoded(self) -> "Column":
        """Meanings of the codes of the rows as text; empty for numbers without a meaning."""
        codes = np.array(sorted(self.codes), dtype=np.float64)
        position = np.minimum(np.searchsorted(codes, self.values), codes.size - 1)
        index = np.where(codes[position] == self.values, position, codes.size)
        return Column(text_array([*(self.codes[code] for code in sorted(self.codes)), ""]), "", index=index)

    def cells(self, rows: slice, *, blank: bool = True) -> list[Cell]:
        """Return rows as cells: numbers with all digits, text without formulas, None for missing values."""
        values = self.array[rows]
        cells: list[Cell] = values.tolist()
        if self.is_text:
            return [safe_cell(cell) if isinstance(cell, str) else cell for cell in cells]
        if not blank or (finite := np.isfinite(values)).all():
            return cells
        return [cell if is_finite else None for cell, is_finite in zip(cells, finite.tolist(), strict=True)]


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """Columns of equal length, with provenance.

    >>> Table("sample", {"rotation": Column.of("rotation", np.zeros(2))}).header
    ['rotation [rad]']
    """

    row: str  # name of the rows: the dimension in netCDF files
    columns: Mapping[str, Column]
    provenance: Mapping[str, Any] = field(default_factory=dict)  # sources and methods, as plain values
    # further tables of the same result, by the name of their rows
    related: Mapping[str, "Table"] = field(default_factory=dict)
    no_unit: str = ""  # unit in headings of dimensionless numbers; no brackets if empty

    def __post_init__(self) -> None:
        object.__setattr__(self, "provenance", plain_texts(self.provenance))

    @classmethod
    def of(cls, row: str, arrays: Arrays, **more: Any) -> "Table":
        """Return a table of arrays by their names in `rocking.quantities`; `more` contains other fields."""
        return cls(row, {name: Column.of(name, values) for name, values in arrays.items()}, **more)

    @classmethod
    def of_rows(cls, row: str, header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> "Table":
        """Return a table of cells with units in the headings."""
        if len(set(header)) < len(header):
            raise InvalidValueError("headings of a table must differ, got {headings}", headings=", ".join(header))
        cells = [list(map(_checked, row_cells)) for row_cells in rows]
        columns = {name: text_array([row_cells[k] for row_cells in cells]) for k, name in enumerate(header)}
        return cls(row, {name: Column(values, "") for name, values in columns.items()})

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    @property
    def header(self) -> list[str]:
        """Names of the columns with units; columns of codes are followed by columns of their meanings."""
        return _header(self.columns, self.no_unit)

    @property
    def rows(self) -> list[tuple[Any, ...]]:
        """All rows, as plain values."""
        return list(zip(*(column.values.tolist() for column in self.columns.values()), strict=True))

    def cells(self, *, blank: bool = True) -> Iterator[tuple[Cell, ...]]:
        """Return the rows without formulas. With `blank`, cells of numbers that are not finite are empty."""
        columns = decoded(self.columns).values()
        for first in range(0, len(self), PIECE):
            rows = slice(first, first + PIECE)
            yield from zip(*(column.cells(rows, blank=blank) for column in columns), strict=True)

    def pieces(self) -> Iterator["Table"]:
        """Yield the table itself."""
        yield self


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Results over dimensions, in pieces, because the results may be larger than the memory."""

    row: str  # name of the rows, in the plural
    dims: Mapping[str, int]  # length of every dimension; the last one changes fastest
    coordinates: Mapping[str, Column]  # columns along dimensions, with `dims`
    results: Mapping[str, Any]  # data types of the results, by their names in `rocking.quantities`
    # returns an iterator over pieces: first row, last row (excluded), and arrays of the results of these rows
    arrays: Callable[[], Iterator[tuple[int, int, Arrays]]]
    provenance: Mapping[str, Any] = field(default_factory=dict)  # sources and methods, as plain values

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of every dimension."""
        return tuple(self.dims.values())

    def __len__(self) -> int:
        return math.prod(self.shape)

    @property
    def columns(self) -> dict[str, Column]:
        """Columns with zero rows."""
        return dict(self._piece(0, 0, {name: np.empty(0, kind) for name, kind in self.results.items()}).columns)

    @property
    def header(self) -> list[str]:
        """Names of the columns with units; columns of codes are followed by columns of their meanings."""
        return _header(self.columns, "")

    def pieces(self) -> Iterator[Table]:
        """Yield tables with one row per grid point."""
        for first, last, arrays in self.arrays():
            yield self._piece(first, last, arrays)

    def blocks(self) -> Iterator[tuple[str, tuple[slice, ...], np.ndarray]]:
        """Yield the results in rectangular blocks: name, position and values."""
        for first, last, arrays in self.arrays():
            for position, entries in blocks(first, last, self.shape):
                for name, values in arrays.items():
                    yield (
                        name,
                        position,
                        np.asarray(values)[entries].reshape([interval.stop - interval.start for interval in position]),
                    )

    def _piece(self, first: int, last: int, arrays: Arrays) -> Table:
        positions = dict(
            zip(self.dims, np.unravel_index(np.arange(first, last, dtype=np.int64), self.shape), strict=True)
        )
        columns = {}
        for name, coordinate in self.coordinates.items():
            index = np.ravel_multi_index(tuple(positions[dim] for dim in coordinate.dims), coordinate.values.shape)
            columns[name] = Column(
                coordinate.values.ravel(), coordinate.unit, coordinate.meaning, codes=coordinate.codes, index=index
            )
        columns |= {name: Column.of(name, np.asarray(values)) for name, values in arrays.items()}
        return Table(self.row, columns)


def blocks(first: int, last: int, shape: tuple[int, ...]) -> Iterator[Block]:
    """Yield rectangular blocks of the flat entries `first` to `last`: position in the grid, slice of the entries."""
    entry = first
    while entry < last:
        position = [int(i) for i in np.unravel_index(entry, shape)]
        # take complete rows of the innermost dimensions as long as they start at zero
        axis, width = len(shape) - 1, 1
        while axis > 0 and position[axis] == 0 and entry + width * shape[axis] <= last:
            width *= shape[axis]
            axis -= 1
        run = max(1, min(shape[axis] - position[axis], (last - entry) // width))
        slices = [slice(i, i + 1) for i in position]
        slices[axis] = slice(position[axis], position[axis] + run)
        slices[axis + 1 :] = [slice(0, n) for n in shape[axis + 1 :]]
        yield tuple(slices), slice(entry - first, entry - first + run * width)
        entry += run * width


def safe_cell(cell: Cell) -> Cell:
    """Return a cell that a spreadsheet does not read as a formula.

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
    """Return a text that a spreadsheet does not read as a formula.

    >>> escaped("=1+1"), escaped("vase")
    ("'=1+1", 'vase')
    """
    return f"'{text}" if text.lstrip(" ").startswith(_FORMULA) else text


def target_of(path: str | os.PathLike[str]) -> Path:
    """Return the validated path of an output file."""
    other: object = path
    if not isinstance(other, (str, os.PathLike)):
        raise InvalidValueError(parameter="path", allowed="the path of a file", value=path)
    target = Path(path)
    if target.is_dir():
        raise InvalidValueError(
            "{parameter} must be the path of a file, got the folder {folder}", parameter="path", folder=target
        )
    if not target.parent.is_dir():
        raise InvalidValueError("no folder {folder} for {file}", folder=target.parent, file=target.name)
    return target


@contextmanager
def writing(path: Path | str) -> Iterator[None]:
    """Convert system errors to an error with path and reason."""
    try:
        yield
    except OSError as error:
        raise RockingError("cannot write {path}: {fault}", path=path, fault=error.strerror or str(error)) from error


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Yield a temporary path. On success, the temporary file replaces `path` in one step."""
    unfinished = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield unfinished
        with unfinished.open("rb+") as file:
            os.fsync(file.fileno())
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


def text_array(values: Sequence[Any]) -> np.ndarray:
    """Return texts as an array of objects."""
    array = np.empty(len(values), dtype=object)
    array[:] = [str(value) if isinstance(value, str) else value for value in values]  # messages become plain texts
    return array


def prefixed(prefix: str, columns: Mapping[str, Column]) -> dict[str, Column]:
    """Return columns with a prefix in their variable names, for several tables in one file."""
    return {
        name: Column(column.values, column.unit, column.meaning, f"{prefix}_{column.variable or name}")
        for name, column in columns.items()
    }


def decoded(columns: Mapping[str, Column]) -> dict[str, Column]:
    """Return columns for readers: each column of codes is followed by a column of their meanings."""
    result = {}
    for name, column in columns.items():
        result[name] = column
        if column.codes:
            result[f"{name}_meaning"] = column.decoded
    return result


def _header(columns: Mapping[str, Column], no_unit: str) -> list[str]:
    units = {name: no_unit if column.unit in {"1", "-"} else column.unit for name, column in decoded(columns).items()}
    return [f"{name} [{unit}]" if unit else name for name, unit in units.items()]
