"""`rocking inventory`: assessment of a list of objects, in order of decreasing risk."""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.answers import Answer
from rocking.cli import completion, options
from rocking.cli.help import SHAKING
from rocking.cli.page import Page, bar, deliver
from rocking.cli.spelling import UsageError
from rocking.spec.questions.inventory import InventoryTable

if TYPE_CHECKING:
    from rocking.decision.inventory.assessment import Assessment
    from rocking.spec.study import StudyProblem

_MOST_PLANNED, _MOST_OBJECTS = 3, 8  # printed measures and objects without --details
_MOST_REASONS = 5
NOTHING_ASSESSED = 1
"""Exit code if no object of the list could be assessed."""

_STYLES = {"GREEN": "bold green", "AMBER": "bold yellow", "RED": "bold red"}


@options.takes(
    options.keys(InventoryTable, "map_columns"),
    options.keys(InventoryTable, "pga", "pgv", panel=SHAKING),
    before="motion",
)
def inventory(
    context: typer.Context,
    objects: Annotated[Path, typer.Argument(help="Object list: .xlsx, .ods or CSV, with name, width, depth, height.")],
    motion: Annotated[
        list[str] | None,
        typer.Option(help="Record file; repeatable.", rich_help_panel=SHAKING),
    ] = None,
    synthetic: Annotated[
        str | None,
        typer.Option(
            help="Synthetic motions: firm-ground, soft-ground, kanai-tajimi, point-source, pulse-like. "
            "[default: firm-ground]",
            rich_help_panel=SHAKING,
        ),
    ] = None,
    count: Annotated[int | None, options.count(200, SHAKING)] = None,
    seed: Annotated[
        int | None, typer.Option(help="Random seed of the synthetic motions. [default: 1]", rich_help_panel=SHAKING)
    ] = None,
    restitution: Annotated[
        str | None,
        typer.Option(
            help="Model or coefficient. [default: calibrated]",
            autocompletion=completion.models,
        ),
    ] = None,
    friction: options.Friction = None,
    units: options.RecordUnits = None,
    sets: options.Set = None,
    output: Annotated[
        list[str] | None,
        options.output("Folder for all reports, or file: .html, .pdf, .xlsx, .csv, .json; repeatable."),
    ] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking inventory`."""
    from rocking.cli.study import problem_in

    targets = [Path(text) for text in output or ()]
    _check(targets)
    problem = problem_in(context, str(objects), "inventory") or _problem(context)
    with bar("motions", quiet=as_json) as progress:
        assessment = problem.answer(progress)
    if not assessment.verdicts:
        print(f"rocking: {nothing_assessed(assessment)}", file=sys.stderr)
        raise typer.Exit(NOTHING_ASSESSED)
    written, left_out = _write(assessment, targets)
    deliver(InventoryAnswer(assessment, details), as_json=as_json)
    if not as_json:
        for path in written:
            print(f"wrote {path}")
        for sentence in left_out:
            print(f"left out: {sentence}")


def nothing_assessed(assessment: "Assessment") -> str:
    """Return a message with the rows that were not assessed and their reasons."""
    rows = assessment.not_assessed
    reasons = "; ".join(f"line {row.row}: {row.reason}" for row in rows[:_MOST_REASONS])
    more = f"; and {len(rows) - _MOST_REASONS} more lines" if len(rows) > _MOST_REASONS else ""
    return f"{assessment.source}: no object could be assessed, no report was written; {reasons}{more}"


def _check(targets: list[Path]) -> None:
    from rocking.reports.inventory_folder import check_form

    for target in targets:
        if target.suffix and not target.is_dir():
            check_form(target)
            if not target.parent.is_dir():
                raise UsageError(
                    "cannot write {file!r}: folder {folder!r} does not exist",
                    folder=str(target.parent),
                    file=target.name,
                )


def _write(assessment: "Assessment", targets: list[Path]) -> tuple[list[Path], list[str]]:
    """Write the report; return the files, and messages on files not written because a library is missing."""
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


def _problem(context: typer.Context) -> "StudyProblem":
    from rocking.cli.arguments import Arguments
    from rocking.cli.study import family, in_lists, problem_of
    from rocking.decision.inventory.hazard import COUNT, FAMILY, SEED

    arguments = Arguments(context, "motion", "settings", "inventory")
    options, named = arguments.options, arguments.options["motion"] or ()
    objects, values = str(options["objects"]), arguments.values(InventoryTable)
    if {"pga", "pgv"} <= values.keys():
        raise UsageError("Give --pga or --pgv, not both; motions are scaled to one of them")
    table = arguments.table("inventory", {**values, "objects": objects}, {"objects": objects})
    synthetic = family(arguments, {"synthetic": FAMILY, "count": COUNT, "seed": SEED})
    if synthetic is not None and not {"pga", "pgv"} & set(table):
        raise UsageError("No intensity level. Give --pga 0.3g or --pgv 25cm/s, or --motion FILE")
    motions = arguments.each(named, arguments.components) if synthetic is None else [synthetic]
    if pulse := next((motion["pulse"] for motion in motions if "pulse" in motion), None):
        raise UsageError(
            "{parameter} accepts record files only, got the pulse {pulse!r}", parameter="--motion", pulse=pulse[:80]
        )
    tables: dict[str, Any] = {"inventory": table}
    if options["restitution"] is not None:
        tables["restitution"] = {"model": options["restitution"]}
    return problem_of("inventory", arguments, in_lists(motions), **tables)


@dataclass(frozen=True)
class InventoryAnswer:
    """A ranked list."""

    assessment: "Assessment"
    details: bool = False

    def answer(self) -> Answer:
        """Return the ranked list, the plan of measures, and the basis of the assessment."""
        from rocking.decision.inventory.ranking import answer_of

        return answer_of(self.assessment)

    def show(self, page: Page) -> None:
        from rocking.decision.inventory import ranking
        from rocking.decision.inventory.lights import LIGHT_MARKS
        from rocking.dynamics.settings import NEVER_SLIDES
        from rocking.restitution.headline import headline

        assessment = self.assessment
        say, hazard, verdicts = ranking.words_of(assessment), assessment.hazard, assessment.verdicts
        page.line(f"{assessment.source}: {hazard.words(say.code)}, {say(hazard.source)}")
        numbers = {light: sum(verdict.light is light for verdict in verdicts) for light in LIGHT_MARKS}
        counts = [f"{say(LIGHT_MARKS[light])} {number}" for light, number in numbers.items()]
        page.line(f"{', '.join(reversed(counts))}\n", "bold")
        self._show_objects(page, say)
        self._show_plan(page, say)
        page.line()
        if self.details:
            self._show_details(page, say)
        in_space = {verdict.item.solid is not None or verdict.friction < NEVER_SLIDES for verdict in verdicts}
        models = [
            say(headline(assessment.restitution, in_space=is_3d, is_stated=not assessment.drawn))
            for is_3d in sorted(in_space)
        ]
        page.line("\n".join(dict.fromkeys(models)))
        if assessment.ignored:
            page.line(say("Columns that were not read: {columns}", columns=", ".join(assessment.ignored)))
        for text in (ranking.untranslated(assessment), ranking.sliding(assessment)):
            if text:
                page.line(text)
        if not self.details:
            page.line("Advice, all objects and definitions: --details    Reports: -o FOLDER, -o report.pdf")

    def _show_objects(self, page: Page, say: Any) -> None:
        """Write one line per object with the rating of each model, and the advice with details."""
        from rich.text import Text

        from rocking.decision.inventory import ranking
        from rocking.decision.inventory.lights import LIGHT_MARKS

        assessment = self.assessment
        count = len(assessment.verdicts) if self.details else _MOST_OBJECTS
        models = [assessment.restitution, *assessment.comparisons]
        page.line(f"     {'  '.join(f'{name:<7}' for name in models)}  {say('object')}", "dim")
        for rank, verdict in enumerate(assessment.verdicts[:count], start=1):
            line = Text(f"{rank:3}  ")
            for name, light in ranking.lights_by_model(verdict, assessment):
                line.append(f"{say(LIGHT_MARKS[light]):<{max(7, len(name))}}  ", style=_STYLES[light.name])
            line.append(f"{ranking.named(verdict, say)}: {ranking.sentence(verdict, assessment)}")
            page.rich(line)
            names = ("advice", "model_note", "noted") if self.details else ()
            if notes := " ".join(filter(None, (getattr(ranking, name)(verdict, assessment) for name in names))):
                page.line(f"{'':12} {notes}", "dim")
        if (remaining := len(assessment.verdicts) - count) > 0:
            page.line(f"     {say('and {count} object more', 'and {count} objects more', count=remaining)}")
        for refused in assessment.not_assessed:
            reason, name = say(refused.reason), refused.label or say("no name")
            page.line(
                f"     {say('not assessed: {name}, line {row}: {reason}', name=name, row=refused.row, reason=reason)}"
            )

    def _show_plan(self, page: Page, say: Any) -> None:
        """Write the first objects of the plan of measures."""
        from rocking.decision.inventory import ranking

        plan = self.assessment.plan
        count = len(plan) if self.details else _MOST_PLANNED
        if plan:
            page.line(f"\n{say('First measures (one measure per object is sufficient):')}")
        for k, entry in enumerate(plan[:count], start=1):
            page.line(f"{k:3}  {ranking.plan_words(entry, say)}")
        if (remaining := len(plan) - count) > 0:
            page.line(f"     {say('and {count} object more', 'and {count} objects more', count=remaining)}")

    def _show_details(self, page: Page, say: Any) -> None:
        """Write the definitions of the ratings, the sources, and the lines and statements of the list."""
        from rocking.cli.study import source_lines
        from rocking.decision.inventory import ranking
        from rocking.decision.inventory.lights import LIGHT_MARKS
        from rocking.motions.summary import summaries_of

        assessment = self.assessment
        for light, text in assessment.thresholds.sentences(say.code).items():
            page.line(f"{say(LIGHT_MARKS[light])}: {text}")
        page.line(assessment.thresholds.conventions(say.code)[0])
        page.facts([] if assessment.hazard.synthetic else source_lines(summaries_of(assessment.hazard.motions)))
        if others := ranking.passed_over(assessment):
            lines = "; ".join(f"{', '.join(map(str, rows))} ({reason})" for reason, rows in others)
            page.line(say("Lines that are not objects: {lines}", lines=lines))
        if text := ranking.stated(assessment):
            page.line(text)
