"""Pictures of what the user sees: POST /api/picture/{what}.{kind}."""

from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import APIRouter, Query, Request
from starlette.responses import Response as Answer

from rocking.app.answers import attachment
from rocking.app.schemas.answers import answered_with_file
from rocking.app.schemas.inputs import Inputs
from rocking.app.settings import state_of
from rocking.app.takeaway.asked import Evaluation
from rocking.app.takeaway.drawing import MEDIA_TYPES, PictureKind, drawn
from rocking.app.takeaway.picture_words import in_words
from rocking.app.work import heavy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

What = Literal["body", "coefficients", "stages", "motion", "response"]
Onto = Literal["left", "right", "both"]

router = APIRouter(prefix="/api", tags=["take away"])


@router.post(
    "/picture/{what}.{kind}",
    response_class=Answer,
    summary="A picture",
    responses=answered_with_file("The picture.", *MEDIA_TYPES.values()),
)
async def picture(
    request: Request,
    what: What,
    kind: PictureKind,
    inputs: Inputs,
    onto: Annotated[Onto, Query(description="foot on which the body lands")] = "both",
    restitution: Annotated[
        int | None, Query(ge=0, description="only this response, counted from 0; all of them if left out")
    ] = None,
) -> Answer:
    """Return a picture as a file: the body, its coefficients, the three stages, the motion, or the responses."""
    asked = Evaluation(inputs, state_of(request).records, onto)
    data = await heavy(request, drawn, lambda: named(figure_of(what, asked, restitution), what, asked.name), kind)
    return attachment(data, f"{asked.name or 'rocking'} {what}.{kind}", MEDIA_TYPES[kind])


def figure_of(what: str, asked: Evaluation, restitution: int | None = None) -> "Figure":
    """Return a picture."""
    from rocking.plots.body import body_picture, coefficient_picture
    from rocking.plots.energy_stages import energy_stages_picture
    from rocking.plots.ground_motion import ground_motion_picture

    if what == "motion":
        return _scaled(ground_motion_picture(asked.motion), asked)
    if what == "response":
        return _responses(asked, restitution)
    if what == "coefficients":
        tables = asked.impact.tables
        return in_words(coefficient_picture(asked.body, tables), [row.name for row in tables[asked.foot]])
    if what == "stages":
        return energy_stages_picture(asked.body, onto=asked.foot)
    return body_picture(asked.body)


def _responses(asked: Evaluation, restitution: int | None) -> "Figure":
    from rocking.app.takeaway.comparison_picture import comparison_picture
    from rocking.plots.response import response_picture

    if restitution is None and len(asked.responses) > 1:
        return comparison_picture(asked.responses)
    chosen = asked.chosen(restitution)
    return in_words(response_picture(chosen, asked.question.assumed_friction), [chosen.parameters.label])


def named(figure: "Figure", what: str, name: str) -> "Figure":
    """Write the name of the body over a picture that has no title of its own."""
    return _titled(figure, name) if name and what in {"body", "coefficients", "stages"} else figure


def _scaled(figure: "Figure", asked: Evaluation) -> "Figure":
    """Say that a motion was scaled: its name speaks of the one that it was."""
    scale = 1.0 if asked.inputs.motion is None else asked.inputs.motion.scale
    return figure if scale == 1.0 else _titled(figure, f"{scale:g} times {asked.motion.name}")


def _titled(figure: "Figure", title: str) -> "Figure":
    from rocking.app.takeaway.comparison_picture import drawn_text

    figure.suptitle(drawn_text(title, 80), x=0.01, ha="left", fontsize=8.5, fontweight="bold")
    return figure
