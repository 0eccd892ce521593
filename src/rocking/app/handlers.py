"""Errors of the endpoints as JSON: installed on the application once."""

from collections.abc import Awaitable, Callable
from typing import Any, cast

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from pydantic import ValidationError
from starlette.exceptions import HTTPException

from rocking.app.answers import JsonAnswer, error_answer, refusal
from rocking.app.problems import kind_of_status
from rocking.bodies.formats.words import sentence
from rocking.errors import RockingError

_SAME_AS = {"model_attributes_type": "model_type", "int_parsing": "int_type", "float_parsing": "float_type"}
_WORDS = {404: "there is no such thing here", 405: "this takes another method"}


def install_handlers(app: FastAPI) -> None:
    """Let errors of the endpoints be answered in one form."""
    app.add_exception_handler(RockingError, _handler(refusal))
    app.add_exception_handler(RequestValidationError, _handler(_invalid))
    app.add_exception_handler(ValidationError, _handler(_invalid))
    app.add_exception_handler(HTTPException, _handler(_refused))


def validation_sentence(error: ValidationError | RequestValidationError) -> str:
    """Return what is wrong with an input in one sentence.

    Returns Key, allowed range and value of the first problem.
    """
    problems = [_without_place(dict(problem)) for problem in error.errors()]
    if problems and problems[0]["loc"] == ():
        problems[0]["loc"] = ("the body of the request",)
    in_body = problems and problems[0]["loc"][0] == "body"
    units = _units_of(getattr(error, "body", None)) if in_body else None
    return sentence(cast("ValidationError", _Found(problems)), units)


class _Found:
    """Problems in the form in which a `ValidationError` has them."""

    def __init__(self, problems: list[dict[str, Any]]) -> None:
        self._problems = problems

    def errors(self, include_url: bool = True) -> list[dict[str, Any]]:
        return self._problems


def _without_place(problem: dict[str, Any]) -> dict[str, Any]:
    place = problem["loc"]
    if place and place[0] in {"body", "query", "path", "header"}:
        problem["loc"] = tuple(place[1:])
    problem["type"] = _SAME_AS.get(problem["type"], problem["type"])
    return problem


def _units_of(document: Any) -> Any:
    body = document.get("body") if isinstance(document, dict) else None
    return body.get("units") if isinstance(body, dict) else None


def _invalid(error: ValidationError | RequestValidationError) -> JsonAnswer:
    return error_answer(422, "invalid-value", validation_sentence(error))


def _refused(error: HTTPException) -> JsonAnswer:
    answer = error_answer(
        error.status_code, kind_of_status(error.status_code), _WORDS.get(error.status_code, str(error.detail))
    )
    answer.headers.update(error.headers or {})
    return answer


def _handler(answer: Callable[[Any], JsonAnswer]) -> Callable[[Request, Exception], Awaitable[JsonAnswer]]:
    # no thread for it: a server that ends would not wait for one
    async def handle(request: Request, error: Exception) -> JsonAnswer:
        return answer(error)

    return handle
