"""Fragility as files: CSV, Excel, MATLAB and netCDF; OpenQuake's NRML is in a room of its own."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from rocking.errors import InvalidValueError
from rocking.studies.fragility.curves import CLAIMS, FragilityModel
from rocking.studies.fragility.nesting import Crossing, check_crossing
from rocking.studies.fragility.tables import TABLES, table
from rocking.studies.fragility.variables import variables_of
from rocking.tables import Table, target_of
from rocking.tables import to_csv as table_to_csv
from rocking.tables import to_excel as tables_to_excel
from rocking.tables import to_mat as structure_to_mat
from rocking.tables import to_netcdf as dataset_to_netcdf

Destination = str | os.PathLike[str]


def to_csv(
    model: FragilityModel,
    path: Destination,
    which: str | Table = "parameters",
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
    which : {"parameters", "points", "fema-p58"} or Table
        What to write.
    crossing : {"refuse", "common-dispersion"}
        What to do with curves that cross, in the table of FEMA P-58.

    Returns
    -------
    Path
        The file. Words that a spreadsheet would take for a formula start with an apostrophe.
    """
    chosen = which if isinstance(which, Table) else table(model, which, crossing=crossing)
    return table_to_csv(chosen, target_of(path))


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
    target = target_of(path)
    tables_to_excel([(name, _sheet(model, name, crossing)) for name in TABLES], target, model.about)
    return target


def _sheet(model: FragilityModel, name: str, crossing: Crossing) -> Table:
    """Return a table; a refusal to draw up one does not cost the others."""
    check_crossing(crossing)
    try:
        return table(model, name, crossing=crossing)
    except InvalidValueError as error:
        return Table.of_rows(name, (str(error),), ())


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
    return structure_to_mat(structure, target_of(path), "fragility")


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
    return dataset_to_netcdf(model.dataset, target_of(path))
