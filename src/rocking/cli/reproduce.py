"""`rocking reproduce`: Mao et al. 2024, recomputed from the published measurements, with a verdict on each claim."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.cli import options
from rocking.cli.measurements import Selection, show_league
from rocking.cli.page import Page, bar, print_json

if TYPE_CHECKING:
    from rocking.reports.paper_document import Reproduction


def reproduce(
    which: Selection = None,
    output: Annotated[Path | None, options.output("Folder for report, tables and figures.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Result as JSON.")] = False,
) -> None:
    """Run `rocking reproduce`."""
    from rocking.evidence.store import selected
    from rocking.reports.paper_document import reproduce as recomputed

    with bar("recomputing tables and claims", quiet=as_json):
        result = recomputed(selected(which)) if which else recomputed()
    if as_json:
        print_json(result.answer())
    if output is None:
        if not as_json:
            _show(result)
        return
    from rocking.reports.paper_folder import steps, write_folder

    with bar("", steps(), quiet=as_json) as progress:
        written, left_out = write_folder(result, output, lambda name: progress(1, name))
    for sentence in left_out:
        print(f"rocking: note: {sentence}", file=sys.stderr)
    if not as_json:
        _what_to_look_at(result, written, output)
        _show(result)


def _what_to_look_at(result: "Reproduction", written: list[Path], folder: Path) -> None:
    """Print what was written and what to look at first."""
    from rocking.reports.paper_document import look_at

    page = Page()
    page.line("What to look at", "bold")
    for path in written:
        page.line(f"  {path}")
    page.line(f"  {folder / 'figures'}  {folder / 'tables'}")
    for name, sentence in look_at(result):
        page.line(f"  {name}: {sentence}")
    page.line()


def _show(result: "Reproduction") -> None:
    """Print the summary: tables, claims, league, verdict."""
    from rich.padding import Padding
    from rich.text import Text

    from rocking.evidence._errata import agreement
    from rocking.evidence.claims_of_errors import tally

    page = Page()
    page.line("Tables of Mao et al. (2024), recomputed", "bold")
    for title, rows in result.tables.items():
        page.line(f"  {title}: {agreement(rows)}")
    page.line(f"  errata found: {sum(e.found for e in result.errata)} of {len(result.errata)}")
    page.line("\nClaims", "bold")
    page.rich(_claims(result))
    page.line(f"  {tally(result.claims)}")
    show_league(page, result.league, len(result.data))
    page.line("\nVerdict", "bold")
    page.rich(Padding(Text("\n".join(result.verdict)), (0, 0, 0, 2)), soft_wrap=False)


def _claims(result: "Reproduction") -> Any:
    from rich.table import Table

    from rocking.evidence.claims_of_errors import FAILS, HOLDS, IN_PART, UNRESOLVED

    styles = {HOLDS: "green", IN_PART: "yellow", FAILS: "red", UNRESOLVED: "cyan"}
    table = Table(box=None, show_header=False, pad_edge=False)
    for width in (16, 8, None):
        table.add_column(width=width, no_wrap=width is not None)
    for claim in result.claims:
        style = styles.get(claim.verdict, "dim")
        table.add_row(f"  [{style}]{claim.verdict}[/]", claim.section, claim.quote)
    return table
