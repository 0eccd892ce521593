"""The file of one response."""

from typing import Any, Literal

from pydantic import Field, field_validator, model_validator

from rocking.conventions import DEFAULT_FRICTION, DEFAULT_RESTITUTION
from rocking.errors import InvalidValueError
from rocking.spec.fields import Angle, JobTable, key
from rocking.spec.motion_tables import ComponentsTable
from rocking.spec.restitution_tables import RestitutionTable
from rocking.spec.settings_tables import BOUNCE_LAW, BOUNCE_RANGE, SettingsTable


class ResponseTable(JobTable):
    """Initial state of the body, and contact with the ground."""

    initial_rotation: float | Angle | None = key(
        "without motion: initial rotation / slenderness angle [-], or with unit: 5deg, 0.1rad; > 0 to the right (+x), "
        "< 0 to the left", unit="slenderness angle, rad or deg",
        allowed="any number: > 1 overturns; an angle in (-90, 90) deg",
    )  # fmt: skip
    friction: float | None = key("coefficient of friction; enables sliding [-]", None, usual="no sliding", gt=0.0)
    normal_restitution: float | None = key(
        "with friction: coefficient of normal restitution [-]", None, usual="0", allowed=BOUNCE_RANGE, ge=0.0
    )
    normal_restitution_law: Literal["newton", "poisson", "stronge"] | None = key(BOUNCE_LAW, usual="newton")
    start_height: float | None = key(
        "with friction: initial height of the lowest point above the ground [m]", None, usual="0", ge=0.0
    )
    start_velocity: list[float] | None = key(
        "with friction: initial velocity of the lowest point, (x, up) of a 2D body, (x, y, up) of a 3D body [m/s]",
        usual="at rest", allowed="2 or 3 numbers",
    )  # fmt: skip
    assumed_friction: float = Field(
        gt=0.0,
        default_factory=lambda: DEFAULT_FRICTION,
        description="coefficient of friction for the sliding check of simulations without sliding [-]",
        json_schema_extra={"usual": f"{DEFAULT_FRICTION:g}"},
    )

    @field_validator("initial_rotation")
    @classmethod
    def _checked_rotation(cls, value: float | str | None) -> float | Angle | None:
        """Return a fraction of the slenderness angle, or an angle."""
        return Angle.of("initial_rotation", value) if isinstance(value, str) else value

    @property
    def dropped(self) -> bool:
        """True if the body starts above the ground, or with a velocity."""
        return bool(self.start_height) or any(self.start_velocity or ())


class ResponseTables(JobTable):
    """Tables of a response other than body and motion."""

    restitution: RestitutionTable = Field(default_factory=lambda: RestitutionTable(model=DEFAULT_RESTITUTION))
    response: ResponseTable = Field(default_factory=ResponseTable)
    settings: SettingsTable = Field(default_factory=SettingsTable)

    @model_validator(mode="after")
    def _coefficient_of_one_history(self) -> "ResponseTables":
        drawn = self.restitution.distribution
        if drawn is not None and drawn.each == "history":
            raise InvalidValueError('restitution.distribution.each must be "impact" for one history, got "history"')
        return self


def check_start(moved: bool, start: ResponseTable) -> None:
    """Raise an error without motion and initial state, or with both motion and initial rotation."""
    if moved and start.initial_rotation is not None:
        raise InvalidValueError("Use a motion or response.initial_rotation, not both.")
    if not moved and start.initial_rotation is None and not start.dropped:
        raise InvalidValueError("No ground motion. Add a motion, or response.initial_rotation such as 0.5.")


class ResponseDocument(ResponseTables):
    """Input file of one response."""

    body: dict[str, Any]
    motion: ComponentsTable | None = None

    @model_validator(mode="after")
    def _moves(self) -> "ResponseDocument":
        check_start(self.motion is not None, self.response)
        return self
