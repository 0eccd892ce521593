"""The two questions that users ask of one body in space: how does it rock under a motion, and when it is let go."""

import math
from dataclasses import fields
from typing import Any

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.conventions import FloatArray
from rocking.dynamics.spatial import attitude
from rocking.dynamics.spatial.ground import Component, ground_of
from rocking.dynamics.spatial.impact import law_of
from rocking.dynamics.spatial.reference import SpatialReference
from rocking.dynamics.spatial.response import SpatialResponse
from rocking.dynamics.spatial.rocker import SpatialBody
from rocking.dynamics.spatial.settings import SpatialSettings
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.outcome import ContactMode
from rocking.portable import applied

_FINE, _AFTER, _LONG = 0.05, 15.0, 300.0
_MOST_SAMPLES = 2_000_000


def simulate_spatial(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Any,
    x: Component = None,
    y: Component = None,
    vertical: Component = None,
    restitution: Any = "housner-3d",
    *,
    scale: float = 1.0,
    tilt: float = 0.0,
    azimuth: float = 0.0,
    yaw: float = 0.0,
    angular_velocity: Any = (0.0, 0.0, 0.0),
    gravity: float = conventions.g,
    duration: float | None = None,
    **options: Any,
) -> SpatialResponse:
    """Return how a body rocks in space under up to three components of ground motion.

    The body turns about the edges and vertices of its base, or rolls on its rim, and does not slip; where it would
    leave the ground, the history stops and says so. A round base under two components rolls and has no impacts, so that
    the restitution does not matter; after it has rolled through lying nearly flat, small causes have large effects.

    Parameters
    ----------
    body : SpatialBody or any object with mass, centre, inertia and base
        The body; its axes are those of the ground at the start, but for `yaw`.
    x, y, vertical : GroundMotion or Pulse, optional
        Components of the motion, all starting at time zero; z is upwards.
    restitution : str, float, SpatialModel or SpatialImpactLaw
        A model of `rocking.restitution.spatial` or its name: "housner-3d", "horizontal-momentum-3d", or "ked-3d" for a
        `Solid`, a box or a cylinder; a coefficient r from 0 to 1 (that share of the angular velocity goes on, in the
        direction of the plastic impact); or any object with `velocity_after` and `label`.
    scale : float
        Factor on all components [-].
    tilt, azimuth : float
        How far the body leans at the start, and in which direction, from x towards y [rad].
    yaw : float
        Rotation about the vertical before that [rad].
    angular_velocity : array_like, shape (3,)
        At the start, in axes of the ground [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].
    duration : float, optional
        How long to follow the body [s]; if not given, the motion and 15 / p after it.
    **options
        Fields of `SpatialSettings`.

    Returns
    -------
    SpatialResponse
        Attitude, contact, impacts, energy, outcome.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> box = SpatialBody.box(width=0.5, depth=0.5, height=2.0, density=2400.0)
    >>> pulse = rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> response = simulate_spatial(box, x=pulse, y=pulse.scaled(0.4))
    >>> response.outcome.name, response.intervals[1][2].name
    ('ROCKED', 'EDGE')
    """
    motions = (x, y, vertical)
    if all(motion is None for motion in motions):
        raise InvalidValueError("a motion is needed in x, y or vertical; free_rocking_spatial does without")
    made, settings = SpatialBody.of(body), _settings(gravity, options)
    scale = checks.within("scale", scale, -1e6, 1e6)
    p = made.frequency(settings.gravity)
    ends = max(motion.duration for motion in motions if motion is not None)
    length = ends + _AFTER / p if duration is None else checks.positive("duration", duration, "s")
    ground = ground_of(x, y, vertical, until=length, scale=scale)
    plausibility.warn(plausibility.of_scaled(motions, scale))
    steps = [motion.time_step for motion in motions if isinstance(motion, GroundMotion)]
    names = tuple("none" if motion is None else motion.name for motion in motions)
    start = _initial(made, tilt, azimuth, yaw, angular_velocity)
    engine = SpatialReference(made, ground, law_of(restitution, made), settings)
    found = engine.run(*start, length)
    end = min(length, found.pieces[-1].end)
    time = _samples(min(steps, default=_FINE / p), end)
    return SpatialResponse(made, ground, engine.law, settings, time, found, end, (names[0], names[1], names[2]))


