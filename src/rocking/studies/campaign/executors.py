"""Who computes the chunks, and the rules for all who do."""

import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from rocking.dynamics.engine import Arrays, empty_results
from rocking.errors import InvalidValueError
from rocking.studies.campaign import disk, fingerprint, identity, shard
from rocking.studies.campaign.chunks import Chunk
from rocking.studies.campaign.errors import CampaignWorkerError
from rocking.studies.campaign.fingerprint import kind_of
from rocking.studies.campaign.pace import Pace, Watch
from rocking.studies.histories import Histories

SUFFIX, PIECES = ".shard", "pieces"
"""End of the names of shards; the folder of those that are pieces of a chunk, until it is whole."""


class Done(NamedTuple):
    """A chunk whose shard is on disk; a piece from its start, where all of it takes long."""

    chunk: Chunk
    seal: str
    size: int
    seconds: float
    worker: str
    attempts: int = 1


@dataclass(frozen=True, eq=False)
class Job:
    """What workers need: it can be pickled."""

    histories: Histories  # what to compute
    engine: str  # the engine that all workers must have, with the last digits that it gives
    software: str  # version of this package that all workers must have
    folder: Path  # where the shards are
    pace: Pace = field(init=False)

    def __post_init__(self) -> None:
        """Start with few histories at a time."""
        made = not self.histories.motions.in_memory
        object.__setattr__(self, "pace", Pace(self.engine, self.histories.together, made))

    def check(self) -> None:
        """Refuse to compute what this campaign would not recognise as its own bits."""
        software = identity.software()
        if software != self.software:
            raise CampaignWorkerError(
                f"this worker has version {software}, the campaign was begun with {self.software}"
            )
        here, wanted = fingerprint.engine_of(self.histories), self.engine
        if kind_of(here) != kind_of(wanted):
            kinds = f"{kind_of(here)} engine, the campaign takes the {kind_of(wanted)} one"
            raise CampaignWorkerError(f"this worker has the {kinds}")
        if here != wanted:
            raise CampaignWorkerError(
                f"this worker computes other last digits: its engine is {here}, that of the campaign is {wanted} "
                f"({fingerprint.LAST_DIGITS})"
            )

    def compute(self, chunk: Chunk, threads: int | None = 1, stop: Callable[[], bool] = lambda: False) -> bytes | None:
        """Return the shard of a chunk, or of as much of it from its start as takes a second.

        Returns the shard, which says how far it goes; None if it was stopped.
        """
        results = empty_results(chunk.last - chunk.first)
        last = self.fill(results, chunk, threads, stop)
        return None if last is None else shard.pack(chunk.piece(chunk.first, last), results)

    def fill(self, results: Arrays, chunk: Chunk, threads: int | None, stop: Callable[[], bool]) -> int | None:
        """Compute the results of a chunk, or of as much of it from its start as takes a second.

        Returns how far it came: the first history that is not there; None if it was stopped.
        """
        self.check()
        first, watch = chunk.first, Watch()
        while first < chunk.last and not watch.over(first - chunk.first, chunk.last - first):
            if first > chunk.first and stop():
                return None
            start, last = time.perf_counter(), self.pace.until(first, chunk.last)
            for name, values in self.histories.run(first, last, threads=threads).items():
                results[name][first - chunk.first : last - chunk.first] = values
            if not self.pace.begun:
                watch = Watch()  # the first step of all starts much else
            self.pace.took(last - first, time.perf_counter() - start)
            first = last
        return first

    def keep(self, chunk: Chunk, data: bytes, seconds: float, worker: str = "") -> Done:
        """Write the shard of a chunk, or of a piece of it.

        seconds: what it took [s].
        """
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
    def run(
        self, job: Job, chunks: Iterator[Chunk], stop: Callable[[], bool], retried: Callable[[Chunk, str], None]
    ) -> Iterator[Done]:
        """Compute chunks, taking no more of them than are being computed or about to be.

        Parameters
        ----------
        job : Job
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


def chosen(executor: "str | Executor", workers: int | None, start_method: str | None) -> Executor:
    """Return the executor that was asked for."""
    given: object = executor
    if given != "processes" and start_method is not None:
        raise InvalidValueError(f'start_method={start_method!r} goes with executor="processes" only')
    if isinstance(given, Executor):
        if workers is not None:
            raise InvalidValueError(f"workers={workers!r} goes with the name of an executor; the object has its own")
        return given
    if given == "serial":
        from rocking.studies.campaign.serial import Serial

        return Serial(workers)
    if given == "processes":
        from rocking.studies.campaign.processes import Processes

        return Processes(workers, start_method or "spawn")
    raise InvalidValueError(f'executor must be "serial", "processes" or an Executor, got {given!r:.60}')


def whole(name: str, value: object, high: int = 4096) -> int:
    """Return a whole number of things of which there is at least one."""
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= high:
        raise InvalidValueError(f"{name} must be a whole number in [1, {high}], got {value!r:.60}")
    return value
