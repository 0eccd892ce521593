"""Reading of input files: their text, their tables, the files that they name, and errors in one sentence."""

import hashlib
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from rocking.errors import InvalidValueError, reason_of
from rocking.spec.schema import migrated

if TYPE_CHECKING:
    from rocking.spec.fields import JobTable

    _Kind = TypeVar("_Kind", bound=JobTable)

_PIECE = 1 << 20
_SPECIAL = "*?["
LARGEST_JOB = 16 * 2**20  # largest size of a job file [byte]


@dataclass
class InputFiles:
    """The files that a job names, with their hashes."""

    folder: Path  # folder of the job file
    # path, sha256 and size in bytes, by the file name in the job or the name that matched a pattern
    files: dict[str, dict[str, Any]] = field(default_factory=dict)

    def file(self, name: str) -> Path:
        """Return the path of a file, and note its hash."""
        path = self.folder / name
        try:
            with path.open("rb") as stream:
                digest, size = hashlib.sha256(), 0
                while piece := stream.read(_PIECE):
                    digest.update(piece)
                    size += len(piece)
        except (OSError, ValueError) as error:
            raise InvalidValueError(
                "{name}: {fault}. File names are relative to the folder of the job file, {folder}.", name=name,
                fault=reason_of(error), folder=self.folder,
            ) from error  # fmt: skip
        self.files[name] = {"path": name, "sha256": digest.hexdigest(), "bytes": size}
        return path

    def named(self, pattern: str) -> list[str]:
        """Return the files that match a pattern such as ``**/*.at2``, relative to the job file, in alphabetic order."""
        if not is_pattern(pattern) or (self.folder / pattern).exists():
            return [pattern]
        root, parts = (Path(Path(pattern).anchor), Path(pattern).parts[1:]) if Path(pattern).is_absolute() else (
            self.folder, Path(pattern).parts,
        )  # fmt: skip
        try:
            paths = sorted(path for path in root.glob("/".join(parts)) if path.is_file())
        except (ValueError, OSError, NotImplementedError) as error:
            raise InvalidValueError(
                "Invalid file pattern {pattern!r:.80} ({reason}).", pattern=pattern, reason=str(error)
            ) from error
        if not paths:
            raise InvalidValueError("No file in {folder} matches {pattern!r:.80}.", pattern=pattern, folder=self.folder)
        return [(path if Path(pattern).is_absolute() else path.relative_to(self.folder)).as_posix() for path in paths]

    def facts(self) -> list[dict[str, Any]]:
        """Return the files as plain values, sorted by name."""
        return [self.files[name] for name in sorted(self.files)]


class CommandFiles(InputFiles):
    """The files that a command names, without hashes. The functions that read these files report errors."""

    def file(self, name: str) -> Path:
        return self.folder / name


def is_pattern(name: str) -> bool:
    """Return True if the name is a file pattern."""
    return any(mark in name for mark in _SPECIAL)


def refuse_changes(before: list[dict[str, Any]], now: list[dict[str, Any]]) -> None:
    """Refuse files that changed after the start of the campaign."""
    was, here = ({item["path"]: item for item in items} for items in (before, now))
    advice = "restore it, or start a new campaign in another folder"
    for path, item in was.items():
        if path not in here:
            raise InvalidValueError("The file is missing, but the campaign uses this file", hint=advice).at(str(path))
        if here[path]["sha256"] != item["sha256"]:
            raise InvalidValueError(
                "The file changed after the start of the campaign (SHA-256 {expected}... before, {hash}... now)",
                expected=item["sha256"][:12], hash=here[path]["sha256"][:12], hint=advice,
            ).at(str(path))  # fmt: skip
    added = sorted(set(here) - set(was))
    if added:
        raise InvalidValueError(
            "The campaign does not use this new file", hint="remove the file, or start a new campaign in another folder"
        ).at(added[0])


def read_text(path: Path) -> str:
    """Return the text of a job file."""
    try:
        if path.is_dir():
            raise InvalidValueError(
                "{folder} is a folder", folder=path, hint="use a job file, or the commands status, resume and export"
            )
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise InvalidValueError("no such file").at(str(path)) from error
    except (OSError, ValueError) as error:
        raise InvalidValueError(
            "The file cannot be opened ({reason}).", reason=str(getattr(error, "strerror", None) or error)
        ).at(str(path)) from error
    if len(data) > LARGEST_JOB:
        raise InvalidValueError("A job file has at most 16 MiB, got {size:.1f} MiB.", size=len(data) / 2**20).at(
            str(path)
        )
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidValueError("The file is not UTF-8 text (byte {byte}).", byte=error.start).at(str(path)) from error


def tables_of(text: str) -> dict[str, Any]:
    """Return the unchecked tables of a text."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InvalidValueError("Invalid TOML: {reason}", reason=str(error)) from error
    except (ValueError, RecursionError) as error:
        raise InvalidValueError("Unreadable TOML: {reason}", reason=str(error).partition(";")[0]) from error


def checked(kind: "type[_Kind]", tables: dict[str, Any]) -> "_Kind":
    """Return the validated tables of a file of any schema."""
    return validated(kind, migrated(tables))


def validated(kind: "type[_Kind]", tables: dict[str, Any]) -> "_Kind":
    """Return the validated tables of the current schema. An error consists of one sentence."""
    from pydantic import ValidationError

    from rocking.bodies.formats.words import from_pydantic

    try:
        return kind.model_validate(tables)
    except ValidationError as error:
        raise from_pydantic(error.errors(include_url=False)) from error


def tables_in(path: Path) -> dict[str, Any] | None:
    """Return the unchecked tables of a TOML file; None for any other file. This function never raises an error."""
    if path.suffix.lower() != ".toml":
        return None
    try:
        return tomllib.loads(read_text(path))
    except (InvalidValueError, ValueError, RecursionError):
        return None
