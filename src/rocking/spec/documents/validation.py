"""The file of a validation."""

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.documents.prediction import PredictedBody
from rocking.spec.motion_tables import OF_FILES, MotionKeys


class ValidationDocument(PredictedBody):
    """Input file of a validation: the body, its uncertain inputs, and the options of the record files."""

    motion: MotionKeys = Field(default_factory=MotionKeys)

    @model_validator(mode="after")
    def _of_files(self) -> "ValidationDocument":
        allowed = OF_FILES - {"vertical_file"}
        if refused := sorted(self.motion.model_fields_set - allowed):
            raise InvalidValueError(
                "[motion] accepts {names} here, got {key}", names=", ".join(sorted(allowed)), key=refused[0],
                hint="the table of outcomes contains the other values",
            )  # fmt: skip
        return self
