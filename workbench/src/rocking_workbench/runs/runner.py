"""Runs of all kinds: one queue, one thread that starts and watches processes, and the progress for the page."""

import logging
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Self, TypeVar

from rocking_workbench.errors import Busy, NotFound
from rocking_workbench.runs.folder import RUNNING, WAITING, RunFolder, folders_in
from rocking_workbench.runs.process import RunProcess

LOOK = 0.2  # interval between checks of running runs [s]
SAVE_AGAIN = 2.0  # waiting time after a failed write of a state [s]
IDLE = 900.0  # time without runs after which `at_idle` is called [s]
_LOG = logging.getLogger(__name__)
R = TypeVar("R", bound="Run")


@dataclass
class Run:
    """A run. Each kind of run is a subclass."""

    GONE: ClassVar[str]  # error message for an unknown run
    FULL: ClassVar[dict[str, Any]]  # error for a full queue
    FILES: ClassVar[tuple[str, ...]]  # a complete folder contains one of these files or folders
    NICE: ClassVar[int]  # addition to the nice value of the server; runs with a lower number start first
    SECONDS: ClassVar[float] = math.inf  # longest time of a process [s]

    folder: RunFolder
    note: Any  # frozen dataclass of the file: name, project, time of creation, state and message
    process: RunProcess | None = None  # present process of the run
    started: float = 0.0  # start of the process on a clock [s]
    cancelled: bool = False  # cancelled: True after a stop by the user; left: True after deletion
    left: bool = False
    saved: bool = True  # True if the state is on the disk

    @classmethod
    def opened(cls, path: Path) -> Self | None:
        """Return a run of an earlier server, queued if it was interrupted; None for a folder that is not shown."""
        raise NotImplementedError

    @property
    def facts(self) -> Any:
        """State and progress for answers."""
        return self.note

    def begin(self) -> None:
        """Set the state before the start of a process."""
        self.started, self.cancelled = time.monotonic(), False
        self.become(RUNNING)

    def look(self) -> bool:
        """Update the progress; return True if complete."""
        return False

    def finish(self, process: RunProcess | None, *, closed: bool) -> None:
        """Set the state after the end of a run, with or without a process; `closed` is True if the server ends."""
        raise NotImplementedError

    def fail(self, reason: str) -> None:
        """Set the state after an error of the server."""
        raise NotImplementedError

    def become(self, state: str, message: str = "", **changes: Any) -> None:
        """Change the state in memory and on the disk; `save` repeats a failed write."""
        self.note, self.saved = replace(self.note, state=state, message=message, **changes), False
        self.save()
        if not self.saved:
            _LOG.warning("the state of %s could not be written; it is tried again", self.folder.path)

    def save(self) -> None:
        """Write an unsaved state; a full disk or a missing folder is ignored."""
        if self.saved:
            return
        try:
            self.folder.write(self.note)
            self.saved = True
        except OSError as error:
            self.saved = isinstance(error, FileNotFoundError)  # a removed folder needs no state


