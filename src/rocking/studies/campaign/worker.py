"""What a worker process does: it computes the chunks that it is sent, and ends when its campaign does."""

import os
import signal
import time
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


def serve(job: Job, connection: Connection, parent: int) -> None:
    """Compute chunks until told to end, or the campaign's process is gone.

    Parameters
    ----------
    job : Job
        What to compute.
    connection : Connection
        Where chunks come from and answers go to.
    parent : int
        The campaign's process.
    """
    # Ctrl-C goes to all processes of a terminal: the campaign's process decides what it means
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        while (chunk := _next(connection, parent)) is not None:
            connection.send(answer(job, chunk))
    except (EOFError, OSError):
        return


def answer(job: Job, chunk: Chunk) -> Done | Failure:
    """Return what became of a chunk; nothing that goes wrong with it ends the worker.

    Parameters
    ----------
    job : Job
        What to compute.
    chunk : Chunk
        Which.

    Returns
    -------
    Done or Failure
        The answer.
    """
    start = time.perf_counter()
    try:
        data = job.compute(chunk)
        if data is None:
            return Failure(chunk, "stopped", None)
        return job.keep(chunk, data, time.perf_counter() - start)
    except OSError as error:
        return Failure(chunk, error.strerror or str(error), error.errno)
    except Exception as error:  # noqa: BLE001 (it is raised where the campaign runs)
        return Failure(chunk, f"{type(error).__name__}: {error}", None)


def _next(connection: Connection, parent: int) -> Chunk | None:
    # a forked sibling may hold the other end open, so that its closing alone does not tell
    while not connection.poll(_LOOK):
        if os.getppid() != parent:
            return None
    received: Chunk | None = connection.recv()
    return received
