"""A study as the server knows it: its folder, its state, its process while it has one."""

import logging
from dataclasses import dataclass, field, replace
from typing import Any

from rocking.app.studies.process import StudyProcess
from rocking.app.studies.progress import Pace
from rocking.app.studies.study_folder import CANCELLED, DONE, FAILED, INTERRUPTED, RUNNING, Meta, StudyFolder
from rocking.errors import RockingError
from rocking.studies.campaign import Estimate

_LOG = logging.getLogger(__name__)


@dataclass
class Study:
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
    _pace: Pace = field(default_factory=Pace)

    def begin(self, workers: int) -> None:
        """Start to compute."""
        self._pace, self.rate, self.estimate, self.cancelled = Pace(), 0.0, None, False
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
        told: dict[str, Any] = {"histories": total, "histories_done": self.done}
        told |= {"rate": self.rate if running else None, "seconds_left": left and left.seconds}
        told |= {"seconds_left_between": left and [left.low, left.high]}
        return self.folder.facts(self.meta) | told
