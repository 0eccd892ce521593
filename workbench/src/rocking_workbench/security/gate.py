"""The gate: checks of the head of every request and of every websocket handshake."""

import logging
import re
from base64 import b64encode
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

from starlette.datastructures import MutableHeaders
from starlette.requests import ClientDisconnect, HTTPConnection
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking_workbench.answers import error_answer, refusal
from rocking_workbench.errors import INTERNAL, NotFound, Refused, kind_of_status
from rocking_workbench.pages import INLINE
from rocking_workbench.security.sessions import is_signed_in
from rocking_workbench.settings import ServerSettings

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
_PUBLIC = {("POST", "/api/session"), ("GET", "/api/session"), ("GET", "/api/openapi.json")}
JSON, BYTES = "application/json", "application/octet-stream"


@dataclass(frozen=True)
class RequestHead:
    """The head of a request or of a websocket handshake."""

    method: str  # method in capitals; "WEBSOCKET" for a handshake
    target: str  # path in the request line, not decoded
    query: str  # query after the question mark
    scheme: str  # "http" or "https"
    headers: Mapping[str, str]  # lower-case name -> value

    @classmethod
    def of(cls, scope: Mapping[str, Any]) -> "RequestHead":
        """Return the head of an ASGI connection."""
        pairs = scope["headers"]
        if len(pairs) > _MOST_HEADERS or sum(len(name) + len(value) for name, value in pairs) > _MOST_BYTES:
            raise Refused(
                "the request has more than {headers} headers or {limit} bytes of headers",
                headers=_MOST_HEADERS, limit=_MOST_BYTES,
                status=431,
            )  # fmt: skip
        headers: dict[str, str] = {}
        for raw, value in pairs:
            name = raw.decode("latin-1").lower()
            if name in headers and name in _ONCE:
                raise Refused("the header {name} appears twice", name=name, status=400)
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
        """True if the request may change data."""
        return self.method not in SAFE

    @property
    def of_api(self) -> bool:
        """True if the target is the API."""
        return self.target.startswith("/api/")

    @property
    def has_body(self) -> bool:
        """True if a body follows."""
        return "transfer-encoding" in self.headers or self.headers.get("content-length", "0") != "0"


def check_method(head: RequestHead) -> None:
    """Refuse unsupported methods, including OPTIONS."""
    if head.method not in _METHODS:
        raise Refused("the method must be GET, HEAD, POST or DELETE", status=405)
    if head.method in SAFE and head.has_body:
        raise Refused("a {method} request has no body", method=head.method, status=400)


def check_target(head: RequestHead, most: int) -> None:
    """Refuse paths that are too long, or contain characters other than letters, digits, dots, dashes and slashes."""
    if len(head.target) + len(head.query) > most:
        raise Refused("path and query are longer than {limit} bytes", limit=most, status=414)
    if not _PATH.fullmatch(head.target):
        raise NotFound("page not found: the path has invalid characters")


def own_hosts(settings: ServerSettings) -> frozenset[str]:
    """Return all valid Host headers of the server."""
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    names = {*_ALWAYS, host.lower()}
    with_port = {f"{name}:{settings.port}" for name in names}
    return frozenset(with_port | names if settings.port == 80 else with_port)


def check_host(head: RequestHead, own: frozenset[str]) -> None:
    """Refuse a request with a foreign Host header."""
    if head.headers.get("host", "").lower() not in own:
        raise Refused(
            "the Host header is not the address of this server; use the link that `rocking serve` prints", status=403
        )


def check_origin(head: RequestHead, own: frozenset[str]) -> None:
    """Refuse a request with a foreign Origin header; unsafe requests need the header."""
    origin = head.headers.get("origin")
    if origin is None:
        if head.unsafe:
            name = head.headers.get("host", "127.0.0.1")
            raise Refused(
                "the Origin header is missing; send Origin: {scheme}://{name}", scheme=head.scheme, name=name,
                status=403,
            )  # fmt: skip
    elif origin.lower() not in {f"{head.scheme}://{name}" for name in own}:
        raise Refused("the Origin header is not the address of this server", status=403)


def check_site(head: RequestHead) -> None:
    """Refuse requests from other sites, except links to pages."""
    site = head.headers.get("sec-fetch-site")
    if site is None or site in _OWN_SITES:
        return
    follows_link = head.headers.get("sec-fetch-mode") == "navigate" and head.headers.get("sec-fetch-dest") == "document"
    if head.unsafe or head.of_api or not follows_link:
        raise Refused("requests from other sites are not allowed", status=403)


def content_type(head: RequestHead) -> str:
    """Return the type of a body in lower case, without its parameters; empty without a type."""
    return head.headers.get("content-type", "").partition(";")[0].strip().lower()


