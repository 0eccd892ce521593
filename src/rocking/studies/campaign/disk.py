"""Files that are there as a whole or not at all, and what is said when the disk does not take them."""

import os
import secrets
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from rocking.studies.campaign.errors import CampaignBusyError, CampaignDamagedError, CampaignStorageError

NOTHING_LOST = "nothing that was recorded before is lost"
_UNFINISHED = ".part"
_FULL = {sqlite3.SQLITE_FULL}
_DENIED = {sqlite3.SQLITE_READONLY, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM}
_TAKEN = {sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED}


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


def remove_unfinished(folder: Path) -> int:
    """Remove files that were being written when their process ended; call it while nobody writes."""
    found = list(folder.glob(f".*{_UNFINISHED}"))
    for path in found:
        path.unlink(missing_ok=True)
    return len(found)


def set_aside(path: Path) -> Path:
    """Give a damaged file another name, under which a user finds it; nothing is deleted.

    Returns its new name: the old one with ``.damaged-1``, ``.damaged-2`` ... behind it.
    """
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
        raise CampaignStorageError(f"{folder}: {error.strerror or error}; {safe()}; {_ADVICE}") from error
    except sqlite3.DatabaseError as error:
        if foreign(error):
            raise
        code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF
        if code in _FULL | _DENIED:
            raise CampaignStorageError(f"{folder}: the ledger: {error}; {safe()}; {_ADVICE}") from error
        if code in _TAKEN:
            raise CampaignBusyError(f"{folder}: another process holds the ledger ({error}); try again later") from error
        raise CampaignDamagedError(ledger_damaged(folder, str(error))) from error


def ledger_damaged(folder: Path, why: str) -> str:
    """Return what is said of a damaged ledger."""
    return f"{folder}: ledger.sqlite is damaged ({why}); run the campaign again: its shards make it anew"


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
