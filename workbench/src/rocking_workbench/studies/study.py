"""A study of the server: state, speed and process."""

import contextlib
import json
import logging
import os
import signal
import subprocess
import sys
import time
from collections import deque
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from rocking.campaigns import Estimate
from rocking.campaigns.status import Speed
from rocking.errors import RockingError
from rocking_workbench.studies import GRACE
from rocking_workbench.studies.study_folder import CANCELLED, DONE, FAILED, INTERRUPTED, LOG, RUNNING, Meta, StudyFolder
from rocking_workbench.work import kill

_WINDOW = 6.0
_LEAST = 0.15

_LONGEST_SENTENCE = 1000
_LOG = logging.getLogger(__name__)


class StudyPace:
    """Rate of finished histories over the last seconds, and work per second.

    >>> pace = StudyPace()
    >>> pace.look(0, 0.0, now=10.0), pace.look(100, 1.5, now=11.0), pace.look(600, 11.5, now=16.0)
    ((0.0, 0.0), (100.0, 0.0), (100.0, 2.0))
    """

    def __init__(self) -> None:
        self._looks: deque[tuple[float, int]] = deque()
        self._speed, self._pace = Speed(), 0.0

    def look(self, done: int, work: float, now: float | None = None) -> tuple[float, float]:
        """Store the number of finished histories and the work of all workers [s]; now: time of a clock [s]."""
        # returns histories per second over the last seconds [1/s], and work per second since the first finished
        # histories [-]; 0 before the first ones
        instant = time.monotonic() if now is None else now
        # a study finishes in blocks: only checks with new histories count
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
    """A process group that computes a study."""

    def __init__(self, folder: StudyFolder, workers: int) -> None:
        self.folder = folder
        command = [sys.executable, "-P", "-m", "rocking_workbench.studies.child", str(folder.path), str(workers)]
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
        """Interrupt the process, and kill it after `patience` [s]; finished simulations are kept."""
        if self._process.poll() is None:
            with contextlib.suppress(OSError, ValueError):  # some systems have no such signal
                self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(patience)
            except subprocess.TimeoutExpired:
                kill(self._process)
        kill(self._process)
        return self._process.wait()

    def close(self) -> None:
        """Close the pipe of the ended process."""
        if self._process.stdin:
            self._process.stdin.close()

    def refusal(self) -> str:
        """Return the reason of its end, or the path of its log."""
        try:
            with (self.folder.path / LOG).open("rb") as log:
                log.seek(self._begin)
                lines = log.read(1 << 20).decode(errors="replace").splitlines()
        except OSError:
            lines = []
        for line in reversed(lines):
            with contextlib.suppress(ValueError, TypeError, KeyError):
                return str(json.loads(line)["error"]["message"])[:_LONGEST_SENTENCE]
        how = "was ended by the system" if (self.code or 0) < 0 else "ended unexpectedly"
        return f"the computation {how}; what was finished is safe, and its log is {Path(self.folder.id) / LOG}"


@dataclass
class HostedStudy:
    """A study."""

    folder: StudyFolder  # where it is
    meta: Meta  # state on disk
    process: StudyProcess | None = None  # who computes it now
    begun: int = 0  # begun, done: histories of the rounds that have begun, and finished ones, at the last look [-]
    done: int = 0
    rate: float = 0.0  # histories per second at the last update [1/s]
    estimate: Estimate | None = None  # time that is left, at the last look; None while that is not known
    cancelled: bool = False  # cancelled, left: whether a user wants it to stop, and whether it is being deleted
    left: bool = False
    unreadable: bool = False  # whether the files are unreadable: shown, and left unchanged
    saved: bool = True  # whether the state is saved
    _pace: StudyPace = field(default_factory=StudyPace)

    def begin(self, workers: int) -> None:
        """Start to compute."""
        self._pace, self.rate, self.estimate, self.cancelled = StudyPace(), 0.0, None, False
        self.process = StudyProcess(self.folder, workers)
        self.become(RUNNING)

    def become(self, state: str, message: str = "") -> None:
        """Change the state in memory and on disk; `save` repeats a failed write."""
        self.meta = replace(self.meta, state=state, message=message)
        self.saved = False
        self.save()
        if not self.saved and not self.left:
            _LOG.warning("the state of study %s could not be written; it is tried again", self.folder.id)

    def save(self) -> None:
        """Write an unsaved state; a full disk or a missing folder is ignored."""
        if self.saved or self.left:
            return
        try:
            self.folder.write(self.meta)
            self.saved = True
        except OSError as error:
            self.saved = isinstance(error, FileNotFoundError)  # there is no folder to write it in, nor will there be

    def look(self) -> bool:
        """Update the progress; return True if complete."""
        try:
            status, complete = self.folder.status()
        except (RockingError, OSError):  # the ledger is incomplete, damaged or missing: its process reports it
            return False
        if status is not None:
            self.begun, self.done = status.histories, status.histories_done
            self.rate, speed = self._pace.look(self.done, status.seconds)
            self.estimate = None if status.work is None or not speed else status.work.at(speed)
        return complete

    def end(self, *, closed: bool) -> None:
        """Store the final state after the process has ended."""
        process, self.process = self.process, None
        if process is None:
            return
        process.close()
        if self.look():
            self.become(DONE)
        elif self.cancelled:
            self.become(CANCELLED, "cancelled; finished simulations are kept, resume the study")
        elif closed:
            self.become(
                INTERRUPTED,
                "the server was closed; finished simulations are kept, and the study continues with the next server",
            )
        else:
            self.become(FAILED, process.refusal())

    @property
    def facts(self) -> dict[str, Any]:
        """State and progress for answers."""
        running = self.meta.state == RUNNING
        total = max(self.meta.histories, self.begun)  # total of an adaptive study: not known in advance
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
