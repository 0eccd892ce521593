"""`rocking validate-predictions`: scores of predictions with measured outcomes."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.answers import Answer
from rocking.cli import options
from rocking.cli.exports import CSV, REPORTED, Exports
from rocking.cli.numbers import number_or_name
from rocking.cli.page import Page, bar, deliver
from rocking.errors import located

if TYPE_CHECKING:
    from rocking.spec.documents.validation import ValidationDocument
    from rocking.spec.reading import InputFiles
    from rocking.spec.validation import FolderValidation

TABLES = ("body", "motion", "settings", "predict")
NOTE = "95 % intervals: bootstrap of motions. The verdict does not use balanced accuracy."
_SCORES = ("forecast", "brier", "logarithmic", "balanced_accuracy")


EXPORTS = {**REPORTED, "csv": CSV}


def validate_predictions(
    context: typer.Context,
    folder: Annotated[
        Path,
        typer.Argument(
            help="Folder with a body file, records (or one .npz array file) and a .csv table with one row per trial. "
            "Columns: motion (or x, y, z), scale, earthquake, overturned. Optional columns: rocked, slid."
        ),
    ],
    restitution: options.MeasuredRestitution = None,
    friction: options.FrictionOfRange = None,
    units: options.Units = None,
    update: Annotated[
        Path | None,
        typer.Option(help="Update the model error with the outcomes; write the .json file for predict.model_error."),
    ] = None,
    sets: options.Set = None,
    threads: options.Threads = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking validate-predictions`."""
    from rocking.spec.validation import ValidationProblem, files_of

    exports = Exports.of(output, EXPORTS)
    files = files_of(folder)
    document, inputs = _document(context, files[0])
    problem = ValidationProblem.of(document, files, inputs)
    with bar("motions", len(problem.motions), quiet=as_json) as progress:
        result = problem.answer(lambda done: progress(1), threads, update=update is not None)
    if update is not None and result.updated is not None:
        result.updated.error.save(update)
    deliver(ValidationAnswer(result), exports, as_json=as_json)


def _document(context: typer.Context, body: Path) -> "tuple[ValidationDocument, InputFiles]":
    from rocking.cli.arguments import Arguments
    from rocking.spec.documents.validation import ValidationDocument
    from rocking.spec.reading import CommandFiles, checked, tables_in
    from rocking.spec.validation import is_question

    arguments = Arguments(context, *TABLES)
    values = {
        "restitution": number_or_name(arguments.options["restitution"]), "friction": arguments.options["friction"]
    }  # fmt: skip
    typed = {
        "body": arguments.table("body", {"units": arguments.length}),
        "predict": arguments.table("predict", values),
        "settings": arguments.table("settings", {}),
        "motion": arguments.table("motion", {"units": arguments.acceleration}),
    }
    stated: dict[str, Any] = {"body": {"file": body.name}}
    if is_question(body):
        stated = dict(tables_in(body) or {})
    with located(body.name, "file"):
        tables = {**stated, **{name: {**stated.get(name, {}), **keys} for name, keys in typed.items() if keys}}
        return checked(ValidationDocument, tables), CommandFiles(body.parent)


@dataclass(frozen=True)
class ValidationAnswer:
    """Scores of the predictions of a folder."""

    result: "FolderValidation"

    def answer(self) -> Answer:
        """Return the scores."""
        return self.result.answer()

    def draw(self) -> Any:
        from rocking.plots import reliability_picture

        return reliability_picture(next(iter(self.result.scores.values())))

    def show(self, page: Page) -> None:
        for validation in self.result.scores.values():
            page.line(validation.verdict, style="bold")
            for line in validation.sentences[1:]:
                page.line(line)
            page.line()
            answer = validation.answer()
            page.rows(({"forecast": name, **scores} for name, scores in answer["scores"].items()), _SCORES)
            page.line()
            page.rows(answer["reliability"], ("predicted", "observed", "count"))
            page.line()
        if self.result.updated is not None:
            for line in self.result.updated.sentences:
                page.line(line)
            answer = self.result.updated.left_out.answer()
            page.rows(({"forecast": name, **scores} for name, scores in answer["scores"].items()), _SCORES)
            page.line()
        page.line(NOTE)
        page.facts([("assumed", reason) for reason in self.result.prediction.assumed])
        if self.result.ignored:
            page.line(f"Columns that were not read: {', '.join(self.result.ignored)}")
        page.warn(self.result.repairs)
        page.warn(f"{self.result.source}, line {row.line}: {row.reason}" for row in self.result.refused)
