"""Tables as an Excel workbook whose words are words and never formulas."""

import io
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from rocking.app.takeaway.plain_text import LONGEST_CELL, plain_line
from rocking.app.takeaway.sheets.sheet import Cell, Sheet
from rocking.errors import InvalidValueError, MissingExtraError, how_to_install

MOST_ROWS = 1_048_575
"""Rows of a sheet below its head."""

MOST_CELLS = 2_000_000
"""Cells of a workbook; more would take minutes to write and longer to open."""

_LONGEST_TITLE = 31
_WIDEST = 60


def excel_of(sheets: Sequence[Sheet]) -> bytes:
    """Return tables as a workbook, one sheet each."""
    longest = max(sheet.count for sheet in sheets)
    if longest > MOST_ROWS:
        raise InvalidValueError(f"a sheet of Excel holds {MOST_ROWS} rows, the table has {longest}: take csv or mat")
    cells = sum(sheet.count * len(sheet.columns) for sheet in sheets)
    if cells > MOST_CELLS:
        raise InvalidValueError(f"a workbook holds up to {MOST_CELLS} cells, this would have {cells}: take csv or mat")
    book = _openpyxl().Workbook(write_only=True)
    titles: list[str] = []
    for sheet in sheets:
        titles.append(_title(sheet.name, titles))
        _fill(book.create_sheet(titles[-1]), sheet)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def _fill(page: Any, sheet: Sheet) -> None:
    fonts, cells = import_module("openpyxl.styles"), import_module("openpyxl.cell")
    page.freeze_panes = "A2"
    letters = import_module("openpyxl.utils").get_column_letter
    for k, column in enumerate(sheet.columns, start=1):
        widest = max([len(column.head), *map(len, column.words[:200] if column.is_text else ())])
        page.column_dimensions[letters(k)].width = min(_WIDEST, widest + 2)
    head = [_told(cells.WriteOnlyCell(page), column.head) for column in sheet.columns]
    for one in head:
        one.font = fonts.Font(bold=True)
    page.append(head)
    for row in sheet.rows:
        page.append([None if value is None else _told(cells.WriteOnlyCell(page), value) for value in row])


def _told(cell: Any, value: Cell) -> Any:
    """Put a value into a cell: a word as a word whatever it begins with, a number with all its digits."""
    number = not isinstance(value, str)
    # left to itself the writer keeps 16 digits; control characters cannot be stored
    cell.value = repr(float(value)) if number else plain_line(str(value), LONGEST_CELL)  # type: ignore[arg-type]
    cell.data_type = "n" if number else "s"
    return cell


def _title(name: str, taken: Sequence[str]) -> str:
    """Return a name that Excel allows and that no other sheet has."""
    words = "".join(each for each in plain_line(name) if each not in r"[]:*?/\'").strip() or "table"
    low = {each.lower() for each in taken}
    for k in range(1, len(taken) + 2):
        tail = "" if k == 1 else f" {k}"
        if (made := words[: _LONGEST_TITLE - len(tail)] + tail).lower() not in low:
            return made
    return words  # not reached: one of len(taken) + 1 names is free


def _openpyxl() -> Any:
    try:
        return import_module("openpyxl")
    except ImportError as error:
        raise MissingExtraError(how_to_install("the spreadsheet", "openpyxl", error)) from error
