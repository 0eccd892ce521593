"""Fragility as files: CSV, Excel, MATLAB and netCDF; OpenQuake's NRML is in a room of its own."""

import csv
import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from rocking.errors import InvalidValueError, extra
from rocking.studies.fragility.curves import CLAIMS, FragilityModel
from rocking.studies.fragility.nesting import Crossing, check_crossing
from rocking.studies.fragility.tables import TABLES, Cell, CellTable, safe_cell, table
from rocking.studies.fragility.variables import variables_of

Destination = str | os.PathLike[str]


def to_csv(
    model: FragilityModel,
    path: Destination,
    which: str | CellTable = "parameters",
    *,
    crossing: Crossing = "refuse",
) -> Path:
    """Write a table of a model as comma-separated values, all digits kept.

    Parameters
    ----------
    model : FragilityModel
        The curves.
    path : str or path
        The file.
    which : {"parameters", "points", "fema-p58"} or CellTable
        What to write.
    crossing : {"refuse", "common-dispersion"}
        What to do with curves that cross, in the table of FEMA P-58.

    Returns
    -------
    Path
        The file. Words that a spreadsheet would take for a formula start with an apostrophe.
    """
    target = checked_path(path)
    cells = which if isinstance(which, CellTable) else table(model, which, crossing=crossing)
    with target.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(cells.safe())
    return target


def to_excel(model: FragilityModel, path: Destination, *, crossing: Crossing = "refuse") -> Path:
    """Write all tables of a model as a workbook, one sheet a table.

    Parameters
    ----------
    model : FragilityModel
        The curves.
    path : str or path
        The file.
    crossing : {"refuse", "common-dispersion"}
        What to do with curves that cross: the sheet of FEMA P-58 says why they are refused there, or all states get
        one dispersion in it.

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
        for row, cells in enumerate(_sheet(model, name, crossing), 1):
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


def _sheet(model: FragilityModel, name: str, crossing: Crossing) -> list[list[Cell]]:
    """Return the cells of a sheet; a refusal to draw up one table does not cost the others."""
    check_crossing(crossing)
    try:
        return table(model, name, crossing=crossing).safe()
    except InvalidValueError as error:
        return [[safe_cell(str(error))]]


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
        The file, with states, median, dispersion, their intervals (NaN where open), goodness of fit (NaN where there
        is none), bootstrap where it was asked for, levels, trials, exceeded, probability, words and provenance.
    """
    from scipy.io import savemat

    target = checked_path(path)
    structure = {
        "component": model.name,
        "measure": model.measure,
        "unit": model.unit,
        "source": model.source,
        "states": np.array([c.state for c in model.curves], dtype=object),
        **{word: np.array([getattr(c, word) for c in model.curves], dtype=object) for word in CLAIMS},
        "median": np.array([c.median for c in model.curves]),
        "dispersion": np.array([c.dispersion for c in model.curves]),
        **_evidence(model),
        "levels": model.levels,
        "trials": np.asarray(model.trials, dtype=np.float64),
        "counted_states": np.array(list(model.reached), dtype=object),
        "exceeded": np.array([np.asarray(v, dtype=np.float64) for v in model.reached.values()]),
        "probability": np.array([c.probability(model.levels) for c in model.curves]),
        "provenance": json.dumps(dict(model.about)),
    }
    savemat(target, {"fragility": structure}, oned_as="column", appendmat=False)
    return target


def _evidence(model: FragilityModel) -> dict[str, Any]:
    """Return intervals, goodness of fit and bootstrap, one row a state, and why states have no curve."""
    found = {
        name: np.asarray(values)
        for name, (_, values, *_) in variables_of(model.curves, model.levels.size, model.unit).items()
    }
    words = {name: values.astype(object) for name, values in found.items() if values.dtype.kind == "U"}
    without = {"state": list(model.without), "why": list(model.without.values())}
    return found | words | {"without_curve": {name: np.array(v, dtype=object) for name, v in without.items()}}


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
    """Return a path that a file can be written to."""
    if not isinstance(path, (str, os.PathLike)):
        raise InvalidValueError(f"path must be the path of a file, got {path!r:.60}")
    target = Path(path)
    if target.is_dir():
        raise InvalidValueError(f"path must be the path of a file, got the folder {target}")
    if not target.parent.is_dir():
        raise InvalidValueError(f"no folder {target.parent} to write {target.name} into")
    return target
