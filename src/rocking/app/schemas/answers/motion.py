"""What is said of a motion."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer


class MotionSeries(Answer):
    """The curves of a motion, as many samples of each, every extreme among them."""

    time: list[float] = Field(description="[s]")
    acceleration: list[float] = Field(description="[m/s2]")
    velocity: list[float] = Field(description="[m/s]")
    displacement: list[float] = Field(description="[m]")
    vertical: list[float] | None = Field(None, description="vertical acceleration, where there is one [m/s2]")
    shown: int = Field(description="samples here")
    of: int = Field(description="samples of the motion")


class SpectrumFacts(Answer):
    """The response of oscillators to a motion."""

    damping_ratio: float = Field(description="[-]")
    period: list[float] = Field(description="[s]")
    acceleration: list[float] = Field(description="pseudo-acceleration [m/s2]")
    velocity: list[float] = Field(description="pseudo-velocity [m/s]")
    displacement: list[float] = Field(description="[m]")
    absolute_acceleration: list[float] = Field(description="[m/s2]")


class MeasureFacts(Answer):
    """One intensity measure."""

    name: str = Field(description="short name: pga, pgv, ...")
    value: float = Field(description="in `unit`")
    unit: str
    words: str


class MotionAnswered(Answer):
    """What a motion is, how strong, and its curves."""

    kind: Literal["record", "pulse"]
    name: str
    format: str | None
    event: str | None
    station: str | None
    component: str | None
    vertical_component: str | None
    file_unit: str | None = Field(description="unit of the file; the answer is in SI")
    samples: int | None = Field(description="of a record")
    time_step_s: float | None = Field(description="of a record [s]")
    duration_s: float = Field(description="[s]")
    warnings: list[str] = Field(description="what was hardly meant, in sentences; none if all is well")
    provenance: list[str] = Field(description="what was done to it, in order")
    peak_vertical_acceleration_m_s2: float | None = Field(description="[m/s2]")
    intensity: dict[str, float] = Field(description="measures, with their units in the names")
    scale: float = Field(description="factor on the motion, which is in every number here [-]")
    peak_acceleration_m_s2: float = Field(description="[m/s2]")
    series: MotionSeries
    spectrum: SpectrumFacts | None = Field(description="null where it was not asked for")
    measures: list[MeasureFacts]
