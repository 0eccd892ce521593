"""The report as a PDF, set by Typst from the same content."""

import json
from importlib.resources import files
from pathlib import Path

from rocking.errors import MissingExtraError, how_to_install
from rocking.reports.document import Document, Paragraph, Picture, ReportSection, ReportTable


def render_pdf(content: Document, pictures: Path, path: Path) -> None:
    """Write the report as PDF."""
    try:
        import typst
    except ImportError as error:
        raise MissingExtraError(how_to_install("the PDF report", "typst", error)) from error
    source = pictures / "report.typ"
    template = files("rocking.reports").joinpath("report.typ").read_text(encoding="utf-8")
    source.write_text(template, encoding="utf-8")
    try:
        pdf = typst.compile(str(source), root=str(pictures), sys_inputs={"document": json.dumps(_plain(content))})
    finally:
        source.unlink()
    path.write_bytes(pdf)


def _plain(content: Document) -> dict[str, object]:
    return {
        "title": content.title,
        "subtitle": content.subtitle,
        "look_at": [list(pair) for pair in content.look_at],
        "sections": [_section(section) for section in content.sections],
        "provenance": [f"{name}: {value}." for name, value in content.provenance.items()],
    }


def _section(section: ReportSection) -> dict[str, object]:
    return {"title": section.title, "blocks": [_block(block) for block in section.blocks]}


def _block(block: Paragraph | ReportTable | Picture) -> dict[str, object]:
    if isinstance(block, Paragraph):
        return {"kind": "paragraph", "lead": block.lead, "text": block.text, "mark": block.mark}
    if isinstance(block, Picture):
        return {"kind": "picture", "file": f"{block.stem}.svg", "caption": block.caption, "wide": block.wide}
    rows = [[{"text": each.text, "mark": each.mark} for each in row] for row in block.rows]
    return {"kind": "table", "caption": block.caption, "header": list(block.header), "rows": rows, "note": block.note}
