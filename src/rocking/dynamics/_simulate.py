"""The front door: how does a body rock under a motion, and how when it is let go."""

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
    from rocking.bodies.solid import Solid
    from rocking.dynamics.contact import ContactResponse, Start
    from rocking.dynamics.hull.response import HullResponse
    from rocking.dynamics.space import SpatialBody, SpatialResponse, SpatialStart

    BodyInSpace: TypeAlias = Solid | SpatialBody

Called = TypeVar("Called", bound=Callable[..., Any])


class IntegrationOptions(TypedDict, total=False):
    """Options of one history and of many: the ground, and how to integrate."""

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
    """Show the options by name and default in the signature, for help, documentation and completion."""
    defaults: dict[str, Any] = {name: values[0] for name, values in UNCHANGED.items()}
    defaults |= {"gravity": Settings.gravity, "most_events": Settings.most_events}
    signature = inspect.signature(function)
    *known, _ = signature.parameters.values()
    keyword = inspect.Parameter.KEYWORD_ONLY
    options = [inspect.Parameter(name, keyword, default=defaults[name]) for name in MovedOptions.__annotations__]
    function.__signature__ = signature.replace(parameters=[*known, *options])  # type: ignore[attr-defined]
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
    """Return how a body moves under a ground motion.

    A plane body rocks about its feet; with `friction` it may also slide, hop and fly. A body in space turns about the
    edges and vertices of its base, or rolls on its rim, and does not slip; where it would leave the ground, the history
    stops and says so; with `friction` it touches with all vertices of its convex hull, on which it rocks, slides, hops,
    flies and falls into another pose. A round base under two components rolls and has no impacts, so that the
    restitution does not matter; after it has rolled through lying nearly flat, small causes have large effects.

    Parameters
    ----------
    body : Body, Solid or SpatialBody
        A plane body (Block, Section, MassPoints), or one in space, with mass, centre, inertia and base.
    motion : GroundMotion, Pulse, mapping or tuple
        The motion along x; or ``{"x": .., "y": .., "z": ..}``, z upwards, or up to three in that order, all starting at
        time zero. A record is taken as straight lines between its samples, a pulse exactly. A plane body takes x and z.
    restitution : str, RestitutionModel, float, mapping or ImpactLaw
        Model or its name, coefficient, ``{"left": r, "right": r}``, or a law (`SpeedRestitution`,
        `RandomRestitution`). With friction it holds for rocking impacts, theta_dot_after / theta_dot_before without
        slip: it fixes where the resultant of the impulses acts; if that takes more friction than there is, the foot
        slides off under the friction there is. Landings from flight, and with None all impacts, follow from
        complementarity. In space a model of `rocking.restitution.space`, with or without its "-3d" ("ked" needs the
        distribution of mass, which a Solid, a box and a cylinder have), a coefficient from 0 to 1 (that share of the
        angular velocity goes on, in the direction of the plastic impact), or any object with `velocity_after` and
        `label`. In space with friction "housner-3d", "ked-3d", "calibrated-3d" or the coefficient of a landing of the
        whole base.
    friction : float, optional
        Coulomb's coefficient mu between body and ground, from 0 to 1e6 [-]: the body may slide, hop and fly. If not
        given, it rocks alone, and a `PureRockingWarning` says where the ground would have to pull, and what the body
        then does.
    normal_restitution : float
        Coefficient of normal restitution of a plane body, in [0, 1), with friction [-].
    normal_restitution_law : {"newton", "poisson", "stronge"}
        What `normal_restitution` is the ratio of: normal velocities (Newton), normal impulses (Poisson), or, squared,
        the work of the normal impulses (Stronge). They differ where sliding stops or turns during an impact.
        Where Newton's or Poisson's law would create energy, or has no solution, Stronge's law applies.
    gravity : float
        Acceleration of gravity [m/s2].
    engine : {"auto", "fast", "reference"}
        Which engine; which one ran is in `Response.engine`. The fast one is for rocking alone, and for bodies in space
        with friction.
    linear, rest_speed, most_events, longest_step, order, tolerance
        How to integrate: see the settings of the mechanics, `PlaneSettings`, `ContactSettings`, `SpaceSettings` and
        `HullSettings`, which have the defaults and the limits.
    angular_velocity : float, or array_like of shape (3,) in space
        theta' at the start; in space three numbers in axes of the ground [rad/s].
    start : Start or SpatialStart, optional
        Instead of rotation and angular_velocity: a plane body, with friction also lifted or pushed along, or how a body
        in space leans.
    duration : float, optional
        How long to follow the body [s]; if not given, the motion and 15 / p (with friction 15 sqrt(R / g)) after it,
        and where the body then still rocks until it rests, at most 300 / p (300 sqrt(R / g)) after the motion. A body
        whose impacts lose no energy never rests: it is followed for 15 / p alone. The summary states whether the body
        still rocks.
        With friction, one that leans beyond its slenderness angle then is followed, on ground at rest, until it lies or
        leans less: `outcome` needs it. In space with friction until it rests.
    stream : int
        Number of the history, for random coefficients.
    scale : float
        Factor on all components of the motion [-].
    rotation : float
        theta at the start; how far a body in space leans towards x [rad].

    Returns
    -------
    Response, ContactResponse, SpatialResponse or HullResponse
        Of a plane body, of one with friction, of one in space, of that with friction: motion, impacts, outcome and
        more.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the mechanics of the body do not have the option.
    MissingExtraError
        If engine="fast" and it was not built.

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
    """Return how a body moves when it is let go, or pushed, on ground at rest.

    Parameters
    ----------
    body : Body, Solid or SpatialBody
        As for `simulate`.
    rotation : float
        theta of a plane body at the start, positive to the right; how far a body in space leans towards x [rad].
    restitution : str, RestitutionModel, float, mapping or ImpactLaw
        As for `simulate`.
    friction : float, optional
        As for `simulate` [-].
    **options
        All other options of `simulate` but scale. If no duration is given, the body is followed until it rests or lies,
        or for 300 / p; with friction 60 sqrt(R / g).

    Returns
    -------
    Response, ContactResponse, SpatialResponse or HullResponse
        As of `simulate`; the motion is None.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or the mechanics of the body do not have the option.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0)
    >>> response = rk.free_rocking(block, rotation=0.5 * block.slenderness_angle, restitution=0.9, gravity=9.81)
    >>> round(4.0 * float(response.impacts["time"][0]), 9)
    2.793372816
    >>> from rocking.dynamics import SpatialBody, SpatialStart
    >>> leaning = SpatialStart(tilt=0.1, azimuth=0.25 * 3.141592653589793)  # corner to opposite corner: r = 59 / 71
    >>> first = rk.free_rocking(SpatialBody.box(1.0, 1.0, 4.0), restitution="housner", start=leaning).impacts[0]
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
    begun = mechanics.begun(start, rotation, angular_velocity)
    settings, own = mechanics.split(options, mechanics.settings, mechanics.options)
    return mechanics.follow(
        body, motion(mechanics), restitution, settings, start=begun, scale=scale, duration=duration, **own
    )
