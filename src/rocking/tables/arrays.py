"""Files of named arrays: netCDF, for xarray and MATLAB, and MATLAB files of version 5."""

import errno
import json
import os
import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.errors import InvalidValueError, extra
from rocking.messages import plain_texts
from rocking.quantities import QUANTITIES
from rocking.tables.table import Column, Grid, Table, text_array

if TYPE_CHECKING:
    import xarray as xr

MOST_BYTES_OF_MATLAB = 2**31 - 1  # Largest variable of a MATLAB file of version 5 [bytes]
_TEXT = 80  # overhead of a text in MATLAB files [bytes]
_MARGIN = 150_000  # attributes and overhead of HDF5 [bytes]


def to_dataset(table: Table) -> "xr.Dataset":
    """Return a dataset of a table and its related tables. A column with the name of the rows becomes a coordinate."""
    xarray = extra("xarray", "a labelled dataset")
    variables = {name: (table.row, column.values, column.attributes) for name, column in table.columns.items()}
    for row, other in table.related.items():
        variables |= {
            f"{row}_{name}": (row, column.values, column.attributes) for name, column in other.columns.items()
        }
    coordinates = {name: variables.pop(name) for name in (table.row,) if name in variables}
    attributes = {key: int(v) if isinstance(v, bool) else v for key, v in table.provenance.items()}
    dataset: xr.Dataset = xarray.Dataset(variables, coords=coordinates, attrs=attributes)
    return dataset


def to_netcdf(content: "xr.Dataset | Grid", path: Path) -> Path:
    """Write netCDF 4, for xarray and MATLAB."""
    extra("h5py", "netCDF")
    extra("h5netcdf", "netCDF")
    if isinstance(content, Grid):
        _grid_to_netcdf(content, path)
    else:
        content.to_netcdf(path, engine="h5netcdf")
    return path


def _grid_to_netcdf(grid: Grid, path: Path) -> None:
    size = len(grid) * sum(np.dtype(kind).itemsize for kind in grid.results.values())
    size += sum(_size(column.values) for column in grid.coordinates.values())
    with _netcdf_file(path, "w", size) as file:
        file.dimensions = dict(grid.dims)
        file.attrs.update(plain_texts(grid.provenance))
        for name, column in grid.coordinates.items():
            _variable(file, name, column.dims, column)
        also = " ".join(name for name in grid.coordinates if name not in grid.dims)
        for name, kind in grid.results.items():
            variable = file.create_variable(name, tuple(grid.dims), dtype=np.dtype(kind))
            variable.attrs.update(QUANTITIES[name].attributes)
            if also:
                variable.attrs["coordinates"] = also
        for name, position, values in grid.blocks():
            file.variables[name][position] = values


def add_to_netcdf(tables: Mapping[str, Table], path: Path, provenance: Mapping[str, Any]) -> None:
    """Write tables as variables of a new or existing netCDF file."""
    size = sum(_size(column.values) for table in tables.values() for column in table.columns.values())
    with _netcdf_file(path, "a", size) as file:
        file.attrs.update(plain_texts(provenance))
        for table in tables.values():
            file.dimensions[table.row] = len(table)
            for name, column in table.columns.items():
                _variable(file, column.variable or name, (table.row,), column)


def _variable(file: Any, name: str, dims: tuple[str, ...], column: Column) -> None:
    kind = extra("h5py", "netCDF").string_dtype() if column.is_text else column.values.dtype
    variable = file.create_variable(name, dims, dtype=kind)
    if column.values.size:
        variable[...] = column.values
    variable.attrs.update(column.attributes)


