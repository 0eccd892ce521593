"""JSON answers without NaN or loss of digits, downloads, and their schema.

The shapes only describe answers. No answer is checked against its shape during a request, because for long series the
check would take more time than the answer. The tests check every shape.
"""

import inspect
import json
import math
from collections.abc import Iterator
from typing import Any, Literal, get_args, get_type_hints

from fastapi import FastAPI
from pydantic import BaseModel, ConfigDict, Field, create_model
from pydantic_core import to_json
from starlette.responses import JSONResponse, Response

from rocking import answers
from rocking.errors import RockingError
from rocking.messages import messages_of
from rocking.quantities import quantity as quantity_of
from rocking_workbench.errors import Refused, kind_of, kind_of_status
from rocking_workbench.plain_text import safe_name


class MessageData(BaseModel):
    """A text with named fields and their values."""

    model_config = ConfigDict(extra="forbid")

    text: str
    facts: dict[str, Any]
    many: str = Field("", description="text for a count other than 1")
    context: str = Field("", description="context of the message, to distinguish messages with the same text")


Point = tuple[float, float]  # x and y [m]
Foot = Literal["left", "right"]  # pivot foot, or foot of an impact

Kind = Literal[
    "invalid-value", "record", "body-file", "geometry", "unknown-model", "missing-extra", "not-found", "conflict",
    "too-large", "busy", "no-room", "forbidden", "internal",
]  # fmt: skip
MEDIA_TYPES = {
    "csv": "text/csv; charset=utf-8",
    "dat": "application/octet-stream",
    "gif": "image/gif",
    "glb": "model/gltf-binary",
    "html": "text/html; charset=utf-8",
    "json": "application/json",
    "mat": "application/x-matlab-data",
    "nc": "application/x-netcdf",
    "parquet": "application/vnd.apache.parquet",
    "pdf": "application/pdf",
    "png": "image/png",
    "svg": "image/svg+xml",
    "toml": "application/toml",
    "xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    "xml": "application/xml",
    "zip": "application/zip",
}
"""Media types by file extension. Browsers save these files, and never show them as a page."""

FILE_SENT: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}
"""Request body of an endpoint that accepts a file."""

_ERRORS = {
    400: "The request is malformed.",
    401: "Not signed in: the request has no session cookie and no key in the header Authorization.",
    403: "Host or Origin is not the server's own address.",
    404: "Not found.",
    405: "The method is not allowed here.",
    409: "Another client changed the object. Read it again.",
    413: "The request or its result exceeds a limit of the server.",
    415: "The type of the request body is not supported.",
    422: "The input is refused. The message contains value, allowed range and likely cause.",
    429: "Too many requests. The header Retry-After contains the waiting time.",
    500: "Internal error. The log of the server contains the traceback.",
    503: "The server is shutting down.",
    507: "The disk of the server is full.",
}


class JsonAnswer(JSONResponse):
    """JSON of plain values and arrays, fast for long series. NaN and infinity are errors."""

    def render(self, content: Any) -> bytes:
        if isinstance(content, answers.Answer):
            content = content.plain()
        elif isinstance(content, dict) and (messages := messages_of(content)):
            content = {**content, "messages": messages}
        data = to_json(content, inf_nan_mode="constants", fallback=_plain)
        if b"NaN" in data or b"Infinity" in data:  # allowed in a name; a number raises an error
            json.dumps(content, allow_nan=False, default=_plain)
        return data


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in an answer")


def error_answer(status: int, kind: str, message: str) -> JsonAnswer:
    """Return an error that contains only a sentence."""
    return JsonAnswer({"error": {"kind": kind, "message": message}}, status_code=status)


def refusal(error: RockingError, *, close: bool = False) -> JsonAnswer:
    """Return an error of this package as JSON, with the header Retry-After if a retry is useful."""
    own = error if isinstance(error, Refused) else None
    kind = kind_of_status(own.status) if own else kind_of(error)
    document = {"kind": kind, **error.data()} | ({"needs": list(own.needs)} if own and own.needs else {})
    answer = JsonAnswer({"error": document}, status_code=own.status if own else 422)
    if own and (own.seconds is not None or own.status == 429):
        answer.headers["Retry-After"] = str(math.ceil(own.seconds or 1.0))
    if close:
        answer.headers["Connection"] = "close"
    return answer


def attachment(data: bytes, name: str) -> Response:
    """Return a response that browsers save as a file; the extension sets its media type."""
    return Response(data, media_type=MEDIA_TYPES[name.rpartition(".")[2]], headers=attachment_headers(name))


def attachment_headers(name: str) -> dict[str, str]:
    """Return headers with which browsers save a response under a safe file name."""
    return {"Content-Disposition": f'attachment; filename="{safe_name(name)}"', "X-Content-Type-Options": "nosniff"}


