"""What `rocking simulate` computes, prints and writes, of every mechanics."""

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.bodies.solid import Solid
from rocking.cli import contact_page, simulate_page, simulate_question, spatial_page
from rocking.cli.inputs import motion_from, refuse, solid_from
from rocking.cli.output import check_files
from rocking.cli.simulate_question import ResponseComparison, SimulateOptions
from rocking.conventions import g
from rocking.dynamics import simulate
from rocking.dynamics.contact import ContactResponse
from rocking.dynamics.exportable import Exportable
from rocking.dynamics.response import Motion, Response
from rocking.dynamics.space import SpatialResponse
from rocking.errors import InvalidValueError, MissingExtraError, RockingError
from rocking.motions.motion import GroundMotion
from rocking.outcome import Outcome
from rocking.reports.response_facts import other_facts, response_facts

_PLANE = ("width", "height", "depth", "angle", "semi_diagonal", "free", "friction", "contact", "bounce", "linear")
_RECORD = ("format", "units", "time_step", "component", "vertical", "vertical_file")
_MESH = ("unit", "density", "up", "fill_holes", "base_tolerance")
_OF_FILES = ("format", "units", "time_step")


@dataclass(frozen=True, slots=True)
class ResponseFiles:
    """Files to write."""

    picture: Path | None  # picture, animation, csv, mat, netcdf: where each goes, if it was asked for
    animation: Path | None
    csv: Path | None
    mat: Path | None
    netcdf: Path | None

    def __post_init__(self) -> None:
        """Refuse before anything is computed."""
        if self.animation is not None and self.animation.suffix.lower() not in {".html", ".gif"}:
            raise RockingError(f"an animation is .html or .gif, got {self.animation.name!r}")

    def write(self, answer: ResponseComparison) -> list[Path]:
        """Write what was asked for."""
        written = self.written(answer.response, lambda: _drawn(answer))
        if self.animation is not None:
            _animate(answer.response, self.animation)
        return written

    def written(self, response: Exportable, drawn: Callable[[], Any]) -> list[Path]:
        """Write the picture and the samples of any kind of response.

        Returns the files, the animation among them, which only the pure rocking response has.
        """
        if self.picture is not None:
            from rocking.plots.style import write

            write(drawn(), self.picture)
        exports = (self.csv, response.to_csv), (self.mat, response.to_mat), (self.netcdf, response.to_netcdf)
        for path, export in exports:
            if path is not None:
                _export(export, path)
        return [path for path in (self.picture, self.animation, self.csv, self.mat, self.netcdf) if path is not None]


def _drawn(answer: ResponseComparison) -> Any:
    from rocking.plots.response import response_picture

    return response_picture(answer.response, answer.friction)


def _export(export: Callable[[Path], object], path: Path) -> None:
    try:
        export(path)
    except MissingExtraError:
        raise
    except ImportError as error:
        # some libraries only notice when they write that one of theirs is not there
        raise MissingExtraError(f"cannot write {path}: {error}") from error


def _animate(response: Response, path: Path) -> None:
    from rocking.plots.animation import animate_gif, animate_html, slowest_speed

    if path.suffix.lower() == ".html":
        animate_html(response, path)
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("frames")
        animate_gif(
            response,
            path,
            speed=slowest_speed(response),
            progress=lambda done, total: progress.update(task, completed=done, total=total),
        )


def as_text(answer: ResponseComparison) -> str:
    """Return everything as JSON.

    Returns one object; SI units, null where something does not exist.
    """
    facts = response_facts(answer.response, answer.friction)
    facts["other_models"] = {name: other_facts(found) for name, found in answer.others.items()}
    return json.dumps(facts, indent=2, allow_nan=False)


def answer_of_contact(asked: SimulateOptions, files: ResponseFiles, *, as_json: bool) -> None:
    """Print, write and draw what a plane body does that may slide and hop."""
    if asked.document is not None:
        raise InvalidValueError(f"{asked.document} has a table [response] and says everything itself: no --contact")
    refuse("--contact has one engine, with the full equations", asked.only_typed(("linear", "engine", "animation")))
    check_files(files.picture, files.csv, files.mat, files.netcdf)
    bounce = asked.values["bounce"]
    response = contact_page.contact_response(
        asked.question(), asked.values["restitution"], 0.0 if bounce is None else bounce
    )
    written = files.written(response, lambda: _drawn_contact(response))
    if as_json:
        print(contact_page.as_json(response))
        return
    contact_page.show(response, asked.units[0])
    for path in written:
        print(f"wrote {path}")


