"""Uploaded records: files by the hash of their bytes, and the motions read from them lately."""

import hashlib
import json
import os
import shutil
import threading
from collections import OrderedDict
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rocking.app.files import safe_name
from rocking.app.problems import NotFound, TooLarge
from rocking.app.settings import Limits
from rocking.errors import RecordError
from rocking.motions.formats import read_motion
from rocking.motions.motion import GroundMotion

_HELD = 128 * 1024 * 1024
"""Motions that are kept in memory [bytes]."""

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


class RecordStore:
    """Files in a folder by hash, each with a note of its name beside it; safe to use from several threads.

    Parameters
    ----------
    folder : Path
        Data folder of the server; records lie in its folder ``records``.
    limits : Limits
        Largest file, and room for all of them.
    """

    def __init__(self, folder: Path, limits: Limits) -> None:
        self.folder = Path(folder) / "records"
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        self._limits = limits
        self._lock = threading.RLock()
        self._motions: OrderedDict[tuple[Any, ...], GroundMotion] = OrderedDict()

    def add(self, content: bytes, name: str) -> StoredRecord:
        """Keep a file; the same bytes under another name take that name.

        Parameters
        ----------
        content : bytes
            The file.
        name : str
            Name as given; only its harmless part is kept.

        Returns
        -------
        StoredRecord
            What is kept.

        Raises
        ------
        RecordError
            If the file is empty.
        TooLarge
            If it is too large, or there is no room for another one.
        """
        self.check_upload(content)
        sha = hashlib.sha256(content).hexdigest()
        made = StoredRecord(sha, safe_name(name, "record"), len(content), datetime.now(UTC).isoformat(" ", "seconds"))
        with self._lock:
            self._make_room(made)
            place = self.folder / sha
            place.mkdir(mode=0o700, exist_ok=True)
            for old in place.iterdir():
                if old.name != made.file_name:
                    old.unlink()
            _write(place / made.file_name, content)
            _write(self.folder / f"{sha}.json", json.dumps(asdict(made)).encode())
            self._forget(sha)
        return made

    def check_upload(self, content: bytes) -> None:
        """Refuse a file that will not be kept whatever it holds.

        Parameters
        ----------
        content : bytes
            The file.

        Raises
        ------
        RecordError
            If it is empty.
        TooLarge
            If it is too large.
        """
        if not content.strip():
            raise RecordError("the file is empty")
        if len(content) > self._limits.upload_bytes:
            raise TooLarge(f"the file has {len(content)} bytes, more than {self._limits.upload_bytes}")

    def stored(self) -> list[StoredRecord]:
        """Return all files, the latest first.

        Returns
        -------
        list of StoredRecord
            What is kept.
        """
        with self._lock:
            notes = [note for note in self.folder.glob("*.json") if _is_hash(note.stem)]
            found = [made for note in notes if (made := _read(note)) is not None]
        return sorted(found, key=lambda made: (made.uploaded, made.record), reverse=True)

    def get(self, sha: str) -> StoredRecord:
        """Return one file.

        Parameters
        ----------
        sha : str
            SHA-256 of its bytes.

        Returns
        -------
        StoredRecord
            What is kept.

        Raises
        ------
        NotFound
            If there is none.
        """
        made = _read(self.folder / f"{sha}.json") if _is_hash(sha) else None
        if made is None or not self._place(made).is_file():
            raise NotFound(f"no record {str(sha)[:12]}... is kept here: upload the file once more")
        return made

    def path(self, sha: str) -> Path:
        """Return where a file is.

        Parameters
        ----------
        sha : str
            SHA-256 of its bytes.

        Returns
        -------
        Path
            The file, under the name it was given.

        Raises
        ------
        NotFound
            If there is none.
        """
        return self._place(self.get(sha))

    def delete(self, sha: str) -> None:
        """Remove a file.

        Parameters
        ----------
        sha : str
            SHA-256 of its bytes.

        Raises
        ------
        NotFound
            If there is none.
        """
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

        Parameters
        ----------
        sha : str
            SHA-256 of its bytes.
        format : str, optional
            Name of its format.
        units : str, optional
            Unit of acceleration, where the file does not state it.
        time_step : float, optional
            Step between samples, where the file does not state it [s].
        component, vertical : str, optional
            Names of the horizontal and the vertical component.

        Returns
        -------
        GroundMotion
            The motion.

        Raises
        ------
        NotFound
            If there is no such file.
        RecordError
            If it cannot be read, or is not what was uploaded.
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
        used = sum(other.bytes for other in self.stored() if other.record != made.record)
        if used + made.bytes > self._limits.records_bytes:
            room = self._limits.records_bytes >> 20
            raise TooLarge(f"records may take up to {room} MiB together; delete some that are no longer needed")

    def _forget(self, sha: str) -> None:
        for key in [key for key in self._motions if key[0] == sha]:
            del self._motions[key]


def _is_hash(word: object) -> bool:
    return isinstance(word, str) and len(word) == 64 and _DIGITS.issuperset(word)


def _size(motion: GroundMotion) -> int:
    return int(motion.acceleration.nbytes * (1 if motion.vertical is None else 2))


def _write(path: Path, content: bytes) -> None:
    """Write a file that is there as a whole or not at all, for this user alone."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)


def _read(note: Path) -> StoredRecord | None:
    try:
        told = json.loads(note.read_bytes())
        made = StoredRecord(str(told["record"]), str(told["file_name"]), int(told["bytes"]), str(told["uploaded"]))
    except (OSError, ValueError, TypeError, KeyError):
        return None
    harmless = safe_name(made.file_name, "record") == made.file_name
    return made if harmless and made.record == note.stem else None
