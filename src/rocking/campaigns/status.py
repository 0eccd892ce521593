"""Progress of a campaign as numbers and as a sentence, and its remaining time."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns import disk
from rocking.campaigns.chunks import Chunk, Plan

PARTS = 16
"""Number of equal segments with their own cost, because the cost changes from the first to the last history."""

_SETTLED = 4.0
NOISE = 0.1  # usual variation of the speed of a machine [-]


@dataclass(frozen=True)
class Estimate:
    """Remaining time.

    Parameters
    ----------
    seconds : float
        Best estimate [s].
    low, high : float
        Probable bounds [s].
    """

    seconds: float
    low: float
    high: float

    def at(self, speed: float) -> "Estimate":
        """Return the time at another speed.

        Parameters
        ----------
        speed : float
            Work of all workers per second [-].

        Returns
        -------
        Estimate
            The estimate divided by the speed.
        """
        return Estimate(self.seconds / speed, self.low / speed, self.high / speed)


class Speed:
    """Work per second since the first finished piece.

    >>> speed = Speed()
    >>> speed.look(1.0, 10.0), speed.look(3.0, 11.0), speed.look(13.0, 16.0)
    (0.0, 0.0, 2.0)
    """

    def __init__(self) -> None:
        self._first: tuple[float, float] | None = None

    def look(self, work: float, now: float) -> float:
        """Record the total work after a piece [s]; return the work per second, 0 in the first seconds [-]."""
        self._first = self._first or (work, now)
        spent = now - self._first[1]
        return (work - self._first[0]) / spent if spent >= _SETTLED else 0.0


class Costs:
    """Cost of histories in equal segments of the campaign.

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
        """Record finished histories and their time [s]; 0 for an unknown time."""
        share = self._overlap(first, last)
        seconds = np.broadcast_to(np.atleast_1d(seconds), len(share))
        self._missing -= share.sum(axis=0)
        self._seen += share[seconds > 0.0].sum(axis=0)
        self._spent += (share / share.sum(axis=1, keepdims=True) * seconds[:, None]).sum(axis=0)

    def shares(self, first: Any, last: Any) -> np.ndarray:
        """Return the number of given histories in each segment."""
        return np.asarray(self._overlap(first, last).sum(axis=0))

    def _overlap(self, first: Any, last: Any) -> np.ndarray:
        first, last = (np.atleast_1d(np.asarray(ends, np.int64))[:, None] for ends in (first, last))
        return np.asarray(np.clip(np.minimum(self.edges[1:], last) - np.maximum(self.edges[:-1], first), 0, None))

    def unseen(self) -> np.ndarray:
        """Return the unfinished segments without a measurement."""
        return np.flatnonzero((self._missing > 0.0) & (self._seen == 0.0))

    def left(self) -> Estimate | None:
        """Return the remaining time of one worker; None while a segment has no measurement."""
        if self.unseen().size:
            return None
        if not self._missing.any():
            return Estimate(0.0, 0.0, 0.0)
        numbers, is_measured = np.arange(self._missing.size), self._seen > 0.0
        costs = np.interp(numbers, numbers[is_measured], self._spent[is_measured] / self._seen[is_measured])
        steps = np.abs(np.diff(costs, prepend=costs[0], append=costs[-1]))
        # the cost within a segment may differ from its mean by half the difference to its neighbours
        doubt = np.sqrt(np.sum((self._missing * 0.5 * np.maximum(steps[:-1], steps[1:])) ** 2))
        best = float(np.sum(self._missing * costs))
        wide = 2.0 * float(doubt) + NOISE * best
        return Estimate(best, max(0.0, best - wide), best + wide)


@dataclass(frozen=True)
class CampaignStatus:
    """Progress of a campaign, from its folder."""

    folder: Path
    histories: int
    histories_done: int  # histories on disk
    chunks: int
    chunks_done: int
    running: str | None  # process of the present run
    seconds: float  # time of all workers for finished chunks [s]
    retries: int  # attempts of finished chunks beyond the first
    damaged: tuple[str, ...]  # damaged or missing shards that were computed again, and a rebuilt ledger
    software: str  # version of this package
    work: Estimate | None = None  # remaining time of one worker; None while a segment has no measurement
    broken: tuple[str, ...] = ()  # shards that are damaged or missing at present; a run computes them again

    @property
    def complete(self) -> bool:
        """True if all histories are computed."""
        return self.chunks_done == self.chunks

    @property
    def sentence(self) -> str:
        """The progress as a sentence."""
        if self.complete:
            return f"all {self.chunks} chunks ({self.histories} histories) are safe in {self.folder}"
        now = f"{self.running} runs it" if self.running else "run the campaign again: it goes on from there"
        share = f"{self.chunks_done} of {self.chunks} chunks ({self.histories_done} of {self.histories} histories)"
        return f"{share} are safe in {self.folder}; {now}"


@dataclass(frozen=True)
class Progress:
    """Progress of a run after the record of a chunk or a piece.

    Parameters
    ----------
    done_histories, total : int
        Recorded histories, and their total.
    chunks_done, chunks : int
        Recorded chunks, and their total.
    rate : float
        Histories per second in this run [1/s]; 0 at its start.
    left : Estimate or None
        Remaining time; None during its measurement.
    seconds : float
        Time since the start of this run [s].
    retries : int
        Repeated chunks of this run.
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
    """Summary of a run."""

    computed: int  # computed chunks
    resumed: int  # chunks of earlier runs
    adopted: int  # unrecorded chunks of an earlier run
    set_aside: tuple[str, ...]  # damaged or missing shards that were computed again, and a rebuilt ledger
    retries: tuple[str, ...]  # repeated chunks, with reasons
    seconds: float  # duration [s]


class Meter:
    """Counts recorded histories and reports the progress."""

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

    def begin(self, chunks: int, ranges: Iterable[tuple[int, int]]) -> None:
        """Record the results before the first chunk of this run."""
        ends = np.array(list(ranges), np.int64).reshape(-1, 2)
        if ends.size:
            self.costs.add(ends[:, 0], ends[:, 1])
        self.chunks, self.histories = chunks, int(np.sum(ends[:, 1] - ends[:, 0]))
        self.resumed = self.histories
        self.known = True
        self._begun = time.perf_counter()
        self._say()

    def add(self, done: Chunk, seconds: float, *, is_chunk: bool) -> None:
        """Record one more chunk, or a piece of a chunk, and its time [s]."""
        if not self._work:
            self._begun = time.perf_counter() - seconds  # the start-up is not included
        self.costs.add(done.first, done.last, seconds)
        self._work += seconds
        self._pace = self._speed.look(self._work, time.perf_counter())
        self.chunks += is_chunk
        self.histories += done.last - done.first
        self._say()

    @property
    def seconds(self) -> float:
        """Time since the start [s]."""
        return time.perf_counter() - self._start

    def sentence(self) -> str:
        """Return the recorded progress as a sentence."""
        if not self.known:
            return disk.NOTHING_LOST
        total = self._plan.chunks
        if self.chunks == total:
            return f"all {total} chunks are safe"
        pieces = self.histories > self.chunks * self._plan.size
        share = f"{self.histories} of {self._plan.count} histories" if pieces else f"{self.chunks} of {total} chunks"
        return f"{share} are safe"

    def raised(self, error: BaseException) -> bool:
        """Return True for an error of the progress function."""
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
