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
    """An uploaded file."""

    record: str  # SHA-256 of its bytes, 64 hexadecimal digits
    file_name: str  # the name it was given, made harmless
    bytes: int  # its length [bytes]
    uploaded: str  # when, in UTC


def keep(folder: Path, made: StoredRecord, content: bytes) -> None:
    """Write a file and its note; what could not be written leaves nothing behind."""
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
    """Remove what was being written when an earlier server ended."""
    for place in (folder, *(each for each in folder.iterdir() if is_hash(each.name))):
        if not place.is_symlink():
            remove_unfinished(place)


def is_own(path: Path) -> bool:
    """Return whether a file is one that was written here, not a link to another place.

    Returns false for links, and files in a folder that is one.
    """
    return not path.is_symlink() and not path.parent.is_symlink() and path.is_file()


def is_hash(word: object) -> bool:
    """Return whether a word is the SHA-256 of a file."""
    return isinstance(word, str) and len(word) == 64 and _DIGITS.issuperset(word)


def read_note(note: Path) -> StoredRecord | None:
    """Return what a note says.

    Returns none if it is no note that was written here.
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
