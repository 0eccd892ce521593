"""The data folder: private, of one server at a time, with a note for those who come second."""

import json
import os
import socket
from pathlib import Path
from types import TracebackType
from typing import Any

from rocking.campaigns.disk import CampaignBusyError, FolderLock
from rocking.errors import InvalidValueError

KEY_FILE = "api-key"
_NOTE = "server.json"


class FolderInUseError(InvalidValueError):
    """Another server has the data folder."""


class DataFolder:
    """The data folder of a server, held while it runs."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock: FolderLock | None = None

    def __enter__(self) -> "DataFolder":
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self.path.chmod(0o700)
        except OSError as error:
            raise InvalidValueError(
                f"the data folder {str(self.path)!r} cannot be used ({error.strerror}): choose another with --data"
            ) from error
        lock = FolderLock(self.path)
        try:
            lock.__enter__()
        except CampaignBusyError as error:
            raise FolderInUseError(
                f"another rocking serve runs with the data folder {str(self.path)!r}: stop it, "
                "or choose another folder with --data"
            ) from error
        self._lock = lock
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for name in (KEY_FILE, _NOTE):
            (self.path / name).unlink(missing_ok=True)
        if self._lock is not None:
            self._lock.__exit__(kind, error, trace)

    def publish(self, url: str, key: str) -> Path:
        """Leave the key for scripts, and the address for a second start.

        Returns file of the key; only its owner can read it.
        """
        write_private(self.path / _NOTE, json.dumps({"url": url, "process": os.getpid(), "machine": _machine()}))
        return write_private(self.path / KEY_FILE, key)

    def running(self) -> tuple[str, str] | None:
        """Return where the server that has the folder can be asked.

        Returns address and key; None if it runs on another machine, or has left none.
        """
        try:
            note: dict[str, Any] = json.loads((self.path / _NOTE).read_text(encoding="utf-8"))
            key = (self.path / KEY_FILE).read_text(encoding="utf-8")
        except (OSError, ValueError):
            return None
        return (note["url"], key) if note.get("machine") == _machine() else None


def write_private(path: Path, text: str) -> Path:
    """Write a file that only its owner can read, in place of whatever has that name."""
    path.unlink(missing_ok=True)  # never through a link that somebody left there
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def _machine() -> str:
    return socket.gethostname()
