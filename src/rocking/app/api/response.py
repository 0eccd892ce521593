"""POST /api/response: how the body rocks, under every restitution that was chosen."""

from typing import Any

from fastapi import APIRouter, Request

from rocking.app.answers import JsonAnswer
from rocking.app.api.answers import ResponseAnswers
from rocking.app.question import question_of
from rocking.app.records import RecordStore
from rocking.app.schemas.answers.answer import answered
from rocking.app.schemas.answers.response import ResponseAnswered
from rocking.app.schemas.inputs import ResponseAsked
from rocking.app.state import state_of
from rocking.app.work import heavy

router = APIRouter(prefix="/api", tags=["response"])

_ABOUT = """\
One answer for every restitution, in the order in which they were chosen: the keys of `rocking simulate --json`, and
`series` as drawn over `points` dots, each with the extremes of every curve, between the two times of `window` if given;
states just before and just after every impact, and where the body turns round, are among them. `verdict` says
whether the choice of the model decides. A restitution that has no response for this body has `label` and `error`."""


@router.post(
    "/response",
    summary="How the body rocks",
    description=_ABOUT,
    response_class=JsonAnswer,
    responses=answered(ResponseAnswered, "One answer for every restitution, and what they say together."),
)
async def response(request: Request, inputs: ResponseAsked) -> JsonAnswer:
    """Answer with responses, verdict, outline and motion."""
    return JsonAnswer(await heavy(request, _answer, inputs, state_of(request).records))


def _answer(inputs: ResponseAsked, records: RecordStore) -> dict[str, Any]:
    return ResponseAnswers.of(question_of(inputs, records)).facts(inputs.points, inputs.body.name, inputs.window)
