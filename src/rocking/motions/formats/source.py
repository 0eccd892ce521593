"""The file that a reader looks at: bytes, lines, and the error that names file and line."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from rocking.errors import RecordError

LARGEST_FILE = 256 * 1024 * 1024
"""Larger files are refused [bytes]."""


@dataclass(frozen=True)
class Source:
    """A file's name and content."""

    name: str  # name for messages
    content: bytes  # what is in it

    @classmethod
    def of_path(cls, path: Path) -> "Source":
        """Read a file, within limits."""
        if not path.is_file():
            raise RecordError(f"{path}: {'not a plain file' if path.exists() else 'no such file'}")
        try:
            size = path.stat().st_size
            if size > LARGEST_FILE:
                raise RecordError(f"{path}: {size} bytes, more than the {LARGEST_FILE} that are read")
            content = path.read_bytes()
        except OSError as error:
            raise RecordError(f"{path}: {error.strerror or error}") from error
        if not content.strip():
            raise RecordError(f"{path}: the file is empty")
        return cls(path.name, content)

    @cached_property
    def is_text(self) -> bool:
        """Whether it looks like text: no NUL among its bytes."""
        return b"\0" not in self.content

    @cached_property
    def lines(self) -> list[str]:
        """Lines without their ends; CR, LF, CR LF and CR CR LF all end one."""
        text = self.content.decode("latin-1")
        return text.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n").split("\n")

    def error(self, line: int | None, cause: str) -> RecordError:
        """Return the error for a line, to be raised."""
        return RecordError(f"{self.name}{'' if line is None else f', line {line + 1}'}: {cause}")
