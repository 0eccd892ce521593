"""`rocking assess`: does it stand, how far is it from overturning, and what to do about it."""

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.cli import options
from rocking.cli.exports import Export, Exports, draw
from rocking.cli.page import Page, bar, deliver

if TYPE_CHECKING:
    from rocking.assessment import BodyAssessment
    from rocking.spec.document import AssessTable


def _report(answer: "AssessmentAnswer", path: Path) -> None:
    from rocking.reports import assessment_report

    told = answer.told
    words = {"project": told.project or "", "author": told.author or ""}
    assessment_report(answer.found, path, name=answer.name, date=told.date or f"{datetime.now(UTC):%d %B %Y}", **words)


EXPORTS = {
    "picture": Export((".png", ".svg"), draw, "matplotlib"),
    "report": Export((".pdf", ".html"), _report, "matplotlib"),
}


@options.sized
def assess(
    context: typer.Context,
    body: options.BodyFile = None,
    record: options.SeveralRecords = None,
    motion: options.SeveralMotions = None,
    synthetic: options.Family = None,
    count: Annotated[int | None, typer.Option(help="How many synthetic motions, 20 if not given.")] = None,
    seed: options.Seed = None,
    restitution: Annotated[
        list[str] | None, typer.Option(help="Model or coefficient, again for more; all models if none.")
    ] = None,
    friction: options.FrictionOfRange = None,
    sets: options.Set = None,
    threads: options.Threads = None,
    out: Annotated[list[str] | None, options.out(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Print whether a body stands, its margin to overturning, what governs, and what to do about it."""
    from rocking.cli.arguments import as_typed, document_file, is_body
    from rocking.cli.predict import TABLES, in_file, number_or_name, typed
    from rocking.spec.document import AssessmentDocument
    from rocking.spec.prediction import PredictionProblem

    exports = Exports.of(out, EXPORTS)
    if file := document_file(context, body, ("assess",), ["threads"]):
        document, inputs = in_file(file, sets, AssessmentDocument, (*TABLES, "assess"))
    else:
        own = {"assess": {"restitutions": None if restitution is None else [*map(number_or_name, restitution)]}}
        document, inputs = typed(context, AssessmentDocument, {"friction": friction}, own)
    with as_typed():
        problem = PredictionProblem.of(document, inputs)
        with bar("histories", quiet=as_json) as progress:
            found = problem.assessed(document.assess, inputs, progress, threads)
    name = Path(body).stem if body and is_body(body) else ""
    deliver(AssessmentAnswer(found, document.assess, name), exports, as_json=as_json)


@dataclass(frozen=True)
class AssessmentAnswer:
    """What is found of a body."""

    found: "BodyAssessment"
    told: "AssessTable"
    name: str = ""  # of the body

    def facts(self) -> dict[str, Any]:
        words = {name: getattr(self.told, name) for name in ("project", "author", "date")}
        return {**words, **self.found.as_dict()}

    def draw(self) -> Any:
        from rocking.plots import assessment_picture

        return assessment_picture(self.found)

    def show(self, page: Page) -> None:
        found = self.found
        for words, style in zip(found.sentences[:3], ("bold", "bold", None), strict=True):
            page.line(words, style=style)
        page.line()
        head = ("restitution", "r left, right", "overturns under", "least factor")
        rows = [*found.models.items()]
        if found.standing is None:
            rows.append((f"{found.lowest.model}, friction {found.friction:.3g}", found.sliding))
        page.table(head, [_row(found, name, each) for name, each in rows], head[:1])
        page.warn(f"{name}: {why}" for name, why in found.refused.items())
        page.line()
        method = "code method" if found.standing is None else "code method, plane body"
        head = (method, "calls safe", "these overturn", "up to factor")
        page.table(head, [
            (name, *((f"{safe} of {of}", str(fell), f"{least:.3g}") if of else ("outside its domain", "-", "-")))
            for name, of, safe, fell, least in found.code_rows
        ], head[:1])  # fmt: skip
        for title, sentences in (("What governs", found.governs), ("What to do", found.to_do)):
            page.line()
            page.line(title, "bold")
            for words in sentences:
                page.line(words)
        page.line()
        assumed = dict.fromkeys(each.partition(":")[0] for each in found.prediction.assumed)
        page.line(f"Assumed: {'; '.join(assumed)}. What, why, and all references: --out report.pdf, or --json.")


def _row(found: "BodyAssessment", name: str, each: Any) -> tuple[str, ...]:
    r = ", ".join(f"{each.coefficients[foot]:.3f}" for foot in ("left", "right"))
    return name, r, f"{found.falls(each)} of {found.fallen.size}", f"{each.lowest:.3g}"
