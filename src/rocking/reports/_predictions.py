"""The reports of a prediction and of a validation: verdict, pictures, tables, and what was assumed."""

from functools import partial

from rocking.plots.prediction import prediction_picture, reliability_picture
from rocking.prediction import Prediction, Validation
from rocking.prediction.likelihood import scale_words
from rocking.reports.body_blocks import body_blocks
from rocking.reports.document import (
    Content,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    answer_table,
    judged,
    table,
)
from rocking.reports.motion_sources import motion_sources, motion_table
from rocking.spec.validation import FolderValidation
from rocking.version import SOFTWARE

_MARKS = ((0.05, "good"), (0.5, "fair"))
_MARKS_OF_FINDINGS = {"better": "good", "not resolved": "fair", "mixed": "fair", "worse": "bad"}
_SCORES = ("forecast", "brier", "logarithmic", "balanced_accuracy", "bias")
_PREDICTED = (
    "Bodies are sampled from the distributions of the uncertain inputs. Each body is simulated under every motion, and "
    "the bodies that overturn are counted. All motions are equally likely. Intervals are of 95 %, for these motions."
)
_VALIDATED = (
    "Bodies that may be the one in question are drawn from what is known of it and followed under the motion of each "
    "trial; nothing is fitted to the outcomes. The plain curves are fitted to the outcomes under all other motions. "
    "Intervals are of 95 %, whole motions drawn anew; differences are drawn in pairs. The verdict rests on the "
    "differences of the Brier and the logarithmic score: balanced accuracy does not see how sure a forecast was."
)


def prediction_content(found: Prediction, *, name: str, date: str) -> Content:
    """Return the report of a prediction: verdict, probabilities and their condition, body, motions, and inputs."""
    mark = next((word for most, word in _MARKS if found.chances["overturning"].high <= most), "bad")
    caption = "Probability of overturning and of rocking under each motion"
    picture = Picture("prediction", caption if found.decides else f"{caption}; contributions to its variance")
    failed = f", {found.failed} without a result" if found.failed else ""
    decides = Paragraph(found.decides) if found.decides else _shares(found)
    body, drawn = body_blocks(found.body, found.gravity)
    sections = [
        ReportSection("Probabilities", [*map(Paragraph, found.sentences[1:]), picture, motion_table(found)]),
        ReportSection("Contributions to the variance", [decides]),
        ReportSection("The body", body),
        ReportSection("Ground motions: source and processing", [motion_sources(found.motions)]),
        _assumed(found),
        ReportSection("Method", [
            Paragraph(_PREDICTED), Paragraph(f"{_count(found)}{failed}; seed {found.seed}."), Paragraph(scale_words()),
            Paragraph(f"{SOFTWARE}."),
        ]),
    ]  # fmt: skip
    several = f"Under {len(found.motions)} motion{'' if len(found.motions) == 1 else 's'}"
    document = judged(name or "A body in an earthquake", (several, date), sections, found.verdict, mark)
    return document, {"prediction": lambda: prediction_picture(found), **drawn}


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
    sampled = [(name, words) for name, words in found.inputs.items() if name not in found.fixed]
    inputs = table("Sampled", ["input", "distribution"], sampled)
    left = table("Not sampled", ["input", "value in all histories"], found.fixed.items())
    return ReportSection("Inputs: sampled, not sampled, assumed", [
        *([inputs] if inputs.rows else []), left, *(Paragraph(each, "Assumed:") for each in found.assumed),
    ])  # fmt: skip


def _count(found: Prediction) -> str:
    return f"{found.count} bodies under each motion, {found.histories} histories in all"


def _shares(found: Prediction) -> ReportTable:
    note = "Sobol indices: contributions to the variance of overturning."
    return answer_table("", found.contributions, note=note)


def _event(event: str, found: Validation) -> ReportSection:
    picture = Picture(event, f"What was said of {event} and how often it happened; and the differences of scores")
    return ReportSection(event.capitalize(), [*map(Paragraph, found.sentences), picture, _scores(found)])


def _scores(found: Validation) -> ReportTable:
    rows = [{"forecast": name, **scores} for name, scores in found.answer()["scores"].items()]
    return answer_table("Scores of each forecast", rows, _SCORES)
