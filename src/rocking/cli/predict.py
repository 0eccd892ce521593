"""`rocking predict` and `rocking assess`: probability of overturning, margin, and retrofit measures."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from rocking.answers import Answer
from rocking.cli import options
from rocking.cli.assessed import (
    R,
    assessment_values,
    headline_of,
    measures_of,
    model_cells,
    prediction_values,
    show_assumed,
    show_subject,
)
from rocking.cli.code_checks import show_limits
from rocking.cli.compared import grouped
from rocking.cli.exports import CSV, NETCDF, REPORTED, Exports
from rocking.cli.numbers import number_or_name
from rocking.cli.page import MOST_MODELS, MOST_ROWS, Page, bar, deliver
from rocking.cli.study import source_lines
from rocking.decision.prediction.forecast import input_label
from rocking.decision.prediction.likelihood import scale_words
from rocking.errors import located
from rocking.messages import listed

if TYPE_CHECKING:
    from rocking.decision.assessment import BodyAssessment
    from rocking.decision.prediction import Prediction
    from rocking.spec.documents.prediction import AssessTable, PredictedBody, PredictionDocument
    from rocking.spec.reading import InputFiles

D = TypeVar("D", bound="PredictionDocument")
TABLES = ("body", "motion", "settings", "predict")
COUNT, SEED = 20, 1
"""Default number and seed of synthetic motions."""


EXPORTS = {**REPORTED, "csv": CSV, "netcdf": NETCDF}
_NAMED = ("calibrated", "housner", "ked")  # restitution cases with their own row


@options.takes(options.SIZES)
def predict(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.SeveralRecords = None,
    motion: options.SeveralMotions = None,
    synthetic: options.Family = None,
    count: Annotated[int | None, options.count(COUNT)] = None,
    seed: options.Seed = None,
    pga: options.ScaledToPeak = None,
    restitution: options.MeasuredRestitution = None,
    friction: options.FrictionOfRange = None,
    sets: options.Set = None,
    threads: options.Threads = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking predict`."""
    from rocking.cli.arguments import document_file
    from rocking.spec.documents.prediction import PredictionDocument
    from rocking.spec.prediction import PredictionProblem

    exports = Exports.of(output, EXPORTS)
    if file := document_file(context, body, ("predict",)):
        document, inputs = in_file(file, sets, PredictionDocument)
    else:
        values = {"restitution": number_or_name(restitution), "friction": friction, "pga": pga}
        document, inputs = typed(context, PredictionDocument, values)
    with bar("reading body and motions", quiet=as_json):
        problem = PredictionProblem.of(document, inputs)
    with bar("motions", len(problem.motions), quiet=as_json) as progress:
        result = problem.answer(lambda done: progress(1), threads)
    deliver(PredictionAnswer(result, named(document, inputs, file), details), exports, as_json=as_json)


def in_file(
    file: Path, sets: list[str] | None, kind: type[D], tables: Sequence[str] = TABLES
) -> "tuple[D, InputFiles]":
    """Return the document of a file, of class `kind`, with the keys of `--set` in `tables`."""
    from rocking.cli.arguments import parsed_sets, with_sets
    from rocking.spec.reading import InputFiles, checked, tables_in

    with located(str(file), "file"):
        stated = dict(tables_in(file) or {})
        lists = "motion" not in stated
        document = checked(kind, with_sets(stated, parsed_sets(sets, tables), lists=lists))
    return document, InputFiles(file.parent)


def named(document: "PredictedBody", inputs: "InputFiles", file: Path | None) -> str:
    """Return the name of the body for the report, otherwise the name of the input file."""
    from rocking.spec.bodies import name_of

    return name_of(document.body, inputs.folder) or (file.stem if file else "")


def typed(
    context: typer.Context, kind: type[D], values: dict[str, Any], own: dict[str, dict[str, Any]] | None = None
) -> "tuple[D, InputFiles]":
    """Return the document of the options, with `values` in its table [predict] and the tables `own`."""
    from rocking.cli.arguments import Arguments
    from rocking.cli.study import motions_of
    from rocking.spec.reading import CommandFiles, checked

    arguments = Arguments(context, *TABLES, *(own or ()))
    with arguments.hinted():
        document: dict[str, Any] = {
            "body": arguments.body_table(arguments.body_and_motions()[0]),
            "predict": arguments.table("predict", values),
            "settings": arguments.table("settings", {}),
            **{name: arguments.table(name, keys) for name, keys in (own or {}).items()},
        }
        document["motions"] = motions_of(arguments, arguments.components, {"count": COUNT, "seed": SEED})
        return checked(kind, document), CommandFiles(Path())


