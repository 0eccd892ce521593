"""`rocking formats`: every record format that can be read and written."""

import json
from typing import Annotated, Any

import typer


def formats(as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False) -> None:
    """List the formats of ground-motion files: name, endings, whether they state unit and step, what to know."""
    from rocking.motions.formats import formats as registered

    facts = {
        name: {
            "title": kind.title,
            "suffixes": list(kind.suffixes),
            "states_unit": kind.states_unit,
            "states_time_step": kind.states_time_step,
            "notes": kind.notes,
        }
        for name, kind in registered().items()
    }
    if as_json:
        print(json.dumps(facts, indent=2))
    else:
        _show(facts)


def _show(facts: dict[str, dict[str, Any]]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(highlight=False)
    if not console.is_terminal:
        # into a file or a pipe: the same width everywhere
        console = Console(highlight=False, width=100)
    table = Table(box=None, pad_edge=False, header_style="bold")
    for word in ("name", "files", "unit", "step"):
        table.add_column(word, no_wrap=word != "files", max_width=14)
    table.add_column("what it is, and what to know", ratio=1)
    for name, fact in facts.items():
        about = Text(fact["title"])
        if fact["notes"]:
            about.append(f"\n{fact['notes']}\n", style="dim")
        table.add_row(
            name,
            " ".join(fact["suffixes"]) or "any",
            *("stated" if fact[key] else "you say" for key in ("states_unit", "states_time_step")),
            about,
        )
    console.print(table)
    console.print("unit, step: stated in the file, or you say them with --units and --time-step. Content decides")
    console.print("which format a file has, not its ending; --format overrides.")
