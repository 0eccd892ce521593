"""Simulation of one body under a ground motion, or in free rocking."""

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias, TypedDict, TypeVar, Unpack, overload

from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION
from rocking.dynamics.mechanics import mechanics_for
from rocking.dynamics.mechanics_base import UNCHANGED, Mechanics
from rocking.dynamics.response import Response
from rocking.dynamics.settings import Settings
from rocking.motions.components import AnyMotion

if TYPE_CHECKING:
    from rocking.bodies import Stack
    from rocking.bodies.solid import Solid
    from rocking.dynamics.frictional.response import HullResponse
    from rocking.dynamics.plane_frictional import ContactResponse, Start
    from rocking.dynamics.rolling import SpatialBody, SpatialResponse, SpatialStart
    from rocking.dynamics.stack.response import StackResponse

    BodyInSpace: TypeAlias = Solid | SpatialBody

Called = TypeVar("Called", bound=Callable[..., Any])


class IntegrationOptions(TypedDict, total=False):
    """Options of one or many histories: ground, and settings of the integration."""

    normal_restitution: float
    normal_restitution_law: str
    gravity: float
    engine: str
    linear: bool
    rest_speed: float | None
    most_events: int
    longest_step: float | None
    order: int | None
    tolerance: float | None


class HistoryOptions(IntegrationOptions, total=False):
    """Options of one history."""

    angular_velocity: Any
    start: "Start | SpatialStart | None"
    duration: float | None
    stream: int


class MovedOptions(HistoryOptions, total=False):
    """Options of one history under a motion."""

    scale: float
    rotation: float


def _shown(function: Called) -> Called:
    """Add the options with their defaults to the signature, for help, documentation and completion."""
    defaults: dict[str, Any] = {name: values[0] for name, values in UNCHANGED.items()}
    defaults |= {"gravity": Settings.gravity, "most_events": Settings.most_events}
    signature = inspect.signature(function)
    *positional, _ = signature.parameters.values()
    keyword = inspect.Parameter.KEYWORD_ONLY
    options = [inspect.Parameter(name, keyword, default=defaults[name]) for name in MovedOptions.__annotations__]
    function.__signature__ = signature.replace(parameters=[*positional, *options])  # type: ignore[attr-defined]
    return function


