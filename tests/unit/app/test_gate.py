"""The gate: what passes, what is refused and how it is told."""

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from rocking.app.errors import BadRequest, NotAllowed, NotFound, WrongContent, WrongMethod
from rocking.app.security.requests import (
    RequestHead,
    TooLong,
    check_content,
    check_host,
    check_method,
    check_origin,
    check_site,
    check_target,
    own_hosts,
)
from rocking.app.settings import ServerSettings

OWN = own_hosts(ServerSettings())


def asked(method: str = "GET", target: str = "/api/info", query: str = "", **headers: str) -> RequestHead:
    return RequestHead(
        method, target, query, "http", {name.replace("_", "-"): value for name, value in headers.items()}
    )


def test_own_hosts_are_loopback_and_the_given_address() -> None:
    """The server's names: three of loopback, the address it was given, and the bare names on port 80 only."""
    assert own_hosts(ServerSettings()) == {"127.0.0.1:8765", "localhost:8765", "[::1]:8765"}
    assert "[fd00::1]:8765" in own_hosts(ServerSettings(host="fd00::1"))
    assert "localhost" in own_hosts(ServerSettings(port=80))


@pytest.mark.parametrize("host", ["127.0.0.1:8765", "LOCALHOST:8765", "[::1]:8765"])
def test_own_host_passes(host: str) -> None:
    """A request to one of the server's own names passes, whatever its case."""
    check_host(asked(host=host), OWN)


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "localhost.evil.example:8765", ""])
def test_foreign_host_is_refused(host: str) -> None:
    """A request to any other name is refused."""
    with pytest.raises(NotAllowed):
        check_host(asked(host=host), OWN)


@pytest.mark.parametrize("method", ["POST", "DELETE", "WEBSOCKET"])
def test_unsafe_needs_an_origin_of_ours(method: str) -> None:
    """What may change something must name our own page; reading needs no Origin, but a foreign one is refused."""
    check_origin(asked(method, origin="http://localhost:8765"), OWN)
    check_origin(asked("GET"), OWN)
    for refused in (asked(method), asked(method, origin="null"), asked("GET", origin="http://evil.example")):
        with pytest.raises(NotAllowed):
            check_origin(refused, OWN)


def test_only_a_followed_link_comes_from_another_site() -> None:
    """Another site may link to a page, but may not load, frame or ask the API."""
    link = {"sec_fetch_mode": "navigate", "sec_fetch_dest": "document"}
    check_site(asked(target="/", sec_fetch_site="cross-site", **link))
    check_site(asked("POST", sec_fetch_site="same-origin"))
    frame = {"sec_fetch_mode": "navigate", "sec_fetch_dest": "iframe"}
    for refused in (
        asked(target="/", sec_fetch_site="cross-site", **frame),
        asked(target="/api/info", sec_fetch_site="cross-site", **link),
        asked("POST", target="/", sec_fetch_site="same-site", **link),
    ):
        with pytest.raises(NotAllowed):
            check_site(refused)


@pytest.mark.parametrize(
    "target", ["/", "/api/info", "/app/main.js", "/vendor/uplot/uPlot.esm.js", "/api/picture/body.png"]
)
def test_plain_paths_pass(target: str) -> None:
    """The paths that exist are plain."""
    check_target(asked(target=target), 4096)


@pytest.mark.parametrize("target", ["", "//", "/../x", "/a/./b", "/%2e", "/a\\b", "/.git", "/a b", "http://e/", "*"])
def test_other_paths_are_refused(target: str) -> None:
    """A path with anything but plain parts does not exist."""
    with pytest.raises(NotFound):
        check_target(asked(target=target), 4096)


def test_long_target_is_refused() -> None:
    """Path and query together have a limit."""
    check_target(asked(target="/a", query="x" * 4094), 4096)
    with pytest.raises(TooLong):
        check_target(asked(target="/a", query="x" * 4095), 4096)


