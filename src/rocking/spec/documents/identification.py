"""The file of an identification."""

import math
from typing import Any, Literal

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Positive, Text, key
from rocking.spec.motion_tables import OneMotionTable


class MeasurementTable(JobTable):
    """What was measured of a body that rocks freely: a file, or a folder in which every file is a trial."""

    file: Text = Field(description="sound, video, table of times or rotations, or a folder of them")
    kind: str | None = key("sound, video, times, rotation, displacement, angular velocity or acceleration")
    column: str | None = key("name of the column, where a table has several")
    unit: str | None = key("unit of the column, where the table states none")
    time_column: str | None = key("name of the column of times; that called time if not given")
    time_unit: str | None = key("unit of the times, s or ms, where the table states none")
    height: Positive | None = key("height of the sensor above the base, for a displacement or an acceleration [m]")
    region: list[float] | None = key(
        "of a video, where the body is at rest, if not found by what moves: left, top, width, height [pixels]"
    )
    frame_rate: Positive | None = key("of a video played more slowly than it was taken, as it was taken [1/s]")


class IdentifyTable(JobTable):
    """What is known beside a measurement; everything that is left out has its usual value."""

    size_error: float | None = key("standard deviation of a length of the body, relative; 0.01 if not given [-]")
    tilt: float | list[float] | None = key(
        "standard deviation of the tilt of the floor, or [tilt, deviation], clockwise; 0.0052 if not given [rad]"
    )
    asymmetry: float | None = key("standard deviation of ln r landing right less left; 0.06 if not given [-]")
    trend: bool | None = key("fit a change of r with the speed")
    damping: bool | None = key("fit damping between impacts")
    clock: float | list[float] | None = key(
        "under a motion: standard deviation of the clock against that of the motion, or [ahead, deviation]; 0.02 [s]"
    )
    first: Literal["left", "right"] | None = key("foot on which it stands after the first impact, of times")


class IdentificationDocument(JobTable):
    """A file that asks what a measurement says of the coefficient of restitution."""

    body: dict[str, Any] | None = None
    measurement: MeasurementTable
    motion: OneMotionTable | None = None
    identify: IdentifyTable = Field(default_factory=IdentifyTable)

    @model_validator(mode="before")
    @classmethod
    def _pairs(cls, stated: Any) -> Any:
        known = stated.get("identify") if isinstance(stated, dict) else None
        known = known if isinstance(known, dict) else {}
        for name in {"tilt", "clock"} & set(known):
            pair = given if isinstance(given := known[name], list) else [given, 0.0]
            if len(pair) != 2 or not all(type(each) in {int, float} and abs(each) < math.inf for each in pair):
                raise InvalidValueError(
                    "{parameter} is one number, or a value and its deviation, got {value}",
                    parameter=f"identify.{name}", value=given,
                )  # fmt: skip
        return stated

    @model_validator(mode="after")
    def _of_two_clocks(self) -> "IdentificationDocument":
        if self.identify.clock is not None and self.motion is None:
            raise InvalidValueError("identify.clock goes with [motion]: it is of both clocks")
        return self
