"""Answers in JSON: every digit kept, and never a NaN."""

import json
import math
from collections.abc import Sequence
from typing import Any

from pydantic_core import to_json
from starlette.responses import JSONResponse

from rocking.app.problems import status_and_kind
from rocking.errors import RockingError


class JsonAnswer(JSONResponse):
    """JSON of plain values and arrays, quick for long series; a NaN or an infinity is an error here.

    An endpoint with long series returns it itself: ``return JsonAnswer({...})``.
    """

    def render(self, content: Any) -> bytes:
        """Return the bytes of an answer."""
        data = to_json(content, inf_nan_mode="constants", fallback=_plain)
        if b"NaN" in data or b"Infinity" in data:  # in a name perhaps; if it is a number, this refuses it
            json.dumps(content, allow_nan=False, default=_plain)
        return data


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in an answer")


def error_answer(status: int, kind: str, message: str, needs: Sequence[str] = ()) -> JsonAnswer:
    """Return an error as the client is told it."""
    error: dict[str, Any] = {"kind": kind, "message": message}
    if needs:
        error["needs"] = list(needs)
    return JsonAnswer({"error": error}, status_code=status)


def refusal(error: RockingError, *, close: bool = False) -> JsonAnswer:
    """Return an error of this package as the client is told it.

    Returns the answer; with Retry-After where another try makes sense.
    """
    status, kind = status_and_kind(error)
    answer = error_answer(status, kind, str(error), getattr(error, "needs", ()))
    seconds = getattr(error, "seconds", None)
    if seconds is not None or status == 429:
        answer.headers["Retry-After"] = str(math.ceil(seconds or 1.0))
    if close:
        answer.headers["Connection"] = "close"
    return answer
