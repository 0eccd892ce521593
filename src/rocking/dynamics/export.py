"""A response as tables and files: xarray, pandas, CSV, MATLAB, netCDF, each with units and provenance."""

import os
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError, MissingExtraError

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd
    import xarray as xr

    from rocking.dynamics.response import Motion, Response

_COLUMNS = (
    ("time", "s", "time"),
    ("rotation", "rad", "rotation theta, positive clockwise"),
    ("angular_velocity", "rad/s", "angular velocity"),
    ("ground_acceleration", "m/s2", "horizontal acceleration of the ground"),
    ("vertical_ground_acceleration", "m/s2", "vertical acceleration of the ground, upwards"),
    ("kinetic_energy", "J", "kinetic energy"),
    ("potential_energy", "J", "potential energy above rest"),
    ("work_of_ground", "J", "work done by the ground since the start"),
    ("energy_lost", "J", "energy lost at impacts since the start"),
    ("horizontal_force", "N", "force of the ground on the body, to the right"),
    ("vertical_force", "N", "force of the ground on the body, upwards"),
)
_UNITS = {name: unit for name, unit, _ in _COLUMNS}
_EXTRAS = {"openpyxl": "excel", "pyarrow": "parquet", "distributed": "dask"}


def extra(module: str, what: str) -> ModuleType:
    """Return an optional dependency.

    Parameters
    ----------
    module : str
        What to import.
    what : str
        What it is needed for.

    Returns
    -------
    module
        The module.

    Raises
    ------
    MissingExtraError
        If it is not installed.
    """
    try:
        return import_module(module)
    except ImportError as error:
        name = _EXTRAS.get(module.partition(".")[0], "data")
        raise MissingExtraError(f"{what} needs {module}: pip install rocking[{name}]") from error


def columns(response: "Response") -> dict[str, FloatArray]:
    """Return the samples of a response by name.

    Parameters
    ----------
    response : Response
        The response.

    Returns
    -------
    dict of str to ndarray
        All of one length; `vertical_ground_acceleration` only if the motion has a vertical part.
    """
    energy, contact = response.energy, response.contact
    values = (
        response.time, response.rotation, response.angular_velocity, response.ground_acceleration,
        response.vertical_ground_acceleration, energy.kinetic, energy.potential, energy.work, energy.lost,
        contact.horizontal, contact.vertical,
    )  # fmt: skip
    count = response.time.size  # energy and forces may have one row more, for a fall after the last sample
    pairs = zip(_COLUMNS, values, strict=True)
    return {name: value[:count] for (name, _, _), value in pairs if value is not None}


def provenance(response: "Response") -> dict[str, Any]:
    """Return what was computed from what, as plain values.

    Parameters
    ----------
    response : Response
        The response.

    Returns
    -------
    dict
        Numbers, words and lists of words.
    """
    from rocking import __version__

    motion, rocker = response.motion, response.rocker
    sides = {
        f"{name}_{foot}": getattr(getattr(rocker, foot), name)
        for foot in ("left", "right")
        for name in ("slenderness_angle", "frequency_parameter", "semi_diagonal", "coefficient")
    }
    return {
        "software": f"rocking {__version__}",
        "engine": response.engine,
        "outcome": response.outcome.name,
        "status": response.status.name,
        "summary": response.summary,
        "body": type(response.body).__name__,
        "mass_kg": response.body.mass,
        "restitution": rocker.label,
        **sides,
        "motion": "none: free rocking" if motion is None else motion.name,
        "motion_provenance": _told(motion),
        "scale": response.scale,
        "random_key": response.key,
        **{f"setting_{k}": v for k, v in vars(response.settings).items()},
    }


def to_xarray(response: "Response") -> "xr.Dataset":
    """Return a response as a labelled dataset.

    Parameters
    ----------
    response : Response
        The response.

    Returns
    -------
    xarray.Dataset
        Over `time` and `impact`, with units and long names.
    """
    xarray = extra("xarray", "a labelled dataset")
    values = columns(response)
    about = {name: {"units": unit, "long_name": words} for name, unit, words in _COLUMNS}
    data: dict[str, Any] = {name: ("time", value, about[name]) for name, value in values.items() if name != "time"}
    units = {"time": "s", "velocity_before": "rad/s", "velocity_after": "rad/s", "coefficient": "1"}
    for name, unit in units.items():
        data[f"impact_{name}"] = ("impact", response.impacts[name], {"units": unit})
    onto = np.where(response.impacts["onto"] == "right", 1, -1).astype(np.int8)
    data["impact_onto"] = ("impact", onto, {"units": "1", "long_name": "foot landed on: 1 right, -1 left"})
    attributes = {k: int(v) if isinstance(v, bool) else v for k, v in provenance(response).items()}
    made: xr.Dataset = xarray.Dataset(data, coords={"time": ("time", values["time"], about["time"])}, attrs=attributes)
    return made


def to_dataframe(response: "Response") -> "pd.DataFrame":
    """Return the samples of a response as a table.

    Parameters
    ----------
    response : Response
        The response.

    Returns
    -------
    pandas.DataFrame
        Columns such as ``rotation [rad]``.
    """
    pandas = extra("pandas", "a table")
    values = columns(response)
    frame: pd.DataFrame = pandas.DataFrame({f"{name} [{_UNITS[name]}]": value for name, value in values.items()})
    return frame


def to_csv(response: "Response", path: "str | Path") -> "Path":
    """Write the samples of a response as comma-separated values, all digits kept.

    Parameters
    ----------
    response : Response
        The response.
    path : str or Path
        The file.

    Returns
    -------
    Path
        The file.
    """
    import csv

    target = target_of(path)
    values = columns(response)
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([f"{name} [{_UNITS[name]}]" for name in values])
        writer.writerows(zip(*(map(repr, value.tolist()) for value in values.values()), strict=True))
    return target


def to_mat(response: "Response", path: "str | Path") -> "Path":
    """Write a response as a MATLAB file (version 5): one structure ``rocking`` with the samples, impacts, units.

    Parameters
    ----------
    response : Response
        The response.
    path : str or Path
        The file.

    Returns
    -------
    Path
        The file.
    """
    import json

    from scipy.io import savemat

    target = target_of(path)
    impacts = {
        name: response.impacts[name].astype(np.float64)
        for name in ("time", "velocity_before", "velocity_after", "coefficient")
    }
    impacts["onto"] = np.where(response.impacts["onto"] == "right", 1.0, -1.0)
    samples = columns(response)
    structure = {
        **samples,
        "impacts": impacts,
        "units": {name: _UNITS[name] for name in samples},
        "provenance": json.dumps(provenance(response)),
    }
    savemat(target, {"rocking": structure}, oned_as="column", appendmat=False)
    return target


def to_netcdf(response: "Response", path: "str | Path") -> "Path":
    """Write a response as netCDF 4, which xarray and MATLAB open.

    Parameters
    ----------
    response : Response
        The response.
    path : str or Path
        The file.

    Returns
    -------
    Path
        The file.
    """
    extra("h5py", "netCDF")
    extra("h5netcdf", "netCDF")
    target = target_of(path)
    to_xarray(response).to_netcdf(target, engine="h5netcdf")
    return target


def _told(motion: "Motion | None") -> str:
    if motion is None:
        return "ground at rest"
    return "; ".join(getattr(motion, "provenance", ())) or repr(motion)


def target_of(path: "str | Path") -> "Path":
    """Return the path of a file that can be written.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Path
        The same.

    Raises
    ------
    InvalidValueError
        If it is no path, a folder, or in a folder that is not there.
    """
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
