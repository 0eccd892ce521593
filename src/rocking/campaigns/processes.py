"""Workers in processes of this machine; each may end at any time."""

import contextlib
import multiprocessing
import os
import pickle
import signal
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import closing
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, NamedTuple

from rocking import checks
from rocking.campaigns.chunks import Chunk
from rocking.campaigns.disk import CampaignWorkerError
from rocking.campaigns.executors import MOST_WORKERS, Done, Executor, Retried, Serial, Stop, WorkerTask, cannot_be_sent
from rocking.errors import InvalidValueError

_WATCH = 0.5
_ATTEMPTS = 3
_AHEAD = 2
_LOOK = 0.1
_GRACE = 0.8
_GUARD = 'check the memory; a script that starts processes needs if __name__ == "__main__": around its calls'


class Failure(NamedTuple):
    """A chunk that failed, and the reason; `number` is the error number of the disk, if there is one."""

    chunk: Chunk
    reason: str
    number: int | None


def serve(job: WorkerTask, connection: Connection) -> None:
    """Compute chunks until the end, or until the process of the campaign has ended."""
    # The end of the campaign's process closes a pipe, but a forked sibling can keep the pipe open. The parent process
    # then changes too, but the parent can be a fork server. Therefore both are checked.
    father, campaign = os.getppid(), multiprocessing.parent_process()

    def orphaned() -> bool:
        return os.getppid() != father or (campaign is not None and not campaign.is_alive())

    # Ctrl-C reaches all processes of a terminal; only the process of the campaign reacts
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        while True:
            if connection.poll(_WATCH):
                if (chunk := connection.recv()) is None:
                    return
                connection.send(answer(job, chunk, orphaned))
            elif orphaned():
                return
    except (EOFError, OSError):
        return


def answer(job: WorkerTask, chunk: Chunk, stop: Callable[[], bool] = lambda: False) -> Done | Failure:
    """Return the result of a chunk; an error does not end the worker."""
    start = time.perf_counter()
    try:
        data = job.compute(chunk, 1, stop)
        if data is None:
            return Failure(chunk, "stopped", None)
        return job.keep(chunk, data, job.pace.settled(time.perf_counter() - start))
    except OSError as error:
        return Failure(chunk, error.strerror or str(error), error.errno)
    except Exception as error:  # noqa: BLE001 (it is raised where the campaign runs)
        return Failure(chunk, f"{type(error).__name__}: {error}", None)


class Processes(Executor):
    """Computes the chunks in processes of this machine, with one engine thread each."""

    def __init__(self, workers: int | None = None, start_method: str = "spawn") -> None:
        self.start_method = checks.one_of("start_method", start_method, multiprocessing.get_all_start_methods())
        affinity = getattr(os, "sched_getaffinity", None)
        processors = len(affinity(0)) if affinity else os.cpu_count() or 1
        self.at_once = processors if workers is None else checks.whole("workers", workers, 1, MOST_WORKERS)

    def run(self, job: WorkerTask, chunks: Iterator[Chunk], stop: Stop, retried: Retried) -> Iterator[Done]:
        with closing(_Crew(self.at_once, self.start_method, job, retried)) as crew:
            deadline = None
            while crew.feed(chunks, stop):
                if deadline is None and stop():
                    deadline = time.monotonic() + _GRACE
                if deadline is not None and time.monotonic() > deadline:
                    return
                yield from crew.collect()


class _Member:
    """A worker and its chunks with the number of attempts; the first chunk is in progress."""

    def __init__(self, context: Any, job: WorkerTask) -> None:
        self.connection, theirs = context.Pipe()
        self.tasks: deque[tuple[Chunk, int]] = deque()
        self.process: BaseProcess = context.Process(target=serve, args=(job, theirs), daemon=True)
        try:
            with _no_interruption():
                self.process.start()
        except (AttributeError, TypeError, pickle.PicklingError) as error:
            raise CampaignWorkerError(cannot_be_sent(error)) from error
        finally:
            theirs.close()

    def send(self, chunk: Chunk, attempts: int) -> None:
        self.tasks.append((chunk, attempts))
        with contextlib.suppress(OSError):  # an error means that the worker has ended; its tasks include this chunk
            self.connection.send(chunk)

    def answers(self, ready: set[Any]) -> Iterator[Done | Failure | None]:
        """Yield the results of the worker; None if the worker has ended."""
        if self.connection not in ready and self.process.sentinel not in ready:
            return
        try:
            while self.connection.poll():
                yield self.connection.recv()
        except (EOFError, OSError):
            yield None
            return
        if self.process.sentinel in ready:
            yield None

    def end(self) -> None:
        self.process.kill()
        self.process.join()
        self.connection.close()
        self.process.close()


