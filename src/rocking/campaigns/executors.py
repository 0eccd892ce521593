"""Who computes the chunks and the rules for all who do; the executor that computes them in this process."""

import os
import signal
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextvars import copy_context
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event
from types import FrameType
from typing import Any, NamedTuple

from rocking import checks
from rocking.campaigns import chunks as shard
from rocking.campaigns import disk, identity
from rocking.campaigns.chunks import DEFAULT_CHUNK, Chunk
from rocking.campaigns.disk import CampaignWorkerError
from rocking.campaigns.identity import kind_of
from rocking.dynamics.plane.fast_engine import Arrays, empty_results
from rocking.studies.histories import Histories

PIECE = 1.0
"""Time after which what is computed is kept [s]: a kill costs no more, a count moves as often."""

_ASK = 0.3
_FIRST = {"fast": 64, "reference": 4}
_FASTER = 4
_REST = 0.5
SUFFIX, PIECES = ".shard", "pieces"
"""End of the names of shards; the folder of those that are pieces of a chunk, until it is whole."""

MOST_WORKERS = 4096
_LOOK = 0.2
Stop = Callable[[], bool]
Retried = Callable[[Chunk, str], None]


class Interruption:
    """Notes the first Ctrl-C or SIGTERM; the second one stops at once, as if this was not here.

    Outside of the main thread nothing is noted: signals never arrive there.

    >>> with Interruption() as interruption:
    ...     interruption.requested()
    False
    """

    def __init__(self) -> None:
        self._requested = False
        self._before: dict[signal.Signals, Any] = {}

    def requested(self) -> bool:
        """Return whether to stop."""
        return self._requested

    def __enter__(self) -> "Interruption":
        if threading.current_thread() is threading.main_thread():
            self._before = {each: signal.signal(each, self._note) for each in (signal.SIGINT, signal.SIGTERM)}
        return self

    def __exit__(self, *_: object) -> None:
        for each, handler in self._before.items():
            signal.signal(each, handler if handler is not None else signal.SIG_DFL)
        self._before = {}

    def _note(self, number: int, frame: FrameType | None) -> None:
        self._requested = True
        self.__exit__()


