"""One chain of steps that a record goes through, in words: the same in Python, job files and on the command line."""

import inspect
from collections.abc import Callable, Sequence
from typing import Any

from rocking import checks
from rocking.conventions import UNITS
from rocking.errors import InvalidValueError, located
from rocking.motions import processing
from rocking.motions.components import Components, rotated
from rocking.motions.floors import on_floor
from rocking.motions.intensity import MEASURES, measure
from rocking.motions.motion import GroundMotion, checked_motion

Steps = list[tuple[str, dict[str, Any]]]
LONGEST_PADDING = 3600.0  # [s] twelve times a record of 300 s, which is long: more is a wrong unit, and hours of work


def _scaled(motion: GroundMotion, factor: float | None = None, **level: float) -> GroundMotion:
    """Return the motion multiplied by a factor, or to a measure.

    Parameters
    ----------
    factor : float
        On all components [-].
    """
    if (factor is not None) + len(level) != 1:
        raise InvalidValueError("scale takes factor=2, or one measure such as pga=3 [m/s2]")
    if factor is not None:
        return motion.scaled(factor)
    ((name, target),) = level.items()
    return processing.scaled_to(motion, name, target)


def _without_response(motion: GroundMotion, stations: str, low: float = 0.02, high: float = 40.0) -> GroundMotion:
    """Return accelerations from counts: the response of the instrument is removed.

    Parameters
    ----------
    stations : str
        StationXML file that describes the instrument, a folder of such files, or several with | between.
    low, high : float
        Frequencies between which that is done [Hz].
    """
    from rocking.motions.formats.instrument import without_response

    return without_response(motion, stations, low, high)


def _rotated(motion: GroundMotion, angle: float) -> GroundMotion:
    """Return both horizontal components turned.

    Parameters
    ----------
    angle : float
        From x towards y [degree].
    """
    raise InvalidValueError("rotate is for two horizontal components; {motion!r:.60} is one", motion=motion.name)


STEPS: dict[str, Callable[..., GroundMotion]] = {
    "response": _without_response,
    "resample": processing.resampled,
    "mean": processing.demeaned,
    "baseline": processing.detrended,
    "taper": processing.tapered,
    "pad": processing.padded,
    "bandpass": processing.bandpassed,
    "trim": processing.trimmed,
    "significant": processing.trimmed_to_significant,
    "rotate": _rotated,
    "floor": on_floor,
    "scale": _scaled,
}
"""What a step does, by its word; keys are the names of its parameters."""


def processed(motion: Any, chain: str | Sequence[str]) -> Any:
    """Return a motion that went through a chain of steps, each of which its provenance names.

    Parameters
    ----------
    motion : GroundMotion or Components
        The motion. Components go through every step together: they are cut at the same times, and scaled by the
        factor of the stronger horizontal one.
    chain : str or sequence of str
        Steps in their order, ``name:key=value,key=value``, with semicolons between: ``mean; bandpass:low=0.1,high=25;
        taper``. There are response, resample, mean, baseline, taper, pad, bandpass, trim, significant, rotate, floor,
        scale; keys are the parameters of the functions of `rocking.motions`; ``scale:factor=2`` or ``scale:pga=3``
        [m/s2] or ``scale:pga=0.3g``, ``rotate:angle=30`` [degree], ``floor:number=3,storeys=5,period=0.5`` [s],
        ``response:stations=FILE.xml,low=0.02,high=40`` [Hz]. ``pad`` adds at most 3600 s at each end.

    Returns
    -------
    GroundMotion or Components
        Of the same kind.

    Raises
    ------
    InvalidValueError
        If there is no such step, or a step refuses its keys or the motion.

    Examples
    --------
    >>> processed(GroundMotion([1.0, 3.0], 0.1), "mean; scale:factor=2").acceleration.tolist()
    [-2.0, 2.0]
    """
    if not isinstance(motion, Components):
        checked_motion(motion)
    steps = steps_of(chain)
    names = [name for name, _ in steps]
    for place, (name, keys) in enumerate(steps, 1):
        which = name if names.count(name) == 1 else f"{place}, {name}"
        with located(f"step {which}", "step", place):
            motion = _together(motion, name, keys) if isinstance(motion, Components) else STEPS[name](motion, **keys)
    return motion


def _together(motion: Components, name: str, keys: dict[str, Any]) -> Components:
    """Take all components through a step that must treat them alike."""
    if name == "rotate" and motion.x is not None and motion.y is not None:
        import math

        return Components(*rotated(motion.x, motion.y, math.radians(keys["angle"])), motion.z)
    if name == "significant":
        first, last = processing.significant_bounds(motion.leading, **keys)
        return motion.each(lambda part: processing.trimmed(part, first, last))
    if name == "floor":
        x, y = (None if part is None else on_floor(part, **keys) for part in (motion.x, motion.y))
        return Components(x, y, motion.z)
    if name == "scale" and "factor" not in keys:
        before, after = motion.leading.peak, _scaled(motion.leading, **keys).peak
        return motion.each(lambda part: part.scaled(after / before))
    return motion.each(lambda part: STEPS[name](part, **keys))


def steps_of(chain: str | Sequence[str]) -> Steps:
    """Return the steps of a chain with their keys, checked.

    >>> steps_of("mean; bandpass:low=0.1,high=25")
    [('mean', {}), ('bandpass', {'low': 0.1, 'high': 25.0})]
    """
    parts = [part.strip() for text in ([chain] if isinstance(chain, str) else chain) for part in str(text).split(";")]
    steps = []
    for place, part in enumerate(filter(None, parts), 1):
        name, _, tail = part.partition(":")
        with located(f"step {name.strip()}", "step", place):
            steps.append(_step(name, tail))
    return steps


def keys_of(step: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    """Return the keys that a step takes beside the motion; level: any measure that grows with it."""
    return {key: one for key, one in inspect.signature(step).parameters.items() if key not in {"motion", "body"}}


def _step(name: str, tail: str) -> tuple[str, dict[str, Any]]:
    name = checks.one_of("step", name.strip(), STEPS)
    known = keys_of(STEPS[name])
    open_ended = known.pop("level", None) is not None
    keys: dict[str, Any] = {}
    for item in filter(None, tail.split(",")):
        key, equals, value = (part.strip() for part in item.partition("="))
        if not equals or key in keys or not (key in known or (open_ended and key in MEASURES)):
            raise InvalidValueError("it takes {keys}, got {item!r:.60}", keys=", ".join(known) or "no keys", item=item)
        keys[key] = _value(key, value, known.get(key))
    if missing := [key for key, one in known.items() if one.default is one.empty and key not in keys]:
        raise InvalidValueError("it needs {keys}", keys=", ".join(missing))
    for key in keys.keys() - known.keys():
        measure(key).check_grows()
    for key, value in keys.items() if name == "pad" else ():
        checks.within(key, value, 0.0, LONGEST_PADDING, unit="s", hint="milliseconds, or samples?")
    return name, keys


def _value(key: str, text: str, parameter: inspect.Parameter | None) -> Any:
    kind = "float" if parameter is None else str(parameter.annotation)
    if parameter is None and (unit := measure(key).unit) in UNITS:
        return checks.quantity(key, text, unit)[0]
    if "float" not in kind and "int" not in kind:
        return text
    try:
        return float(text) if "float" in kind else int(text)
    except ValueError as error:
        allowed = f"a {'whole ' if 'float' not in kind else ''}number"
        raise InvalidValueError(parameter=key, allowed=allowed, value=text, hint=checks.number_hint(text)) from error
