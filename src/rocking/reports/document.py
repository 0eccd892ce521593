"""A report as plain content, and as one self-contained HTML file or a PDF set by Typst, of nothing from elsewhere."""

import hashlib
import json
import platform
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from rocking.answers import AnswerRows, Display
from rocking.errors import InvalidValueError, extra
from rocking.version import SOFTWARE

_NUMBER = frozenset("+-\N{MINUS SIGN}0123456789")


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of a table."""

    text: str
    mark: str = "plain"  # good, fair, bad or plain: agrees, in part, does not, nothing to say
    picture: str = ""  # name of a small picture's file, beside the others


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Plain text."""

    text: str
    lead: str = ""  # words set in bold before it
    mark: str = "plain"  # as of a cell; shown as a coloured bar or word


@dataclass(frozen=True, slots=True)
class ReportTable:
    """A table with a caption."""

    caption: str
    header: Sequence[str]  # column names with units
    rows: Sequence[Sequence[Cell]]
    note: str = ""  # a line below
    stem: str = ""  # name of its CSV file


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure of the report."""

    stem: str  # name of its files, without suffix
    caption: str
    width: int = 100  # share of the width of the page [%]


@dataclass(frozen=True, slots=True)
class Pair:
    """A picture, and a table to its right."""

    left: Picture
    right: ReportTable
    share: int = 40  # share of the picture in the width [%]


@dataclass(frozen=True, slots=True)
class Listing:
    """Text as a machine reads it, line by line."""

    text: str
    lead: str = ""  # words before it


Block = Paragraph | ReportTable | Picture | Pair | Listing


@dataclass(frozen=True, slots=True)
class ReportSection:
    """A section of the report."""

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
    sections : sequence of ReportSection
        The content.
    look_at : sequence of (str, str)
        What to look at first: a short name and a sentence.
    verdict : sequence of Paragraph
        What matters most.
    provenance : dict of str to str
        Versions and sources.
    footer : str
        Small print of every page.
    language : str
        In which it is, as in ISO 639-1.
    look_at_title, sections_title : str
        What stands above what to look at first, and what the list of sections is called.
    """

    title: str
    subtitle: str
    sections: Sequence[ReportSection]
    look_at: Sequence[tuple[str, str]] = ()
    verdict: Sequence[Paragraph] = ()
    provenance: dict[str, str] = field(default_factory=dict)
    footer: str = ""
    language: str = "en"
    look_at_title: str = "What to look at"
    sections_title: str = "Sections"

    @property
    def tables(self) -> list[ReportTable]:
        """Every table with a file name, in order."""
        blocks = (block for section in self.sections for block in section.blocks)
        return [block for block in blocks if isinstance(block, ReportTable) and block.stem]

    def plain(self) -> dict[str, Any]:
        """Return everything as plain values, for the templates of Typst.

        Returns
        -------
        dict
            Fields by name; each block with its ``kind``.
        """
        sections = [(each.title, [_plain(block) for block in each.blocks]) for each in self.sections]
        return {
            "title": self.title,
            "subtitle": self.subtitle,
            "footer": self.footer,
            "language": self.language,
            "look_at_title": self.look_at_title,
            "look_at": [list(pair) for pair in self.look_at],
            "verdict": [_plain(each) for each in self.verdict],
            "sections": [{"title": title, "blocks": blocks} for title, blocks in sections],
            "provenance": [f"{name}: {value}." for name, value in self.provenance.items()],
        }


def _plain(block: Block) -> dict[str, Any]:
    if isinstance(block, Pair):
        return {"kind": "pair", "left": _plain(block.left), "right": _plain(block.right), "share": block.share}
    if isinstance(block, Picture):
        return {"kind": "picture", "file": f"{block.stem}.svg", **asdict(block)}
    if isinstance(block, ReportTable):
        # columns of numbers are set flush right
        texts = [[row[k].text for row in block.rows] for k in range(len(block.header))]
        numbers = [bool(column) and all(not text or text[0] in _NUMBER for text in column) for column in texts]
        return {"kind": "table", "numbers": numbers, **asdict(block)}
    return {"kind": type(block).__name__.lower(), **asdict(block)}


def table(
    caption: str, header: Sequence[str], rows: Iterable[Iterable[object]], note: str = "", stem: str = ""
) -> ReportTable:
    """Return a table from cells and anything that prints.

    >>> table("", ["r [-]"], [[0.5]]).rows
    [[Cell(text='0.5', mark='plain', picture='')]]
    """
    cells = [[each if isinstance(each, Cell) else Cell(str(each)) for each in row] for row in rows]
    return ReportTable(caption, header, cells, note, stem)


def answer_table(
    caption: str, rows: AnswerRows | Iterable[Mapping[str, Any]], names: Sequence[str] = (), note: str = "",
    stem: str = "", *, display: Display | None = None, marks: Mapping[str, Sequence[str]] | None = None,
) -> ReportTable:  # fmt: skip
    """Return a table of an answer; names: its columns; marks: of the cells of a column, by its name."""
    columns = (display or Display()).table(rows, names)
    marked = (map(Cell, each.cells, (marks or {}).get(each.name) or ["plain"] * len(each.cells)) for each in columns)
    return table(caption, [each.heading for each in columns], zip(*marked, strict=True), note, stem)


