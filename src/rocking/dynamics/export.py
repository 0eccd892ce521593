"""A response as tables and files: xarray, pandas, CSV, MATLAB, netCDF; one writer each, for every kind of response."""

import os
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.dynamics.exported import Column, Exported
from rocking.dynamics.samples import columns, provenance
from rocking.errors import InvalidValueError, MissingExtraError, how_to_install

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd
    import xarray as xr

__all__ = [
    "columns",
    "extra",
    "provenance",
    "software",
    "target_of",
    "to_csv",
    "to_dataframe",
    "to_mat",
    "to_netcdf",
    "to_xarray",
]


def extra(module: str, what: str) -> ModuleType:
    """Return an optional dependency."""
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingExtraError(how_to_install(what, module, error)) from error


def software() -> str:
    """Return name and version of this package."""
    from rocking import __version__

    return f"rocking {__version__}"


def to_xarray(content: Exported) -> "xr.Dataset":
    """Return a response as a labelled dataset.

    Returns samples over `time`, the rows of tables over `impact` and the like, with units and long names.
    """
    xarray = extra("xarray", "a labelled dataset")
    data: dict[str, Any] = {
        name: ("time", one.values, one.attributes) for name, one in content.samples.items() if name != "time"
    }
    for row, table in content.tables.items():
        data |= {f"{row}_{name}": (row, one.values, one.attributes) for name, one in table.items()}
    time = content.samples["time"]
    attributes = {k: int(v) if isinstance(v, bool) else v for k, v in content.provenance.items()}
    made: xr.Dataset = xarray.Dataset(data, coords={"time": ("time", time.values, time.attributes)}, attrs=attributes)
    return made


def to_dataframe(content: Exported) -> "pd.DataFrame":
    """Return the samples of a response as a table.

    Returns columns such as ``rotation [rad]``.
    """
    pandas = extra("pandas", "a table")
    frame: pd.DataFrame = pandas.DataFrame(content.headed)
    return frame


def to_csv(content: Exported, path: "str | Path") -> "Path":
    """Write the samples of a response as comma-separated values, all digits kept."""
    import csv

    target, values = target_of(path), content.headed
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(values)
        writer.writerows(zip(*(map(repr, value.tolist()) for value in values.values()), strict=True))
    return target


def to_mat(content: Exported, path: "str | Path") -> "Path":
    """Write a response as a MATLAB file (version 5): one structure ``rocking`` with samples, tables, units."""
    import json

    from scipy.io import savemat

    target = target_of(path)
    structure = {
        **{name: one.values for name, one in content.samples.items()},
        **{f"{row}s": {name: _for_matlab(one) for name, one in table.items()} for row, table in content.tables.items()},
        "units": {name: one.unit for name, one in content.samples.items()},
        **{
            f"{row}_units": {name: one.unit for name, one in table.items() if one.unit}
            for row, table in content.tables.items()
        },
        "provenance": json.dumps(content.provenance),
    }
    savemat(target, {"rocking": structure}, oned_as="column", appendmat=False)
    return target


def to_netcdf(content: Exported, path: "str | Path") -> "Path":
    """Write a response as netCDF 4, which xarray and MATLAB open."""
    return dataset_to_netcdf(to_xarray(content), path)


def dataset_to_netcdf(dataset: "xr.Dataset", path: "str | Path") -> "Path":
    """Write a labelled dataset as netCDF 4, which xarray and MATLAB open."""
    extra("h5py", "netCDF")
    extra("h5netcdf", "netCDF")
    target = target_of(path)
    dataset.to_netcdf(target, engine="h5netcdf")
    return target


def target_of(path: "str | Path") -> "Path":
    """Return the path of a file that can be written."""
    from pathlib import Path

    given: object = path
    if not isinstance(given, (str, os.PathLike)):
        raise InvalidValueError(f"path must be the path of a file, got {path!r:.60}")
    target = Path(path)
    if target.is_dir():
        raise InvalidValueError(f"path must be the path of a file, got the folder {target}")
    if not target.parent.is_dir():
        raise InvalidValueError(f"no folder {target.parent} to write {target.name} into")
    return target


def _for_matlab(one: Column) -> np.ndarray:
    """Numbers as MATLAB's own double; words as a column of cells."""
    if one.values.dtype.kind in "US":
        return one.values.astype(object)
    return one.values.astype(np.float64)
