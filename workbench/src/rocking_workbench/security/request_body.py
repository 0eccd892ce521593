"""Reading of the body of a request, with a limit of its size and a check of its JSON."""

import asyncio
import json
import math
import re
from collections.abc import AsyncIterator
from typing import Any, NoReturn

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_workbench.answers import refusal
from rocking_workbench.errors import Busy, Refused, TooLarge
from rocking_workbench.security.gate import BYTES, SAFE, RequestHead, content_type
from rocking_workbench.settings import MEBIBYTE, Limits

PROJECT_FILE = "/api/projects/import"  # address that accepts a file with all records of a project
_DRAINED = 64 * MEBIBYTE
_LONG_JSON = 1 << 16
_BRACKETS = re.compile(rb'"(?:[^"\\]|\\.)*"|[\[\]{}]', re.DOTALL)
_LARGEST = 2**63


class BodyLimits:
    """Read the body of every request up to a limit, and pass it on."""

    def __init__(self, app: ASGIApp, limits: Limits) -> None:
        self._app = app
        self._limits = limits
        self._held = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Read a body and pass the request on, or refuse it."""
        if scope["type"] != "http" or scope["method"] in SAFE:
            await self._app(scope, receive, send)
            return
        body = bytearray()
        try:
            await self._read(RequestHead.of(scope), receive, body)
        except Refused as error:
            await refusal(error, close=True)(scope, receive, send)
        except ClientDisconnect:
            return
        else:
            await self._app(scope, _again(bytes(body), receive), send)
        finally:
            self._held -= len(body)

    async def _read(self, head: RequestHead, receive: Receive, body: bytearray) -> None:
        is_file, depth = content_type(head) == BYTES, self._limits.json_depth
        limits, is_project = self._limits, head.target == PROJECT_FILE
        most = limits.json_bytes if not is_file else limits.project_bytes if is_project else limits.upload_bytes
        try:
            async with asyncio.timeout(self._limits.body_seconds):
                await self._fill(head, receive, body, most)
        except TimeoutError as error:
            raise Refused(
                "the body did not arrive within {limit:g} s", limit=self._limits.body_seconds, status=408
            ) from error
        if len(body) > _LONG_JSON and not is_file:
            await asyncio.to_thread(check_json, bytes(body), depth)
        elif not is_file:
            check_json(bytes(body), depth)

    async def _fill(self, head: RequestHead, receive: Receive, body: bytearray, most: int) -> None:
        declared, pieces = head.headers.get("content-length", "0"), _pieces(receive)
        length = float(declared) if declared.isdecimal() else math.inf
        too_large = f"the body is larger than {most / MEBIBYTE:g} MiB"
        if length > most:
            if length <= _DRAINED:
                await _drain(pieces)
            raise TooLarge(too_large)
        async for piece in pieces:
            if len(body) + len(piece) > most:
                await _drain(pieces)
                raise TooLarge(too_large)
            if self._held + len(piece) > self._limits.bytes_in_flight:
                raise Busy("too many uploads at the same time; try again later", seconds=2)
            self._held += len(piece)
            body += piece


async def _pieces(receive: Receive) -> AsyncIterator[bytes]:
    more = True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            raise ClientDisconnect
        more = message.get("more_body", False)
        yield message.get("body", b"")


async def _drain(pieces: AsyncIterator[bytes]) -> None:
    """Read the remaining body, because browsers show a refusal only after they have sent the body."""
    drained = 0
    async for piece in pieces:
        drained += len(piece)
        if drained > _DRAINED:
            return


def _again(body: bytes, receive: Receive) -> Receive:
    pending: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def again() -> Message:
        return pending.pop() if pending else await receive()

    return again


def check_json(data: bytes, depth: int) -> None:
    """Refuse a text that is not plain JSON."""
    if not data.strip():
        return
    level = 0
    for match in _BRACKETS.finditer(data):
        level += (match[0] in b"[{") - (match[0] in b"]}")
        if level > depth:
            raise Refused("the JSON is nested deeper than {limit}", limit=depth)
    try:
        text = data.decode("utf-8")
        value = json.loads(
            text, parse_constant=_constant, parse_float=_float, parse_int=_int, object_pairs_hook=_object
        )
        if "\\ud" in text.lower():
            json.dumps(value, ensure_ascii=False).encode("utf-8")
    except UnicodeDecodeError as error:
        raise Refused("the JSON is not in UTF-8") from error
    except UnicodeEncodeError as error:
        raise Refused("a text in the JSON contains a lone surrogate") from error
    except json.JSONDecodeError as error:
        raise Refused(
            "this is not JSON: {reason} at line {line}, column {column}", reason=error.msg, line=error.lineno,
            column=error.colno,
        ) from error  # fmt: skip
    if "\\u0000" in text.lower() or "\0" in text:
        raise Refused("a text in the JSON contains a NUL character")


def _constant(word: str) -> NoReturn:
    raise Refused("{word} is not a finite number", word=word)


def _float(word: str) -> float:
    value = float(word)
    if not math.isfinite(value):
        raise Refused("the number {word} exceeds the range of float64", word=word[:40])
    return value


def _int(word: str) -> int:
    if len(word) > 20 or not -_LARGEST <= int(word) < _LARGEST:
        raise Refused("the integer {word} exceeds 64 bits", word=word[:40])
    return int(word)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) != len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise Refused("the key {key!r} appears twice", key=twice[:60])
    return content
