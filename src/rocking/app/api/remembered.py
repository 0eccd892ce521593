"""Answers that were given lately: who asks the same meanwhile waits for the first instead of computing it again."""

import threading
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future
from typing import Generic, TypeVar

T = TypeVar("T")


class Remembered(Generic[T]):
    """The latest results by key; safe to use from several threads."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._held: OrderedDict[str, Future[T]] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: str, compute: Callable[[], T]) -> T:
        """Return the result of a key; one that cannot be computed is not kept."""
        with self._lock:
            known = self._held.get(key)
            future: Future[T] = Future() if known is None else known
            self._held[key] = future
            self._held.move_to_end(key)
            while len(self._held) > self._most:
                self._held.popitem(last=False)
        if known is not None:
            return known.result()
        try:
            future.set_result(compute())
        except BaseException as error:
            with self._lock:
                if self._held.get(key) is future:
                    del self._held[key]
            future.set_exception(error)
            raise
        return future.result()
