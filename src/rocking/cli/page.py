"""Rendering of answers: facts, tables and sentences on the terminal, or JSON."""

import json
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from rocking.cli.help import Output
from rocking.cli.spelling import spelled
from rocking.messages import Message

if TYPE_CHECKING:
    from rocking.answers import Answer, AnswerRows, Display
    from rocking.cli.exports import Exports
    from rocking.reports.document import ReportTable

Facts = Iterable[tuple[str, str]]
_MIN_WIDTH = 24  # smallest width of a column with line breaks [characters]
MOST_ROWS = 12  # largest number of printed rows of a table
MOST_MODELS = 8  # largest number of rows of a table of models; more models are grouped by outcome


class CommandAnswer(Protocol):
    """Result of a command."""

    def answer(self) -> "Answer":
        """Return all values in SI units, and None for missing values."""

    def show(self, page: "Page") -> None:
        """Write the result on a page."""


class Page:
    """Lines, facts and tables on the terminal."""

    def __init__(self) -> None:
        from rich.console import Console

        self._console = Console(highlight=False, soft_wrap=True)

    def line(self, text: str = "", style: str | None = None) -> None:
        self._console.print(text, style=style, markup=False)

    def rich(self, renderable: Any, **options: Any) -> None:
        """Write an object of rich."""
        self._console.print(renderable, **options)

    def facts(self, facts: Facts, width: int = 13) -> None:
        """Write one line per fact: name and text."""
        for name, value in facts:
            self.line(f"{name + ':':<{width}} {value}")

    def values(self, values: Facts) -> None:
        """Write one line per value: label and text."""
        lines = list(values)
        width = max([20, *(len(label) for label, _ in lines)]) + 2
        for label, value in lines:
            self.line(f"  {label[:1].upper() + label[1:]:<{width}}{value}")

    def warn(self, sentences: Iterable[str | Message]) -> None:
        """Write warnings."""
        for sentence in sentences:
            self.line(f"! {spelled(sentence)}", style="yellow")

    def table(
        self,
        head: Sequence[str],
        rows: Iterable[Sequence[str]],
        left: Sequence[str] = (),
        *,
        bold: Container[int] = (),
        dense: bool = False,
        unfolded: Container[int] = (),
    ) -> None:
        """Write a table with text columns `left`, bold rows `bold`, and columns `unfolded` without line breaks."""
        from rich.table import Table
        from rich.text import Text

        table = Table(box=None, pad_edge=False, collapse_padding=dense, header_style="bold")
        cells, width = [list(row) for row in rows], 0
        for k, name in enumerate(head):
            longest = max(map(len, [*name.split("\n"), *(row[k] for row in cells)]))
            width += 2 + (longest if k in unfolded else min(longest, _MIN_WIDTH))
            layout = {"no_wrap": True} if k in unfolded else {"overflow": "fold"}
            table.add_column(Text(name), justify="left" if name in left else "right", **layout)
        for k, row in enumerate(cells):
            table.add_row(*map(Text, row), style="bold" if k in bold else None)
        terminal_width = self._console.width
        self._console.width = max(width, terminal_width)  # digits are never cut
        self._console.print(table)
        self._console.width = terminal_width

    def reported(self, table: "ReportTable") -> None:
        """Write a table of a report."""
        self.table(table.header, [[cell.text for cell in row] for row in table.rows], table.header[:1])

    def rows(
        self,
        rows: "AnswerRows | Iterable[Mapping[str, Any]]",
        names: Sequence[str] = (),
        display: "Display | None" = None,
        *,
        bold: Container[int] = (),
        most: int = MOST_ROWS,
        **layout: Any,
    ) -> None:
        """Write the first rows of a table of an answer with the columns `names`, and the number of further rows."""
        from rocking.answers import Display

        columns = (display or Display()).table(rows, names)
        cells = list(zip(*(column.cells for column in columns), strict=True))
        left = [column.heading for column in columns if column.is_text]
        head = [column.heading for column in columns]
        numbers = [k for k, column in enumerate(columns) if not column.is_text]
        widths = [max([1, *map(len, column.cells)]) for column in columns]
        layout = {"dense": True, "unfolded": numbers, **layout}
        gap = 1 if layout["dense"] else 2
        if sum(max(len(name), width) + gap for name, width in zip(head, widths, strict=True)) > self._console.width:
            head = [wrap(name, widths[k]) if k in numbers else name for k, name in enumerate(head)]
        self.table(head, cells[:most], left, bold=bold, **layout)
        if len(cells) > most:
            self.line(f"... and {len(cells) - most} more rows in --json", style="dim")


def wrap(name: str, width: int) -> str:
    """Return a heading with line breaks to the width of its column; words are not cut."""
    return "\n".join(textwrap.wrap(name, max(width, 8), break_long_words=False))


def sentence(text: str) -> str:
    """Return a sentence with a capital letter and a full stop."""
    return f"{text[:1].upper()}{text[1:]}."


def print_json(*answers: "Answer") -> None:
    """Print one answer, or a list of answers, as JSON; null replaces numbers that are not finite."""
    trees = [answer.plain() for answer in answers]
    print(json.dumps(trees[0] if len(trees) == 1 else trees, indent=1, allow_nan=False))


def deliver(answer: CommandAnswer, exports: "Exports | None" = None, *, as_json: bool) -> None:
    """Write the requested files and print the result."""
    written: list[Path] = [] if exports is None else exports.write(answer)
    if as_json:
        print_json(answer.answer())
        return
    answer.show(Page())
    for path in written:
        print(f"wrote {path}")


SECONDS = 10.0
"""Time between two lines of progress if standard error is no terminal [s]."""


@contextmanager
def lines(text: Callable[[], str]) -> Iterator[None]:
    """Write a line with a text and the elapsed time on standard error every `SECONDS`."""
    began, over = time.monotonic(), threading.Event()

    def write() -> None:
        while not over.wait(SECONDS):
            print(f"rocking: {text()}, {time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)

    writer = threading.Thread(target=write, daemon=True)
    writer.start()
    try:
        yield
    finally:
        over.set()
        writer.join()


@contextmanager
def bar(title: str, total: int | None = None, *, quiet: bool = False) -> Iterator[Callable[..., None]]:
    """Show the progress on standard error; yield a function of the number of new results and the current step.

    A terminal shows a bar, a file or a pipe one line every `SECONDS`.
    """
    if quiet or Output.quiet.get():
        yield lambda done, now="": None
        return
    if not sys.stderr.isatty():
        count, step = 0, title

        def show(done: int, now: str = title) -> None:
            nonlocal count, step
            count, step = count + done, now

        of = "" if total is None else f" of {total}"
        with lines(lambda: f"{step}: {count}{of}" if count or total else step):
            yield show
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(title, total=total)
        yield lambda done, now=title: shown.update(task, advance=done, description=now)
