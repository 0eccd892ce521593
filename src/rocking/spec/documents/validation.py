"""The file of a validation."""

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.documents.prediction import PredictedBody
from rocking.spec.motion_tables import OF_FILES, MotionKeys


class ValidationDocument(PredictedBody):
    """A file beside a table of outcomes: the body, what is not known of it, and how its records are read."""

    motion: MotionKeys = Field(default_factory=MotionKeys)

    @model_validator(mode="after")
    def _of_files(self) -> "ValidationDocument":
        known = OF_FILES - {"vertical_file"}
        if odd := sorted(self.motion.model_fields_set - known):
            raise InvalidValueError(
                "[motion] takes {names} here, got {key}", names=", ".join(sorted(known)), key=odd[0],
                hint="outcomes name the rest",
            )  # fmt: skip
        return self
