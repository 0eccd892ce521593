"""What every call answers, for the schema of the API: shapes, units and meanings; nothing is checked at run time."""

from typing import Any, Literal

from fastapi import FastAPI
from pydantic import BaseModel, ConfigDict, Field

from rocking.app.schemas.inputs import BodyInput

Point = tuple[float, float]
"""x and y [m]."""

Foot = Literal["left", "right"]
"""Where a body stands or lands."""

Need = Literal["format", "units", "time_step", "component"]
Kind = Literal[
    "invalid-value", "record", "body-file", "geometry", "unknown-model", "missing-extra", "not-found", "too-large",
    "busy", "no-room", "forbidden", "internal",
]  # fmt: skip


class Answer(BaseModel):
    """A table of an answer: it has these keys and no others.

    The shapes describe; nothing is checked against them when a request is answered, which would cost more than the
    answer itself where the series are long. The tests check every one of them.
    """

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


def answered(shape: Any, words: str, status: int = 200) -> dict[int | str, dict[str, Any]]:
    """Return what an endpoint declares of an answer in JSON."""
    return {status: {"model": shape, "description": words}}


def answered_with_file(words: str, *media_types: str) -> dict[int | str, dict[str, Any]]:
    """Return what an endpoint declares of a file that it answers with."""
    name = {"schema": {"type": "string"}, "description": "attachment, with a harmless name of the file"}
    return {
        200: {
            "description": words,
            "headers": {"Content-Disposition": name},
            "content": {
                kind.partition(";")[0]: {"schema": {"type": "string", "format": "binary"}} for kind in media_types
            },
        }
    }


class SideFacts(Answer):
    """What one side of a body decides: it stands on this foot and turns about it."""

    slenderness_ratio: float = Field(description="height of the centre over its lever, h/b [-]")
    slenderness_angle_rad: float = Field(description="alpha = atan(b/h) [rad]")
    semi_diagonal_m: float = Field(description="distance R of the centre from the foot [m]")
    frequency_parameter_rad_s: float = Field(description="p [rad/s]")
    uplift_acceleration_m_s2: float = Field(description="ground acceleration that lifts it, g tan(alpha) [m/s2]")


class Sides(Answer):
    """One entry for each foot."""

    left: SideFacts
    right: SideFacts


class Polygon(Answer):
    """A region of one density."""

    outline: list[Point] = Field(description="vertices x, y [m]")
    holes: list[list[Point]] = Field(description="vertices x, y of every hole [m]")
    density: float = Field(description="[kg/m3]")


class BodyFacts(Answer):
    """Mass, centre, feet, and what each side decides."""

    kind: str = Field(description="class of the body in Python")
    mass_kg: float = Field(description="mass [kg]")
    centre_m: Point = Field(description="centre of mass, x and y [m]")
    feet_m: Point = Field(description="x of the left and of the right foot [m]")
    moment_of_inertia_kg_m2: float = Field(description="about the centre of mass [kg m2]")
    gravity_m_s2: float = Field(description="acceleration of gravity [m/s2]")
    assumed: list[str] = Field(description="what nobody gave and was assumed, in sentences")
    warnings: list[str] = Field(description="what was hardly meant, in sentences; none if all is well")
    sides: Sides


class DrawnBody(BodyFacts):
    """A body with the outline that draws it."""

    name: str | None = Field(description="what the user calls it")
    outline: list[Polygon] = Field(description="polygons; none for mass points and for ellipses")
    points: list[tuple[float, float, float]] = Field(description="mass points: x [m], y [m], mass [kg]")
    centre: Point = Field(description="centre of mass, x and y [m]")
    base: Point = Field(description="x of the left and of the right foot [m]")
    ground: float = Field(description="y of the ground [m]")
    contact: list[Point] = Field(description="stretches of the base that touch the ground, from x to x [m]")