def free_rocking_spatial(
    body: Any,
    tilt: float = 0.0,
    azimuth: float = 0.0,
    restitution: Any = "housner-3d",
    *,
    yaw: float = 0.0,
    angular_velocity: Any = (0.0, 0.0, 0.0),
    gravity: float = conventions.g,
    duration: float | None = None,
    **options: Any,
) -> SpatialResponse:
    """Return how a body rocks in space when it is let go, or pushed, on ground at rest.

    Parameters
    ----------
    body : SpatialBody or any object with mass, centre, inertia and base
        The body.
    tilt, azimuth : float
        How far it leans, and in which direction, from x towards y [rad].
    restitution : str, float, SpatialModel or SpatialImpactLaw
        As for `simulate_spatial`.
    yaw : float
        Rotation about the vertical before that [rad].
    angular_velocity : array_like, shape (3,)
        In axes of the ground [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].
    duration : float, optional
        How long to follow the body [s]; if not given, until it rests or lies, or 300 / p.
    **options
        Fields of `SpatialSettings`.

    Returns
    -------
    SpatialResponse
        As of `simulate_spatial`.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> box = SpatialBody.box(width=1.0, depth=1.0, height=4.0)
    >>> diagonal = free_rocking_spatial(box, tilt=0.1, azimuth=0.25 * math.pi)  # corner to opposite corner
    >>> first = diagonal.impacts[0]
    >>> round(float((first["energy_after"] / first["energy_before"]) ** 0.5), 12) == round(59 / 71, 12)
    True
    """
    made, settings = SpatialBody.of(body), _settings(gravity, options)
    p = made.frequency(settings.gravity)
    length = _LONG / p if duration is None else checks.positive("duration", duration, "s")
    start = _initial(made, tilt, azimuth, yaw, angular_velocity)
    engine = SpatialReference(made, ground_of(), law_of(restitution, made), settings)
    found = engine.run(*start, length)
    last = found.pieces[-1]
    rests = duration is None and last.stance.contact is ContactMode.REST
    end = min(length, last.start + _FINE / p if rests else last.end)
    return SpatialResponse(made, engine.ground, engine.law, settings, _samples(_FINE / p, end), found, end)


def _initial(
    body: SpatialBody, tilt: float, azimuth: float, yaw: float, angular_velocity: Any
) -> tuple[FloatArray, FloatArray]:
    most = 100.0 * body.frequency(conventions.g)
    tilt = checks.within("tilt", tilt, 0.0, 0.5 * math.pi, unit="rad", open_high=True, hint="degrees?")
    azimuth, yaw = (checks.number(name, value, "rad") for name, value in (("azimuth", azimuth), ("yaw", yaw)))
    spin = checks.real_array("angular_velocity", angular_velocity, "rad/s")
    if spin.shape != (3,) or not (np.abs(spin) <= most).all():
        raise InvalidValueError(
            f"angular_velocity must be three numbers in [-{most:g}, {most:g}] rad/s, got {angular_velocity!r:.60}"
        )
    leaning = attitude.turn([-math.sin(azimuth), math.cos(azimuth), 0.0], tilt)
    quaternion = attitude.product(leaning, attitude.turn([0.0, 0.0, 1.0], yaw))
    return quaternion, applied(attitude.matrix(quaternion).T, spin)


def _settings(gravity: float, options: dict[str, Any]) -> SpatialSettings:
    known = {f.name for f in fields(SpatialSettings)}
    unknown = sorted(set(options) - known)
    if unknown:
        raise InvalidValueError(f"no option named {unknown[0]!r}; there are {', '.join(sorted(known))}")
    return SpatialSettings(gravity=gravity, **options)


def _samples(step: float, end: float) -> FloatArray:
    count = end / step
    if not count <= _MOST_SAMPLES:
        raise InvalidValueError(f"the response would have {count:.3g} samples; a shorter duration, please")
    return np.asarray(np.arange(math.floor(count + 1e-9) + 1) * step, dtype=np.float64).clip(max=end)
