"""The reports of a measurement and of a folder of trials: verdict, picture, impacts, models and method."""

from collections.abc import Sequence

from rocking.conventions import FEET
from rocking.identification import Identification, ModelComparison
from rocking.identification.posterior import NO_SCATTER
from rocking.messages import Message
from rocking.plots.identification import identification_picture, trials_picture
from rocking.reports.document import (
    Content,
    Document,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    answer_table,
    judged,
    table,
)
from rocking.spec.identification import IdentifiedTrials

_HOW = (
    "Between two impacts the body rocks freely, which has a closed form. The coefficient of each impact is sampled "
    "about the mean of its side. Scatter, measurement noise, tilt of the floor and frequency parameter are fitted "
    "too, within the stated limits of the body. Intervals contain 95 % of the posterior."
)
_FORCED = (
    "Between two impacts the body follows its equation of motion under the recorded ground motion. Each half cycle "
    "begins at its measured state. The coefficient of each impact is sampled about the mean of its side. Intervals "
    "contain 95 % of the posterior."
)
_TRIALS = (
    "Each trial is identified separately. The mean is that of the logarithms, with Student's t interval from the "
    "scatter between trials. The interval is at least as wide as the intervals of the trials require. The interval "
    "includes the error of the body's size, which is common to all trials."
)


def identification_content(identification: Identification, *, name: str, date: str) -> Content:
    """Return the report of a measurement: verdict, picture, coefficients of the impacts, models and method."""
    return _document_of(identification, name, date), {"measured": lambda: identification_picture(identification)}


def trials_content(trials: IdentifiedTrials, *, name: str, date: str) -> Content:
    """Return the report of a folder of trials."""
    refused = [(row["trial"], row["refused"]) for row in trials.rows if row["refused"]]
    sections = [
        ReportSection("The trials", [
            Picture("trials", "Coefficient of each trial and of the mean, with intervals", 70),
            answer_table("", trials.good_rows, TRIAL),
            *([table("Trials without a coefficient", ["trial", "reason"], refused)] if refused else []),
            *([Paragraph(trials.passed_over_verdict)] if trials.passed_over else []),
        ]),
        *_doubts(trials.doubts),
        *_compared(trials.models),
        ReportSection("Method", [Paragraph(_HOW), Paragraph(_TRIALS)]),
    ]  # fmt: skip
    mark = "bad" if trials.mean is None else "fair" if refused or trials.doubts else "good"
    title, count = f"Coefficient of restitution: {name or trials.name}", f"{len(trials.rows)} trials"
    document = judged(title, (count, date), sections, trials.verdict, mark)
    return document, {"trials": lambda: trials_picture(trials)}


def _document_of(identification: Identification, name: str, date: str) -> Document:
    picture = Picture(
        "measured",
        "Above: measurement, and mean coefficient compared with the models. Below: residuals of the fit, and "
        "coefficient of each impact",
    )
    doubts = _doubts(identification.doubts)
    forced = [Paragraph(str(identification.forced))] if identification.forced else []
    sections = [ReportSection("Measurement", [picture]), *doubts]
    if not identification.refused:
        sections = [
            ReportSection("Result", [picture, _found(identification), *forced]),
            *doubts,
            *_compared(identification.models),
            ReportSection("Impacts", [_impacts(identification)]),
            *(
                [ReportSection("Design of a more precise experiment", [_designs(identification)])]
                if identification.designs
                else []
            ),
        ]
    sections.append(ReportSection("Method", [Paragraph(_FORCED if identification.forced else _HOW)]))
    mark = "bad" if identification.refused else "fair" if identification.doubts else "good"
    title = f"Coefficient of restitution{f': {name}' if name else ''}"
    return judged(title, (identification.source, date), sections, identification.verdict, mark)


def _doubts(doubts: Sequence[str | Message]) -> list[ReportSection]:
    return [ReportSection("Limitations", [Paragraph(str(doubt)) for doubt in doubts])] if doubts else []


def _found(identification: Identification) -> ReportTable:
    rows: list[tuple[str, object]] = [("mean coefficient of restitution r [-]", identification.mean)]
    rows += [(f"r landing {foot} [-]", identification.coefficients[foot]) for foot in FEET]
    rows += [
        ("scatter of ln r from impact to impact [-]", identification.scatter),
        (f"probability of no scatter (prior {NO_SCATTER:g}) [-]", f"{identification.no_scatter:.3g}"),
        ("frequency parameter p [rad/s]", identification.frequency_parameter),
        ("tilt of the floor, clockwise [rad]", identification.tilt),
    ]
    rows += [
        (f"position k of the impulse, landing {foot} [-]", value) for foot, value in identification.impulse.items()
    ]
    rows += [
        (f"{name} [-]", value) for name in ("trend", "damping") if (value := getattr(identification, name)) is not None
    ]
    return table("", ["quantity", "value and 95 % interval"], rows)


def _compared(models: tuple[ModelComparison, ...]) -> list[ReportSection]:
    compared = answer_table("", map(vars, models), COMPARED)
    return [ReportSection("Restitution models", [compared])] if models else []


TRIAL = ("trial", "coefficient", "scatter", "impacts")
IMPACT = ("number", "time", "foot", "speed", "coefficient")
COMPARED = ("model", "coefficient", "bias", "within")
DESIGN = ("release_ratio", "impacts", "timing_noise", "deviation")
"""Columns of the tables of an identification, in every output."""


def _impacts(identification: Identification) -> ReportTable:
    note = "The first and the last impact have no coefficient."
    return answer_table("", identification.answer()["impacts"], IMPACT, note)


def _designs(identification: Identification) -> ReportTable:
    note = "Deviations are lower bounds of any method, for the same scatter from impact to impact."
    return answer_table("", identification.answer()["designs"], DESIGN, note)
