"""Bodies of requests: counted while they arrive, whatever their head says, and read once they are whole."""

import asyncio
import math

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking.app.answers import refusal
from rocking.app.problems import Busy, Problem, TooLarge
from rocking.app.security.asked import SAFE, Asked
from rocking.app.security.contents import BYTES, content_type
from rocking.app.security.json_text import check_json
from rocking.app.settings import MEBIBYTE, Limits

_DRAINED = 64 * MEBIBYTE
_LONG_JSON = 1 << 16


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
            await self._read(Asked.of(scope), receive, body)
        except Problem as problem:
            await refusal(problem, close=True)(scope, receive, send)
        except Gone:
            return
        else:
            await self._app(scope, _again(bytes(body), receive), send)
        finally:
            self._held -= len(body)

    async def _read(self, asked: Asked, receive: Receive, body: bytearray) -> None:
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

    async def _fill(self, asked: Asked, receive: Receive, body: bytearray, most: int) -> None:
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
