"""The three components of motion of a command about a body in space."""

from pathlib import Path
from typing import Any

from rocking.cli.motion_options import motion_from
from rocking.errors import InvalidValueError, RockingError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse

Component = GroundMotion | Pulse | None

_OF_FILES = ("format", "units", "time_step")


def components(
    words: tuple[str | None, str | None, str | None], told: dict[str, Any], names: tuple[str | None, str | None]
) -> tuple[Component, Component, Component]:
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
    if isinstance(along_x, GroundMotion) and along_x.vertical is not None:
        if along_z is not None:
            raise InvalidValueError(
                "the vertical motion is given twice: by --vertical or --vertical-file and --motion-z"
            )
        up = along_x.vertical
        along_z = along_x.changed("its vertical part", acceleration=up, vertical=None)
        along_x = along_x.changed("its horizontal part", vertical=None)
    return along_x, along_y, along_z


def _other(word: str | None, shared: dict[str, Any], name: str | None, axis: str) -> Component:
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
