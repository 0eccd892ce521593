"""The studies of a server: queue, processes, storage and limits."""

import errno
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rocking.dynamics.settings import processors
from rocking_workbench.errors import NoRoom, NotFound, Refused, TooLarge, check_room
from rocking_workbench.plain_text import shown
from rocking_workbench.records import RecordStore
from rocking_workbench.runs.folder import DONE, WAITING, new_id
from rocking_workbench.runs.process import RunProcess
from rocking_workbench.runs.runner import Runner
from rocking_workbench.settings import Limits
from rocking_workbench.studies.finished import OpenStudy
from rocking_workbench.studies.job_document import JobDocument
from rocking_workbench.studies.study import HostedStudy, instant
from rocking_workbench.studies.study_folder import CANCELLED, FAILED, INTERRUPTED, Meta, StudyFolder
from rocking_workbench.work import Remembered

_RESULTS, _ANSWERS = 256 * 2**20, 64 * 2**20  # memory for results and for answers [byte]
_BYTES = 100  # upper estimate of the disk space of a history [byte]
_FULL = {errno.ENOSPC, errno.EDQUOT} if hasattr(errno, "EDQUOT") else {errno.ENOSPC}


class StudyManager:
    """Launch, watch and stop studies, and list all studies on disk."""

    def __init__(
        self,
        folder: Path,
        limits: Limits,
        records: RecordStore,
        queue: Runner | None = None,
        workers: int | None = None,
    ) -> None:
        self._folder, self._limits, self._records = folder / "studies", limits, records
        self._workers = workers or processors()
        self.opened: Remembered[OpenStudy] = Remembered(_RESULTS, lambda study: study.size)
        self.answers: Remembered[bytes] = Remembered(_ANSWERS, len)
        self.queue = queue or Runner()
        self.queue.add(HostedStudy, self._folder, limits.studies_waiting, self._start)

    def create(self, name: str | None, job: object, project: str = "", *, brought: bool = False) -> str:
        """Put a new study in the queue; the limit of the queue does not apply to imported studies."""
        document = JobDocument.of(job)
        count = document.most
        if count > self._limits.histories:
            raise TooLarge(
                "the study has {count} simulations, {limit} are allowed; use fewer values, or `rocking campaign` on "
                "the command line", count=count, limit=self._limits.histories,
            )  # fmt: skip
        title = name or document.document.campaign.name
        study = self.queue.enter(HostedStudy, lambda: self._new_study(title, document, project), brought=brought)
        return study.folder.id

    def of_project(self, project: str) -> list[tuple[str, dict[str, Any]]]:
        """Return names and jobs of the studies of a project, oldest first."""
        mine = [facts for facts in self.overview() if facts["project"] == project]
        return [(facts["name"], self.queue.get(HostedStudy, facts["id"]).folder.asked()) for facts in reversed(mine)]

    def overview(self) -> list[dict[str, Any]]:
        """Return name, kind, state and progress of all studies, newest first."""
        return list(self.queue.published[HostedStudy].values())

    def get(self, study: str) -> dict[str, Any]:
        facts: dict[str, Any] | None = self.queue.published[HostedStudy].get(study)
        if facts is None:
            raise NotFound(HostedStudy.GONE)
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
        return self.queue.get(HostedStudy, study).folder

    def open(self, folder: StudyFolder) -> OpenStudy:
        """Return a finished study; recent studies are cached."""
        return self.opened.get(folder.id, lambda: OpenStudy.of(folder))

    def cancel(self, study: str) -> None:
        """Stop a study within a second; finished simulations are kept."""
        hosted = self.queue.get(HostedStudy, study)
        if not self.queue.stop(hosted):
            raise Refused(
                "the study is {state}; only a queued or running study can be cancelled", state=hosted.note.state
            )

    def resume(self, study: str) -> None:
        """Put a study in the queue again; the study continues from its finished simulations."""

        def again() -> HostedStudy:
            with self.queue.lock:
                hosted = self.queue.get(HostedStudy, study)
                if hosted.unreadable:
                    raise Refused(hosted.note.message)
                if hosted.note.state not in {CANCELLED, INTERRUPTED, FAILED}:
                    raise Refused("the study is {state}; it cannot be resumed", state=hosted.note.state)
                hosted.become(WAITING)
                return hosted

        self.queue.enter(HostedStudy, again)

    def delete(self, study: str) -> None:
        """Delete a study and its results; a running study is stopped."""
        self.queue.delete(self.queue.get(HostedStudy, study))
        self.opened.forget(lambda key: key == study)
        self.answers.forget(lambda key: key[0] == study)

    def close(self) -> None:
        """Stop running studies, which continue with the next server."""
        self.queue.close()

    def _start(self, study: HostedStudy) -> RunProcess:
        path = study.folder.path
        return RunProcess(
            "rocking_workbench.studies.child", str(path), str(self._workers), nice=study.NICE, folder=path
        )

    def _new_study(self, name: str, document: JobDocument, project: str) -> HostedStudy:
        check_room(self._folder, _BYTES * document.most, self._limits.studies_bytes, "studies")
        folder = StudyFolder(self._folder / new_id())
        meta = Meta(shown(name), document.kind, instant(datetime.now(UTC)), document.histories, project=project)
        try:
            folder.create(meta, document, self._records)
        except OSError as error:
            if error.errno not in _FULL:
                raise
            raise NoRoom("the disk is full and the study was not stored; free disk space and send it again") from error
        return HostedStudy(folder, meta)
