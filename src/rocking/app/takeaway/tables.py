"""Tables of what the user sees: POST /api/table/{what}.{kind}."""

import codecs
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request
from starlette.responses import Response as Answer

from rocking.app.answers import attachment
from rocking.app.schemas.answers import answered_with_file
from rocking.app.schemas.inputs import Inputs
from rocking.app.settings import state_of
from rocking.app.takeaway.asked import Evaluation
from rocking.app.takeaway.contents.body_tables import body_table, coefficient_table
from rocking.app.takeaway.contents.motion_tables import measures_table, motion_table, spectrum_table
from rocking.app.takeaway.contents.response_tables import impacts_table, outcomes_table, response_table
from rocking.app.takeaway.table_files import MEDIA_TYPES, written
from rocking.app.work import heavy
from rocking.dynamics.response import Response
from rocking.tables import Table

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
    asked = Evaluation(inputs, state_of(request).records, onto)
    data, words = await heavy(request, _named_table, what, kind, asked, restitution)
    return attachment(data, f"{words}.{kind}", MEDIA_TYPES[kind])


def _named_table(what: str, kind: str, asked: Evaluation, restitution: int | None) -> tuple[bytes, str]:
    data = table_of(what, kind, asked, restitution)
    of_one = what == "response" and (kind != "xlsx" or restitution is not None)
    return data, asked.words(what, restitution) if of_one else f"{asked.name or 'rocking'} {what}"


def table_of(what: str, kind: str, asked: Evaluation, restitution: int | None = None) -> bytes:
    """Return a table as a file."""
    if what == "response":
        return _response(kind, asked, restitution)
    return written([(what, _table(what, asked))], kind)


def _table(what: str, asked: Evaluation) -> Table:
    about = asked.about
    if what == "body":
        return body_table(asked.body, asked.gravity, asked.name, about)
    if what == "coefficients":
        return coefficient_table(asked.impact, about)
    if what in {"impacts", "outcomes"}:
        make = impacts_table if what == "impacts" else outcomes_table
        return make(asked.responses, about)
    made = {"motion": motion_table, "measures": measures_table, "spectrum": spectrum_table}[what]
    return made(asked.motion, about)


def _response(kind: str, asked: Evaluation, restitution: int | None) -> bytes:
    if kind != "xlsx":
        return _exported(asked.chosen(restitution), kind)
    if restitution is not None:
        chosen = asked.chosen(restitution)
        return written([(chosen.parameters.label, response_table(chosen, asked.about))], kind)
    about, responses = asked.about, asked.responses
    samples = [(label, response_table(response, about)) for label, response in responses.items()]
    return written(
        [("outcomes", outcomes_table(responses, about)), ("impacts", impacts_table(responses, about)), *samples], kind
    )


def _exported(response: Response, kind: str) -> bytes:
    """Return the file that the library writes: numbers under names of its own."""
    write = {"csv": response.to_csv, "mat": response.to_mat, "nc": response.to_netcdf}[kind]
    with TemporaryDirectory(prefix="rocking-response-") as folder:
        data = write(Path(folder) / f"response.{kind}").read_bytes()
    return codecs.BOM_UTF8 + data if kind == "csv" else data
