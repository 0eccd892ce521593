"""A table as comma-separated values that Excel opens as they are, and that start nothing."""

import csv
import io

from rocking.app.takeaway.plain_text import cell_text
from rocking.app.takeaway.sheets.sheet import Cell, Sheet

MARK = "\ufeff"
"""Byte-order mark: without it Excel takes UTF-8 for the alphabet of the country."""


def csv_of(sheet: Sheet) -> bytes:
    """Return a table as CSV after RFC 4180, in UTF-8, units in the first line, every digit kept."""
    stream = io.StringIO(newline="")
    # words are quoted also where they need not: a semicolon parts nothing then, whatever Excel takes for the separator
    writer = csv.writer(stream, quoting=csv.QUOTE_NONNUMERIC)
    writer.writerow([cell_text(column.head) for column in sheet.columns])
    for row in sheet.rows:
        writer.writerow([_plain(value) for value in row])
    return (MARK + stream.getvalue()).encode("utf-8")


def _plain(value: Cell) -> Cell:
    if value is None:
        return ""
    if isinstance(value, bool):
        return int(value)
    return cell_text(value) if isinstance(value, str) else value
