"""Record files: content, components, and the base class of formats."""

import hashlib
import re
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats import directions

_CLOSING = re.compile(r"[\W_]*(?:end|eof|ende|fin|fine|son)(?![^\W_])[^\d]{0,60}", re.IGNORECASE)
_MOST_CLOSING = 2
_TURKISH = re.compile(
    r"[İi]vme|zaman|d[üu]şey|doğu|bat[\u0131i]|kuzey|güney|istasyon|bileşen|birim|örnekleme|deprem|saat|süre|kay[\u0131i]t",
    re.IGNORECASE,
)
LARGEST_FILE = 256 * 1024 * 1024  # largest allowed file [bytes]


@dataclass(frozen=True)
class Source:
    """A file for the readers."""

    name: str  # file name, for messages
    content: bytes
    doubts: list[str] = field(default_factory=list, compare=False)  # warnings about the file
    stated: list[str] = field(default_factory=list, compare=False)  # properties stated by the user
    skip: int = 0  # number of lines to skip at the top

    @classmethod
    def of_path(cls, path: Path, skip: int = 0) -> "Source":
        """Read a file of limited size; skip: number of lines to skip at the top."""
        if not path.is_file():
            raise RecordError("not a plain file" if path.exists() else "no such file").at(str(path))
        try:
            size = path.stat().st_size
            if size > LARGEST_FILE:
                raise RecordError("{size} bytes exceed the limit of {limit} bytes", size=size, limit=LARGEST_FILE).at(
                    str(path)
                )
            content = path.read_bytes()
        except OSError as error:
            raise RecordError(error.strerror or str(error)).at(str(path)) from error
        if not content.strip():
            raise RecordError("{file}: the file is empty", file=path)
        return cls(path.name, content, skip=checks.whole("skip", skip, 0, 100_000))

    @cached_property
    def sha256(self) -> str:
        """SHA-256 of the content, in hexadecimal digits."""
        return hashlib.sha256(self.content).hexdigest()

    @cached_property
    def is_text(self) -> bool:
        """True if the content has no NUL byte."""
        return b"\0" not in self.content

    @cached_property
    def lines(self) -> list[str]:
        """Lines without line ends: CR, LF, CR LF or CR CR LF."""
        text = self.content.decode("latin-1")
        lines = text.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n").split("\n")
        return [*([""] * min(self.skip, len(lines))), *lines[self.skip :]]

    @cached_property
    def end(self) -> int:
        """Number of lines without final blank lines and closing words such as ``END``. Closing words give a warning."""
        # under CP/M and DOS, files were padded with Ctrl-Z to full blocks
        last, closing = len(self.lines), 0
        while last:
            bare = self.lines[last - 1].strip(" \t\r\x1a")
            if bare and not (closing < _MOST_CLOSING and _CLOSING.fullmatch(bare)):
                break
            if bare:
                self.doubt(last - 1, f"{bare[:40]!r} after the last number is ignored")
                closing += 1
            last -= 1
        return last

    def error(self, line: int | None, cause: str, **facts: Any) -> RecordError:
        """Return an error about a line. Facts are those of `RockingError`."""
        return RecordError(cause, **facts).at(self.name, 0 if line is None else line + 1)

    def doubt(self, line: int | None, cause: str) -> None:
        """Add a warning about a line. Warnings are issued after the file is read."""
        self.doubts.append(str(self.error(line, cause)))

    @contextmanager
    def doubting(self) -> Iterator[None]:
        """Convert errors in this context to warnings, because they do not affect count, unit, step or peak."""
        try:
            yield
        except RecordError as error:
            self.doubts.append(str(error))

    def begins(self, line: int, mark: str) -> bool:
        """Return True if the line exists and begins with a mark."""
        return line < len(self.lines) and self.lines[line].startswith(mark)

    def expected(self, line: int, content: str) -> RecordError:
        """Return the error for an unexpected line, or for a file that ends too early."""
        return self.error(min(line, len(self.lines) - 1), "{content} expected", content=content)


@dataclass(frozen=True, eq=False)
class Component:
    """One component of a record, in the unit of the file.

    Parameters
    ----------
    name : str
        Name in the file: an azimuth, a channel code, ``U``, ``column 2``.
    acceleration : ndarray
        Samples, in `unit`.
    unit : str
        A key of `rocking.conventions.ACCELERATION_UNITS`.
    time_step : float
        Time step between samples [s].
    stated_peak : float, optional
        Largest magnitude in the header of the file, checked against the samples, in `unit`.
    metadata : mapping of str to str
        Facts from the header about this component.
    """

    name: str
    acceleration: FloatArray
    unit: str
    time_step: float
    stated_peak: float | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)

    @property
    def peak(self) -> float:
        """Largest magnitude of the acceleration, in the unit of the file."""
        return float(np.abs(self.acceleration).max())

    @property
    def direction(self) -> directions.Direction:
        """Direction in the file: ``up``, ``down``, ``unclear``, an azimuth [degree], or None if missing."""
        if directions.KEY in self.metadata:
            return directions.of_metadata(self.metadata)
        return directions.orientation(self.metadata.get("direction") or self.name)


