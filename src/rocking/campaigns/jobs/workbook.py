"""Workbooks of many rows that leave nothing behind where the disk is full."""

from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any

from rocking.errors import extra


def new_book() -> Any:
    """Return an empty workbook whose rows are not kept in memory."""
    openpyxl: Any = extra("openpyxl", "Excel")
    return openpyxl.Workbook(write_only=True)


def save_book(book: Any, path: Path) -> None:
    """Write a workbook.

    It is packed in memory: an archive that a full disk cuts off cannot be closed, and complains when it is forgotten.
    """
    whole = BytesIO()
    try:
        book.save(whole)
    except OSError:
        for sheet in book.worksheets:
            with suppress(Exception):
                sheet.close()
        raise
    path.write_bytes(whole.getbuffer())
