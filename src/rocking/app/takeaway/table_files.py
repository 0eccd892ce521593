"""Tables as files for a browser: comma-separated values, Excel, MATLAB, netCDF."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rocking.app.errors import NotFound
from rocking.app.takeaway.plain_text import LONGEST_CELL, plain_line
from rocking.errors import InvalidValueError
from rocking.tables import (
    Cell,
    Column,
    Table,
    text_array,
    to_csv,
    to_dataset,
    to_excel,
    to_mat,
    to_netcdf,
)

MEDIA_TYPES = {
    "csv": "text/csv; charset=utf-8",
    "xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    "mat": "application/x-matlab-data",
    "nc": "application/x-netcdf",
}
"""What a browser is told about a table."""

MOST_CELLS = 2_000_000
"""Cells of a workbook; more would take minutes to write and longer to open."""


def column(unit: str, values: "Iterable[Cell] | np.ndarray") -> Column:
    """Return a column of numbers, NaN where there is nothing, or of text that can be seen.

    unit: empty for text, ``-`` for numbers without one.
    """
    plain: list[Cell] = values.tolist() if isinstance(values, np.ndarray) else list(values)
    if any(isinstance(value, str) for value in plain):
        return Column(text_array(["" if v is None else plain_line(str(v), LONGEST_CELL) for v in plain]), unit)
    if plain and all(isinstance(value, int) for value in plain):
        return Column(np.array(plain, dtype=np.int64), unit)
    numbers = [value if isinstance(value, (int, float)) and math.isfinite(value) else math.nan for value in plain]
    return Column(np.array(numbers, dtype=np.float64), unit)


def table(columns: dict[str, Column], about: dict[str, str]) -> Table:
    """Return columns as a table; about: what it belongs to."""
    return Table("row", columns, {key: plain_line(value, LONGEST_CELL) for key, value in about.items()}, no_unit="-")


def written(sheets: Sequence[tuple[str, Table]], kind: str) -> bytes:
    """Return tables as a file: all of them, under their names, in Excel, the first one elsewhere."""
    if kind not in MEDIA_TYPES:
        raise NotFound(f"tables are {', '.join(MEDIA_TYPES)}, not {kind!r:.20}")
    first = sheets[0][1]
    with TemporaryDirectory(prefix="rocking-table-") as folder:
        path = Path(folder) / f"table.{kind}"
        if kind == "csv":
            to_csv(first, path, for_excel=True)
        elif kind == "xlsx":
            _check_cells([one for _, one in sheets])
            to_excel([(plain_line(name), one) for name, one in sheets], path, others="csv or mat", dressed=True)
        elif kind == "mat":
            to_mat(_doubles(first), path)
        else:
            units = {name: replace(each, unit=each.unit or "1") for name, each in _doubles(first).columns.items()}
            to_netcdf(to_dataset(replace(first, columns=units)), path)
        return path.read_bytes()


def _check_cells(tables: Sequence[Table]) -> None:
    cells = sum(len(one) * len(one.columns) for one in tables)
    if cells > MOST_CELLS:
        raise InvalidValueError(f"a workbook holds up to {MOST_CELLS} cells, this would have {cells}: take csv or mat")


def _doubles(one: Table) -> Table:
    columns = {
        name: each if each.is_text else replace(each, values=each.values.astype(np.float64))
        for name, each in one.columns.items()
    }
    return replace(one, columns=columns)
