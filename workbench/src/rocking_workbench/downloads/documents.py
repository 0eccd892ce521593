"""Export of documents (report, animation, input files), and import of input files."""

import datetime
from functools import partial
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request
from starlette.responses import Response as Answer

from rocking.plots.labels import fine_samples
from rocking.reports.document import response_pdf
from rocking.reports.response_document import PICTURES, ResponseReport, response_document
from rocking.reports.response_facts import measures_of
from rocking_workbench.answers import FILE_SENT, JsonAnswer, answered, answered_with_file, attachment
from rocking_workbench.downloads.animation import gif_of, page_of
from rocking_workbench.downloads.archive import bundle_of, inputs_from_file
from rocking_workbench.downloads.evaluation import Evaluation
from rocking_workbench.downloads.inputs_file import FILE_NAME, commands, fingerprint, inputs_as_toml, plain_inputs
from rocking_workbench.downloads.pictures import drawn, figure_of
from rocking_workbench.inputs import Inputs, ResponseInputs
from rocking_workbench.plain_text import plain_line
from rocking_workbench.settings import state_of
from rocking_workbench.work import heavy

router = APIRouter(prefix="/api", tags=["take away"], default_response_class=Answer)

Place = Annotated[int | None, Query(ge=0, description="index of the response; default: 0")]
_DATE = "date on the report, such as 2026-11-21; default: none"


@router.post("/report.pdf", summary="The report as PDF", responses=answered_with_file("The report.", "pdf"))
async def report(
    request: Request, inputs: ResponseInputs, date: Annotated[datetime.date | None, Query(description=_DATE)] = None
) -> Answer:
    """Return the report: body, coefficients, motion, responses and commands."""
    evaluation = Evaluation(inputs, state_of(request).records)
    day = "" if date is None else f"{date.day} {date:%B %Y}"
    return attachment(await heavy(request, report_of, evaluation, day), f"{evaluation.label} report.pdf")


@router.post(
    "/animation.{kind}",
    summary="The body in motion",
    responses=answered_with_file("The animation.", "html", "gif"),
)
async def animation(
    request: Request, kind: Literal["html", "gif"], inputs: ResponseInputs, restitution: Place = None
) -> Answer:
    """Return the animation of one response as a self-contained page or as a GIF."""
    evaluation = Evaluation(inputs, state_of(request).records)
    make = page_of if kind == "html" else gif_of
    data = await heavy(request, lambda: make(evaluation.chosen(restitution)))
    return attachment(data, f"{evaluation.file_stem('animation', restitution)}.{kind}")


@router.post(
    "/inputs.toml",
    summary="The inputs as a file of the command line",
    responses=answered_with_file("The input file of `rocking simulate`.", "toml"),
)
async def inputs_file(request: Request, inputs: Inputs) -> Answer:
    """Return the input file of `rocking simulate` for the same result."""
    return attachment((await heavy(request, inputs_as_toml, inputs)).encode(), FILE_NAME)


@router.post(
    "/inputs.zip",
    summary="Input file with its record",
    responses=answered_with_file("Input file, record and commands.", "zip"),
)
async def inputs_bundle(request: Request, inputs: Inputs) -> Answer:
    """Return an archive with input file, record and commands."""
    evaluation = Evaluation(inputs, state_of(request).records)
    return attachment(await heavy(request, bundle_of, evaluation), f"{evaluation.label} response.zip")


@router.post(
    "/inputs/read",
    openapi_extra=FILE_SENT,
    summary="Read an input file",
    responses=answered(Inputs, "The inputs."),
    response_class=JsonAnswer,
)
async def inputs_read(request: Request) -> JsonAnswer:
    """Return the inputs of an input file or archive, and store the record of an archive."""
    data = await request.body()
    return JsonAnswer(plain_inputs(await heavy(request, inputs_from_file, data, state_of(request).records)))


def report_of(evaluation: Evaluation, date: str) -> bytes:
    """Return the report as PDF."""
    inputs, motion = evaluation.inputs, None if evaluation.inputs.motion is None else evaluation.motion
    results = ResponseReport(
        evaluation.impact, motion, {} if motion is None else measures_of(motion, fine_samples(motion)),
        evaluation.responses, evaluation.refused, evaluation.problem.assumed_friction, evaluation.name, date,
        inputs_as_toml(inputs), [plain_line(line, 2000) for line in commands(inputs)], fingerprint(inputs),
    )  # fmt: skip
    stems = [stem for stem in PICTURES if motion is not None or stem != "motion"]
    pictures = {stem: drawn(partial(figure_of, stem, evaluation)) for stem in stems}
    return response_pdf(response_document(results), pictures)
