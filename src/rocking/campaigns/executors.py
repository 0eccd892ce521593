"""The interface of executors, and the executor that computes in this process."""

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
"""Time between records [s]; a killed process loses at most the work of this time."""

_ASK = 0.3
_FIRST = {"fast": 64, "reference": 4}
_FASTER = 4
_REST = 0.5
SUFFIX, PIECES = ".shard", "pieces"
"""Extension of shards; folder of the pieces of incomplete chunks."""

MOST_WORKERS = 4096
_LOOK = 0.2
Stop = Callable[[], bool]
Retried = Callable[[Chunk, str], None]


class Interruption:
    """Records the first Ctrl-C or SIGTERM; the second signal has its usual effect.

    Signals arrive in the main thread only.

    >>> with Interruption() as interruption:
    ...     interruption.requested()
    False
    """

    def __init__(self) -> None:
        self._requested = False
        self._before: dict[signal.Signals, Any] = {}

    def requested(self) -> bool:
        """Return True if a stop was requested."""
        return self._requested

    def __enter__(self) -> "Interruption":
        if threading.current_thread() is threading.main_thread():
            self._before = {
                signal_number: signal.signal(signal_number, self._note)
                for signal_number in (signal.SIGINT, signal.SIGTERM)
            }
        return self

    def __exit__(self, *_: object) -> None:
        for signal_number, handler in self._before.items():
            signal.signal(signal_number, handler if handler is not None else signal.SIG_DFL)
        self._before = {}

    def _note(self, number: int, frame: FrameType | None) -> None:
        self._requested = True
        self.__exit__()


