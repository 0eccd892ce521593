"""The body, the motion and the model that the options of a command say."""

import math
import re
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.bodies import Block, Body, Solid
from rocking.bodies.formats import FORMATS, describes_solid, read_body, read_plane_body
from rocking.checks import length_unit
from rocking.cli.options import in_unit
from rocking.conventions import FEET, Foot
from rocking.errors import BodyFileError, InvalidValueError, RecordError, RockingError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.pulses import catalogue, pulse
from rocking.restitution import RestitutionModel, model
from rocking.restitution.from_file import file_of, model_in_file

_WORDS = (
    (re.compile(r"\bunits="), "--units"),
    (re.compile(r"\bfill_holes\b(=True)?"), "--fill-holes"),
    (re.compile(r"\bbase_tolerance\b=?"), "--base-tolerance"),
    (re.compile(r"\bup must be"), "--up must be"),
)
_PARAMETER = re.compile(r"\b(format|units|time_step|component|vertical)=")


def body_from(
    file: Path | None,
    *,
    width: float | None,
    height: float | None,
    depth: float | None,
    density: float | None,
    angle: float | None,
    semi_diagonal: float | None,
    unit: str | None,
) -> Body:
    """Return the body that a command was given.

    density: density [kg/m3]; angle: slenderness angle [rad].
    """
    sizes = {"--width": width, "--height": height, "--angle": angle, "--semi-diagonal": semi_diagonal}
    given = [name for name, value in sizes.items() if value is not None]
    if file is not None:
        if given or depth is not None or density is not None:
            raise InvalidValueError("give a body file or dimensions, not both")
        try:
            return read_plane_body(file, units=unit)
        except BodyFileError as error:
            if is_body(file):
                raise
            raise BodyFileError(f"{error}; perhaps a record: see rocking motion {file}") from error
    scale = length_unit(unit or "m")
    options: dict[str, float] = {} if density is None else {"density": density}
    if depth is not None:
        options["depth"] = depth * scale
    if width is not None and height is not None and len(given) == 2:
        return Block(width=width * scale, height=height * scale, **options)
    if angle is not None and semi_diagonal is not None and len(given) == 2:
        return Block.from_angle(angle, semi_diagonal * scale, **options)
    raise InvalidValueError(
        "a body is a file, or --width and --height, or --angle and --semi-diagonal; "
        f"got {' '.join(given) if given else 'none of them'}"
    )


def body_words(body: Body, gravity: float, length: str = "m") -> str:
    """Return a plane body in a line.

    gravity: acceleration of gravity [m/s2]. Returns Kind, mass, and what decides how it rocks, of both feet where they
    differ.
    """
    feet: tuple[Foot, ...] = ("right",) if body.is_symmetric else FEET
    sides = {foot: body.side(foot, gravity) for foot in feet}
    shape = "; ".join(
        f"{'' if body.is_symmetric else f'{foot} '}alpha = {side.slenderness_angle:.4g} rad "
        f"({math.degrees(side.slenderness_angle):.3g} deg), R = {in_unit(side.semi_diagonal, length)}, "
        f"p = {side.frequency_parameter:.4g} rad/s"
        for foot, side in sides.items()
    )
    return f"{type(body).__name__}, {body.mass:.4g} kg, {shape}"


def models_from(words: Sequence[str] | None) -> list[RestitutionModel] | None:
    """Return the models that a command was given, none if it was given none."""
    return [model_in_file(word) if file_of(word) else model(word) for word in words] if words else None


def is_solid(word: str | Path | None) -> bool:
    """Return whether the first word of a command names a body in space.

    Returns whether it is a mesh, or a TOML file with [solid].
    """
    return word is not None and describes_solid(word)


def is_body(word: str | Path) -> bool:
    """Return whether a word names a body, plane or in space, by how it ends.

    Returns whether a body file is named so.
    """
    return Path(word).suffix.lower() in FORMATS


def solid_from(
    path: Path,
    *,
    unit: str | None,
    density: float | None,
    up: str | None,
    fill_holes: bool,
    base_tolerance: float | None,
) -> Solid:
    """Return the body in space that a command was given.

    density: density of the mesh [kg/m3]. Returns the body, and what was done to get it.
    """
    try:
        scale = length_unit(unit or "m")
        reach = None if base_tolerance is None else base_tolerance * scale
        body = read_body(path, units=unit, density=density, up=up, fill_holes=fill_holes, base_tolerance=reach)
        if not isinstance(body, Solid):
            raise BodyFileError(f"{path.name}: describes a plane body; a body in space is needed here")
        return body
    except RockingError as error:
        raise type(error)(_in_options_of_solids(str(error))) from error


