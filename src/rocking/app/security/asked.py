"""The head of a request or of a websocket handshake, as the checks look at it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rocking.app.problems import BadRequest, Problem

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


class TooManyHeaders(Problem):
    """The head of the request is larger than that of any browser."""

    status = 431
    kind = "too-large"


@dataclass(frozen=True)
class Asked:
    """The head of a request or of a websocket handshake."""

    method: str  # in capitals; "WEBSOCKET" for a handshake
    target: str  # path as it stands in the request line, nothing decoded
    query: str  # what follows the question mark
    scheme: str  # "http" or "https"
    headers: Mapping[str, str]  # lower-case name -> value

    @classmethod
    def of(cls, scope: Mapping[str, Any]) -> "Asked":
        """Return the head of an ASGI connection."""
        pairs = scope["headers"]
        if len(pairs) > _MOST_HEADERS or sum(len(name) + len(value) for name, value in pairs) > _MOST_BYTES:
            raise TooManyHeaders(f"the head has more than {_MOST_HEADERS} headers or {_MOST_BYTES} bytes")
        headers: dict[str, str] = {}
        for raw, value in pairs:
            name = raw.decode("latin-1").lower()
            if name in headers and name in _ONCE:
                raise BadRequest(f"the header {name} is there twice")
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
        """Return whether it may change something."""
        return self.method not in SAFE

    @property
    def of_api(self) -> bool:
        """Return whether it asks the API and not for a page."""
        return self.target.startswith("/api/")

    @property
    def has_body(self) -> bool:
        """Return whether a body follows.

        Returns by its length, or by its being chunked.
        """
        return "transfer-encoding" in self.headers or self.headers.get("content-length", "0") != "0"
