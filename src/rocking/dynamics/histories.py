"""The two questions that users ask of one body: how does it rock under a motion, and how does it rock when let go."""

import math
import warnings
from dataclasses import fields
from typing import Any

from rocking import checks, conventions, plausibility
from rocking.bodies import Body
from rocking.dynamics.response import Motion, Response
from rocking.dynamics.rocker import Rocker
from rocking.dynamics.run import run
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.segments import Segments

# p times the step between samples of a pulse's response, and p times the time that is followed after the motion
_FINE, _AFTER = 0.05, 15.0
_MOST_SAMPLES = 2_000_000


def simulate(  # noqa: PLR0913 - every one of them is a question that users ask
    body: Body,
    motion: Motion,
    restitution: Any = "ked",
    *,
    scale: float = 1.0,
    rotation: float = 0.0,
    angular_velocity: float = 0.0,
    gravity: float = conventions.g,
    duration: float | None = None,
    engine: str = "auto",
    key: int = 0,
    friction: float | None = None,
    **options: Any,
) -> Response:
    """Return how a body rocks under a ground motion.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints.
    motion : GroundMotion or Pulse
        The motion; a record is taken as straight lines between its samples, a pulse exactly.
    restitution : str, RestitutionModel, float, mapping or ImpactLaw
        Model or its name, coefficient, ``{"left": r, "right": r}``, or a law (`SpeedRestitution`,
        `RandomRestitution`).
    scale : float
        Factor on both components of the motion [-].
    rotation, angular_velocity : float
        theta [rad] and theta' [rad/s] at the start.
    gravity : float
        Acceleration of gravity [m/s2].
    duration : float, optional
        How long to follow the body [s]; if not given, the motion and 15 / p after it.
    engine : {"auto", "fast", "reference"}
        Which engine; which one ran is in `Response.engine`.
    key : int
        Number of the history, for random coefficients.
    friction : float, optional
        Coefficient of friction between body and ground [-]; where the response takes more, a `PureRockingWarning`
        says so; where the body would fly, with or without it, one says what it then does (`Response.with_contact`).
    **options
        Fields of `Settings`: linear, rest_speed, most_impacts, longest_step, order, tolerance.

    Returns
    -------
    Response
        Rotation, impacts, energy, forces, outcome.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    MissingExtraError
        If engine="fast" and it was not built.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=0.5, height=2.0)
    >>> pulse = rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> rk.simulate(block, pulse, restitution="housner").outcome.name
    'ROCKED'
    """
    if not isinstance(motion, (GroundMotion, Pulse)):
        raise InvalidValueError(f"motion must be a GroundMotion or a pulse, got {motion!r:.60}")
    scale = checks.within("scale", scale, -1e6, 1e6)
    plausibility.warn(plausibility.of_scaled([motion], scale))
    settings = settings_of(gravity, options)
    rocker = Rocker.of_body(body, restitution, settings.gravity)
    rotation, velocity = initial_state(rocker, rotation, angular_velocity)
    slow, quick = _frequencies(rocker)
    length = motion.duration + _AFTER / slow if duration is None else checks.positive("duration", duration, "s")
    segments = motion.segments()
    if isinstance(motion, Pulse):
        segments = segments.refined(math.ceil(quick * segments.step / _FINE))
    _check_samples(length / segments.step)
    segments = _cut(segments, length).extended(length)
    found = run(
        rocker, segments, settings, engine=engine, scale=scale, key=_key(key), rotation=rotation, velocity=velocity
    )
    return _credible(Response(body, motion, rocker, settings, segments, scale, key, found), friction)


