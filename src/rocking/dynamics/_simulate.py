"""The front door: how does a body rock under a motion, and how when it is let go."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from rocking import checks, conventions, errors
from rocking.bodies import Body
from rocking.dynamics.response import Response, response_of_rocking
from rocking.dynamics.settings import Settings, in_space
from rocking.errors import InvalidValueError, PureRockingWarning
from rocking.motions.components import Components, with_vertical
from rocking.motions.motion import GroundMotion, checked_level
from rocking.motions.pulse import Motion, Pulse

if TYPE_CHECKING:
    from rocking.bodies.solid import Solid
    from rocking.dynamics.contact import ContactResponse, Start
    from rocking.dynamics.hull.response import HullResponse
    from rocking.dynamics.space import SpatialBody, SpatialResponse, SpatialStart

Component = GroundMotion | Pulse | None
AnyMotion = Motion | Mapping[str, Motion] | tuple[Component, ...]
"""A motion along x, or components by direction, or in the order x, y, z."""


@overload
def simulate(
    body: Body, motion: AnyMotion, restitution: Any = "ked", *, friction: None = None, **options: Any
) -> Response: ...
@overload
def simulate(
    body: Body, motion: AnyMotion, restitution: Any = "ked", *, friction: float, **options: Any
) -> "ContactResponse": ...
@overload
def simulate(
    body: "Solid | SpatialBody", motion: AnyMotion, restitution: Any = "ked", *, friction: None = None, **options: Any
) -> "SpatialResponse": ...
@overload
def simulate(
    body: "Solid | SpatialBody", motion: AnyMotion, restitution: Any = "ked", *, friction: float, **options: Any
) -> "HullResponse": ...
def simulate(  # type: ignore[misc]  # noqa: PLR0913 - the overloads name what the answer hangs on
    body: Any,
    motion: Any,
    restitution: Any = "ked",
    *,
    friction: float | None = None,
    bounce: float = 0.0,
    bounce_law: str = "newton",
    scale: float = 1.0,
    rotation: float = 0.0,
    angular_velocity: Any = 0.0,
    start: "Start | SpatialStart | None" = None,
    gravity: float = conventions.g,
    duration: float | None = None,
    engine: str = "auto",
    stream: int = 0,
    linear: bool = False,
    rest_speed: float | None = None,
    most_events: int = 100_000,
    longest_step: float | None = None,
    order: int | None = None,
    tolerance: float | None = None,
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
        `label`. In space with friction "housner-3d", "ked-3d" or the coefficient of a landing of the whole base, not
        below Housner's.
    friction : float, optional
        Coulomb's coefficient mu between body and ground, from 0 to 1e6 [-]: the body may slide, hop and fly. If not
        given, it rocks alone, and a `PureRockingWarning` says where the ground would have to pull, and what the body
        then does.
    bounce : float
        Coefficient of normal restitution of a plane body, in [0, 1), with friction [-].
    bounce_law : {"newton", "poisson", "stronge"}
        What `bounce` is the ratio of: normal velocities (Newton), normal impulses (Poisson), or, squared, the work of
        the normal impulses (Stronge). They differ where sliding stops or turns during an impact. Where Newton's or
        Poisson's would create energy, or has no solution, Stronge's stands in.
    scale : float
        Factor on all components of the motion [-].
    rotation, angular_velocity : float
        theta [rad] and theta' [rad/s] at the start; how far a body in space leans towards x, and its angular velocity,
        three numbers in axes of the ground.
    start : Start or SpatialStart, optional
        Instead of these: a plane body, with friction also lifted or pushed along, or how a body in space leans.
    gravity : float
        Acceleration of gravity [m/s2].
    duration : float, optional
        How long to follow the body [s]; if not given, the motion and 15 / p (with friction 15 sqrt(R / g)) after it,
        and where the body then still rocks until it rests, at most 300 / p (300 sqrt(R / g)) after the motion. A body
        whose impacts lose no energy never rests: it is followed for 15 / p alone. The summary states whether the body
        still rocks.
        With friction, one that leans beyond its slenderness angle then is followed, on ground at rest, until it lies or
        leans less: `outcome` needs it. In space with friction until it rests.
    engine : {"auto", "fast", "reference"}
        Which engine; which one ran is in `Response.engine`. The fast one is for rocking alone, and for bodies in space
        with friction.
    stream : int
        Number of the history, for random coefficients.
    linear, rest_speed, most_events, longest_step, order, tolerance
        How to integrate: see `Settings`.

    Returns
    -------
    Response, ContactResponse, SpatialResponse or HullResponse
        Of a plane body, of one with friction, of one in space, of that with friction: motion, impacts, outcome and
        more.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or these mechanics do not know it.
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
    settings = {
        "gravity": gravity, "linear": linear, "rest_speed": rest_speed, "most_events": most_events,
        "longest_step": longest_step, "order": order, "tolerance": tolerance,
    }  # fmt: skip
    return _followed(
        body, components_of(motion) if in_space(body) else in_plane(motion), restitution, settings, friction=friction,
        bounce=bounce, bounce_law=bounce_law, rotation=rotation, angular_velocity=angular_velocity, start=start,
        engine=engine, stream=stream, scale=scale, duration=duration,
    )  # fmt: skip


@overload
def free_rocking(
    body: Body, rotation: float = 0.0, restitution: Any = "ked", *, friction: None = None, **options: Any
) -> Response: ...
@overload
def free_rocking(
    body: Body, rotation: float = 0.0, restitution: Any = "ked", *, friction: float, **options: Any
) -> "ContactResponse": ...
@overload
def free_rocking(
    body: "Solid | SpatialBody",
    rotation: float = 0.0,
    restitution: Any = "ked",
    *,
    friction: None = None,
    **options: Any,
) -> "SpatialResponse": ...
@overload
def free_rocking(
    body: "Solid | SpatialBody", rotation: float = 0.0, restitution: Any = "ked", *, friction: float, **options: Any
) -> "HullResponse": ...
def free_rocking(  # type: ignore[misc]  # noqa: PLR0913 - as for `simulate`
    body: Any,
    rotation: float = 0.0,
    restitution: Any = "ked",
    *,
    friction: float | None = None,
    bounce: float = 0.0,
    bounce_law: str = "newton",
    angular_velocity: Any = 0.0,
    start: "Start | SpatialStart | None" = None,
    gravity: float = conventions.g,
    duration: float | None = None,
    engine: str = "auto",
    stream: int = 0,
    linear: bool = False,
    rest_speed: float | None = None,
    most_events: int = 100_000,
    longest_step: float | None = None,
    order: int | None = None,
    tolerance: float | None = None,
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
    friction, bounce : float, optional
        As for `simulate` [-].
    bounce_law : {"newton", "poisson", "stronge"}
        As for `simulate`.
    angular_velocity : float, or array_like of shape (3,) in space
        theta' at the start, in space in axes of the ground [rad/s].
    start : Start or SpatialStart, optional
        Instead of rotation and angular_velocity.
    gravity : float
        Acceleration of gravity [m/s2].
    duration : float, optional
        How long to follow the body [s]; if not given, until it rests or lies, or 300 / p; with friction 60 sqrt(R / g).
    engine : {"auto", "fast", "reference"}
        Which engine.
    stream : int
        Number of the history, for random coefficients.
    linear, rest_speed, most_events, longest_step, order, tolerance
        How to integrate: see `Settings`.

    Returns
    -------
    Response, ContactResponse, SpatialResponse or HullResponse
        As of `simulate`; the motion is None.

    Raises
    ------
    InvalidValueError
        If a value is outside its range, or these mechanics do not know it.

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
    settings = {
        "gravity": gravity, "linear": linear, "rest_speed": rest_speed, "most_events": most_events,
        "longest_step": longest_step, "order": order, "tolerance": tolerance,
    }  # fmt: skip
    return _followed(
        body, (None, None, None) if in_space(body) else None, restitution, settings, friction=friction, bounce=bounce,
        bounce_law=bounce_law, rotation=rotation, angular_velocity=angular_velocity, start=start, engine=engine,
        stream=stream, duration=duration,
    )  # fmt: skip


def _followed(  # noqa: PLR0913 - what the two questions have in common
    body: Any,
    motion: Any,
    restitution: Any,
    settings: dict[str, Any],
    *,
    friction: float | None,
    bounce: float,
    bounce_law: str,
    rotation: float,
    angular_velocity: Any,
    start: Any,
    engine: str,
    stream: int,
    **how: Any,
) -> Any:
    if start is not None and (np.any(rotation) or np.any(angular_velocity)):
        raise InvalidValueError("give either start or rotation and angular_velocity, got both")
    if in_space(body):
        from rocking.dynamics.space.attitude import SpatialStart
        from rocking.dynamics.space.body import SpatialBody
        from rocking.dynamics.space.response import response_in_space

        if friction is None:
            body = SpatialBody.of(body)
        refuse("a body in space", bounce=bounce, bounce_law=bounce_law, stream=stream)
        if not np.ndim(angular_velocity) and angular_velocity:
            raise InvalidValueError("angular_velocity of a body in space must be three numbers [rad/s], got one")
        spin = angular_velocity if np.ndim(angular_velocity) else (0.0, 0.0, 0.0)
        leaning = _start(start, SpatialStart) or SpatialStart(rotation, angular_velocity=spin)
        if friction is not None:
            from rocking.dynamics.hull.response import response_on_hull

            own = Settings(**settings, mechanics="space with friction", friction=friction)
            return response_on_hull(body, motion, restitution, own, start=leaning, engine=engine, **how)
        refuse("a body in space without friction", engine=engine)
        return response_in_space(
            body, motion, restitution, Settings(**settings, mechanics="space"), start=leaning, **how
        )
    if friction is not None:
        from rocking.dynamics.contact.base import Start
        from rocking.dynamics.contact.response import response_with_contact

        refuse("a body with friction", engine=engine, stream=stream)
        return response_with_contact(
            body, motion, friction, restitution, Settings(**settings, mechanics="contact"), bounce=bounce,
            bounce_law=bounce_law, start=_start(start, Start) or Start(rotation, angular_velocity), **how,
        )  # fmt: skip
    refuse("a body without friction=, which rocks alone", bounce=bounce, bounce_law=bounce_law)
    if start is not None:
        from rocking.dynamics.contact.base import Start

        rotation, angular_velocity = rocking_start(_start(start, Start))
    response = response_of_rocking(
        body, motion, restitution, Settings(**settings), rotation=rotation, angular_velocity=angular_velocity,
        engine=engine, stream=stream, **how,
    )  # fmt: skip
    for sentence in () if errors.silenced(PureRockingWarning) else response.doubts():
        errors.warn(sentence, PureRockingWarning)
    return response


_USUAL: dict[str, tuple[Any, ...]] = {
    "friction": (None,), "bounce": (0.0,), "bounce_law": ("newton",), "engine": ("auto", "reference"),
    "stream": (0,), "start": (None,), "twin": (False,), "threads": (None,), "duration": (None,), "rotation": (0.0,),
    "angular_velocity": (0.0,),
}  # fmt: skip


def refuse(what: str, **options: Any) -> None:
    """Refuse what these mechanics do not know."""
    for name, value in options.items():
        if np.ndim(value) or not any(value is usual or value == usual for usual in _USUAL[name]):
            raise InvalidValueError(f"{name} is nothing for {what}, got {value!r:.60}")


def rocking_start(start: "Start") -> tuple[float, float]:
    """Return theta [rad] and theta' [rad/s] of a start; one that lifts or pushes the body along is refused."""
    if not start.rocks_alone:
        raise InvalidValueError(
            "without friction= a start has rotation and angular_velocity alone, since the body neither slides nor "
            f"flies, got {start!r}"
        )
    return start.rotation, start.angular_velocity


