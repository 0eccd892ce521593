"""The file of an identification."""

import math
from typing import Any, Literal

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.identification.readers.reader import KINDS
from rocking.spec.fields import JobTable, Positive, Text, key
from rocking.spec.motion_tables import OneMotionTable


class MeasurementTable(JobTable):
    """Measurement of a freely rocking body: a file, or a folder with one file per trial."""

    file: Text = key(
        "sound file, video, table of times or rotations, or folder of such files", ..., allowed="an existing path"
    )
    kind: str | None = key(
        "kind of measurement: sound, video, times, rotation, displacement, angular velocity or acceleration",
        usual="from the extension, or the unit of the column", allowed=", ".join(KINDS),
    )  # fmt: skip
    column: str | None = key(
        "name of the measured column, for a table with several columns", usual="the only column besides the times",
        allowed="a name in the header",
    )  # fmt: skip
    unit: str | None = key(
        "unit of the column, for a table without unit", usual="unit in the header", allowed="a unit of the kind"
    )
    time_column: str | None = key("name of the column of times", usual="time", allowed="a name in the header")
    time_unit: str | None = key(
        "unit of the times, s or ms, for a table without unit", usual="unit in the header", allowed="s, ms"
    )
    height: Positive | None = key(
        "height of the sensor above the base, for displacement or acceleration [m]",
        usual="required for displacement or acceleration",
    )
    region: list[float] | None = key(
        "video: region of the body at rest as left, top, width, height [pixels]", usual="detected from the movement",
        allowed="4 numbers within the picture",
    )  # fmt: skip
    frame_rate: Positive | None = key(
        "frame rate of the camera, for a video in slow motion [1/s]", usual="frame rate of the file"
    )


class IdentifyTable(JobTable):
    """Standard deviations and options of an identification."""

    size_error: float | None = key(
        "relative standard deviation of the body dimensions [-]", None, usual="0.01", ge=0.0, le=0.2
    )
    tilt: float | list[float] | None = key(
        "standard deviation of the floor tilt, or [tilt, deviation], positive clockwise [rad]", usual="0.0052",
        allowed="tilt >= -0.1, <= 0.1; deviation >= 0, <= 0.1",
    )  # fmt: skip
    asymmetry: float | None = key(
        "standard deviation of ln r on the right minus ln r on the left [-]", None, usual="0.06", ge=0.0, le=1.0
    )
    trend: bool | None = key("fit of a linear change of r with the impact velocity", usual="false")
    damping: bool | None = key("fit of a damping between impacts", usual="false")
    clock: float | list[float] | None = key(
        "with a motion: standard deviation of the time offset between both clocks, or [offset, deviation] [s]",
        usual="0.02", allowed="any offset; deviation >= 0, <= 10",
    )  # fmt: skip
    first: Literal["left", "right"] | None = key("times: contact foot after the first impact", usual="right")


class IdentificationDocument(JobTable):
    """Input file of an identification."""

    body: dict[str, Any] | None = None
    measurement: MeasurementTable
    motion: OneMotionTable | None = None
    identify: IdentifyTable = Field(default_factory=IdentifyTable)

    @model_validator(mode="before")
    @classmethod
    def _pairs(cls, stated: Any) -> Any:
        identify = stated.get("identify") if isinstance(stated, dict) else None
        identify = identify if isinstance(identify, dict) else {}
        for name in {"tilt", "clock"} & set(identify):
            pair = value if isinstance(value := identify[name], list) else [value, 0.0]
            if len(pair) != 2 or not all(type(number) in {int, float} and abs(number) < math.inf for number in pair):
                raise InvalidValueError(
                    "{parameter} must be a number, or a value and its standard deviation, got {value}.",
                    parameter=f"identify.{name}", value=value,
                )  # fmt: skip
        return stated

    @model_validator(mode="after")
    def _of_two_clocks(self) -> "IdentificationDocument":
        if self.identify.clock is not None and self.motion is None:
            raise InvalidValueError("identify.clock needs [motion]. Add a motion, or remove the key.")
        return self
