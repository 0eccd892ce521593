"""The studies of a server: queue, processes, storage and limits."""

import errno
import shutil
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rocking.campaigns import disk
from rocking.dynamics.settings import processors
from rocking_workbench.errors import NoRoom, NotFound, Refused, TooLarge, check_room
from rocking_workbench.plain_text import shown
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import Limits
from rocking_workbench.studies.finished import OpenStudy
from rocking_workbench.studies.job_document import JobDocument
from rocking_workbench.studies.queue import GONE, StudyQueue
from rocking_workbench.studies.study import HostedStudy
from rocking_workbench.studies.study_folder import (
    CAMPAIGN,
    CANCELLED,
    DONE,
    FAILED,
    INTERRUPTED,
    META,
    RUNNING,
    WAITING,
    Meta,
    StudyFolder,
    is_id,
    new_id,
)
from rocking_workbench.work import Remembered

_RESULTS, _ANSWERS = 256 * 2**20, 64 * 2**20  # memory for results and for answers [byte]
_BYTES = 100  # disk for a history, generously [byte]
_FULL = {errno.ENOSPC, errno.EDQUOT} if hasattr(errno, "EDQUOT") else {errno.ENOSPC}
_DELETED = ".deleted-"
_UNREADABLE = f"its {META} cannot be read; nothing was changed: mend it and start the server again, or delete the study"


class StudyManager:
    """Launch, watch and stop studies, and list all studies on disk."""

    def __init__(
        self, folder: Path, limits: Limits, records: RecordStore, *, workers: int | None = None, at_once: int = 1
    ) -> None:
        self._folder, self._limits, self._records = folder / "studies", limits, records
        there = studies_in(self._folder)
        self.opened: Remembered[OpenStudy] = Remembered(_RESULTS, lambda study: study.size)
        self.answers: Remembered[bytes] = Remembered(_ANSWERS, len)
        self.queue = StudyQueue(there, workers or processors(), at_once, limits.studies_waiting)
        if any(study.meta.state == WAITING for study in there.values()):
            self.queue.changed()  # continue the studies of an earlier server

    def create(self, name: str | None, job: object, project: str = "", *, brought: bool = False) -> str:
        """Put a new study in the queue; imported studies ignore its length."""
        document = JobDocument.of(job)
        count = document.most
        if count > self._limits.histories:
            raise TooLarge(
                "the study has {count} simulations, {limit} are allowed; use fewer values, or `rocking campaign` on "
                "the command line", count=count, limit=self._limits.histories,
            )  # fmt: skip
        title = name or document.document.campaign.name
        return self.queue.enter(lambda: self._new_study(title, document, project), brought=brought).folder.id

    def of_project(self, project: str) -> list[tuple[str, dict[str, Any]]]:
        """Return names and jobs of the studies of a project, oldest first."""
        mine = [facts for facts in self.overview() if facts["project"] == project]
        return [(facts["name"], self.queue.study(facts["id"]).folder.asked()) for facts in reversed(mine)]

    def overview(self) -> list[dict[str, Any]]:
        """Return name, kind, state and progress of all studies, newest first."""
        return list(self.queue.published.values())

    def get(self, study: str) -> dict[str, Any]:
        facts = self.queue.published.get(study)
        if facts is None:
            raise NotFound(GONE)
        return facts

    def finished(self, study: str) -> StudyFolder:
        """Return the folder of a study that is done."""
        facts = self.get(study)
        if facts["state"] != DONE:
            raise Refused(
                "the study is {state}: {done} of {count} simulations are finished", state=facts["state"],
                done=facts["histories_done"], count=facts["histories"], hint="results are available when all "
                                                                             "simulations are finished",
            )  # fmt: skip
        return self.queue.study(study).folder

    def open(self, folder: StudyFolder) -> OpenStudy:
        """Return a finished study; recent studies are cached."""
        return self.opened.get(folder.id, lambda: OpenStudy.of(folder))

    def cancel(self, study: str) -> None:
        """Stop a study within a second; finished simulations are kept."""
        with self.queue.lock:
            hosted = self.queue.study(study)
            if hosted.meta.state not in {WAITING, RUNNING}:
                raise Refused(
                    "the study is {state}; only a queued or running study can be cancelled", state=hosted.meta.state
                )
            hosted.cancelled, process = True, hosted.process
            if process is None:
                hosted.become(CANCELLED, "cancelled before the start")
        if process is not None:
            process.stop()
            self.queue.end(hosted, process)
        self.queue.changed()

    def resume(self, study: str) -> None:
        """Put a study in the queue again; it continues."""

        def again() -> HostedStudy:
            with self.queue.lock:
                hosted = self.queue.study(study)
                if hosted.unreadable:
                    raise Refused(hosted.meta.message)
                if hosted.meta.state not in {CANCELLED, INTERRUPTED, FAILED}:
                    raise Refused("the study is {state}; it cannot be resumed", state=hosted.meta.state)
                hosted.cancelled = False
                hosted.become(WAITING)
                return hosted

        self.queue.enter(again)

    def delete(self, study: str) -> None:
        """Delete a study and its results; a running study is stopped."""
        hosted, process = self.queue.leave(study)
        if process is not None:
            process.stop()
            process.close()
        self.opened.forget(lambda key: key == study)
        self.answers.forget(lambda key: key[0] == study)
        remove(hosted)
        self.queue.changed()

    def close(self) -> None:
        """Stop running studies, which can be resumed, and stop watching."""
        self.queue.close()

    def _new_study(self, name: str, document: JobDocument, project: str) -> HostedStudy:
        check_room(self._folder, _BYTES * document.most, self._limits.studies_bytes, "studies")
        folder = StudyFolder(self._folder / new_id())
        meta = Meta(shown(name), document.kind, _instant(datetime.now(UTC)), document.histories, project=project)
        try:
            folder.create(meta, document, self._records)
        except OSError as error:
            if error.errno not in _FULL:
                raise
            raise NoRoom("the disk is full and the study was not stored; free disk space and send it again") from error
        return HostedStudy(folder, meta)


