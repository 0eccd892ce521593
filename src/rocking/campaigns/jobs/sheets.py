"""Tables of adaptive studies as files: CSV, Parquet, Excel, MATLAB, and variables of a netCDF file."""

import csv
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns.jobs.answer import Column, Sheet
from rocking.campaigns.jobs.matlab import sheet_to_matlab
from rocking.campaigns.jobs.netcdf import netcdf_file, room_of
from rocking.campaigns.jobs.results import PIECE
from rocking.campaigns.jobs.rows import MOST_ROWS_OF_EXCEL
from rocking.campaigns.jobs.workbook import new_book, save_book
from rocking.errors import InvalidValueError, extra
from rocking.studies.fragility.tables import safe_cell

Attributes = Mapping[str, Any]


def sheet_to_csv(sheet: Sheet, path: Path, attributes: Attributes) -> None:
    """Write a table as comma-separated values, all digits kept; what is no finite number is left empty."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(sheet.header())
        writer.writerows(_rows(sheet))


def sheet_to_parquet(sheet: Sheet, path: Path, attributes: Attributes) -> None:
    """Write a table as Parquet; units are in the metadata of the columns."""
    pa: Any = extra("pyarrow", "Parquet")
    parquet: Any = extra("pyarrow.parquet", "Parquet")
    arrays = [
        pa.array(each.values.tolist(), pa.string()) if each.is_words else pa.array(each.values)
        for each in sheet.columns.values()
    ]
    fields = [
        pa.field(name, array.type, metadata={"units": each.unit, "long_name": each.words})
        for (name, each), array in zip(sheet.columns.items(), arrays, strict=True)
    ]
    told = {name: value if isinstance(value, str) else json.dumps(value) for name, value in attributes.items()}
    schema = pa.schema(fields, metadata=told)
    parquet.write_table(pa.table(arrays, schema=schema), path)


def sheet_to_excel(sheet: Sheet, path: Path, attributes: Attributes) -> None:
    """Write a table as a workbook: one sheet of rows, one that says where they come from."""
    if sheet.rows > MOST_ROWS_OF_EXCEL:
        raise InvalidValueError(
            f"a sheet of Excel has {MOST_ROWS_OF_EXCEL} rows, these are {sheet.rows}; take .parquet or .csv"
        )
    book = new_book()
    page = book.create_sheet(sheet.dim)
    page.append(sheet.header())
    for row in _rows(sheet):
        page.append(row)
    page = book.create_sheet("provenance")
    for name, value in attributes.items():
        page.append([name, safe_cell(str(value)[:32_000])])
    save_book(book, path)


SHEET_FORMATS: dict[str, Callable[[Sheet, Path, Attributes], None]] = {
    ".csv": sheet_to_csv,
    ".parquet": sheet_to_parquet,
    ".mat": sheet_to_matlab,
    ".xlsx": sheet_to_excel,
}
"""What writes a table, by the end of the file's name."""


def sheets_to_netcdf(sheets: Mapping[str, Sheet], path: Path, attributes: Attributes) -> None:
    """Write tables as variables of a netCDF file, which is made or, where it is there, added to."""
    h5py: Any = extra("h5py", "netCDF")
    room = sum(room_of(each.values) for sheet in sheets.values() for each in sheet.columns.values())
    with netcdf_file(path, "a", room) as file:
        for name, value in attributes.items():
            file.attrs[name] = value
        for sheet in sheets.values():
            file.dimensions[sheet.dim] = sheet.rows
            for name, each in sheet.columns.items():
                _variable(file, sheet, each.variable or name, each, h5py.string_dtype())


def _variable(file: Any, sheet: Sheet, name: str, column: Column, words: Any) -> None:
    made = file.create_variable(name, (sheet.dim,), dtype=words if column.is_words else column.values.dtype)
    if sheet.rows:
        made[...] = column.values
    made.attrs["units"], made.attrs["long_name"] = column.unit, column.words


def _rows(sheet: Sheet) -> Iterator[tuple[Any, ...]]:
    """Return the rows, made piece by piece: as Python objects they take many times the room of their numbers."""
    for first in range(0, sheet.rows, PIECE):
        part = slice(first, first + PIECE)
        yield from zip(*(_cells(each, part) for each in sheet.columns.values()), strict=True)


def _cells(column: Column, part: slice) -> list[Any]:
    values = column.values[part]
    cells = values.tolist()
    if column.is_words:
        return [safe_cell(word) for word in cells]
    return cells if np.all(np.isfinite(values)) else [cell if np.isfinite(cell) else None for cell in cells]