class DescribedBody(DrawnBody):
    """A body, and what a user should know of it."""

    warnings: list[str] = Field(description="sentences; none if all is well")


class BodyInFile(DescribedBody):
    """What a body file holds."""

    body: BodyInput = Field(description="the body as it stands in the inputs")


class MotionSeries(Answer):
    """The curves of a motion, as many samples of each, every extreme among them."""

    time: list[float] = Field(description="[s]")
    acceleration: list[float] = Field(description="[m/s2]")
    velocity: list[float] = Field(description="[m/s]")
    displacement: list[float] = Field(description="[m]")
    vertical: list[float] | None = Field(None, description="vertical acceleration, where there is one [m/s2]")
    shown: int = Field(description="samples here")
    of: int = Field(description="samples of the motion")


class SpectrumFacts(Answer):
    """The response of oscillators to a motion."""

    damping_ratio: float = Field(description="[-]")
    period: list[float] = Field(description="[s]")
    acceleration: list[float] = Field(description="pseudo-acceleration [m/s2]")
    velocity: list[float] = Field(description="pseudo-velocity [m/s]")
    displacement: list[float] = Field(description="[m]")
    absolute_acceleration: list[float] = Field(description="[m/s2]")


class MeasureFacts(Answer):
    """One intensity measure."""

    name: str = Field(description="short name: pga, pgv, ...")
    value: float = Field(description="in `unit`")
    unit: str
    words: str


class MotionAnswered(Answer):
    """What a motion is, how strong, and its curves."""

    kind: Literal["record", "pulse"]
    name: str
    format: str | None
    event: str | None
    station: str | None
    component: str | None
    vertical_component: str | None
    file_unit: str | None = Field(description="unit of the file; the answer is in SI")
    samples: int | None = Field(description="of a record")
    time_step_s: float | None = Field(description="of a record [s]")
    duration_s: float = Field(description="[s]")
    warnings: list[str] = Field(description="what was hardly meant, in sentences; none if all is well")
    provenance: list[str] = Field(description="what was done to it, in order")
    peak_vertical_acceleration_m_s2: float | None = Field(description="[m/s2]")
    intensity: dict[str, float] = Field(description="measures, with their units in the names")
    scale: float = Field(description="factor on the motion, which is in every number here [-]")
    peak_acceleration_m_s2: float = Field(description="[m/s2]")
    series: MotionSeries
    spectrum: SpectrumFacts | None = Field(description="null where it was not asked for")
    measures: list[MeasureFacts]


class Shares(Answer):
    """Kinetic energy that each stage of KED leaves, over the energy before the impact."""

    before: float = Field(description="1 [-]")
    stage_1: float = Field(alias="stage 1", description="after the vertical part is lost [-]")
    stage_2: float = Field(alias="stage 2", description="after the part along O'S is lost [-]")
    after: float = Field(description="after the impact [-]")


class CoefficientFacts(Answer):
    """One model's answer for one body."""

    model: str = Field(description="name of the model with its parameters, or calibrated")
    coefficient_of_restitution: float = Field(description="theta_dot_after / theta_dot_before, of velocities [-]")
    low_95: float = Field(description="lower end of the 95 % interval for a single measured body [-]")
    high_95: float = Field(description="upper end of the 95 % interval for a single measured body [-]")
    impulse_ratio_k: float = Field(description="distance of the impulse over the lever of the new foot [-]")
    impulse_x_m: float = Field(description="where the impulse acts on the ground [m]")
    energy_loss: float = Field(description="share of the kinetic energy that the impact costs [-]")
    friction_demand: float = Field(description="friction coefficient below which the foot slips at the impact [-]")
    admissible: bool = Field(description="whether one impulse on the base can do it without creating energy")
    warnings: list[str] = Field(description="sentences; none if all is well")


