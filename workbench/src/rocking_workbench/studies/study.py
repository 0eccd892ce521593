"""A study of the server: state, speed and progress."""

import time
from collections import deque
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, ClassVar, Self

from rocking.campaigns import Estimate
from rocking.campaigns.status import Speed
from rocking.errors import RockingError
from rocking_workbench.runs.folder import DONE, RUNNING, WAITING
from rocking_workbench.runs.process import LOG, RunProcess
from rocking_workbench.runs.runner import Run
from rocking_workbench.studies.study_folder import CAMPAIGN, CANCELLED, FAILED, INTERRUPTED, META, Meta, StudyFolder

_WINDOW = 6.0
_LEAST = 0.15

_LONGEST_SENTENCE = 1000
_UNREADABLE = f"its {META} cannot be read; nothing was changed: mend it and start the server again, or delete the study"


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
        """Store the number of finished histories and the work of all workers [s]; `now` is the time of a clock [s]."""
        # Returns histories per second over the last seconds [1/s], and work per second since the first finished
        # histories [-]. Both are 0 before the first histories.
        instant = time.monotonic() if now is None else now
        # histories are finished in blocks, so only calls with new histories count
        if not self._looks or done > self._looks[-1][1]:
            if self._looks:
                self._pace = self._speed.look(work, instant)
            self._looks.append((instant, done))
        while len(self._looks) > 2 and instant - self._looks[0][0] > _WINDOW:
            self._looks.popleft()
        (first, before), (_, after) = self._looks[0], self._looks[-1]
        spent = max(self._looks[-1][0] - first, instant - first - _WINDOW)
        return (after - before) / spent if spent > _LEAST else 0.0, self._pace


@dataclass
class HostedStudy(Run):
    """A study."""

    GONE = "study not found; it may have been deleted"
    FULL: ClassVar = {
        "text": "{count} studies are queued", "hint": "try again when a study is finished", "seconds": 30
    }  # fmt: skip
    FILES = (META, CAMPAIGN)
    NICE = 12

    folder: StudyFolder
    note: Meta
    begun: int = 0  # begun, done: histories of the started rounds, and finished histories, at the last update [-]
    done: int = 0
    rate: float = 0.0  # histories per second at the last update [1/s]
    estimate: Estimate | None = None  # remaining time at the last update; None if unknown
    unreadable: bool = False  # True for an unreadable state on the disk, which is not changed
    _pace: StudyPace = field(default_factory=StudyPace)

    @classmethod
    def opened(cls, path: Path) -> Self:
        """Return a study of an earlier server; an unreadable study is shown, and not changed."""
        folder = StudyFolder(path)
        created = instant(datetime.fromtimestamp(path.lstat().st_mtime, UTC))
        unknown = Meta(f"study {path.name}", "unknown", created, 0, FAILED, _UNREADABLE)
        meta = folder.read()
        study = cls(folder, meta or unknown, unreadable=meta is None)
        is_complete = study.look()
        if study.note.state in {WAITING, RUNNING, INTERRUPTED}:
            message = "the server was closed; finished simulations are kept, and the study continues"
            study.become(*(DONE,) if is_complete else (WAITING, message))
        return study

    def begin(self) -> None:
        """Reset the speed, which was that of an earlier process."""
        self._pace, self.rate, self.estimate = StudyPace(), 0.0, None
        super().begin()

    def look(self) -> bool:
        """Update the progress; return True if complete."""
        try:
            status, complete = self.folder.status()
        except (RockingError, OSError):  # the process reports an incomplete, damaged or missing ledger
            return False
        if status is not None:
            self.begun, self.done = status.histories, status.histories_done
            self.rate, speed = self._pace.look(self.done, status.seconds)
            self.estimate = None if status.work is None or not speed else status.work.at(speed)
        return complete

    def finish(self, process: RunProcess | None, *, closed: bool) -> None:
        """Set the final state."""
        if process is not None and self.look():
            self.become(DONE)
        elif self.cancelled:
            kept = "cancelled; finished simulations are kept, resume the study"
            self.become(CANCELLED, "cancelled before the start" if process is None else kept)
        elif process is None:
            self.become(INTERRUPTED, "the server was closed before the study started; it starts with the next server")
        elif closed:
            self.become(
                INTERRUPTED,
                "the server was closed; finished simulations are kept, and the study continues with the next server",
            )
        else:
            self.become(FAILED, self._reason(process))

    def fail(self, reason: str) -> None:
        """Set the state of a study that can be resumed."""
        self.become(FAILED, f"{reason}; resume it")

    def _reason(self, process: RunProcess) -> str:
        """Return the error of the process, or the path of its log."""
        if refusal := self.folder.refusal(process.log_start):
            return str(refusal["message"])[:_LONGEST_SENTENCE]
        how = "was ended by the system" if (process.code or 0) < 0 else "ended unexpectedly"
        return f"the computation {how}; what was finished is safe, and its log is {Path(self.folder.id) / LOG}"

    @property
    def facts(self) -> dict[str, Any]:
        """State and progress for answers."""
        running = self.note.state == RUNNING
        total = max(self.note.histories, self.begun)  # the total of an adaptive study is unknown in advance
        left = self.estimate if running else None
        return {
            "id": self.folder.id,
            **asdict(self.note),
            "histories": total,
            "histories_done": self.done,
            "rate": self.rate if running else None,
            "seconds_left": left and left.seconds,
            "seconds_left_between": left and [left.low, left.high],
        }


def instant(time: datetime) -> str:
    """Return a time as text."""
    return time.isoformat(timespec="microseconds").replace("+00:00", "Z")
