"""`rocking models` and `rocking record formats`: lists of restitution models and record formats."""

import textwrap
from dataclasses import dataclass
from typing import Annotated, Any

import typer

from rocking.answers import Answer
from rocking.cli import completion, options
from rocking.cli.page import Page, deliver

_MOST_SUFFIXES = 3  # extensions of a format in the list without --details
_TEXTS, _ALL = ("name", "model", "files", "unit", "step", "description"), range(5)


def models(
    name: Annotated[
        str | None,
        typer.Argument(help="Model or FILE.py:MODEL. [default: all models]", autocompletion=completion.every_model),
    ] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
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
    chosen = {key: kind for key, kind in kinds.items() if name in {None, key}}
    deliver(_Models(chosen, details or name is not None), as_json=as_json)


@dataclass(frozen=True)
class _Models:
    kinds: dict[str, Any]
    details: bool

    def answer(self) -> Answer:
        """Return the title, reference, assumptions, domain and known defects of each model."""
        names = ("title", "reference", "assumptions", "domain", "known_defects")
        return Answer({key: {name: getattr(kind, name) for name in names} for key, kind in self.kinds.items()})

    def show(self, page: Page) -> None:
        if not self.details:
            rows = [(key, kind.title) for key, kind in self.kinds.items()]
            page.table(("name", "model"), rows, _TEXTS, unfolded=_ALL)
            page.line("\nAssumptions, domain and known defects: rocking models NAME, or --details")
            return
        for key, entry in self.answer().values.items():
            page.line(f"{key}: {entry.pop('title')}")
            for name, value in entry.items():
                for k, line in enumerate([value] if isinstance(value, str) else value):
                    first = f"  {name.replace('_', ' ') + ':' if k == 0 else '':<15}"
                    page.line(textwrap.fill(line, width=100, initial_indent=first, subsequent_indent=" " * 17))
            page.line()


def record_formats(details: options.Details = False, as_json: options.AsJson = False) -> None:
    """Run `rocking record formats`."""
    deliver(_Formats(details), as_json=as_json)


@dataclass(frozen=True)
class _Formats:
    details: bool

    def answer(self) -> Answer:
        """Return the title, extensions, stated quantities and notes of each format."""
        from rocking.motions.formats import formats as registered

        names = ("title", "suffixes", "states_unit", "states_time_step", "notes")
        return Answer({key: {name: getattr(kind, name) for name in names} for key, kind in registered().items()})

    def show(self, page: Page) -> None:
        facts = self.answer().values.items()
        rows = [(name, self._suffixes(fact["suffixes"]), *_stated(fact), fact["title"]) for name, fact in facts]
        page.table(("name", "files", "unit", "step", "description"), rows, _TEXTS, unfolded=_ALL)
        page.line("unit, step: in the file, or required: --units and --set motion.time_step=SECONDS.")
        page.line("The format is found by content, not by extension; --set motion.format=NAME overrides.")
        if not self.details:
            page.line("All extensions, and the files of each verification: --details")
            return
        for name, fact in facts:
            if fact["notes"]:
                page.line(f"\n{name}", "bold")
                page.line(textwrap.fill(fact["notes"], width=100, initial_indent="  ", subsequent_indent="  "))

    def _suffixes(self, suffixes: tuple[str, ...]) -> str:
        shown = suffixes if self.details else suffixes[:_MOST_SUFFIXES]
        return " ".join(shown) + " ..." * (len(shown) < len(suffixes)) or "any"


def _stated(fact: dict[str, Any]) -> list[str]:
    return ["in file" if fact[key] else "required" for key in ("states_unit", "states_time_step")]
