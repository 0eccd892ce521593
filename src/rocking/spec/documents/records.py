"""The input files for one record and for a set of records."""

from typing import Annotated

from pydantic import BeforeValidator, Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, in_list
from rocking.spec.motion_tables import ComponentsTable, MotionTable


class RecordDocument(JobTable):
    """Input file for reading and processing one record."""

    motion: ComponentsTable


class RecordSetDocument(JobTable):
    """Input file for reading, processing and selecting a set of records."""

    motions: Annotated[list[MotionTable], Field(min_length=1, max_length=1), BeforeValidator(in_list)]

    @model_validator(mode="after")
    def _of_records(self) -> "RecordSetDocument":
        if self.motions[0].records is None:
            raise InvalidValueError("motions.records is missing. Add record files, a folder or a pattern.")
        return self
