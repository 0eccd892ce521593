"""Tables of settings: gravity, equations, engine, and the ground of studies."""

from typing import Any, Literal

from rocking.spec.fields import JobTable, Positive, key

BOUNCE_LAW = (
    "definition of normal_restitution: ratio of normal velocities (newton), of impulses (poisson), or root of the "
    "ratio of energies (stronge)"
)


class SettingsTable(JobTable):
    """How to integrate: what is left out has its usual value."""

    gravity: Positive | None = key("acceleration of gravity [m/s2]")
    linear: bool | None = key("slender-linear equations")
    rest_speed: float | None = key("speed below which a motion ends at once [-]")
    most_events: int | None = key("a history with more impacts and changes of contact is stopped")
    longest_step: float | None = key("longest Taylor step as p times time [-]")
    order: int | None = key("order of the Taylor series")
    tolerance: float | None = key("bound on the last two terms of a Taylor step [-]")
    engine: Literal["auto", "fast", "reference"] = key("which engine computes", "auto")

    def stated(self) -> dict[str, Any]:
        """Return what was stated, without the engine, as `Settings` takes it."""
        return self.model_dump(exclude={"engine"}, exclude_none=True)


class StudySettingsTable(SettingsTable):
    """How to integrate: what is left out has its usual value. Friction is of studies; one history has its own table."""

    friction: float | None = key("coefficient of friction; enables sliding [-]", None, ge=0.0)
    normal_restitution: float | None = key("with friction: coefficient of normal restitution, from 0 [-]", None, ge=0.0)
    normal_restitution_law: Literal["newton", "poisson", "stronge"] | None = key(BOUNCE_LAW)
