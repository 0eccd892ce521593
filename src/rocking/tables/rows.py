"""Files of rows: CSV, Parquet, Excel. They are written in pieces, so that a file may be larger than the memory."""

import csv
import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.errors import InvalidValueError, extra
from rocking.tables.table import Cell, Column, Grid, Table, decoded, safe_cell

if TYPE_CHECKING:
    import pandas as pd

MOST_ROWS_OF_EXCEL = 1_048_575  # rows of a sheet without its header
_LONGEST_CELL = 32_000
_LONGEST_TITLE = 31
_WIDEST = 60


def to_dataframe(table: Table) -> "pd.DataFrame":
    """Return a table as pandas.DataFrame."""
    pandas = extra("pandas", "a table")
    arrays = (column.array for column in decoded(table.columns).values())
    frame: pd.DataFrame = pandas.DataFrame(dict(zip(table.header, arrays, strict=True)))
    return frame


def to_csv(table: Table | Grid, path: Path, *, blank: bool = True, for_excel: bool = False) -> Path:
    """Write a table as comma-separated values with all digits; the header contains the units."""
    # for_excel: write a byte order mark for UTF-8, and quote text so that Excel does not split it at semicolons
    with path.open("w", newline="", encoding="utf-8-sig" if for_excel else "utf-8") as file:
        writer = csv.writer(file, quoting=csv.QUOTE_NONNUMERIC if for_excel else csv.QUOTE_MINIMAL)
        writer.writerow(map(safe_cell, table.header))
        for piece in table.pieces():
            writer.writerows(piece.cells(blank=blank))
    return path


def to_parquet(table: Table | Grid, path: Path) -> None:
    """Write a table as Parquet, one row group per piece; the metadata of the columns contain the units."""
    pa: Any = extra("pyarrow", "Parquet")
    parquet: Any = extra("pyarrow.parquet", "Parquet")
    text, coded = pa.string(), pa.dictionary(pa.int32(), pa.string())

    def arrow(column: Column) -> Any:
        if not column.is_text:
            return pa.array(column.array)
        texts, index = pa.array(column.values.tolist(), text), column.index
        return texts if index is None else pa.DictionaryArray.from_arrays(pa.array(index.astype(np.int32)), texts)

    fields = []
    for name, column in table.columns.items():
        number = None if column.is_text else pa.from_numpy_dtype(column.values.dtype)
        kind = number or (text if column.index is None else coded)
        fields.append(pa.field(name, kind, metadata={"units": column.unit, "long_name": column.meaning}))
    provenance = {
        key: value if isinstance(value, str) else json.dumps(value) for key, value in table.provenance.items()
    }
    schema = pa.schema(fields, metadata=provenance)
    with parquet.ParquetWriter(path, schema) as writer:
        for piece in table.pieces():
            writer.write_table(pa.table([arrow(column) for column in piece.columns.values()], schema=schema))


def to_excel(
    sheets: Sequence[tuple[str, Table | Grid]], path: Path, provenance: Mapping[str, Any] | None = None, *,
    others: str = ".parquet or .csv", dressed: bool = False,
) -> None:  # fmt: skip
    """Write tables as a workbook without formulas."""
    # the workbook is made in memory: a workbook that is written directly to a full disk raises errors later
    # others: file formats for more rows, named in the error
    # dressed: bold fixed headings, fitted column widths and all digits instead of 16, but slower
    for _, table in sheets:
        if len(table) > MOST_ROWS_OF_EXCEL:
            kind = f" {table.row}" if isinstance(table, Grid) else ""
            raise InvalidValueError(
                "a sheet of Excel has at most {limit} rows, but the table has {count}{rows}", limit=MOST_ROWS_OF_EXCEL,
                count=len(table), rows=kind, hint=f"use {others}",
            )  # fmt: skip
    book: Any = extra("openpyxl", "Excel").Workbook(write_only=True)
    titles: list[str] = []
    for name, table in sheets:
        titles.append(_title(name, titles))
        page = book.create_sheet(titles[-1])
        if dressed:
            _fill(page, table)
            continue
        page.append([safe_cell(heading) for heading in table.header])
        for piece in table.pieces():
            for row in piece.cells():
                page.append(row)
    if provenance is not None:
        page = book.create_sheet("provenance")
        for name, value in provenance.items():
            page.append([name, safe_cell(str(value)[:_LONGEST_CELL])])
    buffer = BytesIO()
    try:
        book.save(buffer)
    except OSError:
        for page in book.worksheets:
            with suppress(Exception):
                page.close()
        raise
    path.write_bytes(buffer.getbuffer())


def _fill(page: Any, table: Table | Grid) -> None:
    fonts, cells = import_module("openpyxl.styles"), import_module("openpyxl.cell")
    page.freeze_panes = "A2"
    letters = import_module("openpyxl.utils").get_column_letter
    for k, (heading, column) in enumerate(zip(table.header, decoded(table.columns).values(), strict=True), start=1):
        widest = max([len(heading), *map(len, column.array[:200].tolist() if column.is_text else ())])
        page.column_dimensions[letters(k)].width = min(_WIDEST, widest + 2)
    head = [_filled(cells.WriteOnlyCell(page), heading) for heading in table.header]
    for cell in head:
        cell.font = fonts.Font(bold=True)
    page.append(head)
    for piece in table.pieces():
        # the text needs no escaping, because the type of the cell excludes formulas
        columns = (
            [text or None for text in column.array.tolist()] if column.is_text else column.cells(slice(None))
            for column in decoded(piece.columns).values()
        )
        for row in zip(*columns, strict=True):
            page.append([None if value is None else _filled(cells.WriteOnlyCell(page), value) for value in row])


def _filled(cell: Any, value: Cell) -> Any:
    """Put a value into a cell: text without formulas, a number with all digits."""
    # the writer itself keeps only 16 digits
    cell.value = value if isinstance(value, str) else repr(float(value))  # type: ignore[arg-type]
    cell.data_type = "s" if isinstance(value, str) else "n"
    return cell


def _title(name: str, taken: list[str]) -> str:
    """Return a valid and unique name of a sheet."""
    text = (
        "".join(character for character in name if character.isprintable() and character not in r"[]:*?/\'").strip()
        or "table"
    )
    low = {character.lower() for character in taken}
    for k in range(1, len(taken) + 2):
        tail = "" if k == 1 else f" {k}"
        if (title := text[: _LONGEST_TITLE - len(tail)] + tail).lower() not in low:
            break
    return title
