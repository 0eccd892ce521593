"""A record file: its bytes and lines, what it holds, and what every format of such files is."""

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
LARGEST_FILE = 256 * 1024 * 1024  # larger files are refused [bytes]


@dataclass(frozen=True)
class Source:
    """The file that a reader looks at."""

    name: str  # its name, for messages
    content: bytes  # what is in it
    doubts: list[str] = field(default_factory=list, compare=False)  # what a reader found odd and did not refuse
    stated: list[str] = field(default_factory=list, compare=False)  # what the user stated of it by hand
    skip: int = 0  # lines at the top that the user passes over

    @classmethod
    def of_path(cls, path: Path, skip: int = 0) -> "Source":
        """Read a file, within limits; skip: lines at its top to pass over."""
        if not path.is_file():
            raise RecordError("not a plain file" if path.exists() else "no such file").at(str(path))
        try:
            size = path.stat().st_size
            if size > LARGEST_FILE:
                raise RecordError(
                    "{size} bytes, more than the {limit} that are read", size=size, limit=LARGEST_FILE
                ).at(str(path))
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
        """Whether it looks like text: no NUL among its bytes."""
        return b"\0" not in self.content

    @cached_property
    def lines(self) -> list[str]:
        """Lines without their ends; CR, LF, CR LF and CR CR LF all end one."""
        text = self.content.decode("latin-1")
        lines = text.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n").split("\n")
        return [*([""] * min(self.skip, len(lines))), *lines[self.skip :]]

    @cached_property
    def end(self) -> int:
        """Number of lines up to words that close the file, such as ``END``, which are doubted, and to blanks."""
        # Ctrl-Z padded files to whole blocks under CP/M and DOS
        last, closing = len(self.lines), 0
        while last:
            bare = self.lines[last - 1].strip(" \t\r\x1a")
            if bare and not (closing < _MOST_CLOSING and _CLOSING.fullmatch(bare)):
                break
            if bare:
                self.doubt(last - 1, f"{bare[:40]!r} behind the last number is passed over")
                closing += 1
            last -= 1
        return last

    def error(self, line: int | None, cause: str, **facts: Any) -> RecordError:
        """Return the error for a line, to be raised; facts: as of `RockingError`."""
        return RecordError(cause, **facts).at(self.name, 0 if line is None else line + 1)

    def doubt(self, line: int | None, cause: str) -> None:
        """Keep a doubt about a line, which is said once the file is read."""
        self.doubts.append(str(self.error(line, cause)))

    @contextmanager
    def doubting(self) -> Iterator[None]:
        """Make a doubt of what is refused within: it is no count, unit, step or peak of the acceleration."""
        try:
            yield
        except RecordError as error:
            self.doubts.append(str(error))

    def begins(self, line: int, mark: str) -> bool:
        """Return whether there is such a line and it begins with a mark."""
        return line < len(self.lines) and self.lines[line].startswith(mark)

    def expected(self, line: int, what: str) -> RecordError:
        """Return the error for a line that should say something else, or of which the file ends too early."""
        return self.error(min(line, len(self.lines) - 1), "{content} expected", content=what)


@dataclass(frozen=True, eq=False)
class Component:
    """One component of a record, in the unit of the file.

    Parameters
    ----------
    name : str
        What the file calls it: an azimuth, a channel code, ``U``, ``column 2``.
    acceleration : ndarray
        Samples, in `unit`.
    unit : str
        A key of `rocking.conventions.ACCELERATION_UNITS`.
    time_step : float
        Step between samples [s].
    stated_peak : float, optional
        Largest acceleration by the file's own header, without its sign, in `unit`; the reader has checked it.
    metadata : mapping of str to str
        What the header says about this component.
    """

    name: str
    acceleration: FloatArray
    unit: str
    time_step: float
    stated_peak: float | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)

    @property
    def peak(self) -> float:
        """Largest acceleration without its sign, in the unit of the file."""
        return float(np.abs(self.acceleration).max())

    @property
    def direction(self) -> directions.Direction:
        """Direction by the file: ``up``, ``down``, ``unclear``, an azimuth [degree]; None if it states none."""
        if directions.KEY in self.metadata:
            return directions.of_metadata(self.metadata)
        return directions.orientation(self.metadata.get("direction") or self.name)


