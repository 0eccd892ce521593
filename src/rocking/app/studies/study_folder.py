"""A study on disk: its id and name, what it is, the job, the records that it needs, and the campaign."""

import json
import os
import re
import secrets
import shutil
import unicodedata
from contextlib import suppress
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from rocking.app.errors import NotFound
from rocking.app.studies.job_document import JobDocument
from rocking.campaigns import disk
from rocking.campaigns.jobs.folder import status_of
from rocking.campaigns.status import CampaignStatus
from rocking.errors import InvalidValueError, RockingError

_ID = re.compile(r"[0-9a-f]{16}\Z")
_LONGEST = 120
_HIDDEN = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}
_RESERVED = {"con", "prn", "aux", "nul", *(f"{kind}{k}" for kind in ("com", "lpt") for k in range(10))}
META, JOB, CAMPAIGN, RECORDS, LOG = "meta.json", "job.toml", "campaign", "records", "log.txt"
"""Files and folders of a study."""

WAITING, RUNNING, CANCELLED = "waiting", "running", "cancelled"
INTERRUPTED, FAILED, DONE = "interrupted", "failed", "done"
STATES = (WAITING, RUNNING, CANCELLED, INTERRUPTED, FAILED, DONE)
"""What a study may be doing."""


def new_id() -> str:
    """Return the name of a new study's folder."""
    return secrets.token_hex(8)


def is_id(text: str) -> bool:
    """Return whether words can be the name of a study's folder."""
    return _ID.match(text) is not None


def shown(text: str) -> str:
    r"""Return words of a user as they may be shown: one line, nothing hidden in it.

    Returns at most 120 characters, without control, formatting and direction marks; never empty.

    >>> shown("a\u202eb\n  c")
    'ab c'
    """
    plain = "".join(" " if mark.isspace() else mark for mark in unicodedata.normalize("NFC", text[:4000]))
    seen = "".join(mark for mark in plain if unicodedata.category(mark) not in _HIDDEN)
    return " ".join(seen.split())[:_LONGEST].rstrip() or "study"


def file_name(text: str) -> str:
    """Return the name under which a record is kept in a study.

    Returns Letters, digits, dots, dashes and underscores; no pattern, no path, no reserved word.

    >>> file_name("../../etc/pass wd*.AT2")
    'pass_wd_.AT2'
    """
    last = re.split(r"[/\\]", text)[-1]
    plain = re.sub(r"[^A-Za-z0-9._-]+", "_", last).lstrip(".")[-80:].lstrip("._-").rstrip(".")
    return plain if plain and plain.partition(".")[0].lower() not in _RESERVED else f"record_{plain}".rstrip("_")


class Records(Protocol):
    """Where uploaded records are kept."""

    def path(self, sha256: str) -> Path:
        """Return where a record is."""


@dataclass(frozen=True)
class Meta:
    """What is known of a study beside its campaign."""

    name: str  # name, kind: what it is called, fit to be shown, and what it computes
    kind: str
    created: str  # when it was made, as of ISO 8601
    histories: int  # how many it has
    state: str = WAITING  # one of `STATES`
    message: str = ""  # A sentence about how it ended; empty while there is none


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
        """Folder of the campaign."""
        return self.path / CAMPAIGN

    def create(self, meta: Meta, job: JobDocument, records: Records) -> None:
        """Write what a study needs, so that it needs nothing else: a power cut leaves all of it or no `meta.json`."""
        from rocking.campaigns.jobs import Job

        try:
            disk.make_folder(self.path)
            self.path.chmod(0o700)
            kept = {sha256: self._keep(sha256, records.path(sha256)) for sha256 in job.records}
            disk.write_new(self.path / JOB, job.toml(kept.__getitem__).encode())
            if not job.needs_long:
                with np.errstate(all="ignore"):  # what overflows is infinite, and refused by its name
                    made = Job.read(self.path / JOB)  # everything is checked: bodies, motions, axes, levels
                if made.study.histories.count != meta.histories:
                    raise InvalidValueError(f"job has {made.study.histories.count} histories, not {meta.histories}")
            self.write(meta)
        except BaseException as error:
            shutil.rmtree(self.path, ignore_errors=True)
            if isinstance(error, RockingError):
                raise type(error)(self.without_paths(str(error))) from error
            raise

    def _keep(self, sha256: str, source: Path) -> str:
        """Copy a record into the study, by a link where the disk can, and return its path in the study."""
        name = f"{RECORDS}/{sha256}/{file_name(source.name)}"
        target = self.path / name
        disk.make_folder(target.parent)
        try:
            target.hardlink_to(source)
        except OSError:
            try:
                shutil.copyfile(source, target)
            except FileNotFoundError as error:
                raise NotFound("a record of the job was deleted meanwhile; upload it again") from error
        return name

    def write(self, meta: Meta) -> None:
        """Write what is known of the study, as a whole or not at all."""
        disk.write_new(self.path / META, (json.dumps(asdict(meta), indent=1) + "\n").encode())

    def read(self) -> Meta | None:
        """Return what is known of the study.

        Returns none where there is none, or none that can be read.
        """
        try:
            told = json.loads((self.path / META).read_bytes())
            made = Meta(**{item.name: told[item.name] for item in fields(Meta)})
        except (OSError, ValueError, KeyError, TypeError):
            return None
        words = (made.name, made.kind, made.created, made.state, made.message)
        sound = all(isinstance(word, str) for word in words) and isinstance(made.histories, int)
        return made if sound and made.state in STATES else None

    def status(self) -> tuple[CampaignStatus | None, bool]:
        """Return how far the campaign is.

        Returns status: of an adaptive study that of the rounds that have begun; None where nothing has.
        """
        if not (self.campaign / JOB).is_file():
            return None, False
        found = status_of(self.campaign, verify=False)
        return found.status, found.complete

    def ended(self) -> Meta | None:
        """Return what is known of a study when the server starts: what its end interrupted waits to go on by itself.

        Returns as it is on disk now; None where there is no study.
        """
        meta = self.read()
        if meta is None or meta.state not in {WAITING, RUNNING, INTERRUPTED}:
            return meta
        try:
            complete = self.status()[1]
        except (RockingError, OSError):
            complete = False
        words = "" if complete else "the server ended before the study did; what was finished is safe, and it goes on"
        meta = replace(meta, state=DONE if complete else WAITING, message=words)
        with suppress(OSError):  # a full disk: the next start finds out again
            self.write(meta)
        return meta

    def without_paths(self, words: str) -> str:
        """Return a sentence without the paths of this machine in it, which are nobody's business."""
        for folder in (self.campaign, self.path):
            words = words.replace(f"{folder}{os.sep}", "").replace(str(folder), "the study")
        return words.removeprefix(f"{JOB}: ")

    def facts(self, meta: Meta) -> dict[str, Any]:
        """Return what is known, as the answer of the application."""
        return {"id": self.id, **asdict(meta)}