class Runner:
    """Thread-safe queue of all runs, with limits of running and queued runs of each kind."""

    def __init__(self, at_once: int = 1) -> None:
        self.lock = threading.RLock()
        self.closed = False
        self.at_idle: Callable[[], None] = lambda: None
        self.published: dict[type[Run], dict[str, Any]] = {}  # facts of the runs by kind, newest first
        # functions that are called after changes, from any thread
        self.listeners: set[tuple[type[Run], Callable[[], None]]] = set()
        self._at_once = at_once
        self._kinds: dict[type[Run], tuple[int, Callable[[Any], RunProcess], threading.Lock]] = {}
        self._runs: dict[str, Run] = {}
        self._wake = threading.Event()
        self._thread: threading.Thread | None = None

    def add(self, kind: type[R], folder: Path, longest: int, start: Callable[[R], RunProcess]) -> None:
        """Add a kind with its runs of an earlier server; `longest` is the largest number of queued runs."""
        with self.lock:
            self._kinds[kind] = longest, start, threading.Lock()
            for path in folders_in(folder, *kind.FILES):
                if (run := kind.opened(path)) is not None:
                    self._runs[path.name] = run
        self.changed() if self._queued() else self.publish()

    def get(self, kind: type[R], name: str) -> R:
        with self.lock:
            run = self._runs.get(name)
        if not isinstance(run, kind):
            raise NotFound(kind.GONE)
        return run

    def enter(self, kind: type[R], make: Callable[[], R], *, brought: bool = False) -> R:
        """Put a run in the queue; the limit of the queue does not apply to imported runs."""
        longest, _, alone = self._kinds[kind]
        with alone:
            count = sum(isinstance(run, kind) for run in self._queued())
            if count >= longest and not brought:
                raise Busy(**kind.FULL, count=count)
            run = make()
            with self.lock:
                if run.left:
                    raise NotFound(kind.GONE)
                self._runs[run.folder.id] = run
        self.changed()
        return run

    def stop(self, run: Run) -> bool:
        """Stop a queued or running run; return False for other runs."""
        with self.lock:
            if run.note.state not in {WAITING, RUNNING}:
                return False
            run.cancelled, process = True, run.process
            if process is None:
                run.finish(None, closed=False)
        if process is not None:
            self.end(run, process)
        self.changed()
        return True

    def delete(self, run: Run) -> None:
        """Delete a run and its folder; its process is stopped."""
        with self.lock:
            run.cancelled = run.left = True
            process = run.process
            self._runs.pop(run.folder.id, None)
        if process is not None:
            process.stop()
        run.folder.remove()
        self.changed()

    def end(self, run: Run, process: RunProcess) -> None:
        """Stop a process, and set the state of its run."""
        process.stop()
        with self.lock:
            if run.process is process:
                run.process = None
                run.finish(process, closed=self.closed)

    def changed(self) -> None:
        """Publish changes, and process the queue immediately."""
        with self.lock:
            dead = self._thread is None or not self._thread.is_alive()
            if dead and not self.closed:
                self._thread = threading.Thread(target=self._watch, name="runs", daemon=True)
                self._thread.start()
        self.publish()
        self._wake.set()

    def publish(self) -> None:
        """Publish changes of state and progress to listeners."""
        with self.lock:
            now: dict[type[Run], dict[str, Any]] = {kind: {} for kind in self._kinds}
            for run in sorted(self._runs.values(), key=_age, reverse=True):
                now[type(run)][run.folder.id] = run.facts
            before, self.published = self.published, now
        for kind, tell in list(self.listeners):
            if now[kind] != before[kind]:
                tell()

    def close(self) -> None:
        """Stop running runs, which continue with the next server, and stop watching."""
        self.closed = True
        self._wake.set()
        if self._thread is not None:
            self._thread.join()
        for run in list(self._runs.values()):
            process = run.process
            if process is not None:
                self.end(run, process)
            elif run.note.state == WAITING:
                run.finish(None, closed=True)
        self.publish()

    def _watch(self) -> None:
        saved = True
        while not self.closed:
            try:
                for run in self._running():
                    self._tend(run)
                self._begin_next()
                with self.lock:  # write unsaved states again after a full disk
                    for run in self._runs.values():
                        run.save()
                    saved = all(run.saved for run in self._runs.values())
                self.publish()
            except Exception:  # noqa: BLE001 - whatever it is, the runs go on
                _LOG.exception("the queue of runs stumbled")
                saved = False
            running = self._running()
            if not self._wake.wait(LOOK if running else IDLE if saved else SAVE_AGAIN) and saved and not running:
                self.at_idle()
            self._wake.clear()

    def _tend(self, run: Run) -> None:
        """Update a running run; an error does not affect other runs."""
        process = run.process
        try:
            run.look()
            if process is None or run.cancelled:
                return
            if process.code is not None or time.monotonic() - run.started > run.SECONDS:
                self.end(run, process)
        except Exception as error:  # noqa: BLE001 - whatever it is, the other runs go on
            self._fail(run, "its end could not be noted", error)

    def _running(self) -> list[Run]:
        with self.lock:
            return [run for run in self._runs.values() if run.process is not None]

    def _queued(self) -> list[Run]:
        """Return the queued runs in the order in which they start."""
        with self.lock:
            queued = (run for run in self._runs.values() if run.note.state == WAITING)
            return sorted(queued, key=lambda run: (run.NICE, _age(run)))

    def _begin_next(self) -> None:
        with self.lock:
            for run in self._queued():
                if sum(type(other) is type(run) for other in self._running()) >= self._at_once:
                    continue
                try:
                    run.begin()
                    run.process = self._kinds[type(run)][1](run)
                except Exception as error:  # noqa: BLE001 - the others wait for their turn
                    self._fail(run, "its process could not be started", error)

    def _fail(self, run: Run, fault: str, error: Exception) -> None:
        _LOG.warning("run %s: %s", run.folder.path, fault, exc_info=True)
        with self.lock:
            if run.process is None and run.note.state == RUNNING:
                reason = (isinstance(error, OSError) and error.strerror) or type(error).__name__
                run.fail(f"{fault} ({reason})")


def _age(run: Run) -> tuple[str, str]:
    return run.note.created, run.folder.id
