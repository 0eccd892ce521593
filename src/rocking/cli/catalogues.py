"""`rocking models` and `rocking record formats`: lists of restitution models and record formats."""

import textwrap
from dataclasses import dataclass
from typing import Annotated, Any

import typer

from rocking.answers import Answer
from rocking.cli import completion
from rocking.cli.page import Page, deliver

AsJson = Annotated[bool, typer.Option("--json", help="Result as JSON.")]


def models(
    name: Annotated[
        str | None,
        typer.Argument(help="Model or FILE.py:MODEL. [default: all models]", autocompletion=completion.every_model),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Run `rocking models`."""
    from rocking import checks, restitution
    from rocking.errors import UnknownModelError
    from rocking.restitution.from_file import file_of, model_in_file
    from rocking.restitution.space import spatial_models

    kinds: dict[str, Any] = {**restitution.models(), **spatial_models()}
    if name is not None and file_of(name):
        kinds[name] = type(model_in_file(name))
    name = checks.spelling(name, kinds)
    if name is not None and name not in kinds:
        near = checks.nearest(name, kinds)
        raise UnknownModelError(
            "unknown restitution model {name!r}; models: {names}", parameter="restitution", name=name,
            names=", ".join(kinds), hint=near,
        )  # fmt: skip
    deliver(_Models({key: kind for key, kind in kinds.items() if name in {None, key}}), as_json=as_json)


@dataclass(frozen=True)
class _Models:
    kinds: dict[str, Any]

    def answer(self) -> Answer:
        """Return the title, reference, assumptions, domain and known defects of each model."""
        names = ("title", "reference", "assumptions", "domain", "known_defects")
        return Answer({key: {name: getattr(kind, name) for name in names} for key, kind in self.kinds.items()})

    def show(self, page: Page) -> None:
        for key, entry in self.answer().values.items():
            page.line(f"{key}: {entry.pop('title')}")
            for name, value in entry.items():
                for k, line in enumerate([value] if isinstance(value, str) else value):
                    first = f"  {name.replace('_', ' ') + ':' if k == 0 else '':<15}"
                    page.line(textwrap.fill(line, width=100, initial_indent=first, subsequent_indent=" " * 17))
            page.line()


def record_formats(as_json: AsJson = False) -> None:
    """Run `rocking record formats`."""
    deliver(_Formats(), as_json=as_json)


class _Formats:
    def answer(self) -> Answer:
        """Return the title, extensions, stated quantities and notes of each format."""
        from rocking.motions.formats import formats as registered

        names = ("title", "suffixes", "states_unit", "states_time_step", "notes")
        return Answer({key: {name: getattr(kind, name) for name in names} for key, kind in registered().items()})

    def show(self, page: Page) -> None:
        from rich.console import Console
        from rich.table import Table
        from rich.text import Text

        console = Console(highlight=False)
        if not console.is_terminal:  # fixed width for a file or a pipe
            console = Console(highlight=False, width=100)
        table = Table(box=None, pad_edge=False, header_style="bold")
        for head in ("name", "files", "unit", "step"):
            table.add_column(head, no_wrap=head != "files", max_width=14)
        table.add_column("description", ratio=1)
        for name, fact in self.answer().values.items():
            about = Text(fact["title"])
            if fact["notes"]:
                about.append(f"\n{fact['notes']}\n", style="dim")
            stated = ("in file" if fact[key] else "required" for key in ("states_unit", "states_time_step"))
            table.add_row(name, " ".join(fact["suffixes"]) or "any", *stated, about)
        console.print(table)
        page.line("unit, step: in the file, or required: --units and --set motion.time_step=SECONDS.")
        page.line("The format is found by content, not by extension; --set motion.format=NAME overrides.")
