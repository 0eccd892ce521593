"""The reports of a prediction and of a validation: verdict, pictures, tables, and what was assumed."""

from functools import partial

from rocking.conventions import percent
from rocking.plots.prediction import prediction_picture, reliability_picture
from rocking.prediction import Prediction, Validation
from rocking.reports.document import Content, Paragraph, Picture, ReportSection, ReportTable, judged, table
from rocking.spec.validation import FolderValidation

_MARKS = ((0.05, "good"), (0.5, "fair"))
_MARKS_OF_FINDINGS = {"better": "good", "not resolved": "fair", "mixed": "fair", "worse": "bad"}
_SCORES = {
    "brier": "Brier [-]", "logarithmic": "logarithmic [nat]", "balanced_accuracy": "balanced accuracy [-]",
    "bias": "bias [-]",
}  # fmt: skip
_PREDICTED = (
    "Bodies that may be the one in question are drawn from what is known of it, each is followed under every motion, "
    "and those that overturn are counted. Intervals are of 95 %."
)
_VALIDATED = (
    "Bodies that may be the one in question are drawn from what is known of it and followed under the motion of each "
    "trial; nothing is fitted to the outcomes. The plain curves are fitted to the outcomes under all other motions. "
    "Intervals are of 95 %, whole motions drawn anew; differences are drawn in pairs. The verdict rests on the "
    "differences of the Brier and the logarithmic score: balanced accuracy does not see how sure a forecast was."
)


def prediction_content(found: Prediction, *, name: str, date: str) -> Content:
    """Return the report of a prediction: verdict, picture, probabilities, what decides them, and what was assumed."""
    chance = found.chances["overturning"]
    mark = next((word for most, word in _MARKS if chance.high <= most), "bad")
    picture = Picture(
        "prediction", "How likely it overturns and rocks under each motion, and what decides whether it does"
    )
    failed = f", {found.failed} without a result" if found.failed else ""
    sections = [
        ReportSection("What will become of it", [*map(Paragraph, found.sentences[1:]), picture, _motions(found)]),
        *([ReportSection("What decides it", [_shares(found)])] if found.shares else []),
        _assumed(found),
        ReportSection(
            "How it was computed", [Paragraph(_PREDICTED), Paragraph(f"{_count(found)}{failed}; seed {found.seed}.")]
        ),
    ]
    several = f"Under {len(found.motions)} motion{'' if len(found.motions) == 1 else 's'}"
    document = judged(name or "A body in an earthquake", (several, date), sections, found.verdict, mark)
    return document, {"prediction": lambda: prediction_picture(found)}


def validation_content(found: FolderValidation, *, name: str, date: str) -> Content:
    """Return the report of a validation: verdict, reliability diagram, scores, and what was assumed."""
    rows = [(str(each.line), each.reason) for each in found.refused]
    left_out = [table(f"Rows of {found.source} that could not be taken", ["line", "why"], rows)] if rows else []
    count = Paragraph(f"{_count(found.prediction)}.")
    sections = [
        *(_event(event, each) for event, each in found.found.items()),
        _assumed(found.prediction),
        ReportSection("How it was computed", [Paragraph(_VALIDATED), count, *left_out]),
    ]
    first = next(iter(found.found.values()))
    mark = _MARKS_OF_FINDINGS["mixed" if first.finding == "better" and first.too_sure else first.finding]
    several = f"{first.count} outcomes under {first.clusters} motions"
    document = judged(f"Predictions of {name or found.name}", (several, date), sections, first.verdict, mark)
    return document, {event: partial(reliability_picture, each) for event, each in found.found.items()}


def _assumed(found: Prediction) -> ReportSection:
    inputs = table("", ["input", "drawn from"], found.inputs.items())
    return ReportSection("What is known, and what was assumed", [inputs, *map(Paragraph, found.assumed)])


def _count(found: Prediction) -> str:
    return f"{found.count} bodies under each motion, {found.histories} histories in all"


def _motions(found: Prediction) -> ReportTable:
    rows = [
        (name, *(percent(float(chance.per_motion[k])) for chance in found.chances.values()))
        for k, name in enumerate(found.motions)
    ]
    return table("Probabilities under each motion", ["motion", *found.chances], rows)


def _shares(found: Prediction) -> ReportTable:
    rows = [
        (
            "motion" if name == "case" else name,
            f"{s.first:.2f}",
            f"{s.total:.2f}",
            f"{s.total_low:.2f} to {s.total_high:.2f}",
        )
        for name, s in sorted(found.shares.items(), key=lambda pair: -pair[1].total)
    ]
    note = "Sobol indices: shares of the variance of whether it overturns."
    return table("", ["what is not known", "alone [-]", "with the others [-]", "95 %"], rows, note)


def _event(event: str, found: Validation) -> ReportSection:
    picture = Picture(event, f"What was said of {event} and how often it happened; and the differences of scores")
    return ReportSection(event.capitalize(), [*map(Paragraph, found.sentences), picture, _scores(found)])


def _scores(found: Validation) -> ReportTable:
    rows = []
    for name, each in found.forecasts.items():
        scores = [getattr(each, measure) for measure in _SCORES]
        rows.append((name, *(f"{s.value:.3f} ({s.low:.3f} to {s.high:.3f})" for s in scores)))
    return table("Scores of each forecast", ["forecast", *_SCORES.values()], rows)
