"""The parts of which the report of a response is put together, as plain content."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from rocking.reports.document import Cell, Paragraph, ReportTable

_NUMBER = frozenset("+-\N{MINUS SIGN}0123456789")


@dataclass(frozen=True, slots=True)
class Image:
    """A picture."""

    stem: str  # name of its file, without suffix
    caption: str  # what it shows
    width: int = 100  # share of the width of the page [%]


@dataclass(frozen=True, slots=True)
class Pair:
    """A picture, and a table to its right."""

    left: Image  # the picture
    right: ReportTable
    share: int = 40  # share of the picture in the width [%]


@dataclass(frozen=True, slots=True)
class Listing:
    """Text as a machine reads it."""

    text: str  # the text, line by line
    lead: str = ""  # words before it


Block = Paragraph | ReportTable | Image | Pair | Listing


@dataclass(frozen=True, slots=True)
class PagePart:
    """A section."""

    title: str
    blocks: Sequence[Block]  # its content


@dataclass(frozen=True, slots=True)
class Pages:
    """The whole report."""

    title: str  # title, subtitle: title, and a line below it
    subtitle: str
    verdict: Sequence[Paragraph]  # what matters most
    parts: Sequence[PagePart]  # the content
    footer: str = field(default="")  # small print of every page

    def plain(self) -> dict[str, Any]:
        """Return everything as plain values, for the template."""
        return {
            "title": self.title,
            "subtitle": self.subtitle,
            "footer": self.footer,
            "verdict": [_plain(each) for each in self.verdict],
            "sections": [
                {"title": part.title, "blocks": [_plain(each) for each in part.blocks]} for part in self.parts
            ],
        }


def _plain(block: Block) -> dict[str, Any]:
    if isinstance(block, Paragraph):
        return {"kind": "paragraph", "lead": block.lead, "text": block.text, "mark": block.mark}
    if isinstance(block, Image):
        return {"kind": "picture", "file": f"{block.stem}.svg", "caption": block.caption, "width": block.width}
    if isinstance(block, Pair):
        return {"kind": "pair", "left": _plain(block.left), "right": _plain(block.right), "share": block.share}
    if isinstance(block, Listing):
        return {"kind": "listing", "text": block.text, "lead": block.lead}
    return {
        "kind": "table",
        "caption": block.caption,
        "header": list(block.header),
        "rows": [[{"text": each.text, "mark": each.mark} for each in row] for row in block.rows],
        "numbers": [_numeric([row[k] for row in block.rows]) for k in range(len(block.header))],
        "note": block.note,
    }


def _numeric(cells: Sequence[Cell]) -> bool:
    """Tell whether a column holds numbers, which are set flush right."""
    return bool(cells) and all(not each.text or each.text[0] in _NUMBER for each in cells)