def free_rocking(  # noqa: PLR0913 - as for `simulate`
    body: Body,
    rotation: float = 0.0,
    restitution: Any = "ked",
    *,
    angular_velocity: float = 0.0,
    gravity: float = conventions.g,
    duration: float | None = None,
    engine: str = "auto",
    key: int = 0,
    friction: float | None = None,
    **options: Any,
) -> Response:
    """Return how a body rocks when it is let go, or pushed, on ground at rest.

    Parameters
    ----------
    body : Body
        Block, Section or MassPoints.
    rotation : float
        theta at the start; positive to the right [rad].
    restitution : str, RestitutionModel, float, mapping or ImpactLaw
        As for `simulate`.
    angular_velocity : float
        theta' at the start [rad/s].
    gravity : float
        Acceleration of gravity [m/s2].
    duration : float, optional
        How long to follow the body [s]; if not given, until it rests or lies, or 300 / p.
    engine : {"auto", "fast", "reference"}
        Which engine.
    key : int
        Number of the history, for random coefficients.
    friction : float, optional
        Coefficient of friction between body and ground [-]; where the response takes more, a `PureRockingWarning`
        says so; where the body would fly, with or without it, one says what it then does (`Response.with_contact`).
    **options
        Fields of `Settings`.

    Returns
    -------
    Response
        As of `simulate`; its motion is None.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0)
    >>> response = rk.free_rocking(block, rotation=0.5 * block.slenderness_angle, restitution=0.9, gravity=9.81)
    >>> round(4.0 * float(response.impacts["time"][0]), 9)
    2.793372816
    """
    settings = settings_of(gravity, options)
    rocker = Rocker.of_body(body, restitution, settings.gravity)
    rotation, velocity = initial_state(rocker, rotation, angular_velocity)
    slow, quick = _frequencies(rocker)
    step = _FINE / quick
    length = 300.0 / slow if duration is None else checks.positive("duration", duration, "s")
    _check_samples(length / step)
    segments = Segments.still(step, max(1, math.ceil(length / step - 1e-9)))
    found = run(rocker, segments, settings, engine=engine, key=_key(key), rotation=rotation, velocity=velocity)
    if duration is None:
        found, segments = _until_rest(found, segments)
    return _credible(Response(body, None, rocker, settings, segments, 1.0, key, found), friction)


def settings_of(gravity: float, options: dict[str, Any]) -> Settings:
    """Return the settings of a call.

    gravity: acceleration of gravity [m/s2].
    """
    known = {f.name for f in fields(Settings)}
    unknown = sorted(set(options) - known)
    if unknown:
        raise InvalidValueError(f"no option named {unknown[0]!r}; there are {', '.join(sorted(known))}")
    return Settings(gravity=gravity, **options)


def initial_state(rocker: Rocker, rotation: float, angular_velocity: float) -> tuple[float, float]:
    """Return checked initial conditions.

    rotation, angular_velocity: theta [rad] and theta' [rad/s]. Returns the same, finite and within a quarter turn.
    """
    half_pi = 0.5 * math.pi
    rotation = checks.within(
        "rotation", rotation, -half_pi, half_pi, unit="rad", open_low=True, open_high=True, hint="degrees?"
    )
    most = 100.0 * _frequencies(rocker)[1]
    return rotation, checks.within("angular_velocity", angular_velocity, -most, most, unit="rad/s", hint="degrees?")


def _frequencies(rocker: Rocker) -> tuple[float, float]:
    both = rocker.right.frequency_parameter, rocker.left.frequency_parameter
    return min(both), max(both)


def _key(key: Any) -> int:
    if isinstance(key, bool) or not isinstance(key, int) or not 0 <= key < 2**63:
        raise InvalidValueError(f"key must be a whole number in [0, 2^63), got {key!r}")
    return key


def _check_samples(count: float) -> None:
    if not count <= _MOST_SAMPLES:
        raise InvalidValueError(
            f"the response would have {count:.3g} samples, more than {_MOST_SAMPLES:.0e}; a shorter duration, please"
        )


def _cut(segments: Segments, length: float) -> Segments:
    keep = max(1, math.ceil(length / segments.step - 1e-9))
    if keep >= segments.count:
        return segments
    vertical = None if segments.vertical is None else segments.vertical[:keep]
    return Segments(segments.step, segments.horizontal[:keep], vertical)


def _until_rest(found: Any, segments: Segments) -> tuple[Any, Segments]:
    from dataclasses import replace

    moving = (found.rotation != 0.0) | (found.angular_velocity != 0.0)
    last = int(moving.nonzero()[0][-1]) + 2 if moving.any() else 2
    if last >= found.rotation.size:
        return found, segments
    shorter = replace(found, rotation=found.rotation[: last + 1], angular_velocity=found.angular_velocity[: last + 1])
    return shorter, Segments.still(segments.step, last)


def _credible(response: Response, friction: float | None) -> Response:
    if friction is not None:
        plausibility.warn(plausibility.of_friction(checks.positive("friction", friction)))
    for sentence in response.doubts(friction):
        warnings.warn(sentence, PureRockingWarning, stacklevel=3)
    return response
