"""What a request may be: method, path, host, page of origin and kind of its head; its body, counted as it arrives."""

import asyncio
import json
import math
import re
from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking.app.answers import refusal
from rocking.app.errors import Busy, NotFound, Refused, TooLarge
from rocking.app.settings import MEBIBYTE, Limits, ServerSettings

_MOST_HEADERS = 100
_MOST_BYTES = 1 << 14
SAFE = frozenset({"GET", "HEAD"})
_ONCE = {
    "host",
    "origin",
    "authorization",
    "cookie",
    "content-type",
    "content-length",
    "content-encoding",
    "transfer-encoding",
    "sec-fetch-site",
    "sec-fetch-mode",
    "sec-fetch-dest",
}
_METHODS = SAFE | {"POST", "DELETE", "WEBSOCKET"}
_PATH = re.compile(r"(/[A-Za-z0-9_-][A-Za-z0-9._-]*)+/?|/")
_ALWAYS = ("127.0.0.1", "localhost", "[::1]")
_OWN_SITES = {"same-origin", "none"}
JSON = "application/json"
BYTES = "application/octet-stream"


@dataclass(frozen=True)
class RequestHead:
    """The head of a request or of a websocket handshake."""

    method: str  # in capitals; "WEBSOCKET" for a handshake
    target: str  # path as it stands in the request line, nothing decoded
    query: str  # what follows the question mark
    scheme: str  # "http" or "https"
    headers: Mapping[str, str]  # lower-case name -> value

    @classmethod
    def of(cls, scope: Mapping[str, Any]) -> "RequestHead":
        """Return the head of an ASGI connection."""
        pairs = scope["headers"]
        if len(pairs) > _MOST_HEADERS or sum(len(name) + len(value) for name, value in pairs) > _MOST_BYTES:
            raise Refused(f"the head has more than {_MOST_HEADERS} headers or {_MOST_BYTES} bytes", status=431)
        headers: dict[str, str] = {}
        for raw, value in pairs:
            name = raw.decode("latin-1").lower()
            if name in headers and name in _ONCE:
                raise Refused(f"the header {name} is there twice", status=400)
            headers[name] = value.decode("latin-1").strip()
        target = (scope.get("raw_path") or scope["path"].encode()).decode("latin-1")
        return cls(
            method="WEBSOCKET" if scope["type"] == "websocket" else scope["method"],
            target=target.partition("?")[0],
            query=scope.get("query_string", b"").decode("latin-1"),
            scheme={"ws": "http", "wss": "https"}.get(scope["scheme"], scope["scheme"]),
            headers=headers,
        )

    @property
    def unsafe(self) -> bool:
        """Whether it may change something."""
        return self.method not in SAFE

    @property
    def of_api(self) -> bool:
        """Whether it asks the API and not for a page."""
        return self.target.startswith("/api/")

    @property
    def has_body(self) -> bool:
        """Whether a body follows, by its length or by its being chunked."""
        return "transfer-encoding" in self.headers or self.headers.get("content-length", "0") != "0"


def check_method(head: RequestHead) -> None:
    """Refuse methods that nothing here takes; OPTIONS too, as no other site may ask."""
    if head.method not in _METHODS:
        raise Refused("the method must be GET, HEAD, POST or DELETE", status=405)
    if head.method in SAFE and head.has_body:
        raise Refused(f"a {head.method} request has no body", status=400)


def check_target(head: RequestHead, most: int) -> None:
    """Refuse paths of anything but letters, digits, dots, dashes and slashes; most: of path and query [bytes]."""
    if len(head.target) + len(head.query) > most:
        raise Refused(f"path and query are longer than {most} bytes", status=414)
    if not _PATH.fullmatch(head.target):
        raise NotFound("there is no such page: its path has characters that none here has")


def own_hosts(settings: ServerSettings) -> frozenset[str]:
    """Return every Host header that is the server's own."""
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    names = {*_ALWAYS, host.lower()}
    with_port = {f"{name}:{settings.port}" for name in names}
    return frozenset(with_port | names if settings.port == 80 else with_port)


def check_host(head: RequestHead, own: frozenset[str]) -> None:
    """Refuse a request that was sent to another name."""
    if head.headers.get("host", "").lower() not in own:
        raise Refused(
            "the Host header is not this server's address: open it by the link that `rocking serve` prints", status=403
        )


def check_origin(head: RequestHead, own: frozenset[str]) -> None:
    """Refuse a request of another page; one that may change something must say where it comes from."""
    origin = head.headers.get("origin")
    if origin is None:
        if head.unsafe:
            name = head.headers.get("host", "127.0.0.1")
            raise Refused(f"the Origin header is missing: a script sends Origin: {head.scheme}://{name}", status=403)
    elif origin.lower() not in {f"{head.scheme}://{name}" for name in own}:
        raise Refused("the Origin header names another page than this server's own", status=403)