class Stage(Answer):
    """One stage of the impact."""

    name: Literal["before", "stage 1", "stage 2", "after"]
    words: str
    energy_joule: float = Field(alias="energy_J", description="kinetic energy that it leaves [J]")
    share: float = Field(description="the same over the energy before the impact [-]")
    velocity_m_s: list[Point] = Field(description="velocity x and y at each of the points [m/s]")


class Stages(Answer):
    """The three stages of KED for an impact at 1 rad/s."""

    velocity_before_rad_s: float = Field(description="angular velocity [rad/s]")
    velocity_after_rad_s: float = Field(description="angular velocity [rad/s]")
    points_m: list[Point] = Field(description="where the velocities are given, x and y [m]")
    stages: list[Stage]


class MeasuredPoint(Answer):
    """One published measurement."""

    group: str
    label: str
    slenderness_ratio: float = Field(description="h/b [-]")
    slenderness_angle_rad: float = Field(description="[rad]")
    coefficient: float = Field(description="of restitution [-]")
    low: float = Field(description="least value that the printed digits leave open [-]")
    high: float = Field(description="largest value that the printed digits leave open [-]")


class Measured(Answer):
    """The published measurements."""

    source: str
    points: list[MeasuredPoint]


class ModelCurve(Answer):
    """The coefficient of homogeneous rectangles under one model."""

    model: str
    slenderness_ratio: list[float] = Field(description="h/b [-]")
    coefficient: list[float] = Field(description="of restitution [-]")


class ImpactWarning(Answer):
    """A sentence, and the models that it is about."""

    words: str
    models: list[str]


ByFoot = dict[Foot, list[CoefficientFacts]]


class ImpactAnswered(Answer):
    """What an impact costs, by the foot on which the body lands; of two equal feet only the right one is told."""

    body: DrawnBody
    ked_energy_shares: dict[Foot, Shares]
    coefficients: ByFoot = Field(description="every model, the calibrated default first")
    identities: dict[str, dict[str, bool]] = Field(description="empty here; `rocking cor --identities --json` fills it")
    titles: dict[str, str] = Field(description="name of a model to its title")
    measured: Measured
    curves: list[ModelCurve]
    stages: dict[Foot, Stages]
    warnings: list[ImpactWarning]


class RecordKept(Answer):
    """A file that is kept."""

    record: str = Field(description="SHA-256 of its bytes, by which inputs name it")
    file_name: str = Field(description="the name it was given, made harmless")
    bytes: int = Field(description="its length [bytes]")
    uploaded: str = Field(description="when, in UTC")


class ComponentFacts(Answer):
    """One component of a record; null is what the file does not say."""

    name: str
    samples: int
    unit: str | None = Field(description="of acceleration in the file")
    time_step_s: float | None = Field(description="[s]")
    duration_s: float | None = Field(description="[s]")
    peak_m_s2: float | None = Field(description="largest acceleration [m/s2]")


class RecordFacts(RecordKept):
    """What a record file holds, and what must still be told."""

    format: str | None = Field(description="null where no format fits")
    components: list[ComponentFacts]
    needs: list[Need] = Field(description="what must still be told before it can be used")
    choices: dict[Need, list[str]] = Field(description="what may be told")
    message: str = Field(description="why, in a sentence; empty if nothing is missing")


class Deleted(Answer):
    """What is no longer there."""

    deleted: str = Field(description="its name in addresses")


class EngineFacts(Answer):
    """Which engine computes histories."""

    name: str
    instruction_set: str | None


class ParameterFacts(Answer):
    """What a model or a pulse takes."""

    unit: str
    words: str
    default: float | Literal["unlimited"] | None = Field(
        description='in `unit`; "unlimited" where it is infinite, null where one must be given'
    )


class ModelFacts(Answer):
    """A restitution model."""

    name: str
    label: str
    title: str
    citation: str
    summary: str
    assumptions: list[str]
    domain: str
    known_defects: list[str]
    parameters: dict[str, ParameterFacts]


class PulseFacts(Answer):
    """A kind of pulse."""

    summary: str
    parameters: dict[str, ParameterFacts]


