"""The folder that `rocking paper --out` writes: report, tables, figures, numbers."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rocking.errors import MissingExtraError, RockingError
from rocking.reports.document import Document, ReportTable
from rocking.reports.html import render_html
from rocking.reports.paper_document import paper_document
from rocking.reports.pdf import render_pdf
from rocking.reports.provenance import made_with
from rocking.reports.reproduction import Reproduction

Step = Callable[[str], None]


def write_folder(result: Reproduction, folder: Path, step: Step) -> tuple[list[Path], list[str]]:
    """Write report, tables, figures and numbers.

    Returns written: the files to look at: report.html, report.pdf, results.json; left_out: what was not written,
    because an optional package is missing, and how to install it.
    """
    pictures, tables = folder / "figures", folder / "tables"
    try:
        for each in (pictures, tables):
            each.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RockingError(f"cannot write to {folder}: {error.strerror}") from error
    written: list[Path] = []
    left_out: list[str] = []
    try:
        _draw(result, pictures, step)
    except MissingExtraError as error:
        left_out.append(f"no figures, and no report.html and report.pdf, which show them: {error}")
    document = paper_document(result)
    step("tables")
    for table in document.tables:
        _write_table(table, tables / f"{table.stem}.csv")
    reports = {"report.html": _write_html, "report.pdf": render_pdf}
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
        "errata": [
            {"name": e.name, "statement": e.statement, "evidence": e.evidence, "found": e.found} for e in result.errata
        ],
        "tables": {
            title: [
                {
                    "label": row.label,
                    "slenderness_ratio": row.slenderness,
                    "r_experiment": row.measured,
                    **{
                        f"{key}_{which}": value
                        for key, entry in row.entries.items()
                        for which, value in (
                            ("printed", entry.printed),
                            ("recomputed", entry.recomputed),
                            ("agrees", entry.agrees),
                        )
                    },
                }
                for row in rows
            ]
            for title, rows in result.tables.items()
        },
        "league": [row.as_dict() for row in result.league],
        "calibration": {
            "model": result.calibration.model().label,
            **result.calibration.summary,
            "covered_one_by_one": [result.coverage.one_by_one, result.coverage.rows],
            "covered_by_data_set": {name: list(counts) for name, counts in result.coverage.by_group.items()},
        },
        "provenance": document.provenance if document else made_with(),
    }


def _write_html(document: Document, pictures: Path, path: Path) -> None:
    path.write_text(render_html(document, pictures), encoding="utf-8")


def _draw(result: Reproduction, folder: Path, step: Step) -> None:
    from rocking.plots.paper_figures import paper_figures
    from rocking.plots.style import save

    for stem, draw in paper_figures().items():
        step(stem.replace("_", " "))
        save(draw(), folder, stem)


def _write_table(table: ReportTable, path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.writer(file)
        writer.writerow(table.header)
        writer.writerows([each.text for each in row] for row in table.rows)