def check_site(head: RequestHead) -> None:
    """Refuse what a browser sends on behalf of another site, but for somebody following a link to a page."""
    site = head.headers.get("sec-fetch-site")
    if site is None or site in _OWN_SITES:
        return
    follows_link = head.headers.get("sec-fetch-mode") == "navigate" and head.headers.get("sec-fetch-dest") == "document"
    if head.unsafe or head.of_api or not follows_link:
        raise Refused("another site asks for this", status=403)


def content_type(head: RequestHead) -> str:
    """Return the type of a body in lower case, without its parameters; empty if none is given."""
    return head.headers.get("content-type", "").partition(";")[0].strip().lower()


def check_content(head: RequestHead) -> None:
    """Refuse bodies of other types, in another charset, or packed."""
    kind = content_type(head)
    if head.headers.get("content-encoding", "identity").lower() != "identity":
        raise Refused("the body must not be compressed", status=415)
    if (head.has_body or kind) and head.unsafe and kind not in {JSON, BYTES}:
        raise Refused(f"Content-Type must be {JSON}, or {BYTES} for a file", status=415)
    parameters = head.headers.get("content-type", "").partition(";")[2].replace(" ", "").lower()
    if kind == JSON and parameters not in {"", "charset=utf-8", 'charset="utf-8"'}:
        raise Refused("JSON must be in UTF-8", status=415)


_DRAINED = 64 * MEBIBYTE
_LONG_JSON = 1 << 16
_BRACKETS = re.compile(rb'"(?:[^"\\]|\\.)*"|[\[\]{}]', re.DOTALL)
_LARGEST = 2**63


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
        except Refused as error:
            await refusal(error, close=True)(scope, receive, send)
        except Gone:
            return
        else:
            await self._app(scope, _again(bytes(body), receive), send)
        finally:
            self._held -= len(body)

    async def _read(self, head: RequestHead, receive: Receive, body: bytearray) -> None:
        is_file, depth = content_type(head) == BYTES, self._limits.json_depth
        most = self._limits.upload_bytes if is_file else self._limits.json_bytes
        try:
            async with asyncio.timeout(self._limits.body_seconds):
                await self._fill(head, receive, body, most)
        except TimeoutError as error:
            raise Refused(f"the body did not arrive within {self._limits.body_seconds:g} s", status=408) from error
        if len(body) > _LONG_JSON and not is_file:
            await asyncio.to_thread(check_json, bytes(body), depth)
        elif not is_file:
            check_json(bytes(body), depth)

    async def _fill(self, head: RequestHead, receive: Receive, body: bytearray, most: int) -> None:
        declared, pieces = head.headers.get("content-length", "0"), _pieces(receive)
        length = float(declared) if declared.isdecimal() else math.inf
        too_large = TooLarge(f"the body is larger than {most / MEBIBYTE:g} MiB")
        if length > most:
            if length <= _DRAINED:
                await _drain(pieces)
            raise too_large
        async for piece in pieces:
            if len(body) + len(piece) > most:
                await _drain(pieces)
                raise too_large
            if self._held + len(piece) > self._limits.bytes_in_flight:
                raise Busy("too many files arrive at once; try again in a moment", seconds=2)
            self._held += len(piece)
            body += piece


async def _pieces(receive: Receive) -> AsyncIterator[bytes]:
    more = True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            raise Gone
        more = message.get("more_body", False)
        yield message.get("body", b"")


async def _drain(pieces: AsyncIterator[bytes]) -> None:
    """Read on for a while: a browser shows the refusal only once it has sent what it wanted."""
    drained = 0
    async for piece in pieces:
        drained += len(piece)
        if drained > _DRAINED:
            return


def _again(body: bytes, receive: Receive) -> Receive:
    whole: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def again() -> Message:
        return whole.pop() if whole else await receive()

    return again


def check_json(data: bytes, depth: int) -> None:
    """Refuse a text that is not plain JSON."""
    if not data.strip():
        return
    level = 0
    for match in _BRACKETS.finditer(data):
        level += (match[0] in b"[{") - (match[0] in b"]}")
        if level > depth:
            raise Refused(f"the JSON is nested deeper than {depth}")
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
        raise Refused("a text in the JSON holds half a character (a lone surrogate)") from error
    except json.JSONDecodeError as error:
        raise Refused(f"this is not JSON: {error.msg} at line {error.lineno}, column {error.colno}") from error
    if "\\u0000" in text.lower() or "\0" in text:
        raise Refused("a text in the JSON holds a NUL")


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
