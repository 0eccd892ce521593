"""A report as one self-contained HTML file, or as a PDF set by Typst: nothing is fetched from elsewhere."""

import json
from base64 import b64encode
from collections.abc import Callable, Mapping
from functools import partial
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rocking.errors import InvalidValueError, extra
from rocking.reports.document import Document, Listing, Pair, Paragraph, ReportTable


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
    path.write_bytes(_pdf(document, "report.typ", pictures, []))


def write_report(document: Document, pictures: Mapping[str, Callable[[], Any]], path: Path) -> None:
    """Write a report of one body as .pdf or .html; pictures: what draws each, by stem."""
    from rocking.plots.style import write

    if path.suffix.lower() not in {".pdf", ".html"}:
        raise InvalidValueError(f"a report is .pdf or .html, got {path.name!r}")
    with TemporaryDirectory(prefix="rocking-report-") as folder:
        drawn = {stem: write(draw(), Path(folder) / f"{stem}.svg") for stem, draw in pictures.items()}
        if path.suffix.lower() == ".html":
            write_html(document, Path(folder), path)
        else:
            path.write_bytes(response_pdf(document, {stem: file.read_bytes() for stem, file in drawn.items()}))


def response_pdf(document: Document, pictures: Mapping[str, bytes]) -> bytes:
    """Return the report of a response as PDF, the same for the same content."""
    from matplotlib import get_data_path

    with TemporaryDirectory(prefix="rocking-report-") as name:
        folder = Path(name)
        for stem, data in pictures.items():
            (folder / f"{stem}.svg").write_bytes(data)
        # its words in any script come from the fonts of the system; those of the pictures are always there
        return _pdf(document, "response.typ", folder, [str(Path(get_data_path()) / "fonts" / "ttf")])


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
    return files("rocking.reports").joinpath(name).read_bytes()