def studies_in(folder: Path) -> dict[str, HostedStudy]:
    """Return the studies of an earlier server; none of them runs."""
    disk.make_folder(folder)
    folder.chmod(0o700)
    studies = {}
    for path in list(folder.iterdir()):
        if path.name.startswith(_DELETED):
            shutil.rmtree(path, ignore_errors=True)
        if path.is_symlink() or not path.is_dir() or not is_id(path.name):
            continue
        meta = StudyFolder(path).ended()
        if meta is None and _is_half_written(path):
            shutil.rmtree(path, ignore_errors=True)
            continue
        studies[path.name] = HostedStudy(StudyFolder(path), meta or _unknown(path), unreadable=meta is None)
        studies[path.name].look()
    return studies


def _is_half_written(path: Path) -> bool:
    """Return True if the folder was created incompletely."""
    try:
        return not {META, CAMPAIGN} & {entry.name for entry in path.iterdir()}
    except OSError:
        return False


def _unknown(path: Path) -> Meta:
    """Return the data of an unreadable study."""
    created = _instant(datetime.fromtimestamp(path.lstat().st_mtime, UTC))
    return Meta(f"study {path.name}", "unknown", created, 0, FAILED, _UNREADABLE)


def _instant(time: datetime) -> str:
    return time.isoformat(timespec="microseconds").replace("+00:00", "Z")


def remove(study: HostedStudy) -> None:
    """Remove a study from the disk, safe against interruption."""
    path = study.folder.path
    aside = path.with_name(f"{_DELETED}{path.name}")
    with suppress(FileNotFoundError):  # somebody was quicker
        path.rename(aside)
    shutil.rmtree(aside, ignore_errors=True)
