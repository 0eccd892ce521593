"""The gate: every request and every websocket passes these checks before anything reads it."""

import logging
from collections.abc import Callable

from starlette.datastructures import MutableHeaders
from starlette.requests import ClientDisconnect, HTTPConnection
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking.app.answers import error_answer, refusal
from rocking.app.errors import INTERNAL, Refused, kind_of_status
from rocking.app.security.requests import (
    RequestHead,
    check_content,
    check_host,
    check_method,
    check_origin,
    check_site,
    check_target,
    own_hosts,
)
from rocking.app.security.sessions import check_session
from rocking.app.settings import ServerSettings

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
"""What is looked at, in this order."""

CONTENT_POLICY = "; ".join((
    "default-src 'none'",
    "script-src 'self'",
    "style-src 'self'",
    "img-src 'self' data: blob:",
    "connect-src 'self'",
    "font-src 'self'",
    "base-uri 'none'",
    "form-action 'none'",
    "frame-ancestors 'none'",
))  # fmt: skip
_FEATURES = (
    "accelerometer", "autoplay", "camera", "clipboard-read", "display-capture", "encrypted-media", "geolocation",
    "gyroscope", "hid", "magnetometer", "microphone", "midi", "payment", "publickey-credentials-get",
    "screen-wake-lock", "serial", "usb", "xr-spatial-tracking",
)  # fmt: skip
HEADERS = {
    "Content-Security-Policy": CONTENT_POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": ", ".join(f"{feature}=()" for feature in _FEATURES),
}
_LOG = logging.getLogger("rocking.app")


class Gate:
    """Let pass what our own page or a script with the key asks, and nothing else."""

    settings: ServerSettings
    own: frozenset[str]

    def __init__(self, app: ASGIApp, settings: ServerSettings) -> None:
        self._app = app
        self.settings = settings
        self.own = own_hosts(settings)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check a connection and hand it on, or refuse it."""
        if scope["type"] != "lifespan":
            try:
                head = RequestHead.of(scope)
                for check in CHECKS.values():
                    check(self, head, HTTPConnection(scope))
            except Refused as error:
                await _refuse(error, scope, receive, send)
                return
        await self._app(scope, receive, send)


async def _refuse(error: Refused, scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": kind_of_status(error.status)})
    else:
        await refusal(error, close=True)(scope, receive, send)


class SafeHeaders:
    """Put the headers on every answer."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand a request on and complete its answer."""

        async def complete(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.update(HEADERS)
                headers["Cache-Control"] = "no-store" if scope["path"].startswith("/api/") else "no-cache"
                del headers["Server"]
            await send(message)

        await self._app(scope, receive, complete if scope["type"] == "http" else send)


class Failures:
    """Answer 500, without a trace, where something raises that was not foreseen."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand a request on, and answer if it fails."""
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
