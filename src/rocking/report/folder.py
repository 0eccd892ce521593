"""The folder that `rocking paper --out` writes: report, tables, figures, numbers."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rocking.errors import RockingError
from rocking.report.document import Document, Table
from rocking.report.html import render_html
from rocking.report.paper_document import paper_document
from rocking.report.pdf import render_pdf
from rocking.report.provenance import made_with
from rocking.report.reproduction import Reproduction

Step = Callable[[str], None]


def write_folder(result: Reproduction, folder: Path, step: Step) -> list[Path]:
    """Write report, tables, figures and numbers.

    Parameters
    ----------
    result : Reproduction
        The paper, recomputed.
    folder : Path
        Folder to write, made if it does not exist.
    step : callable
        Told what is being done, for a progress bar.

    Returns
    -------
    list of Path
        The files to look at: report.html, report.pdf, results.json.

    Raises
    ------
    RockingError
        If the folder cannot be written.
    """
    pictures, tables = folder / "figures", folder / "tables"
    try:
        for each in (pictures, tables):
            each.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RockingError(f"cannot write to {folder}: {error.strerror}") from error
    _draw(result, pictures, step)
    document = paper_document(result)
    step("tables")
    for table in document.tables:
        _write_table(table, tables / f"{table.stem}.csv")
    html, pdf, numbers = (folder / name for name in ("report.html", "report.pdf", "results.json"))
    step("HTML report")
    html.write_text(render_html(document, pictures), encoding="utf-8")
    step("PDF report")
    render_pdf(document, pictures, pdf)
    numbers.write_text(json.dumps(as_plain(result, document), indent=2), encoding="utf-8")
    return [html, pdf, numbers]


def steps() -> int:
    """Return how many steps `write_folder` reports.

    Returns
    -------
    int
        Figures, tables, HTML, PDF.
    """
    from rocking.plots.paper import paper_figures

    return len(paper_figures()) + 3


def as_plain(result: Reproduction, document: Document | None = None) -> dict[str, Any]:
    """Return every number as plain values, for JSON.

    Parameters
    ----------
    result : Reproduction
        The paper, recomputed.
    document : Document, optional
        The report, if it is at hand.

    Returns
    -------
    dict
        Numbers and strings; SI units.
    """
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


def _draw(result: Reproduction, folder: Path, step: Step) -> None:
    from rocking.plots.paper import paper_figures
    from rocking.plots.style import save

    for stem, draw in paper_figures().items():
        step(stem.replace("_", " "))
        save(draw(result.league, result.calibration), folder, stem)


def _write_table(table: Table, path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.writer(file)
        writer.writerow(table.header)
        writer.writerows([each.text for each in row] for row in table.rows)
