"""`rocking simulate` of a body in space: from the options to what is printed."""

from pathlib import Path
from typing import Any

from rocking import checks
from rocking.bodies.solid import Solid
from rocking.cli import spatial_page
from rocking.cli.files_output import check_files
from rocking.cli.simulate_asked import SimulateOptions
from rocking.cli.simulate_output import ResponseFiles
from rocking.cli.solid_options import refuse, solid_from
from rocking.cli.spatial_motion import components
from rocking.conventions import g
from rocking.dynamics.spatial import SpatialResponse, simulate_spatial
from rocking.errors import InvalidValueError, RockingError
from rocking.outcome import Outcome

DEFAULT = "housner-3d"
"""Restitution of a body in space if none is asked for: the plastic impact without slip."""

_PLANE = ("width", "height", "depth", "angle", "semi_diagonal", "free", "friction", "contact", "bounce", "linear")
_RECORD = ("format", "units", "time_step", "component", "vertical", "vertical_file")
_MESH = ("unit", "density", "up", "fill_holes", "base_tolerance")


def answer(asked: SimulateOptions, files: ResponseFiles, *, as_json: bool) -> None:
    """Print, write and draw how a body in space rocks."""
    refuse("a body in space has an engine of its own", asked.only_typed((*_PLANE, "engine", "animation")))
    check_files(files.picture, files.csv, files.mat, files.netcdf)
    values = asked.values
    names = values["component_y"], values["component_z"]
    moved = components((_along_x(values), values["motion_y"], values["motion_z"]), asked.some(_RECORD), names)
    file = solid_from(Path(values["body"]), **asked.some(_MESH))
    word = values["restitution"] if "restitution" in asked.typed else DEFAULT
    response = _computed(file.solid, moved, word, values["scale"], values["gravity"])
    written = files.written(response, lambda: _drawn(response))
    if as_json:
        print(spatial_page.as_json(response, file))
        return
    spatial_page.show(response, file, asked.units[0])
    for path in written:
        print(f"wrote {path}")


def _along_x(values: dict[str, Any]) -> str | None:
    record, motion = values["record"], values["motion"]
    if record is not None and motion is not None:
        raise InvalidValueError(f"one motion along x, please: got {record[:100]!r} and --motion {motion[:100]!r}")
    word: str | None = motion if record is None else record
    return word


def _computed(
    solid: Solid, moved: tuple[Any, Any, Any], restitution: str, scale: float, gravity: float | None
) -> SpatialResponse:
    pull = g if gravity is None else checks.positive("--gravity", gravity, "m/s2")
    response = simulate_spatial(solid, *moved, restitution=_law(restitution), scale=scale, gravity=pull)
    if response.outcome is Outcome.FAILED:
        raise RockingError(f"there is no response: {response.status.value}")
    return response


def _law(word: str) -> str | float:
    try:
        return float(word)
    except ValueError:
        return word if word.lower().endswith("-3d") else f"{word}-3d"


def _drawn(response: SpatialResponse) -> Any:
    from rocking.plots.spatial import spatial_picture

    return spatial_picture(response)
