"""Tables of settings: gravity, equations, engine, and the ground of studies."""

from typing import Any, Literal

from rocking.spec.fields import JobTable, Positive, key

BOUNCE_LAW = (
    "definition of normal_restitution: ratio of normal velocities (newton), of impulses (poisson), or root of the "
    "ratio of energies (stronge)"
)
BOUNCE_RANGE = ">= 0, < 1"  # of all laws; the mechanics check the upper limit


class SettingsTable(JobTable):
    """Settings of the integration."""

    gravity: Positive | None = key("acceleration of gravity [m/s2]")
    linear: bool | None = key("linear equations of a slender body")
    rest_speed: float | None = key("dimensionless speed below which the body comes to rest [-]")
    most_events: int | None = key("largest number of impacts and contact changes of one history")
    longest_step: float | None = key("longest time step, as p times the time [-]")
    order: int | None = key("order of the Taylor series", allowed="4, 6, 8; 2 to 40 in 3D")
    tolerance: float | None = key("largest size of the last two terms of a Taylor step [-]")
    engine: Literal["auto", "fast", "reference"] = key("computation engine", "auto")

    def stated(self) -> dict[str, Any]:
        """Return the stated settings without the engine, as keywords of `Settings`."""
        return self.model_dump(exclude={"engine"}, exclude_none=True)


class StudySettingsTable(SettingsTable):
    """Settings of the integration, and of the contact in studies; the table of a response has its own contact keys."""

    friction: float | None = key("coefficient of friction; enables sliding [-]", None, usual="no sliding", ge=0.0)
    normal_restitution: float | None = key(
        "with friction: coefficient of normal restitution [-]", None, allowed=BOUNCE_RANGE, ge=0.0
    )
    normal_restitution_law: Literal["newton", "poisson", "stronge"] | None = key(BOUNCE_LAW)