class FamilyFacts(Answer):
    """A family of synthetic motions."""

    name: str
    title: str
    summary: str
    generator: str
    time_step_s: float = Field(description="[s]")


class FormatFacts(Answer):
    """A format of record files."""

    name: str
    title: str
    suffixes: list[str]
    states_unit: bool
    states_time_step: bool
    notes: str


class UnitNames(Answer):
    """Units that may be said."""

    length: list[str]
    acceleration: list[str]


class QuantityAnswer(Answer):
    """An intensity measure, or an axis of a map."""

    name: str
    words: str
    unit: str


class KindOfStudy(Answer):
    """A kind of study, and the table that its job has of its own."""

    name: str
    table: str


class Info(Answer):
    """What there is to choose from."""

    version: str
    engine: EngineFacts
    gravity_m_s2: float = Field(description="where nothing else is said [m/s2]")
    models: list[ModelFacts]
    pulses: dict[str, PulseFacts]
    families: list[FamilyFacts]
    formats: list[FormatFacts]
    units: UnitNames
    measures: list[QuantityAnswer]
    axes: list[QuantityAnswer]
    study_kinds: list[KindOfStudy]
    limits: dict[str, float] = Field(
        description="how much one server takes; the names say what: bytes [B], seconds [s], counts"
    )


class ErrorDetail(BaseModel):
    """What went wrong."""

    model_config = ConfigDict(extra="forbid")

    kind: Kind
    message: str
    needs: list[str] = []


class ErrorAnswer(BaseModel):
    """Every error: one kind, one sentence."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={"examples": [{"error": {"kind": "not-found", "message": "there is no such thing here"}}]},
    )

    error: ErrorDetail


_WORDS = {
    400: "The request is not what a browser or a script sends.",
    401: "Nobody is signed in: no cookie, and no key in the header Authorization.",
    403: "Host or Origin is not the server's own address.",
    404: "There is no such thing.",
    405: "This takes another method.",
    413: "The request, or what it asks for, is larger than one server takes.",
    415: "The body of the request is of another type than this takes.",
    422: "The input is refused; the message names value, allowed range and likely cause.",
    429: "Too much is asked at once; the header Retry-After says when to try again.",
    500: "Something went wrong; its trace is in the server's log.",
    503: "The server ends.",
    507: "The disk of the server takes nothing more.",
}

ERRORS: dict[int | str, dict[str, Any]] = {
    status: {"model": ErrorAnswer, "description": words} for status, words in _WORDS.items()
}
"""What every endpoint may answer besides what it is for."""

_KEY = {
    "type": "http",
    "scheme": "bearer",
    "description": "The key in the file `api-key` of the data folder, new at every start.",
}

_PUBLIC = {"/api/session"}

_AGAIN = {"schema": {"type": "integer"}, "description": "when another try makes sense [s]"}


def describe_api(app: FastAPI) -> None:
    """Let the schema of the API say which calls need the key, and say once what an error looks like."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        schema = plain()
        components = schema.setdefault("components", {})
        components["securitySchemes"] = {"key": _KEY}
        components["responses"] = {_name(status): _response(status) for status in _WORDS}
        for path, item in schema["paths"].items():
            for operation in item.values():
                operation["security"] = [] if path in _PUBLIC else [{"key": []}]
                for status in _WORDS:
                    operation["responses"][str(status)] = {"$ref": f"#/components/responses/{_name(status)}"}
        return schema

    app.openapi = openapi  # type: ignore[method-assign]  # the way that FastAPI provides


def _name(status: int) -> str:
    return f"Error{status}"


def _response(status: int) -> dict[str, Any]:
    content = {"application/json": {"schema": {"$ref": "#/components/schemas/ErrorAnswer"}}}
    told = {"description": _WORDS[status], "content": content}
    return {**told, "headers": {"Retry-After": _AGAIN}} if status == 429 else told
