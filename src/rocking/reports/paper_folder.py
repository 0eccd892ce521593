"""The folder that `rocking paper --out` writes: report, tables, figures, numbers."""

import csv
import json
from collections.abc import Callable
from pathlib import Path

from rocking.errors import MissingExtraError
from rocking.reports.document import ReportTable, render_pdf, write_html
from rocking.reports.paper_document import Reproduction, paper_document
from rocking.tables.table import writing

Step = Callable[[str], None]


def write_folder(result: Reproduction, folder: Path, step: Step) -> tuple[list[Path], list[str]]:
    """Write report, tables, figures and numbers."""
    # returns the files to look at, and what was not written since an optional package is missing, with how to install
    # it
    pictures, tables = folder / "figures", folder / "tables"
    with writing(f"to {folder}"):
        for each in (pictures, tables):
            each.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    left_out: list[str] = []
    try:
        _draw(pictures, step, result)
    except MissingExtraError as error:
        left_out.append(f"no figures, and no report.html and report.pdf, which show them: {error}")
    document = paper_document(result)
    step("tables")
    for table in document.tables:
        _write_table(table, tables / f"{table.stem}.csv")
    reports = {"report.html": write_html, "report.pdf": render_pdf}
    for name, write in reports.items() if not left_out else []:
        step(name)
        try:
            write(document, pictures, folder / name)
            written.append(folder / name)
        except MissingExtraError as error:
            left_out.append(f"no {name}: {error}")
    numbers = folder / "results.json"
    numbers.write_text(json.dumps(result.answer().plain(), indent=2), encoding="utf-8")
    return [*written, numbers], left_out


def steps() -> int:
    """Return how many steps `write_folder` reports."""
    from rocking.plots.paper_figures import paper_figures

    return len(paper_figures()) + 3


def _draw(folder: Path, step: Step, result: Reproduction) -> None:
    from rocking.plots.paper_figures import paper_figures
    from rocking.plots.style import write

    for stem, draw in paper_figures(result.data).items():
        step(stem.replace("_", " "))
        figure = draw()
        write(figure, folder / f"{stem}.png")
        figure.set_layout_engine(None)  # it is laid out, for the other format too
        write(figure, folder / f"{stem}.svg")


def _write_table(table: ReportTable, path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.writer(file)
        writer.writerow(table.header)
        writer.writerows([each.text for each in row] for row in table.rows)
