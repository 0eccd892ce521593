"""POST /api/body and /api/body/file: what a body is, from a document or from a file."""

import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request

from rocking.app.answers import JsonAnswer, safe_name
from rocking.app.errors import Refused, room_on_disk
from rocking.app.question import body_from
from rocking.app.schemas.answers import BodyInFile, DescribedBody, answered
from rocking.app.schemas.inputs import BodyAsked, BodyInput, check_file, parsed_toml
from rocking.app.work import heavy, sized
from rocking.bodies import Body
from rocking.bodies.formats import read_plane_body
from rocking.bodies.formats.body_writer import body_to_toml
from rocking.bodies.formats.schema import UnitName
from rocking.bodies.formats.source import blamed
from rocking.conventions import FEET, g
from rocking.errors import BodyFileError
from rocking.evidence._coefficient_table import outside_evidence
from rocking.reports.body_facts import body_facts, outline_facts

router = APIRouter(prefix="/api", tags=["body"])
_ABOUT = "The keys of `body` of `rocking cor --json`, the polygons that draw the body, and warnings in plain words."
_FILE = """\
The content of a DXF, WKT, GeoJSON or TOML file; `name` says by its ending which of them it is. `units` is needed for
WKT and GeoJSON, and for a drawing that does not state its unit. `body` of the answer is what stands in the inputs."""
OCTETS: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}
"""What the schema of an endpoint says that takes a file."""


@router.post(
    "/body",
    summary="What a body is",
    description=_ABOUT,
    response_class=JsonAnswer,
    responses=answered(DescribedBody, "The body."),
)
async def body(request: Request, asked: BodyAsked) -> JsonAnswer:
    """Answer with the facts of a body."""
    return await sized(request, asked.body, _body, asked)


@router.post(
    "/body/file",
    summary="Read a body file",
    description=_FILE,
    response_class=JsonAnswer,
    responses=answered(BodyInFile, "The body, and what stands in the inputs for it."),
    openapi_extra=OCTETS,
)
async def body_file(
    request: Request,
    name: Annotated[str, Query(max_length=500)],
    units: UnitName | None = None,
    density: Annotated[float | None, Query(gt=0.0, le=1e6, allow_inf_nan=False, description="kg/m3")] = None,
) -> JsonAnswer:
    """Answer with the body of a file as it stands in the inputs, and its facts.

    density: density of what has none of its own [kg/m3].
    """
    content = await request.body()
    return JsonAnswer(await heavy(request, _read, content, name, units, density))


def described(body: Body, gravity: float, name: str | None) -> dict[str, Any]:
    """Return what is said of a body.

    gravity: acceleration of gravity [m/s2].
    """
    facts = body_facts(body, gravity)
    found = facts["warnings"] + [outside_evidence(body, foot) for foot in FEET]
    warnings = list(dict.fromkeys(sentence for sentence in found if sentence))
    return {"name": name, **facts, **outline_facts(body), "warnings": warnings}


def _body(asked: BodyAsked) -> JsonAnswer:
    return JsonAnswer(described(body_from(asked.body), asked.settings.gravity or g, asked.body.name))


def _read(content: bytes, name: str, units: str | None, density: float | None) -> dict[str, Any]:

    given: BodyInput = body_in_file(content, name, units, density)
    return {"body": given.table(), **described(body_from(given), g, given.name)}


def body_in_file(content: bytes, name: str, units: str | None, density: float | None) -> BodyInput:
    """Return the body that a file describes.

    density: density of what has none of its own, in a drawing [kg/m3].
    """
    shown = safe_name(name, "body")
    check_file(content, shown)
    if shown.lower().endswith(".toml"):
        return _toml(content, shown, units)
    with TemporaryDirectory(prefix="rocking-") as folder:
        path = Path(folder) / shown
        with room_on_disk():
            path.write_bytes(content)
        body = read_plane_body(path, units=units, density=density)
    return BodyInput.model_validate({**tomllib.loads(body_to_toml(body)), "name": Path(shown).stem})


def _toml(content: bytes, name: str, units: str | None) -> BodyInput:
    with blamed(name):
        try:
            given = parsed_toml(content.decode("utf-8-sig"))
        except (UnicodeDecodeError, Refused) as error:
            raise BodyFileError(f"is not TOML that can be read: {str(error).partition(';')[0]}") from error
        if "body" in given and isinstance(given["body"], dict):
            given = given["body"]
        if units is not None and given.get("units", units) != units:
            raise BodyFileError(f"states units = {given['units']!r:.20}, but units = {units!r} was asked for")
    return BodyInput.model_validate(given)
