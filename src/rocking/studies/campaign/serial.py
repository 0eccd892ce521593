"""The executor that computes the chunks in this process: one is written while the next one is computed."""

import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextvars import copy_context
from threading import Event

from rocking.dynamics.engine import Arrays, empty_results
from rocking.studies.campaign import shard
from rocking.studies.campaign.chunks import Chunk
from rocking.studies.campaign.executors import Done, Executor, Job, whole

_LOOK = 0.2


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
        self._threads = None if threads is None else whole("workers", threads)

    def run(
        self, job: Job, chunks: Iterator[Chunk], stop: Callable[[], bool], retried: Callable[[Chunk, str], None]
    ) -> Iterator[Done]:
        """Compute chunks.

        Parameters
        ----------
        job : Job
            What to compute.
        chunks : iterator of Chunk
            What remains to be done.
        stop : callable
            Whether to stop: a large chunk is left unfinished then, and one that was begun too early is not wanted.
        retried : callable
            Never called.

        Yields
        ------
        Done
            One after another.
        """
        with _Ahead(job, self._threads, stop) as ahead:
            begun = ahead.begin(chunks)
            while begun is not None:
                chunk, results = begun
                found = ahead.found()
                if found is None:
                    return
                last, seconds = found
                begun = ahead.begin(chunks)
                yield job.keep(chunk, shard.pack(chunk.piece(chunk.first, last), results), seconds)
                if stop():  # as if the next one had not been begun
                    return
                begun = begun or ahead.begin(chunks)  # what was left of the last one


class _Ahead:
    """The thread that computes, one chunk at a time."""

    def __init__(self, job: Job, threads: int | None, stop: Callable[[], bool]) -> None:
        self._job, self._threads, self._stop = job, threads, stop
        self._over = Event()
        self._pool = ThreadPoolExecutor(1, "campaign")
        self._begun: Future[tuple[int, float] | None]

    def __enter__(self) -> "_Ahead":
        return self

    def __exit__(self, *_: object) -> None:
        """Wait for the thread, which leaves its chunk as soon as it asks; what it says then is not wanted."""
        self._over.set()
        self._pool.shutdown()

    def begin(self, chunks: Iterator[Chunk]) -> tuple[Chunk, Arrays] | None:
        """Begin the next chunk, if there is one; its results are there as soon as its time is known."""
        chunk = next(chunks, None)
        if chunk is None:
            return None
        results = empty_results(chunk.last - chunk.first)
        # in the context of the caller: what NumPy does about an overflow is part of it
        self._begun = self._pool.submit(copy_context().run, self._compute, results, chunk)
        return chunk, results

    def found(self) -> tuple[int, float] | None:
        """Wait for the chunk that was begun: how far it came, and what it took [s]; None if it was stopped."""
        while not wait([self._begun], _LOOK).done:
            pass  # a wait without end would not be woken by Ctrl-C everywhere
        return self._begun.result()

    def _compute(self, results: Arrays, chunk: Chunk) -> tuple[int, float] | None:
        start = time.perf_counter()
        last = self._job.fill(results, chunk, self._threads, lambda: self._over.is_set() or self._stop())
        return None if last is None else (last, self._job.pace.settled(time.perf_counter() - start))
