"""The problem of a response, one body and its motion, from the tables of an input file, and the result."""

import math
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rocking import checks, plausibility
from rocking.bodies import PLANE_BODIES
from rocking.conventions import DEFAULT_FRICTION, DEFAULT_RESTITUTION
from rocking.dynamics import SpatialBody, SpatialStart, Start, free_rocking, simulate
from rocking.dynamics.mechanics import mechanics_for, mechanics_of
from rocking.dynamics.mechanics_base import Mechanics
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, PureRockingWarning, located
from rocking.motions.components import together
from rocking.spec.bodies import body_for_motion
from rocking.spec.construction import components_of, motion_of, restitutions_of
from rocking.spec.fields import Angle
from rocking.spec.reading import InputFiles

if TYPE_CHECKING:
    from rocking.spec.documents.response import ResponseDocument, ResponseTables


@dataclass(frozen=True, slots=True)
class ResponseProblem:
    """Body, motion, restitutions and settings of a response."""

    body: Any  # a `Body` or a `Solid`
    motion: Any  # unscaled motion, for a 3D body a mapping from axes to motions; None for free rocking
    restitutions: dict[str, Any] = field(
        default_factory=lambda: {DEFAULT_RESTITUTION: DEFAULT_RESTITUTION}
    )  # restitutions by label, with values as in `simulate`
    settings: Settings = field(default_factory=PlaneSettings)  # settings of mechanics and integration
    engine: str = "auto"
    assumed_friction: float = DEFAULT_FRICTION  # coefficient of friction for the sliding check [-]
    initial_rotation: float | None = None  # initial rotation / slenderness angle of its side [-]
    start_height: float = 0.0  # height of the lowest point above the ground, with friction [m]
    start_velocity: tuple[float, ...] = ()  # velocity of the lowest point: (x, up) in 2D, (x, y, up) in 3D [m/s]
    scale: float = 1.0  # scale factor of the motion [-]

    def __post_init__(self) -> None:
        """Check the values that the engines do not check."""
        plausibility.warn(plausibility.of_friction(checks.positive("friction", self.assumed_friction)))
        if self.initial_rotation is not None:
            checks.number("initial_rotation", self.initial_rotation)
        if self.motion is not None and self.initial_rotation is not None:
            raise InvalidValueError("Use a motion or initial_rotation, not both.")
        if self.motion is None and self.initial_rotation is None and not self.dropped:
            raise InvalidValueError("No ground motion. Add a motion, initial_rotation, start_height or start_velocity.")
        if self.start_velocity and len(self.start_velocity) != len(self.axes):
            raise InvalidValueError(
                parameter="start_velocity", allowed=f"{len(self.axes)} numbers, {', '.join(self.axes)} [m/s]",
                value=list(self.start_velocity),
            )  # fmt: skip

    @property
    def mechanics(self) -> Mechanics:
        """Mechanics of the settings."""
        return mechanics_of(self.settings)

    @property
    def balance_angle(self) -> float:
        """Slenderness angle on the side of `initial_rotation` [rad]."""
        return _balance_angle(self.body, right=self.initial_rotation is None or self.initial_rotation > 0.0)

    @property
    def rotation(self) -> float:
        """Initial rotation, positive to the right [rad]."""
        return 0.0 if self.initial_rotation is None else float(self.initial_rotation * self.balance_angle)

    @property
    def axes(self) -> tuple[str, ...]:
        """Axes of the initial velocity."""
        return ("x", "up") if isinstance(self.body, PLANE_BODIES) else ("x", "y", "up")

    @property
    def dropped(self) -> bool:
        """True if the body starts above the ground, or with a velocity."""
        return bool(self.start_height) or any(self.start_velocity)

    @property
    def start(self) -> SpatialStart | Start:
        """Initial position and velocity. A 3D body is tilted towards +x, or towards -x if `initial_rotation` < 0."""
        velocity = self.start_velocity or (0.0,) * len(self.axes)
        if isinstance(self.body, PLANE_BODIES):
            x, up = velocity
            return Start(self.rotation, horizontal_velocity=x, height=self.start_height, vertical_velocity=up)
        azimuth = 0.0 if self.rotation >= 0.0 else math.pi
        return SpatialStart(abs(self.rotation), azimuth, height=self.start_height, velocity=velocity)

    def answer(self, restitution: Any = ...) -> Any:
        """Return the response with one restitution, by default the first."""
        law = next(iter(self.restitutions.values())) if restitution is ... else restitution
        options: dict[str, Any] = dict(self.settings.stated)
        if "engine" in self.mechanics.options:
            options["engine"] = self.engine
        with warnings.catch_warnings():  # the output of the response contains these warnings
            warnings.simplefilter("ignore", PureRockingWarning)
            if self.initial_rotation is not None or self.dropped:
                options["start"] = self.start
            if self.motion is None:
                return free_rocking(self.body, restitution=law, **options)
            return simulate(self.body, self.motion, law, scale=self.scale, **options)