class Pace:
    """How many histories at a time take as long as nobody minds to wait, learned from one step to the next."""

    def __init__(self, engine: str, together: int = 1, synthetic: bool = False) -> None:
        self.least = _FIRST[kind_of(engine)]
        self.step = min(self.least, together) if synthetic else self.least
        self.together = together
        self._first: tuple[int, float] | None = None
        self._startup = 0.0
        self.begun = False

    def until(self, first: int, last: int) -> int:
        """Return where to stop: after equal steps, since short ones leave lanes idle."""
        left = last - first
        end = first + -(-left // -(-left // self.step))
        between = end - end % self.together
        return between if end < last and between > first else end

    def took(self, count: int, seconds: float) -> None:
        """Learn from a step and the seconds that it took."""
        if self._first is None:
            self._first = count, seconds
        elif not self.begun:
            self.begun, self._startup = True, max(0.0, self._first[1] - self._first[0] * seconds / count)
        wanted = int(count * _ASK / max(seconds, 1e-6))
        if wanted < self.step or 2 * count >= self.step:  # the end of a piece says nothing about longer steps
            self.step = max(1, min(wanted, _FASTER * self.step, DEFAULT_CHUNK))

    def settled(self, seconds: float) -> float:
        """Return the seconds of a piece without what its first step took beyond its histories: code, motions."""
        startup, self._startup = self._startup, 0.0
        return seconds - startup if startup < seconds else seconds


class Done(NamedTuple):
    """A chunk whose shard is on disk; a piece from its start, where all of it takes long."""

    chunk: Chunk
    seal: str
    size: int
    seconds: float
    worker: str
    attempts: int = 1


@dataclass(frozen=True, eq=False)
class WorkerTask:
    """What workers need: it can be pickled."""

    histories: Histories  # what to compute
    engine: str  # the engine that all workers must have, with the last digits that it gives
    software: str  # version of this package that all workers must have
    folder: Path  # where the shards are
    pace: Pace = field(init=False)

    def __post_init__(self) -> None:
        """Start with few histories at a time."""
        synthetic = not self.histories.motions.in_memory
        object.__setattr__(self, "pace", Pace(self.engine, self.histories.together, synthetic))

    def check(self) -> None:
        """Refuse to compute what this campaign would not recognise as its own bits."""
        software = identity.software()
        if software != self.software:
            raise CampaignWorkerError(
                "this worker has version {software}, the campaign was begun with {expected}", software=software,
                expected=self.software,
            )  # fmt: skip
        here, wanted = identity.engine_of(self.histories), self.engine
        if kind_of(here) != kind_of(wanted):
            kinds = f"{kind_of(here)} engine, the campaign takes the {kind_of(wanted)} one"
            raise CampaignWorkerError("this worker has the {versions}", versions=kinds)
        if here != wanted:
            raise CampaignWorkerError(
                "this worker computes other last digits: its engine is {engine}, that of the campaign is {expected} "
                "({reason})", engine=here, expected=wanted, reason=identity.LAST_DIGITS,
            )  # fmt: skip

    def compute(self, chunk: Chunk, threads: int | None = 1, stop: Stop = lambda: False) -> bytes | None:
        """Return the shard of a chunk, or of as much of it from its start as takes a second; None if it was stopped."""
        results = empty_results(chunk.last - chunk.first, self.histories.columns)
        last = self.fill(results, chunk, threads, stop)
        return None if last is None else shard.pack(chunk.piece(chunk.first, last), results)

    def fill(self, results: Arrays, chunk: Chunk, threads: int | None, stop: Stop) -> int | None:
        """Compute a chunk, or as much of it as takes a second; the first history that is not there, None if stopped."""
        self.check()
        first, begun = chunk.first, time.perf_counter()
        while first < chunk.last:
            spent, done = time.perf_counter() - begun, first - chunk.first
            # a piece is long enough after a second, unless the rest takes less than half of one
            if spent > PIECE and done > 0 and (chunk.last - first) * spent > _REST * PIECE * done:
                break
            if done and stop():
                return None
            start, last = time.perf_counter(), self.pace.until(first, chunk.last)
            for name, values in self.histories.run(first, last, threads=threads).items():
                results[name][done : last - chunk.first] = values
            if not self.pace.begun:
                begun = time.perf_counter()  # the first step of all starts much else
            self.pace.took(last - first, time.perf_counter() - start)
            first = last
        return first

    def keep(self, chunk: Chunk, data: bytes, seconds: float, worker: str = "") -> Done:
        """Write the shard of a chunk, or of a piece of it, which took some seconds."""
        done = chunk.piece(*shard.range_of(data))
        disk.write_new(path_of(self.folder, done), data)
        return Done(done, shard.seal(data), len(data), seconds, worker or f"process {os.getpid()}")


def path_of(folder: Path, chunk: Chunk) -> Path:
    """Return where the shard of a chunk is, or of a piece of one."""
    return (folder.with_name(PIECES) if chunk.of else folder) / f"{chunk.name}{SUFFIX}"


class Executor(ABC):
    """Computes chunks, wherever; the shards are the same whoever does."""

    at_once = 1
    """How many workers share the work."""

    @abstractmethod
    def run(self, job: WorkerTask, chunks: Iterator[Chunk], stop: Stop, retried: Retried) -> Iterator[Done]:
        """Compute chunks, taking no more of them than are being computed or about to be.

        Parameters
        ----------
        job : WorkerTask
            What to compute.
        chunks : iterator of Chunk
            What remains to be done; it ends early when the campaign is to stop.
        stop : callable
            Whether to stop within a second.
        retried : callable
            Called with a chunk that is tried again, and why.

        Yields
        ------
        Done
            Chunks whose shards are on disk, in any order. Of one that takes long it is a piece from its start; the
            iterator then gives the rest, also after it had ended.
        """


def cannot_be_sent(error: Exception) -> str:
    """Return what is said of histories that cannot be pickled."""
    return f"the histories cannot be sent to a process: {error}; lambdas and local functions cannot, named ones can"


class Serial(Executor):
    """Computes the chunks one after another in this process.

    While a chunk is packed, written, recorded and told, a second thread computes the next one: `Histories.run` is
    called there, never twice at a time, and at the same time as the function that is told of the progress. No more
    than two chunks and the file of one are held in memory, and the thread has ended when the run has, however it ends.

    Parameters
    ----------
    threads : int, optional
        Threads of the fast engine; as many as the processor has, if not given.
    """

    def __init__(self, threads: int | None = None) -> None:
        self._threads = None if threads is None else checks.whole("workers", threads, 1, MOST_WORKERS)

    def run(self, job: WorkerTask, chunks: Iterator[Chunk], stop: Stop, retried: Retried) -> Iterator[Done]:
        """Compute chunks one after another; of one that is begun too early nothing is wanted."""
        over, pool = Event(), ThreadPoolExecutor(1, "campaign")

        def compute(results: Arrays, chunk: Chunk) -> tuple[int, float] | None:
            start = time.perf_counter()
            last = job.fill(results, chunk, self._threads, lambda: over.is_set() or stop())
            return None if last is None else (last, job.pace.settled(time.perf_counter() - start))

        def begin() -> tuple[Chunk, Arrays, Future[tuple[int, float] | None]] | None:
            """Begin the next chunk, if there is one; its results are there as soon as its time is known."""
            chunk = next(chunks, None)
            if chunk is None:
                return None
            results = empty_results(chunk.last - chunk.first, job.histories.columns)
            # in the context of the caller: what NumPy does about an overflow is part of it
            return chunk, results, pool.submit(copy_context().run, compute, results, chunk)

        try:
            begun = begin()
            while begun is not None:
                chunk, results, future = begun
                while not wait([future], _LOOK).done:
                    pass  # a wait without end would not be woken by Ctrl-C everywhere
                done = future.result()
                if done is None:
                    return
                begun = begin()
                yield job.keep(chunk, shard.pack(chunk.piece(chunk.first, done[0]), results), done[1])
                if stop():  # as if the next one had not been begun
                    return
                begun = begun or begin()  # what was left of the last one
        finally:
            over.set()  # the thread leaves its chunk as soon as it asks
            pool.shutdown()
