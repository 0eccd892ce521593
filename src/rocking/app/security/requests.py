"""What the head of a request or of a websocket handshake may be: method, path, host, page of origin, kind of body."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rocking.app.errors import BadRequest, NotAllowed, NotFound, Problem, WrongContent, WrongMethod
from rocking.app.settings import ServerSettings

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


class TooManyHeaders(Problem):
    """The head of the request is larger than that of any browser."""

    status = 431
    kind = "too-large"


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


class TooLong(Problem):
    """The path or the query is longer than any that is needed."""

    status = 414
    kind = "too-large"


def check_method(asked: RequestHead) -> None:
    """Refuse methods that nothing here takes; OPTIONS too, as no other site may ask."""
    if asked.method not in _METHODS:
        raise WrongMethod("the method must be GET, HEAD, POST or DELETE")
    if asked.method in SAFE and asked.has_body:
        raise BadRequest(f"a {asked.method} request has no body")


def check_target(asked: RequestHead, most: int) -> None:
    """Refuse paths with anything but plain letters, digits, dots, dashes and slashes.

    most: longest path and query [bytes].
    """
    if len(asked.target) + len(asked.query) > most:
        raise TooLong(f"path and query are longer than {most} bytes")
    if not _PATH.fullmatch(asked.target):
        raise NotFound("there is no such page: its path has characters that none here has")


def own_hosts(settings: ServerSettings) -> frozenset[str]:
    """Return every Host header that is the server's own."""
    given = f"[{settings.host}]" if ":" in settings.host else settings.host
    names = {*_ALWAYS, given.lower()}
    with_port = {f"{name}:{settings.port}" for name in names}
    return frozenset(with_port | names if settings.port == 80 else with_port)


def check_host(asked: RequestHead, own: frozenset[str]) -> None:
    """Refuse a request that was sent to another name."""
    if asked.headers.get("host", "").lower() not in own:
        raise NotAllowed(
            "the Host header is not this server's address: open it by the link that `rocking serve` prints"
        )


def check_origin(asked: RequestHead, own: frozenset[str]) -> None:
    """Refuse a request of another page; one that may change something must say where it comes from."""
    origin = asked.headers.get("origin")
    if origin is None:
        if asked.unsafe:
            name = asked.headers.get("host", "127.0.0.1")
            raise NotAllowed(f"the Origin header is missing: a script sends Origin: {asked.scheme}://{name}")
    elif origin.lower() not in {f"{asked.scheme}://{name}" for name in own}:
        raise NotAllowed("the Origin header names another page than this server's own")


def check_site(asked: RequestHead) -> None:
    """Refuse what a browser sends on behalf of another site, but for somebody following a link to a page."""
    site = asked.headers.get("sec-fetch-site")
    if site is None or site in _OWN_SITES:
        return
    follows_link = (
        asked.headers.get("sec-fetch-mode") == "navigate" and asked.headers.get("sec-fetch-dest") == "document"
    )
    if asked.unsafe or asked.of_api or not follows_link:
        raise NotAllowed("another site asks for this")


def content_type(asked: RequestHead) -> str:
    """Return the type of a body without its parameters.

    Returns lower case; empty if none is given.
    """
    return asked.headers.get("content-type", "").partition(";")[0].strip().lower()


def check_content(asked: RequestHead) -> None:
    """Refuse bodies of other types, in another charset, or packed."""
    kind = content_type(asked)
    if asked.headers.get("content-encoding", "identity").lower() != "identity":
        raise WrongContent("the body must not be compressed")
    if (asked.has_body or kind) and asked.unsafe and kind not in {JSON, BYTES}:
        raise WrongContent(f"Content-Type must be {JSON}, or {BYTES} for a file")
    parameters = asked.headers.get("content-type", "").partition(";")[2].replace(" ", "").lower()
    if kind == JSON and parameters not in {"", "charset=utf-8", 'charset="utf-8"'}:
        raise WrongContent("JSON must be in UTF-8")
