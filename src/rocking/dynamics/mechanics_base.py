"""What one mechanics offers: which bodies it takes, its settings, one history, many histories, rows of a study."""

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
"""Laid out motions, law and settings of some histories by which the last digits of an engine are told."""

UNCHANGED: dict[str, tuple[Any, ...]] = {
    "friction": (None,), "bounce": (0.0,), "bounce_law": ("newton",), "linear": (False,), "rest_speed": (None,),
    "longest_step": (None,), "order": (None,), "tolerance": (None,), "engine": ("auto", "reference"), "stream": (0,),
    "start": (None,), "scale": (1.0,), "rotation": (0.0,), "angular_velocity": (0.0,), "duration": (None,),
    "threads": (None,), "twin": (False,), "progress": (None,),
}  # fmt: skip
"""Values of options that change nothing, the default first: also the mechanics that lack an option take them."""


def in_space(body: Any) -> bool:
    """Return whether a body is one in space: it has a base to stand on, not two feet."""
    return not isinstance(body, (Body, np.ndarray)) and hasattr(body, "base")


def listed(value: Any) -> list[Any]:
    """Return a sequence as a list, anything else as a list of one."""
    return list(value) if isinstance(value, Sequence) and not isinstance(value, str) else [value]


def row_of(name: str, values: Any) -> FloatArray:
    """Return one number or several as a row of finite numbers."""
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
    """Return one coefficient of friction or several as a row, which is empty without any."""
    return np.empty(0) if friction is None else row_of("friction", friction)


@dataclass(frozen=True)
class Combinations:
    """What `simulate_many` computes, as users give it: every body under every motion at every scale, and so on."""

    bodies: Any
    motions: Any
    restitutions: list[Any]
    scales: Any  # [-]
    frictions: FloatArray  # none without friction [-]
    start: Any = None
    rotation: Any = 0.0
    angular_velocity: Any = 0.0
    duration: float | None = None
    engine: str = "auto"
    threads: int | None = None
    twin: bool = False
    progress: Callable[[int], None] | None = None


