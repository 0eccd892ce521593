"""The files of one record and of a set of records."""

from typing import Annotated

from pydantic import BeforeValidator, Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, in_list
from rocking.spec.motion_tables import ComponentsTable, MotionTable


class RecordDocument(JobTable):
    """A file that says how one record is read and corrected."""

    motion: ComponentsTable


class RecordSetDocument(JobTable):
    """A file that says how a set of records is read, corrected and chosen."""

    motions: Annotated[list[MotionTable], Field(min_length=1, max_length=1), BeforeValidator(in_list)]

    @model_validator(mode="after")
    def _of_records(self) -> "RecordSetDocument":
        if self.motions[0].records is None:
            raise InvalidValueError("motions.records is missing: a set is one of records")
        return self
