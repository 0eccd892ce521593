"""Long computations in threads with a short queue, and cached results."""

import asyncio
import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, Generic, ParamSpec, TypeVar

from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection

from rocking_workbench.errors import Busy, Refused

P = ParamSpec("P")
T = TypeVar("T")
_SMALL = 200  # largest number of vertices of a body with a computing time of a few milliseconds


class ComputationQueue:
    """Threads for long computations, with a bounded queue."""

    def __init__(self, at_once: int, waiting: int) -> None:
        self._threads = ThreadPoolExecutor(at_once, thread_name_prefix="heavy")
        self._room = at_once + waiting
        self._inside = 0
        self._lock = threading.Lock()

    def submit(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> "Future[T]":
        """Put a computation in the queue."""
        with self._lock:
            if self._inside >= self._room:
                raise Busy("{count} computations are running or queued; try again later", count=self._inside, seconds=2)
            self._inside += 1
        try:
            future = self._threads.submit(function, *args, **kwargs)
        except BaseException:
            self._leave()
            raise
        future.add_done_callback(self._leave)
        return future

    @property
    def busy(self) -> bool:
        """True while a computation runs."""
        with self._lock:
            return self._inside > 0

    def close(self) -> None:
        """Start no further computations; running computations continue to their end."""
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _leave(self, _: Any = None) -> None:
        with self._lock:
            self._inside -= 1


async def heavy(request: HTTPConnection, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Compute in one of a few threads, so that light requests stay fast."""
    queue: ComputationQueue = request.app.state.rocking.heavy
    try:
        return await asyncio.wrap_future(queue.submit(function, *args, **kwargs))
    except asyncio.CancelledError as error:  # a request is cancelled only at the end of the server
        message = "the server is shutting down; restart it, then compute again"
        raise Refused(message, status=503) from error


async def sized(
    request: HTTPConnection, vertices: int, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs
) -> T:
    """Compute in a thread, for large bodies in the queue of long computations."""
    if vertices <= _SMALL:
        return await run_in_threadpool(function, *args, **kwargs)
    return await heavy(request, function, *args, **kwargs)


class Remembered(Generic[T]):
    """Thread-safe cache of the latest results by key, with a limit of their total size."""

    def __init__(self, most: int, size: Callable[[T], int] = lambda result: 1) -> None:
        self._most, self._size = most, size
        self._held: OrderedDict[Hashable, Future[T]] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: Hashable, compute: Callable[[], T]) -> T:
        """Return the result of a key, which is computed once; failures are not cached."""
        with self._lock:
            held = self._held.get(key)
            future: Future[T] = Future() if held is None else held
            self._held[key] = future
            self._held.move_to_end(key)
        if held is not None:
            return held.result()
        try:
            future.set_result(compute())
        except BaseException as error:
            with self._lock:
                if self._held.get(key) is future:
                    del self._held[key]
            future.set_exception(error)
            raise
        with self._lock:
            sizes = {
                key: self._size(done_future.result()) for key, done_future in self._held.items() if done_future.done()
            }
            for oldest in list(sizes)[:-1]:
                if sum(sizes.values()) <= self._most:
                    break
                del sizes[oldest], self._held[oldest]
        return future.result()

    def known(self, key: Hashable) -> T | None:
        """Return the cached result for a key, or None."""
        with self._lock:
            future = self._held.get(key)
        return future.result() if future is not None and future.done() else None

    def forget(self, concerned: Callable[[Any], bool]) -> None:
        """Remove the results of some keys."""
        with self._lock:
            for key in [key for key in self._held if concerned(key)]:
                del self._held[key]
