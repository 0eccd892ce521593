"""What every record format is: a name, a way to recognise it, a reader and a writer."""

from abc import ABC, abstractmethod
from typing import ClassVar

from rocking.errors import RecordError
from rocking.motions.formats.record import Record
from rocking.motions.formats.source import Source


class RecordFormat(ABC):
    """One format of ground-motion files; a new one is a subclass in a file of its own and a line in the registry.

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
            What to write.

        Returns
        -------
        bytes
            The content.

        Raises
        ------
        RecordError
            If the format cannot hold it.
        """
