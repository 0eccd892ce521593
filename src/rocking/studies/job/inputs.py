"""The files that a job names: their bytes are part of what it is."""

import hashlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rocking.errors import InvalidValueError

_PIECE = 1 << 20
_SPECIAL = "*?["


@dataclass(frozen=True)
class InputFile:
    """A file that a job names."""

    path: str  # as the job names it, or as its pattern finds it: relative to the folder of the job file
    sha256: str  # hash of its bytes, 64 hexadecimal digits
    size: int  # its length [bytes]


@dataclass
class Inputs:
    """The files that a job names, hashed when they are asked for."""

    folder: Path  # folder of the job file
    files: dict[str, InputFile] = field(default_factory=dict)

    def file(self, name: str) -> Path:
        """Return the path of a file, and note its hash."""
        path = self.folder / name
        try:
            with path.open("rb") as stream:
                made, size = hashlib.sha256(), 0
                while piece := stream.read(_PIECE):
                    made.update(piece)
                    size += len(piece)
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or error
            raise InvalidValueError(f"{name}: {why}; files are relative to the job file, here {self.folder}") from error
        self.files[name] = InputFile(name, made.hexdigest(), size)
        return path

    def named(self, pattern: str) -> list[str]:
        """Return the names of the files that a pattern finds, in the order of the alphabet.

        pattern: name of a file, or with ``*``, ``?``, ``[...]`` and ``**`` for those of several. Returns relative to
        the folder of the job file.
        """
        if not any(mark in pattern for mark in _SPECIAL) or (self.folder / pattern).exists():
            return [pattern]
        root, rest = (Path(Path(pattern).anchor), Path(pattern).parts[1:]) if Path(pattern).is_absolute() else (
            self.folder, Path(pattern).parts,
        )  # fmt: skip
        try:
            found = sorted(path for path in root.glob("/".join(rest)) if path.is_file())
        except (ValueError, OSError, NotImplementedError) as error:
            raise InvalidValueError(f"{pattern!r:.80} is no pattern of files ({error})") from error
        if not found:
            raise InvalidValueError(f"{pattern!r:.80} finds no file in {self.folder}")
        return [path.as_posix() if Path(pattern).is_absolute() else self._relative(path) for path in found]

    def _relative(self, path: Path) -> str:
        return path.relative_to(self.folder).as_posix()

    def told(self) -> list[dict[str, Any]]:
        """Return the files as plain values, in the order of their names."""
        return [{"path": f.path, "sha256": f.sha256, "bytes": f.size} for _, f in sorted(self.files.items())]


def refuse_changes(before: list[dict[str, Any]], now: list[dict[str, Any]]) -> None:
    """Refuse files that are not what they were when the campaign began."""
    was, found = ({item["path"]: item for item in items} for items in (before, now))
    advice = "restore it, or begin a new campaign in another folder"
    for path, item in was.items():
        if path not in found:
            raise InvalidValueError(f"{path}: was there when the campaign began and is missing now; {advice}")
        if found[path]["sha256"] != item["sha256"]:
            raise InvalidValueError(
                f"{path}: has changed since the campaign began (SHA-256 {item['sha256'][:12]}... then, "
                f"{found[path]['sha256'][:12]}... now); {advice}"
            )
    added = sorted(set(found) - set(was))
    if added:
        raise InvalidValueError(f"{added[0]}: was not there when the campaign began; remove it, or begin a new one")