def judged(title: str, under: Iterable[str], sections: Sequence[ReportSection], verdict: str, mark: str) -> Document:
    """Return a report with its verdict on top; under: what stands below the title, as far as there is something."""
    subtitle = ". ".join(filter(None, under))
    return Document(title, subtitle, sections, verdict=[Paragraph(verdict, "", mark)], footer=SOFTWARE)


def made_with() -> dict[str, str]:
    """Return what made a result: versions, and the fingerprints of the data."""
    import scipy

    from rocking import evidence
    from rocking.evidence.measurements import provenance

    source, data = provenance(), files(evidence).joinpath("data")
    prints = [
        f"{name} {hashlib.sha256(data.joinpath(name).read_bytes()).hexdigest()[:12]}"
        for name in (f"mao2024_table{i}.csv" for i in (1, 2, 3))
    ]
    return {
        "Made with": f"{SOFTWARE}, Python {platform.python_version()}, numpy {np.__version__}, "
        f"scipy {scipy.__version__}",
        "Measurements": f"{source['source']}, doi:{source['doi']}, {source['licence']}",
        "SHA-256": ", ".join(prints),
    }


def render_html(document: Document, pictures: Path) -> str:
    """Return a report as HTML, its pictures inside."""
    jinja2 = extra("jinja2", "the HTML report")
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    kinds = {"table": ReportTable, "pair": Pair, "listing": Listing, "paragraph": Paragraph}
    environment.tests |= {name: partial(_is, kind) for name, kind in kinds.items()}
    template = environment.from_string(_template("report.html.jinja").decode())
    html: str = template.render(
        document=document, svg=lambda stem: _inline(pictures, stem), image=lambda name: _address(pictures / name)
    )
    return html


def _is(kind: type, block: object) -> bool:
    return isinstance(block, kind)


def _inline(folder: Path, stem: str) -> object:
    from markupsafe import Markup

    text = (folder / f"{stem}.svg").read_text(encoding="utf-8")
    # ids of different pictures must not meet in one page
    body = text[text.index("<svg") :]
    for attribute in ('id="', 'href="#', "url(#"):
        body = body.replace(attribute, f"{attribute}{stem}-")
    return Markup(body)


def _address(jpeg: Path) -> str:
    """Return a small picture as an address that holds it."""
    return f"data:image/jpeg;base64,{b64encode(jpeg.read_bytes()).decode()}"


def write_html(document: Document, pictures: Path, path: Path) -> None:
    """Write a report as HTML."""
    path.write_text(render_html(document, pictures), encoding="utf-8")


def render_pdf(document: Document, pictures: Path, path: Path) -> None:
    """Write a report as PDF."""
    path.write_bytes(_pdf(document, "report.typ", pictures, _fonts()))


Content = tuple[Document, dict[str, Callable[[], Any]]]
"""A document, and what draws its pictures, by stem."""


def write_report(document: Document, pictures: Mapping[str, Callable[[], Any]], path: Path) -> None:
    """Write a report of one body as .pdf or .html; pictures: what draws each, by stem."""
    from rocking.plots.style import write

    if path.suffix.lower() not in {".pdf", ".html"}:
        raise InvalidValueError("a report is .pdf or .html, got {file!r}", file=path.name)
    with TemporaryDirectory(prefix="rocking-report-") as folder:
        drawn = {stem: write(draw(), Path(folder) / f"{stem}.svg") for stem, draw in pictures.items()}
        if path.suffix.lower() == ".html":
            write_html(document, Path(folder), path)
        else:
            path.write_bytes(response_pdf(document, {stem: file.read_bytes() for stem, file in drawn.items()}))


def response_pdf(document: Document, pictures: Mapping[str, bytes]) -> bytes:
    """Return the report of a response as PDF, the same for the same content."""
    with TemporaryDirectory(prefix="rocking-report-") as name:
        folder = Path(name)
        for stem, data in pictures.items():
            (folder / f"{stem}.svg").write_bytes(data)
        # its words in any script come from the fonts of the system; those of the pictures are always there
        return _pdf(document, "response.typ", folder, _fonts())


def _fonts() -> list[str]:
    """Return where the typeface of pictures, words and tables is; none where nothing draws."""
    try:
        from matplotlib import get_data_path
    except ImportError:
        return []

    return [str(Path(get_data_path()) / "fonts" / "ttf")]


def _pdf(document: Document, template: str, folder: Path, fonts: list[str]) -> bytes:
    typst = extra("typst", "the PDF report")
    source = folder / template
    source.write_bytes(_template(template))
    try:
        inputs = {"document": json.dumps(document.plain())}
        pdf = typst.compile(str(source), root=str(folder), sys_inputs=inputs, font_paths=fonts)
    finally:
        source.unlink()
    assert isinstance(pdf, bytes)
    return pdf


def _template(name: str) -> bytes:
    return Path(__file__).with_name(name).read_bytes()
