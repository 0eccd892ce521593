"""The report of one body under one motion: what it is, what an impact costs, how it rocks, and how to do it again."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rocking.bodies import Body
from rocking.conventions import FEET, g
from rocking.dynamics.response import Motion, Response
from rocking.motions.intensity import Measure
from rocking.outcome import Outcome
from rocking.reports.document import Paragraph, ReportTable, cell
from rocking.reports.facts.body import side_facts
from rocking.reports.facts.impact import ImpactAnswer
from rocking.reports.facts.verdict import ModelAgreement
from rocking.reports.facts.words import restitution_words
from rocking.reports.response_blocks import Block, Image, Listing, PagePart, Pages, Pair
from rocking.reports.response_tables import (
    coefficients_table,
    impacts_table,
    measures_table,
    outcomes_table,
)

_MARKS = {Outcome.OVERTURNED: "bad", Outcome.ROCKED: "good", Outcome.NO_UPLIFT: "good"}
_KINDS = {"Block": "A rocking block", "MassPoints": "Rocking point masses"}
_LONGEST_LISTING = 12_000


@dataclass(frozen=True)
class ReportSubject:
    """What a report is about."""

    name: str  # what the user calls the body; perhaps empty
    date: str  # day of the report; perhaps empty
    toml: str  # the inputs as a file of the command line
    commands: Sequence[str]  # what to type for the same result
    fingerprint: str  # SHA-256 of the inputs
    software: str  # name and version


@dataclass(frozen=True)
class ReportResults:
    """What was computed."""

    impact: ImpactAnswer  # body and coefficients
    motion: Motion | None  # the motion, scaled; None for free rocking
    measures: dict[str, Measure]  # its intensity measures
    responses: Mapping[str, Response]  # by label of the restitution; at least one
    refused: Mapping[str, str]  # by label: why there is none
    friction: float  # coefficient of friction between body and ground [-]


PICTURES = ("body", "coefficients", "motion", "response")
"""Stems of the pictures of a report; ``motion`` is left out for free rocking."""


def response_pages(asked: ReportSubject, found: ReportResults) -> Pages:
    """Return the report."""
    body = found.impact.body
    title = asked.name or _KINDS.get(type(body).__name__, "A rocking body")
    parts = [
        PagePart(
            "The body", [Pair(Image("body", "The body on its feet O and O', with its centre of mass C"), _body(found))]
        ),
        PagePart("What an impact costs", _impact(found)),
        PagePart("The ground", _ground(found)),
        PagePart("The response", _response(found)),
        PagePart("To do it again", _again(asked, next(iter(found.responses.values())))),
    ]
    about = f"{asked.software}, inputs {asked.fingerprint[:16]}"
    return Pages(title, _subtitle(asked, found), _verdict(found), parts, about)


def _subtitle(asked: ReportSubject, found: ReportResults) -> str:
    first = next(iter(found.responses.values()))
    ground = "let go, the ground at rest" if found.motion is None else f"under {found.motion.name}"
    if first.scale != 1.0:
        ground = f"{ground}, scaled by {first.scale:g}"
    return ground[:1].upper() + ground[1:] + (f". {asked.date}" if asked.date else "")


def _verdict(found: ReportResults) -> list[Paragraph]:
    label, first = next(iter(found.responses.items()))
    words = first.summary[:1].upper() + first.summary[1:] + "."
    made = [Paragraph(words, f"With {restitution_words(label)}:", _MARKS.get(first.outcome, "plain"))]
    verdict = ModelAgreement.of({restitution_words(label): one for label, one in found.responses.items()})
    if len(found.responses) > 1:
        made.append(Paragraph(verdict.sentence, "", "fair" if verdict.decides else "plain"))
    return made


def _body(found: ReportResults) -> ReportTable:
    body, gravity = found.impact.body, found.impact.gravity
    x, y = body.centre
    rows = [
        ("mass", f"{body.mass:.5g} kg"),
        *(("density", sentence.removeprefix("density ")) for sentence in body.assumed),
        ("centre of mass", f"x = {x:.4g} m, y = {y:.4g} m"),
        ("feet", f"x = {body.feet[0]:.4g} m and {body.feet[1]:.4g} m"),
        ("moment of inertia", f"{body.moment_of_inertia:.5g} kg m\N{SUPERSCRIPT TWO} about the centre"),
        *_sides(body, gravity),
        ("gravity", f"{gravity:.6g} m/s\N{SUPERSCRIPT TWO}"),
    ]
    return ReportTable("", ["quantity", "value"], [[cell(name), cell(value)] for name, value in rows])


def _sides(body: Body, gravity: float) -> list[tuple[str, str]]:
    rows: list[tuple[str, str]] = []
    for foot in FEET if not body.is_symmetric else FEET[-1:]:
        side = side_facts(body, foot, gravity)
        on = "" if body.is_symmetric else f", {foot} foot"
        angle, uplift = side["slenderness_angle_rad"], side["uplift_acceleration_m_s2"]
        rows += [
            (f"slenderness h/b{on}", f"{side['slenderness_ratio']:.4g}"),
            (f"slenderness angle{on}", f"{angle:.5g} rad = {math.degrees(angle):.4g}\N{DEGREE SIGN}"),
            (f"semi-diagonal R{on}", f"{side['semi_diagonal_m']:.5g} m"),
            (f"frequency parameter p{on}", f"{side['frequency_parameter_rad_s']:.5g} rad/s"),
            (f"lifts from{on}", f"{uplift:.4g} m/s\N{SUPERSCRIPT TWO} = {uplift / g:.3g} g"),
        ]
    return rows


def _impact(found: ReportResults) -> list[Block]:
    tables = [coefficients_table(found.impact, foot) for foot in found.impact.tables]
    rows = [row for table in found.impact.tables.values() for row in table]
    said = dict.fromkeys(f"{restitution_words(row.name)}: {warning}" for row in rows for warning in row.warnings)
    picture = Image("coefficients", "Every model for this body, and where it lies among the published measurements")
    return [picture, *tables, *(Paragraph(words, "", "fair") for words in said)]


def _ground(found: ReportResults) -> list[Block]:
    if found.motion is None:
        return [Paragraph("Free rocking: the body is let go, and the ground stays at rest.")]
    caption = "Acceleration, velocity and displacement of the ground, and the response spectrum for 5 % damping"
    return [Image("motion", caption, 74), measures_table(found.measures)]


def _response(found: ReportResults) -> list[Block]:
    several = len(found.responses) > 1
    caption = "The models over one another" if several else "Rotation, velocity, energy and the friction that is taken"
    first_label, first = next(iter(found.responses.items()))
    blocks: list[Block] = [Image("response", caption, 80), outcomes_table(found.responses, found.friction)]
    blocks += [Paragraph(why, f"{restitution_words(label)}:", "fair") for label, why in found.refused.items()]
    for label, response in found.responses.items():
        blocks += [
            Paragraph(words, f"{restitution_words(label)}:", "fair") for words in response.doubts(found.friction)
        ]
    return [*blocks, impacts_table(first_label, first)] if first.impacts.size else blocks


def _again(asked: ReportSubject, first: Response) -> list[Block]:
    toml = asked.toml
    if len(toml) > _LONGEST_LISTING:
        toml = toml[:_LONGEST_LISTING] + "\n# ... cut off here: the file itself has all of it"
    return [
        Listing(toml.rstrip("\n"), "This file, saved as response.toml beside the record if there is one:"),
        Listing("\n".join(asked.commands), "gives the same numbers on the command line:"),
        Paragraph(f"{asked.software}; SHA-256 of the inputs: {asked.fingerprint}.", "Made with"),
        Paragraph(_how(first), "Computed with"),
    ]


def _how(first: Response) -> str:
    told = "; ".join(f"{name.replace('_', ' ')} {value}" for name, value in first.settings.stated.items())
    return f"engine {first.engine}; {told}; energy adds up to {first.energy.closure:.1e} of its largest."
