"""What nobody foresaw: its trace goes into the log, and the client is told that something went wrong."""

import logging

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rocking.app.answers import error_answer
from rocking.app.problems import INTERNAL

_LOG = logging.getLogger("rocking.app")


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
