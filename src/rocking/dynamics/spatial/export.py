"""A response in space as tables and files: xarray, CSV, netCDF, each with units and provenance."""

from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.export import extra, target_of

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

    from rocking.dynamics.spatial.response import SpatialResponse

_AXES = ("x", "y", "z")


def columns(response: "SpatialResponse") -> dict[str, tuple[str, str, FloatArray]]:
    """Return the samples of a response in space by name.

    Parameters
    ----------
    response : SpatialResponse
        The response.

    Returns
    -------
    dict of str to tuple
        Unit, words, and values, all of one length.
    """
    energy, states = response.energy, response.states
    made: dict[str, tuple[str, str, FloatArray]] = {"time": ("s", "time", response.time)}
    for k, name in enumerate(("s", *_AXES)):
        made[f"quaternion_{name}"] = (
            "1",
            f"attitude, component {name} of the unit quaternion",
            states.quaternion[:, k],
        )
    for k, name in enumerate(_AXES):
        made[f"angular_velocity_{name}"] = ("rad/s", f"angular velocity about {name}", states.angular_velocity[:, k])
    made["tilt"] = ("rad", "angle between the axis of the body and the vertical", response.tilt)
    made["azimuth"] = ("rad", "direction in which the body leans, from x towards y", response.azimuth)
    made["contact"] = ("1", "0 rest, 1 edge, 2 vertex, 3 rolling", response.contact.astype(np.float64))
    for k, name in enumerate(_AXES):
        made[f"centre_{name}"] = ("m", f"centre of mass, {name}", response.centre[:, k])
    ground = response.ground.at(response.time)
    for k, name in enumerate(_AXES):
        made[f"ground_acceleration_{name}"] = ("m/s2", f"acceleration of the ground, {name}", ground[:, k])
    made["kinetic_energy"] = ("J", "kinetic energy", energy.kinetic)
    made["potential_energy"] = ("J", "potential energy above rest", energy.potential)
    made["work_of_ground"] = ("J", "work done by the ground since the start", energy.work)
    made["energy_lost"] = ("J", "energy lost at impacts since the start", energy.lost)
    return made


def provenance(response: "SpatialResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values.

    Parameters
    ----------
    response : SpatialResponse
        The response.

    Returns
    -------
    dict
        Numbers, words and lists of numbers.
    """
    body = response.body
    return {
        "software": f"rocking {version('rocking')}",
        "engine": response.trajectory.engine,
        "outcome": response.outcome.name,
        "status": response.status.name,
        "summary": response.summary,
        "overturning_direction_rad": response.overturning_direction,
        "mass_kg": body.mass,
        "centre_m": body.centre.tolist(),
        "inertia_kg_m2": body.inertia.ravel().tolist(),
        "base_m": np.ravel(body.base).tolist(),
        "restitution": response.law.label,
        **{f"motion_{axis}": name for axis, name in zip(("x", "y", "vertical"), response.names, strict=True)},
        **{f"setting_{k}": v for k, v in vars(response.settings).items()},
    }


def to_xarray(response: "SpatialResponse") -> "xr.Dataset":
    """Return a response in space as a labelled dataset.

    Parameters
    ----------
    response : SpatialResponse
        The response.

    Returns
    -------
    xarray.Dataset
        Over `time` and `impact`, with units and long names.
    """
    xarray = extra("xarray", "a labelled dataset")
    data: dict[str, Any] = {
        name: ("time", values, {"units": unit, "long_name": words})
        for name, (unit, words, values) in columns(response).items()
        if name != "time"
    }
    units = {"time": "s", "energy_before": "J", "energy_after": "J", "impulse": "N s", "pull": "N s"}
    for name, unit in units.items():
        data[f"impact_{name}"] = ("impact", response.impacts[name], {"units": unit})
    for name in ("contact", "vertices"):
        data[f"impact_{name}"] = ("impact", response.impacts[name].astype(object))
    time = ("time", response.time, {"units": "s", "long_name": "time"})
    made: xr.Dataset = xarray.Dataset(data, coords={"time": time}, attrs=provenance(response))
    return made


def to_csv(response: "SpatialResponse", path: "str | Path") -> "Path":
    """Write the samples of a response in space as comma-separated values, all digits kept.

    Parameters
    ----------
    response : SpatialResponse
        The response.
    path : str or Path
        The file.

    Returns
    -------
    Path
        The file.
    """
    import csv

    target, values = target_of(path), columns(response)
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([f"{name} [{'-' if unit == '1' else unit}]" for name, (unit, _, _) in values.items()])
        writer.writerows(zip(*(map(repr, row.tolist()) for _, _, row in values.values()), strict=True))
    return target


def to_netcdf(response: "SpatialResponse", path: "str | Path") -> "Path":
    """Write a response in space as netCDF 4, which xarray and MATLAB open.

    Parameters
    ----------
    response : SpatialResponse
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
