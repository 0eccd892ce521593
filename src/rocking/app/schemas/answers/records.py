"""What is said of record files."""

from typing import Literal

from pydantic import Field

from rocking.app.schemas.answers.answer import Answer

Need = Literal["format", "units", "time_step", "component"]


class RecordKept(Answer):
    """A file that is kept."""

    record: str = Field(description="SHA-256 of its bytes, by which inputs name it")
    file_name: str = Field(description="the name it was given, made harmless")
    bytes: int = Field(description="its length [bytes]")
    uploaded: str = Field(description="when, in UTC")


class ComponentFacts(Answer):
    """One component of a record; null is what the file does not say."""

    name: str
    samples: int
    unit: str | None = Field(description="of acceleration in the file")
    time_step_s: float | None = Field(description="[s]")
    duration_s: float | None = Field(description="[s]")
    peak_m_s2: float | None = Field(description="largest acceleration [m/s2]")


class RecordFacts(RecordKept):
    """What a record file holds, and what must still be told."""

    format: str | None = Field(description="null where no format fits")
    components: list[ComponentFacts]
    needs: list[Need] = Field(description="what must still be told before it can be used")
    choices: dict[Need, list[str]] = Field(description="what may be told")
    message: str = Field(description="why, in a sentence; empty if nothing is missing")


class Deleted(Answer):
    """What is no longer there."""

    deleted: str = Field(description="its name in addresses")
