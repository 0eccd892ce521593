"""One process runs a campaign at a time."""

import contextlib
import os
import socket
import sys
import time
from pathlib import Path

from rocking.studies.campaign.errors import CampaignBusyError

NAME = "running.lock"
_PATIENCE = 0.5
_held: set[int] = set()


class FolderLock:
    """Held while a campaign runs; the system lets go of it when the process ends, however it ends."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._handle = -1

    def __enter__(self) -> "FolderLock":
        handle = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)
        deadline = time.monotonic() + _PATIENCE  # who only looks whether it is held, holds it for an instant
        while not _take(handle):
            if time.monotonic() > deadline:
                holder = _text(handle) or "another process"
                os.close(handle)
                raise CampaignBusyError(f"{self._path.parent}: {holder} runs this campaign; wait for it, or stop it")
            time.sleep(0.02)
        _held.add(handle)
        self._handle = handle
        os.ftruncate(handle, 0)
        os.lseek(handle, 0, os.SEEK_SET)
        os.write(handle, f"process {os.getpid()} on {socket.gethostname()}".encode())
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):
            os.ftruncate(self._handle, 0)
        _held.discard(self._handle)
        os.close(self._handle)


def holder(folder: Path) -> str | None:
    """Return who runs a campaign.

    Returns process and machine; None if nobody does.
    """
    try:
        handle = os.open(folder / NAME, os.O_RDONLY)
    except OSError:
        return None
    try:
        return None if _take(handle) else (_text(handle) or "another process")
    finally:
        os.close(handle)


def _text(handle: int) -> str:
    with contextlib.suppress(OSError):
        os.lseek(handle, 0, os.SEEK_SET)
        return os.read(handle, 200).decode(errors="replace")
    return ""


if sys.platform == "win32":
    import msvcrt

    def _take(handle: int) -> bool:
        os.lseek(handle, 1 << 20, os.SEEK_SET)  # far behind the text, so that others can read it
        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        return True

else:
    import fcntl

    def _take(handle: int) -> bool:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True

    def _let_go_in_child() -> None:
        """Let go in a forked worker: if it outlives its parent, the campaign is not busy."""
        for handle in _held:
            with contextlib.suppress(OSError):
                os.close(handle)
        _held.clear()

    os.register_at_fork(after_in_child=_let_go_in_child)
