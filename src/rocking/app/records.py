"""Uploaded records: folders by the hash of the bytes, a note of the name beside each, and the motions read lately."""

import hashlib
import json
import shutil
import threading
from collections import OrderedDict
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rocking.app.answers import safe_name
from rocking.app.errors import NotFound, TooLarge, room_on_disk
from rocking.app.settings import Limits
from rocking.campaigns.disk import remove_unfinished, write_new
from rocking.errors import RecordError
from rocking.motions.formats import read_motion
from rocking.motions.motion import GroundMotion

_DIGITS = frozenset("0123456789abcdef")
_HELD = 128 * 1024 * 1024
"""Motions that are kept in memory [bytes]."""

MOST_RECORDS = 5_000
"""Files that are kept at once."""


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


class RecordStore:
    """Files in a folder by hash, each with a note of its name beside it; safe to use from several threads."""

    def __init__(self, folder: Path, limits: Limits) -> None:
        self.folder = Path(folder) / "records"
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        sweep(self.folder)
        self._limits = limits
        self._lock = threading.RLock()
        self._motions: OrderedDict[tuple[Any, ...], GroundMotion] = OrderedDict()

    @property
    def largest(self) -> int:
        """Size of the largest file that is kept [bytes]."""
        return self._limits.upload_bytes

    def add(self, content: bytes, name: str) -> StoredRecord:
        """Keep a file; the same bytes under another name take that name."""
        self.check_upload(content)
        sha = hashlib.sha256(content).hexdigest()
        made = StoredRecord(sha, safe_name(name, "record"), len(content), datetime.now(UTC).isoformat(" ", "seconds"))
        with self._lock:
            self._make_room(made)
            with room_on_disk():
                keep(self.folder, made, content)
            self._forget(sha)
        return made

    def check_upload(self, content: bytes) -> None:
        """Refuse a file that will not be kept whatever it holds."""
        if not content.strip():
            raise RecordError("the file is empty")
        if len(content) > self._limits.upload_bytes:
            raise TooLarge(f"the file has {len(content)} bytes, more than {self._limits.upload_bytes}")

    def stored(self) -> list[StoredRecord]:
        """Return all files, the latest first."""
        with self._lock:
            notes = [note for note in self.folder.glob("*.json") if is_hash(note.stem)]
            found = [made for note in notes if (made := read_note(note)) is not None]
        return sorted(found, key=lambda made: (made.uploaded, made.record), reverse=True)

    def get(self, sha: str) -> StoredRecord:
        """Return one file."""
        made = read_note(self.folder / f"{sha}.json") if is_hash(sha) else None
        if made is None or not is_own(self._place(made)):
            raise NotFound(f"no record {str(sha)[:12]}... is kept here: upload the file once more")
        return made

    def path(self, sha: str) -> Path:
        """Return where a file is.

        Returns the file, under the name it was given.
        """
        return self._place(self.get(sha))

    def content(self, sha: str) -> bytes:
        """Return the bytes of a file, as they were uploaded."""
        path = self.path(sha)
        try:
            found = path.read_bytes()
        except OSError:
            found = b""
        if hashlib.sha256(found).hexdigest() != sha:
            raise RecordError(f"{path.name}: has changed since it was uploaded: upload it once more")
        return found

    def delete(self, sha: str) -> None:
        """Remove a file."""
        with self._lock:
            self.get(sha)
            (self.folder / f"{sha}.json").unlink(missing_ok=True)
            shutil.rmtree(self.folder / sha, ignore_errors=True)
            self._forget(sha)

    def motion(
        self,
        sha: str,
        format: str | None = None,
        units: str | None = None,
        time_step: float | None = None,
        component: str | None = None,
        vertical: str | None = None,
    ) -> GroundMotion:
        """Return a motion of a file, as `read_motion` reads it; one that was read lately is not read again.

        time_step: step between samples, where the file does not state it [s].
        """
        key = (sha, format, units, time_step, component, vertical)
        with self._lock:
            path = self.path(sha)
            if key in self._motions:
                self._motions.move_to_end(key)
                return self._motions[key]
        found = read_motion(path, *key[1:])
        if sha not in found.provenance[0]:  # read_motion notes the hash of what it read
            raise RecordError(f"{path.name}: has changed since it was uploaded: upload it once more")
        with self._lock:
            self._motions[key] = found
            while sum(map(_size, self._motions.values())) > _HELD and len(self._motions) > 1:
                self._motions.popitem(last=False)
        return found

    def _place(self, made: StoredRecord) -> Path:
        return self.folder / made.record / made.file_name

    def _make_room(self, made: StoredRecord) -> None:
        others = [other for other in self.stored() if other.record != made.record]
        if len(others) >= MOST_RECORDS:
            raise TooLarge(f"up to {MOST_RECORDS} records are kept; delete some that are no longer needed")
        used = sum(other.bytes for other in others)
        if used + made.bytes > self._limits.records_bytes:
            room = self._limits.records_bytes >> 20
            raise TooLarge(f"records may take up to {room} MiB together; delete some that are no longer needed")

    def _forget(self, sha: str) -> None:
        for key in [key for key in self._motions if key[0] == sha]:
            del self._motions[key]


def _size(motion: GroundMotion) -> int:
    return int(motion.acceleration.nbytes * (1 if motion.vertical is None else 2))
