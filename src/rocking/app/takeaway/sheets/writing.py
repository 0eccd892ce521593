"""Tables in the format that was asked for."""

from collections.abc import Sequence

from rocking.app.errors import NotFound
from rocking.app.takeaway.sheets.csv_file import csv_of
from rocking.app.takeaway.sheets.excel_file import excel_of
from rocking.app.takeaway.sheets.matlab_file import matlab_of
from rocking.app.takeaway.sheets.netcdf_file import netcdf_of
from rocking.app.takeaway.sheets.sheet import Sheet

MEDIA_TYPES = {
    "csv": "text/csv; charset=utf-8",
    "xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    "mat": "application/x-matlab-data",
    "nc": "application/x-netcdf",
}
"""What a browser is told about a table."""


def written(sheets: Sequence[Sheet], kind: str) -> bytes:
    """Return tables as a file."""
    if kind == "csv":
        return csv_of(sheets[0])
    if kind == "nc":
        return netcdf_of(sheets[0])
    if kind == "xlsx":
        return excel_of(sheets)
    if kind == "mat":
        return matlab_of(sheets)
    raise NotFound(f"tables are {', '.join(MEDIA_TYPES)}, not {kind!r:.20}")
