"""Workers of an existing Dask cluster: they return shards, which this process writes."""

import os
import pickle
import socket
import time
from collections.abc import Iterator
from importlib import import_module
from types import ModuleType
from typing import Any

from rocking import checks
from rocking.campaigns.chunks import Chunk
from rocking.campaigns.disk import CampaignWorkerError
from rocking.campaigns.executors import MOST_WORKERS, Done, Executor, Retried, Stop, WorkerTask, cannot_be_sent
from rocking.errors import InvalidValueError, MissingExtraError, how_to_install

_LOOK = 0.2
_GRACE = 0.8


class DaskExecutor(Executor):
    """Computes the chunks on a Dask cluster; its workers need this package, but not the folder.

    Parameters
    ----------
    address : str
        Address of the scheduler, as in ``tcp://host:8786``.
    ahead : int
        Chunks per thread of the cluster; this limits the results in memory.
    timeout : float
        Time limit of the search for the scheduler [s].

    Raises
    ------
    InvalidValueError
        If the address is empty.
    """

    def __init__(self, address: str, *, ahead: int = 2, timeout: float = 10.0) -> None:
        value: object = address
        if not isinstance(value, str) or not value:
            raise InvalidValueError(
                parameter="address", allowed='the address of a scheduler, such as "tcp://host:8786"', value=value
            )
        self.address, self.ahead, self.timeout = address, checks.whole("ahead", ahead, 1, MOST_WORKERS), timeout

    def run(self, job: WorkerTask, chunks: Iterator[Chunk], stop: Stop, retried: Retried) -> Iterator[Done]:
        """Compute chunks. Lost chunks are submitted again; the cluster itself repeats the chunks of an ended worker."""
        try:
            dask = import_module("distributed")
        except ImportError as error:
            raise MissingExtraError(how_to_install("a campaign on a Dask cluster", "distributed", error)) from error
        try:
            client = dask.Client(self.address, timeout=self.timeout, set_as_default=False)
        except (OSError, ValueError) as error:
            raise CampaignWorkerError(
                "the Dask scheduler at {address} does not respond: {reason}", address=self.address, reason=str(error)
            ) from error
        with client:
            yield from _Window(dask, client, job, self).work(chunks, stop, retried)


class _Window:
    """The few chunks on the cluster."""

    def __init__(self, dask: ModuleType, client: Any, job: WorkerTask, executor: DaskExecutor) -> None:
        self._dask, self._client, self._job, self._executor = dask, client, job, executor
        try:
            pickled = pickle.dumps(job)
        except (AttributeError, TypeError, pickle.PicklingError) as error:
            raise CampaignWorkerError(cannot_be_sent(error)) from error
        # the data are a task instead of scattered data, so that another worker can repeat this task
        self._loaded = client.submit(pickle.loads, pickled, pure=False)
        self._flying: dict[Any, tuple[Chunk, int]] = {}

    def work(self, chunks: Iterator[Chunk], stop: Stop, retried: Retried) -> Iterator[Done]:
        deadline = None
        while self._fill(chunks, stop):
            if deadline is None and stop():
                deadline = time.monotonic() + _GRACE
            if deadline is not None and time.monotonic() > deadline:
                self._client.cancel(list(self._flying))
                return
            for future in self._landed():
                chunk, attempts = self._flying.pop(future)
                if (done := self._kept(future, chunk)) is not None:
                    yield done._replace(attempts=attempts)
                    continue
                if attempts >= 3 or self._client.status != "running":
                    raise CampaignWorkerError(
                        "the Dask cluster lost histories {first} to {last}", first=chunk.first, last=chunk.last - 1,
                        hint="check the cluster",
                    )  # fmt: skip
                retried(chunk, "the cluster lost a chunk; it is computed again")
                self._submit(chunk, attempts + 1)

    def _fill(self, chunks: Iterator[Chunk], stop: Stop) -> bool:
        if not stop():
            self._executor.at_once = max(1, sum(self._client.nthreads().values()))
        while len(self._flying) < self._executor.at_once * self._executor.ahead and not stop():
            if (chunk := next(chunks, None)) is None:
                break
            self._submit(chunk, 1)
        return bool(self._flying)

    def _submit(self, chunk: Chunk, attempts: int) -> None:
        self._flying[self._client.submit(_compute, self._loaded, chunk, pure=False)] = (chunk, attempts)

    def _landed(self) -> list[Any]:
        # polling, because a wait raises an error and cancels the futures after the loss of the scheduler
        end = time.monotonic() + _LOOK
        while not (landed := [future for future in self._flying if future.done()]) and time.monotonic() < end:
            time.sleep(0.002)
        return landed

    def _kept(self, future: Any, chunk: Chunk) -> Done | None:
        """Write the returned shard; return None if the cluster lost the shard."""
        if future.status in {"cancelled", "lost"}:
            return None
        try:
            data, seconds, worker = future.result()
        except Exception as error:
            if isinstance(error, (self._dask.CancelledError, self._dask.comm.CommClosedError)):
                return None
            raise CampaignWorkerError(
                "the computation of histories {first} to {last} failed: {error}: {reason}",
                first=chunk.first, last=chunk.last - 1,
                error=type(error).__name__, reason=str(error),
            ) from error  # fmt: skip
        return self._job.keep(chunk, data, seconds, worker)


def _compute(job: WorkerTask, chunk: Chunk) -> tuple[bytes, float, str]:
    start = time.perf_counter()
    data = job.compute(chunk) or b""
    return data, job.pace.settled(time.perf_counter() - start), f"process {os.getpid()} on {socket.gethostname()}"