def _drawn_contact(response: ContactResponse) -> Any:
    from rocking.plots.regimes import regimes_picture

    return regimes_picture(response)


def answer_of_pure_rocking(asked: SimulateOptions, files: ResponseFiles, *, as_json: bool) -> None:
    """Print, write and draw how a plane body rocks without sliding."""
    if asked.document is not None:
        found = simulate_question.answer_of(asked.document)
    else:
        refuse("pure rocking does not leave the ground: with --contact it may", asked.only_typed(("bounce",)))
        found = ResponseComparison.of(asked.question(), asked.values["restitution"])
    written = files.write(found)
    if as_json:
        print(as_text(found))
        return
    simulate_page.show(found, *asked.units)
    for path in written:
        print(f"wrote {path}")


def answer_of_solid(asked: SimulateOptions, files: ResponseFiles, *, as_json: bool) -> None:
    """Print, write and draw how a body in space rocks."""
    refuse("a body in space has an engine of its own", asked.only_typed((*_PLANE, "engine", "animation")))
    check_files(files.picture, files.csv, files.mat, files.netcdf)
    values = asked.values
    names = values["component_y"], values["component_z"]
    moved = components((_along_x(values), values["motion_y"], values["motion_z"]), asked.some(_RECORD), names)
    solid = solid_from(Path(values["body"]), **asked.some(_MESH))
    response = _computed_solid(solid, moved, values["restitution"], values["scale"], values["gravity"])
    written = files.written(response, lambda: _drawn_solid(response))
    if as_json:
        print(spatial_page.as_json(response, solid))
        return
    spatial_page.show(response, solid, asked.units[0])
    for path in written:
        print(f"wrote {path}")


def _along_x(values: dict[str, Any]) -> str | None:
    record, motion = values["record"], values["motion"]
    if record is not None and motion is not None:
        raise InvalidValueError(f"one motion along x, please: got {record[:100]!r} and --motion {motion[:100]!r}")
    word: str | None = motion if record is None else record
    return word


def _computed_solid(
    solid: Solid, motion: dict[str, Motion], restitution: str, scale: float, gravity: float | None
) -> SpatialResponse:
    pull = g if gravity is None else checks.positive("--gravity", gravity, "m/s2")
    response = simulate(solid, motion, _law(restitution), scale=scale, gravity=pull)
    if response.outcome is Outcome.FAILED:
        raise RockingError(f"there is no response: {response.status.value}")
    return response


def _law(word: str) -> str | float:
    try:
        return float(word)
    except ValueError:
        return word


def _drawn_solid(response: SpatialResponse) -> Any:
    from rocking.plots.spatial import spatial_picture

    return spatial_picture(response)


def components(
    words: tuple[str | None, str | None, str | None], told: dict[str, Any], names: tuple[str | None, str | None]
) -> dict[str, Motion]:
    """Return the motion along x, y and z."""
    if all(word is None for word in words):
        raise InvalidValueError(
            "what moves the ground? Give a record file or a pulse such as sine:amplitude=3,period=0.8, along y and z "
            "with --motion-y and --motion-z"
        )
    x, y, z = words
    shared = {name: told[name] for name in _OF_FILES} if any(map(_is_file, words)) else {}
    along_x = None if x is None else motion_from(x, **(told if _is_file(x) or not shared else _but_shared(told)))
    along_y = _other(y, shared, names[0], "y")
    along_z = _other(z, shared, names[1], "z")
    if isinstance(along_x, GroundMotion) and along_x.vertical is not None and along_z is not None:
        raise InvalidValueError("the vertical motion is given twice: by --vertical or --vertical-file and --motion-z")
    moved = {"x": along_x, "y": along_y, "z": along_z}
    return {axis: motion for axis, motion in moved.items() if motion is not None}


def _other(word: str | None, shared: dict[str, Any], name: str | None, axis: str) -> Motion | None:
    option = f"--component-{axis}"
    if word is None:
        if name is not None:
            raise InvalidValueError(f"{option} names a component of --motion-{axis}, which is not given")
        return None
    try:
        return motion_from(word, component=name, **(shared if _is_file(word) else {}))
    except RockingError as error:
        raise type(error)(str(error).replace("--component", option)) from error


def _but_shared(told: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in told.items() if name not in _OF_FILES}


def _is_file(word: str | None) -> bool:
    try:
        return word is not None and Path(word).exists()
    except (OSError, ValueError):  # no file can have such a name
        return False
