"""Where an answer on a body is computed: small ones at once, large ones in the line of long computations."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection

from rocking.app.schemas.caps import size_of
from rocking.app.work import heavy
from rocking.bodies.formats.body_schema import Document

P = ParamSpec("P")
T = TypeVar("T")

_SMALL = 200
"""Vertices up to which a body takes a few milliseconds."""


async def sized(
    request: HTTPConnection, body: Document, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs
) -> T:
    """Compute in a thread; a large body waits in line with other long computations."""
    if size_of(body) <= _SMALL:
        return await run_in_threadpool(function, *args, **kwargs)
    return await heavy(request, function, *args, **kwargs)
