"""The report of a validation: whether predictions were right, beside the plain curves that they must beat."""

from pathlib import Path

from rocking.errors import InvalidValueError
from rocking.plots.reliability import reliability_picture
from rocking.prediction import Validation
from rocking.reports.document import Document, Paragraph, Picture, ReportSection, ReportTable, table
from rocking.reports.render import write_report
from rocking.spec.validation import FolderValidation
from rocking.tables import target_of
from rocking.version import SOFTWARE

_MARKS = {"better": "good", "not resolved": "fair", "mixed": "fair", "worse": "bad"}
_COLUMNS = {
    "brier": "Brier [-]", "logarithmic": "logarithmic [nat]", "balanced_accuracy": "balanced accuracy [-]",
    "bias": "bias [-]",
}  # fmt: skip
_METHOD = (
    "Bodies that may be the one in question are drawn from what is known of it and followed under the motion of each "
    "trial; nothing is fitted to the outcomes. The plain curves are fitted to the outcomes under all other motions. "
    "Intervals are of 95 %, whole motions drawn anew; differences are drawn in pairs. The verdict rests on the "
    "differences of the Brier and the logarithmic score: balanced accuracy does not see how sure a forecast was."
)


def validation_report(found: FolderValidation, path: str | Path, *, date: str = "") -> Path:
    """Write the report of a validation: verdict, reliability diagram, scores, and what was assumed.

    Parameters
    ----------
    found : FolderValidation
        As `rocking validate` finds it.
    path : str or Path
        A document (.pdf), or a web page of one file (.html).
    date : str
        Day of the report, as it should be printed.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If it is no validation, or the ending of the path is another.
    MissingExtraError
        If matplotlib, and typst (.pdf) or jinja2 (.html), are not installed.
    """
    known: object = found
    if not isinstance(known, FolderValidation):
        raise InvalidValueError(f"found must be a FolderValidation, got {found!r:.60}")
    target = target_of(path)
    pictures = {event: (lambda each=each: reliability_picture(each)) for event, each in found.found.items()}
    write_report(validation_document(found, date), pictures, target)
    return target


def validation_document(found: FolderValidation, date: str = "") -> Document:
    """Return the content of the report."""
    sections = [_event(event, each) for event, each in found.found.items()]
    inputs = table("", ["input", "drawn from"], found.prediction.inputs.items())
    sections.append(
        ReportSection("What is known, and what was assumed", [inputs, *map(Paragraph, found.prediction.assumed)])
    )
    rows = [(str(each.line), each.reason) for each in found.refused]
    left_out = [table(f"Rows of {found.source} that could not be taken", ["line", "why"], rows)] if rows else []
    count = f"{found.prediction.count} bodies under each motion, {found.prediction.histories} histories in all."
    sections.append(ReportSection("How it was computed", [Paragraph(_METHOD), Paragraph(count), *left_out]))
    first = next(iter(found.found.values()))
    subtitle = f"{first.count} outcomes under {first.clusters} motions" + (f". {date}" if date else "")
    mark = _MARKS["mixed" if first.finding == "better" and first.too_sure else first.finding]
    verdict = [Paragraph(first.verdict, "", mark)]
    return Document(f"Predictions of {found.name}", subtitle, sections, verdict=verdict, footer=SOFTWARE)


def _event(event: str, found: Validation) -> ReportSection:
    picture = Picture(event, f"What was said of {event} and how often it happened; and the differences of scores")
    return ReportSection(event.capitalize(), [*map(Paragraph, found.sentences), picture, _scores(found)])


def _scores(found: Validation) -> ReportTable:
    rows = []
    for name, each in found.forecasts.items():
        scores = [getattr(each, measure) for measure in _COLUMNS]
        rows.append((name, *(f"{s.value:.3f} ({s.low:.3f} to {s.high:.3f})" for s in scores)))
    return table("Scores of each forecast", ["forecast", *_COLUMNS.values()], rows)
