"""`rocking examples`: what comes with the package, and one of it run in the current folder."""

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
    known = catalogue()
    if name is None or dry_run or as_json:
        chosen = known if name is None else {name: known[checks.one_of("example", name, known)]}
        deliver(_Listed(chosen, whole=name is None), as_json=as_json)
        return
    _run(known[checks.one_of("example", name, known)], context.obj, force=force)


@dataclass(frozen=True)
class _Listed:
    """Some examples; whole: as a table of all of them."""

    chosen: Mapping[str, Example]
    whole: bool

    def answer(self) -> Answer:
        """Return what each example writes and runs."""
        names = ("name", "kind", "title", "writes", "commands", "outputs")
        return Answer({"examples": [{name: getattr(one, name) for name in names} for one in self.chosen.values()]})

    def show(self, page: Page) -> None:
        if self.whole:
            rows = [(one.name, one.kind, one.title) for one in self.chosen.values()]
            page.table(("name", "kind", "what it is"), rows, ("name", "kind", "what it is"), whole={0, 1})
            page.line("\nRun an example in this folder: rocking examples NAME. In Python: rk.examples.")
            return
        for one in self.chosen.values():
            page.line(f"{one.name}: {one.title}")
            page.line(f"writes {', '.join(one.writes)}, and by its commands {', '.join(one.outputs)}")
            for command in one.commands:
                page.line(f"$ {command}", "bold")


def _run(chosen: Example, run: Callable[[list[str]], None], *, force: bool) -> None:
    """Write the files and run the commands, one after the other as if they were typed; the first that fails ends it."""
    page = Page()
    there = [name for name in chosen.outputs if Path(name).exists()]
    if folder := next((name for name in there if Path(name).is_dir()), None):
        raise InvalidValueError("a folder of that name is there already", hint="take another folder").at(str(folder))
    if there and not force:
        raise InvalidValueError(
            "{files}: there already", files=", ".join(there), hint="take another folder, or --force"
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
