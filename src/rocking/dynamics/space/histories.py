"""One body in space under up to three components of motion, or let go."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.conventions import FloatArray
from rocking.dynamics.settings import Settings
from rocking.dynamics.space.attitude import SpatialStart
from rocking.dynamics.space.body import SpatialBody
from rocking.dynamics.space.ground import Component, ground_of
from rocking.dynamics.space.impact_laws import law_of
from rocking.dynamics.space.reference import SpatialReference
from rocking.dynamics.space.response import SpatialResponse
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.outcome import ContactMode

_FINE, _AFTER, _LONG = 0.05, 15.0, 300.0
_MOST_SAMPLES = 2_000_000


def response_in_space(
    body: Any,
    components: tuple[Component, Component, Component],
    restitution: Any,
    settings: Settings,
    *,
    start: SpatialStart,
    scale: float = 1.0,
    duration: float | None = None,
) -> SpatialResponse:
    """Return how a body rocks in space; without any component, when it is let go."""
    # duration: how long to follow the body [s]; if not given, the motion and 15 / p after it, on ground at rest until
    # it rests or lies, or 300 / p
    made = SpatialBody.of(body)
    scale = checks.within("scale", scale, -1e6, 1e6)
    start = started(start, made.frequency(conventions.g))
    p, shaken = made.frequency(settings.gravity), [motion for motion in components if motion is not None]
    if shaken and not all(hasattr(motion, "duration") for motion in shaken):
        ground_of(*components)  # says which of them is no motion
    usual = max(motion.duration for motion in shaken) + _AFTER / p if shaken else _LONG / p
    length = usual if duration is None else checks.positive("duration", duration, "s")
    ground = ground_of(*components, until=length if shaken else np.inf, scale=scale)
    plausibility.warn(plausibility.of_scaled(shaken, scale))
    engine = SpatialReference(made, ground, law_of(restitution, made), settings)
    found = engine.run(start.quaternion, start.body_velocity, length)
    last = found.pieces[-1]
    rests = not shaken and duration is None and last.contact.mode is ContactMode.REST
    end = min(length, last.start + _FINE / p if rests else last.end)
    steps = [motion.time_step for motion in shaken if isinstance(motion, GroundMotion)]
    time = samples(min(steps, default=_FINE / p), end)
    x, y, z = ("none" if motion is None else motion.name for motion in components)
    return SpatialResponse(made, ground, engine.law, settings, time, found, end, (x, y, z))


def started(start: SpatialStart, pace: float) -> SpatialStart:
    """Return how a body starts, checked; pace: frequency parameter, or sqrt(g / size) [1/s]."""
    most = 100.0 * pace
    tilt = checks.within("tilt", start.tilt, 0.0, 0.5 * math.pi, unit="rad", open_high=True, hint="degrees?")
    azimuth, yaw = (checks.number(name, getattr(start, name), "rad") for name in ("azimuth", "yaw"))
    spin = checks.real_array("angular_velocity", start.angular_velocity, "rad/s")
    if spin.shape != (3,) or not (np.abs(spin) <= most).all():
        raise InvalidValueError(
            f"angular_velocity must be three numbers in [-{most:g}, {most:g}] rad/s, got {start.angular_velocity!r:.60}"
        )
    return replace(start, tilt=tilt, azimuth=azimuth, yaw=yaw, angular_velocity=spin)


def samples(step: float, end: float) -> FloatArray:
    """Return the times of samples up to an end [s]."""
    count = end / step
    if not count <= _MOST_SAMPLES:
        raise InvalidValueError(f"the response would have {count:.3g} samples; a shorter duration, please")
    return np.asarray(np.arange(math.floor(count + 1e-9) + 1) * step, dtype=np.float64).clip(max=end)
