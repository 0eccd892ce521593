"""The output folder of `rocking reproduce`: report, tables, figures, numbers."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rocking.answers import Answer
from rocking.errors import MissingExtraError
from rocking.reports.document import Document, ReportTable, render_pdf, write_html
from rocking.tables.table import writing

Step = Callable[[str], None]
Figures = dict[str, Callable[[], Any]]


def write_folder(
    document: Document, figures: Figures, answer: Answer, folder: Path, step: Step
) -> tuple[list[Path], list[str]]:
    """Write report, tables, figures and numbers. The number of steps is the number of figures plus three."""
    # returns the main files, and messages about files that need a missing package, with the installation command
    pictures, tables = folder / "figures", folder / "tables"
    with writing(f"to {folder}"):
        for directory in (pictures, tables):
            directory.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    omissions: list[str] = []
    try:
        _draw(figures, pictures, step)
    except MissingExtraError as error:
        omissions.append(f"no figures, no report.html and no report.pdf: {error}")
    step("tables")
    for table in document.tables:
        _write_table(table, tables / f"{table.stem}.csv")
    reports = {"report.html": write_html, "report.pdf": render_pdf}
    for name, write in reports.items() if not omissions else []:
        step(name)
        try:
            write(document, pictures, folder / name)
            written.append(folder / name)
        except MissingExtraError as error:
            omissions.append(f"no {name}: {error}")
    numbers = folder / "results.json"
    numbers.write_text(json.dumps(answer.plain(), indent=2), encoding="utf-8")
    return [*written, numbers], omissions


def _draw(figures: Figures, folder: Path, step: Step) -> None:
    from rocking.plots.style import write

    for stem, draw in figures.items():
        step(stem.replace("_", " "))
        figure = draw()
        write(figure, folder / f"{stem}.png")
        figure.set_layout_engine(None)  # the layout is final and is also used for the other format
        write(figure, folder / f"{stem}.svg")


def _write_table(table: ReportTable, path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.writer(file)
        writer.writerow(table.header)
        writer.writerows([cell.text for cell in row] for row in table.rows)
