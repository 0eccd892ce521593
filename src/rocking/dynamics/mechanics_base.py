"""Interface of a mechanics: its bodies and settings, and functions for one history, many histories and studies."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ImpactLaw
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.messages import Range
from rocking.motions.components import Components, components_of, in_plane

if TYPE_CHECKING:
    import xarray as xr

    from rocking.dynamics.response_base import ResponseBase
    from rocking.dynamics.rows import RowRunner

Sample = tuple[list[Any], ImpactLaw, Settings]
"""Motions, law and settings of test histories. Their results identify the rounding of an engine."""

UNCHANGED: dict[str, tuple[Any, ...]] = {
    "friction": (None,), "normal_restitution": (0.0,), "normal_restitution_law": ("newton",),
    "linear": (False,), "rest_speed": (None,),
    "longest_step": (None,), "order": (None,), "tolerance": (None,), "engine": ("auto", "reference"), "stream": (0,),
    "start": (None,), "scale": (1.0,), "rotation": (0.0,), "angular_velocity": (0.0,), "duration": (None,),
    "threads": (None,), "twin": (False,), "progress": (None,),
}  # fmt: skip
"""Neutral values of options, default first. A mechanics accepts these values even for options that it does not have."""


def in_space(body: Any) -> bool:
    """Return True for a 3D body, which has a base instead of two feet."""
    return not isinstance(body, (Body, np.ndarray)) and hasattr(body, "base")


def listed(value: Any) -> list[Any]:
    """Return a sequence as a list, and any other value as a list with one item."""
    return list(value) if isinstance(value, Sequence) and not isinstance(value, str) else [value]


def row_of(name: str, values: Any) -> FloatArray:
    """Return numbers as a one-dimensional array. The numbers must be finite and within 1e6."""
    row = np.atleast_1d(checks.real_array(name, values))
    if row.ndim != 1 or not row.size:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter=name,
            allowed="one number or a row of numbers", shape=row.shape,
        )  # fmt: skip
    bad = np.flatnonzero(~(np.abs(row) <= 1e6))
    if bad.size:
        raise InvalidValueError(
            "{parameter} must be finite and within 1e6, got {value} at index {index}", parameter=name,
            allowed=Range(-1e6, 1e6), value=float(row[bad[0]]), index=int(bad[0]),
        )  # fmt: skip
    return row


def frictions_of(friction: Any) -> FloatArray:
    """Return coefficients of friction as a one-dimensional array; empty for None."""
    return np.empty(0) if friction is None else row_of("friction", friction)


@dataclass(frozen=True)
class Combinations:
    """Arguments of `simulate_many`: all combinations of bodies, motions, scales, restitutions and frictions."""

    bodies: Any
    motions: Any
    restitutions: list[Any]
    scales: Any  # scale factors [-]
    frictions: FloatArray  # coefficients of friction [-]; empty without friction
    start: Any = None
    rotation: Any = 0.0
    angular_velocity: Any = 0.0
    duration: float | None = None
    engine: str = "auto"
    threads: int | None = None
    twin: bool = False
    progress: Callable[[int], None] | None = None


class Mechanics(ABC):
    """A mechanics: equations of motion, and the bodies and settings to which the equations apply."""

    name: ClassVar[str]  # identifier
    in_plane: ClassVar[bool] = True  # True if the ground motion has one horizontal component only
    slides: ClassVar[bool] = False  # True if bodies slide, hop and fly; the restitution may then be None
    has_restitution: ClassVar[bool] = True  # False if the body itself states its restitution
    is_compared: ClassVar[bool] = False  # True if studies compare restitutions, linear equations and engines
    title: ClassVar[str]  # title of the mechanics, a noun
    subject: ClassVar[str]  # description of its bodies in messages
    settings: ClassVar[type[Settings]]
    options: ClassVar[frozenset[str]] = frozenset()  # options of `follow` besides settings, start and duration
    # options of `follow_many` besides settings
    batch_options: ClassVar[frozenset[str]] = frozenset({"start", "duration", "engine", "threads", "progress"})
    at_rest: ClassVar[Any] = None  # argument of `follow` for ground at rest

    @property
    def batch_settings(self) -> type[Settings]:
        """Class of the settings of `follow_many`."""
        return self.settings

    @abstractmethod
    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        """Return True if the mechanics applies to a body.

        `friction` is a coefficient or None; `study` is True in a study.
        """

    @abstractmethod
    def motion(self, motion: Any) -> Any:
        """Return a motion of the user in the form for `follow`. Raise an error if the motion is not allowed."""

    @abstractmethod
    def start_class(self) -> type:
        """Return the class of the start of a body."""

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        """Return the start of a body from its rotation [rad] and angular velocity [rad/s]."""
        return self.start_class()(rotation, angular_velocity)

    @abstractmethod
    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: Any, *, start: Any, **options: Any
    ) -> "ResponseBase":
        """Return the response of one body. `options` contains scale, duration, and options of the mechanics."""

    @property
    @abstractmethod
    def columns(self) -> tuple[str, ...]:
        """Names of the variables that `follow_many` fills."""

    @abstractmethod
    def follow_many(self, combinations: Combinations, settings: Any) -> "xr.Dataset":
        """Return the results of every combination."""

    def study_settings(self, body: Any, options: Mapping[str, Any]) -> Settings:
        """Return the settings of a study of a body. Raise an error for unknown options."""
        return self.split(options, self.settings, frozenset())[0]

    @property
    def study_columns(self) -> Mapping[str, Any]:
        """Data types of the results of the rows of a study, by name."""
        from rocking.dynamics.plane.fast_engine import RESULTS

        return RESULTS

    def uplift_accelerations(
        self, settings: Settings, sides: Mapping[str, FloatArray], tangent: Callable[[FloatArray], FloatArray] = np.tan
    ) -> FloatArray:
        """Return the ground accelerations of uplift about the right and the left foot [m/s2], shape (2, n)."""
        angles = np.stack([sides["alpha_right"], sides["alpha_left"]])
        return np.asarray(settings.gravity * (angles if settings.linear else tangent(angles)))  # Eq. 25

    def rows(self, motions: Sequence[Any], law: Any, settings: Any, engine: str) -> "RowRunner":
        """Return the object that computes the rows of a study."""
        raise InvalidValueError("studies do not accept {subject}", subject=self.subject)

    def parameters(self, body: Any, restitution: Any, settings: Settings) -> RockingParameters:
        """Return the parameters of a body with its restitution, for the rows of a study."""
        return RockingParameters.of_body(body, restitution, settings.gravity, may_be_none=self.slides)

    def check_motions(self, motions: Sequence[Any]) -> None:
        """Raise an error if the mechanics does not apply to a motion of a study."""
        if any(isinstance(motion, Components) for motion in motions):
            raise InvalidValueError("a plane body needs a motion with one horizontal component, got several")

    def engine_of_study(self, *, fast: bool) -> str:
        """Return the name of the engine of a study. `fast` is True if the compiled engine was used."""
        return "fast" if fast else "reference"

    def samples(self, pulses: list[Any], flat: list[Any], upright: list[Any]) -> list[Sample]:
        """Return test histories that identify the rounding of the engine: pulses, and records without and with z."""
        return []

    def sample_rows(self, values: dict[str, Any]) -> dict[str, Any]:
        """Return the rows of the test histories, limited to values that the mechanics accepts."""
        return values

    def instruction_set(self) -> str:
        """Return the instruction set on which the rounding of the engine depends; empty if there is no dependence."""
        return ""

    def begun(self, start: Any, rotation: Any, angular_velocity: Any) -> Any:
        """Return the start of a body: `start` if stated, otherwise from rotation and angular velocity."""
        if start is None:
            return self.start_of(rotation, angular_velocity)
        if np.any(rotation) or np.any(angular_velocity):
            raise InvalidValueError("use start, or rotation and angular_velocity, not both")
        kind = self.start_class()
        if not isinstance(start, kind):
            raise InvalidValueError(parameter="start", allowed=f"a {kind.__name__}(...)", value=start)
        return start

    def split(
        self, options: Mapping[str, Any], kind: type[Settings], own: frozenset[str]
    ) -> tuple[Settings, dict[str, Any]]:
        """Return the settings and the other options of the mechanics. Raise an error for unknown options."""
        names = kind.names()
        self.refuse_others(options, {*names, *own})
        stated = {name: value for name, value in options.items() if value is not None or None not in _neutral(name)}
        settings = kind(**{name: stated[name] for name in names if name in stated})
        return settings, {name: stated[name] for name in own if name in stated}

    def refuse_others(self, options: Mapping[str, Any], allowed: set[str]) -> None:
        """Raise an error for options that the mechanics does not have, unless their values are neutral."""
        for name, value in options.items():
            if name not in allowed and not _is_neutral(name, value):
                raise InvalidValueError(
                    "{parameter} does not apply to {subject}, got {value}; options: {options}", parameter=name,
                    value=value, subject=self.subject, options=", ".join(sorted(allowed)),
                )  # fmt: skip


class PlaneMechanics(Mechanics):
    """Mechanics of plane bodies, with starts of class `Start`."""

    def motion(self, motion: Any) -> Any:
        """Return the motion along x, with the motion along z as vertical component."""
        return in_plane(motion)

    def start_class(self) -> type:
        """Return the class of starts of plane bodies."""
        from rocking.dynamics.plane_frictional.base import Start

        return Start


class RockingMechanics(PlaneMechanics):
    """Mechanics of plane bodies that only rock: the start is a rotation and an angular velocity."""

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        """Return rotation and angular velocity; their limits depend on the body and are checked later."""
        return rotation, angular_velocity

    def begun(self, start: Any, rotation: Any, angular_velocity: Any) -> Any:
        """Return rotation and angular velocity at the start. Raise an error for a start above the ground."""
        from rocking.dynamics.plane_frictional.base import rocking_start

        begun = super().begun(start, rotation, angular_velocity)
        return begun if start is None else rocking_start(begun)


class SpatialMechanics(Mechanics):
    """Mechanics of 3D bodies, with starts of class `SpatialStart`."""

    in_plane, at_rest = False, (None, None, None)

    def motion(self, motion: Any) -> Any:
        """Return the components along x, y and z."""
        return components_of(motion)

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        """Return the start of a body that is tilted towards x."""
        if not np.ndim(angular_velocity) and angular_velocity:
            raise InvalidValueError("angular_velocity of a body in space must be three numbers [rad/s], got one")
        spin = angular_velocity if np.ndim(angular_velocity) else (0.0, 0.0, 0.0)
        return self.start_class()(rotation, angular_velocity=spin)

    def start_class(self) -> type:
        """Return the class of starts of 3D bodies."""
        from rocking.dynamics.rolling.attitude import SpatialStart

        return SpatialStart


def _is_neutral(name: str, value: Any) -> bool:
    values = _neutral(name)  # distinguish 0 from False
    return any(value is option for option in values) or (not np.ndim(value) and name != "linear" and value in values)


def _neutral(name: str) -> tuple[Any, ...]:
    return UNCHANGED.get(name, ())
