"""The folder that `rocking paper --out` writes: report, tables, figures, numbers."""

import csv
import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rocking.errors import MissingExtraError
from rocking.evidence._errata import TableRow
from rocking.reports.document import Document, ReportTable, made_with, render_pdf, write_html
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
    numbers.write_text(json.dumps(as_plain(result, document), indent=2), encoding="utf-8")
    return [*written, numbers], left_out


def steps() -> int:
    """Return how many steps `write_folder` reports."""
    from rocking.plots.paper_figures import paper_figures

    return len(paper_figures()) + 3


def as_plain(result: Reproduction, document: Document | None = None) -> dict[str, Any]:
    """Return every number as plain values, for JSON."""
    return {
        "verdict": list(result.verdict),
        "claims": [
            {"section": c.section, "claim": c.quote, "verdict": c.verdict, "evidence": c.evidence, "test": c.test}
            for c in result.claims
        ],
        "errata": [asdict(erratum) for erratum in result.errata],
        "tables": {title: [_row(row) for row in rows] for title, rows in result.tables.items()},
        "league": [dict(row.answer().values) for row in result.league],
        "calibration": {
            "model": result.calibration.model().label,
            **result.calibration.summary,
            "covered_one_by_one": [result.coverage.one_by_one, result.coverage.rows],
            "covered_by_data_set": {name: list(counts) for name, counts in result.coverage.by_group.items()},
        },
        "hierarchical_calibration": {
            "model": result.hierarchy.model().label,
            **result.hierarchy.summary,
            "shares": result.hierarchy.shares,
            "left_out_groups": [{**asdict(each), "within": each.within} for each in result.left_out],
        },
        "provenance": document.provenance if document else made_with(),
    }


def _row(row: TableRow) -> dict[str, Any]:
    values = {
        f"{key}_{which}": getattr(entry, which)
        for key, entry in row.entries.items()
        for which in ("printed", "recomputed", "agrees")
    }
    return {"label": row.label, "slenderness_ratio": row.slenderness, "r_experiment": row.measured, **values}


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