def refuse(reason: str, options: dict[str, Any]) -> None:
    """Refuse options that have no meaning for a kind of body."""
    given = [name for name, value in options.items() if value is not None and value is not False]
    if given:
        raise RockingError(f"{reason}, so it takes no {', '.join(given)}")


def spelt(options: dict[str, Any]) -> dict[str, Any]:
    """Return options under the names that a user types.

    >>> spelt({"semi_diagonal": None})
    {'--semi-diagonal': None}
    """
    return {"--units" if name == "unit" else f"--{name.replace('_', '-')}": value for name, value in options.items()}


def _in_options_of_solids(words: str) -> str:
    for pattern, option in _WORDS:
        words = pattern.sub(option, words)
    return words


def motion_from(
    word: str,
    *,
    format: str | None = None,
    units: str | None = None,
    time_step: float | None = None,
    component: str | None = None,
    vertical: str | None = None,
    vertical_file: str | None = None,
    scale: float | None = None,
) -> GroundMotion | Pulse:
    """Return the motion that a command was given; a name that exists as a file is a file, whatever else it might be.

    time_step: step between samples, where the file does not state it [s]; scale: factor on the accelerations of both
    components, not zero [-].

    >>> motion_from("sine:amplitude=3,period=0.8", scale=2.0).peak
    6.0
    """
    factor = None if scale is None else checks.number("scale", scale)
    if factor == 0.0:
        raise InvalidValueError("scale must not be 0: nothing would move")
    asked = {
        "format": format,
        "units": units,
        "time_step": time_step,
        "component": component,
        "vertical": vertical,
        "vertical_file": vertical_file,
    }
    motion: GroundMotion | Pulse
    if _is_file(word):
        motion = _from_file(word, format, units, time_step, component, vertical, vertical_file)
    else:
        motion = _pulse(word, [_option(name) for name, value in asked.items() if value is not None])
    return motion if factor is None else motion.scaled(factor)


def _is_file(word: str) -> bool:
    try:
        return Path(word).exists()
    except (OSError, ValueError):
        # no file can have such a name
        return False


def _pulse(word: str, options: list[str]) -> Pulse:
    name, colon, _ = word.partition(":")
    if (not colon and name not in catalogue()) or "/" in name or "\\" in word:
        raise RecordError(
            f"{word[:200]}: no such file; a pulse is written as sine:amplitude=3,period=0.8, "
            f"with one of {', '.join(sorted(catalogue()))}"
        )
    made = pulse(word)
    if options:
        raise InvalidValueError(f"a pulse takes no {', '.join(options)}: these are for files; got {word[:200]!r}")
    return made


def _from_file(
    word: str,
    format: str | None,
    units: str | None,
    time_step: float | None,
    component: str | None,
    vertical: str | None,
    vertical_file: str | None,
) -> GroundMotion:
    from rocking.motions.formats import read_motion, read_record

    try:
        return read_motion(word, format, units, time_step, component, vertical, vertical_path=vertical_file)
    except InvalidValueError as error:
        cause = _in_options(error)
        if component is None and "component=" in str(error):
            names = [part.name for part in read_record(word, format, units, time_step).components]
            taken = "" if vertical is None or vertical_file is not None else vertical.casefold()
            cause += "; " + _hint([name for name in names if name.casefold() != taken])
        raise InvalidValueError(cause) from error
    except RecordError as error:
        body = f"; perhaps a body: see rocking cor {word}" if is_body(word) else ""
        raise RecordError(_in_options(error) + body) from error


def _hint(names: list[str]) -> str:
    """Return what to type for each component."""
    choices = [f"--component {shlex.quote(name)}" for name in names]
    return f"that is, {' or '.join(choices)}" if choices else "it has no other one"


def _in_options(error: RockingError) -> str:
    """Return the message with the parameters of functions called as the command line calls them."""
    return _PARAMETER.sub(lambda found: _option(found[1]), str(error))


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")