def test_methods() -> None:
    """GET, HEAD, POST and DELETE pass, nothing else does, and what reads has no body."""
    for method in ("GET", "HEAD", "POST", "DELETE"):
        check_method(asked(method))
    for method in ("OPTIONS", "PUT", "PATCH", "TRACE", "CONNECT", "get", "PROPFIND"):
        with pytest.raises(WrongMethod):
            check_method(asked(method))
    with pytest.raises(BadRequest):
        check_method(asked("GET", content_length="3"))


@pytest.mark.parametrize(
    "kind", ["application/json", "application/json; charset=utf-8", "Application/JSON", "application/octet-stream"]
)
def test_json_and_bytes_pass(kind: str) -> None:
    """The two types of bodies pass."""
    check_content(asked("POST", content_type=kind, content_length="2"))


@pytest.mark.parametrize(
    "headers",
    [
        {"content_type": "text/plain"},
        {"content_type": "multipart/form-data; boundary=x"},
        {"content_type": "application/json; charset=utf-16"},
        {"content_type": "application/json", "content_encoding": "gzip"},
        {"content_length": "2"},
        {"transfer_encoding": "chunked"},
    ],
)
def test_other_bodies_are_refused(headers: dict[str, str]) -> None:
    """A body of another type, charset or packing is refused, and one without a type."""
    with pytest.raises(WrongContent):
        check_content(asked("POST", **headers))


def test_header_twice_is_refused() -> None:
    """A header that decides something must not be there twice."""
    scope = {
        "type": "http",
        "method": "GET",
        "scheme": "http",
        "path": "/",
        "headers": [(b"host", b"a"), (b"Host", b"b")],
    }
    with pytest.raises(BadRequest):
        RequestHead.of(scope)


def test_without_a_session_only_the_door_is_open(app: FastAPI, stranger: TestClient) -> None:
    """Every endpoint in the schema but the three public ones answers 401 to a stranger."""
    public = {("get", "/api/session"), ("post", "/api/session"), ("get", "/api/openapi.json")}
    head = {"Origin": "http://127.0.0.1:8765", "Content-Type": "application/json"}
    for path, item in app.openapi()["paths"].items():
        for method in set(item) - {"parameters"}:
            if (method, path) in public:
                continue
            target = path.replace("{", "").replace("}", "")
            content = b"{}" if method == "post" else None
            head_of = head if method == "post" else {"Origin": head["Origin"]}
            assert stranger.request(method, target, content=content, headers=head_of).status_code == 401, (method, path)


def test_key_and_cookie_open_the_same_door(client: TestClient) -> None:
    """A script with the key is signed in; with a wrong key it is not, even with a good cookie."""
    assert client.get("/api/session").json() == {"signed_in": True}
    assert client.get("/api/session", headers={"Authorization": "Bearer nonsense"}).json() == {"signed_in": False}


def test_headers_are_on_every_answer(client: TestClient) -> None:
    """Pages, the API, refusals and things that do not exist all carry the same protective headers."""
    for path, status, kept in (
        ("/", 200, "no-cache"),
        ("/api/session", 200, "no-store"),
        ("/api/nothing", 404, "no-store"),
        ("/%2e", 404, "no-cache"),
    ):
        answer = client.get(path)
        assert answer.status_code == status, path
        assert answer.headers["Content-Security-Policy"].startswith("default-src 'none'; script-src 'self';")
        assert "unsafe" not in answer.headers["Content-Security-Policy"]
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
        assert answer.headers["Referrer-Policy"] == "no-referrer"
        assert answer.headers["Cross-Origin-Opener-Policy"] == "same-origin"
        assert answer.headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert "camera=()" in answer.headers["Permissions-Policy"]
        assert answer.headers["Cache-Control"] == kept
        assert "Server" not in answer.headers
        assert not [name for name in answer.headers if name.lower().startswith("access-control")]
