"""The list of studies, pushed to the browser whenever it changes."""

import asyncio
import contextlib
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from rocking.app.answers import JsonAnswer
from rocking.app.studies.manager import StudyManager

SHORTEST = 0.2
"""Time between two messages, at least [s]."""

MOST = 64
"""Browsers that are told at the same time."""

_TRY_LATER = 1013


async def serve(manager: StudyManager, socket: WebSocket) -> None:
    """Send the list of studies now and after every change, until the browser goes."""
    loop, changed = asyncio.get_running_loop(), asyncio.Event()

    def tell() -> None:
        with contextlib.suppress(RuntimeError):  # the loop has ended, the browser with it
            loop.call_soon_threadsafe(changed.set)

    if manager.watchers >= MOST:
        await socket.close(_TRY_LATER)
        return
    leave = manager.subscribe(tell)
    gone = None
    try:
        await socket.accept()
        gone = asyncio.create_task(_gone(socket))
        while not gone.done():
            changed.clear()
            await socket.send_text(bytes(JsonAnswer({"studies": manager.overview()}).body).decode())
            await _either(gone, changed)
            await asyncio.wait({gone}, timeout=SHORTEST)
    except (WebSocketDisconnect, RuntimeError):  # it went while it was told
        pass
    finally:
        leave()
        if gone is not None:
            gone.cancel()


async def _either(gone: "asyncio.Task[None]", changed: asyncio.Event) -> None:
    woken: asyncio.Task[Any] = asyncio.create_task(changed.wait())
    try:
        both: set[asyncio.Task[Any]] = {gone, woken}
        await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
    finally:
        woken.cancel()


async def _gone(socket: WebSocket) -> None:
    """Return when the browser has gone; what it says is not listened to."""
    while True:
        message = await socket.receive()
        if message["type"] == "websocket.disconnect":
            return
