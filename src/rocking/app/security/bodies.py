"""Bodies of requests: counted while they arrive; JSON is UTF-8, not deep, with no key twice and no NaN."""

import asyncio
import json
import math
import re
from typing import Any, NoReturn

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking.app.answers import refusal
from rocking.app.errors import Busy, Problem, Refused, TooLarge
from rocking.app.security.requests import BYTES, SAFE, RequestHead, content_type
from rocking.app.settings import MEBIBYTE, Limits

_DRAINED = 64 * MEBIBYTE
_LONG_JSON = 1 << 16
_BRACKETS = re.compile(rb'"(?:[^"\\]|\\.)*"|[\[\]{}]', re.DOTALL)
_LARGEST = 2**63


class TooSlow(Problem):
    """The body of a request does not arrive."""

    status = 408


class Gone(Exception):  # noqa: N818 - nothing went wrong
    """The client went away."""


class BodyLimits:
    """Read the body of every request up to a limit, and hand it on whole."""

    def __init__(self, app: ASGIApp, limits: Limits) -> None:
        self._app = app
        self._limits = limits
        self._held = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Read a body and hand the request on, or refuse it."""
        if scope["type"] != "http" or scope["method"] in SAFE:
            await self._app(scope, receive, send)
            return
        body = bytearray()
        try:
            await self._read(RequestHead.of(scope), receive, body)
        except Problem as problem:
            await refusal(problem, close=True)(scope, receive, send)
        except Gone:
            return
        else:
            await self._app(scope, _again(bytes(body), receive), send)
        finally:
            self._held -= len(body)

    async def _read(self, asked: RequestHead, receive: Receive, body: bytearray) -> None:
        is_file = content_type(asked) == BYTES
        most = self._limits.upload_bytes if is_file else self._limits.json_bytes
        try:
            async with asyncio.timeout(self._limits.body_seconds):
                await self._fill(asked, receive, body, most)
        except TimeoutError as error:
            raise TooSlow(f"the body did not arrive within {self._limits.body_seconds:g} s") from error
        if is_file:
            return
        if len(body) > _LONG_JSON:
            await asyncio.to_thread(check_json, bytes(body), self._limits.json_depth)
        else:
            check_json(bytes(body), self._limits.json_depth)

    async def _fill(self, asked: RequestHead, receive: Receive, body: bytearray, most: int) -> None:
        declared, pieces = asked.headers.get("content-length", "0"), _Pieces(receive)
        length = float(declared) if declared.isdecimal() else math.inf
        if length > most:
            if length <= _DRAINED:
                await _drain(pieces)
            raise TooLarge(_too_large(most))
        async for piece in pieces:
            if len(body) + len(piece) > most:
                await _drain(pieces)
                raise TooLarge(_too_large(most))
            if self._held + len(piece) > self._limits.bytes_in_flight:
                raise Busy("too many files arrive at once; try again in a moment", seconds=2)
            self._held += len(piece)
            body += piece


def _too_large(most: int) -> str:
    return f"the body is larger than {most / MEBIBYTE:g} MiB"


class _Pieces:
    def __init__(self, receive: Receive) -> None:
        self._receive = receive
        self._more = True

    def __aiter__(self) -> "_Pieces":
        return self

    async def __anext__(self) -> bytes:
        if not self._more:
            raise StopAsyncIteration
        message = await self._receive()
        if message["type"] == "http.disconnect":
            raise Gone
        self._more = message.get("more_body", False)
        piece: bytes = message.get("body", b"")
        return piece


async def _drain(pieces: _Pieces) -> None:
    """Read on for a while: a browser shows the refusal only once it has sent what it wanted."""
    drained = 0
    async for piece in pieces:
        drained += len(piece)
        if drained > _DRAINED:
            return


def _again(body: bytes, receive: Receive) -> Receive:
    sent = False

    async def whole() -> Message:
        nonlocal sent
        if sent:
            return await receive()
        sent = True
        return {"type": "http.request", "body": body, "more_body": False}

    return whole


def check_json(data: bytes, depth: int) -> None:
    """Refuse a text that is not plain JSON."""
    if not data.strip():
        return
    _check_depth(data, depth)
    try:
        text = data.decode("utf-8")
        json.loads(text, parse_constant=_constant, parse_float=_float, parse_int=_int, object_pairs_hook=_object)
    except UnicodeDecodeError as error:
        raise Refused("the JSON is not in UTF-8") from error
    except json.JSONDecodeError as error:
        raise Refused(f"this is not JSON: {error.msg} at line {error.lineno}, column {error.colno}") from error
    lower = text.lower()
    if "\\u0000" in lower or "\0" in text:
        raise Refused("a text in the JSON holds a NUL")
    if "\\ud" in lower:
        _check_characters(text)


def _check_depth(data: bytes, most: int) -> None:
    depth = 0
    for match in _BRACKETS.finditer(data):
        mark = match[0]
        depth += (mark in b"[{") - (mark in b"]}")
        if depth > most:
            raise Refused(f"the JSON is nested deeper than {most}")


def _check_characters(text: str) -> None:
    try:
        json.dumps(json.loads(text), ensure_ascii=False).encode("utf-8")
    except UnicodeEncodeError as error:
        raise Refused("a text in the JSON holds half a character (a lone surrogate)") from error


def _constant(word: str) -> NoReturn:
    raise Refused(f"{word} is not a number that can be computed with")


def _float(word: str) -> float:
    value = float(word)
    if not math.isfinite(value):
        raise Refused(f"the number {word[:40]} is larger than float64 holds")
    return value


def _int(word: str) -> int:
    if len(word) > 20 or not -_LARGEST <= int(word) < _LARGEST:
        raise Refused(f"the whole number {word[:40]} does not fit into 64 bits")
    return int(word)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) != len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise Refused(f"the key {twice[:60]!r} is there twice")
    return content
