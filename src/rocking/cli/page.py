"""The one renderer of answers: facts, tables and sentences on the terminal, or JSON."""

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
_LEAST_WIDTH = 24  # to which columns of text are folded
MOST_ROWS = 12  # rows of a table of an answer that are printed
MOST_MODELS = 8  # rows of a table of models; more are grouped by outcome


class CommandAnswer(Protocol):
    """What every command has to show."""

    def answer(self) -> "Answer":
        """Return everything that is shown: SI units, None where something does not exist."""

    def show(self, page: "Page") -> None:
        """Write it on a page."""


class Page:
    """Lines, facts and tables on the terminal."""

    def __init__(self) -> None:
        from rich.console import Console

        self._console = Console(highlight=False, soft_wrap=True)

    def line(self, text: str = "", style: str | None = None) -> None:
        self._console.print(text, style=style, markup=False)

    def rich(self, renderable: Any, **options: Any) -> None:
        """Write what rich has made."""
        self._console.print(renderable, **options)

    def facts(self, facts: Facts, width: int = 13) -> None:
        """Write a line for each fact, its name before it."""
        for name, value in facts:
            self.line(f"{name + ':':<{width}} {value}")

    def values(self, values: Facts) -> None:
        """Write a line for each value, its label before it."""
        lines = list(values)
        width = max([20, *(len(label) for label, _ in lines)]) + 2
        for label, value in lines:
            self.line(f"  {label[:1].upper() + label[1:]:<{width}}{value}")

    def warn(self, sentences: Iterable[str | Message]) -> None:
        """Write what a reader should not miss."""
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
        whole: Container[int] = (),
    ) -> None:
        """Write a table; left: columns of text; bold: rows that stand out; whole: columns that are never folded."""
        from rich.table import Table
        from rich.text import Text

        table = Table(box=None, pad_edge=False, collapse_padding=dense, header_style="bold")
        cells, width = [list(row) for row in rows], 0
        for k, name in enumerate(head):
            longest = max(map(len, [*name.split("\n"), *(row[k] for row in cells)]))
            width += 2 + (longest if k in whole else min(longest, _LEAST_WIDTH))
            how = {"no_wrap": True} if k in whole else {"overflow": "fold"}
            table.add_column(Text(name), justify="left" if name in left else "right", **how)
        for k, row in enumerate(cells):
            table.add_row(*map(Text, row), style="bold" if k in bold else None)
        usual = self._console.width
        self._console.width = max(width, usual)  # wider than the terminal rather than without a digit
        self._console.print(table)
        self._console.width = usual

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
        """Write the first rows of a table of an answer, and how many more there are; names: its columns."""
        from rocking.answers import Display

        columns = (display or Display()).table(rows, names)
        cells = list(zip(*(column.cells for column in columns), strict=True))
        left = [column.heading for column in columns if column.is_text]
        head, numbers = [each.heading for each in columns], [k for k, each in enumerate(columns) if not each.is_text]
        widths = [max([1, *map(len, column.cells)]) for column in columns]
        layout = {"dense": True, "whole": numbers, **layout}
        gap = 1 if layout["dense"] else 2
        if sum(max(len(name), width) + gap for name, width in zip(head, widths, strict=True)) > self._console.width:
            head = [wrap(name, widths[k]) if k in numbers else name for k, name in enumerate(head)]
        self.table(head, cells[:most], left, bold=bold, **layout)
        if len(cells) > most:
            self.line(f"... and {len(cells) - most} more; --json has them all", style="dim")


def wrap(name: str, width: int) -> str:
    """Return a heading over as many lines as the width of its column needs; no word is cut."""
    return "\n".join(textwrap.wrap(name, max(width, 8), break_long_words=False))


def sentence(text: str) -> str:
    """Return a sentence that begins and ends as one."""
    return f"{text[:1].upper()}{text[1:]}."


def print_json(*answers: "Answer") -> None:
    """Print an answer as JSON, several as a list, with null where there is no finite number."""
    trees = [answer.plain() for answer in answers]
    print(json.dumps(trees[0] if len(trees) == 1 else trees, indent=1, allow_nan=False))


def deliver(answer: CommandAnswer, exports: "Exports | None" = None, *, as_json: bool) -> None:
    """Write the files that were asked for, and print an answer."""
    written: list[Path] = [] if exports is None else exports.write(answer)
    if as_json:
        print_json(answer.answer())
        return
    answer.show(Page())
    for path in written:
        print(f"wrote {path}")


SECONDS = 10.0
"""Time between two lines about the progress where standard error is no terminal."""


@contextmanager
def lines(text: Callable[[], str]) -> Iterator[None]:
    """Write a line with a text and the time since the beginning every `SECONDS`, on standard error."""
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
def bar(what: str, total: int | None = None, *, quiet: bool = False) -> Iterator[Callable[..., None]]:
    """Show the progress on standard error; what is yielded takes the number done since, and the current step.

    A terminal has a bar, a file or a pipe a line every `SECONDS`.
    """
    if quiet or Output.quiet.get():
        yield lambda done, now="": None
        return
    if not sys.stderr.isatty():
        count, step = 0, what

        def tell(done: int, now: str = what) -> None:
            nonlocal count, step
            count, step = count + done, now

        of = "" if total is None else f" of {total}"
        with lines(lambda: f"{step}: {count}{of}" if count or total else step):
            yield tell
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what, total=total)
        yield lambda done, now=what: shown.update(task, advance=done, description=now)
