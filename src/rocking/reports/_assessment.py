"""The report of an assessment: verdict, margins, probability, what governs, what to do, codes, assumptions, sources."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rocking.assessment import BodyAssessment
from rocking.assessment._assess import DIRECTIONS, POINTS, REACH
from rocking.assessment.answer import StandingSolid, just_above
from rocking.conventions import FEET
from rocking.dynamics import simulate
from rocking.evidence.measurements import provenance
from rocking.motions.components import leading
from rocking.motions.intensity import measure, sampled
from rocking.motions.summary import support_of
from rocking.outcome import Outcome
from rocking.plots.body import body_picture
from rocking.plots.ground_motion import ground_motion_picture
from rocking.plots.prediction import assessment_picture, prediction_picture
from rocking.plots.response import response_picture
from rocking.plots.solid import equilibria_picture
from rocking.plots.spatial import spatial_picture
from rocking.prediction.likelihood import scale_words
from rocking.reports.body_blocks import repairs_of
from rocking.reports.document import (
    Block,
    Content,
    Document,
    Pair,
    Paragraph,
    Picture,
    ReportSection,
    ReportTable,
    answer_table,
    table,
)
from rocking.reports.motion_sources import motion_sources, peak_display
from rocking.reports.response_document import body_table
from rocking.restitution import models
from rocking.studies.code_methods import CODE_METHODS, LEFT_OUT
from rocking.studies.remedies import ASSUMED, CALIBRATED
from rocking.version import SOFTWARE

_PLANE = "plane body"
_IN_SPACE = (
    "Histories: the ground is level, body and floor are rigid, the solid touches with all vertices of its hull, where "
    f"it may slide, hop and fly; it is turned into {2 * DIRECTIONS} directions unless its azimuth is known: behind a "
    "motion's name stands where its weakest side then faces, from x towards y. The least factor is looked for at "
    f"{POINTS} levels in equal ratios, from what lifts the body up to {REACH:g} times that or the "
    "largest acceleration on record, then by halvings: a thinner stretch below may have been missed. It overturned "
    "where it ends in another pose, more than 10 degrees away. Code methods and remedies are those of a plane body, "
    "which the table of the body states: what happens in space alone they do not see.",
)
_SEARCHED = (
    "Histories: the ground is level, body and floor are rigid, the body stands on two feet. The least factor is looked "
    "for at 64 levels in equal ratios, from what lifts the body up to 50 times that or the largest acceleration on "
    "record, then by halvings: a thinner stretch below may have been missed. Both ways round are computed.",
    "Remedies: the least change is looked for at 32 steps up to the one that keeps the body from lifting, and is that "
    "from which on all that were tried stand, with every model, at 0.6 to 1 times what is asked, and whose least "
    "factor, looked for as above, is more; what is changed is a block with the coefficients of the body, moved by "
    "what the models say of the change.",
)


def assessment_content(found: BodyAssessment, *, name: str, date: str, project: str = "", author: str = "") -> Content:
    """Return the report of an assessment, to be signed: verdict, evidence, what to do, assumptions and references."""
    drawn, solid = governing_history(found), found.standing
    pictures: dict[str, Callable[[], Any]] = {
        "body": lambda: body_picture(found.body) if solid is None else equilibria_picture(solid.solid, solid.pose),
        "margins": lambda: assessment_picture(found),
        "prediction": lambda: prediction_picture(found.prediction),
        "motion": lambda: ground_motion_picture(leading(drawn.motion)),
        "response": lambda: (
            response_picture(drawn.history, found.friction) if solid is None else spatial_picture(drawn.history)
        ),
    }
    return assessment_document(found, name, {"project": project, "author": author, "date": date}, drawn), pictures


class Drawn(NamedTuple):
    """The history that is drawn, of which motion, and which it is in words."""

    history: Any
    motion: Any
    words: str


def governing_history(found: BodyAssessment) -> Drawn:
    """Return a history that overturns: under a motion as it is, that of the least margin first, or at the margin."""
    factor, model, motion, mirrored = found.lowest
    if found.standing is not None:
        return _governing_solid(found, found.standing)
    fell = [(name, k) for name, each in found.models.items() for k in np.flatnonzero(each.overturned == 1.0).tolist()]
    at, how = 1.0, "as it is"
    if fell:
        model, motion = min(fell, key=lambda one: (one[1] != motion, one[0] != model))
    elif math.isfinite(factor):
        at, how = just_above(factor), f"at {factor:.3g} times, the least factor that was found to overturn it"
    pair = found.models[model].coefficients
    swapped = {foot: pair[other] for foot, other in zip(FEET, FEET[::-1], strict=True)}
    for twin in (mirrored, not mirrored):
        body, own = (found.body.mirrored(), swapped) if twin else (found.body, pair)
        history = simulate(body, found.motions[motion], own, scale=at, gravity=found.gravity)
        if not fell or history.outcome is Outcome.OVERTURNED:
            break
    name = found.motions[motion].name
    return Drawn(history, found.motions[motion],
                 f"The body{' mirrored,' if twin else ''} under {name} {how}, with {model}")  # fmt: skip


def _governing_solid(found: BodyAssessment, solid: StandingSolid) -> Drawn:
    """Return the history of a solid at its least factor; under the first motion as it is where there is none."""
    factor, model, motion, _ = found.lowest
    at, how = (just_above(factor), f"at {factor:.3g} times") if math.isfinite(factor) else (1.0, "as it is")
    moved = found.motions[motion]
    history = simulate(
        solid.solid.turned(solid.turned), moved.parts, solid.restitution, friction=found.friction, scale=at,
        gravity=found.gravity, tolerance=1e-8,
    )  # fmt: skip
    azimuth = f"{math.degrees(solid.turned) % 360.0:.0f}"
    return Drawn(history, moved, f"The solid, its x axis at {azimuth} deg, under {moved.name} {how}, with {model}")


def assessment_document(found: BodyAssessment, name: str, signed: dict[str, str], drawn: Drawn) -> Document:
    """Return the content of the report of an assessment."""
    some = (found.fallen > 0.0).any() or found.lowest.factor < 1.0
    mark = "bad" if (found.fallen == 1.0).any() else "fair" if some else "good"
    margins = Picture("margins", "Least factor on each motion that overturns; code methods over it, unsafe above 1")
    how_likely = Picture("prediction", "How likely it overturns and rocks under each motion, and what decides it")
    moved = leading(drawn.motion)
    motion = Picture("motion", f"{moved.name}: motion of the {support_of(moved)}, response spectrum, 5 % damping", 74)
    searched = _SEARCHED[:1] if found.standing is None else _IN_SPACE
    under = f"{drawn.words}: {drawn.history.summary}"
    picture = [how_likely] if found.prediction.chances["overturning"].value > 0.0 else []
    sections = [
        ReportSection("Does it stand?", [margins, _models(found), _motions(found)]),
        ReportSection("What governs", [*map(Paragraph, found.governs)]),
        ReportSection("What to do", [*map(_led, found.to_do)]),
        ReportSection("How likely is it?", [*map(Paragraph, found.prediction.sentences), *picture]),
        ReportSection("Code methods beside it", [_codes(found)]),
        ReportSection("The body", _about(found)),
        ReportSection("Ground motions: source and processing", [motion_sources(found.prediction.motions)]),
        ReportSection("The governing motion and history", [motion, Picture("response", under, 80)]),
        ReportSection("What is known, and what was assumed", [
            table("", ["input", "distribution or value"], found.prediction.inputs.items()),
            *map(_led, (*searched, *_SEARCHED[1:], *ASSUMED, *found.prediction.assumed)),
            *(Paragraph(each, "Not sampled:") for each in found.prediction.not_sampled), Paragraph(scale_words()),
            *(Paragraph(why, f"{model} says nothing of this body:", "fair") for model, why in found.refused.items()),
        ]),
        ReportSection("References", [*map(_led, _references(found))]),
        ReportSection("Signed", [table("", ["", ""], [(key, words or "_" * 30) for key, words in
                                                      (*signed.items(), ("signature", ""))])]),
    ]  # fmt: skip
    several = f"Under {found.several}"
    head = ". ".join(filter(None, (several, signed["project"] if name else "", signed["author"], signed["date"])))
    verdict = [Paragraph(found.verdict, "", mark), *map(Paragraph, (found.margin_words, found.probability_words))]
    title = name or signed["project"] or "A body in an earthquake"
    return Document(title, head, sections, verdict=verdict, footer=SOFTWARE)


def _models(found: BodyAssessment) -> ReportTable:
    rows = found.model_rows
    note = (
        "r: velocity after an impact over velocity before. Smallest factor: on any motion, either way round; infinite "
        "where none that was tried overturns. The calibrated model's ends are those of 95 % for a single body."
    )
    if found.standing is not None:
        note += f" Histories in space with a friction of {found.friction:.3g}; r: in the plane of its {_PLANE}."
    marks = {"overturned": ["good" if row["overturned"].startswith("0 ") else "bad" for row in rows]}
    return answer_table("With each model of restitution", rows, (), note, marks=marks)


def _motions(found: BodyAssessment) -> ReportTable:
    least = np.fmin.reduce([np.fmin.reduce(each.least) for each in found.models.values()])
    worst = [min(np.flatnonzero(found.records == k).tolist(), key=lambda j: np.nan_to_num(least[j], nan=np.inf))
             for k in np.unique(found.records)]  # fmt: skip
    count = len(found.models)
    ranked = sorted(zip(worst, found.fallen, strict=True), key=lambda pair: least[pair[0]])
    rows = [
        {
            "motion": found.motions[j].name, "pga": found.motions[j].peak, "pgv": _pgv(found.motions[j]),
            "uplift_factors": found.lifts[j], "min_factor": least[j], "overturned": f"{fallen * count:.0f} of {count}",
        }
        for j, fallen in ranked
    ]  # fmt: skip
    note = (
        "Factors on the motion as it is; of two components in the direction of the least. Overturns at: the least "
        "factor with any model; what overturns under less may stand under the motion as it is, where no model then "
        "falls, and that is no margin."
    )
    marks = {"overturned": ["bad" if fallen > 0.0 else "good" for _, fallen in ranked]}
    display = peak_display(found.prediction.motions)
    return answer_table("Under each motion", rows, (), note, display=display, marks=marks)


def _pgv(motion: Any) -> float:
    return measure("pgv").of(sampled(leading(motion)))


def _led(words: str) -> Paragraph:
    """Return a paragraph whose first words stand out."""
    lead, colon, rest = words.partition(": ")
    return Paragraph(rest, f"{lead}:") if colon else Paragraph(words)


def _codes(found: BodyAssessment) -> ReportTable:
    methods = [CODE_METHODS[row["method"]] for row in found.code_rows]
    rows = [
        {**row, "method": each.title, "vertical motion": each.vertical.value}
        for row, each in zip(found.code_rows, methods, strict=True)
    ]
    note = (
        "Overturned: of those rated safe, with some model. Up to factor: the least on any motion that it still calls "
        f"safe. Vertical motion: in {found.vertical} of {len(found.motions)} motions. Left out: "
        f"{'; '.join(f'{name} ({why})' for name, why in LEFT_OUT.items())}."
    )
    return answer_table("", rows, (), note)


def _about(found: BodyAssessment) -> list[Block]:
    if found.standing is None:
        return [Pair(Picture("body", "The body on its feet O and O'"), body_table("", found.body, found.gravity))]
    repairs = repairs_of(found.standing.solid)
    title = f"The {_PLANE} of {math.degrees(found.standing.plane) % 360.0:.0f} deg"
    return [
        *map(Paragraph, found.standing.words),
        Picture("body", "How much the centre must rise to topple it, by direction; what it stands on, and its sides"),
        body_table(title, found.body, found.gravity),
        *repairs,
    ]


def _references(found: BodyAssessment) -> list[str]:
    kinds, source = models(), provenance()
    used = [kinds[name] for name in dict.fromkeys(each.partition(":")[0] for each in found.models) if name in kinds]
    measured = [f"measurements: {source['source']}, doi:{source['doi']}"] if CALIBRATED in found.models else []
    named = [f"{kind.name}: {kind.reference}" for kind in used]
    return [
        *measured,
        *named,
        *(f"{one.title}: {one.reference}. Our reading: {one.reading}" for one in CODE_METHODS.values()),
    ]