class AnswerShape(BaseModel):
    """A table of an answer; unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


def shape(name: str, meaning: str, /, *more: Any, **fields: Any) -> Any:
    """Return a table of an answer.

    `more` contains a base table, and names of quantities, with [] for lists of values. `fields` maps a key to its
    type, to (type, description), or to (type, description, quantity). The quantity gives the unit of the key; ""
    means no unit. The default description of a key is that in `rocking.quantities`. A `Field` in place of the
    description can add a default.
    """
    base = next((item for item in more if not isinstance(item, str)), AnswerShape)
    fields = {key: kind for names in more if isinstance(names, str) for key, kind in _of_names(names)} | fields
    if "units" in fields:
        fields["messages"] = Messages
    keys: Any = {key: _field(key, *(value if isinstance(value, tuple) else (value,))) for key, value in fields.items()}
    return create_model(name, __base__=base, __doc__=meaning, __module__=__name__, **keys)


def _of_names(names: str) -> Iterator[tuple[str, Any]]:
    for name in names.split():
        key = name.removesuffix("[]")
        entry = quantity_of(key)
        assert entry is not None, key
        kind = str if entry.is_text else float
        yield key, list[kind] if key != name else kind  # type: ignore[valid-type]


def shape_of(kind: type, name: str, *, without: tuple[str, ...] = (), **more: Any) -> Any:
    """Return a dataclass as a table of an answer; `Annotated[str, "description"]` contains the descriptions."""
    # `more` contains keys as in `shape`, which replace keys of the dataclass
    hints = {key: hint for key, hint in get_type_hints(kind, include_extras=True).items() if key not in without}
    types = {key: get_args(hint) if hasattr(hint, "__metadata__") else hint for key, hint in hints.items()}
    return shape(name, inspect.getdoc(kind) or "", **{**types, **more})


def _field(key: str, kind: Any, description: Any = None, quantity: str | None = None) -> tuple[Any, Any]:
    entry = quantity_of(key if quantity is None else quantity)
    if description is None and entry is not None:
        description = entry.meaning
    if not isinstance(description, str):
        return kind, ... if description is None else description
    unit = "" if entry is None else "-" if entry.unit == "1" else entry.unit
    return kind, Field(
        description=f"{description} [{unit}]".strip() if unit and not description.endswith("]") else description
    )


Messages: Any = (
    dict[str, MessageData],
    Field({}, description="data of each message in this answer, by its English text"),
)
Units: Any = (dict[str, str], "unit of every number, by the name of its quantity")


def answered(kind: Any, description: str, status: int = 200) -> dict[int | str, dict[str, Any]]:
    """Return the declaration of a JSON answer of an endpoint."""
    return {status: {"model": kind, "description": description}}


def answered_with_file(description: str, *endings: str) -> dict[int | str, dict[str, Any]]:
    """Return the declaration of a file that an endpoint returns; `endings` are the extensions of its names."""
    name = {"schema": {"type": "string"}, "description": "attachment, with a harmless name of the file"}
    file = {"schema": {"type": "string", "format": "binary"}}
    content = {MEDIA_TYPES[ending].partition(";")[0]: file for ending in endings}
    return {200: {"description": description, "headers": {"Content-Disposition": name}, "content": content}}


Deleted: Any = shape("Deleted", "Identifier of the deleted item.", deleted=(str, "identifier in URLs"))
QuantityAnswer: Any = shape(
    "QuantityAnswer", "An intensity measure, or an axis of a map.", name=str, description=str, unit=str
)
PlaceData: Any = shape(
    "PlaceData",
    "A table, file or step with an invalid input.",
    name=str,
    kind=Literal["table", "key", "file", "step"],
    number=(int, "of the line or step, from 1; 0 for none"),
)
AllowedData: Any = shape(
    "AllowedData",
    "The allowed values of a parameter; low and high are null for an open range.",
    sentence=str,
    low=(float | None, Field(None, description="lower limit, in `unit` of the refusal")),
    high=(float | None, Field(None, description="upper limit, in `unit` of the refusal")),
    low_open=(bool, False),
    high_open=(bool, False),
)
Refusal: Any = shape(
    "Refusal",
    "Reason of a refusal; further keys are filled if known.",
    message=(str, "in one sentence"),
    parameter=(str, Field("", description="path of the refused parameter in the request, such as body.block.width")),
    value=(Any, Field(None, description="the refused value, in the unit of the request; as text if it is no number")),
    allowed=(AllowedData | None, Field(None, description="the allowed values")),
    unit=(str, Field("", description="unit of the allowed values")),
    text=(str, Field("", description="the sentence without place and hint, with named fields")),
    facts=(dict[str, Any], Field({}, description="values of the fields")),
    hint=(MessageData | None, Field(None, description="remedy or likely cause")),
    places=(list[PlaceData], []),
    more=(int, Field(0, description="number of further errors")),
)
ErrorDetail: Any = shape("ErrorDetail", "An error.", Refusal, kind=Kind, needs=(list[str], []))


class ErrorAnswer(BaseModel):
    """An error: kind and message."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={"examples": [{"error": {"kind": "not-found", "message": "not found"}}]},
    )

    error: ErrorDetail


ERRORS: dict[int | str, dict[str, Any]] = {
    status: {"description": description} for status, description in _ERRORS.items()
}
"""Error responses of every endpoint; `describe_api` adds the other contents."""
ERRORS[500]["model"] = ErrorAnswer  # of one status only: a model costs each endpoint a validator


def describe_api(app: FastAPI) -> None:
    """Add the authentication key of calls and the form of errors to the schema of the API."""
    plain = app.openapi
    key = {"type": "http", "scheme": "bearer"}
    key["description"] = "The key from the file `api-key` in the data folder. Each start writes a new key."

    def openapi() -> dict[str, Any]:
        schema = plain()
        components = schema.setdefault("components", {})
        components["securitySchemes"] = {"key": key}
        content = {"application/json": {"schema": {"$ref": "#/components/schemas/ErrorAnswer"}}}
        errors = {status: {"description": description, "content": content} for status, description in _ERRORS.items()}
        again = {"schema": {"type": "integer"}, "description": "waiting time before the next request [s]"}
        errors[429]["headers"] = {"Retry-After": again}
        components["responses"] = {f"Error{status}": error for status, error in errors.items()}
        for path, item in schema["paths"].items():
            for operation in item.values():
                operation["security"] = [] if path == "/api/session" else [{"key": []}]
                for status in _ERRORS:
                    operation["responses"][str(status)] = {"$ref": f"#/components/responses/Error{status}"}
        return schema

    app.openapi = openapi  # type: ignore[method-assign]  # the way that FastAPI provides
