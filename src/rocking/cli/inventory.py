"""`rocking inventory`: which objects of a list stay standing, the worst first."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.cli import options
from rocking.cli.page import Page, bar, deliver
from rocking.errors import InvalidValueError
from rocking.spec.document import InventoryTable

if TYPE_CHECKING:
    from rocking.spec.study import StudyProblem
    from rocking.studies.inventory.assessment import Assessment

_SHAKING = "How it shakes"
_STYLES = {"GREEN": "bold green", "AMBER": "bold yellow", "RED": "bold red"}


def inventory(
    context: typer.Context,
    objects: Annotated[
        Path, typer.Argument(help="CSV file with the columns name, width_cm, depth_cm, height_cm and more.")
    ],
    pga: Annotated[str | None, options.key(InventoryTable, "pga", rich_help_panel=_SHAKING)] = None,
    pgv: Annotated[str | None, options.key(InventoryTable, "pgv", rich_help_panel=_SHAKING)] = None,
    motion: Annotated[
        list[str] | None,
        typer.Option(help="Record file, again for more; as recorded without a level.", rich_help_panel=_SHAKING),
    ] = None,
    synthetic: Annotated[
        str | None,
        typer.Option(
            help="Family of motions: firm-ground (default), soft-ground, kanai-tajimi, point-source, pulse-like.",
            rich_help_panel=_SHAKING,
        ),
    ] = None,
    count: Annotated[
        int | None, typer.Option(help="How many synthetic motions, 200 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Seed of the synthetic motions, 1 if not given.", rich_help_panel=_SHAKING)
    ] = None,
    restitution: options.Restitution = "ked",
    units: options.RecordUnits = None,
    sets: options.Set = None,
    out: Annotated[
        list[str] | None,
        typer.Option(
            help="Folder for the report in all forms, or a file: .html, .pdf, .xlsx, .csv, .json; again for more.",
            rich_help_panel=options.OUTPUT,
        ),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print which objects of a list stay standing at a level of shaking, the worst first, in plain words."""
    from rocking.cli.study import document_file, problem_in

    targets = [Path(text) for text in out or ()]
    _check(targets)
    file = document_file(context, "inventory", str(objects))
    problem = problem_in(file, "inventory", sets) if file is not None else _problem(context.params)
    with bar("motions", quiet=as_json) as tell:
        assessment = problem.answer(tell)
    written, left_out = _write(assessment, targets)
    deliver(InventoryAnswer(assessment), as_json=as_json)
    if not as_json:
        for path in written:
            print(f"wrote {path}")
        for sentence in left_out:
            print(f"left out: {sentence}")


def _check(targets: list[Path]) -> None:
    from rocking.reports.inventory_folder import check_form

    for target in targets:
        if target.suffix and not target.is_dir():
            check_form(target)
            if not target.parent.is_dir():
                raise InvalidValueError(f"no folder {str(target.parent)!r} to write {target.name!r} into")


def _write(assessment: "Assessment", targets: list[Path]) -> tuple[list[Path], list[str]]:
    """Write the report; return the files, and what was left out for want of a library."""
    from rocking.reports.inventory_folder import write_inventory, write_inventory_file

    written: list[Path] = []
    left_out: list[str] = []
    for target in targets:
        if target.suffix and not target.is_dir():
            written.append(write_inventory_file(assessment, target))
        else:
            paths, missing = write_inventory(assessment, target)
            written, left_out = [*written, *paths], [*left_out, *missing]
    return written, left_out


def _problem(asked: dict[str, Any]) -> "StudyProblem":
    from rocking.cli.question import Words, as_typed
    from rocking.spec.document import CampaignDocument
    from rocking.spec.reading import CommandFiles, checked
    from rocking.spec.study import StudyProblem

    if asked["pga"] is not None and asked["pgv"] is not None:
        raise InvalidValueError("give --pga or --pgv, not both: motions are scaled to one of them")
    words = Words({"units": asked["units"], "sets": asked["sets"]}, ("motion", "settings", "inventory"))
    levels = {name: asked[name] for name in ("pga", "pgv") if asked[name] is not None}
    with as_typed():
        tables = {
            "campaign": {"name": "inventory", "kind": "inventory"},
            "inventory": {"objects": str(asked["objects"]), **levels, **words.sets.get("inventory", {})},
            "motions": _motions(asked, words, leveled=bool(levels)),
            "restitution": {"model": asked["restitution"]},
            "settings": words.sets.get("settings", {}),
        }
        return StudyProblem.of(checked(CampaignDocument, tables), CommandFiles(Path()))


def _motions(asked: dict[str, Any], words: Any, *, leveled: bool) -> list[dict[str, Any]]:
    from rocking.cli.study import motions_tables
    from rocking.studies.inventory.hazard import COUNT, FAMILY, SEED

    family = {name: asked[name] for name in ("synthetic", "count", "seed")}
    if asked["motion"]:
        if odd := [f"--{name}" for name, value in family.items() if value is not None]:
            raise InvalidValueError(f"{', '.join(odd)} is for synthetic motions: leave it out beside --motion")
        tables = motions_tables(words, asked["motion"])
        for word, table in zip(asked["motion"], tables, strict=True):
            if "pulse" in table:
                raise InvalidValueError(f"--motion takes record files here, got the pulse {word[:80]!r}")
        return tables
    stated = [*(["--units"] if words.acceleration else []), *(f"motion.{key}" for key in words.sets.get("motion", {}))]
    if stated:
        raise InvalidValueError(f"{', '.join(stated)} is for record files: leave it out, or give --motion")
    if not leveled:
        raise InvalidValueError("how strong is the shaking? Give --pga 0.3g or --pgv 25cm/s, or --motion FILE")
    usual = {"synthetic": FAMILY, "count": COUNT, "seed": SEED}
    return [{name: usual[name] if value is None else value for name, value in family.items()}]


@dataclass(frozen=True)
class InventoryAnswer:
    """A ranked list."""

    assessment: "Assessment"

    def facts(self) -> Any:
        """Return everything as plain values."""
        import json

        from rocking.reports.inventory_folder import inventory_json

        return json.loads(inventory_json(self.assessment))

    def show(self, page: Page) -> None:
        """Write the ranking."""
        from rich.text import Text

        from rocking.studies.inventory.table import SLIDING, advice, model_note, sentence

        assessment = self.assessment
        page.line(f"{assessment.source}: {assessment.hazard.words()}, {assessment.hazard.source}")
        for rank, verdict in enumerate(assessment.verdicts, start=1):
            line = Text(f"{rank:3}  ")
            line.append(f"{verdict.light.value} {verdict.light.name:<5}", style=_STYLES[verdict.light.name])
            line.append(f"  {verdict.item.name}: {sentence(verdict, assessment)}")
            page.rich(line)
            note = f"{advice(verdict, assessment)} {model_note(verdict, assessment)}"
            page.line(f"{'':12} {note}".rstrip(), "dim")
        for refused in assessment.not_assessed:
            page.line(f"     not assessed: {refused.name or 'no name'}, line {refused.row}: {refused.reason}")
        lights = assessment.thresholds.sentences().items()
        page.line("\n" + "\n".join(f"{light.name}: {text}" for light, text in lights))
        if assessment.ignored:
            page.line(f"Columns that were not read: {', '.join(assessment.ignored)}")
        page.line(SLIDING)
