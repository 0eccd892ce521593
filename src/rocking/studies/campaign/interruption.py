"""Ctrl-C and SIGTERM: a wish to stop, which is asked for rather than thrown into the middle of things."""

import signal
import threading
from types import FrameType
from typing import Any


class Interruption:
    """Notes the first Ctrl-C or SIGTERM; the second one stops at once, as if this was not here.

    Outside of the main thread nothing is noted: signals never arrive there.

    >>> with Interruption() as interruption:
    ...     interruption.asked()
    False
    """

    _WATCHED = (signal.SIGINT, signal.SIGTERM)

    def __init__(self) -> None:
        self._asked = False
        self._before: dict[signal.Signals, Any] = {}

    def asked(self) -> bool:
        """Return whether to stop."""
        return self._asked

    def __enter__(self) -> "Interruption":
        if threading.current_thread() is threading.main_thread():
            self._before = {each: signal.signal(each, self._note) for each in self._WATCHED}
        return self

    def __exit__(self, *_: object) -> None:
        self._restore()

    def _note(self, number: int, frame: FrameType | None) -> None:
        self._asked = True
        self._restore()

    def _restore(self) -> None:
        for each, handler in self._before.items():
            signal.signal(each, handler if handler is not None else signal.SIG_DFL)
        self._before = {}