class Mechanics(ABC):
    """One way in which bodies move."""

    name: ClassVar[str]  # one word
    in_plane: ClassVar[bool] = True  # whether a body has one horizontal motion
    slides: ClassVar[bool] = False  # whether bodies slide, hop and fly; a restitution may then be none
    is_compared: ClassVar[bool] = False  # whether restitutions are compared, with linear equations too and two engines
    title: ClassVar[str]  # as a noun
    subject: ClassVar[str]  # bodies that move like this, in messages
    settings: ClassVar[type[Settings]]
    options: ClassVar[frozenset[str]] = frozenset()  # of `follow`, beside settings, start and duration
    # of `follow_many`, beside settings
    batch_options: ClassVar[frozenset[str]] = frozenset({"start", "duration", "engine", "threads", "progress"})
    at_rest: ClassVar[Any] = None  # ground at rest as a motion of `follow`

    @property
    def batch_settings(self) -> type[Settings]:
        """Class of the settings of `follow_many`."""
        return self.settings

    @abstractmethod
    def takes(self, body: Any, friction: Any, *, study: bool = False) -> bool:
        """Return whether a body moves like this, with friction or with None; study: in a study."""

    @abstractmethod
    def motion(self, motion: Any) -> Any:
        """Return what a user gives as the motion in the form that `follow` takes, or refuse it."""

    @abstractmethod
    def start_class(self) -> type:
        """Return the class that states how a body starts."""

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        """Return how a body starts, from the rotation [rad] and the angular velocity [rad/s]."""
        return self.start_class()(rotation, angular_velocity)

    @abstractmethod
    def follow(
        self, body: Any, motion: Any, restitution: Any, settings: Any, *, start: Any, **options: Any
    ) -> "ResponseBase":
        """Return one history; options: scale, duration, and those of the mechanics."""

    @property
    @abstractmethod
    def columns(self) -> tuple[str, ...]:
        """Names of the variables that `follow_many` fills."""

    @abstractmethod
    def follow_many(self, combinations: Combinations, settings: Any) -> "xr.Dataset":
        """Return every combination."""

    def rows(self, motions: Sequence[Any], law: Any, settings: Any, engine: str) -> "RowRunner":
        """Return what computes the rows of a study."""
        raise InvalidValueError("studies do not take {subject}", subject=self.subject)

    def parameters(self, body: Any, restitution: Any, settings: Settings) -> RockingParameters:
        """Return a body with its restitution, as the rows of a study take it."""
        return RockingParameters.of_body(body, restitution, settings.gravity, may_be_none=self.slides)

    def check_laid_out(self, motions: Sequence[Any]) -> None:
        """Refuse motions of a study that these mechanics do not take."""
        if any(isinstance(motion, Components) for motion in motions):
            raise InvalidValueError("a motion of several components is for bodies in space; a plane body takes one")

    def engine_of_study(self, *, fast: bool) -> str:
        """Return which engine computes the rows of a study, in words; fast: whether the compiled one ran."""
        return "fast" if fast else "reference"

    def samples(self, pulses: list[Any], flat: list[Any], upright: list[Any]) -> list[Sample]:
        """Return histories that tell the last digits of the engine, of pulses and of records without and with z."""
        return []

    def sample_rows(self, values: dict[str, Any]) -> dict[str, Any]:
        """Return the rows of these histories, limited to what these mechanics take."""
        return values

    def instruction_set(self) -> str:
        """Return the instruction set that decides last digits of the compiled engine, if it has several."""
        return ""

    def begun(self, start: Any, rotation: Any, angular_velocity: Any) -> Any:
        """Return how a body starts: the start that is stated, or one of rotation and angular velocity."""
        if start is None:
            return self.start_of(rotation, angular_velocity)
        if np.any(rotation) or np.any(angular_velocity):
            raise InvalidValueError("give either start or rotation and angular_velocity, got both")
        kind = self.start_class()
        if not isinstance(start, kind):
            raise InvalidValueError(parameter="start", allowed=f"a {kind.__name__}(...)", value=start)
        return start

    def split(
        self, options: Mapping[str, Any], kind: type[Settings], own: frozenset[str]
    ) -> tuple[Settings, dict[str, Any]]:
        """Return the settings, and the other options that these mechanics have; refuse what they have not."""
        names = kind.names()
        self.refuse_others(options, {*names, *own})
        stated = {name: value for name, value in options.items() if value is not None or None not in _usual(name)}
        settings = kind(**{name: stated[name] for name in names if name in stated})
        return settings, {name: stated[name] for name in own if name in stated}

    def refuse_others(self, options: Mapping[str, Any], allowed: set[str]) -> None:
        """Refuse options that these mechanics do not have, unless they change nothing."""
        for name, value in options.items():
            if name not in allowed and not _changes_nothing(name, value):
                raise InvalidValueError(
                    "{parameter} does not apply to {subject}, got {value}; options: {options}", parameter=name,
                    value=value, subject=self.subject, options=", ".join(sorted(allowed)),
                )  # fmt: skip


class PlaneMechanics(Mechanics):
    """Mechanics of plane bodies, which start as `Start` states."""

    def motion(self, motion: Any) -> Any:
        """Return the motion along x, and z as its vertical part."""
        return in_plane(motion)

    def start_class(self) -> type:
        """Return the class of starts in a plane."""
        from rocking.dynamics.contact.base import Start

        return Start


class SpatialMechanics(Mechanics):
    """Mechanics of bodies in space, which start as `SpatialStart` states."""

    in_plane, at_rest = False, (None, None, None)

    def motion(self, motion: Any) -> Any:
        """Return the components along x, y and z."""
        return components_of(motion)

    def start_of(self, rotation: Any, angular_velocity: Any) -> Any:
        """Return how a body that leans towards x starts."""
        if not np.ndim(angular_velocity) and angular_velocity:
            raise InvalidValueError("angular_velocity of a body in space must be three numbers [rad/s], got one")
        spin = angular_velocity if np.ndim(angular_velocity) else (0.0, 0.0, 0.0)
        return self.start_class()(rotation, angular_velocity=spin)

    def start_class(self) -> type:
        """Return the class of starts in space."""
        from rocking.dynamics.space.attitude import SpatialStart

        return SpatialStart


def _changes_nothing(name: str, value: Any) -> bool:
    usual = _usual(name)  # 0 is not False
    return any(value is each for each in usual) or (not np.ndim(value) and name != "linear" and value in usual)


def _usual(name: str) -> tuple[Any, ...]:
    return UNCHANGED.get(name, ())
