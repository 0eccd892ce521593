"""A report as plain content, whatever it is rendered to: sections of paragraphs, tables and figures."""

from collections.abc import Sequence
from dataclasses import dataclass, field

MARKS = ("good", "fair", "bad", "plain")
"""What a cell or a verdict says: agrees, in part, does not, nothing to say."""


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of a table.

    Parameters
    ----------
    text : str
        What stands in it.
    mark : str
        One of `MARKS`.
    """

    text: str
    mark: str = "plain"


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Plain text.

    Parameters
    ----------
    text : str
        The text.
    lead : str
        Words set in bold before it.
    mark : str
        One of `MARKS`; shown as a coloured bar or word.
    """

    text: str
    lead: str = ""
    mark: str = "plain"


@dataclass(frozen=True, slots=True)
class Table:
    """A table with a caption.

    Parameters
    ----------
    caption : str
        What it shows.
    header : sequence of str
        Column names with units.
    rows : sequence of sequence of Cell
        The cells.
    note : str
        A line below.
    stem : str
        Name of its CSV file.
    """

    caption: str
    header: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    note: str = ""
    stem: str = ""


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure of the report.

    Parameters
    ----------
    stem : str
        Name of its files, without suffix.
    caption : str
        What it shows.
    wide : bool
        Whether it needs the full width.
    """

    stem: str
    caption: str
    wide: bool = True


Block = Paragraph | Table | Picture


@dataclass(frozen=True, slots=True)
class Section:
    """A section of the report.

    Parameters
    ----------
    title : str
        Its title.
    blocks : sequence of Block
        Its content.
    """

    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True, slots=True)
class Document:
    """A whole report.

    Parameters
    ----------
    title : str
        Title.
    subtitle : str
        A line below it.
    look_at : sequence of (str, str)
        What to look at first: a short name and a sentence.
    sections : sequence of Section
        The content.
    provenance : dict of str to str
        Versions and sources.
    """

    title: str
    subtitle: str
    look_at: Sequence[tuple[str, str]]
    sections: Sequence[Section]
    provenance: dict[str, str] = field(default_factory=dict)

    @property
    def tables(self) -> list[Table]:
        """Every table with a file name, in order."""
        blocks = (block for section in self.sections for block in section.blocks)
        return [block for block in blocks if isinstance(block, Table) and block.stem]


def cell(text: object, mark: str = "plain") -> Cell:
    """Return a cell from anything that prints.

    Parameters
    ----------
    text : object
        What stands in it.
    mark : str
        One of `MARKS`.

    Returns
    -------
    Cell
        The cell.
    """
    return Cell(str(text), mark)