def _start(start: Any, kind: type) -> Any:
    if start is not None and not isinstance(start, kind):
        raise InvalidValueError(f"start must be a {kind.__name__}(...), got {start!r:.60}")
    return start


_HOW = 'a GroundMotion, a pulse, or {"x": ..., "y": ..., "z": ...} of these'


def components_of(motion: Any) -> tuple[Component, Component, Component]:
    """Return the components of a motion, of a mapping from x, y and z, or of a tuple in that order.

    The vertical part of a record along x is its z.

    >>> [part is None for part in components_of({"z": GroundMotion([0.0, 1.0], 0.1)})]
    [True, True, False]
    """
    if isinstance(motion, Components):
        motion = motion.parts
    if isinstance(motion, Mapping):
        unknown = [name for name in motion if name not in ("x", "y", "z")]
        if unknown:
            raise InvalidValueError(f"a component of the motion is x, y or z, got {unknown[0]!r:.60}")
        motion = tuple(motion.get(name) for name in "xyz")
    parts = motion if isinstance(motion, (tuple, list)) else (motion,)
    if len(parts) > 3:
        raise InvalidValueError(f"a motion has at most three components, x, y and z, got {len(parts)}")
    for part in parts:
        if not isinstance(part, (GroundMotion, Pulse)) and part is not None:
            raise InvalidValueError(f"motion must be {_HOW}, got {checks.given('motion', part)}")
    if all(part is None for part in parts):
        raise InvalidValueError(f"motion must be {_HOW}, got none; free_rocking lets a body go on ground at rest")
    x, y, z = (*parts, None, None)[:3]
    if isinstance(x, GroundMotion) and x.vertical is not None:
        if z is not None:
            raise InvalidValueError("the vertical motion is given twice: by the vertical part of x, and by z")
        z = x.changed("its vertical part", acceleration=x.vertical, vertical=None)
        x = x.changed("its horizontal part", vertical=None)
    return checked_level(x), checked_level(y), z


def together(motion: Any, *, plane: bool = False) -> Any:
    """Return a motion of one component as it is, of several as one of a study: in a plane along x, with its z."""
    if not isinstance(motion, (Mapping, tuple, Components)):
        return checked_level(motion)
    if plane:
        return in_plane(motion)
    return motion if isinstance(motion, Components) else Components(*components_of(motion))


def in_plane(motion: Any) -> GroundMotion | Pulse:
    """Return the motion of a plane body: along x, and z as its vertical part."""
    if isinstance(motion, (GroundMotion, Pulse)):
        return checked_level(motion)  # type: ignore[no-any-return]
    x, y, z = components_of(motion)
    if y is not None:
        raise InvalidValueError("a plane body moves along x and z, got y too; Solid.from_section makes it a solid")
    if z is None and x is not None:
        return x
    if not isinstance(z, GroundMotion) or isinstance(x, Pulse):
        raise InvalidValueError("vertical motion of a plane body is a record beside another: two GroundMotion, please")
    if x is None:
        x = z.changed("no horizontal motion", acceleration=0.0 * z.acceleration, metadata={})
    return with_vertical(x, z)
