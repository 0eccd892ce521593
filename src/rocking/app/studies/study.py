"""A study: its folder on disk, its state, how fast it is, and its process while it has one."""

import contextlib
import json
import logging
import os
import re
import secrets
import shutil
import signal
import subprocess
import sys
import time
from collections import deque
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.app.errors import NotFound
from rocking.app.plain_text import record_file_name
from rocking.app.studies import GRACE
from rocking.app.studies.job_document import JobDocument
from rocking.campaigns import Estimate, disk
from rocking.campaigns.jobs.folder import status_of
from rocking.campaigns.status import CampaignStatus, Speed
from rocking.errors import InvalidValueError, RockingError

if TYPE_CHECKING:
    from rocking.app.records import RecordStore

_ID = re.compile(r"[0-9a-f]{16}\Z")
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

    def create(self, meta: Meta, job: JobDocument, records: "RecordStore") -> None:
        """Write what a study needs, so that it needs nothing else: a power cut leaves all of it or no `meta.json`."""
        from rocking.campaigns.jobs import Job

        try:
            disk.make_folder(self.path)
            self.path.chmod(0o700)
            kept = {sha256: self._keep(sha256, records.path(sha256)) for sha256 in job.records}
            disk.write_new(self.path / JOB, job.toml(kept.__getitem__).encode())
            if not job.needs_long:
                with np.errstate(all="ignore"):  # what overflows is infinite, and refused by its name
                    count = Job.read(self.path / JOB).study.histories.count  # checks bodies, motions, axes, levels
                if count != meta.histories:
                    raise InvalidValueError(f"job has {count} histories, not {meta.histories}")
            self.write(meta)
        except BaseException as error:
            shutil.rmtree(self.path, ignore_errors=True)
            if isinstance(error, RockingError):
                raise type(error)(self.without_paths(str(error))) from error
            raise

    def _keep(self, sha256: str, source: Path) -> str:
        """Copy a record into the study, by a link where the disk can, and return its path in the study."""
        name = f"{RECORDS}/{sha256}/{record_file_name(source.name)}"
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
        """Return what is known of the study; None where there is nothing, or nothing that can be read."""
        try:
            words = json.loads((self.path / META).read_bytes())
            meta = Meta(**{item.name: words[item.name] for item in fields(Meta)})
        except (OSError, ValueError, KeyError, TypeError):
            return None
        texts = (meta.name, meta.kind, meta.created, meta.state, meta.message)
        sound = all(isinstance(text, str) for text in texts) and isinstance(meta.histories, int)
        return meta if sound and meta.state in STATES else None

    def status(self) -> tuple[CampaignStatus | None, bool]:
        """Return how far the campaign is (None where nothing has begun), and whether it is complete."""
        if not (self.campaign / JOB).is_file():
            return None, False
        campaign = status_of(self.campaign, verify=False)
        return campaign.status, campaign.complete

    def ended(self) -> Meta | None:
        """Return what is known when the server starts, None of no study: what its end interrupted waits to go on."""
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


_WINDOW = 6.0
_LEAST = 0.15

_LONGEST_SENTENCE = 1000
_LOG = logging.getLogger(__name__)


class StudyPace:
    """How fast histories are finished, over the last seconds, and how much work is done in a second.

    >>> pace = StudyPace()
    >>> pace.look(0, 0.0, now=10.0), pace.look(100, 1.5, now=11.0), pace.look(600, 11.5, now=16.0)
    ((0.0, 0.0), (100.0, 0.0), (100.0, 2.0))
    """

    def __init__(self) -> None:
        self._looks: deque[tuple[float, int]] = deque()
        self._speed, self._pace = Speed(), 0.0

    def look(self, done: int, work: float, now: float | None = None) -> tuple[float, float]:
        """Note how many histories are finished and what all workers spent on them [s]; now: instant of a clock [s].

        Returns histories a second over the last seconds [1/s], and the work done in a second since the first were
        finished [-]; 0 while nothing is known.
        """
        instant = time.monotonic() if now is None else now
        # a study finishes in jumps, a piece at a time: only looks that found more say anything
        if not self._looks or done > self._looks[-1][1]:
            if self._looks:
                self._pace = self._speed.look(work, instant)
            self._looks.append((instant, done))
        while len(self._looks) > 2 and instant - self._looks[0][0] > _WINDOW:
            self._looks.popleft()
        (first, before), (_, after) = self._looks[0], self._looks[-1]
        spent = max(self._looks[-1][0] - first, instant - first - _WINDOW)
        return (after - before) / spent if spent > _LEAST else 0.0, self._pace