def check_content(head: RequestHead) -> None:
    """Refuse bodies of other types, bodies in another charset, and compressed bodies."""
    kind = content_type(head)
    if head.headers.get("content-encoding", "identity").lower() != "identity":
        raise Refused("the body must not be compressed", status=415)
    if (head.has_body or kind) and head.unsafe and kind not in {JSON, BYTES}:
        raise Refused(
            "{parameter} must be {allowed}", parameter="Content-Type", allowed=f"{JSON}, or {BYTES} for a file",
            status=415,
        )  # fmt: skip
    parameters = head.headers.get("content-type", "").partition(";")[2].replace(" ", "").lower()
    if kind == JSON and parameters not in {"", "charset=utf-8", 'charset="utf-8"'}:
        raise Refused("JSON must be in UTF-8", status=415)


def check_session(head: RequestHead, request: HTTPConnection) -> None:
    """Refuse private targets without a session."""
    public = not head.of_api or ("GET" if head.method == "HEAD" else head.method, head.target) in _PUBLIC
    if not public and not is_signed_in(request):
        raise Refused(
            "not signed in; open the link that `rocking serve` prints",
            hint="scripts send Authorization: Bearer KEY, with the key from the file api-key in the data folder",
            status=401,
        )


Check = Callable[["Gate", RequestHead, HTTPConnection], None]
CHECKS: dict[str, Check] = {
    "method": lambda gate, head, request: check_method(head),
    "target": lambda gate, head, request: check_target(head, gate.settings.limits.target_bytes),
    "host": lambda gate, head, request: check_host(head, gate.own),
    "site": lambda gate, head, request: check_site(head),
    "origin": lambda gate, head, request: check_origin(head, gate.own),
    "content": lambda gate, head, request: check_content(head),
    "session": lambda gate, head, request: check_session(head, request),
}
"""Checks in their order."""

# hashes of the only inline scripts of the pages: the import maps
_KNOWN = [f"'sha256-{b64encode(sha256(script.encode()).digest()).decode()}'" for script in INLINE]
CONTENT_POLICY = "; ".join((
    "default-src 'none'",
    " ".join(("script-src 'self'", *_KNOWN)),
    "style-src 'self'",
    "img-src 'self' data: blob:",
    "connect-src 'self'",
    "font-src 'self'",
    "base-uri 'none'",
    "form-action 'none'",
    "frame-ancestors 'none'",
))  # fmt: skip
# Pages of the manual have no input. They contain styles, and a form that opens a page of the manual.
MANUAL_POLICY = CONTENT_POLICY.replace("form-action 'none'", "form-action 'self'").replace(
    "style-src 'self'", "style-src 'self' 'unsafe-inline'"
)
_FEATURES = (
    "accelerometer", "autoplay", "camera", "clipboard-read", "display-capture", "encrypted-media", "geolocation",
    "gyroscope", "hid", "magnetometer", "midi", "payment", "publickey-credentials-get",
    "screen-wake-lock", "serial", "usb", "xr-spatial-tracking",
)  # fmt: skip
HEADERS = {
    "Content-Security-Policy": CONTENT_POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": ", ".join([*(f"{feature}=()" for feature in _FEATURES), "microphone=(self)"]),
}
_LOG = logging.getLogger("rocking_workbench")


class Gate:
    """Pass only requests of the application's page, and of scripts with the key."""

    settings: ServerSettings
    own: frozenset[str]

    def __init__(self, app: ASGIApp, settings: ServerSettings) -> None:
        self._app = app
        self.settings = settings
        self.own = own_hosts(settings)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check a connection and pass it on, or refuse it."""
        if scope["type"] != "lifespan":
            try:
                head = RequestHead.of(scope)
                for check in CHECKS.values():
                    check(self, head, HTTPConnection(scope))
            except Refused as error:
                if scope["type"] == "http":
                    await refusal(error, close=True)(scope, receive, send)
                else:
                    await receive()
                    await send({"type": "websocket.close", "code": 1008, "reason": kind_of_status(error.status)})
                return
        await self._app(scope, receive, send)


class SafeHeaders:
    """Add security headers to every response."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on and complete its response."""

        async def complete(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.update(HEADERS)
                if scope["path"].startswith("/manual/"):
                    headers["Content-Security-Policy"] = MANUAL_POLICY
                of_api = scope["path"].startswith("/api/")
                headers.setdefault("Cache-Control", "no-store" if of_api else "no-cache")
                del headers["Server"]
            await send(message)

        await self._app(scope, receive, complete if scope["type"] == "http" else send)


class Failures:
    """Return status 500, without a traceback, for unexpected errors."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, and respond if it fails."""
        started = False

        async def watched(message: Message) -> None:
            nonlocal started
            started = started or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, watched)
        except ClientDisconnect:
            return
        except Exception:
            if scope["type"] != "http":
                raise
            _LOG.exception("%s %s failed", scope["method"], scope["path"])
            if started:
                raise
            await error_answer(500, "internal", INTERNAL)(scope, receive, send)
