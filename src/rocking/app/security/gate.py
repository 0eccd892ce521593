"""The gate: every request and every websocket passes these checks before anything reads it."""

from collections.abc import Callable

from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send

from rocking.app.answers import refusal
from rocking.app.problems import Problem
from rocking.app.security.asked import Asked
from rocking.app.security.contents import check_content
from rocking.app.security.hosts import check_host, own_hosts
from rocking.app.security.origins import check_origin, check_site
from rocking.app.security.session import check_session
from rocking.app.security.targets import check_method, check_target
from rocking.app.settings import Settings

Check = Callable[["Gate", Asked, HTTPConnection], None]

CHECKS: dict[str, Check] = {
    "method": lambda gate, asked, request: check_method(asked),
    "target": lambda gate, asked, request: check_target(asked, gate.settings.limits.target_bytes),
    "host": lambda gate, asked, request: check_host(asked, gate.own),
    "site": lambda gate, asked, request: check_site(asked),
    "origin": lambda gate, asked, request: check_origin(asked, gate.own),
    "content": lambda gate, asked, request: check_content(asked),
    "session": lambda gate, asked, request: check_session(asked, request),
}
"""What is looked at, in this order."""


class Gate:
    """Let pass what our own page or a script with the key asks, and nothing else."""

    settings: Settings
    own: frozenset[str]

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self._app = app
        self.settings = settings
        self.own = own_hosts(settings)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check a connection and hand it on, or refuse it."""
        if scope["type"] != "lifespan":
            try:
                asked = Asked.of(scope)
                for check in CHECKS.values():
                    check(self, asked, HTTPConnection(scope))
            except Problem as problem:
                await _refuse(problem, scope, receive, send)
                return
        await self._app(scope, receive, send)


async def _refuse(problem: Problem, scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": problem.kind})
    else:
        await refusal(problem, close=True)(scope, receive, send)
