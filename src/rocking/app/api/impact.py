"""POST /api/impact: what an impact costs, under every model, against the published measurements."""

from typing import Any

from fastapi import APIRouter, Request

from rocking.app.answers import JsonAnswer
from rocking.app.question import body_from
from rocking.app.schemas.answers import ImpactAnswered, answered
from rocking.app.schemas.inputs import ImpactAsked
from rocking.app.work import Remembered, sized
from rocking.bodies import Block
from rocking.conventions import g
from rocking.reports.body_facts import (
    ImpactAnswer,
    curves_facts,
    impact_facts,
    measured_facts,
    outline_facts,
    stages_facts,
)

router = APIRouter(prefix="/api", tags=["impact"])

_ABOUT = """\
The keys of `rocking cor --json`; `measured` and `curves` for the picture; `stages` by foot with velocities at points
of the body for the three stages of KED; `warnings` in plain words, each with the models that it concerns."""

_HELD: Remembered[JsonAnswer] = Remembered(64)


@router.post(
    "/impact",
    summary="What an impact costs",
    description=_ABOUT,
    response_class=JsonAnswer,
    responses=answered(ImpactAnswered, "Every model, the measurements, and the three stages."),
)
async def impact(request: Request, asked: ImpactAsked) -> JsonAnswer:
    """Answer with coefficients, evidence and stages."""
    return await sized(request, asked.body, _answer, asked)


def warm_up() -> None:
    """Compute what all answers share, so that the first user does not wait for it."""
    _answer(ImpactAsked.model_validate({"body": {"units": "m", "width": 1.0, "height": 4.0}}))


def _answer(asked: ImpactAsked) -> JsonAnswer:
    return _HELD.get(asked.model_dump_json(exclude_unset=True), lambda: JsonAnswer(_facts(asked)))


def _facts(asked: ImpactAsked) -> dict[str, Any]:
    body = body_from(asked.body)
    # a block is the same on both sides; what is the same is told once
    onto = "right" if asked.onto == "both" and isinstance(body, Block) else asked.onto
    gravity = asked.settings.gravity or g
    answer = ImpactAnswer.of(body, None, onto=onto, eta=1.0, gravity=gravity, identities=False)
    facts = impact_facts(answer)
    facts["body"] |= {"name": asked.body.name, **outline_facts(body)}
    titles = {row.name: row.title for rows in answer.tables.values() for row in rows}
    return {
        **facts,
        "titles": titles,
        "measured": measured_facts(),
        "curves": curves_facts(),
        "stages": {foot: stages_facts(body, foot) for foot in answer.tables},
        "warnings": _warnings(answer),
    }


def _warnings(answer: ImpactAnswer) -> list[dict[str, Any]]:
    found: dict[str, list[str]] = {}
    for row in (row for rows in answer.tables.values() for row in rows):
        for words in row.warnings:
            models = found.setdefault(words, [])
            if row.name not in models:
                models.append(row.name)
    return [{"words": words, "models": models} for words, models in found.items()]
