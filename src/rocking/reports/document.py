"""A report as plain content, whatever it is rendered to: sections of paragraphs, tables and figures."""

from collections.abc import Sequence
from dataclasses import dataclass, field

MARKS = ("good", "fair", "bad", "plain")
"""What a cell or a verdict says: agrees, in part, does not, nothing to say."""


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of a table."""

    text: str  # what stands in it
    mark: str = "plain"  # one of `MARKS`


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Plain text."""

    text: str
    lead: str = ""  # words set in bold before it
    mark: str = "plain"  # one of `MARKS`; shown as a coloured bar or word


@dataclass(frozen=True, slots=True)
class ReportTable:
    """A table with a caption."""

    caption: str  # what it shows
    header: Sequence[str]  # column names with units
    rows: Sequence[Sequence[Cell]]
    note: str = ""  # A line below
    stem: str = ""  # name of its CSV file


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure of the report."""

    stem: str  # name of its files, without suffix
    caption: str  # what it shows
    wide: bool = True  # whether it needs the full width


Block = Paragraph | ReportTable | Picture


@dataclass(frozen=True, slots=True)
class ReportSection:
    """A section of the report."""

    title: str
    blocks: Sequence[Block]  # its content


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
    sections: Sequence[ReportSection]
    provenance: dict[str, str] = field(default_factory=dict)

    @property
    def tables(self) -> list[ReportTable]:
        """Every table with a file name, in order."""
        blocks = (block for section in self.sections for block in section.blocks)
        return [block for block in blocks if isinstance(block, ReportTable) and block.stem]


def cell(text: object, mark: str = "plain") -> Cell:
    """Return a cell from anything that prints."""
    return Cell(str(text), mark)