@overload
def simulate(
    body: Body, motion: AnyMotion, restitution: Any = DEFAULT_RESTITUTION, *, friction: None = None,
    **options: Unpack[MovedOptions],
) -> Response: ...  # fmt: skip
@overload
def simulate(
    body: Body, motion: AnyMotion, restitution: Any = DEFAULT_RESTITUTION, *, friction: float,
    **options: Unpack[MovedOptions],
) -> "ContactResponse": ...  # fmt: skip
@overload
def simulate(
    body: "Stack", motion: AnyMotion, restitution: Any = DEFAULT_RESTITUTION, *, friction: None = None,
    **options: Unpack[MovedOptions],
) -> "StackResponse": ...  # fmt: skip
@overload
def simulate(
    body: "BodyInSpace", motion: AnyMotion, restitution: Any = DEFAULT_RESTITUTION, *, friction: None = None,
    **options: Unpack[MovedOptions],
) -> "SpatialResponse": ...  # fmt: skip
@overload
def simulate(
    body: "BodyInSpace", motion: AnyMotion, restitution: Any = DEFAULT_RESTITUTION, *, friction: float,
    **options: Unpack[MovedOptions],
) -> "HullResponse": ...  # fmt: skip
@_shown
def simulate(
    body: Any, motion: Any, restitution: Any = DEFAULT_RESTITUTION, *, friction: float | None = None, **options: Any
) -> Any:
    """Return the response of a body to a ground motion.

    A plane body rocks about its feet. With `friction`, a plane body may also slide, hop and fly. A 3D body turns about
    the edges and vertices of its base, or rolls on its rim, without slip. A loss of contact stops this history with an
    error status. With `friction`, a 3D body touches the ground at the vertices of its convex hull: it rocks, slides,
    hops, flies and falls into other poses. A round base under two horizontal components rolls without impacts, so that
    the restitution has no influence. When such a base becomes nearly flat on the ground, small changes have large
    effects afterwards.

    Parameters
    ----------
    body : Body, Stack, Solid or SpatialBody
        A plane body (Block, Section, MassPoints), a stack of plane bodies with its own friction and restitution, or a
        3D body with mass, centre of mass, inertia and base.
    motion : GroundMotion, Pulse, mapping or tuple
        The motion along x, or ``{"x": .., "y": .., "z": ..}`` with z upwards, or up to three motions in this order. All
        components start at the same time. A record is linear between its samples; a pulse is exact. A plane body uses x
        and z.
    restitution : str, RestitutionModel, float, mapping or ImpactLaw
        Model or its name, coefficient, ``{"left": r, "right": r}``, or a law (`SpeedRestitution`, `RandomRestitution`).

        With friction, the coefficient applies to rocking impacts without slip and gives the impulse position. If the
        friction demand exceeds the friction, the foot slides during the impact. The complementarity problem gives
        landings from flight, and all impacts if the restitution is None.

        For a 3D body: a model of `rocking.restitution.space`, with or without "-3d" ("ked" needs a distribution of
        mass, as in a Solid, a box or a cylinder); a coefficient from 0 to 1, the ratio of angular velocities in the
        direction of the plastic impact; or an object with `velocity_after` and `label`. For a 3D body with friction:
        "housner-3d", "ked-3d", "calibrated-3d", or the coefficient of a landing of the full base.
    friction : float, optional
        Coulomb's coefficient mu between body and ground, from 0 to 1e6 [-]: the body may slide, hop and fly. If None,
        the body only rocks. A `PureRockingWarning` then reports a tensile contact force, together with the response of
        a body that may fly.
    normal_restitution : float
        Coefficient of normal restitution of a plane body, in [0, 1), with friction [-].
    normal_restitution_law : {"newton", "poisson", "stronge"}
        Definition of `normal_restitution`: ratio of normal velocities (Newton), ratio of normal impulses (Poisson), or
        square root of the ratio of the work of the normal impulses (Stronge). The definitions differ if sliding stops
        or reverses during an impact. Stronge's law replaces a law that would create energy or has no solution.
    gravity : float
        Acceleration of gravity [m/s2].
    engine : {"auto", "fast", "reference"}
        Engine. `Response.engine` names the engine that was used. The fast engine applies to plane bodies without
        friction, to stacks and to 3D bodies with friction.
    linear, rest_speed, most_events, longest_step, order, tolerance
        Settings of the integration: see `PlaneSettings`, `ContactSettings`, `SpaceSettings` and `HullSettings` for
        defaults and limits.
    angular_velocity : float, or array_like of shape (3,) in space
        Initial angular velocity theta'; for a 3D body three components in axes of the ground [rad/s].
    start : Start or SpatialStart, optional
        Initial position and velocity, instead of rotation and angular_velocity. With friction, the start also has a
        height and other velocities.
    duration : float, optional
        Duration [s]. By default, the response ends 15 / p (with friction 15 sqrt(R / g)) after the ground motion. If
        the body still rocks, the response is extended, up to 300 / p (300 sqrt(R / g)) after the ground motion, except
        for a body without energy loss at impacts. The summary includes a motion that continues at the end. With
        friction, a rotation beyond the slenderness angle extends the response until the outcome is known. The response
        of a 3D body with friction is extended until the body rests. A response on an isolated base is not extended; the
        outcome includes later overturning.
    stream : int
        Number of the history, for random coefficients.
    scale : float
        Factor on all components of the motion [-].
    rotation : float
        Initial rotation theta; for a 3D body the tilt towards x [rad].

    Returns
    -------
    Response, ContactResponse, StackResponse, SpatialResponse or HullResponse
        Response of a plane body, a plane body with friction, a stack, a 3D body, or a 3D body with friction: motion,
        impacts, outcome and other results.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or an option does not apply to the body.
    MissingExtraError
        If engine="fast" and the engine was not built.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=0.5, height=2.0)
    >>> pulse = rk.pulses.sine(amplitude=3.0, period=0.6)
    >>> rk.simulate(block, pulse, restitution="housner").outcome.name
    'ROCKED'
    >>> squat = rk.simulate(rk.Block(width=1.0, height=1.0), rk.pulses.rectangular(4.0, 0.5), friction=0.3)
    >>> squat.outcome.name, bool(squat.sliding_distance > 0.0)
    ('SLID', True)
    >>> box = rk.dynamics.SpatialBody.box(width=0.5, depth=0.5, height=2.0)
    >>> response = rk.simulate(box, {"x": pulse, "y": pulse.scaled(0.4)}, "housner")
    >>> response.outcome.name, response.intervals[1][2].name
    ('ROCKED', 'EDGE')
    >>> rk.simulate(box, {"x": pulse, "y": pulse.scaled(0.4)}, "housner", friction=0.2).outcome.name
    'SLID'
    """
    return _follow(body, lambda mechanics: mechanics.motion(motion), restitution, friction=friction, **options)


