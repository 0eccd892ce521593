"""Fragility as files: CSV, Excel, MATLAB and netCDF; OpenQuake's NRML is in a room of its own."""

import csv
import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from rocking.dynamics.export import extra
from rocking.errors import InvalidValueError
from rocking.studies.fragility.curves import FragilityModel
from rocking.studies.fragility.tables import TABLES, CellTable, table

Destination = str | os.PathLike[str]


def to_csv(model: FragilityModel, path: Destination, which: str | CellTable = "parameters") -> Path:
    """Write a table of a model as comma-separated values, all digits kept.

    Parameters
    ----------
    model : FragilityModel
        The curves.
    path : str or path
        The file.
    which : {"parameters", "points", "fema-p58"} or CellTable
        What to write.

    Returns
    -------
    Path
        The file. Words that a spreadsheet would take for a formula start with an apostrophe.
    """
    target = checked_path(path)
    cells = which if isinstance(which, CellTable) else table(model, which)
    with target.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(cells.safe())
    return target


def to_excel(model: FragilityModel, path: Destination) -> Path:
    """Write all tables of a model as a workbook, one sheet a table.

    Parameters
    ----------
    model : FragilityModel
        The curves.
    path : str or path
        The file.

    Returns
    -------
    Path
        The file. Words are stored as words, never as formulas.
    """
    openpyxl: Any = extra("openpyxl", "Excel")
    target = checked_path(path)
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name in TABLES:
        sheet = book.create_sheet(name)
        for row, cells in enumerate(table(model, name).safe(), 1):
            for column, value in enumerate(cells, 1):
                cell = sheet.cell(row=row, column=column, value=value)
                if isinstance(value, str):
                    cell.data_type = "s"
    sheet = book.create_sheet("provenance")
    for row, (name, value) in enumerate(model.about.items(), 1):
        sheet.cell(row=row, column=1, value=name)
        sheet.cell(row=row, column=2, value=str(value)).data_type = "s"
    book.save(target)
    return target


def to_mat(model: FragilityModel, path: Destination) -> Path:
    """Write a model as a MATLAB file (version 5): one structure ``fragility``.

    Parameters
    ----------
    model : FragilityModel
        The curves.
    path : str or path
        The file.

    Returns
    -------
    Path
        The file, with states, median, dispersion, levels, trials, exceeded, probability, words and provenance.
    """
    from scipy.io import savemat

    target = checked_path(path)
    structure = {
        "component": model.name,
        "measure": model.measure,
        "unit": model.unit,
        "source": model.source,
        "states": np.array([c.state for c in model.curves], dtype=object),
        "median": np.array([c.median for c in model.curves]),
        "dispersion": np.array([c.dispersion for c in model.curves]),
        "levels": model.levels,
        "trials": np.asarray(model.trials, dtype=np.float64),
        "counted_states": np.array(list(model.reached), dtype=object),
        "exceeded": np.array([np.asarray(v, dtype=np.float64) for v in model.reached.values()]),
        "probability": np.array([c.probability(model.levels) for c in model.curves]),
        "provenance": json.dumps(dict(model.about)),
    }
    savemat(target, {"fragility": structure}, oned_as="column", appendmat=False)
    return target


def to_netcdf(model: FragilityModel, path: Destination) -> Path:
    """Write a model as netCDF 4, which xarray and MATLAB open.

    Parameters
    ----------
    model : FragilityModel
        The curves.
    path : str or path
        The file.

    Returns
    -------
    Path
        The file.
    """
    extra("h5py", "netCDF")
    extra("h5netcdf", "netCDF")
    target = checked_path(path)
    model.dataset.to_netcdf(target, engine="h5netcdf")
    return target


def checked_path(path: Any) -> Path:
    """Return a path that a file can be written to.

    Parameters
    ----------
    path : str or path
        The file.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If it is no path, a folder, or in a folder that does not exist.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise InvalidValueError(f"path must be the path of a file, got {path!r:.60}")
    target = Path(path)
    if target.is_dir():
        raise InvalidValueError(f"path must be the path of a file, got the folder {target}")
    if not target.parent.is_dir():
        raise InvalidValueError(f"no folder {target.parent} to write {target.name} into")
    return target