def _balance_angle(body: Any, *, right: bool) -> float:
    """Return the slenderness angle of a body on one side, in 3D towards +x or -x [rad]."""
    if isinstance(body, PLANE_BODIES):
        return body.side("right" if right else "left").slenderness_angle
    space = SpatialBody.of(body)
    sign, (x, _, height) = 1.0 if right else -1.0, space.centre.tolist()
    ends = [space.radius] if space.round else (sign * space.vertices[:, 0]).tolist()
    return math.atan2(max(ends) - sign * x, height)


def _in_slenderness_angles(rotation: float | Angle | None, body: Any) -> float | None:
    """Return an initial rotation as a fraction of the slenderness angle."""
    if not isinstance(rotation, Angle):
        return rotation
    return rotation.radians / _balance_angle(body, right=rotation.radians > 0.0)


def problem_of(
    tables: "ResponseTables", body: Any, motion: Any, *, scale: float | None = None, inputs: InputFiles | None = None
) -> ResponseProblem:
    """Return the simulation problem of tables, body and motion. `scale` replaces the scale factor of the tables."""
    table, start = getattr(tables, "motion", None), tables.response
    mechanics = mechanics_for(body, start.friction)
    ground = start.model_dump(include={"friction", "normal_restitution", "normal_restitution_law"}, exclude_none=True)
    with located("response"):
        mechanics.refuse_others(ground, {*mechanics.settings.names()})
        if start.dropped and not mechanics.slides:
            raise InvalidValueError(
                "start_height and start_velocity need friction. Add response.friction, or remove them."
            )
    if not mechanics.is_compared:
        _refuse(f"{mechanics.title} has no sliding check", start, {"assumed_friction"})
        _refuse(f"{mechanics.title} has one engine with the nonlinear equations", tables.settings, {"linear", "engine"})
    with located("settings"):
        settings, _ = mechanics.split(tables.settings.stated() | ground, mechanics.settings, frozenset())
    restitutions: dict[str, Any] = {DEFAULT_RESTITUTION: DEFAULT_RESTITUTION}
    if mechanics.has_restitution:
        restitutions = restitutions_of(tables.restitution, 0, [body], inputs, mechanics=mechanics)
    elif "restitution" in tables.model_fields_set:
        raise InvalidValueError(
            "{subject} has its own restitution. Remove {parameter}.", parameter="restitution", subject=mechanics.subject
        )
    if not mechanics.is_compared and len(restitutions) > 1:
        names = ", ".join(restitutions)
        raise InvalidValueError(
            "{mechanics} accepts one restitution model, got {names}.", parameter="restitution",
            mechanics=mechanics.title, names=names,
        )  # fmt: skip
    return ResponseProblem(
        body,
        motion,
        restitutions,
        settings,
        engine=tables.settings.engine,
        assumed_friction=start.assumed_friction,
        initial_rotation=_in_slenderness_angles(start.initial_rotation, body),
        start_height=start.start_height or 0.0,
        start_velocity=tuple(start.start_velocity or ()),
        scale=scale if scale is not None else 1.0 if table is None else table.scale,
    )


def _refuse(reason: str, table: Any, keys: set[str]) -> None:
    stated = [name for name in type(table).model_fields if name in keys & table.model_fields_set]
    if any(getattr(table, name) not in {None, False} for name in stated):
        raise InvalidValueError("{reason}. Remove {keys}.", reason=reason, keys=", ".join(stated))


def response_problem(document: "ResponseDocument", files: InputFiles, *, in_space: bool = False) -> ResponseProblem:
    """Return the simulation problem of an input file.

    `files` records the named files; `in_space` requires a 3D body.
    """
    table = document.motion
    with located("body"):
        turned = in_space or (table is not None and table.y is not None)
        body = body_for_motion(document.body, files, in_space=turned, with_stacks=True)
    motion: Any = None
    with located("motion"):
        if table is not None:
            several = components_of(table, files) if table.components else motion_of(table, files)
            motion = together(several, plane=True) if isinstance(body, PLANE_BODIES) else several
    return problem_of(document, body, motion, inputs=files)
