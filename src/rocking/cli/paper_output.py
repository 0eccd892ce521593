"""What `rocking paper` prints."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from rocking.evidence.claim import FAILS, HOLDS, IN_PART, UNRESOLVED
from rocking.reports.paper_document import Reproduction, look_at
from rocking.reports.paper_folder import as_plain, steps

_STYLE = {HOLDS: "green", IN_PART: "yellow", FAILS: "red", UNRESOLVED: "cyan"}


def as_json(result: Reproduction) -> str:
    """Return every number as JSON."""
    return json.dumps(as_plain(result), indent=2)


def what_to_look_at(result: Reproduction, written: list[Path], folder: Path) -> None:
    """Print what was written and what to look at first."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    console.print("What to look at", style="bold")
    for path in written:
        console.print(f"  {path}", markup=False)
    console.print(f"  {folder / 'figures'}  {folder / 'tables'}", markup=False)
    for name, sentence in look_at(result):
        console.print(f"  {name}: {sentence}", markup=False)
    console.print()


def show(result: Reproduction) -> None:
    """Print the summary: tables, claims, league, verdict."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    console.print("Tables of Mao et al. (2024), recomputed", style="bold")
    for title, rows in result.tables.items():
        entries = [entry for row in rows for entry in row.entries.values()]
        console.print(
            f"  {title}: {sum(e.agrees for e in entries)} of {len(entries)} printed values agree in all digits"
        )
    console.print(f"  errata found: {sum(e.found for e in result.errata)} of {len(result.errata)}")
    console.print("\nClaims", style="bold")
    console.print(_claims(result))
    console.print(
        "\nLeague: RMSE of r over 39 measurements, in bands of h/b; log error of the energy loss", style="bold"
    )
    console.print(_league(result))
    console.print("\nVerdict", style="bold")
    console.print(_indented(result.verdict), soft_wrap=False)


@contextmanager
def progress(*, quiet: bool) -> Iterator[Callable[[str], None]]:
    """Show a progress bar, and give the function that moves it.

    Returns takes the name of the step that begins.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description:24}"), BarColumn(), TextColumn("{task.completed}/{task.total}"))
    bar = Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True, disable=quiet)
    with bar:
        task = bar.add_task("", total=steps())

        def step(name: str) -> None:
            bar.update(task, description=name, advance=1)

        yield step


def _claims(result: Reproduction) -> object:
    from rich.table import Table

    table = Table(box=None, show_header=False, pad_edge=False)
    for width in (16, 8, None):
        table.add_column(width=width, no_wrap=width is not None)
    for claim in result.claims:
        style = _STYLE.get(claim.verdict, "dim")
        table.add_row(f"  [{style}]{claim.verdict}[/]", claim.section, claim.quote)
    return table


def _indented(sentences: Sequence[str]) -> object:
    from rich.padding import Padding
    from rich.text import Text

    return Padding(Text("\n".join(sentences)), (0, 0, 0, 2))


def _league(result: Reproduction) -> object:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("  model", overflow="fold")
    for name in ("RMSE", "bias", "<=3", "3-6", ">6", "loss", "BIC"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in result.league:
        bands = [f"{value:.3f}" for value in row.by_band.values()]
        style = "bold" if row.name in ("ked", "housner") else None
        table.add_row(
            f"  {row.name}",
            f"{row.rmse:.4f}",
            f"{row.bias:+.3f}",
            *bands,
            f"{row.log_loss_rmse:.3f}",
            f"{row.bic:.1f}",
            style=style,
        )
    return table
