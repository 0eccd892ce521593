"""One plane body that rocks: under a motion, or let go."""

import math
from dataclasses import replace
from typing import Any

from rocking import checks, plausibility
from rocking.bodies import Body
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.fast_engine import run
from rocking.dynamics.response import Response
from rocking.dynamics.response_base import followed, ground_at_rest
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.motions.pulse import Motion
from rocking.motions.segments import Segments

# p times: the step between samples of a pulse's response, what is followed after a motion, and on ground at rest
_FINE, _AFTER, _FREE = 0.05, 15.0, 300.0


def response_of_rocking(  # noqa: PLR0913 - what the front door hands on
    body: Body,
    motion: Motion | None,
    restitution: Any,
    settings: Settings,
    *,
    rotation: float = 0.0,
    angular_velocity: float = 0.0,
    scale: float = 1.0,
    duration: float | None = None,
    engine: str = "auto",
    stream: int = 0,
) -> Response:
    """Return how a plane body rocks without sliding or flying; on ground at rest without a motion."""
    # rotation, angular_velocity: theta [rad] and theta' [rad/s] at the start; duration: how long to follow the body
    # [s]; if not given, the motion and 15 / p after it, on ground at rest until it rests or lies, or 300 / p
    scale = checks.within("scale", scale, -1e6, 1e6)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    parameters = RockingParameters.of_body(body, restitution, settings.gravity)
    frequencies = parameters.right.frequency_parameter, parameters.left.frequency_parameter
    slow, quick = min(frequencies), max(frequencies)
    half_pi = 0.5 * math.pi
    rotation = checks.within(
        "rotation", rotation, -half_pi, half_pi, unit="rad", open_low=True, open_high=True, hint="degrees?"
    )
    most = 100.0 * quick
    velocity = checks.within("angular_velocity", angular_velocity, -most, most, unit="rad/s", hint="degrees?")
    usual = _FREE / slow if motion is None else motion.duration + _AFTER / slow
    length = usual if duration is None else checks.positive("duration", duration, "s")
    if motion is None:
        segments = ground_at_rest(_FINE / quick, length)
    else:
        segments = motion.segments()
        segments = followed(segments, length, math.ceil(quick * segments.step / _FINE), motion)
    _check_stream(stream)
    found = run(
        parameters, segments, settings, engine=engine, scale=scale, stream=stream, rotation=rotation, velocity=velocity
    )
    if motion is None and duration is None:
        found, segments = _until_rest(found, segments)
    return Response(body, motion, parameters, settings, segments, scale, stream, found)


def _check_stream(stream: object) -> None:
    if isinstance(stream, bool) or not isinstance(stream, int) or not 0 <= stream < 2**63:
        raise InvalidValueError(f"stream must be a whole number in [0, 2^63), got {stream!r}")


def _until_rest(found: Any, segments: Segments) -> tuple[Any, Segments]:
    moving = (found.rotation != 0.0) | (found.angular_velocity != 0.0)
    last = int(moving.nonzero()[0][-1]) + 2 if moving.any() else 2
    if last >= found.rotation.size:
        return found, segments
    shorter = replace(found, rotation=found.rotation[: last + 1], angular_velocity=found.angular_velocity[: last + 1])
    return shorter, Segments.still(segments.step, last)
