"""The one document of everything that a user chose: body, motion, restitution, response and settings."""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, ConfigDict, Field, FiniteFloat, model_validator

from rocking.app.schemas.body import BodyInput
from rocking.app.schemas.caps import MOST_RESTITUTIONS, refuse_more
from rocking.studies.job.response_tables import OneMotionTable, ResponseTables, check_start
from rocking.studies.job.table import JobTable, Words, refused
from rocking.studies.job.tables import SettingsTable

__all__ = [
    "BodyAsked",
    "BodyInput",
    "ImpactAsked",
    "Inputs",
    "MotionAsked",
    "MotionInput",
    "Points",
    "ResponseAsked",
    "ResponseInputs",
    "Window",
]

Hash = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$", description="SHA-256 of an uploaded record")]

Points = Annotated[int, Field(ge=10, le=2000)]
"""Over how many dots curves are drawn; each keeps the lowest and the highest value of every curve."""


def _forward(window: tuple[float, float]) -> tuple[float, float]:
    if window[0] >= window[1]:
        raise ValueError(f"window must be the times between which curves are drawn, got {list(window)}; in this order?")
    return window


Window = Annotated[tuple[FiniteFloat, FiniteFloat], Field(strict=False), AfterValidator(_forward)]
"""The part of the time that is drawn [s]."""


_BODY: dict[str, Any] = {"units": "cm", "width": 50, "height": 200}
_MOTION: dict[str, Any] = {"pulse": "sine:amplitude=3,period=0.8"}
_INPUTS: dict[str, Any] = {"body": _BODY, "motion": _MOTION, "restitution": {"models": ["ked", "housner"]}}


def _shown(example: dict[str, Any]) -> ConfigDict:
    """Return what puts an example into the schema."""
    return ConfigDict(json_schema_extra={"examples": [example]})


class MotionInput(OneMotionTable):
    """One pulse, one uploaded record by its hash, or one motion of a synthetic family."""

    record: Hash | None = None
    file_name: Words | None = None

    @model_validator(mode="after")
    def _named_record(self) -> "MotionInput":
        if self.file_name is not None and self.record is None:
            raise refused("file_name goes with record only")
        return self


class Inputs(ResponseTables):
    """Everything that a user chose: a body, and what else was given so far."""

    model_config = _shown(_INPUTS)

    body: BodyInput
    motion: MotionInput | None = None

    @model_validator(mode="after")
    def _few_restitutions(self) -> "Inputs":
        chosen = len(self.restitution.models or ()) + len(self.restitution.values or ())
        refuse_more(chosen, MOST_RESTITUTIONS, "one question compares up to {most} restitutions")
        return self


class ResponseInputs(Inputs):
    """Inputs that have a response: something moves the body."""

    @model_validator(mode="after")
    def _moves(self) -> "ResponseInputs":
        check_start(self.motion is not None, self.response.free)
        return self


class ResponseAsked(ResponseInputs):
    """Inputs that have a response, and how its curves are drawn."""

    model_config = _shown(_INPUTS)

    points: Points = 1000
    window: Window | None = None


class BodyAsked(JobTable):
    """A body, and the gravity under which it stands."""

    model_config = _shown({"body": _BODY})

    body: BodyInput
    settings: SettingsTable = SettingsTable()


class ImpactAsked(BodyAsked):
    """A body, and the foot on which it lands."""

    model_config = _shown({"body": _BODY, "onto": "both"})

    onto: Literal["left", "right", "both"] = "both"


class MotionAsked(JobTable):
    """A motion, and how much of it."""

    model_config = _shown({"motion": _MOTION})

    motion: MotionInput
    settings: SettingsTable = SettingsTable()
    points: Points = 1000
    window: Window | None = None
    spectrum: bool = True
