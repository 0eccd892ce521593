"""Long computations: a few threads, a short line before them, and an honest answer when the line is full."""

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, ParamSpec, TypeVar

from starlette.requests import HTTPConnection

from rocking.app.problems import Busy, Ending

P = ParamSpec("P")
T = TypeVar("T")


class WaitingLine:
    """Threads for long computations, and a line of bounded length before them."""

    def __init__(self, at_once: int, waiting: int) -> None:
        self._threads = ThreadPoolExecutor(at_once, thread_name_prefix="heavy")
        self._room = at_once + waiting
        self._inside = 0
        self._lock = threading.Lock()

    def submit(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> "Future[T]":
        """Put a computation in line."""
        with self._lock:
            if self._inside >= self._room:
                raise Busy(f"{self._inside} computations run or wait already; try again in a moment", seconds=2)
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
        """Whether something is still being computed."""
        with self._lock:
            return self._inside > 0

    def close(self) -> None:
        """Start nothing more; what runs ends by itself."""
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _leave(self, _: Any = None) -> None:
        with self._lock:
            self._inside -= 1


async def heavy(request: HTTPConnection, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Compute in a thread, with few others at once, so that light requests stay quick."""
    line: WaitingLine = request.app.state.rocking.heavy
    try:
        return await asyncio.wrap_future(line.submit(function, *args, **kwargs))
    except asyncio.CancelledError as error:  # only a server that ends cancels a request
        raise Ending("the server ends before this is computed; start it again, then ask again") from error