@dataclass(frozen=True)
class PredictionAnswer:
    """Prediction of a body."""

    result: "Prediction"
    name: str = ""  # name of the body
    details: bool = False

    def answer(self) -> Answer:
        """Return the prediction."""
        return self.result.answer()

    def draw(self) -> Any:
        from rocking.plots import prediction_picture

        return prediction_picture(self.result)

    def show(self, page: Page) -> None:
        from rocking.reports.motion_sources import motion_table

        result = self.result
        show_subject(page, result)
        page.line(result.verdict, style="bold")
        if self.details:
            for line in result.sentences[1:]:
                page.line(line)
        else:
            self._show_values(page)
        page.line()
        if self.details or 1 < len(result.motions) <= MOST_MODELS:
            page.reported(motion_table(result))
            page.line()
        if result.decides:
            page.line(result.decides)
            page.line()
        else:
            page.rows(result.ranked_contributions, most=MOST_ROWS if self.details else MOST_MODELS)
            page.line("Contributions to the variance of overturning (Sobol indices).")
            page.line()
        if not self.details:
            show_assumed(page, result)
            page.line("Reasons, sources and likelihood terms: --details    Files: -o report.pdf, -o table.csv")
            return
        listed = result.assumptions.keys() | result.fixed.keys()
        page.facts([(input_label(name), text) for name, text in result.inputs.items() if name not in listed])
        page.facts([("assumed", reason) for reason in result.assumed])
        page.facts([("not sampled", reason) for reason in result.not_sampled])
        page.facts(source_lines(result.motions))
        page.line(scale_words())
        page.warn(result.repairs)

    def _show_values(self, page: Page) -> None:
        """Write the values and the sentences that limit the verdict."""
        result = self.result
        page.values(prediction_values(result))
        for line in filter(None, [getattr(result.body, "caution", ""), result.evidence, result.headline]):
            page.line(line)
        if result.failed:
            page.warn([f"{result.failed} of {result.histories} histories have no result and do not count."])


@options.takes(options.SIZES)
def assess(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.SeveralRecords = None,
    motion: options.SeveralMotions = None,
    synthetic: options.Family = None,
    count: Annotated[int | None, options.count(COUNT)] = None,
    seed: options.Seed = None,
    pga: options.ScaledToPeak = None,
    restitution: Annotated[
        list[str] | None, typer.Option(help="Model or coefficient; repeatable. [default: all models]")
    ] = None,
    friction: options.FrictionOfRange = None,
    sets: options.SetOfAssessment = None,
    threads: options.Threads = None,
    output: Annotated[list[str] | None, options.output(REPORTED)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking assess`."""
    from rocking.cli.arguments import document_file
    from rocking.spec.documents.prediction import AssessmentDocument
    from rocking.spec.prediction import PredictionProblem

    exports = Exports.of(output, REPORTED)
    if file := document_file(context, body, ("assess",)):
        document, inputs = in_file(file, sets, AssessmentDocument, (*TABLES, "assess"))
    else:
        own = {"assess": {"restitutions": None if restitution is None else [*map(number_or_name, restitution)]}}
        document, inputs = typed(context, AssessmentDocument, {"friction": friction, "pga": pga}, own)
    with bar("reading body and motions", quiet=as_json):
        problem = PredictionProblem.of(document, inputs)
    with bar("histories", quiet=as_json) as progress:
        result = problem.assessed(document.assess, inputs, progress, threads)
    name = named(document, inputs, file)
    deliver(AssessmentAnswer(result, document.assess, name, details), exports, as_json=as_json)


@dataclass(frozen=True)
class AssessmentAnswer:
    """Assessment of a body."""

    result: "BodyAssessment"
    table: "AssessTable"
    name: str = ""  # name of the body
    details: bool = False

    @property
    def signed(self) -> dict[str, str]:
        """Project, author and date of the report."""
        table = self.table
        date = table.date or f"{datetime.now(UTC):%d %B %Y}"
        return {"project": table.project or "", "author": table.author or "", "date": date}

    def answer(self) -> Answer:
        """Return the assessment with project, author and date."""
        return self.result.answer() | {name: getattr(self.table, name) for name in ("project", "author", "date")}

    def draw(self) -> Any:
        from rocking.plots import assessment_picture

        return assessment_picture(self.result)

    def show(self, page: Page) -> None:
        result = self.result
        show_subject(page, result.prediction, "; both polarities")
        page.line(headline_of(result), style="bold")
        if result.body.caution:
            page.line(result.body.caution)
        page.values(assessment_values(result))
        page.line(result.prediction.evidence)
        page.line(result.headline)
        page.line()
        if self.details:
            self._show_details(page)
            return
        rows = {row["restitution"]: row for row in result.model_rows[: len(result.models)]}
        shown = {name for name in rows if len(rows) <= MOST_MODELS or name.partition(",")[0] in _NAMED}
        groups = grouped({name: row["overturned"] for name, row in rows.items()}, shown)
        head = ("restitution model", "r", "overturned", "margin")
        page.table(head, [model_cells([rows[name] for name in group]) for group in groups], head[:1])
        page.warn(f"{name}: {reason}" for name, reason in result.refused.items())
        page.line()
        for text in measures_of(result):
            page.line(text)
        page.line()
        show_assumed(page, result.prediction)
        page.line("Causes, code methods, sliding and sources: --details    Report: -o report.pdf")

    def _show_details(self, page: Page) -> None:
        from rocking.decision.code_methods import CODE_METHODS

        result = self.result
        for text in result.sentences[:3]:
            page.line(text)
        page.line()
        page.rows(result.model_rows, (), R, most=len(result.models) + 1, dense=False)
        page.warn(f"{name}: {reason}" for name, reason in result.refused.items())
        page.line()
        if result.standing is not None:
            page.line("Code methods: plane body")
        page.rows(result.code_rows, (), most=len(result.capacities), dense=False)
        show_limits(page, (CODE_METHODS[name] for name in result.capacities), result)
        for title, sentences in (("Causes", result.governing_factors), ("Retrofit measures", result.measures)):
            page.line()
            page.line(title, "bold")
            for text in sentences:
                page.line(text)
        page.line()
        page.facts(source_lines(result.prediction.motions))
        page.line(scale_words())
        assumed = listed(result.prediction.assumed_values).rstrip(".")
        page.line(f"Assumed: {assumed}. Reasons and all references: -o report.pdf, or --json.")
        page.warn(result.prediction.repairs)
