"""What is said of studies: state, progress, and the history behind a point."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer
from rocking.app.schemas.answers.response import ResponseFacts
from rocking.app.schemas.inputs import Inputs


class StudyFacts(Answer):
    """State and progress of a study."""

    id: str = Field(description="its name in addresses")
    name: str
    kind: str
    created: str = Field(description="when, in UTC")
    histories: int = Field(description="of an adaptive study those that are known so far")
    state: Literal["waiting", "running", "cancelled", "interrupted", "failed", "done"]
    message: str = Field(description="a sentence on the state; empty where there is nothing to say")
    histories_done: int
    rate: float | None = Field(description="while it runs [1/s]")
    seconds_left: float | None = Field(description="while it runs; null while that is measured, or cannot be known [s]")
    seconds_left_between: tuple[float, float] | None = Field(description="between which it probably is [s]")


class Studies(Answer):
    """All studies, the newest first."""

    studies: list[StudyFacts]


class Launched(Answer):
    """A study that was put in line."""

    id: str = Field(description="its name in addresses")


class StoredHistory(Answer):
    """What a study has of one history, to the last digit."""

    history: int = Field(description="its number")
    meaning: str = Field(description="the mode in words")
    outcome: int
    mode: int = Field(description="-3 not computed, -2 not lifted, -1 stands, n >= 0 overturns after n impacts")
    impacts: int
    peak_rotation_rad: float | None = Field(description="null if it was not computed [rad]")
    peak_rotation_over_alpha: float | None = Field(description="null if it was not computed [-]")
    overturning_time_s: float | None = Field(description="null if it stands [s]")


class Cell(Answer):
    """The history behind a point of the picture of a study."""

    stored: StoredHistory
    inputs: Inputs | None = Field(description="what to ask for the same history; null where inputs cannot say it")
    answer: ResponseFacts | None = Field(description="null where there is no response")
    difference_rad: float | None = Field(description="between the peaks of `stored` and `answer` [rad]")
    note: str = Field(description="on what is missing; empty if nothing is")
