"""Report of one body under one motion: body, energy loss of an impact, response, and commands for a new run."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking import checks
from rocking.answers import AnswerRows, Display
from rocking.bodies import Body
from rocking.bodies.body import assumed_rows
from rocking.conventions import DEFAULT_FRICTION, Assumed, Foot, given_or_assumed
from rocking.dynamics.response import Response
from rocking.dynamics.response_base import ResponseBase
from rocking.errors import InvalidValueError
from rocking.evidence._coefficient_table import CALIBRATED
from rocking.motions.intensity import Measure
from rocking.motions.pulse import Motion
from rocking.motions.summary import MotionSummary, support_of
from rocking.outcome import Outcome
from rocking.plots.body import body_picture, coefficient_picture
from rocking.plots.ground_motion import ground_motion_picture
from rocking.plots.labels import fine_samples
from rocking.plots.response import response_picture
from rocking.reports.body_facts import CLOSELY, ImpactAnswer
from rocking.reports.document import (
    Block,
    Content,
    Document,
    Listing,
    Pair,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    answer_table,
)
from rocking.reports.document import table as report_table
from rocking.reports.motion_sources import motion_doubts, motion_sources
from rocking.reports.response_facts import ModelAgreement, measure_quantities, measures_of, restitution_words
from rocking.version import SOFTWARE

_OUTCOMES = {Outcome.OVERTURNED: "overturns", Outcome.ROCKED: "does not overturn", Outcome.NO_UPLIFT: "no uplift"}
_MARKS = {Outcome.OVERTURNED: "bad", Outcome.ROCKED: "good", Outcome.NO_UPLIFT: "good"}
_KINDS = {"Block": "A rocking block", "MassPoints": "Rocking point masses"}
_LONGEST_LISTING = 12_000
_MOST_IMPACTS = 24
_FRICTION = ("friction_of_motion", "friction_of_impacts")


@dataclass(frozen=True)
class ResponseReport:
    """Inputs and results of a report."""

    impact: ImpactAnswer  # body and coefficients
    motion: Motion | None  # the scaled motion; None for free rocking
    measures: dict[str, Measure]  # intensity measures of the motion
    responses: Mapping[str, Response]  # responses by label of the restitution; at least one response
    refused: Mapping[str, str]  # reasons for missing responses, by label
    friction: float  # coefficient of friction between body and ground [-]
    name: str = ""  # name of the body
    date: str = ""  # day of the report
    toml: str = ""  # the inputs as an input file; empty for Python objects
    commands: Sequence[str] = ()  # commands that give the same result
    fingerprint: str = ""  # SHA-256 of the inputs


PICTURES = ("body", "coefficients", "motion", "response")
"""Stems of the pictures of a report. Free rocking has no picture ``motion``."""


def response_document(results: ResponseReport) -> Document:
    """Return the report."""
    title = results.name or _KINDS.get(type(results.impact.body).__name__, "A rocking body")
    first = next(iter(results.responses.values()))
    body = Picture("body", "The body on its feet O and O', with its centre of mass C")
    gravity = results.impact.gravity
    sections = [
        ReportSection("The body", [Pair(body, body_table("", results.impact.body, gravity))]),
        ReportSection("Energy loss at an impact", impact_blocks(results.impact)),
        ReportSection("The ground motion", ground_blocks(results.motion, results.measures)),
        ReportSection("The response", _response(results)),
        ReportSection("How to repeat the computation", _repetition(results, first)),
    ]
    about = ", ".join([SOFTWARE, *([f"inputs {results.fingerprint[:16]}"] if results.fingerprint else [])])
    subtitle = subtitle_of(results.motion, first.scale, results.date)
    return Document(title, subtitle, sections, verdict=_verdict(results), footer=about)


def subtitle_of(motion: Motion | None, scale: float, date: str) -> str:
    """Return the line below the title: the scaled motion and the day."""
    ground = "Free rocking, ground at rest" if motion is None else f"Under {motion.name}"
    scaled = f", scaled by {scale:g}" if scale != 1.0 else ""
    return ground + scaled + (f". {date}" if date else "")


def _verdict(results: ResponseReport) -> list[Paragraph]:
    label, first = next(iter(results.responses.items()))
    own = outcome_paragraph(first, label)
    verdict = ModelAgreement.of({restitution_words(label): response for label, response in results.responses.items()})
    if len(results.responses) == 1:
        return [own]
    return [own, Paragraph(verdict.sentence, "", "fair" if verdict.models_differ else "plain")]


def outcome_paragraph(response: ResponseBase, label: str) -> Paragraph:
    """Return the outcome of a response with a restitution, as a sentence in its colour."""
    summary = response.summary[:1].upper() + response.summary[1:] + "."
    return Paragraph(summary, f"With {restitution_words(label)}:", _MARKS.get(response.outcome, "plain"))


_OF_BODY = (
    "mass", "centre", "foot_positions", "moment_of_inertia", "slenderness_ratio", "slenderness_angle", "semi_diagonal",
    "frequency_parameter", "uplift_acceleration", "gravity",
)  # fmt: skip


def body_table(title: str, body: Body, gravity: float) -> ReportTable:
    """Return the data of a body under a gravity [m/s2]."""
    lines = [*Display().lines(body.answer(gravity).values, _OF_BODY, in_full=True)]
    return report_table(title, ["quantity", "value"], [lines[0], *assumed_rows(body), *lines[1:]])


def impact_blocks(impact: ImpactAnswer) -> list[Block]:
    """Return the coefficients of all models for a body, with their warnings."""
    tables = [_coefficients(impact, foot) for foot in impact.tables]
    rows = [row for table in impact.tables.values() for row in table]
    notes = dict.fromkeys(f"{restitution_words(row.name)}: {warning}" for row in rows for warning in row.warnings)
    picture = Picture("coefficients", "All models for this body, compared with the published measurements")
    return [picture, *tables, *(Paragraph(note, "", "fair") for note in notes)]


def ground_blocks(motion: Motion | None, measures: Mapping[str, Measure]) -> list[Block]:
    """Return picture, intensity and source of the scaled motion of a response."""
    if motion is None:
        return [Paragraph("Free rocking: the body starts from an initial rotation, and the ground is at rest.")]
    caption = (
        f"Acceleration, velocity and displacement of the {support_of(motion)}, and the response spectrum for "
        "5 % damping"
    )
    summary = [MotionSummary.of(motion)]
    return [Picture("motion", caption, 74), *motion_doubts(summary), _measures(measures), motion_sources(summary)]


def _response(results: ResponseReport) -> list[Block]:
    several = len(results.responses) > 1
    caption = "Responses with all models" if several else "Rotation, velocity, energy and friction demand"
    first_label, first = next(iter(results.responses.items()))
    blocks: list[Block] = [Picture("response", caption, 80), _outcomes(results.responses, results.friction)]
    blocks += [Paragraph(reason, f"{restitution_words(label)}:", "fair") for label, reason in results.refused.items()]
    for label, response in results.responses.items():
        blocks += [
            Paragraph(doubt, f"{restitution_words(label)}:", "fair") for doubt in response.doubts(results.friction)
        ]
    return [*blocks, impact_table(first_label, first.impacts)] if first.impacts.size else blocks


def _repetition(results: ResponseReport, first: Response) -> list[Block]:
    toml = results.toml
    if not toml:
        return [Paragraph(f"{SOFTWARE}.", "Software"), Paragraph(method_words(first, first.energy.closure), "Method")]
    if len(toml) > _LONGEST_LISTING:
        toml = toml[:_LONGEST_LISTING] + "\n# ... truncated: the file contains the complete input"
    return [
        Listing(toml.rstrip("\n"), "Save this text as response.toml in the folder of the record, if there is one:"),
        Listing("\n".join(results.commands), "Commands that give the same numbers:"),
        Paragraph(f"{SOFTWARE}; SHA-256 of the inputs: {results.fingerprint}.", "Software"),
        Paragraph(method_words(first, first.energy.closure), "Method"),
    ]


def method_words(response: ResponseBase, closure: float) -> str:
    """Return engine and settings of a response, and its energy balance error divided by the largest energy."""
    settings = "; ".join(f"{name.replace('_', ' ')} {value}" for name, value in response.settings.stated.items())
    return f"engine {response.engine}; {settings}; energy balance error {closure:.1e} of the largest energy."


def _coefficients(answer: ImpactAnswer, foot: Foot) -> ReportTable:
    rows = [
        {**row.answer().values, "model": restitution_words(row.name),
         "notes": "see below" if row.warnings else "fitted" if row.name == CALIBRATED else ""}
        for row in answer.tables[foot]
    ]  # fmt: skip
    note = (
        "r: velocity after the impact over velocity before. The interval applies to one measured body and follows from "
        "each model's misfit to the published measurements. k: impulse position over half the base width."
    )
    where = f", landing on the {foot} foot" if len(answer.tables) > 1 else ""
    names = ("model", "coefficient", "impulse_ratio", "energy_loss", "friction_demand", "notes")
    marks = {"notes": ["fair"] * len(rows)}
    caption = f"Coefficient of restitution{where}"
    return answer_table(caption, rows, names, note, display=Display(own=CLOSELY), marks=marks)


def _measures(measures: Mapping[str, Measure]) -> ReportTable:
    display = Display(own=measure_quantities(measures))
    lines = display.lines({name: measure.value for name, measure in measures.items()}, [*measures], in_full=True)
    return report_table("Intensity of the motion", ["measure", "value"], lines)


def _outcomes(responses: Mapping[str, Response], friction: float) -> ReportTable:
    rows = [_outcome(label, response) for label, response in responses.items()]
    note = (
        "A peak above 1 means that the centre of mass passed the foot and returned. Friction demand: largest ratio of "
        "horizontal to vertical force; during rocking, the body has contact at one foot. Coefficient of friction: "
        f"{friction:g}, {given_or_assumed(friction)}."
    )
    marks = {name: ["bad" if row[name] > friction else "plain" for row in rows] for name in _FRICTION}
    marks["outcome"] = [_MARKS.get(response.outcome, "plain") for response in responses.values()]
    return answer_table("Outcome", rows, (), note, marks=marks)


def impact_table(label: str, impacts: np.ndarray) -> ReportTable:
    """Return the first impacts of a response with a restitution."""
    shown = impacts[:_MOST_IMPACTS]
    rows = AnswerRows({"number": [*range(1, shown.size + 1)], **AnswerRows.of(shown).columns})
    left = impacts.size - shown.size
    note = f"{left} more impacts, decreasing; the table of impacts contains all." if left > 0 else ""
    return answer_table(f"Impacts with {restitution_words(label)}", rows, (), note, display=Display(own=CLOSELY))


def _outcome(label: str, response: Response) -> dict[str, Any]:
    answer, contact = response.outcome_answer(), response.contact
    is_overturned = response.outcome is Outcome.OVERTURNED
    return {
        "restitution": restitution_words(label),
        **{f"coefficient_{foot}": r for foot, r in answer["coefficient"].items()},
        "outcome": _OUTCOMES[response.outcome] + (f" to the {answer['side']}" if is_overturned else ""),
        **{name: None if is_overturned else answer[name] for name in ("peak_rotation", "peak_ratio")},
        "impacts": answer["impacts"],
        **{name: getattr(contact, name) for name in _FRICTION},
    }


def inputs_of(response: Any, body: Body) -> tuple[ImpactAnswer, Motion | None, dict[str, Measure]]:
    """Return the impact of a body, and the scaled motion of its response with the intensity measures."""
    if response.outcome is Outcome.FAILED:
        raise InvalidValueError("the response has no result to report: {reason}", reason=response.summary)
    impact = ImpactAnswer.of(body, None, foot="both", gravity=response.settings.gravity, identities=False)
    motion, scale = response.motion, response.scale
    if motion is not None and scale != 1.0:
        motion = motion.scaled(scale)
    return impact, motion, {} if motion is None or scale == 0.0 else measures_of(motion, fine_samples(motion))


def response_content(response: Response, *, name: str, date: str, friction: float = DEFAULT_FRICTION) -> Content:
    """Return the report of a response: body, energy loss at an impact, ground motion, response and pictures."""
    friction = friction if isinstance(friction, Assumed) else checks.positive("friction", friction)
    impact, motion, measures = inputs_of(response, response.body)
    responses = {response.parameters.label: response}
    document = response_document(ResponseReport(impact, motion, measures, responses, {}, friction, name, date))
    pictures: dict[str, Callable[[], Any]] = {
        "body": lambda: body_picture(response.body),
        "coefficients": lambda: coefficient_picture(response.body, impact.tables),
        "response": lambda: response_picture(response, friction),
    }
    if motion is not None:
        pictures["motion"] = lambda: ground_motion_picture(motion)
    return document, pictures
