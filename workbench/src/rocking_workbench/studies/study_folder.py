"""A study on disk: identifier, data, job, records and campaign."""

import json
import re
import secrets
import shutil
import tomllib
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import TypeAdapter

from rocking.campaigns import disk
from rocking.campaigns.jobs import status_of
from rocking.campaigns.status import CampaignStatus
from rocking.errors import InvalidValueError, RockingError
from rocking.spec.schema import migrated
from rocking_workbench.errors import NotFound
from rocking_workbench.plain_text import record_file_name

if TYPE_CHECKING:
    from rocking_workbench.records import RecordStore
    from rocking_workbench.studies.job_document import JobDocument

_ID = re.compile(r"[0-9a-f]{16}\Z")
META, JOB, CAMPAIGN, RECORDS, LOG = "meta.json", "job.toml", "campaign", "records", "log.txt"
"""Files and folders of a study."""

WAITING, RUNNING, CANCELLED = "waiting", "running", "cancelled"
INTERRUPTED, FAILED, DONE = "interrupted", "failed", "done"
STATES = (WAITING, RUNNING, CANCELLED, INTERRUPTED, FAILED, DONE)  # states of a study


def new_id() -> str:
    """Return the name of a new study's folder."""
    return secrets.token_hex(8)


def is_id(text: str) -> bool:
    """Return True if a text can be the name of a study folder."""
    return _ID.match(text) is not None


@dataclass(frozen=True)
class Meta:
    """Data of a study outside its campaign."""

    name: str  # name, kind: printable name and type of computation
    kind: str
    created: str  # when it was made, as of ISO 8601
    histories: int  # number of histories
    state: str = WAITING  # one of `STATES`
    message: str = ""  # result message; empty if there is none
    project: str = ""  # to which it belongs, by its name in addresses; empty if to none


_META = TypeAdapter(Meta)


@dataclass(frozen=True)
class StudyFolder:
    """The folder of a study."""

    path: Path  # where it is; its name is that of the study

    @property
    def id(self) -> str:
        """Name of the study in addresses."""
        return self.path.name

    @property
    def campaign(self) -> Path:
        return self.path / CAMPAIGN

    def create(self, meta: Meta, job: "JobDocument", records: "RecordStore") -> None:
        """Write a self-contained study; `meta.json` is written last."""
        from rocking.campaigns.jobs import Job

        try:
            disk.make_folder(self.path)
            self.path.chmod(0o700)
            kept = {sha256: self._keep(sha256, records.path(sha256)) for sha256 in job.records}
            disk.write_new(self.path / JOB, job.toml(kept.__getitem__).encode())
            if not job.needs_long:
                with np.errstate(all="ignore"):  # overflow gives infinity, which is rejected by its key
                    count = Job.read(self.path / JOB).study.histories.count  # checks bodies, motions, axes, levels
                if count != meta.histories:
                    raise InvalidValueError(
                        "job has {count} histories, not {expected}", count=count, expected=meta.histories
                    )
            self.write(meta)
        except BaseException as error:
            shutil.rmtree(self.path, ignore_errors=True)
            if isinstance(error, RockingError):
                without_paths(error, self.path)
            raise

    def asked(self) -> dict[str, Any]:
        """Return the tables of the job, with records by hash."""
        tables = migrated(tomllib.loads((self.path / JOB).read_text(encoding="utf-8")))
        for motions in tables.get("motions", []):
            if "records" in motions:
                motions["records"] = [Path(name).parent.name for name in motions["records"]]
        return tables

    def _keep(self, sha256: str, source: Path) -> str:
        """Link or copy a record into the study, and return its path in the study."""
        name = f"{RECORDS}/{sha256}/{record_file_name(source.name)}"
        target = self.path / name
        disk.make_folder(target.parent)
        try:
            target.hardlink_to(source)
        except OSError:
            try:
                shutil.copyfile(source, target)
            except FileNotFoundError as error:
                raise NotFound("a record of the job was deleted; upload the record again") from error
        return name

    def write(self, meta: Meta) -> None:
        """Write the data of the study atomically."""
        disk.write_new(self.path / META, (json.dumps(asdict(meta), indent=1) + "\n").encode())

    def read(self) -> Meta | None:
        """Return the data of the study; None if missing or unreadable."""
        try:
            meta = _META.validate_json((self.path / META).read_bytes(), strict=True)
        except (OSError, ValueError):
            return None
        return meta if meta.state in STATES else None

    def status(self) -> tuple[CampaignStatus | None, bool]:
        """Return the progress of the campaign, None before its start, and True if complete."""
        if not (self.campaign / JOB).is_file():
            return None, False
        campaign = status_of(self.campaign, verify=False)
        return campaign.status, campaign.complete

    def ended(self) -> Meta | None:
        """Return the data of the study at the start of the server; interrupted studies are queued."""
        meta = self.read()
        if meta is None or meta.state not in {WAITING, RUNNING, INTERRUPTED}:
            return meta
        try:
            complete = self.status()[1]
        except (RockingError, OSError):
            complete = False
        message = "" if complete else "the server was closed; finished simulations are kept, and the study continues"
        meta = replace(meta, state=DONE if complete else WAITING, message=message)
        with suppress(OSError):  # ignore a full disk; the next start computes the state again
            self.write(meta)
        return meta


def without_paths(error: RockingError, study: Path) -> RockingError:
    """Remove the paths of a study from an error."""
    for folder in (study / CAMPAIGN, study):
        error.without_folder(folder, "the study")
    return error.without_file(JOB)
