"""A study on disk: data, job, records and campaign."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal

import numpy as np
from pydantic import TypeAdapter

from rocking.campaigns import disk
from rocking.campaigns.jobs import status_of
from rocking.campaigns.status import CampaignStatus
from rocking.errors import InvalidValueError, RockingError
from rocking.spec.schema import migrated
from rocking_workbench.errors import NotFound
from rocking_workbench.plain_text import record_file_name
from rocking_workbench.runs.folder import WAITING, RunFolder

if TYPE_CHECKING:
    from rocking_workbench.records import RecordStore
    from rocking_workbench.studies.job_document import JobDocument

META, JOB, CAMPAIGN, RECORDS = "meta.json", "job.toml", "campaign", "records"
"""Files and folders of a study."""
CANCELLED: Final = "cancelled"
INTERRUPTED: Final = "interrupted"
FAILED: Final = "failed"


@dataclass(frozen=True)
class Meta:
    """Data of a study outside its campaign."""

    name: str  # name: printable name; kind: type of computation
    kind: str
    created: str  # time of creation in ISO 8601
    histories: int  # number of histories
    state: Literal["waiting", "running", "cancelled", "interrupted", "failed", "done"] = WAITING
    message: str = ""  # result message; empty if there is none
    project: str = ""  # identifier of the project of the study; empty without a project


class StudyFolder(RunFolder):
    """The folder of a study."""

    NOTE: ClassVar = META
    SCHEMA: ClassVar = 1
    FORMAT: ClassVar = TypeAdapter(Meta)

    @property
    def campaign(self) -> Path:
        return self.path / CAMPAIGN

    def create(self, meta: Meta, job: "JobDocument", records: "RecordStore") -> None:
        """Write a self-contained study; `meta.json` is written last."""
        from rocking.campaigns.jobs import Job

        try:
            with self.new():
                kept = {sha256: self._keep_record(sha256, records.path(sha256)) for sha256 in job.records}
                disk.write_new(self.path / JOB, job.toml(kept.__getitem__).encode())
                if not job.needs_long:
                    with np.errstate(all="ignore"):  # an overflow gives infinity, which is refused with its key
                        count = Job.read(self.path / JOB).study.histories.count  # this call checks all inputs
                    if count != meta.histories:
                        raise InvalidValueError(
                            "the job has {count} histories, but {expected} are required",
                            count=count,
                            expected=meta.histories,
                        )
                self.write(meta)
        except RockingError as error:
            without_paths(error, self.path)
            raise

    def asked(self) -> dict[str, Any]:
        """Return the tables of the job, with records by hash."""
        tables = migrated(tomllib.loads((self.path / JOB).read_text(encoding="utf-8")))
        for motions in tables.get("motions", []):
            if "records" in motions:
                motions["records"] = [Path(name).parent.name for name in motions["records"]]
        return tables

    def status(self) -> tuple[CampaignStatus | None, bool]:
        """Return the progress of the campaign, None before its start, and True if complete."""
        if not (self.campaign / JOB).is_file():
            return None, False
        campaign = status_of(self.campaign, verify=False)
        return campaign.status, campaign.complete

    def _keep_record(self, sha256: str, source: Path) -> str:
        """Copy or link a record into the study, and return its path."""
        name = f"{RECORDS}/{sha256}/{record_file_name(source.name)}"
        try:
            self.keep(name, source)
        except FileNotFoundError as error:
            raise NotFound("a record of the job was deleted; upload the record again") from error
        return name


def without_paths(error: RockingError, study: Path) -> RockingError:
    """Remove the paths of a study from an error."""
    for folder in (study / CAMPAIGN, study):
        error.without_folder(folder, "the study")
    return error.without_file(JOB)