@overload
def free_rocking(
    body: Body, rotation: float = 0.0, restitution: Any = DEFAULT_RESTITUTION, *, friction: None = None,
    **options: Unpack[HistoryOptions],
) -> Response: ...  # fmt: skip
@overload
def free_rocking(
    body: Body, rotation: float = 0.0, restitution: Any = DEFAULT_RESTITUTION, *, friction: float,
    **options: Unpack[HistoryOptions],
) -> "ContactResponse": ...  # fmt: skip
@overload
def free_rocking(
    body: "Stack", rotation: Any = 0.0, restitution: Any = DEFAULT_RESTITUTION, *, friction: None = None,
    **options: Unpack[HistoryOptions],
) -> "StackResponse": ...  # fmt: skip
@overload
def free_rocking(
    body: "BodyInSpace", rotation: float = 0.0, restitution: Any = DEFAULT_RESTITUTION, *, friction: None = None,
    **options: Unpack[HistoryOptions],
) -> "SpatialResponse": ...  # fmt: skip
@overload
def free_rocking(
    body: "BodyInSpace", rotation: float = 0.0, restitution: Any = DEFAULT_RESTITUTION, *, friction: float,
    **options: Unpack[HistoryOptions],
) -> "HullResponse": ...  # fmt: skip
def free_rocking(
    body: Any,
    rotation: float = 0.0,
    restitution: Any = DEFAULT_RESTITUTION,
    *,
    friction: float | None = None,
    **options: Any,
) -> Any:
    """Return the response of a body with an initial rotation or velocity on ground at rest.

    Parameters
    ----------
    body : Body, Stack, Solid or SpatialBody
        As for `simulate`.
    rotation : float, or array_like of shape (bodies,) for a stack
        Initial rotation theta of a plane body, positive to the right, or tilt of a 3D body towards x [rad].
    restitution : str, RestitutionModel, float, mapping or ImpactLaw
        As for `simulate`.
    friction : float, optional
        As for `simulate` [-].
    **options
        Other options of `simulate`, without scale. By default, the response ends when the body rests or has overturned,
        and after 300 / p at most (with friction after 60 sqrt(R / g), on an isolated base after 100 / p).

    Returns
    -------
    Response, ContactResponse, StackResponse, SpatialResponse or HullResponse
        As for `simulate`; the motion is None.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or an option does not apply to the body.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0)
    >>> response = rk.free_rocking(block, rotation=0.5 * block.slenderness_angle, restitution=0.9, gravity=9.81)
    >>> round(4.0 * float(response.impacts["time"][0]), 9)
    2.793372816
    >>> from rocking.dynamics import SpatialBody, SpatialStart
    >>> tilted = SpatialStart(tilt=0.1, azimuth=0.25 * 3.141592653589793)  # corner to opposite corner: r = 59 / 71
    >>> first = rk.free_rocking(SpatialBody.box(1.0, 1.0, 4.0), restitution="housner", start=tilted).impacts[0]
    >>> round(float((first["energy_after"] / first["energy_before"]) ** 0.5) / 59.0 * 71.0, 12)
    1.0
    """
    return _follow(
        body, lambda mechanics: mechanics.at_rest, restitution, friction=friction, rotation=rotation, **options
    )


def _follow(
    body: Any, motion: Callable[[Mechanics], Any], restitution: Any, *, scale: float = 1.0, start: Any = None,
    rotation: float = 0.0, angular_velocity: Any = 0.0, duration: float | None = None, **options: Any,
) -> Any:  # fmt: skip
    mechanics = mechanics_for(body, options["friction"])
    initial = mechanics.begun(start, rotation, angular_velocity)
    settings, own_options = mechanics.split(options, mechanics.settings, mechanics.options)
    return mechanics.follow(
        body, motion(mechanics), restitution, settings, start=initial, scale=scale, duration=duration, **own_options
    )
