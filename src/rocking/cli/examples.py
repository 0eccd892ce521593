"""`rocking examples`: list the examples; run an example in the current folder."""

import shlex
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from rocking import checks
from rocking.answers import Answer
from rocking.cli import completion
from rocking.cli.page import Page, deliver
from rocking.errors import InvalidValueError
from rocking.examples import Example, catalogue, write


def examples(
    context: typer.Context,
    name: Annotated[
        str | None,
        typer.Argument(help="Name of an example. [default: list of all examples]", autocompletion=completion.examples),
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Dry run: list files and commands.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite existing files.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="List as JSON; run nothing.")] = False,
) -> None:
    """Run `rocking examples`."""
    entries = catalogue()
    if name is None or dry_run or as_json:
        chosen = entries if name is None else {name: entries[checks.one_of("example", name, entries)]}
        deliver(_Listed(chosen, is_complete=name is None), as_json=as_json)
        return
    _run(entries[checks.one_of("example", name, entries)], context.obj, force=force)


@dataclass(frozen=True)
class _Listed:
    """List of examples. `is_complete` is True for all examples, which are printed as a table."""

    chosen: Mapping[str, Example]
    is_complete: bool

    def answer(self) -> Answer:
        """Return the files and commands of each example."""
        names = ("name", "kind", "title", "writes", "commands", "outputs")
        return Answer(
            {"examples": [{name: getattr(example, name) for name in names} for example in self.chosen.values()]}
        )

    def show(self, page: Page) -> None:
        if self.is_complete:
            rows = [(example.name, example.kind, example.title) for example in self.chosen.values()]
            page.table(("name", "kind", "title"), rows, ("name", "kind", "title"), unfolded=range(3))
            page.line("\nRun an example in this folder: rocking examples NAME. In Python: rk.examples.")
            return
        for example in self.chosen.values():
            page.line(f"{example.name}: {example.title}")
            page.line(f"files: {', '.join(example.writes)}; files of its commands: {', '.join(example.outputs)}")
            for command in example.commands:
                page.line(f"$ {command}", "bold")


def _run(chosen: Example, run: Callable[[list[str]], None], *, force: bool) -> None:
    """Write the files and run the commands in order; stop at the first failure."""
    page = Page()
    existing = [name for name in chosen.outputs if Path(name).exists()]
    if folder := next((name for name in existing if Path(name).is_dir()), None):
        raise InvalidValueError("a folder of this name already exists", hint="use another folder").at(str(folder))
    if existing and not force:
        raise InvalidValueError(
            "{files}: already exists", files=", ".join(existing), hint="use another folder, or --force"
        )
    written = write(chosen.name, force=force)
    page.line(f"{chosen.name}: {chosen.title}\n")
    for path in written:
        page.line(f"wrote {path}")
    for command in chosen.commands:
        page.line(f"\n$ {command}", "bold")
        sys.stdout.flush()
        try:
            run(shlex.split(command)[1:])
        except SystemExit as end:
            if end.code:
                raise
