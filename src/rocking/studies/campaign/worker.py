"""What a worker process does: it computes the chunks that it is sent, and ends when its campaign does."""

import multiprocessing
import os
import signal
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import NamedTuple

from rocking.studies.campaign.chunks import Chunk
from rocking.studies.campaign.executors import Done, Job

_LOOK = 0.5


class Failure(NamedTuple):
    """A chunk that could not be computed, and why; the number is of an error of the disk."""

    chunk: Chunk
    why: str
    number: int | None


def serve(job: Job, connection: Connection) -> None:
    """Compute chunks until told to end, or the campaign's process is gone."""
    orphaned = _orphaned()
    # Ctrl-C goes to all processes of a terminal: the campaign's process decides what it means
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        while (chunk := _next(connection, orphaned)) is not None:
            connection.send(answer(job, chunk, orphaned))
    except (EOFError, OSError):
        return


def answer(job: Job, chunk: Chunk, stop: Callable[[], bool] = lambda: False) -> Done | Failure:
    """Return what became of a chunk; nothing that goes wrong with it ends the worker."""
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


def _orphaned() -> Callable[[], bool]:
    """Make the question whether the campaign's process has gone."""
    # its end closes a pipe, but a forked sibling may hold that open; a new father tells as well, but under a fork
    # server the father is the server: so both are asked
    father, campaign = os.getppid(), multiprocessing.parent_process()
    return lambda: os.getppid() != father or (campaign is not None and not campaign.is_alive())


def _next(connection: Connection, orphaned: Callable[[], bool]) -> Chunk | None:
    while not connection.poll(_LOOK):
        if orphaned():
            return None
    received: Chunk | None = connection.recv()
    return received
