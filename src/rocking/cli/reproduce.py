"""`rocking reproduce`: results of Mao et al. (2024) or of Gaibor and Lopez (2026), recomputed."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.cli import options
from rocking.cli.measurements import show_league
from rocking.cli.page import Page, bar, print_json

if TYPE_CHECKING:
    from rocking.answers import Answer
    from rocking.evidence.claims_of_errors import Claim
    from rocking.reports.document import Document
    from rocking.reports.paper_document import Reproduction

GAIBOR = "gaibor-2026"


def reproduce(
    which: Annotated[
        list[str] | None,
        typer.Argument(
            help=f"{GAIBOR}; or measurements for mao-2024: published, own, table1, S, M, L, or files (.toml, .csv)."
        ),
    ] = None,
    full: Annotated[bool, typer.Option("--full", help=f"All frequencies, starts and cells of {GAIBOR}.")] = False,
    output: Annotated[Path | None, options.output("Folder for report, tables and figures.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Result as JSON.")] = False,
) -> None:
    """Run `rocking reproduce`."""
    if which == [GAIBOR]:
        _gaibor(full, output, as_json)
        return
    if full:
        from rocking.errors import InvalidValueError

        raise InvalidValueError(parameter="full", allowed=f"with {GAIBOR} only", value=full)
    from rocking.evidence.store import selected
    from rocking.reports.paper_document import reproduce as recomputed

    with bar("recomputing tables and claims", quiet=as_json):
        result = recomputed(selected(which)) if which else recomputed()
    if as_json:
        print_json(result.answer())
    if output is not None:
        from rocking.plots.paper_figures import paper_figures
        from rocking.reports.paper_document import look_at, paper_document

        _write(paper_document(result), paper_figures(result.data), result.answer(), output, look_at(result), as_json)
    if not as_json:
        _show(result)


def _gaibor(full: bool, output: Path | None, as_json: bool) -> None:
    from rocking.evidence import gaibor_2026

    effort = gaibor_2026.FULL if full else gaibor_2026.FAST
    with bar("cases", gaibor_2026.steps(effort), quiet=as_json) as progress:
        result = gaibor_2026.reproduce(effort, lambda name: progress(1, name))
    if as_json:
        print_json(result.answer())
    from rocking.reports.gaibor_2026 import gaibor_document, parameters

    if output is not None:
        from rocking.plots.gaibor_2026 import gaibor_figures

        _write(gaibor_document(result), gaibor_figures(result), result.answer(), output, (), as_json)
    if not as_json:
        page = Page()
        page.line("Gaibor and Lopez (2026), arXiv:2606.14288, recomputed", "bold")
        page.line(parameters(result))
        quote = ""
        for claim in result.claims():
            if claim.quote != quote:
                quote = claim.quote
                page.line(f"\nStatement {claim.section}: {quote}", "bold")
            page.line(f"  {claim.verdict}: {claim.test}", _styles().get(claim.verdict))
            page.line(f"    {claim.evidence}")


def _write(
    document: "Document", figures: dict[str, Any], answer: "Answer", folder: Path,
    look_at: Sequence[tuple[str, str]], as_json: bool,
) -> None:  # fmt: skip
    """Write the folder; print what was written and the main points."""
    from rocking.reports.paper_folder import write_folder

    with bar("", len(figures) + 3, quiet=as_json) as progress:
        written, left_out = write_folder(document, figures, answer, folder, lambda name: progress(1, name))
    for sentence in left_out:
        print(f"rocking: note: {sentence}", file=sys.stderr)
    if as_json:
        return
    page = Page()
    page.line("What to look at", "bold")
    for path in written:
        page.line(f"  {path}")
    page.line(f"  {folder / 'figures'}  {folder / 'tables'}")
    for name, sentence in look_at:
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
    page.rich(_claims(result.claims))
    page.line(f"  {tally(result.claims)}")
    show_league(page, result.league, len(result.data))
    page.line("\nVerdict", "bold")
    page.rich(Padding(Text("\n".join(result.verdict)), (0, 0, 0, 2)), soft_wrap=False)


def _styles() -> dict[str, str]:
    from rocking.evidence.claims_of_errors import FAILS, HOLDS, IN_PART, UNRESOLVED

    return {HOLDS: "green", IN_PART: "yellow", FAILS: "red", UNRESOLVED: "cyan"}


def _claims(claims: "Sequence[Claim]") -> Any:
    from rich.table import Table

    table = Table(box=None, show_header=False, pad_edge=False)
    for width in (16, 8, None):
        table.add_column(width=width, no_wrap=width is not None)
    for claim in claims:
        style = _styles().get(claim.verdict, "dim")
        table.add_row(f"  [{style}]{claim.verdict}[/]", claim.section, claim.quote)
    return table
