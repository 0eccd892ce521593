"""Tables of what the user sees: POST /api/table/{what}.{kind}."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request
from starlette.responses import Response as Answer

from rocking.app.answers import attachment
from rocking.app.schemas.answers import answered_with_file
from rocking.app.schemas.inputs import Inputs
from rocking.app.settings import state_of
from rocking.app.takeaway.asked import Asked
from rocking.app.takeaway.contents.body_sheets import body_sheet, coefficient_sheet
from rocking.app.takeaway.contents.motion_sheets import measures_sheet, motion_sheet, spectrum_sheet
from rocking.app.takeaway.contents.response_sheets import impacts_sheet, outcomes_sheet, response_sheet
from rocking.app.takeaway.sheets import MEDIA_TYPES, Sheet, written
from rocking.app.takeaway.sheets.csv_file import MARK
from rocking.app.work import heavy
from rocking.dynamics.response import Response

What = Literal["body", "coefficients", "measures", "motion", "spectrum", "response", "outcomes", "impacts"]
Kind = Literal["csv", "xlsx", "mat", "nc"]

router = APIRouter(prefix="/api", tags=["take away"])


@router.post(
    "/table/{what}.{kind}",
    response_class=Answer,
    summary="A table",
    responses=answered_with_file("The table.", *MEDIA_TYPES.values()),
)
async def table(
    request: Request,
    what: What,
    kind: Kind,
    inputs: Inputs,
    onto: Annotated[Literal["left", "right", "both"], Query(description="foot on which the body lands")] = "both",
    restitution: Annotated[
        int | None,
        Query(ge=0, description="which response, counted from 0; if left out the first one, in xlsx all of them"),
    ] = None,
) -> Answer:
    """Return a table as a file that Excel, MATLAB, Python or R opens."""
    asked = Asked(inputs, state_of(request).records, onto)
    data, words = await heavy(request, _named_table, what, kind, asked, restitution)
    return attachment(data, f"{words}.{kind}", MEDIA_TYPES[kind])


def _named_table(what: str, kind: str, asked: Asked, restitution: int | None) -> tuple[bytes, str]:
    data = table_of(what, kind, asked, restitution)
    of_one = what == "response" and (kind != "xlsx" or restitution is not None)
    return data, asked.words(what, restitution) if of_one else f"{asked.name or 'rocking'} {what}"


def table_of(what: str, kind: str, asked: Asked, restitution: int | None = None) -> bytes:
    """Return a table as a file."""
    if what == "response":
        return _response(kind, asked, restitution)
    return written([_sheet(what, asked)], kind)


def _sheet(what: str, asked: Asked) -> Sheet:
    about = asked.about
    if what == "body":
        return body_sheet(asked.body, asked.gravity, asked.name, about)
    if what == "coefficients":
        return coefficient_sheet(asked.impact, about)
    if what in {"impacts", "outcomes"}:
        make = impacts_sheet if what == "impacts" else outcomes_sheet
        return make(asked.responses, about)
    made = {"motion": motion_sheet, "measures": measures_sheet, "spectrum": spectrum_sheet}[what]
    return made(asked.motion, about)


def _response(kind: str, asked: Asked, restitution: int | None) -> bytes:
    if kind != "xlsx":
        return _exported(asked.chosen(restitution), kind)
    if restitution is not None:
        chosen = asked.chosen(restitution)
        return written([response_sheet(chosen, chosen.rocker.label, asked.about)], kind)
    about, responses = asked.about, asked.responses
    samples = [response_sheet(response, label, about) for label, response in responses.items()]
    return written([outcomes_sheet(responses, about), impacts_sheet(responses, about), *samples], kind)


def _exported(response: Response, kind: str) -> bytes:
    """Return the file that the library writes: numbers under names of its own."""
    write = {"csv": response.to_csv, "mat": response.to_mat, "nc": response.to_netcdf}[kind]
    with TemporaryDirectory(prefix="rocking-response-") as folder:
        data = write(Path(folder) / f"response.{kind}").read_bytes()
    return MARK.encode() + data if kind == "csv" else data
