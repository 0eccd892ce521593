"""A report as plain content, as one self-contained HTML file, or as a PDF from Typst without network access."""

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
    mark: str = "plain"  # good (agrees), fair (agrees in part), bad (disagrees) or plain (not rated)
    picture: str = ""  # file name of a thumbnail, in the folder of the pictures


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Plain text."""

    text: str
    lead: str = ""  # bold text before the paragraph
    mark: str = "plain"  # mark as for a cell; shown as a coloured bar or word


@dataclass(frozen=True, slots=True)
class ReportTable:
    """A table with a caption."""

    caption: str
    header: Sequence[str]  # column names with units
    rows: Sequence[Sequence[Cell]]
    note: str = ""  # a line below the table
    stem: str = ""  # name of its CSV file


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure of the report."""

    stem: str  # name of its files, without suffix
    caption: str
    width: int = 100  # fraction of the page width [%]


@dataclass(frozen=True, slots=True)
class Pair:
    """A picture, and a table to its right."""

    left: Picture
    right: ReportTable
    share: int = 40  # fraction of the width for the picture [%]


@dataclass(frozen=True, slots=True)
class Listing:
    """Machine-readable text in lines."""

    text: str
    lead: str = ""  # text before the listing


Block = Paragraph | ReportTable | Picture | Pair | Listing


@dataclass(frozen=True, slots=True)
class ReportSection:
    """A section of the report."""

    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True, slots=True)
class Document:
    """A complete report.

    Parameters
    ----------
    title : str
        Title.
    subtitle : str
        Line below the title.
    sections : sequence of ReportSection
        The content.
    look_at : sequence of (str, str)
        Main points: a short name and a sentence.
    verdict : sequence of Paragraph
        Main result.
    provenance : dict of str to str
        Versions and sources.
    footer : str
        Small print of every page.
    language : str
        ISO 639-1 code of the language.
    look_at_title, sections_title : str
        Titles of the main points and of the list of sections.
    """

    title: str
    subtitle: str
    sections: Sequence[ReportSection]
    look_at: Sequence[tuple[str, str]] = ()
    verdict: Sequence[Paragraph] = ()
    provenance: dict[str, str] = field(default_factory=dict)
    footer: str = ""
    language: str = "en"
    look_at_title: str = "Main points"
    sections_title: str = "Sections"

    @property
    def tables(self) -> list[ReportTable]:
        """Tables with a file name, in order."""
        blocks = (block for section in self.sections for block in section.blocks)
        return [block for block in blocks if isinstance(block, ReportTable) and block.stem]

    def plain(self) -> dict[str, Any]:
        """Return the content as plain values, for the Typst templates.

        Returns
        -------
        dict
            Fields by name. Every block has a ``kind``.
        """
        sections = [(item.title, [_plain(block) for block in item.blocks]) for item in self.sections]
        return {
            "title": self.title,
            "subtitle": self.subtitle,
            "footer": self.footer,
            "language": self.language,
            "look_at_title": self.look_at_title,
            "look_at": [list(pair) for pair in self.look_at],
            "verdict": [_plain(item) for item in self.verdict],
            "sections": [{"title": title, "blocks": blocks} for title, blocks in sections],
            "provenance": [f"{name}: {value}." for name, value in self.provenance.items()],
        }


def _plain(block: Block) -> dict[str, Any]:
    if isinstance(block, Pair):
        return {"kind": "pair", "left": _plain(block.left), "right": _plain(block.right), "share": block.share}
    if isinstance(block, Picture):
        return {"kind": "picture", "file": f"{block.stem}.svg", **asdict(block)}
    if isinstance(block, ReportTable):
        # columns of numbers are aligned to the right
        texts = [[row[k].text for row in block.rows] for k in range(len(block.header))]
        numbers = [bool(column) and all(not text or text[0] in _NUMBER for text in column) for column in texts]
        return {"kind": "table", "numbers": numbers, **asdict(block)}
    return {"kind": type(block).__name__.lower(), **asdict(block)}


def table(
    caption: str, header: Sequence[str], rows: Iterable[Iterable[object]], note: str = "", stem: str = ""
) -> ReportTable:
    """Return a table from cells and values. Values are converted to text.

    >>> table("", ["r [-]"], [[0.5]]).rows
    [[Cell(text='0.5', mark='plain', picture='')]]
    """
    cells = [[value if isinstance(value, Cell) else Cell(str(value)) for value in row] for row in rows]
    return ReportTable(caption, header, cells, note, stem)


