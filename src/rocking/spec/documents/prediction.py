"""The input files of a prediction and of an assessment."""

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Positive, Seed, Text, in_list, key
from rocking.spec.motion_tables import ComponentsTable, MotionTable
from rocking.spec.settings_tables import StudySettingsTable


class PredictTable(JobTable):
    """Uncertain inputs of a body: a number, [low, high], a sample of three or more numbers, or a distribution."""

    restitution: Any = key(
        'coefficient of restitution, model, "complementarity", or "measured" [-]', usual="measured",
        allowed="numbers in [0, 10], or a name from `rocking models`",
    )  # fmt: skip
    friction: Any = key("coefficient of friction [-]", usual="[0.3, 0.8]", allowed=">= 0.01, <= 10")
    base: Any = key(
        "distance of the feet from the edges of the base [m]", usual="0 to 2 % of the base width",
        allowed=">= 0, <= 0.9 x half width; of a 3D body >= -0.25 x width, <= 0.5 x height",
    )  # fmt: skip
    centre: Any = key(
        "scale factor of the height of the centre of mass [-]", usual="[0.97, 1.03]", allowed=">= 0.5, <= 1.5"
    )
    offset: Any = key(
        "horizontal offset of the centre of mass [m]", usual="up to 3 % of the half size of the body",
        allowed=">= -0.9 x half width, <= 0.9 x half width; of a 3D body up to its half size",
    )  # fmt: skip
    level: Any = key(
        'slope of the support [rad], or "floor", "shelf", "pedestal", "road"', usual="floor", unit="rad",
        allowed=">= -0.5, <= 0.5, or a name",
    )  # fmt: skip
    polarity: Any = key(
        "polarity: 1 as recorded, -1 reversed", usual="both with equal probability",
        allowed="1, -1, or a sample of both",
    )  # fmt: skip
    azimuth: Any = key(
        "azimuth of the body to the x component (3D or two components), where its direction is known [rad]",
        usual="unknown, sampled over all directions", allowed=">= -2 pi, <= 2 pi",
    )  # fmt: skip
    axis: Annotated[list[float], Field(min_length=3, max_length=3)] | None = key(
        "direction of the x component of the motion in the axes of the scan file, instead of azimuth",
        usual="azimuth in its place",
    )
    model_error: Any = key(
        'factors on uplift acceleration and energy barrier: class of the body "machined", "object" or "natural", '
        '"off", a file of validate-predictions --update, or a table with mean and covariance of ln of both factors [-]',
        usual="machined for blocks, object for other plane bodies, natural for scans",
        allowed="a class, off, an existing file, or a table",
    )  # fmt: skip
    sliding_beyond: Positive = key("smallest sliding distance that counts as sliding [m]", 0.01)
    pga: Text | None = key(
        "peak ground acceleration of every scaled motion: 0.3g, 2.9m/s2", usual="motions are not scaled",
        unit="stated with the number", allowed="a number > 0 with unit",
    )  # fmt: skip
    count: int = key(
        "number of sampled bodies for each motion, a power of two", 128, allowed="powers of two, >= 4, <= 1,048,576",
        ge=4, le=1 << 20,
    )  # fmt: skip
    contributions: bool = key("contributions of the inputs to the variance", True)
    seed: Seed = key("random seed", 0)


class PredictedBody(JobTable):
    """A body, its uncertain inputs, and the settings of the integration."""

    predict: PredictTable = Field(default_factory=PredictTable)
    body: dict[str, Any]
    settings: StudySettingsTable = Field(default_factory=StudySettingsTable)

    @model_validator(mode="after")
    def _one_engine(self) -> "PredictedBody":
        allowed = {"gravity", "friction", "normal_restitution", "normal_restitution_law"}
        refused = sorted(self.settings.model_fields_set - allowed)
        if refused:
            raise InvalidValueError(
                "A prediction does not accept {parameter}. Remove it.", parameter=f"settings.{refused[0]}"
            )
        if "friction" in self.settings.model_fields_set & self.predict.model_fields_set:
            raise InvalidValueError("Use predict.friction or settings.friction, not both.")
        return self


class PredictionDocument(PredictedBody):
    """Input file of a prediction."""

    motion: ComponentsTable | None = None
    motions: Annotated[list[MotionTable], BeforeValidator(in_list)] = Field(default_factory=list)

    @model_validator(mode="after")
    def _whole(self) -> "PredictionDocument":
        if (self.motion is None) == (not self.motions):
            raise InvalidValueError("Use [[motions]], or [motion] with x and y, not both.")
        return self


_LABEL = "any text: printed in the report, 1 to 200 characters"


class AssessTable(JobTable):
    """Options of an assessment and of its report."""

    restitutions: list[Any] | None = key(
        "restitution models and coefficients to compare", usual="all models",
        allowed="names from `rocking models`, or numbers in [0, 10]",
    )  # fmt: skip
    margin: Positive = key("required margin: scale factor of the motions for the retrofit measures [-]", 1.0)
    project: Text | None = key("name of the project", usual="not printed", allowed=_LABEL)
    author: Text | None = key("author of the report", usual="not printed", allowed=_LABEL)
    date: Text | None = key("date of the report", usual="today", allowed=_LABEL)


class AssessmentDocument(PredictionDocument):
    """Input file of an assessment."""

    assess: AssessTable = Field(default_factory=AssessTable)