class StudyProcess:
    """A process, and the group of its workers, that computes a study."""

    def __init__(self, folder: StudyFolder, workers: int) -> None:
        self.folder = folder
        command = [sys.executable, "-P", "-m", "rocking.app.studies.child", str(folder.path), str(workers)]
        with (folder.path / LOG).open("ab") as log:
            self._begin = log.tell()
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=log, cwd=folder.path,
                start_new_session=True, env={**os.environ, "PYTHONUNBUFFERED": "1"},
            )  # fmt: skip

    @property
    def code(self) -> int | None:
        """Exit code; None while it runs, negative where a signal ended it."""
        return self._process.poll()

    def stop(self, patience: float = GRACE) -> int:
        """Ask it to stop, and make it stop if it does not within so long [s]: what is finished is safe either way."""
        if self._process.poll() is None:
            with contextlib.suppress(OSError, ValueError):  # some systems have no such signal
                self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(patience)
            except subprocess.TimeoutExpired:
                self.kill()
        self.kill()
        return self._process.wait()

    def kill(self) -> None:
        """End it and all its workers at once."""
        with contextlib.suppress(OSError):
            if sys.platform == "win32":
                self._process.kill()
            elif self._process.poll() is None:
                os.killpg(self._process.pid, signal.SIGKILL)

    def close(self) -> None:
        """Let go of the pipe, once it has ended."""
        if self._process.stdin is not None:
            self._process.stdin.close()

    def refusal(self) -> str:
        """Return why it ended, in words that a user may see, or where to look for more."""
        try:
            with (self.folder.path / LOG).open("rb") as log:
                log.seek(self._begin)
                lines = log.read(1 << 20).decode(errors="replace").splitlines()
        except OSError:
            lines = []
        refusals = [line.removeprefix("refused: ") for line in lines if line.startswith("refused: ")]
        if refusals:
            return self.folder.without_paths(refusals[-1])[:_LONGEST_SENTENCE]
        how = "was ended by the system" if (self.code or 0) < 0 else "ended unexpectedly"
        return f"the computation {how}; what was finished is safe, and its log is {Path(self.folder.id) / LOG}"


def processors() -> int:
    """Return how many processors this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


@dataclass
class HostedStudy:
    """A study."""

    folder: StudyFolder  # where it is
    meta: Meta  # what is known of it
    process: StudyProcess | None = None  # who computes it now
    begun: int = 0  # begun, done: histories of the rounds that have begun, and finished ones, at the last look [-]
    done: int = 0
    rate: float = 0.0  # histories a second, at the last look [1/s]
    estimate: Estimate | None = None  # time that is left, at the last look; None while that is not known
    cancelled: bool = False  # cancelled, left: whether a user wants it to stop, and whether it is being deleted
    left: bool = False
    unreadable: bool = False  # whether what is on disk is not understood: it is shown, and left as it is
    saved: bool = True  # whether the disk knows its state
    _pace: StudyPace = field(default_factory=StudyPace)

    def begin(self, workers: int) -> None:
        """Start to compute."""
        self._pace, self.rate, self.estimate, self.cancelled = StudyPace(), 0.0, None, False
        self.process = StudyProcess(self.folder, workers)
        self.become(RUNNING)

    def become(self, state: str, message: str = "") -> None:
        """Change the state, here and on disk; where the disk does not take it, here alone until `save` is called."""
        self.meta = replace(self.meta, state=state, message=message)
        self.saved = False
        self.save()
        if not self.saved and not self.left:
            _LOG.warning("the state of study %s could not be written; it is tried again", self.folder.id)

    def save(self) -> None:
        """Write the state if the disk does not know it yet; a full disk, or a folder that is gone, is no error."""
        if self.saved or self.left:
            return
        try:
            self.folder.write(self.meta)
            self.saved = True
        except OSError as error:
            self.saved = isinstance(error, FileNotFoundError)  # there is no folder to write it in, nor will there be

    def look(self) -> bool:
        """See how far it is."""
        try:
            status, complete = self.folder.status()
        except (RockingError, OSError):  # the ledger is being made, or is damaged or gone: its process will say so
            return False
        if status is not None:
            self.begun, self.done = status.histories, status.histories_done
            self.rate, speed = self._pace.look(self.done, status.seconds)
            self.estimate = None if status.work is None or not speed else status.work.at(speed)
        return complete

    def end(self, *, closed: bool) -> None:
        """Note how it ended, once its process has; nothing if that was noted before."""
        process, self.process = self.process, None
        if process is None:
            return
        process.close()
        if self.look():
            self.become(DONE)
        elif self.cancelled:
            self.become(CANCELLED, "cancelled; what was finished is safe, resume it")
        elif closed:
            self.become(
                INTERRUPTED,
                "the server was closed; what was finished is safe, and it goes on when the server starts again",
            )
        else:
            self.become(FAILED, process.refusal())

    @property
    def facts(self) -> dict[str, Any]:
        """What the application answers."""
        running = self.meta.state == RUNNING
        total = max(self.meta.histories, self.begun)  # an adaptive study finds out on the way how many there are
        left = self.estimate if running else None
        return {
            "id": self.folder.id,
            **asdict(self.meta),
            "histories": total,
            "histories_done": self.done,
            "rate": self.rate if running else None,
            "seconds_left": left and left.seconds,
            "seconds_left_between": left and [left.low, left.high],
        }
