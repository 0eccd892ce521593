"""Folders of runs: a note of the state, links to files of the user, inputs, results and a log."""

import json
import os
import re
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, ClassVar, Final

from pydantic import TypeAdapter

from rocking.campaigns import disk
from rocking_workbench.runs.process import LOG

WAITING: Final = "waiting"
RUNNING: Final = "running"
DONE: Final = "done"
_ID = re.compile(r"[0-9a-f]{16}\Z")
_DELETED = ".deleted-"
_LONGEST_LOG = 1 << 20  # length of the end of a log that is read [bytes]


def new_id() -> str:
    """Return the name of a new run's folder."""
    return secrets.token_hex(8)


def is_id(text: str) -> bool:
    """Return True if a text can be the name of the folder of a run."""
    return _ID.match(text) is not None


@dataclass(frozen=True)
class RunFolder:
    """The folder of a run."""

    path: Path  # path of the folder; the last component is the name of the run

    NOTE: ClassVar[str]  # name of the file with the state
    SCHEMA: ClassVar[int]  # schema of the notes on the disk; 1 for a note without number
    FORMAT: ClassVar[TypeAdapter[Any]]  # type of a note

    @property
    def id(self) -> str:
        """Name of the run in addresses."""
        return self.path.name

    @contextmanager
    def new(self) -> Iterator[None]:
        """Make the folder; an error leaves no folder."""
        try:
            disk.make_folder(self.path)
            self.path.chmod(0o700)
            yield
        except BaseException:
            shutil.rmtree(self.path, ignore_errors=True)
            raise

    def keep(self, name: str, source: Path) -> None:
        """Link or copy a file of the user into the folder."""
        target = self.path / name
        if not target.parent.exists():
            disk.make_folder(target.parent)
        try:
            target.hardlink_to(source)
        except OSError:
            shutil.copyfile(source, target)

    def write(self, note: Any) -> None:
        """Write the note atomically."""
        data = json.dumps({"schema": self.SCHEMA, **asdict(note)}, indent=1) + "\n"
        disk.write_new(self.path / self.NOTE, data.encode())

    def read(self) -> Any:
        """Return the note, or None if the note is missing, unreadable or of a later version."""
        try:
            data = json.loads((self.path / self.NOTE).read_bytes())
            if data.pop("schema", 1) > self.SCHEMA:
                return None
            return self.FORMAT.validate_json(json.dumps(self.present(data)), strict=True)
        except (OSError, ValueError, TypeError, AttributeError):
            return None

    def present(self, data: dict[str, Any]) -> dict[str, Any]:
        """Return the data of a note of an earlier schema in the present schema."""
        return data

    def refusal(self, start: int = 0) -> dict[str, Any] | None:
        """Return the last error in the log after a position, as data without the path of the folder."""
        try:
            with (self.path / LOG).open("rb") as log:
                log.seek(max(start, log.seek(0, os.SEEK_END) - _LONGEST_LOG))
                text = log.read().decode(errors="replace").replace(f"{self.path}{os.sep}", "")
        except OSError:
            return None
        for line in reversed(text.splitlines()):
            with suppress(ValueError, TypeError, KeyError):
                error: dict[str, Any] = json.loads(line)["error"]
                return {**error, "message": error["message"]}
        return None

    def remove(self) -> None:
        """Remove the folder; an interrupted removal is finished later."""
        aside = self.path.with_name(f"{_DELETED}{self.id}")
        with suppress(FileNotFoundError):  # another thread may have removed the folder
            self.path.rename(aside)
        shutil.rmtree(aside, ignore_errors=True)


def folders_in(folder: Path, *files: str) -> Iterator[Path]:
    """Yield the folders of earlier runs that contain one of the files; remove all other folders."""
    disk.make_folder(folder)
    folder.chmod(0o700)
    for path in list(folder.iterdir()):
        if path.name.startswith(_DELETED):
            shutil.rmtree(path, ignore_errors=True)
        elif is_id(path.name) and path.is_dir() and not path.is_symlink():
            try:
                is_half_written = not {*files} & {entry.name for entry in path.iterdir()}
            except OSError:
                is_half_written = False
            if is_half_written:
                shutil.rmtree(path, ignore_errors=True)
            else:
                yield path
