"""How far a campaign is, in numbers and in a sentence."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rocking.studies.campaign.chunks import Plan


@dataclass(frozen=True)
class Status:
    """How far a campaign is, as its folder says.

    Parameters
    ----------
    folder : Path
        The campaign.
    histories, histories_done : int
        All of them, and those that are safe on disk.
    chunks, chunks_done : int
        The same, in chunks.
    running : str or None
        Process that runs it now.
    seconds : float
        Time that all workers have spent on finished chunks [s].
    retries : int
        Attempts of finished chunks beyond the first.
    damaged : tuple of str
        Shards that were found damaged or missing so far, and computed again.
    software : str
        Version of this package that computes it.
    """

    folder: Path
    histories: int
    histories_done: int
    chunks: int
    chunks_done: int
    running: str | None
    seconds: float
    retries: int
    damaged: tuple[str, ...]
    software: str

    @property
    def complete(self) -> bool:
        """Whether all histories are computed."""
        return self.chunks_done == self.chunks

    @property
    def sentence(self) -> str:
        """How far it is, in words."""
        if self.complete:
            return f"all {self.chunks} chunks ({self.histories} histories) are safe in {self.folder}"
        now = f"{self.running} runs it" if self.running else "run the campaign again: it goes on from there"
        return f"{self.chunks_done} of {self.chunks} chunks are safe in {self.folder}; {now}"


@dataclass(frozen=True)
class Progress:
    """How far a run is, right after a chunk was recorded.

    Parameters
    ----------
    done_histories, total : int
        Histories that are safe, and all of them.
    chunks_done, chunks : int
        The same, in chunks.
    rate : float
        Histories a second in this run [1/s]; 0 at its start.
    seconds_left : float or None
        Time left at this rate [s]; None at the start.
    seconds : float
        Time since the start of this run [s].
    retries : int
        Chunks that were tried again in this run.
    """

    done_histories: int
    total: int
    chunks_done: int
    chunks: int
    rate: float
    seconds_left: float | None
    seconds: float
    retries: int


@dataclass(frozen=True)
class Summary:
    """What a run did.

    Parameters
    ----------
    computed : int
        Chunks that were computed in it.
    resumed : int
        Chunks that were there before.
    adopted : int
        Those of them that had been written but not recorded when an earlier run was killed.
    set_aside : tuple of str
        Shards that were damaged or missing, and computed again.
    retries : tuple of str
        Chunks that were tried again, and why.
    seconds : float
        How long it took [s].
    """

    computed: int
    resumed: int
    adopted: int
    set_aside: tuple[str, ...]
    retries: tuple[str, ...]
    seconds: float


class Meter:
    """Counts what is safe, and tells it.

    Parameters
    ----------
    folder : Path
        The campaign.
    plan : Plan
        How it is cut.
    tell : callable, optional
        Called with `Progress`.
    """

    def __init__(self, folder: Path, plan: Plan, tell: Callable[[Progress], object] | None) -> None:
        self._folder, self._plan, self._tell = folder, plan, tell
        self._start = time.perf_counter()
        self._begun = self._start
        self.chunks = self.histories = self.resumed = 0
        self.known = False
        self._error: Exception | None = None
        self.retries: list[str] = []

    def begin(self, chunks: int, histories: int) -> None:
        """Note what is there before the first chunk of this run.

        Parameters
        ----------
        chunks, histories : int
            How many.
        """
        self.chunks, self.histories, self.resumed = chunks, histories, histories
        self.known = True
        self._begun = time.perf_counter()
        self._say()

    def add(self, histories: int) -> None:
        """Note that one more chunk is recorded.

        Parameters
        ----------
        histories : int
            How many it holds.
        """
        self.chunks += 1
        self.histories += histories
        self._say()

    @property
    def seconds(self) -> float:
        """Time since the start [s]."""
        return time.perf_counter() - self._start

    def sentence(self) -> str:
        """Return what is safe, in words.

        Returns
        -------
        str
            Part of a sentence.
        """
        if not self.known:
            return "nothing that was recorded before is lost"
        total = self._plan.chunks
        return f"all {total} chunks are safe" if self.chunks == total else f"{self.chunks} of {total} chunks are safe"

    def raised(self, error: BaseException) -> bool:
        """Return whether an error is of the function that is told, and so not of the campaign.

        Parameters
        ----------
        error : BaseException
            What was raised.

        Returns
        -------
        bool
            True for that very error.
        """
        return error is self._error

    def _say(self) -> None:
        if self._tell is None:
            return
        spent = time.perf_counter() - self._begun
        here = self.histories - self.resumed
        rate = here / spent if here and spent > 0.0 else 0.0
        left = (self._plan.count - self.histories) / rate if rate else None
        done = (self.histories, self._plan.count, self.chunks, self._plan.chunks)
        try:
            self._tell(Progress(*done, rate, left, self.seconds, len(self.retries)))
        except Exception as error:
            self._error = error
            raise
