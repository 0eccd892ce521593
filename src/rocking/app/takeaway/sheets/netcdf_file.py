"""A table as netCDF."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rocking.app.takeaway.plain_text import LONGEST_CELL, plain_line
from rocking.app.takeaway.sheets.sheet import Column, Sheet
from rocking.errors import extra


def netcdf_of(sheet: Sheet) -> bytes:
    """Return a table as netCDF 4: one variable a column over ``row``, with units."""
    xarray = extra("xarray", "netCDF")
    for module in ("h5py", "h5netcdf"):
        extra(module, "netCDF")
    data = {column.name: ("row", _values(column), {"units": column.unit or "1"}) for column in sheet.columns}
    about = {key: plain_line(value, LONGEST_CELL) for key, value in sheet.about.items()}
    with TemporaryDirectory(prefix="rocking-table-") as folder:
        path = Path(folder) / "table.nc"
        xarray.Dataset(data, attrs=about).to_netcdf(path, engine="h5netcdf")
        return path.read_bytes()


def _values(column: Column) -> np.ndarray:
    if not column.is_text:
        return column.numbers
    return np.array([plain_line(words, LONGEST_CELL) for words in column.words], dtype=object)
