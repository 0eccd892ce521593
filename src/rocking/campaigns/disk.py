"""Files that are there as a whole or not at all, one process a campaign, and what stops it."""

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
    """Base of what a campaign refuses on purpose."""


class CampaignMismatchError(CampaignError):
    """The folder holds another campaign than the one that was asked for, or none."""


class CampaignBusyError(CampaignError):
    """Another process runs the same campaign."""


class CampaignStorageError(CampaignError):
    """The folder cannot be written: the disk is full, the folder is read-only, the device fails."""


class CampaignDamagedError(CampaignError):
    """A file of the campaign is not what was written."""


class CampaignIncompleteError(CampaignError):
    """Results were asked for before all histories are computed."""


class CampaignWorkerError(CampaignError):
    """Workers cannot compute a chunk: they die of it again and again, or refuse it."""


class CampaignInterrupted(KeyboardInterrupt):
    """The campaign was asked to stop, by Ctrl-C or SIGTERM, and has stopped; what is finished is safe.

    It is a `KeyboardInterrupt`, so that nothing that goes on after errors goes on after it.
    """


def write_new(path: Path, data: bytes) -> None:
    """Write a file so that a power cut at any instant leaves all of it or nothing under its name."""
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
    """Make the names in a folder last; where a system cannot open folders, it keeps them by itself."""
    if os.name == "nt":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def make_folder(folder: Path) -> None:
    """Make a folder, and those it is in, so that they last."""
    fresh = [each for each in (folder, *folder.parents) if not each.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    for each in reversed(fresh or [folder]):  # also where it was there: who made it may have been killed before this
        sync_folder(each.parent)


def refuse_used(folder: Path, mark: str, allowed: set[str], hint: str) -> None:
    """Refuse a folder that has the file by which a campaign is known, or any that it is not allowed to begin with."""
    there = {entry.name for entry in folder.iterdir() if not entry.name.startswith(".")}
    if mark in there:
        raise CampaignMismatchError("a campaign is here already", hint=hint).at(str(folder))
    if odd := sorted(there - allowed):
        raise CampaignMismatchError(
            "not empty ({name} ...)", name=odd[0], hint="a campaign takes a folder of its own"
        ).at(str(folder))


def remove_unfinished(folder: Path) -> None:
    """Remove files that were being written when their process ended; call it while nobody writes."""
    for path in folder.glob(f".*{_UNFINISHED}"):
        path.unlink(missing_ok=True)


def set_aside(path: Path) -> Path:
    """Give a damaged file another name, ``.damaged-1``, ``-2`` ... behind it, and return that; nothing is deleted."""
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
    """Turn what disk and database say into one sentence that a user can act on."""
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
            raise CampaignStorageError("the ledger: {reason}; {kept}", reason=str(error), kept=safe(), hint=_ADVICE).at(
                str(folder)
            ) from error
        if code in _TAKEN:
            raise CampaignBusyError(
                "another process holds the ledger ({reason})", reason=str(error), hint="try again later"
            ).at(str(folder)) from error
        raise ledger_damaged(folder, str(error)) from error


def ledger_damaged(folder: Path, why: str) -> CampaignDamagedError:
    """Return the error of a damaged ledger."""
    hint = "run the campaign again: its shards make it anew"
    return CampaignDamagedError("ledger.sqlite is damaged ({reason})", reason=why, hint=hint).at(str(folder))


_ADVICE = "make room or allow writing, then run the campaign again: it goes on where it stopped"


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
    """Held while a campaign runs; the system lets go of it when the process ends, however it ends."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._handle = -1

    def __enter__(self) -> "FolderLock":
        handle = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)
        deadline = time.monotonic() + _PATIENCE  # who only looks whether it is held, holds it for an instant
        while not _take(handle):
            if time.monotonic() > deadline:
                runs = _text(handle)
                os.close(handle)
                raise CampaignBusyError(
                    "{process} runs this campaign", process=runs, hint="wait for it, or stop it"
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
    """Return the process and machine that run a campaign; None if nobody does."""
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
            with suppress(OSError):
                os.close(handle)
        _held.clear()

    os.register_at_fork(after_in_child=_let_go_in_child)
