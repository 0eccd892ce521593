"""Report of a body with restraints: body, restraints, energy loss of an impact, motion, response, forces."""

import math
from collections.abc import Callable
from typing import Any

from rocking.answers import Display
from rocking.dynamics.restrained.response import RestrainedResponse
from rocking.dynamics.restrained.rows import uplift_accelerations
from rocking.dynamics.restrained.settings import RestrainedStudySettings
from rocking.outcome import Outcome
from rocking.plots.body import body_picture, coefficient_picture
from rocking.plots.ground_motion import ground_motion_picture
from rocking.plots.restrained import loops_picture, restrained_picture
from rocking.reports.document import Block, Content, Document, Pair, Paragraph, Picture, ReportSection, answer_table
from rocking.reports.document import table as report_table
from rocking.reports.response_document import (
    body_table,
    ground_blocks,
    impact_blocks,
    impact_table,
    inputs_of,
    method_words,
    outcome_paragraph,
    subtitle_of,
)
from rocking.version import SOFTWARE

_PEAKS = (
    "peak_rotation", "peak_ratio", "residual_rotation", "uplift_height", "impacts", "largest_base_shear",
    "largest_overturning_moment", "least_force",
)  # fmt: skip
_LAWS = ("restraint", "force_law", "ground_point", "body_point", "law_constants")
_RESTRAINTS = (
    "restraint", "largest_force", "smallest_force", "largest_elongation", "yield_count", "is_broken", "residual_force",
    "residual_slack", "dissipated_energy",
)  # fmt: skip
_EVENTS = ("time", "restraint", "restraint_phase", "rotation", "elongation", "restraint_force")
_MOST_EVENTS = 40
_IMPULSES = (
    "Restraints have finite forces, and give no impulse at an impact: the coefficients are those of the body without "
    "restraints (Dimitrakopoulos & DeJong 2012). Tests of walls with tendons and fuses report other energy losses."
)


def restrained_content(response: RestrainedResponse, *, name: str, date: str) -> Content:
    """Return the report of a response with restraints, and the functions that draw its pictures."""
    body, label = response.body.body, response.parameters.label
    impact, motion, measures = inputs_of(response, body)
    sections = [
        ReportSection("The body", [
            Pair(Picture("body", "The body with its restraints, on its feet O and O', with its centre of mass C"),
                 body_table("", body, response.settings.gravity)),
        ]),
        ReportSection("The restraints", [_laws(response), _uplift(response)]),
        ReportSection("Energy loss at an impact", [*impact_blocks(impact), Paragraph(_IMPULSES)]),
        ReportSection("The ground motion", ground_blocks(motion, measures)),
        ReportSection("The response", _response(response, label)),
        ReportSection("Method", [
            Paragraph(f"{SOFTWARE}.", "Software"),
            Paragraph(method_words(response, response.energy_closure), "Method"),
        ]),
    ]  # fmt: skip
    document = Document(
        name or "A body with restraints", subtitle_of(response.motion, response.scale, date), sections,
        verdict=[outcome_paragraph(response, label), *_damage(response)], footer=SOFTWARE,
    )  # fmt: skip
    pictures: dict[str, Callable[[], Any]] = {
        "body": lambda: body_picture(response.body),
        "coefficients": lambda: coefficient_picture(body, impact.tables),
        "response": lambda: restrained_picture(response),
        "loops": lambda: loops_picture(response),
    }
    if motion is not None:
        pictures["motion"] = lambda: ground_motion_picture(motion)
    return document, pictures


def _laws(response: RestrainedResponse) -> Block:
    rows = response.body.answer(response.settings.gravity)["restraint_laws"]
    return answer_table("Force laws", rows, _LAWS, "Points x, z: x as for the feet, z upwards from the ground.")


def _uplift(response: RestrainedResponse) -> Paragraph:
    settings = RestrainedStudySettings(**response.settings.stated, body=response.body)
    values = [
        f"{value:.4g} m/s2 about the {foot} foot"
        if value < math.inf
        else f"no uplift about the {foot} foot at a rigid wall"
        for foot, value in zip(("right", "left"), uplift_accelerations(settings, 1)[:, 0], strict=True)
    ]
    return Paragraph(f"{', '.join(values)}.", "Ground acceleration at uplift, with prestress and slip forces:")


def _damage(response: RestrainedResponse) -> list[Paragraph]:
    """Return the yielded and the broken restraints, and the rotation that remains."""
    columns = response.restraints.columns
    damage = {"Broken:": columns["is_broken"], "Yielded:": columns["yield_count"]}
    return [
        Paragraph(", ".join(names) + ".", lead, "fair")
        for lead, flags in damage.items()
        if (names := [name for name, is_damaged in zip(columns["restraint"], flags, strict=True) if is_damaged])
    ]


def _response(response: RestrainedResponse, label: str) -> list[Block]:
    is_overturned = response.outcome is Outcome.OVERTURNED
    shown = [name for name in _PEAKS if not (is_overturned and name in {"peak_rotation", "peak_ratio"})]
    values = {**response.answer().values, "impacts": len(response.impacts)}
    events = response.restraint_events
    blocks: list[Block] = [
        Picture("response", "Ground acceleration, rotation, forces of the restraints, and work on the restraints", 80),
        *(Paragraph(doubt, "", "fair") for doubt in response.doubts()),
        report_table("Largest values", ["quantity", "value"], [*Display().lines(values, shown, in_full=True)]),
        answer_table("Restraints", response.restraints, _RESTRAINTS),
        Picture("loops", "Moment on the foundation against rotation; force against elongation of the restraints", 80),
    ]
    if len(events):
        first = {column: cells[:_MOST_EVENTS] for column, cells in events.columns.items()}
        left = len(events) - _MOST_EVENTS
        note = f"{left} more events; the table of events contains all." if left > 0 else ""
        blocks.append(answer_table("Events of restraints", type(events)(first), _EVENTS, note))
    return [*blocks, impact_table(label, response.impacts)] if response.impacts.size else blocks
