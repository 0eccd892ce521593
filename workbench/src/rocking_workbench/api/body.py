"""POST /api/body and /api/body/file: properties of a body, from a document or a file."""

import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request

from rocking.answers import Answer
from rocking.bodies import Body
from rocking.bodies.formats import body_to_toml, read_plane_body
from rocking.bodies.formats.schema import UnitName
from rocking.conventions import FEET, g
from rocking.errors import BodyFileError, located
from rocking.evidence._coefficient_table import outside_evidence
from rocking.reports.body_facts import outline_answer
from rocking_workbench.answers import FILE_SENT, JsonAnswer, Point, Units, answered, shape
from rocking_workbench.errors import Refused, room_on_disk
from rocking_workbench.inputs import BodyInput, BodyRequest, body_from, check_file, parsed_toml, size_of
from rocking_workbench.plain_text import safe_name
from rocking_workbench.work import heavy, sized

router = APIRouter(prefix="/api", tags=["body"])

SideFacts: Any = shape(
    "SideFacts",
    "Quantities of one side of a body, for rocking about this foot.",
    "slenderness_ratio slenderness_angle semi_diagonal frequency_parameter uplift_acceleration",
)
Sides: Any = shape("Sides", "One entry for each foot.", left=SideFacts, right=SideFacts)
Polygon: Any = shape(
    "Polygon",
    "A region of one density.",
    outline=list[Point],
    holes=list[list[Point]],
    density=float,
)
BodyFacts: Any = shape(
    "BodyFacts",
    "Mass, centre of mass, feet, and quantities of each side.",
    "mass moment_of_inertia gravity assumed[] warnings[]",
    kind=(str, "class of the body in Python"),
    centre=Point,
    foot_positions=Point,
    sides=Sides,
)
DrawnBody: Any = shape(
    "DrawnBody",
    "A body with the outline that draws it.",
    BodyFacts,
    "masses[] ground",
    name=(str | None, "name of the body"),
    outline=(list[Polygon], "polygons; none for mass points and for ellipses"),
    points=list[Point],
    base_contact=list[Point],
)
DescribedBody: Any = shape("DescribedBody", "A body with warnings and units.", DrawnBody, units=Units)
BodyInFile: Any = shape(
    "BodyInFile", "The body of a file.", DescribedBody, body=(BodyInput, "the body as a table of inputs")
)


@router.post("/body", summary="Properties of a body", responses=answered(DescribedBody, "The body."))
async def body(request: Request, inputs: BodyRequest) -> JsonAnswer:
    """Answer with the keys of `body` of `rocking restitution --json`, the polygons that draw it, and its warnings."""
    gravity = inputs.settings.gravity or g
    described_body = await sized(
        request, size_of(inputs.body), lambda: described(body_from(inputs.body), gravity, inputs.body.name)
    )
    return JsonAnswer(described_body)


@router.post(
    "/body/file",
    summary="Read a body file",
    responses=answered(BodyInFile, "The body and its table of inputs."),
    openapi_extra=FILE_SENT,
)
async def body_file(
    request: Request,
    name: Annotated[str, Query(max_length=500)],
    units: UnitName | None = None,
    density: Annotated[float | None, Query(gt=0.0, le=1e6, allow_inf_nan=False, description="kg/m3")] = None,
) -> JsonAnswer:
    """Read a DXF, WKT, GeoJSON or TOML file; the extension of `name` selects the format.

    `units` is needed for WKT and GeoJSON, and for a drawing without a unit. `body` of the answer is the table for the
    inputs.
    """
    content = await request.body()
    return JsonAnswer(await heavy(request, _of_file, content, name, units, density))


def described(body: Body, gravity: float, name: str | None) -> Answer:
    """Return properties, outline and warnings of a body at an acceleration of gravity [m/s2]."""
    answer = body.answer(gravity)
    warnings = [*answer["warnings"], *(outside_evidence(body, foot) for foot in FEET)]
    warnings = list(dict.fromkeys(sentence for sentence in warnings if sentence))
    return answer | outline_answer(body) | {"name": name, "warnings": warnings}


def _of_file(content: bytes, name: str, units: str | None, density: float | None) -> dict[str, Any]:
    table = body_in_file(content, name, units, density)
    return {"body": table.table(), **described(body_from(table), g, table.name).plain()}


def body_in_file(content: bytes, name: str, units: str | None, density: float | None) -> BodyInput:
    """Return the body of a file; `density` is the default density of regions in a drawing [kg/m3]."""
    name = safe_name(name, "body")
    check_file(content, name)
    if name.lower().endswith(".toml"):
        return _toml(content, name, units)
    with TemporaryDirectory(prefix="rocking-") as folder:
        path = Path(folder) / name
        with room_on_disk():
            path.write_bytes(content)
        body = read_plane_body(path, units=units, density=density)
    return BodyInput.model_validate({**tomllib.loads(body_to_toml(body)), "name": Path(name).stem})


def _toml(content: bytes, name: str, units: str | None) -> BodyInput:
    with located(name, "file"):
        try:
            table = parsed_toml(content.decode("utf-8-sig"))
        except UnicodeDecodeError as error:
            raise BodyFileError("the file is not readable TOML: {reason}", reason=error.reason) from error
        except Refused as error:
            raise BodyFileError("the file is not readable TOML: {reason}", reason=error.message) from error
        if "body" in table and isinstance(table["body"], dict):
            table = table["body"]
        if units is not None and table.get("units", units) != units:
            raise BodyFileError(
                "the file states units = {value}, but units = {units!r} is given",
                parameter="units", value=table["units"],
                units=units,
            )  # fmt: skip
    return BodyInput.model_validate(table)
