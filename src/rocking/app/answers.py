"""Answers in JSON, every digit kept and never a NaN, and answers that a browser saves as a file."""

import json
import math
import re
import unicodedata
from collections.abc import Sequence
from typing import Any

from pydantic_core import to_json
from starlette.responses import JSONResponse, Response

from rocking.app.errors import status_and_kind
from rocking.errors import RockingError

_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_STRANGE = re.compile(r"(?:[^A-Za-z0-9._-]|(?<![A-Za-z0-9])\.|\.(?![A-Za-z0-9]))+")
_LONGEST = 80


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


def safe_name(name: str, fallback: str = "rocking") -> str:
    """Return a file name that is harmless on every system: ASCII letters, digits, dot, dash and underscore.

    Returns at most 80 characters; never a hidden, reserved or empty name.

    >>> safe_name("../../Vase Nº 3 <b>.csv")
    'Vase-No-3-b.csv'
    >>> safe_name("statue v1.2 report.pdf")
    'statue-v1.2-report.pdf'
    """
    plain = unicodedata.normalize("NFKD", name[:1000]).encode("ascii", "ignore").decode()
    stem, dot, suffix = plain.rpartition(".")
    if not dot or not re.fullmatch(r"[A-Za-z0-9]{1,8}", suffix):
        stem, dot, suffix = plain, "", ""
    stem = _STRANGE.sub("-", stem).strip("-_") or fallback
    stem = f"{fallback}-{stem}" if _RESERVED.fullmatch(stem) else stem
    return stem[: _LONGEST - len(suffix) - 1].rstrip(".-_") + dot + suffix


def attachment(data: bytes, name: str, media_type: str) -> Response:
    """Return an answer that a browser saves as a file and never shows as a page."""
    headers = {
        "Content-Disposition": f'attachment; filename="{safe_name(name)}"',
        "X-Content-Type-Options": "nosniff",
    }
    return Response(data, media_type=media_type, headers=headers)