@contextmanager
def _netcdf_file(path: Path, mode: str, size: int) -> Iterator[Any]:
    """Open a netCDF file if the disk has enough free space. The file is always closed."""
    h5netcdf: Any = extra("h5netcdf", "netCDF")
    # check the disk first: on a full disk, HDF5 writes again at the end of the process and may crash
    if shutil.disk_usage(path.parent).free < size + _MARGIN:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    file = h5netcdf.File(path, mode)
    try:
        yield file
        file.close()
    except BaseException as error:
        with suppress(OSError):
            os.truncate(path, 0)  # free the space that closing the file needs
        with suppress(Exception):
            file.close()
        cause = re.search(r"errno = (\d+), error message = '([^']*)'", str(error))
        if cause is None:
            raise
        raise OSError(int(cause[1]), cause[2]) from error


def _size(values: np.ndarray) -> int:
    """Return the minimum size of values in a file [bytes]."""
    return int(values.nbytes if values.dtype.kind in "iufb" else 16 * values.size)


def _plain(structure: Any) -> Any:
    """Return a structure with plain texts instead of messages, and with cells of texts instead of padded characters."""
    if isinstance(structure, Mapping):
        return {name: _plain(value) for name, value in structure.items()}
    if isinstance(structure, np.ndarray) and structure.dtype.kind in "OU" and structure.ndim == 1:
        return text_array(structure.tolist())
    return str(structure) if isinstance(structure, str) else structure


def to_mat(
    content: Table | Grid | Mapping[str, Any], path: Path, name: str = "rocking", *, apart: bool = False
) -> Path:
    """Write a table, results over dimensions, or a structure as a MATLAB file of version 5."""
    # apart: write columns, full names and meanings of a table as separate structures
    from scipy.io import savemat

    match content:
        case Grid():
            structure: Any = _structure_of_grid(content)
        case Table():
            structure = _structure(content, apart=apart)
        case _:
            structure = content
    savemat(path, {name: _plain(structure)}, oned_as="column", appendmat=False, long_field_names=True)
    return path


def _structure(table: Table, *, apart: bool) -> dict[str, Any]:
    columns = table.columns.values()
    if sum(_TEXT * c.values.size if c.is_text else c.values.nbytes for c in columns) > MOST_BYTES_OF_MATLAB:
        raise InvalidValueError(
            "MATLAB files allow tables up to 2 GiB, this table has {count} rows", count=len(table),
            hint="use .nc, which MATLAB reads",
        )  # fmt: skip
    named = {column.variable or name: column for name, column in table.columns.items()}
    values = {name: column.values for name, column in named.items()}
    units = {name: column.unit for name, column in named.items()}
    if apart:
        meanings = {name: column.meaning for name, column in named.items()}
        names = dict(zip(named, table.columns, strict=True))
        provenance = table.provenance["provenance"]
        return {"columns": values, "names": names, "units": units, "words": meanings, "provenance": provenance}
    related = {row: other.columns for row, other in table.related.items()}

    # numbers become double; text becomes a column of cells
    def cells(column: Column) -> Any:
        return column.values.astype(object if column.is_text else np.float64)

    return {
        **values,
        **{f"{row}s": {name: cells(c) for name, c in other.items()} for row, other in related.items()},
        "units": units,
        **{f"{row}_units": {name: c.unit for name, c in other.items() if c.unit} for row, other in related.items()},
        "provenance": json.dumps(table.provenance),
    }


def _structure_of_grid(grid: Grid) -> dict[str, Any]:
    if 8 * len(grid) > MOST_BYTES_OF_MATLAB:
        raise InvalidValueError(
            "MATLAB files allow arrays up to 2 GiB, and this result has arrays of {size:.3g} GiB",
            size=8 * len(grid) / 2**30, hint="use .nc, which MATLAB reads",
        )  # fmt: skip
    results = {name: np.empty(grid.shape, kind) for name, kind in grid.results.items()}
    for name, position, values in grid.blocks():
        results[name][position] = values
    return {
        "dimensions": np.array(list(grid.dims), dtype=object),
        "coordinates": {name: column.values for name, column in grid.coordinates.items()},
        "results": results,
        "units": {name: QUANTITIES[name].unit for name in grid.results},
        "provenance": grid.provenance["provenance"],
    }
