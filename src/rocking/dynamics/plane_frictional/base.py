"""Data of a body on two feet for the planar equations, per unit of mass (docs/theory/contact.md, Feet)."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.bodies.frame import refuse_frame
from rocking.errors import InvalidValueError
from rocking.outcome import Regime

LEFT, RIGHT = -1, 1
BOTH = (LEFT, RIGHT)


@dataclass(frozen=True)
class PlaneBase:
    """Inertia of a body and positions of its feet relative to the centre of mass."""

    mass: float  # m [kg]
    inertia: float  # polar moment of inertia about the centre, divided by the mass, I_C / m [m2]
    height: float  # height h of the centre above the ground at rest [m]
    left: float  # left, right: horizontal distances of the feet from the centre, both above zero [m]
    right: float

    @classmethod
    def of_body(cls, body: Body) -> "PlaneBase":
        checks.of_kind("body", body, Body, "a Block, Section or MassPoints")
        refuse_frame(body)
        left, right = body.side("left"), body.side("right")
        mass = body.mass
        if not body.moment_of_inertia > 0.0:
            raise InvalidValueError(
                "with friction a body needs a moment of inertia about its centre of mass above 0; distribute its mass"
            )
        return cls(mass, body.moment_of_inertia / mass, right.centre_height, left.half_width, right.half_width)

    @property
    def width(self) -> float:
        """Distance between the feet [m]."""
        return self.left + self.right

    @property
    def size(self) -> float:
        """Larger distance from a foot to the centre [m]."""
        return math.hypot(max(self.left, self.right), self.height)

    def lever(self, foot: int) -> float:
        """Return the lever d of a foot; negative for the left foot [m]."""
        return self.right if foot > 0 else -self.left

    def slenderness_angle(self, foot: int) -> float:
        """Return alpha = atan(b / h) of a side [rad]."""
        return math.atan2(abs(self.lever(foot)), self.height)

    def arm(self, foot: int, rotation: float) -> tuple[float, float]:
        """Return the position of a foot relative to the centre, to the right and upwards [m].

        `rotation` is theta [rad].
        """
        d, sine, cosine = self.lever(foot), math.sin(rotation), math.cos(rotation)
        return d * cosine - self.height * sine, -d * sine - self.height * cosine  # Eq. 58

    def rise_on(self, foot: int, rotation: float) -> float:
        """Return the rise of the centre on one foot, d sin(theta) - 2 h sin(theta / 2)^2 [m], exactly zero at rest."""
        return self.lever(foot) * math.sin(rotation) - 2.0 * self.height * math.sin(0.5 * rotation) ** 2  # Eq. 59


class Mode(NamedTuple):
    """Contact conditions of one smooth piece of the motion."""

    feet: tuple[int, ...]  # feet in contact: none, -1 (left), +1 (right) or both
    slip: int = 0  # direction of sliding: -1, 0 (sticking) or +1

    @property
    def regime(self) -> Regime:
        """Regime of the mode."""
        if not self.feet:
            return Regime.FLIGHT
        if len(self.feet) == 2:
            return Regime.SLIDE if self.slip else Regime.REST
        return Regime.SLIDE_ROCK if self.slip else Regime.ROCK

    @property
    def carrier(self) -> str:
        """Feet in contact: ``"none"``, ``"left"``, ``"right"`` or ``"both"``."""
        return {(): "none", (LEFT,): "left", (RIGHT,): "right", BOTH: "both"}[self.feet]


REST = Mode(BOTH)
FLIGHT = Mode(())


class ContactState(NamedTuple):
    """Position and velocity of the body."""

    # x, rise, rotation: displacement of the centre of mass from its initial position, to the right [m] and upwards
    # [m], and theta [rad]
    x: float = 0.0
    rise: float = 0.0
    rotation: float = 0.0
    u: float = 0.0  # u, w, spin: their rates [m/s, m/s, rad/s]
    w: float = 0.0
    spin: float = 0.0
    touching: tuple[int, ...] = BOTH  # feet with zero gap


def along(base: PlaneBase, state: ContactState, foot: int) -> float:
    """Return the velocity of a foot along the ground, to the right [m/s]. Exactly zero for a sticking foot."""
    return state.u + base.arm(foot, state.rotation)[1] * state.spin  # Eq. 60


def away(base: PlaneBase, state: ContactState, foot: int) -> float:
    """Return the velocity of a foot away from the ground, upwards [m/s]. Exactly zero for a foot at rest."""
    return state.w - base.arm(foot, state.rotation)[0] * state.spin  # Eq. 61


def kept(base: PlaneBase, state: ContactState, feet: tuple[int, ...], *, stick: bool) -> ContactState:
    """Return a state that satisfies the contact conditions exactly: ``v_n = 0``, and ``v_t = 0`` if the feet stick."""
    if not feet:
        return state
    if len(feet) == 2:
        u = 0.0 if stick else along(base, state, feet[0])
        return ContactState(state.x, 0.0, 0.0, u, 0.0, 0.0, feet)
    (foot,) = feet
    r_x, r_z = base.arm(foot, state.rotation)
    u = -(r_z * state.spin) if stick else state.u
    return state._replace(rise=base.rise_on(foot, state.rotation), u=u, w=r_x * state.spin)


def kinetic(base: PlaneBase, state: ContactState) -> float:
    """Return the kinetic energy relative to the ground per mass, (x'^2 + z'^2 + (I_C / m) theta'^2) / 2 [J/kg]."""
    return 0.5 * (state.u**2 + state.w**2 + base.inertia * state.spin**2)  # Eq. 62


@dataclass(frozen=True)
class Start:
    """Start of a plane body: position and velocity at time zero, relative to the ground.

    Parameters
    ----------
    rotation : float
        theta, within a quarter turn [rad]. The lower foot is on the ground unless `height` is given.
    angular_velocity : float
        theta' [rad/s].
    horizontal_velocity : float
        Velocity of the lower foot, to the right [m/s].
    height : float
        Height of the lower foot above the ground [m].
    vertical_velocity : float
        Velocity of the lower foot, upwards [m/s].

    Raises
    ------
    InvalidValueError
        If a value is not finite, the rotation is beyond a quarter turn, or the height is negative.

    Notes
    -----
    Without friction, only `rotation` and `angular_velocity` are allowed, because the body does not slide or fly.

    Examples
    --------
    >>> Start(rotation=0.1).height
    0.0
    """

    rotation: float = 0.0
    angular_velocity: float = 0.0
    horizontal_velocity: float = 0.0
    height: float = 0.0
    vertical_velocity: float = 0.0

    def __post_init__(self) -> None:
        half = 0.5 * math.pi
        checks.within(
            "rotation", self.rotation, -half, half, unit="rad", open_low=True, open_high=True, hint="in radians"
        )
        checks.within("angular_velocity", self.angular_velocity, -1e4, 1e4, unit="rad/s", hint="in radians")
        checks.within("horizontal_velocity", self.horizontal_velocity, -1e4, 1e4, unit="m/s")
        checks.within("height", self.height, 0.0, 1e4, unit="m", hint="the ground is at zero")
        checks.within("vertical_velocity", self.vertical_velocity, -1e4, 1e4, unit="m/s")

    @property
    def rocks_alone(self) -> bool:
        """True if the lower foot is at rest on the ground, as for a body without friction."""
        return not (self.horizontal_velocity or self.height or self.vertical_velocity)


def rocking_start(start: Start) -> tuple[float, float]:
    """Return theta [rad] and theta' [rad/s] of a start. Raise an error for a height or another velocity."""
    if not start.rocks_alone:
        raise InvalidValueError(
            "without friction= {parameter} has rotation and angular_velocity only, since the body neither slides "
            "nor flies, got {value}", parameter="start", value=start,
        )  # fmt: skip
    return start.rotation, start.angular_velocity


def starts_of(start: Any, rotation: Any = 0.0, angular_velocity: Any = 0.0) -> list[Start] | None:
    """Return the starts of plane bodies, from `start` or from numbers or arrays; None if no start is stated."""
    stated = np.ndim(rotation) or np.ndim(angular_velocity) or rotation != 0.0 or angular_velocity != 0.0
    if start is None:
        return _starts_of_numbers(rotation, angular_velocity) if stated else None
    if stated:
        raise InvalidValueError("use start, or rotation and angular_velocity, not both")
    starts = list(start) if isinstance(start, (list, tuple)) else [start]
    if not starts:
        raise InvalidValueError("start must be at least one Start(...), got none")
    for k, item in enumerate(starts):
        if not isinstance(item, Start):
            raise InvalidValueError(
                parameter="start" if item is start else f"start[{k}]", allowed="a Start(...) or a list of these",
                value=item,
            )  # fmt: skip
    return starts


def _starts_of_numbers(rotation: Any, angular_velocity: Any) -> list[Start]:
    rows = [
        np.atleast_1d(checks.real_array(name, values, unit))
        for name, values, unit in (("rotation", rotation, "rad"), ("angular_velocity", angular_velocity, "rad/s"))
    ]
    shapes = [row.shape for row in rows]
    if any(row.ndim != 1 or not row.size for row in rows) or len(set(shapes) - {(1,)}) > 1:
        raise InvalidValueError(
            "rotation and angular_velocity must be numbers, or rows of equal length with one entry per start, got "
            "shapes {rotation} and {angular_velocity}", rotation=shapes[0], angular_velocity=shapes[1],
        )  # fmt: skip
    return [Start(*values) for values in zip(*(row.tolist() for row in np.broadcast_arrays(*rows)), strict=True)]


def state_at_start(start: Start, base: PlaneBase) -> ContactState:
    """Return the initial state of the centre of mass. The origin of x is the upright body on the same foot."""
    direction = start.rotation or start.angular_velocity
    foot = RIGHT if direction > 0.0 else LEFT
    r_x, r_z = base.arm(foot, start.rotation)
    touching: tuple[int, ...] = ()
    if start.height == 0.0:
        touching = BOTH if start.rotation == 0.0 else (foot,)
    spin = start.angular_velocity
    return ContactState(
        base.lever(foot) - r_x,
        base.rise_on(foot, start.rotation) + start.height,
        start.rotation,
        start.horizontal_velocity - r_z * spin,
        start.vertical_velocity + r_x * spin,
        spin,
        touching,
    )
