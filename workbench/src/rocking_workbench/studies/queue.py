"""The queue of studies: computed, watched and published one after another."""

import logging
import threading
from collections.abc import Callable
from typing import Any

from rocking_workbench.errors import Busy, NotFound
from rocking_workbench.studies.study import HostedStudy, StudyProcess
from rocking_workbench.studies.study_folder import FAILED, INTERRUPTED, RUNNING, WAITING

LOOK = 0.2  # interval between checks of running studies [s]
SAVE_AGAIN = 2.0  # time after which a state is written again that the disk did not take [s]
_LOG = logging.getLogger(__name__)
GONE = "study not found; it may have been deleted"


class StudyQueue:
    """Thread-safe queue of studies, with limits of running and queued studies."""

    def __init__(self, studies: dict[str, HostedStudy], workers: int, at_once: int, longest: int) -> None:
        self.lock = threading.RLock()
        self.published: dict[str, dict[str, Any]] = {}
        self.closed = False
        self._studies, self._workers, self._at_once, self._longest = studies, workers, at_once, longest
        self._wake = threading.Event()
        self._listeners: set[Callable[[], None]] = set()
        self._entering = 0
        self._thread: threading.Thread | None = None
        self.publish()

    def study(self, name: str) -> HostedStudy:
        if name not in self._studies:
            raise NotFound(GONE)
        return self._studies[name]

    def enter(self, make: Callable[[], HostedStudy], *, brought: bool = False) -> HostedStudy:
        """Put a study in the queue; a place is reserved during its creation."""
        with self.lock:
            waiting = self._entering + sum(study.meta.state == WAITING for study in self._studies.values())
            if waiting >= self._longest and not brought:
                raise Busy(
                    "{count} studies are queued", count=waiting, hint="try again when a study is finished", seconds=30
                )
            self._entering += 1
        try:
            study = make()
            with self.lock:
                if study.left:
                    raise NotFound(GONE)
                self._studies[study.folder.id] = study
        finally:
            with self.lock:
                self._entering -= 1
        self.changed()
        return study

    def leave(self, name: str) -> tuple[HostedStudy, StudyProcess | None]:
        """Remove a study, and return it with its process."""
        with self.lock:
            study = self.study(name)
            study.cancelled = study.left = True
            return self._studies.pop(name), study.process

    def end(self, study: HostedStudy, process: StudyProcess) -> None:
        """Store the end of a study after its process has ended."""
        with self.lock:
            if study.process is process:
                study.end(closed=self.closed)

    def subscribe(self, tell: Callable[[], None]) -> Callable[[], None]:
        """Subscribe to changes, called from any thread."""
        with self.lock:
            self._listeners.add(tell)
        return lambda: self._listeners.discard(tell)

    @property
    def watchers(self) -> int:
        """Number of subscribers."""
        return len(self._listeners)

    def changed(self) -> None:
        """Process the queue now."""
        with self.lock:
            dead = self._thread is None or not self._thread.is_alive()
            if dead and not self.closed:
                self._thread = threading.Thread(target=self._watch, name="studies", daemon=True)
                self._thread.start()
        self.publish()
        self._wake.set()

    def publish(self) -> None:
        """Publish changes to subscribers."""
        with self.lock:
            studies = sorted(
                self._studies.values(), key=lambda study: (study.meta.created, study.folder.id), reverse=True
            )
            now = {study.folder.id: study.facts for study in studies}
            if now == self.published:
                return
            self.published = now
            listeners = list(self._listeners)
        for tell in listeners:
            tell()

    def close(self) -> None:
        """Stop running studies, which can be resumed, and stop watching."""
        self.closed = True
        self._wake.set()
        if self._thread is not None:
            self._thread.join()
        for study in list(self._studies.values()):
            process = study.process
            if process is not None:
                process.stop()
                self.end(study, process)
            elif study.meta.state == WAITING:
                study.become(
                    INTERRUPTED, "the server was closed before the study started; it starts with the next server"
                )
        self.publish()

    def _watch(self) -> None:
        while not self.closed:
            try:
                for study in self._running():
                    self._tend(study)
                self._begin_next()
                with self.lock:  # write again after a full disk
                    for study in self._studies.values():
                        study.save()
                    unsaved = not all(study.saved for study in self._studies.values())
                self.publish()
            except Exception:  # noqa: BLE001 - whatever it is, the studies go on
                _LOG.exception("the queue of studies stumbled")
                unsaved = True
            self._wake.wait(LOOK if self._running() else SAVE_AGAIN if unsaved else None)
            self._wake.clear()

    def _tend(self, study: HostedStudy) -> None:
        """Update a running study; an error does not affect other studies."""
        process = study.process
        try:
            study.look()
            if process is not None and process.code is not None and not study.cancelled:
                self.end(study, process)
        except Exception as error:  # noqa: BLE001 - whatever it is, the other studies go on
            _LOG.exception("study %s could not be looked at", study.folder.id)
            with self.lock:
                if study.process is None and study.meta.state == RUNNING:
                    study.become(FAILED, f"its end could not be noted ({type(error).__name__}); resume it")

    def _running(self) -> list[HostedStudy]:
        with self.lock:
            return [study for study in self._studies.values() if study.process is not None]

    def _begin_next(self) -> None:
        with self.lock:
            waiting = [study for study in self._studies.values() if study.meta.state == WAITING]
            room = max(0, self._at_once - len(self._running()))
            for study in sorted(waiting, key=lambda waiting_study: waiting_study.meta.created)[:room]:
                try:
                    study.begin(self._workers)
                except Exception as error:  # noqa: BLE001 - the others wait for their turn
                    reason = (isinstance(error, OSError) and error.strerror) or type(error).__name__
                    _LOG.warning("study %s could not be begun", study.folder.id, exc_info=True)
                    study.become(FAILED, f"its process could not be started ({reason}); resume it")
                    self._wake.set()  # a process is free: start the next study
