"""What an error looks like to a client, and at which statuses: for the schema of the API."""

from typing import Any, Literal

from fastapi import FastAPI
from pydantic import BaseModel, ConfigDict

Kind = Literal[
    "invalid-value", "record", "body-file", "geometry", "unknown-model", "missing-extra", "not-found", "too-large",
    "busy", "no-room", "forbidden", "internal",
]  # fmt: skip


class Told(BaseModel):
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

    error: Told


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
