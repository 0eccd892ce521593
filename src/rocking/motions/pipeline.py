"""Chains of processing steps as text. The text is the same in Python, in input files and on the command line."""

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
LONGEST_PADDING = 3600.0  # [s], 12 times a long record (300 s); larger values result from a wrong unit


def _scaled(motion: GroundMotion, factor: float | None = None, **level: float) -> GroundMotion:
    """Return the motion scaled by a factor, or to an intensity measure.

    Parameters
    ----------
    factor : float
        Scale factor of all components [-].
    """
    if (factor is not None) + len(level) != 1:
        raise InvalidValueError("scale accepts factor=2, or one measure such as pga=3 [m/s2]")
    if factor is not None:
        return motion.scaled(factor)
    ((name, target),) = level.items()
    return processing.scaled_to(motion, name, target)


def _without_response(motion: GroundMotion, stations: str, low: float = 0.02, high: float = 40.0) -> GroundMotion:
    """Return accelerations from counts, without the instrument response.

    Parameters
    ----------
    stations : str
        StationXML file of the instrument, a folder of such files, or several files separated by |.
    low, high : float
        Frequency range of the correction [Hz].
    """
    from rocking.motions.formats.instrument import without_response

    return without_response(motion, stations, low, high)


def _rotated(motion: GroundMotion, angle: float) -> GroundMotion:
    """Return both horizontal components along rotated axes.

    Parameters
    ----------
    angle : float
        Rotation angle, from x towards y [degree].
    """
    raise InvalidValueError("rotate requires two horizontal components; {motion!r:.60} is one", motion=motion.name)


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
"""Functions of the processing steps by name. The keys of a step are the parameters of its function."""


def processed(motion: Any, chain: str | Sequence[str]) -> Any:
    """Return a processed motion. The provenance of the motion contains all steps.

    Parameters
    ----------
    motion : GroundMotion or Components
        Motion. All components are cut at equal times. They are scaled by the factor of the horizontal component with
        the largest peak.
    chain : str or sequence of str
        Ordered steps ``name:key=value,key=value``, separated by semicolons: ``mean; bandpass:low=0.1,high=25;
        taper``. Steps are response, resample, mean, baseline, taper, pad, bandpass, trim, significant, rotate, floor
        and scale. Keys are the parameters of the functions of `rocking.motions`. Examples: ``scale:factor=2``,
        ``scale:pga=3`` [m/s2], ``scale:pga=0.3g``, ``rotate:angle=30`` [degree],
        ``floor:number=3,storeys=5,period=0.5`` [s], ``response:stations=FILE.xml,low=0.02,high=40`` [Hz]. ``pad`` adds
        at most 3600 s at each end.

    Returns
    -------
    GroundMotion or Components
        Processed motion of the same type.

    Raises
    ------
    InvalidValueError
        If a step is unknown, or its keys or the motion are invalid.

    Examples
    --------
    >>> processed(GroundMotion([1.0, 3.0], 0.1), "mean; scale:factor=2").acceleration.tolist()
    [-2.0, 2.0]
    """
    if not isinstance(motion, Components):
        checked_motion(motion)
    steps = steps_of(chain)
    names = [name for name, _ in steps]
    for number, (name, keys) in enumerate(steps, 1):
        label = name if names.count(name) == 1 else f"{number}, {name}"
        with located(f"step {label}", "step", number):
            motion = _together(motion, name, keys) if isinstance(motion, Components) else STEPS[name](motion, **keys)
    return motion


def _together(motion: Components, name: str, keys: dict[str, Any]) -> Components:
    """Return all components after one step, with common times and factors."""
    if name == "rotate" and motion.x is not None and motion.y is not None:
        import math

        return Components(*rotated(motion.x, motion.y, math.radians(keys["angle"])), motion.z)
    if name == "significant":
        first, last = processing.significant_bounds(motion.leading, **keys)
        return motion.each(lambda component: processing.trimmed(component, first, last))
    if name == "floor":
        x, y = (None if component is None else on_floor(component, **keys) for component in (motion.x, motion.y))
        return Components(x, y, motion.z)
    if name == "scale" and "factor" not in keys:
        before, after = motion.leading.peak, _scaled(motion.leading, **keys).peak
        return motion.each(lambda component: component.scaled(after / before))
    return motion.each(lambda component: STEPS[name](component, **keys))


def steps_of(chain: str | Sequence[str]) -> Steps:
    """Return the validated steps of a chain with their keys.

    >>> steps_of("mean; bandpass:low=0.1,high=25")
    [('mean', {}), ('bandpass', {'low': 0.1, 'high': 25.0})]
    """
    texts = [text.strip() for text in ([chain] if isinstance(chain, str) else chain) for text in str(text).split(";")]
    steps = []
    for number, text in enumerate(filter(None, texts), 1):
        name, _, tail = text.partition(":")
        with located(f"step {name.strip()}", "step", number):
            steps.append(_step(name, tail))
    return steps


def keys_of(step: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    """Return the parameters of a step, except the motion. `level` means any measure of nonzero power."""
    return {
        key: parameter for key, parameter in inspect.signature(step).parameters.items() if key not in {"motion", "body"}
    }


def _step(name: str, tail: str) -> tuple[str, dict[str, Any]]:
    name = checks.one_of("step", name.strip(), STEPS)
    parameters = keys_of(STEPS[name])
    open_ended = parameters.pop("level", None) is not None
    keys: dict[str, Any] = {}
    for item in filter(None, tail.split(",")):
        key, equals, value = (text.strip() for text in item.partition("="))
        if not equals or key in keys or not (key in parameters or (open_ended and key in MEASURES)):
            raise InvalidValueError(
                "allowed keys are {keys}, got {item!r:.60}", keys=", ".join(parameters) or "no keys", item=item
            )
        keys[key] = _value(key, value, parameters.get(key))
    if missing := [
        key for key, parameter in parameters.items() if parameter.default is parameter.empty and key not in keys
    ]:
        raise InvalidValueError("required keys are missing: {keys}", keys=", ".join(missing))
    for key in keys.keys() - parameters.keys():
        measure(key).check_grows()
    for key, value in keys.items() if name == "pad" else ():
        checks.within(key, value, 0.0, LONGEST_PADDING, unit="s", hint="enter seconds")
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
