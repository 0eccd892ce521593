"""How far a campaign is, in numbers and in a sentence, and how long it will still take."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns import disk
from rocking.campaigns.chunks import Chunk, Plan

PARTS = 16
"""Equal parts of the histories, each of which is measured: costs change from the first history to the last one."""

_SETTLED = 4.0
NOISE = 0.1  # a machine is no steadier than this from one minute to the next [-]


@dataclass(frozen=True)
class Estimate:
    """Time that is left.

    Parameters
    ----------
    seconds : float
        The best guess [s].
    low, high : float
        Between these it is likely to be [s].
    """

    seconds: float
    low: float
    high: float

    def at(self, speed: float) -> "Estimate":
        """Return the time of several workers for the work of one.

        Parameters
        ----------
        speed : float
            Seconds of work that are done in a second, by all of them together [-].

        Returns
        -------
        Estimate
            That many times less.
        """
        return Estimate(self.seconds / speed, self.low / speed, self.high / speed)


class Speed:
    """How much work is done in a second, since the first piece was finished.

    >>> speed = Speed()
    >>> speed.look(1.0, 10.0), speed.look(3.0, 11.0), speed.look(13.0, 16.0)
    (0.0, 0.0, 2.0)
    """

    def __init__(self) -> None:
        self._first: tuple[float, float] | None = None

    def look(self, work: float, now: float) -> float:
        """Note all work right after a piece was finished [s]; the work in a second, 0 in the first seconds [-]."""
        self._first = self._first or (work, now)
        spent = now - self._first[1]
        return (work - self._first[0]) / spent if spent >= _SETTLED else 0.0


class Costs:
    """What histories have taken, in equal parts of all of them.

    >>> costs = Costs(32)
    >>> costs.add(0, 16, 8.0)
    >>> costs.left() is None, costs.unseen().tolist()
    (True, [8, 9, 10, 11, 12, 13, 14, 15])
    >>> costs.add(16, 31, 15.0)
    >>> costs.left().seconds
    1.0
    """

    def __init__(self, count: int) -> None:
        self.edges = np.unique(np.linspace(0, count, PARTS + 1).astype(np.int64))
        self._missing = np.diff(self.edges).astype(np.float64)
        self._seen, self._spent = np.zeros_like(self._missing), np.zeros_like(self._missing)

    def add(self, first: Any, last: Any, seconds: Any = 0.0) -> None:
        """Note histories that are finished, and what they took; 0 where that is not known [s]."""
        share = self._overlap(first, last)
        seconds = np.broadcast_to(np.atleast_1d(seconds), len(share))
        self._missing -= share.sum(axis=0)
        self._seen += share[seconds > 0.0].sum(axis=0)
        self._spent += (share / share.sum(axis=1, keepdims=True) * seconds[:, None]).sum(axis=0)

    def shares(self, first: Any, last: Any) -> np.ndarray:
        """Return how many histories of every part are among some."""
        return np.asarray(self._overlap(first, last).sum(axis=0))

    def _overlap(self, first: Any, last: Any) -> np.ndarray:
        first, last = (np.atleast_1d(np.asarray(each, np.int64))[:, None] for each in (first, last))
        return np.asarray(np.clip(np.minimum(self.edges[1:], last) - np.maximum(self.edges[:-1], first), 0, None))

    def unseen(self) -> np.ndarray:
        """Return the parts of which nothing was measured yet, and which are not finished."""
        return np.flatnonzero((self._missing > 0.0) & (self._seen == 0.0))

    def left(self) -> Estimate | None:
        """Return the time of one worker for what is missing; None while a part of that was not measured."""
        if self.unseen().size:
            return None
        if not self._missing.any():
            return Estimate(0.0, 0.0, 0.0)
        numbers, known = np.arange(self._missing.size), self._seen > 0.0
        each = np.interp(numbers, numbers[known], self._spent[known] / self._seen[known])
        steps = np.abs(np.diff(each, prepend=each[0], append=each[-1]))
        # within a part the cost may be as far off its mean as halfway to its neighbours'
        doubt = np.sqrt(np.sum((self._missing * 0.5 * np.maximum(steps[:-1], steps[1:])) ** 2))
        best = float(np.sum(self._missing * each))
        wide = 2.0 * float(doubt) + NOISE * best
        return Estimate(best, max(0.0, best - wide), best + wide)


@dataclass(frozen=True)
class CampaignStatus:
    """How far a campaign is, as its folder says."""

    folder: Path
    histories: int
    histories_done: int  # those that are safe on disk
    chunks: int
    chunks_done: int
    running: str | None  # process that runs it now
    seconds: float  # time that all workers have spent on finished chunks [s]
    retries: int  # attempts of finished chunks beyond the first
    damaged: tuple[str, ...]  # shards found damaged or missing so far, and computed again; a ledger that was made anew
    software: str  # version of this package that computes it
    work: Estimate | None = None  # time of one worker for what is missing; None while a part was not measured yet
    broken: tuple[str, ...] = ()  # shards that are damaged or missing now, and do not count; a run computes them again

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
        share = f"{self.chunks_done} of {self.chunks} chunks ({self.histories_done} of {self.histories} histories)"
        return f"{share} are safe in {self.folder}; {now}"


@dataclass(frozen=True)
class Progress:
    """How far a run is, right after a chunk, or a piece of one that takes long, was recorded.

    Parameters
    ----------
    done_histories, total : int
        Histories that are safe, and all of them.
    chunks_done, chunks : int
        The same, in chunks.
    rate : float
        Histories a second in this run [1/s]; 0 at its start.
    left : Estimate or None
        Time that is left; None while that is being measured.
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
    left: Estimate | None
    seconds: float
    retries: int


