"""The report as one self-contained HTML file: pictures inside, nothing fetched from elsewhere."""

from importlib.resources import files
from pathlib import Path

from rocking.errors import MissingExtraError, how_to_install
from rocking.reports import document
from rocking.reports.document import Document


def render_html(content: Document, pictures: Path) -> str:
    """Return the report as HTML."""
    try:
        import jinja2
    except ImportError as error:
        raise MissingExtraError(how_to_install("the HTML report", "jinja2", error)) from error
    template = files("rocking.reports").joinpath("report.html.jinja").read_text(encoding="utf-8")
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.tests["paragraph"] = lambda block: isinstance(block, document.Paragraph)
    environment.tests["table"] = lambda block: isinstance(block, document.ReportTable)
    return environment.from_string(template).render(document=content, svg=lambda stem: _inline(pictures, stem))


def _inline(folder: Path, stem: str) -> object:
    from markupsafe import Markup

    text = (folder / f"{stem}.svg").read_text(encoding="utf-8")
    # ids of different pictures must not meet in one page
    body = text[text.index("<svg") :]
    for attribute in ('id="', 'href="#', "url(#"):
        body = body.replace(attribute, f"{attribute}{stem}-")
    return Markup(body)
