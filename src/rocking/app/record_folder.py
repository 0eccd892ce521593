"""Uploaded records on disk: a folder by hash with the file in it, and a note of its name beside the folder."""

import json
import shutil
from dataclasses import asdict, dataclass
from pathlib import Path

from rocking.app.files import safe_name
from rocking.studies.campaign.disk import remove_unfinished, write_new

_DIGITS = frozenset("0123456789abcdef")


@dataclass(frozen=True, slots=True)
class StoredRecord:
    """An uploaded file.

    Parameters
    ----------
    record : str
        SHA-256 of its bytes, 64 hexadecimal digits.
    file_name : str
        The name it was given, made harmless.
    bytes : int
        Its length [bytes].
    uploaded : str
        When, in UTC.
    """

    record: str
    file_name: str
    bytes: int
    uploaded: str


def keep(folder: Path, made: StoredRecord, content: bytes) -> None:
    """Write a file and its note; what could not be written leaves nothing behind.

    Parameters
    ----------
    folder : Path
        Folder of all records.
    made : StoredRecord
        What the note says.
    content : bytes
        The file.

    Raises
    ------
    OSError
        If the disk does not take it.
    """
    place = folder / made.record
    fresh = not place.exists()
    try:
        place.mkdir(mode=0o700, exist_ok=True)
        _write(place / made.file_name, content)
        _write(folder / f"{made.record}.json", json.dumps(asdict(made)).encode())
    except OSError:
        if fresh:
            shutil.rmtree(place, ignore_errors=True)
        raise
    for old in place.iterdir():
        if old.name != made.file_name:
            old.unlink()


def sweep(folder: Path) -> None:
    """Remove what was being written when an earlier server ended.

    Parameters
    ----------
    folder : Path
        Folder of all records.
    """
    for place in (folder, *(each for each in folder.iterdir() if is_hash(each.name))):
        if not place.is_symlink():
            remove_unfinished(place)


def is_own(path: Path) -> bool:
    """Return whether a file is one that was written here, not a link to another place.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    bool
        False for links, and files in a folder that is one.
    """
    return not path.is_symlink() and not path.parent.is_symlink() and path.is_file()


def is_hash(word: object) -> bool:
    """Return whether a word is the SHA-256 of a file.

    Parameters
    ----------
    word : object
        Anything.

    Returns
    -------
    bool
        Whether it has 64 hexadecimal digits.
    """
    return isinstance(word, str) and len(word) == 64 and _DIGITS.issuperset(word)


def read_note(note: Path) -> StoredRecord | None:
    """Return what a note says.

    Parameters
    ----------
    note : Path
        The note.

    Returns
    -------
    StoredRecord or None
        None if it is no note that was written here.
    """
    try:
        told = json.loads(note.read_bytes())
        made = StoredRecord(str(told["record"]), str(told["file_name"]), int(told["bytes"]), str(told["uploaded"]))
    except (OSError, ValueError, TypeError, KeyError):
        return None
    harmless = safe_name(made.file_name, "record") == made.file_name
    return made if harmless and made.record == note.stem else None


def _write(path: Path, content: bytes) -> None:
    """Write a file that is there as a whole or not at all, for this user alone."""
    write_new(path, content)
    path.chmod(0o600)
