"""Report of an assessment: verdict, margins, probability, causes, measures, code methods, assumptions, sources."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rocking.conventions import FEET
from rocking.decision.assessment import BodyAssessment
from rocking.decision.assessment._assess import DIRECTIONS, POINTS, REACH
from rocking.decision.assessment.answer import StandingSolid, just_above
from rocking.decision.code_methods import CODE_METHODS, LEFT_OUT
from rocking.decision.prediction.likelihood import scale_words
from rocking.decision.remedies import ASSUMED, CALIBRATED
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
from rocking.reports.motion_sources import motion_doubts, motion_sources, peak_display
from rocking.reports.response_document import body_table
from rocking.restitution import models
from rocking.version import SOFTWARE

_PLANE = "plane body"
_IN_SPACE = (
    "Histories: the ground is level, and body and floor are rigid. The solid has contact at all vertices of its hull, "
    "and may slide, hop and fly. Unless the azimuth is stated, the solid is computed in "
    f"{2 * DIRECTIONS} directions. The angle after a motion's name is the direction of the weakest side, from x to y. "
    f"The smallest factor is searched at {POINTS} geometrically spaced levels, from uplift up to {REACH:g} times "
    "uplift or the largest recorded acceleration, then by bisection. A narrower interval of overturning below this "
    "factor may be missed. The solid has overturned if its final pose is another one, more than 10 degrees away. Code "
    "methods and measures apply to the plane body in the table of the body, and do not include 3D effects.",
)
_SEARCHED = (
    "Histories: the ground is level, body and floor are rigid, and the body has two feet. The smallest factor is "
    "searched at 64 geometrically spaced levels, from uplift up to 50 times uplift or the largest recorded "
    "acceleration, then by bisection. A narrower interval of overturning below this factor may be missed. Both "
    "polarities are computed.",
    "Measures: 32 changes are computed, up to the change that prevents uplift. The result is the smallest change from "
    "which on no computed body overturns, with every model, at 0.6 to 1 times the required factor. Its smallest "
    "overturning factor also exceeds the required factor. The changed body is a block with the coefficients of the "
    "original body, adjusted by the change that the models predict.",
)


def assessment_content(
    assessment: BodyAssessment, *, name: str, date: str, project: str = "", author: str = ""
) -> Content:
    """Return the report of an assessment for signature: verdict, evidence, measures, assumptions and references."""
    governing, standing = governing_history(assessment), assessment.standing
    pictures: dict[str, Callable[[], Any]] = {
        "body": lambda: (
            body_picture(assessment.body) if standing is None else equilibria_picture(standing.solid, standing.pose)
        ),
        "margins": lambda: assessment_picture(assessment),
        "prediction": lambda: prediction_picture(assessment.prediction),
        "motion": lambda: ground_motion_picture(leading(governing.motion)),
        "response": lambda: (
            response_picture(governing.history, assessment.friction)
            if standing is None
            else spatial_picture(governing.history)
        ),
    }
    return assessment_document(
        assessment, name, {"project": project, "author": author, "date": date}, governing
    ), pictures


class GoverningHistory(NamedTuple):
    """The history in the picture, with its motion and a description."""

    history: Any
    motion: Any
    description: str


def governing_history(assessment: BodyAssessment) -> GoverningHistory:
    """Return a history with overturning.

    The motion is unscaled if possible, preferably the motion with the smallest margin; otherwise it is scaled to this
    margin.
    """
    factor, model, motion, mirrored = assessment.lowest
    if assessment.standing is not None:
        return _governing_solid(assessment, assessment.standing)
    overturned = [
        (name, k)
        for name, margin in assessment.models.items()
        for k in np.flatnonzero(margin.overturned == 1.0).tolist()
    ]
    scale, scale_text = 1.0, "(unscaled)"
    if overturned:
        model, motion = min(overturned, key=lambda case: (case[1] != motion, case[0] != model))
    elif math.isfinite(factor):
        scale, scale_text = just_above(factor), f"scaled by {factor:.3g}, the smallest factor with overturning"
    as_given = assessment.models[model].coefficients
    swapped = {foot: as_given[other] for foot, other in zip(FEET, FEET[::-1], strict=True)}
    for is_mirrored in (mirrored, not mirrored):
        body, coefficients = (assessment.body.mirrored(), swapped) if is_mirrored else (assessment.body, as_given)
        history = simulate(body, assessment.motions[motion], coefficients, scale=scale, gravity=assessment.gravity)
        if not overturned or history.outcome is Outcome.OVERTURNED:
            break
    name = assessment.motions[motion].name
    return GoverningHistory(history, assessment.motions[motion],
                 f"The body{' mirrored,' if is_mirrored else ''} under {name} {scale_text}, with {model}")  # fmt: skip


def _governing_solid(assessment: BodyAssessment, solid: StandingSolid) -> GoverningHistory:
    """Return the history of a solid at the smallest overturning factor, or under the unscaled first motion."""
    factor, model, motion, _ = assessment.lowest
    scale, scale_text = (
        (just_above(factor), f"scaled by {factor:.3g}") if math.isfinite(factor) else (1.0, "(unscaled)")
    )
    motion_of_record = assessment.motions[motion]
    history = simulate(
        solid.solid.turned(solid.azimuth), motion_of_record.parts, solid.restitution, friction=assessment.friction,
        scale=scale, gravity=assessment.gravity, tolerance=1e-8,
    )  # fmt: skip
    azimuth = f"{math.degrees(solid.azimuth) % 360.0:.0f}"
    return GoverningHistory(
        history,
        motion_of_record,
        f"The solid, its x axis at {azimuth} deg, under {motion_of_record.name} {scale_text}, with {model}",
    )


def assessment_document(
    assessment: BodyAssessment, name: str, signed: dict[str, str], governing: GoverningHistory
) -> Document:
    """Return the content of the report of an assessment."""
    may_overturn = (assessment.overturning_fraction > 0.0).any() or assessment.lowest.factor < 1.0
    doubtful = may_overturn or assessment.body.is_weaker_along_depth
    mark = "bad" if (assessment.overturning_fraction == 1.0).any() else "fair" if doubtful else "good"
    margins = Picture(
        "margins", "Smallest overturning factor of each motion, and code methods relative to it (unsafe above 1)"
    )
    probability_picture = Picture(
        "prediction", "Probability of overturning and of rocking under each motion, and the main uncertainties"
    )
    leading_motion = leading(governing.motion)
    motion = Picture(
        "motion",
        f"{leading_motion.name}: motion of the {support_of(leading_motion)}, response spectrum, 5 % damping",
        74,
    )
    searched = _SEARCHED[:1] if assessment.standing is None else _IN_SPACE
    history_caption = f"{governing.description}: {governing.history.summary}"
    probability_blocks = [probability_picture] if assessment.prediction.chances["overturning"].value > 0.0 else []
    sections = [
        ReportSection("Overturning", [margins, _models(assessment), _motions(assessment)]),
        ReportSection("Causes", [*map(Paragraph, assessment.governing_factors)]),
        ReportSection("Measures", [*map(_led, assessment.measures)]),
        ReportSection("Probability", [*map(Paragraph, assessment.prediction.sentences), *probability_blocks]),
        ReportSection("Code methods", [_codes(assessment)]),
        ReportSection("The body", _about(assessment)),
        ReportSection("Ground motions: source and processing", [motion_sources(assessment.prediction.motions)]),
        ReportSection("The governing motion and history", [motion, Picture("response", history_caption, 80)]),
        ReportSection("Inputs and assumptions", [
            table("", ["input", "distribution or value"], assessment.prediction.inputs.items()),
            *map(_led, (*searched, *_SEARCHED[1:], *ASSUMED, *assessment.prediction.assumed)),
            *(Paragraph(text, "Not sampled:") for text in assessment.prediction.not_sampled), Paragraph(scale_words()),
            *(Paragraph(reason, f"{model} does not apply to this body:", "fair")
              for model, reason in assessment.refused.items()),
        ]),
        ReportSection("References", [*map(_led, _references(assessment))]),
        ReportSection("Signed", [table("", ["", ""], [(key, value or "_" * 30) for key, value in
                                                      (*signed.items(), ("signature", ""))])]),
    ]  # fmt: skip
    motions_text = f"Under {assessment.motion_count}"
    subtitle = ". ".join(
        filter(None, (motions_text, signed["project"] if name else "", signed["author"], signed["date"]))
    )
    verdict = [
        Paragraph(assessment.verdict, "", mark),
        *map(Paragraph, (assessment.margin_sentence, assessment.probability_sentence)),
        *motion_doubts(assessment.prediction.motions),
    ]
    title = name or signed["project"] or "A body in an earthquake"
    return Document(title, subtitle, sections, verdict=verdict, footer=SOFTWARE)


def _models(assessment: BodyAssessment) -> ReportTable:
    rows = assessment.model_rows
    note = (
        "r: velocity after an impact over velocity before. Margin: smallest factor on a motion with overturning, of "
        "all motions and both polarities; infinite if no computed factor overturns the body. The ends of the "
        "calibrated model are those of its 95 % interval for a single body."
    )
    if assessment.standing is not None:
        note += (
            f" 3D histories with a friction coefficient of {assessment.friction:.3g}; r: in the plane of the {_PLANE}."
        )
    marks = {"overturned": ["good" if row["overturned"].startswith("0 ") else "bad" for row in rows]}
    return answer_table("With each model of restitution", rows, (), note, marks=marks)


def _motions(assessment: BodyAssessment) -> ReportTable:
    margins = assessment.models.values()
    min_factors = np.fmin.reduce([np.fmin.reduce(margin.min_factors_by_polarity) for margin in margins])
    worst_directions = [min(np.flatnonzero(assessment.records == k).tolist(),
                            key=lambda j: np.nan_to_num(min_factors[j], nan=np.inf))
             for k in np.unique(assessment.records)]  # fmt: skip
    count = len(assessment.models)
    fractions = zip(worst_directions, assessment.overturning_fraction, strict=True)
    ranked = sorted(fractions, key=lambda pair: min_factors[pair[0]])
    rows = [
        {
            "motion": assessment.motions[j].name, "pga": assessment.motions[j].peak, "pgv": _pgv(assessment.motions[j]),
            "uplift_factors": assessment.uplift_factors[j], "min_factor": min_factors[j],
            "overturned": f"{fraction * count:.0f} of {count}",
        }
        for j, fraction in ranked
    ]  # fmt: skip
    note = (
        "Factors scale the motion; two components are combined in the direction of the smallest factor. "
        "Margin: the smallest factor with overturning with any model. With a factor below 1 the body can still stand "
        "under the unscaled motion; then the factor is no margin."
    )
    marks = {"overturned": ["bad" if fraction > 0.0 else "good" for _, fraction in ranked]}
    display = peak_display(assessment.prediction.motions)
    return answer_table("Under each motion", rows, (), note, display=display, marks=marks)


def _pgv(motion: Any) -> float:
    return measure("pgv").of(sampled(leading(motion)))


def _led(text: str) -> Paragraph:
    """Return a paragraph with the text before the first colon in bold."""
    lead, colon, body = text.partition(": ")
    return Paragraph(body, f"{lead}:") if colon else Paragraph(text)


def _codes(assessment: BodyAssessment) -> ReportTable:
    methods = [CODE_METHODS[row["method"]] for row in assessment.code_rows]
    rows = [
        {**row, "method": method.title, "vertical motion": method.vertical.value}
        for row, method in zip(assessment.code_rows, methods, strict=True)
    ]
    note = (
        "Overturned: motions rated safe under which the body overturns with at least one model. Limit factor: the "
        "smallest factor of any motion up to which the method rates the body safe. Vertical motion: in "
        f"{assessment.vertical} of {len(assessment.motions)} motions. Not included: "
        f"{'; '.join(f'{name} ({reason})' for name, reason in LEFT_OUT.items())}."
    )
    return answer_table("", rows, (), note)


def _about(assessment: BodyAssessment) -> list[Block]:
    if assessment.standing is None:
        return [
            Pair(Picture("body", "The body on its feet O and O'"), body_table("", assessment.body, assessment.gravity))
        ]
    repairs = repairs_of(assessment.standing.solid)
    title = f"The {_PLANE} of {math.degrees(assessment.standing.plane_azimuth) % 360.0:.0f} deg"
    return [
        *map(Paragraph, assessment.standing.sentences),
        Picture("body", "Energy barrier by direction; the support polygon; the body from its sides"),
        body_table(title, assessment.body, assessment.gravity),
        *repairs,
    ]


def _references(assessment: BodyAssessment) -> list[str]:
    kinds, source = models(), provenance()
    classes = [
        kinds[name] for name in dict.fromkeys(label.partition(":")[0] for label in assessment.models) if name in kinds
    ]
    measured = [f"measurements: {source['source']}, doi:{source['doi']}"] if CALIBRATED in assessment.models else []
    named = [f"{kind.name}: {kind.reference}" for kind in classes]
    return [
        *measured,
        *named,
        *(f"{method.title}: {method.reference}. Our reading: {method.reading}" for method in CODE_METHODS.values()),
    ]
