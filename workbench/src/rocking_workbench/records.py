"""Uploaded records in folders by hash, with notes of their names, and cached motions."""

import hashlib
import json
import shutil
import threading
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from pydantic import TypeAdapter

from rocking import GroundMotion, read_motion
from rocking.campaigns.disk import remove_unfinished, write_new
from rocking.errors import RecordError
from rocking_workbench.errors import NotFound, TooLarge, room_on_disk
from rocking_workbench.plain_text import safe_name
from rocking_workbench.settings import Limits
from rocking_workbench.work import Remembered

_DIGITS = frozenset("0123456789abcdef")
_HELD = 128 * 1024 * 1024  # largest memory of cached motions [bytes]
MOST_RECORDS = 5_000  # largest number of stored files


@dataclass(frozen=True, slots=True)
class StoredRecord:
    """A stored file."""

    record: Annotated[str, "SHA-256 of its bytes; inputs use it as the name of the record"]
    file_name: Annotated[str, "safe form of its original name"]
    bytes: Annotated[int, "size [bytes]"]
    uploaded: Annotated[str, "time in UTC"]


_NOTE = TypeAdapter(StoredRecord)


def is_hash(word: object) -> bool:
    """Return True if a text is the SHA-256 of a file."""
    return isinstance(word, str) and len(word) == 64 and _DIGITS.issuperset(word)


def read_note(note: Path) -> StoredRecord | None:
    """Return the record of a note; None if the note is invalid."""
    try:
        record = _NOTE.validate_json(note.read_bytes(), strict=True)
    except (OSError, ValueError):
        return None
    harmless = safe_name(record.file_name, "record") == record.file_name
    return record if harmless and record.record == note.stem else None


class RecordStore:
    """Thread-safe store of files in a folder by hash, with a note of each name.

    With `forgets`, a new file can replace the oldest files.
    """

    def __init__(self, folder: Path, limits: Limits, name: str = "records", *, forgets: bool = False) -> None:
        self.folder = Path(folder) / name
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        self._sweep()
        self._limits, self._forgets = limits, forgets
        self._lock = threading.RLock()
        self._motions: Remembered[GroundMotion] = Remembered(_HELD, _size)

    @property
    def largest(self) -> int:
        """Largest allowed size of a file [bytes]."""
        return self._limits.upload_bytes

    def add(self, content: bytes, name: str) -> StoredRecord:
        """Store a file. A stored file with equal bytes and another name is renamed."""
        self.check_upload(content)
        sha = hashlib.sha256(content).hexdigest()
        record = StoredRecord(sha, safe_name(name, "record"), len(content), datetime.now(UTC).isoformat(" ", "seconds"))
        with self._lock:
            self._check_room(record)
            with room_on_disk():
                self._keep(record, content)
            self._forget(sha)
        return record

    def check_upload(self, content: bytes) -> None:
        """Refuse a file that is empty or too large."""
        if not content.strip():
            raise RecordError("the file is empty")
        if len(content) > self._limits.upload_bytes:
            raise TooLarge(
                "the file has {size} bytes, more than {most}", size=len(content), most=self._limits.upload_bytes
            )

    def stored(self) -> list[StoredRecord]:
        """Return all files, newest first."""
        with self._lock:
            notes = [note for note in self.folder.glob("*.json") if is_hash(note.stem)]
            records = [record for note in notes if (record := read_note(note)) is not None]
        return sorted(records, key=lambda record: (record.uploaded, record.record), reverse=True)

    def get(self, sha: str) -> StoredRecord:
        record = read_note(self.folder / f"{sha}.json") if is_hash(sha) else None
        path = self._place(record) if record else None
        # a link in place of the file or of its folder is refused
        if record is None or path is None or path.is_symlink() or path.parent.is_symlink() or not path.is_file():
            raise NotFound("record {record}... is not stored here; upload the file again", record=str(sha)[:12])
        return record

    def path(self, sha: str) -> Path:
        """Return the path of a file."""
        return self._place(self.get(sha))

    def content(self, sha: str) -> bytes:
        """Return the bytes of a file after a check of its hash."""
        path = self.path(sha)
        try:
            content = path.read_bytes()
        except OSError:
            content = b""
        if hashlib.sha256(content).hexdigest() != sha:
            raise RecordError("{file}: changed since the upload; upload the file again", file=path.name)
        return content

    def delete(self, sha: str) -> None:
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
        *,
        skip: int = 0,
    ) -> GroundMotion:
        """Return a motion of a file from `read_motion`; recent motions are cached."""
        how = (format, units, time_step, component, vertical, skip)
        with self._lock:
            path = self.path(sha)

        def read() -> GroundMotion:
            motion = read_motion(path, *how[:-1], skip=skip)
            if sha not in motion.provenance[0]:  # the provenance of read_motion contains the hash of the record
                raise RecordError("{file}: changed since the upload; upload the file again", file=path.name)
            return motion

        return self._motions.get((sha, *how), read)

    def _place(self, record: StoredRecord) -> Path:
        return self.folder / record.record / record.file_name

    def _keep(self, record: StoredRecord, content: bytes) -> None:
        """Write a file and its note with private access. A failure leaves no files."""
        path = self._place(record)
        fresh = not path.parent.exists()
        note = self.folder / f"{record.record}.json"
        try:
            path.parent.mkdir(mode=0o700, exist_ok=True)
            for target, data in ((path, content), (note, json.dumps(asdict(record)).encode())):
                write_new(target, data)
                target.chmod(0o600)
        except OSError:
            if fresh:
                shutil.rmtree(path.parent, ignore_errors=True)
            raise
        for old in path.parent.iterdir():
            if old.name != record.file_name:
                old.unlink()

    def _sweep(self) -> None:
        """Remove incomplete files of an earlier server."""
        for folder in (self.folder, *(path for path in self.folder.iterdir() if is_hash(path.name))):
            if not folder.is_symlink():
                remove_unfinished(folder)

    def _check_room(self, record: StoredRecord) -> None:
        others = [other for other in self.stored() if other.record != record.record]
        while self._forgets and others and self._fits([], record) and not self._fits(others, record):
            self.delete(others.pop().record)
        if len(others) >= MOST_RECORDS:
            raise TooLarge(
                "up to {most} records are stored; delete records that are no longer needed", most=MOST_RECORDS
            )
        if not self._fits(others, record):
            room = self._limits.records_bytes >> 20
            raise TooLarge(
                "records may take up to {limit} MiB together", limit=room, hint="delete items that are no longer needed"
            )

    def _fits(self, others: list[StoredRecord], record: StoredRecord) -> bool:
        room = self._limits.records_bytes - sum(other.bytes for other in others)
        return len(others) < MOST_RECORDS and record.bytes <= room

    def _forget(self, sha: str) -> None:
        self._motions.forget(lambda key: key[0] == sha)


def _size(motion: GroundMotion) -> int:
    return int(motion.acceleration.nbytes * (1 if motion.vertical is None else 2))