class _Crew:
    """The workers of a run."""

    def __init__(self, count: int, start_method: str, job: WorkerTask, retried: Retried) -> None:
        self._wanted, self._job, self._retried = count, job, retried
        self._context = multiprocessing.get_context(start_method)
        self._members: list[_Member] = []
        self._again: deque[tuple[Chunk, int]] = deque()

    def feed(self, chunks: Iterator[Chunk], stop: Stop) -> bool:
        """Distribute chunks to free workers; return True if any chunk is in progress."""
        while not stop() and (len(self._members) < self._wanted or len(self._least().tasks) < _AHEAD):
            task = self._again.popleft() if self._again else (next(chunks, None), 1)
            if task[0] is None:
                break
            if len(self._members) < self._wanted and (not self._members or self._least().tasks):
                self._members.append(_Member(self._context, self._job))
            self._least().send(task[0], task[1])
        return any(member.tasks for member in self._members)

    def collect(self) -> Iterator[Done]:
        """Wait briefly; yield finished chunks, raise failures, and replace ended workers."""
        watched: list[Any] = [m.connection for m in self._members] + [m.process.sentinel for m in self._members]
        ready = set(wait(watched, _LOOK))
        for member in list(self._members):
            for answer in member.answers(ready):
                if answer is None:
                    self._bury(member)
                    break
                if isinstance(answer, Failure):
                    if answer.number is not None:
                        raise OSError(answer.number, answer.reason)
                    raise CampaignWorkerError(
                        "the computation of histories {first} to {last} failed: {reason}",
                        first=answer.chunk.first, last=answer.chunk.last - 1,
                        reason=answer.reason,
                    )  # fmt: skip
                yield answer._replace(attempts=member.tasks.popleft()[1])

    def close(self) -> None:
        """End all workers; unfinished chunks are discarded."""
        for member in self._members:
            member.end()
        self._members = []

    def _least(self) -> _Member:
        return min(self._members, key=lambda member: len(member.tasks))

    def _bury(self, member: _Member) -> None:
        self._members.remove(member)
        member.process.join()
        cause = _cause(member.process.exitcode)
        for position, (chunk, attempts) in enumerate(reversed(member.tasks), 1 - len(member.tasks)):
            at_work = position == 0
            if at_work and attempts >= _ATTEMPTS:
                raise CampaignWorkerError(
                    "{attempts} workers ended during the computation of histories {first} to {last}, the last worker "
                    "{cause}",
                    first=chunk.first, last=chunk.last - 1, attempts=attempts, cause=cause, hint=_GUARD,
                )  # fmt: skip
            self._again.appendleft((chunk, attempts + at_work))
            if at_work:
                self._retried(chunk, f"a worker ended ({cause}); its chunk is computed again")
        member.end()


def _cause(code: int | None) -> str:
    if code is None or code >= 0:
        return f"with code {code}"
    with contextlib.suppress(ValueError):
        return f"by {signal.Signals(-code).name}"
    return f"by signal {-code}"


@contextlib.contextmanager
def _no_interruption() -> Iterator[None]:
    """Block Ctrl-C for a new worker until the worker ignores the signal."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def chosen(executor: str | Executor, workers: int | None, start_method: str | None) -> Executor:
    """Return the executor for a name, or the given executor."""
    if executor != "processes" and start_method is not None:
        raise InvalidValueError(
            '{parameter}={value} applies to executor="processes" only', parameter="start_method", value=start_method
        )
    if isinstance(executor, Executor):
        if workers is not None:
            raise InvalidValueError(
                "{parameter}={value} is allowed only if executor is a name", parameter="workers", value=workers,
                hint="an Executor object has its own number of workers",
            )  # fmt: skip
        return executor
    if executor == "serial":
        return Serial(workers)
    if executor == "processes":
        return Processes(workers, start_method or "spawn")
    raise InvalidValueError(parameter="executor", allowed='"serial", "processes" or an Executor', value=executor)
