"""The file of one response."""

from typing import Any, Literal

from pydantic import Field, model_validator

from rocking.conventions import DEFAULT_FRICTION, DEFAULT_RESTITUTION
from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, key
from rocking.spec.motion_tables import ComponentsTable
from rocking.spec.restitution_tables import RestitutionTable
from rocking.spec.settings_tables import BOUNCE_LAW, SettingsTable


class ResponseTable(JobTable):
    """How the body starts, and on what it stands."""

    initial_rotation: float | None = key(
        "no motion: initial rotation over the slenderness angle; above 0 to the right (x), below 0 to the left [-]"
    )
    friction: float | None = key("coefficient of friction; enables sliding [-]", None, gt=0.0)
    normal_restitution: float | None = key("with friction: coefficient of normal restitution, from 0 [-]", None, ge=0.0)
    normal_restitution_law: Literal["newton", "poisson", "stronge"] | None = key(BOUNCE_LAW)
    start_height: float | None = key(
        "with friction: initial height of the lowest point, from which the body drops [m]", None, ge=0.0
    )
    start_velocity: list[float] | None = key(
        "with friction: initial velocity of the lowest point; x and up for a plane body, x, y and up for a solid [m/s]"
    )
    assumed_friction: float = Field(
        gt=0.0,
        default_factory=lambda: DEFAULT_FRICTION,
        description="without friction: what pure rocking is compared with; 0.5 if not given [-]",
    )

    @property
    def dropped(self) -> bool:
        """Whether the body starts above the ground, or in motion."""
        return bool(self.start_height) or any(self.start_velocity or ())


class ResponseTables(JobTable):
    """What every document of a response has, wherever its body and motion come from."""

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
    """Refuse a document in which nothing moves the body, and one with both a motion and an initial rotation."""
    if moved and start.initial_rotation is not None:
        raise InvalidValueError("Use a motion or response.initial_rotation, not both.")
    if not moved and start.initial_rotation is None and not start.dropped:
        raise InvalidValueError("No ground motion. Add a motion, or response.initial_rotation such as 0.5.")


class ResponseDocument(ResponseTables):
    """A file that describes one response."""

    body: dict[str, Any]
    motion: ComponentsTable | None = None

    @model_validator(mode="after")
    def _moves(self) -> "ResponseDocument":
        check_start(self.motion is not None, self.response)
        return self