@dataclass(frozen=True, eq=False)
class Record:
    """A record file: its components in the order of the file, and its header as it stands.

    Parameters
    ----------
    format : str
        Name of the format it was read as.
    components : tuple of Component
        In the order of the file.
    header : str
        The raw header.
    metadata : mapping of str to str
        What the header says: event, station, network, processing.
    """

    format: str
    components: tuple[Component, ...]
    header: str = ""
    metadata: Mapping[str, str] = field(default_factory=dict)

    def text(self, key: str, width: int, default: str = "") -> str:
        """Return what is known of the record on one line of a header, for writers.

        Parameters
        ----------
        key : str
            A key of the metadata.
        width : int
            Most characters.
        default : str
            What a header says where nothing is known.

        Returns
        -------
        str
            Latin-1 text.
        """
        return one_line(self.metadata.get(key, default), width)


class RecordFormat(ABC):
    """One format of ground-motion files; a new one is a subclass in a file of its own and a line in `reader`."""

    name: ClassVar[str]  # name for `format=` and on the command line
    title: ClassVar[str]  # who publishes such files, in one line
    suffixes: ClassVar[tuple[str, ...]] = ()  # usual endings, lower case, for people only: content decides
    states_unit: ClassVar[bool] = True  # whether the file itself says so; where not, the user must
    states_time_step: ClassVar[bool] = True  # whether the file itself says so; where not, the user must
    notes: ClassVar[str] = ""  # what to know before trusting it
    marks: ClassVar[tuple[str, ...]] = ()  # patterns of text with which lines near the top begin
    top: ClassVar[int] = 0  # how many lines are looked at for them

    def __init_subclass__(cls) -> None:
        """Refuse a format that nothing recognises."""
        super().__init_subclass__()
        if not (cls.marks and cls.top) and cls.recognises is RecordFormat.recognises:
            raise TypeError(f"{cls.__name__}: say marks and top, or write recognises")

    def recognises(self, source: Source) -> bool:
        """Return whether the content looks like this format: all marks but one are there; never raises."""
        # a damaged header must not turn a file into a nameless table of numbers
        return bool(self.marks) and self._marks_in(source) >= len(self.marks) - 1

    def resembles(self, source: Source) -> bool:
        """Return whether half of the marks of this format are there, as in a damaged header."""
        return len(self.marks) > 3 and 2 * self._marks_in(source) >= len(self.marks)

    def _marks_in(self, source: Source) -> int:
        top = source.lines[: self.top] if source.is_text else []
        return sum(any(re.match(mark, line[:400]) for line in top) for mark in self.marks)

    def refusal(self, source: Source) -> RecordError | None:
        """Return why a file that no format recognises would be of this one but for a damage that can be named."""
        return None

    @abstractmethod
    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record."""

    @abstractmethod
    def write(self, record: Record) -> bytes:
        """Return the content of a file that `read` reads back, to the digits that the format can hold."""


def readable(text: str, *, turkish: bool = False) -> str:
    r"""Return a line in the alphabet in which it was written: UTF-8 where it is that, Turkish by its words, or Latin-1.

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
    r"""Return Latin-1 text that fits on one line of a header, for writers; other letters become question marks.

    >>> one_line("El Centro\r\n 1940", 12)
    'El Centro 19'
    """
    plain = " ".join(str(text).split()).encode("latin-1", "replace").decode("latin-1")
    return "".join(mark if mark.isprintable() else "?" for mark in plain)[:width].strip()


def metadata_of(**texts: str) -> dict[str, str]:
    """Return what a header says, without what it leaves empty; an underscore is a blank.

    >>> metadata_of(event="Kobe", station_name=" ")
    {'event': 'Kobe'}
    """
    return {key.replace("_", " "): readable(text.strip()) for key, text in texts.items() if text.strip()}
