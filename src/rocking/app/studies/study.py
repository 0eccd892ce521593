"""A study as the server knows it: its folder, its state, its process while it has one."""

from dataclasses import dataclass, field, replace
from typing import Any

from rocking.app.studies.process import StudyProcess
from rocking.app.studies.progress import Pace
from rocking.app.studies.study_folder import CANCELLED, DONE, FAILED, INTERRUPTED, RUNNING, Meta, StudyFolder
from rocking.errors import RockingError


@dataclass
class Study:
    """A study.

    Parameters
    ----------
    folder : StudyFolder
        Where it is.
    meta : Meta
        What is known of it.
    process : StudyProcess, optional
        Who computes it now.
    begun, done : int
        Histories of the rounds that have begun, and finished ones, at the last look [-].
    rate : float
        Histories a second, at the last look [1/s].
    cancelled : bool
        Whether a user wants it to stop.
    """

    folder: StudyFolder
    meta: Meta
    process: StudyProcess | None = None
    begun: int = 0
    done: int = 0
    rate: float = 0.0
    cancelled: bool = False
    _pace: Pace = field(default_factory=Pace)

    def begin(self, workers: int) -> None:
        """Start to compute.

        Parameters
        ----------
        workers : int
            Threads or processes.
        """
        self._pace, self.rate, self.cancelled = Pace(), 0.0, False
        self.process = StudyProcess(self.folder, workers)
        self.become(RUNNING)

    def become(self, state: str, message: str = "") -> None:
        """Change the state, here and on disk.

        Parameters
        ----------
        state : str
            The new one.
        message : str
            A sentence about it.
        """
        self.meta = replace(self.meta, state=state, message=message)
        self.folder.write(self.meta)

    def look(self) -> bool:
        """See how far it is.

        Returns
        -------
        bool
            Whether all of it is finished.
        """
        try:
            self.begun, self.done, complete = self.folder.status()
        except RockingError:  # the ledger is being made, or is damaged: its process will say so
            return False
        self.rate = self._pace.look(self.done)
        return complete

    def end(self, *, closed: bool) -> None:
        """Note how it ended, once its process has; nothing if that was noted before.

        Parameters
        ----------
        closed : bool
            Whether the server is being closed.
        """
        process, self.process = self.process, None
        if process is None:
            return
        process.close()
        if self.look():
            self.become(DONE)
        elif self.cancelled:
            self.become(CANCELLED, "cancelled; what was finished is safe, resume it")
        elif closed:
            self.become(INTERRUPTED, "the server was closed; what was finished is safe, resume it")
        else:
            self.become(FAILED, process.refusal())

    @property
    def facts(self) -> dict[str, Any]:
        """What the application answers."""
        running = self.meta.state == RUNNING
        total = max(self.meta.histories, self.begun)  # an adaptive study finds out on the way how many there are
        left = (total - self.done) / self.rate if running and self.rate > 0.0 else None
        told: dict[str, Any] = {"histories": total, "histories_done": self.done}
        told |= {"rate": self.rate if running else None, "seconds_left": left}
        return self.folder.facts(self.meta) | told
