"""A planar response as tables and files, with units and provenance."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.export import extra, target_of
from rocking.dynamics.planar.mode import Regime

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd
    import xarray as xr

    from rocking.dynamics.planar.response import PlanarResponse

COLUMNS = (
    ("time", "s", "time"),
    ("displacement", "m", "displacement of the centre of mass to the right, relative to the ground"),
    ("rise", "m", "height of the centre of mass above its place at rest"),
    ("rotation", "rad", "rotation theta, positive clockwise"),
    ("horizontal_velocity", "m/s", "velocity of the centre of mass to the right, relative to the ground"),
    ("vertical_velocity", "m/s", "velocity of the centre of mass upwards, relative to the ground"),
    ("angular_velocity", "rad/s", "angular velocity"),
    ("regime", "1", "; ".join(f"{r.code} {r.value}" for r in Regime)),
    ("sliding_distance", "m", "path of the feet along the ground since the start"),
    ("horizontal_force", "N", "force of the ground on the body, to the right"),
    ("vertical_force_left", "N", "force of the ground on the left foot, upwards"),
    ("vertical_force_right", "N", "force of the ground on the right foot, upwards"),
    ("kinetic_energy", "J", "kinetic energy relative to the ground"),
    ("potential_energy", "J", "potential energy above rest"),
    ("work_of_ground", "J", "work done by the ground since the start"),
    ("lost_in_impacts", "J", "energy lost in impacts since the start"),
    ("lost_in_friction", "J", "energy lost in friction since the start"),
)
"""Name, unit and meaning of every column."""

_IMPACT_UNITS = {
    "time": "s", "velocity_before": "rad/s", "velocity_after": "rad/s", "normal_left": "N s", "normal_right": "N s",
    "tangential_left": "N s", "tangential_right": "N s", "lost": "J",
}  # fmt: skip


def columns(response: "PlanarResponse") -> dict[str, FloatArray]:
    """Return the samples of a response by name.

    Parameters
    ----------
    response : PlanarResponse
        The response.

    Returns
    -------
    dict of str to ndarray
        All of one length, in the order of `COLUMNS`.
    """
    energy, forces = response.energy, response.forces
    values = (
        response.time, response.displacement, response.rise, response.rotation, response.horizontal_velocity,
        response.vertical_velocity, response.angular_velocity, response.sampled("regime"), response.sampled("slid"),
        forces.horizontal, forces.left, forces.right, energy.kinetic, energy.potential, energy.work,
        energy.lost_in_impacts, energy.lost_in_friction,
    )  # fmt: skip
    return {name: value for (name, _, _), value in zip(COLUMNS, values, strict=True)}


def provenance(response: "PlanarResponse") -> dict[str, Any]:
    """Return what was computed from what, as plain values.

    Parameters
    ----------
    response : PlanarResponse
        The response.

    Returns
    -------
    dict
        Numbers and words.
    """
    from importlib.metadata import version

    motion, law, footing = response.motion, response.law, response.footing
    imposed = (
        "none: complementarity" if law.restitution is None else "left {:.9g}, right {:.9g}".format(*law.restitution)
    )
    return {
        "software": f"rocking {version('rocking')}",
        "engine": "planar: Taylor series with events and complementarity",
        "outcome": response.outcome.name,
        "status": response.status.name,
        "summary": response.summary,
        "body": type(response.body).__name__,
        "mass_kg": footing.mass,
        "inertia_kg_m2": footing.mass * footing.inertia,
        "centre_height_m": footing.height,
        "half_width_left_m": footing.left,
        "half_width_right_m": footing.right,
        "friction": law.friction,
        "bounce": law.bounce,
        "imposed_restitution": imposed,
        "motion": "none: ground at rest" if motion is None else motion.name,
        "scale": response.scale,
        **{f"setting_{k}": v for k, v in vars(response.settings).items()},
    }


def to_xarray(response: "PlanarResponse") -> "xr.Dataset":
    """Return a response as a labelled dataset.

    Parameters
    ----------
    response : PlanarResponse
        The response.

    Returns
    -------
    xarray.Dataset
        Over `time`, `impact` and `interval`, with units and long names.
    """
    xarray = extra("xarray", "a labelled dataset")
    about = {name: {"units": unit, "long_name": words} for name, unit, words in COLUMNS}
    values = columns(response)
    data: dict[str, Any] = {name: ("time", value, about[name]) for name, value in values.items() if name != "time"}
    impacts, regimes = response.impacts, response.regimes
    for name, unit in _IMPACT_UNITS.items():
        data[f"impact_{name}"] = ("impact", impacts[name], {"units": unit})
    data["impact_feet"] = ("impact", impacts["feet"], {"long_name": "feet that touch the ground"})
    for name, unit in (("start", "s"), ("end", "s"), ("distance", "m")):
        data[f"interval_{name}"] = ("interval", regimes[name], {"units": unit})
    data["interval_regime"] = ("interval", regimes["regime"], {"long_name": "regime"})
    data["interval_feet"] = ("interval", regimes["feet"], {"long_name": "feet that carry"})
    made: xr.Dataset = xarray.Dataset(
        data, coords={"time": ("time", values["time"], about["time"])}, attrs=provenance(response)
    )
    return made


def to_dataframe(response: "PlanarResponse") -> "pd.DataFrame":
    """Return the samples of a response as a table.

    Parameters
    ----------
    response : PlanarResponse
        The response.

    Returns
    -------
    pandas.DataFrame
        Columns such as ``rotation [rad]``.
    """
    pandas = extra("pandas", "a table")
    made: pd.DataFrame = pandas.DataFrame(_named(response))
    return made


def to_csv(response: "PlanarResponse", path: "str | Path") -> "Path":
    """Write the samples of a response as comma-separated values, all digits kept.

    Parameters
    ----------
    response : PlanarResponse
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
    named = _named(response)
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(named)
        writer.writerows(zip(*(map(repr, np.asarray(v).tolist()) for v in named.values()), strict=True))
    return target


def _named(response: "PlanarResponse") -> dict[str, FloatArray]:
    units = {name: unit for name, unit, _ in COLUMNS}
    return {f"{name} [{units[name]}]": value for name, value in columns(response).items()}