def answer_table(
    caption: str, rows: AnswerRows | Iterable[Mapping[str, Any]], names: Sequence[str] = (), note: str = "",
    stem: str = "", *, display: Display | None = None, marks: Mapping[str, Sequence[str]] | None = None,
) -> ReportTable:  # fmt: skip
    """Return a table of an answer. `names` selects columns; `marks` contains marks of cells by column name."""
    columns = (display or Display()).table(rows, names)
    marked = (
        map(Cell, column.cells, (marks or {}).get(column.name) or ["plain"] * len(column.cells)) for column in columns
    )
    return table(caption, [column.heading for column in columns], zip(*marked, strict=True), note, stem)


def judged(title: str, under: Iterable[str], sections: Sequence[ReportSection], verdict: str, mark: str) -> Document:
    """Return a report with its verdict at the top. `under` contains texts below the title; empty texts are omitted."""
    subtitle = ". ".join(filter(None, under))
    return Document(title, subtitle, sections, verdict=[Paragraph(verdict, "", mark)], footer=SOFTWARE)


def software_and_data() -> dict[str, str]:
    """Return the software versions and the fingerprints of the data of a result."""
    import scipy

    from rocking import evidence
    from rocking.evidence.measurements import provenance

    source, data = provenance(), files(evidence).joinpath("data")
    prints = [
        f"{name} {hashlib.sha256(data.joinpath(name).read_bytes()).hexdigest()[:12]}"
        for name in (f"mao2024_table{i}.csv" for i in (1, 2, 3))
    ]
    return {
        "Software": f"{SOFTWARE}, Python {platform.python_version()}, numpy {np.__version__}, "
        f"scipy {scipy.__version__}",
        "Measurements": f"{source['source']}, doi:{source['doi']}, {source['licence']}",
        "SHA-256": ", ".join(prints),
    }


def render_html(document: Document, pictures: Path) -> str:
    """Return a report as HTML that contains its pictures."""
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
    # ids must be unique within a page
    body = text[text.index("<svg") :]
    for attribute in ('id="', 'href="#', "url(#"):
        body = body.replace(attribute, f"{attribute}{stem}-")
    return Markup(body)


def _address(jpeg: Path) -> str:
    """Return a thumbnail as a data URL."""
    return f"data:image/jpeg;base64,{b64encode(jpeg.read_bytes()).decode()}"


def write_html(document: Document, pictures: Path, path: Path) -> None:
    """Write a report as HTML."""
    path.write_text(render_html(document, pictures), encoding="utf-8")


def render_pdf(document: Document, pictures: Path, path: Path) -> None:
    """Write a report as PDF."""
    path.write_bytes(_pdf(document, "report.typ", pictures, _fonts()))


Content = tuple[Document, dict[str, Callable[[], Any]]]
"""A document, and the functions that draw its pictures, by stem."""


def write_report(document: Document, pictures: Mapping[str, Callable[[], Any]], path: Path) -> None:
    """Write a report of one body as .pdf or .html. `pictures` contains drawing functions by stem."""
    from rocking.plots.style import write

    if path.suffix.lower() not in {".pdf", ".html"}:
        raise InvalidValueError("the report file must end in .pdf or .html, got {file!r}", file=path.name)
    with TemporaryDirectory(prefix="rocking-report-") as folder:
        drawn = {stem: write(draw(), Path(folder) / f"{stem}.svg") for stem, draw in pictures.items()}
        if path.suffix.lower() == ".html":
            write_html(document, Path(folder), path)
        else:
            path.write_bytes(response_pdf(document, {stem: file.read_bytes() for stem, file in drawn.items()}))


def response_pdf(document: Document, pictures: Mapping[str, bytes]) -> bytes:
    """Return the report of a response as PDF. Equal content gives equal bytes."""
    with TemporaryDirectory(prefix="rocking-report-") as name:
        folder = Path(name)
        for stem, data in pictures.items():
            (folder / f"{stem}.svg").write_bytes(data)
        # text in other scripts uses the fonts of the system; the fonts of the pictures are always available
        return _pdf(document, "response.typ", folder, _fonts())


def _fonts() -> list[str]:
    """Return the folders of the fonts of the report; empty without matplotlib."""
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
