"""The ground motion of a command: a record file, or a pulse in one word."""

import re
import shlex
from pathlib import Path

from rocking import checks
from rocking.errors import InvalidValueError, RecordError, RockingError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.pulses import catalogue, pulse

_PARAMETER = re.compile(r"\b(format|units|time_step|component|vertical)=")


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
        from rocking.cli.solid_options import is_body

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
