"""The reports of a prediction and of a validation: verdict, pictures, tables and assumptions."""

from functools import partial

from rocking.decision.prediction import Prediction, Validation
from rocking.decision.prediction.forecast import input_label
from rocking.decision.prediction.likelihood import scale_words
from rocking.plots.prediction import prediction_picture, reliability_picture
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
from rocking.reports.motion_sources import motion_doubts, motion_sources, motion_table
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
    "Bodies are sampled from the distributions of the uncertain inputs and simulated under the motion of each trial. "
    "The prediction is not fitted to the outcomes. The simple curves are fitted to the outcomes under all other "
    "motions. The 95 % intervals are from a bootstrap that resamples motions; differences are resampled in pairs. The "
    "verdict uses the differences of the Brier and the logarithmic score, because balanced accuracy ignores the "
    "probability of a forecast."
)


def prediction_content(prediction: Prediction, *, name: str, date: str) -> Content:
    """Return the report of a prediction: verdict, probabilities and their condition, body, motions and inputs."""
    mark = next((word for limit, word in _MARKS if prediction.chances["overturning"].high <= limit), "bad")
    caption = "Probability of overturning and of rocking under each motion"
    picture = Picture("prediction", caption if prediction.decides else f"{caption}; contributions to its variance")
    failed = f", {prediction.failed} without a result" if prediction.failed else ""
    contributions = Paragraph(prediction.decides) if prediction.decides else _shares(prediction)
    body, pictures = body_blocks(prediction.body, prediction.gravity)
    sections = [
        ReportSection("Probabilities", [*map(Paragraph, prediction.sentences[1:]), picture, motion_table(prediction)]),
        ReportSection("Contributions to the variance", [contributions]),
        ReportSection("The body", body),
        ReportSection("Ground motions: source and processing", [
            *motion_doubts(prediction.motions), motion_sources(prediction.motions),
        ]),
        _assumed(prediction),
        ReportSection("Method", [
            Paragraph(_PREDICTED), Paragraph(f"{_count(prediction)}{failed}; seed {prediction.seed}."),
            Paragraph(scale_words()), Paragraph(f"{SOFTWARE}."),
        ]),
    ]  # fmt: skip
    motions_text = f"Under {len(prediction.motions)} motion{'' if len(prediction.motions) == 1 else 's'}"
    document = judged(name or "A body in an earthquake", (motions_text, date), sections, prediction.verdict, mark)
    return document, {"prediction": lambda: prediction_picture(prediction), **pictures}


def validation_content(validations: FolderValidation, *, name: str, date: str) -> Content:
    """Return the report of a validation: verdict, reliability diagram, scores and assumptions."""
    rows = [(str(row.line), row.reason) for row in validations.refused]
    left_out = [table(f"Rows of {validations.source} that cannot be used", ["line", "reason"], rows)] if rows else []
    count = Paragraph(f"{_count(validations.prediction)}.")
    sections = [
        *(_event(event, row) for event, row in validations.scores.items()),
        _assumed(validations.prediction),
        ReportSection("Method", [Paragraph(_VALIDATED), count, *left_out]),
    ]
    first = next(iter(validations.scores.values()))
    mark = _MARKS_OF_FINDINGS["mixed" if first.finding == "better" and first.too_sure else first.finding]
    outcomes_text = f"{first.count} outcomes under {first.clusters} motions"
    document = judged(
        f"Predictions of {name or validations.name}", (outcomes_text, date), sections, first.verdict, mark
    )
    return document, {event: partial(reliability_picture, row) for event, row in validations.scores.items()}


def _assumed(prediction: Prediction) -> ReportSection:
    fixed = prediction.fixed
    sampled = [(input_label(name), text) for name, text in prediction.inputs.items() if name not in fixed]
    inputs = table("Sampled", ["input", "distribution"], sampled)
    not_sampled = table(
        "Not sampled", ["input", "value in all histories"], [(input_label(name), fixed[name]) for name in fixed]
    )
    return ReportSection("Inputs: sampled, not sampled, assumed", [
        *([inputs] if inputs.rows else []), not_sampled,
        *(Paragraph(assumption, "Assumed:") for assumption in prediction.assumed),
    ])  # fmt: skip


def _count(prediction: Prediction) -> str:
    return f"{prediction.count} bodies under each motion, {prediction.histories} histories in all"


def _shares(prediction: Prediction) -> ReportTable:
    note = "Sobol indices: contributions to the variance of overturning."
    return answer_table("", prediction.ranked_contributions, note=note)


def _event(event: str, validation: Validation) -> ReportSection:
    picture = Picture(event, f"Predicted probability and observed frequency of {event}, and the differences of scores")
    return ReportSection(event.capitalize(), [*map(Paragraph, validation.sentences), picture, _scores(validation)])


def _scores(validation: Validation) -> ReportTable:
    rows = [{"forecast": name, **scores} for name, scores in validation.answer()["scores"].items()]
    return answer_table("Scores of each forecast", rows, _SCORES)
