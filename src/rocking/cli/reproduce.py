"""`rocking reproduce`: results of Mao et al. (2024) or of Gaibor and Lopez (2026), recomputed."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking import checks
from rocking.cli import options
from rocking.cli.measurements import show_league
from rocking.cli.page import Page, bar, print_json
from rocking.cli.spelling import UsageError
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from rocking.answers import Answer
    from rocking.evidence.claims_of_errors import Claim
    from rocking.evidence.measurements import DataSet
    from rocking.reports.document import Document
    from rocking.reports.paper_document import Reproduction

MAO, GAIBOR = "mao-2024", "gaibor-2026"


def reproduce(
    which: Annotated[
        list[str] | None,
        typer.Argument(
            help=f"{GAIBOR}; or measurements for {MAO}: published, own, table1, S, M, L, or files (.toml, .csv)."
        ),
    ] = None,
    full: Annotated[bool, typer.Option("--full", help=f"All frequencies, starts and cells of {GAIBOR}.")] = False,
    output: Annotated[Path | None, options.output("Folder for report, tables and figures.")] = None,
    details: options.Details = False,
    as_json: Annotated[bool, typer.Option("--json", help="Result as JSON.")] = False,
) -> None:
    """Run `rocking reproduce`."""
    if which == [GAIBOR]:
        _gaibor(full, output, as_json)
        return
    if full:
        raise UsageError("--full is for {name} only", name=GAIBOR)
    if GAIBOR in (which or ()):
        raise UsageError("{name} cannot be combined with other names", name=GAIBOR)
    from rocking.reports.paper_document import reproduce as recomputed

    data = _measurements([name for name in which or () if name != MAO])
    with bar("recomputing tables and claims", quiet=as_json):
        result = recomputed() if data is None else recomputed(data)
    if as_json:
        print_json(result.answer())
    if output is not None:
        from rocking.plots.paper_figures import paper_figures
        from rocking.reports.paper_document import paper_document

        _write(paper_document(result), paper_figures(result.data), result.answer(), output, as_json)
    if not as_json:
        _show(result, details=details)


def _measurements(names: "Sequence[str]") -> "DataSet | None":
    """Return the measurements of sets and files; None without names."""
    from rocking.evidence.store import selected

    try:
        return selected(names) if names else None
    except InvalidValueError as error:
        unknown = str(error.facts.get("name", ""))
        if unknown in names and not Path(unknown).suffix:
            error.hint = checks.nearest(unknown, (MAO, GAIBOR)) or error.hint
            error.add_hint(f"papers: {MAO}, {GAIBOR}; -o FOLDER writes all tables and figures of a paper")
        raise


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

        _write(gaibor_document(result), gaibor_figures(result), result.answer(), output, as_json)
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


def _write(document: "Document", figures: dict[str, Any], answer: "Answer", folder: Path, as_json: bool) -> None:
    """Write the folder; print the names of its files."""
    from rocking.reports.paper_folder import write_folder

    with bar("", len(figures) + 3, quiet=as_json) as progress:
        written, left_out = write_folder(document, figures, answer, folder, lambda name: progress(1, name))
    for sentence in left_out:
        print(f"rocking: note: {sentence}", file=sys.stderr)
    for path in () if as_json else (*written, folder / "figures", folder / "tables"):
        print(f"wrote {path}")


def _show(result: "Reproduction", *, details: bool) -> None:
    """Print the numbers of tables and claims, the models with the smallest errors, and the verdict.

    details: print every claim, all models, and the whole verdict.
    """
    from rich.padding import Padding
    from rich.text import Text

    from rocking.evidence._errata import agreement
    from rocking.evidence.claims_of_errors import tally

    page = Page()
    page.line(f"Mao et al. (2024): {tally(result.claims)}", "bold")
    for title, rows in result.tables.items():
        page.line(f"  {title}: {agreement(rows)}")
    page.line(f"  Errata found: {sum(erratum.is_confirmed for erratum in result.errata)} of {len(result.errata)}")
    if details:
        page.line("\nClaims", "bold")
        page.rich(_claims(result.claims))
    shown = {result.league[0].name, "ked", "housner"}
    show_league(page, [row for row in result.league if details or row.name in shown], len(result.data))
    verdict = result.verdict if details else result.verdict[:1]
    page.line("\nVerdict", "bold")
    page.rich(Padding(Text("\n".join(verdict)), (0, 0, 0, 2)), soft_wrap=False)
    if not details:
        page.line("Claims, all models and the whole verdict: --details    Report, tables and figures: -o FOLDER")


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
