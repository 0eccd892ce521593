"""The files of a prediction and of an assessment."""

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Positive, Seed, Text, in_list, key
from rocking.spec.motion_tables import ComponentsTable, MotionTable
from rocking.spec.settings_tables import StudySettingsTable


class PredictTable(JobTable):
    """What is not known of a body: a number, [low, high], more numbers, or a table of a distribution."""

    restitution: Any = key('"measured" (usual), a model, "complementarity", or a coefficient [-]')
    friction: Any = key("coefficient of friction; [0.3, 0.8] if not given [-]")
    base: Any = key("how far feet lie inside of the drawn base; up to 2 % of its width if not given [m]")
    centre: Any = key("factor on the height of the centre of mass; [0.97, 1.03] if not given [-]")
    polarity: Any = key("1 as recorded, -1 mirrored; both alike if not given")
    azimuth: Any = key("of the body's plane, with motions of two components; any if not given [rad]")
    sliding_beyond: Positive = key("distance from which it is said to slide [m]", 0.01)
    pga: Text | None = key("peak ground acceleration to which each motion is scaled: 0.3g, 2.9m/s2")
    count: int = key("bodies drawn for each motion, a power of two", 128, ge=4, le=1 << 20)
    contributions: bool = key("find which input matters how much", True)
    seed: Seed = key("seed of the draws", 0)


class PredictedBody(JobTable):
    """A body, what is not known of it, and how to integrate."""

    predict: PredictTable = Field(default_factory=PredictTable)
    body: dict[str, Any]
    settings: StudySettingsTable = Field(default_factory=StudySettingsTable)

    @model_validator(mode="after")
    def _one_engine(self) -> "PredictedBody":
        known = {"gravity", "friction", "normal_restitution", "normal_restitution_law"}
        odd = sorted(self.settings.model_fields_set - known)
        if odd:
            raise InvalidValueError(
                "{parameter} does not go with a prediction, which has one engine", parameter=f"settings.{odd[0]}"
            )
        if "friction" in self.settings.model_fields_set & self.predict.model_fields_set:
            raise InvalidValueError("predict.friction and settings.friction say the same: leave one out")
        return self


class PredictionDocument(PredictedBody):
    """A file that asks how likely a body is to overturn."""

    motion: ComponentsTable | None = None
    motions: Annotated[list[MotionTable], BeforeValidator(in_list)] = Field(default_factory=list)

    @model_validator(mode="after")
    def _whole(self) -> "PredictionDocument":
        if (self.motion is None) == (not self.motions):
            raise InvalidValueError("give [[motions]], or [motion] with x and y, and not both")
        return self


class AssessTable(JobTable):
    """What is asked of an assessment, and what stands on its report."""

    restitutions: list[Any] | None = key("models and coefficients of the histories; all models if not given")
    margin: Positive = key("factor on the motions that remedies must hold [-]", 1.0)
    project: Text | None = key("what the project is called")
    author: Text | None = key("who signs")
    date: Text | None = key("day of the report; today if not given")


class AssessmentDocument(PredictionDocument):
    """A file that asks whether a body stands, and what to do about it."""

    assess: AssessTable = Field(default_factory=AssessTable)