@dataclass(frozen=True, eq=False)
class Record:
    """Content of a record file: components and header.

    Parameters
    ----------
    format : str
        Name of the format.
    components : tuple of Component
        Components in the order of the file.
    header : str
        Raw header.
    metadata : mapping of str to str
        Facts from the header: event, station, network, processing.
    """

    format: str
    components: tuple[Component, ...]
    header: str = ""
    metadata: Mapping[str, str] = field(default_factory=dict)

    def text(self, key: str, width: int, default: str = "") -> str:
        """Return a text of the metadata for one line of a header, for writers.

        Parameters
        ----------
        key : str
            A key of the metadata.
        width : int
            Largest number of characters.
        default : str
            Text for missing metadata.

        Returns
        -------
        str
            Latin-1 text.
        """
        return one_line(self.metadata.get(key, default), width)


class RecordFormat(ABC):
    """A format of ground-motion files. A new format needs a subclass in its own module, and a line in `reader`."""

    name: ClassVar[str]  # name for `format=` and on the command line
    title: ClassVar[str]  # publisher of such files, in one line
    suffixes: ClassVar[tuple[str, ...]] = ()  # usual extensions in lower case; not used for detection
    unit_is_free: ClassVar[bool] = False  # True if written files can have any unit of acceleration
    states_unit: ClassVar[bool] = True  # True if the files contain the unit; otherwise the user must state the unit
    states_time_step: ClassVar[bool] = True  # True if the files contain the time step; otherwise the user must state it
    notes: ClassVar[str] = ""  # limits of the format and its verification
    marks: ClassVar[tuple[str, ...]] = ()  # patterns at the start of lines near the top
    top: ClassVar[int] = 0  # number of lines searched for marks

    def __init_subclass__(cls) -> None:
        """Raise an error for a format that cannot be detected."""
        super().__init_subclass__()
        if not (cls.marks and cls.top) and cls.recognises is RecordFormat.recognises:
            raise TypeError(f"{cls.__name__}: define marks and top, or recognises")

    def recognises(self, source: Source) -> bool:
        """Return True if the content has all marks of this format, or all but one. Never raises an error."""
        # a file with a damaged header must not count as columns of numbers
        return bool(self.marks) and self._marks_in(source) >= len(self.marks) - 1

    def resembles(self, source: Source) -> bool:
        """Return True if the content has half of the marks of this format or more, as in a damaged header."""
        return len(self.marks) > 3 and 2 * self._marks_in(source) >= len(self.marks)

    def _marks_in(self, source: Source) -> int:
        top = source.lines[: self.top] if source.is_text else []
        return sum(any(re.match(mark, line[:400]) for line in top) for mark in self.marks)

    def refusal(self, source: Source) -> RecordError | None:
        """Return the error of a file of this format with a known damage, otherwise None."""
        return None

    @abstractmethod
    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record."""

    @abstractmethod
    def write(self, record: Record) -> bytes:
        """Return the content of a file of this format. `read` can read the file."""


def readable(text: str, *, turkish: bool = False) -> str:
    r"""Return a decoded line: UTF-8 if valid, the Turkish encoding for Turkish words, otherwise Latin-1.

    >>> readable("\xddvme (g)"), readable("\xc5\xa0i\xc5\xa1")
    ('İvme (g)', 'Šiš')
    """
    content = text.encode("latin-1", "ignore")
    try:
        return content.decode("utf-8")
    except UnicodeError:
        in_turkish = content.decode("cp1254", "replace")
        return in_turkish if turkish or _TURKISH.search(in_turkish) else text


def one_line(text: object, width: int) -> str:
    r"""Return Latin-1 text for one line of a header, for writers. Other letters become question marks.

    >>> one_line("El Centro\r\n 1940", 12)
    'El Centro 19'
    """
    plain = " ".join(str(text).split()).encode("latin-1", "replace").decode("latin-1")
    return "".join(mark if mark.isprintable() else "?" for mark in plain)[:width].strip()


def metadata_of(**texts: str) -> dict[str, str]:
    """Return metadata without empty texts; underscores in keys become blanks.

    >>> metadata_of(event="Kobe", station_name=" ")
    {'event': 'Kobe'}
    """
    return {key.replace("_", " "): readable(text.strip()) for key, text in texts.items() if text.strip()}
