"""`rocking paper`: Mao et al. 2024, recomputed from the published measurements, with a verdict on each claim."""

import sys
from pathlib import Path
from typing import Annotated

import typer


def paper(
    out: Annotated[
        Path | None, typer.Option(help="Folder for the report, tables and figures; none is written if left out.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print every number as JSON.")] = False,
) -> None:
    """Recompute the paper: every table, figure, erratum and claim, and the league of all models."""
    from rocking.cli import paper_output
    from rocking.reports.paper_document import reproduce

    result = reproduce()
    if as_json:
        print(paper_output.as_json(result))
    if out is None:
        if not as_json:
            paper_output.show(result)
        return
    from rocking.reports.paper_folder import write_folder

    with paper_output.progress(quiet=as_json) as step:
        written, left_out = write_folder(result, out, step)
    for sentence in left_out:
        print(f"rocking: note: {sentence}", file=sys.stderr)
    if not as_json:
        paper_output.what_to_look_at(result, written, out)
        paper_output.show(result)
