"""POST /api/impact: coefficient of restitution by model, compared with published measurements."""

from typing import Any, Literal

from fastapi import APIRouter, Request

from rocking import Block
from rocking.answers import Answer
from rocking.conventions import g
from rocking.reports.body_facts import (
    ImpactAnswer,
    curves_answer,
    measured_answer,
    outline_answer,
    stages_answer,
)
from rocking.restitution import models
from rocking_workbench.answers import Foot, JsonAnswer, Point, Units, answered, shape
from rocking_workbench.api.body import DrawnBody
from rocking_workbench.inputs import ImpactRequest, body_from, size_of
from rocking_workbench.work import Remembered, sized

router = APIRouter(prefix="/api", tags=["impact"])
_HELD: Remembered[JsonAnswer] = Remembered(64)

Shares: Any = shape(
    "Shares",
    "Kinetic energy that each stage of KED leaves, over the energy before the impact.",
    **{
        "before": (float, "1 [-]"),
        "stage 1": (float, "after the vertical part is lost [-]"),
        "stage 2": (float, "after the part along O'S is lost [-]"),
        "after": (float, "after the impact [-]"),
    },
)
CoefficientFacts: Any = shape(
    "CoefficientFacts",
    "Result of one model for one body.",
    "coefficient coefficient_low coefficient_high impulse_ratio impulse_position energy_loss warnings[]",
    model=(str, "name of the model with its parameters, or calibrated"),
    friction_demand=(float, "friction coefficient below which the foot slips at the impact"),
    admissible=(bool, "whether one impulse on the base can do it without creating energy"),
)
Stage: Any = shape(
    "Stage",
    "One stage of the impact.",
    name=Literal["before", "stage 1", "stage 2", "after"],
    description=str,
    energy=(float, "kinetic energy after the stage"),
    fraction=(float, "kinetic energy after the stage / energy before the impact"),
    velocity=list[Point],
)
Stages: Any = shape(
    "Stages",
    "The three stages of KED for an impact at 1 rad/s.",
    "velocity_before velocity_after",
    points=(list[Point], "points of the velocities, x and y"),
    stages=list[Stage],
)
MeasuredPoint: Any = shape(
    "MeasuredPoint",
    "One published measurement.",
    "slenderness_ratio slenderness_angle coefficient coefficient_low coefficient_high",
    group=str,
    label=str,
)
Measured: Any = shape("Measured", "The published measurements.", source=str, measurements=list[MeasuredPoint])
ModelCurve: Any = shape(
    "ModelCurve",
    "The coefficient of homogeneous rectangles under one model.",
    "model slenderness_ratio[] coefficient[]",
)
ImpactWarning: Any = shape("ImpactWarning", "A warning and its models.", description=str, models=list[str])
ImpactAnswered: Any = shape(
    "ImpactAnswered",
    "Coefficients by impact foot; of two equal feet only the right foot.",
    body=DrawnBody,
    ked_energy_fractions=dict[Foot, Shares],
    coefficients=(dict[Foot, list[CoefficientFacts]], "every model, the calibrated default first"),
    identities=(dict[str, dict[str, bool]], "empty here; `rocking restitution --check-identities --json` fills it"),
    titles=(dict[str, str], "name of a model to its title"),
    measured=Measured,
    curves=list[ModelCurve],
    stages=dict[Foot, Stages],
    warnings=list[ImpactWarning],
    units=Units,
)


@router.post(
    "/impact",
    summary="Coefficients of restitution",
    responses=answered(ImpactAnswered, "Every model, the measurements, and the three stages."),
)
async def impact(request: Request, inputs: ImpactRequest) -> JsonAnswer:
    """Return the keys of `rocking restitution --json`, and the data of its figures.

    `measured` and `curves` are for the figure. `stages` contains, by foot, velocities at points of the body for the
    three stages of KED. `warnings` contains texts with the affected models.
    """
    return await sized(request, size_of(inputs.body), answer, inputs)


def answer(inputs: ImpactRequest) -> JsonAnswer:
    """Return the coefficients of an impact. Recent results are cached."""
    key = inputs.model_dump_json(exclude_unset=True), *models().values()
    return _HELD.get(key, lambda: JsonAnswer(_facts(inputs)))


def _facts(inputs: ImpactRequest) -> Answer:
    body = body_from(inputs.body)
    # a homogeneous block is symmetric, so equal values are listed once
    same = isinstance(body, Block) and body.known is None and body.stands_on_corners
    foot = "right" if inputs.foot == "both" and same else inputs.foot
    coefficients = ImpactAnswer.of(body, None, foot=foot, gravity=inputs.settings.gravity or g, identities=False)
    facts = coefficients.answer()
    rows = [row for table in coefficients.tables.values() for row in table]
    warned: dict[str, dict[str, None]] = {}  # models by sentence, each model once
    for row in rows:
        for sentence in row.warnings:
            warned.setdefault(sentence, {})[row.name] = None
    return facts | {
        "body": facts["body"] | outline_answer(body) | {"name": inputs.body.name},
        "titles": {row.name: row.title for row in rows},
        "measured": measured_answer(),
        "curves": curves_answer(),
        "stages": {foot: stages_answer(body, foot) for foot in coefficients.tables},
        "warnings": [{"description": sentence, "models": list(names)} for sentence, names in warned.items()],
    }
