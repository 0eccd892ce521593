"""Uploaded records: files by the hash of their bytes, and the motions read from them lately."""

import hashlib
import shutil
import threading
from collections import OrderedDict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rocking.app.disk_room import room_on_disk
from rocking.app.files import safe_name
from rocking.app.problems import NotFound, TooLarge
from rocking.app.record_folder import StoredRecord, is_hash, is_own, keep, read_note, sweep
from rocking.app.settings import Limits
from rocking.errors import RecordError
from rocking.motions.formats import read_motion
from rocking.motions.motion import GroundMotion

_HELD = 128 * 1024 * 1024
"""Motions that are kept in memory [bytes]."""

MOST_RECORDS = 5_000
"""Files that are kept at once."""


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
