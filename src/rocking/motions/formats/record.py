"""A record file: its bytes and lines, what it holds, and what every format of such files is."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError

LARGEST_FILE = 256 * 1024 * 1024
"""Larger files are refused [bytes]."""


@dataclass(frozen=True)
class Source:
    """The file that a reader looks at.

    Parameters
    ----------
    name : str
        Its name, for messages.
    content : bytes
        What is in it.
    """

    name: str
    content: bytes

    @classmethod
    def of_path(cls, path: Path) -> "Source":
        """Read a file, within limits.

        Parameters
        ----------
        path : Path
            The file.

        Returns
        -------
        Source
            Its name and content.
        """
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
        """Return the error for a line, to be raised.

        Parameters
        ----------
        line : int or None
            Index of the line; None for the whole file.
        cause : str
            What is wrong.

        Returns
        -------
        RecordError
            It names file and line.
        """
        return RecordError(f"{self.name}{'' if line is None else f', line {line + 1}'}: {cause}")


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


class RecordFormat(ABC):
    """One format of ground-motion files; a new one is a subclass in a file of its own and a line in `reader`.

    Attributes
    ----------
    name : str
        Name for `format=` and on the command line.
    title : str
        Who publishes such files, in one line.
    suffixes : tuple of str
        Usual endings, lower case, for people only: content decides.
    states_unit, states_time_step : bool
        Whether the file itself says so; where not, the user must.
    notes : str
        What to know before trusting it.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    suffixes: ClassVar[tuple[str, ...]] = ()
    states_unit: ClassVar[bool] = True
    states_time_step: ClassVar[bool] = True
    notes: ClassVar[str] = ""

    @abstractmethod
    def recognises(self, source: Source) -> bool:
        """Return whether the content looks like this format; never raises.

        Parameters
        ----------
        source : Source
            The file.

        Returns
        -------
        bool
            True if this format should read it.
        """

    def refusal(self, source: Source) -> RecordError | None:
        """Return why a file that no format recognises would be of this one but for a damage that can be named.

        Parameters
        ----------
        source : Source
            The file.

        Returns
        -------
        RecordError or None
            The error to raise, with its line; None if the format has nothing to say.
        """
        return None

    @abstractmethod
    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record.

        Parameters
        ----------
        source : Source
            The file.
        units : str, optional
            Unit of acceleration, where the file does not say; one that contradicts the file is refused.
        time_step : float, optional
            Step between samples, where the file does not say; one that contradicts the file is refused [s].

        Returns
        -------
        Record
            Components and header.

        Raises
        ------
        RecordError
            If it is damaged, at odds with its own header, or a unit or step is missing.
        """

    @abstractmethod
    def write(self, record: Record) -> bytes:
        """Return the content of a file that `read` reads back, to the digits that the format can hold.

        Parameters
        ----------
        record : Record
            What to write; what the format cannot hold raises a `RecordError`.

        Returns
        -------
        bytes
            The content.
        """
