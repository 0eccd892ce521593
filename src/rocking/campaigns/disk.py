"""Atomic writing of files, a lock for one process per campaign, and the errors of campaigns."""

import os
import secrets
import socket
import sqlite3
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from rocking.errors import RockingError

NOTHING_LOST = "nothing that was recorded before is lost"
_UNFINISHED = ".part"
_DENIED = {
    sqlite3.SQLITE_FULL, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM
}  # fmt: skip
_TAKEN = {sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED}
NAME = "running.lock"
_PATIENCE = 0.5
_held: set[int] = set()


class CampaignError(RockingError):
    """Base class of the errors of a campaign."""


class CampaignMismatchError(CampaignError):
    """The folder contains another campaign, or no campaign."""


class CampaignBusyError(CampaignError):
    """Another process runs the same campaign."""


class CampaignStorageError(CampaignError):
    """The folder cannot be written: the disk is full, the folder is read-only, the device fails."""


class CampaignDamagedError(CampaignError):
    """A file of the campaign has changed."""


class CampaignIncompleteError(CampaignError):
    """Results were requested before the end of the campaign."""


class CampaignWorkerError(CampaignError):
    """Workers cannot compute a chunk: they end repeatedly, or refuse it."""


class CampaignInterrupted(KeyboardInterrupt):
    """The campaign has stopped after Ctrl-C or SIGTERM; finished chunks are safe.

    The base class `KeyboardInterrupt` passes handlers of ordinary errors.
    """


def write_new(path: Path, data: bytes) -> None:
    """Write a file, which is complete or absent after a power failure at any instant."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}-{secrets.token_hex(4)}{_UNFINISHED}")
    try:
        _write_through(unfinished, data)
        unfinished.replace(path)
    except BaseException:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)
        raise
    sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Write the names of a folder to disk; some systems do this themselves."""
    if os.name == "nt":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def make_folder(folder: Path) -> None:
    """Make a folder and its parents, written to disk."""
    fresh = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    for created in reversed(fresh or [folder]):  # an earlier process may have been killed before this step
        sync_folder(created.parent)


def refuse_used(folder: Path, mark: str, allowed: set[str], hint: str) -> None:
    """Refuse a folder that contains the file of a campaign, or files that are not allowed."""
    entries = {entry.name for entry in folder.iterdir() if not entry.name.startswith(".")}
    if mark in entries:
        raise CampaignMismatchError("the folder already contains a campaign", hint=hint).at(str(folder))
    if odd := sorted(entries - allowed):
        raise CampaignMismatchError(
            "the folder is not empty ({name} ...)", name=odd[0], hint="use an empty folder for the campaign"
        ).at(str(folder))


def remove_unfinished(folder: Path) -> None:
    """Remove incomplete files of ended processes. Call only while no process writes."""
    for path in folder.glob(f".*{_UNFINISHED}"):
        path.unlink(missing_ok=True)


def set_aside(path: Path) -> Path:
    """Rename a damaged file to ``.damaged-1``, ``-2`` ..., and return the new path; nothing is deleted."""
    number = 1
    while (aside := path.with_name(f"{path.name}.damaged-{number}")).exists():
        number += 1
    path.replace(aside)
    sync_folder(path.parent)
    return aside


@contextmanager
def guarded(
    folder: Path,
    safe: Callable[[], str] = lambda: NOTHING_LOST,
    foreign: Callable[[BaseException], bool] = lambda _: False,
) -> Iterator[None]:
    """Convert errors of disk and database into errors with a remedy."""
    try:
        yield
    except OSError as error:
        if foreign(error) or isinstance(error, ConnectionError):
            raise
        raise CampaignStorageError("{fault}; {kept}", fault=error.strerror or str(error), kept=safe(), hint=_ADVICE).at(
            str(folder)
        ) from error
    except sqlite3.DatabaseError as error:
        if foreign(error):
            raise
        code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF
        if code in _DENIED:
            raise CampaignStorageError(
                "the ledger cannot be read or written: {reason}; {kept}", reason=str(error), kept=safe(), hint=_ADVICE
            ).at(str(folder)) from error
        if code in _TAKEN:
            raise CampaignBusyError(
                "another process uses the ledger ({reason})", reason=str(error), hint="try again later"
            ).at(str(folder)) from error
        raise ledger_damaged(folder, str(error)) from error


def ledger_damaged(folder: Path, reason: str) -> CampaignDamagedError:
    """Return the error of a damaged ledger."""
    hint = "run the campaign again: the run rebuilds the ledger from the shards"
    return CampaignDamagedError("ledger.sqlite is damaged ({reason})", reason=reason, hint=hint).at(str(folder))


_ADVICE = "free disk space or allow writing, then run the campaign again to continue it"


def _write_through(path: Path, data: bytes) -> None:
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        view = memoryview(data)
        while view:
            view = view[os.write(handle, view) :]
        os.fsync(handle)
    finally:
        os.close(handle)


class FolderLock:
    """The lock of a running campaign. The system releases the lock at the end of the process."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._handle = -1

    def __enter__(self) -> "FolderLock":
        handle = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)
        deadline = time.monotonic() + _PATIENCE  # a mere check also holds the lock for an instant
        while not _take(handle):
            if time.monotonic() > deadline:
                runs = _text(handle)
                os.close(handle)
                raise CampaignBusyError(
                    "{process} runs this campaign",
                    process=runs,
                    hint="wait until that process ends, or stop the process",
                ).at(str(self._path.parent))
            time.sleep(0.02)
        _held.add(handle)
        self._handle = handle
        os.ftruncate(handle, 0)
        os.lseek(handle, 0, os.SEEK_SET)
        os.write(handle, f"process {os.getpid()} on {socket.gethostname()}".encode())
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):
            os.ftruncate(self._handle, 0)
        _held.discard(self._handle)
        os.close(self._handle)


def holder(folder: Path) -> str | None:
    """Return the process and machine of a running campaign, or None if no process runs the campaign."""
    try:
        handle = os.open(folder / NAME, os.O_RDONLY)
    except OSError:
        return None
    try:
        return None if _take(handle) else _text(handle)
    finally:
        os.close(handle)


def _text(handle: int) -> str:
    with suppress(OSError):
        os.lseek(handle, 0, os.SEEK_SET)
        return os.read(handle, 200).decode(errors="replace") or "another process"
    return "another process"


if sys.platform == "win32":
    import msvcrt

    def _take(handle: int) -> bool:
        os.lseek(handle, 1 << 20, os.SEEK_SET)  # lock a byte far behind the readable text
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
        """Release the lock in a forked worker, because the worker may run longer than its parent."""
        for handle in _held:
            with suppress(OSError):
                os.close(handle)
        _held.clear()

    os.register_at_fork(after_in_child=_let_go_in_child)
