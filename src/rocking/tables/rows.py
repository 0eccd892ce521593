"""Files with a row a line: CSV, Parquet, Excel; written piece by piece, so that they may be larger than the memory."""

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

MOST_ROWS_OF_EXCEL = 1_048_575  # rows of a sheet, its header apart
_LONGEST_CELL = 32_000
_LONGEST_TITLE = 31
_WIDEST = 60


def to_dataframe(table: Table) -> "pd.DataFrame":
    """Return a table as pandas has it."""
    pandas = extra("pandas", "a table")
    arrays = (each.array for each in decoded(table.columns).values())
    frame: pd.DataFrame = pandas.DataFrame(dict(zip(table.header, arrays, strict=True)))
    return frame


def to_csv(table: Table | Grid, path: Path, *, blank: bool = True, for_excel: bool = False) -> Path:
    """Write a table as comma-separated values, all digits kept; units stand in the header."""
    # for_excel: a mark before the first line tells Excel that it is UTF-8, and text is quoted: a semicolon separates
    # nothing then, whatever Excel takes for the separator
    with path.open("w", newline="", encoding="utf-8-sig" if for_excel else "utf-8") as file:
        writer = csv.writer(file, quoting=csv.QUOTE_NONNUMERIC if for_excel else csv.QUOTE_MINIMAL)
        writer.writerow(map(safe_cell, table.header))
        for piece in table.pieces():
            writer.writerows(piece.cells(blank=blank))
    return path


def to_parquet(table: Table | Grid, path: Path) -> None:
    """Write a table as Parquet, a group of rows a piece; units are in the metadata of the columns."""
    pa: Any = extra("pyarrow", "Parquet")
    parquet: Any = extra("pyarrow.parquet", "Parquet")
    text, coded = pa.string(), pa.dictionary(pa.int32(), pa.string())

    def arrow(column: Column) -> Any:
        if not column.is_text:
            return pa.array(column.array)
        words, index = pa.array(column.values.tolist(), text), column.index
        return words if index is None else pa.DictionaryArray.from_arrays(pa.array(index.astype(np.int32)), words)

    fields = []
    for name, each in table.columns.items():
        number = None if each.is_text else pa.from_numpy_dtype(each.values.dtype)
        kind = number or (text if each.index is None else coded)
        fields.append(pa.field(name, kind, metadata={"units": each.unit, "long_name": each.meaning}))
    provenance = {key: each if isinstance(each, str) else json.dumps(each) for key, each in table.provenance.items()}
    schema = pa.schema(fields, metadata=provenance)
    with parquet.ParquetWriter(path, schema) as writer:
        for piece in table.pieces():
            writer.write_table(pa.table([arrow(column) for column in piece.columns.values()], schema=schema))


def to_excel(
    sheets: Sequence[tuple[str, Table | Grid]], path: Path, provenance: Mapping[str, Any] | None = None, *,
    others: str = ".parquet or .csv", dressed: bool = False,
) -> None:  # fmt: skip
    """Write tables as a workbook, whose text is text and never a formula."""
    # it is packed in memory: an archive that a full disk cuts off cannot be closed, and complains when it is forgotten.
    # others: the formats that take more rows. dressed: headings are bold and stay in sight, columns are as wide as they
    # need, and numbers keep all digits (16 otherwise), which takes longer
    for _, table in sheets:
        if len(table) > MOST_ROWS_OF_EXCEL:
            kind = f" {table.row}" if isinstance(table, Grid) else ""
            raise InvalidValueError(
                "a sheet of Excel has {limit} rows, these are {count}{rows}", limit=MOST_ROWS_OF_EXCEL,
                count=len(table), rows=kind, hint=f"take {others}",
            )  # fmt: skip
    book: Any = extra("openpyxl", "Excel").Workbook(write_only=True)
    titles: list[str] = []
    for name, table in sheets:
        titles.append(_title(name, titles))
        page = book.create_sheet(titles[-1])
        if dressed:
            _fill(page, table)
            continue
        page.append([safe_cell(each) for each in table.header])
        for piece in table.pieces():
            for row in piece.cells():
                page.append(row)
    if provenance is not None:
        page = book.create_sheet("provenance")
        for name, value in provenance.items():
            page.append([name, safe_cell(str(value)[:_LONGEST_CELL])])
    whole = BytesIO()
    try:
        book.save(whole)
    except OSError:
        for page in book.worksheets:
            with suppress(Exception):
                page.close()
        raise
    path.write_bytes(whole.getbuffer())


def _fill(page: Any, table: Table | Grid) -> None:
    fonts, cells = import_module("openpyxl.styles"), import_module("openpyxl.cell")
    page.freeze_panes = "A2"
    letters = import_module("openpyxl.utils").get_column_letter
    for k, (heading, column) in enumerate(zip(table.header, decoded(table.columns).values(), strict=True), start=1):
        widest = max([len(heading), *map(len, column.array[:200].tolist() if column.is_text else ())])
        page.column_dimensions[letters(k)].width = min(_WIDEST, widest + 2)
    head = [_filled(cells.WriteOnlyCell(page), heading) for heading in table.header]
    for one in head:
        one.font = fonts.Font(bold=True)
    page.append(head)
    for piece in table.pieces():
        # text as it is: the kind of its cell says that it is no formula
        columns = (
            [text or None for text in each.array.tolist()] if each.is_text else each.cells(slice(None))
            for each in decoded(piece.columns).values()
        )
        for row in zip(*columns, strict=True):
            page.append([None if value is None else _filled(cells.WriteOnlyCell(page), value) for value in row])


def _filled(cell: Any, value: Cell) -> Any:
    """Put a value into a cell: text as text whatever it begins with, a number with all its digits."""
    # left to itself the writer keeps 16 digits
    cell.value = value if isinstance(value, str) else repr(float(value))  # type: ignore[arg-type]
    cell.data_type = "s" if isinstance(value, str) else "n"
    return cell


def _title(name: str, taken: list[str]) -> str:
    """Return a name that Excel allows and that no other sheet has."""
    words = "".join(each for each in name if each.isprintable() and each not in r"[]:*?/\'").strip() or "table"
    low = {each.lower() for each in taken}
    for k in range(1, len(taken) + 2):
        tail = "" if k == 1 else f" {k}"
        if (title := words[: _LONGEST_TITLE - len(tail)] + tail).lower() not in low:
            break
    return title