@dataclass(frozen=True)
class Summary:
    """What a run did."""

    computed: int  # chunks that were computed in it
    resumed: int  # chunks that were there before
    adopted: int  # those of them that had been written but not recorded when an earlier run was killed
    set_aside: tuple[str, ...]  # shards that were damaged or missing, and computed again; a damaged ledger, made anew
    retries: tuple[str, ...]  # chunks that were tried again, and why
    seconds: float  # how long it took [s]


class Meter:
    """Counts what is safe, and tells it."""

    def __init__(self, folder: Path, plan: Plan, tell: Callable[[Progress], object] | None) -> None:
        self._folder, self._plan, self._tell = folder, plan, tell
        self._start = time.perf_counter()
        self._begun = self._start
        self.costs = Costs(plan.count)
        self._work = self._pace = 0.0
        self._speed = Speed()
        self.chunks = self.histories = self.resumed = 0
        self.known = False
        self._error: Exception | None = None
        self.retries: list[str] = []

    def begin(self, chunks: int, there: Iterable[tuple[int, int]]) -> None:
        """Note what is there before the first chunk of this run."""
        ends = np.array(list(there), np.int64).reshape(-1, 2)
        if ends.size:
            self.costs.add(ends[:, 0], ends[:, 1])
        self.chunks, self.histories = chunks, int(np.sum(ends[:, 1] - ends[:, 0]))
        self.resumed = self.histories
        self.known = True
        self._begun = time.perf_counter()
        self._say()

    def add(self, done: Chunk, seconds: float, *, whole: bool) -> None:
        """Note that one more chunk, or piece of one, is recorded, and what it took [s]."""
        if not self._work:
            self._begun = time.perf_counter() - seconds  # what it took to start says nothing about the rest
        self.costs.add(done.first, done.last, seconds)
        self._work += seconds
        self._pace = self._speed.look(self._work, time.perf_counter())
        self.chunks += whole
        self.histories += done.last - done.first
        self._say()

    @property
    def seconds(self) -> float:
        """Time since the start [s]."""
        return time.perf_counter() - self._start

    def sentence(self) -> str:
        """Return what is safe, in words."""
        if not self.known:
            return disk.NOTHING_LOST
        total = self._plan.chunks
        if self.chunks == total:
            return f"all {total} chunks are safe"
        pieces = self.histories > self.chunks * self._plan.size
        share = f"{self.histories} of {self._plan.count} histories" if pieces else f"{self.chunks} of {total} chunks"
        return f"{share} are safe"

    def raised(self, error: BaseException) -> bool:
        """Return whether an error is of the function that is told, and so not of the campaign."""
        return error is self._error

    def _say(self) -> None:
        if self._tell is None:
            return
        spent = time.perf_counter() - self._begun
        here = self.histories - self.resumed
        rate = here / spent if here and spent > 0.0 else 0.0
        left = self.costs.left()
        if left is not None and left.seconds:
            left = left.at(self._pace) if self._pace else None
        done = (self.histories, self._plan.count, self.chunks, self._plan.chunks)
        try:
            self._tell(Progress(*done, rate, left, self.seconds, len(self.retries)))
        except Exception as error:
            self._error = error
            raise
