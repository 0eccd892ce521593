"""The reports of a measurement and of a folder of trials: verdict, picture, what impacts took, models, how it was."""

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
    "Between two impacts the body rocks freely, which has a closed form. At every impact the coefficient is drawn "
    "about a mean of its side, with a scatter that is fitted too; so are the noise of the measurement, the "
    "tilt of the floor and the frequency parameter, within what is known of the body. Intervals are of 95 %, of the "
    "posterior."
)
_FORCED = (
    "Between two impacts the body follows its equation of motion under the ground that was recorded. Half cycles begin "
    "anew where they were measured; at every impact the coefficient is drawn about a mean of its side. Intervals are "
    "of 95 %, of the posterior."
)
_TRIALS = (
    "Each trial is looked at by itself. The mean is that of the logarithms, with Student's t interval from how trials "
    "differ, never narrower than their own intervals allow; the error of the size of the body, common to all, is in it."
)


def identification_content(found: Identification, *, name: str, date: str) -> Content:
    """Return the report of a measurement: verdict, picture, what each impact took, the models, and how it was found."""
    return _document_of(found, name, date), {"measured": lambda: identification_picture(found)}


def trials_content(found: IdentifiedTrials, *, name: str, date: str) -> Content:
    """Return the report of a folder of trials."""
    refused = [(row["trial"], row["refused"]) for row in found.rows if row["refused"]]
    sections = [
        ReportSection("The trials", [
            Picture("trials", "The coefficient of every trial with its interval, and that of the mean", 70),
            answer_table("", found.good_rows, TRIAL),
            *([table("Trials without a coefficient", ["trial", "why"], refused)] if refused else []),
            *([Paragraph(found.passed_over_verdict)] if found.passed_over else []),
        ]),
        *_doubts(found.doubts),
        *_compared(found.models),
        ReportSection("How it was found", [Paragraph(_HOW), Paragraph(_TRIALS)]),
    ]  # fmt: skip
    mark = "bad" if found.mean is None else "fair" if refused or found.doubts else "good"
    title, count = f"Coefficient of restitution: {name or found.name}", f"{len(found.rows)} trials"
    document = judged(title, (count, date), sections, found.verdict, mark)
    return document, {"trials": lambda: trials_picture(found)}


def _document_of(found: Identification, name: str, date: str) -> Document:
    picture = Picture(
        "measured",
        "Above: what was measured, and the mean coefficient with the models beside it. Below: what the fit leaves "
        "over, and what each impact took",
    )
    doubts = _doubts(found.doubts)
    forced = [Paragraph(str(found.forced))] if found.forced else []
    sections = [ReportSection("What was measured", [picture]), *doubts]
    if not found.refused:
        sections = [
            ReportSection("What was found", [picture, _found(found), *forced]),
            *doubts,
            *_compared(found.models),
            ReportSection("What each impact took", [_impacts(found)]),
            *([ReportSection("What experiment would tell more", [_designs(found)])] if found.designs else []),
        ]
    sections.append(ReportSection("How it was found", [Paragraph(_FORCED if found.forced else _HOW)]))
    mark = "bad" if found.refused else "fair" if found.doubts else "good"
    title = f"Coefficient of restitution{f': {name}' if name else ''}"
    return judged(title, (found.source, date), sections, found.verdict, mark)


def _doubts(doubts: Sequence[str | Message]) -> list[ReportSection]:
    return (
        [ReportSection("What there is to say against it", [Paragraph(str(doubt)) for doubt in doubts])]
        if doubts
        else []
    )


def _found(found: Identification) -> ReportTable:
    rows: list[tuple[str, object]] = [("mean coefficient of restitution r [-]", found.mean)]
    rows += [(f"r landing {foot} [-]", found.coefficients[foot]) for foot in FEET]
    rows += [
        ("scatter of ln r from impact to impact [-]", found.scatter),
        (f"probability of no scatter, {NO_SCATTER:g} before the measurement [-]", f"{found.no_scatter:.3g}"),
        ("frequency parameter p [rad/s]", found.frequency_parameter),
        ("tilt of the floor, clockwise [rad]", found.tilt),
    ]
    rows += [(f"position k of the impulse, landing {foot} [-]", each) for foot, each in found.impulse.items()]
    rows += [(f"{name} [-]", each) for name in ("trend", "damping") if (each := getattr(found, name)) is not None]
    return table("", ["what", "value and 95 % interval"], rows)


def _compared(models: tuple[ModelComparison, ...]) -> list[ReportSection]:
    compared = answer_table("", map(vars, models), COMPARED)
    return [ReportSection("Models of restitution beside it", [compared])] if models else []


TRIAL = ("trial", "coefficient", "scatter", "impacts")
IMPACT = ("number", "time", "onto", "speed", "coefficient")
COMPARED = ("model", "coefficient", "bias", "within")
DESIGN = ("release_ratio", "impacts", "timing_noise", "deviation")
"""Columns of the tables of an identification, on every door."""


def _impacts(found: Identification) -> ReportTable:
    note = "Of the first impact and of the last nothing is known."
    return answer_table("", found.answer()["impacts"], IMPACT, note)


def _designs(found: Identification) -> ReportTable:
    note = "Bounds: no method does better with the same scatter from impact to impact."
    return answer_table("", found.answer()["designs"], DESIGN, note)