class Pace:
    """Number of histories per step, adapted so that a step takes a short time."""

    def __init__(self, engine: str, together: int = 1, synthetic: bool = False) -> None:
        self.least = _FIRST[kind_of(engine)]
        self.step = min(self.least, together) if synthetic else self.least
        self.together = together
        self._first: tuple[int, float] | None = None
        self._startup = 0.0
        self.begun = False

    def until(self, first: int, last: int) -> int:
        """Return the end of the next step. The steps are equal, because short steps leave lanes idle."""
        left = last - first
        end = first + -(-left // -(-left // self.step))
        between = end - end % self.together
        return between if end < last and between > first else end

    def took(self, count: int, seconds: float) -> None:
        """Adapt the number to the time of a step [s]."""
        if self._first is None:
            self._first = count, seconds
        elif not self.begun:
            self.begun, self._startup = True, max(0.0, self._first[1] - self._first[0] * seconds / count)
        step = int(count * _ASK / max(seconds, 1e-6))
        if step < self.step or 2 * count >= self.step:  # a short last step gives no information on longer steps
            self.step = max(1, min(step, _FASTER * self.step, DEFAULT_CHUNK))

    def settled(self, seconds: float) -> float:
        """Return the time of a piece without the start-up in its first step (loading of code and motions) [s]."""
        startup, self._startup = self._startup, 0.0
        return seconds - startup if startup < seconds else seconds


class Done(NamedTuple):
    """A chunk with its shard on disk, or the first piece of a slow chunk."""

    chunk: Chunk
    seal: str
    size: int
    seconds: float
    worker: str
    attempts: int = 1


@dataclass(frozen=True, eq=False)
class WorkerTask:
    """Data for workers, which can be pickled."""

    histories: Histories
    engine: str  # required engine with fingerprint
    software: str  # required version of this package
    folder: Path  # folder of the shards
    pace: Pace = field(init=False)

    def __post_init__(self) -> None:
        """Start with few histories per step."""
        synthetic = not self.histories.motions.in_memory
        object.__setattr__(self, "pace", Pace(self.engine, self.histories.together, synthetic))

    def check(self) -> None:
        """Refuse a computation with another version or other last digits."""
        software = identity.software()
        if software != self.software:
            raise CampaignWorkerError(
                "this worker has version {software}, but the campaign started with version {expected}",
                software=software,
                expected=self.software,
            )  # fmt: skip
        here, expected = identity.engine_of(self.histories), self.engine
        if kind_of(here) != kind_of(expected):
            kinds = f"{kind_of(here)} engine, but the campaign needs the {kind_of(expected)} engine"
            raise CampaignWorkerError("this worker has the {versions}", versions=kinds)
        if here != expected:
            raise CampaignWorkerError(
                "results of this worker differ in the last digits: the worker has engine {engine}, the campaign has "
                "engine {expected} ({reason})", engine=here, expected=expected, reason=identity.LAST_DIGITS,
            )  # fmt: skip

    def compute(self, chunk: Chunk, threads: int | None = 1, stop: Stop = lambda: False) -> bytes | None:
        """Return the result file (shard) of a chunk, or of its first second of computing; None after a stop."""
        results = empty_results(chunk.last - chunk.first, self.histories.columns)
        last = self.fill(results, chunk, threads, stop)
        return None if last is None else shard.pack(chunk.piece(chunk.first, last), results)

    def fill(self, results: Arrays, chunk: Chunk, threads: int | None, stop: Stop) -> int | None:
        """Compute a chunk for about a second; return the first history that is missing, or None after a stop."""
        self.check()
        first, begun = chunk.first, time.perf_counter()
        while first < chunk.last:
            spent, done = time.perf_counter() - begun, first - chunk.first
            # a piece ends after a second, unless the remaining histories need less than half a second
            if spent > PIECE and done > 0 and (chunk.last - first) * spent > _REST * PIECE * done:
                break
            if done and stop():
                return None
            start, last = time.perf_counter(), self.pace.until(first, chunk.last)
            for name, values in self.histories.run(first, last, threads=threads).items():
                results[name][done : last - chunk.first] = values
            if not self.pace.begun:
                begun = time.perf_counter()  # the first step includes the start-up
            self.pace.took(last - first, time.perf_counter() - start)
            first = last
        return first

    def keep(self, chunk: Chunk, data: bytes, seconds: float, worker: str = "") -> Done:
        """Write the shard of a chunk or piece; `seconds` is its computing time."""
        done = chunk.piece(*shard.range_of(data))
        disk.write_new(path_of(self.folder, done), data)
        return Done(done, shard.seal(data), len(data), seconds, worker or f"process {os.getpid()}")


def path_of(folder: Path, chunk: Chunk) -> Path:
    """Return the path of the shard of a chunk or piece."""
    return (folder.with_name(PIECES) if chunk.parent else folder) / f"{chunk.name}{SUFFIX}"


class Executor(ABC):
    """Computes chunks; the shards are independent of the executor."""

    at_once = 1
    """Number of workers."""

    @abstractmethod
    def run(self, job: WorkerTask, chunks: Iterator[Chunk], stop: Stop, retried: Retried) -> Iterator[Done]:
        """Compute chunks; the number of pending chunks is limited.

        Parameters
        ----------
        job : WorkerTask
            The task.
        chunks : iterator of Chunk
            The remaining chunks; it ends early after a stop.
        stop : callable
            Returns True to stop within a second.
        retried : callable
            Called with each repeated chunk and the reason.

        Yields
        ------
        Done
            Chunks with shards on disk, in any order, or the first piece of a slow chunk. The iterator `chunks` then
            returns the remaining piece, even after its end.
        """


def cannot_be_sent(error: Exception) -> str:
    """Return the error text of histories that cannot be pickled."""
    return f"the histories cannot be sent to a process: {error}; lambdas and local functions cannot, named ones can"


class Serial(Executor):
    """Computes the chunks one after another in this process.

    A second thread computes the next chunk while a chunk is packed, written, recorded and reported. The second thread
    calls `Histories.run`, one call at a time, possibly during the progress function. At most two chunks and one file
    are in memory. The thread ends at the end of the run.

    Parameters
    ----------
    threads : int, optional
        Threads of the fast engine. Default: the number of processor cores.
    """

    def __init__(self, threads: int | None = None) -> None:
        self._threads = None if threads is None else checks.whole("workers", threads, 1, MOST_WORKERS)

    def run(self, job: WorkerTask, chunks: Iterator[Chunk], stop: Stop, retried: Retried) -> Iterator[Done]:
        """Compute chunks one after another; a chunk that began before a stop is discarded."""
        over, pool = Event(), ThreadPoolExecutor(1, "campaign")

        def compute(results: Arrays, chunk: Chunk) -> tuple[int, float] | None:
            start = time.perf_counter()
            last = job.fill(results, chunk, self._threads, lambda: over.is_set() or stop())
            return None if last is None else (last, job.pace.settled(time.perf_counter() - start))

        def begin() -> tuple[Chunk, Arrays, Future[tuple[int, float] | None]] | None:
            """Begin the next chunk, if there is one. Its results are complete at the end of its task."""
            chunk = next(chunks, None)
            if chunk is None:
                return None
            results = empty_results(chunk.last - chunk.first, job.histories.columns)
            # the task has the context of the caller, which includes the overflow settings of NumPy
            return chunk, results, pool.submit(copy_context().run, compute, results, chunk)

        try:
            begun = begin()
            while begun is not None:
                chunk, results, future = begun
                while not wait([future], _LOOK).done:
                    pass  # on some systems, Ctrl-C does not interrupt a wait without time limit
                done = future.result()
                if done is None:
                    return
                begun = begin()
                yield job.keep(chunk, shard.pack(chunk.piece(chunk.first, done[0]), results), done[1])
                if stop():  # after a stop, the next chunk is discarded
                    return
                begun = begun or begin()  # `chunks` may now return the remaining piece of the last chunk
        finally:
            over.set()  # the thread stops at its next check
            pool.shutdown()
