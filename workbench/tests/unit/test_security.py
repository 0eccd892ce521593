"""Who may ask and what: the head of a request, its body while it arrives, one-time links, sessions, the key."""

import asyncio
import math
import re
from contextlib import contextmanager

import pytest
from fastapi.testclient import TestClient

from rocking_workbench.errors import Busy, Refused
from rocking_workbench.pages import FILES
from rocking_workbench.security.gate import (
    RequestHead,
    check_content,
    check_host,
    check_method,
    check_origin,
    check_site,
    check_target,
    own_hosts,
)
from rocking_workbench.security.request_body import BodyLimits, check_json
from rocking_workbench.security.sessions import Sessions, new_token
from rocking_workbench.settings import Limits, ServerSettings

OWN = own_hosts(ServerSettings())


@contextmanager
def refused(status):
    with pytest.raises(Refused) as caught:
        yield
    assert caught.value.status == status


def head(method="GET", target="/api/info", query="", **headers):
    return RequestHead(
        method, target, query, "http", {name.replace("_", "-"): value for name, value in headers.items()}
    )


def test_own_hosts_are_loopback_and_the_given_address():
    """The server's names: three of loopback, the address it was given, and the bare names on port 80 only."""
    assert own_hosts(ServerSettings()) == {"127.0.0.1:8765", "localhost:8765", "[::1]:8765"}
    assert "[fd00::1]:8765" in own_hosts(ServerSettings(host="fd00::1"))
    assert "localhost" in own_hosts(ServerSettings(port=80))


LINK = {"sec_fetch_mode": "navigate", "sec_fetch_dest": "document"}
PLAIN = ("/", "/api/info", "/app/main.js", "/vendor/uplot/uPlot.esm.js", "/api/table/body.csv")
BODIES = ("application/json; charset=utf-8", "Application/JSON", "application/octet-stream")
GOOD = [
    *((check_host, head(host=host)) for host in ("127.0.0.1:8765", "LOCALHOST:8765", "[::1]:8765")),
    *((check_origin, head(method, origin="http://localhost:8765")) for method in ("POST", "DELETE", "WEBSOCKET")),
    (check_origin, head("GET")),
    (check_site, head(target="/", sec_fetch_site="cross-site", **LINK)),
    (check_site, head("POST", sec_fetch_site="same-origin")),
    *((check_target, head(target=target)) for target in PLAIN),
    (check_target, head(target="/a", query="x" * 4094)),
    *((check_method, head(method)) for method in ("GET", "HEAD", "POST", "DELETE")),
    *((check_content, head("POST", content_type=kind, content_length="2")) for kind in BODIES),
]
STRANGE = ("", "//", "/../x", "/a/./b", "/%2e", "/a\\b", "/.git", "/a b", "http://e/", "*")
# hosts, origins, sites, methods, contents and headers that others would send are in verification/test_web_attacks
BAD = [
    (403, check_host, head(host="127.0.0.1:1")),
    *((403, check_origin, head(method)) for method in ("POST", "DELETE", "WEBSOCKET")),
    (403, check_site, head("POST", target="/", sec_fetch_site="same-site", **LINK)),
    *((404, check_target, head(target=target)) for target in STRANGE),
    (414, check_target, head(target="/a", query="x" * 4095)),
    *((405, check_method, head(method)) for method in ("CONNECT", "get")),
    (415, check_content, head("POST", content_length="2")),
    (415, check_content, head("POST", transfer_encoding="chunked")),
]


def looked_at(check, sent):
    """Run one check of a head, with what it needs of the server."""
    more = {check_host: (OWN,), check_origin: (OWN,), check_target: (4096,)}
    check(sent, *more.get(check, ()))


def test_what_our_page_and_scripts_send_passes():
    """Own hosts in any case, own origins, plain paths, four methods, two types of bodies, a link that is followed."""
    for check, sent in GOOD:
        looked_at(check, sent)


@pytest.mark.parametrize(("status", "check", "sent"), BAD)
def test_what_nothing_of_ours_sends_is_refused(status, check, sent):
    """Each check refuses with its own status."""
    with refused(status):
        looked_at(check, sent)


def test_header_twice_is_refused():
    """A header that decides something must not be there twice."""
    twice = [(b"host", b"a"), (b"Host", b"b")]
    with refused(400):
        RequestHead.of({"type": "http", "method": "GET", "scheme": "http", "path": "/", "headers": twice})


def test_without_a_session_only_the_door_is_open(app, stranger):
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


def test_key_and_cookie_open_the_same_door(client):
    """A script with the key is signed in; with a wrong key it is not, even with a good cookie."""
    assert client.get("/api/session").json() == {"signed_in": True}
    assert client.get("/api/session", headers={"Authorization": "Bearer nonsense"}).json() == {"signed_in": False}


def test_headers_are_on_every_answer(client):
    """Pages, the API, refusals and things that do not exist all carry the same protective headers."""
    for path, status, kept in (
        ("/", 200, "no-cache"),
        ("/app/main.js", 200, "no-cache"),
        (f"/{FILES.fingerprint}/app/main.js", 200, "private, max-age=31536000, immutable"),
        (f"/{FILES.fingerprint}/app/absent.js", 404, "no-cache"),
        ("/0123456789abcdef/app/main.js", 404, "no-cache"),
        ("/api/session", 200, "no-store"),
        ("/api/nothing", 404, "no-store"),
        ("/%2e", 404, "no-cache"),
    ):
        answer = client.get(path)
        assert answer.status_code == status, path
        assert answer.headers["Content-Security-Policy"].startswith("default-src 'none'; script-src 'self' 'sha256-")
        assert "unsafe" not in answer.headers["Content-Security-Policy"]
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
        assert answer.headers["Referrer-Policy"] == "no-referrer"
        assert answer.headers["Cross-Origin-Opener-Policy"] == "same-origin"
        assert answer.headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert "camera=()" in answer.headers["Permissions-Policy"]
        assert answer.headers["Cache-Control"] == kept
        assert "Server" not in answer.headers
        assert not [name for name in answer.headers if name.lower().startswith("access-control")]


def test_plain_json_passes():
    """Numbers of float64 and of 64 bits, text in every script, and 32 levels pass."""
    check_json('{"a": [1, -2.5e-300, 9223372036854775807, "ü\\ud83d\\ude00\\n", null, true]}'.encode(), 32)
    check_json(b"[" * 32 + b"]" * 32, 32)
    check_json(b'"' + b"[" * 1000 + b'\\"{"', 32)
    check_json(b"", 32)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b'{"a": NaN}', "NaN"),
        (b"[-Infinity]", "-Infinity"),
        (b"[1e999]", "exceeds the range of float64"),
        (b"[9223372036854775808]", "64 bits"),
        (b"[" + b"9" * 5000 + b"]", "64 bits"),
        (b'{"a": 1, "a": 2}', "the key 'a' appears twice"),
        (b"[" * 33 + b"]" * 33, "deeper than 32"),
        (b"[" * 100_000, "deeper than 32"),
        (b'{"a":' * 100_000, "deeper than 32"),
        (b'["\\u0000"]', "NUL"),
        (b'["\\ud800"]', "lone surrogate"),
        (b"\xff\xfe[\x00]\x00", "UTF-8"),
        (b"\xef\xbb\xbf[]", "not JSON"),
        (b"{'a': 1}", "not JSON"),
        (b"[1,]", "not JSON"),
        (b"[1] [2]", "not JSON"),
    ],
)
def test_other_json_is_refused(data, words):
    """What a lenient reader lets through is refused with a sentence that names it."""
    with pytest.raises(Refused, match=words):
        check_json(data, 32)


class Exchange:
    """A request that arrives in pieces, and what was answered."""

    def __init__(self, pieces, headers, pause=0.0):
        self.pieces, self.pause = list(pieces), pause
        self.scope = {
            "type": "http",
            "method": "POST",
            "scheme": "http",
            "path": "/api/records",
            "headers": [(name.encode(), value.encode()) for name, value in headers.items()],
        }
        self.taken = 0
        self.status = 0
        self.seen: bytes | None = None

    async def app(self, scope, receive, send):
        self.seen = (await receive())["body"]
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def receive(self):
        await asyncio.sleep(self.pause)
        if not self.pieces:
            return {"type": "http.disconnect"}
        piece = self.pieces.pop(0)
        self.taken += len(piece)
        return {"type": "http.request", "body": piece, "more_body": bool(self.pieces)}

    async def send(self, message):
        self.status = message.get("status", self.status)

    def through(self, limits):
        doors = BodyLimits(self.app, limits)
        asyncio.run(doors(self.scope, self.receive, self.send))
        assert doors._held == 0
        return self


FILE = {"content-type": "application/octet-stream"}
JSON = {"content-type": "application/json"}


def test_body_arrives_whole():
    """A body in pieces is handed on as one."""
    assert Exchange([b"ab", b"", b"c"], FILE).through(Limits()).seen == b"abc"


def test_body_of_exactly_the_limit_passes():
    """The limit itself is allowed, one byte more is not, however it is cut."""
    limits = Limits(upload_bytes=10, json_bytes=5)
    assert Exchange([b"x" * 10], FILE).through(limits).seen == b"x" * 10
    for pieces in ([b"x" * 11], [b"x"] * 11):
        refused = Exchange(pieces, FILE).through(limits)
        assert (refused.status, refused.seen) == (413, None)
    assert Exchange([b'"xxx"'], JSON).through(limits).status == 200
    assert Exchange([b'"xxxx"'], JSON).through(limits).status == 413


def test_declared_length_is_refused_before_anything_is_kept():
    """A length beyond the limit is refused by the head alone; one that is no number as well."""
    for declared in ("11", "99999999999999999999999999", "-1", "0x10", "1e3"):
        assert Exchange([b"x"], {**FILE, "content-length": declared}).through(Limits(upload_bytes=10)).status == 413


def test_lying_length_does_not_help():
    """Bytes are counted, whatever length the head states."""
    assert Exchange([b"x" * 11], {**FILE, "content-length": "2"}).through(Limits(upload_bytes=10)).status == 413


def test_refused_body_is_read_on_only_for_a_while():
    """An endless body is refused after a bounded number of bytes."""
    endless = Exchange([b"x" * (1 << 20)] * 200, FILE).through(Limits(upload_bytes=10))
    assert endless.status == 413
    assert endless.taken <= 66 << 20


def test_slow_body_is_refused():
    """A body that does not arrive in time is given up with 408."""
    slow = Exchange([b"x"] * 100, FILE, pause=0.02).through(Limits(body_seconds=0.1))
    assert (slow.status, slow.seen) == (408, None)


def test_all_bodies_together_are_limited():
    """Beyond the bytes that all requests may hold together, the answer is 429."""
    assert Exchange([b"x" * 20], FILE).through(Limits(bytes_in_flight=10)).status == 429


def test_who_goes_away_is_forgotten():
    """A client that leaves in the middle gets no answer and holds nothing."""
    gone = Exchange([], FILE).through(Limits())
    assert (gone.status, gone.seen) == (0, None)


def test_long_json_is_checked_as_well():
    """A long document, which is checked beside the event loop, is refused like a short one."""
    long = b'{"a": "' + b"x" * 100_000 + b'", "b": NaN}'
    assert Exchange([long], JSON).through(Limits()).status == 422
    assert Exchange([long.replace(b"NaN", b"1.0")], JSON).through(Limits()).status == 200


ORIGIN = {"Origin": "http://127.0.0.1:8765"}


class Clock:
    def __init__(self):
        self.now = 1000.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def sessions(clock):
    return Sessions(Limits(), clock)


def test_tokens_have_256_bits_and_differ():
    """A token is 43 letters of the URL alphabet (32 bytes), and none comes twice."""
    tokens = {new_token() for _ in range(1000)}
    assert len(tokens) == 1000
    assert all(re.fullmatch(r"[A-Za-z0-9_-]{43}", token) for token in tokens)


def test_later_link_gets_too_old(sessions, clock):
    """A link for another browser is good for 15 minutes, the first one for ever."""
    first, early, late = sessions.new_link(math.inf), sessions.new_link(), sessions.new_link()
    clock.now += 899.0
    assert sessions.knows(sessions.sign_in(early))
    clock.now += 2.0
    with pytest.raises(Refused, match="wrong, used up or too old"):
        sessions.sign_in(late)
    clock.now += 1e6
    assert sessions.knows(sessions.sign_in(first))


def test_session_ends_after_idle_hours(sessions, clock):
    """A session that is used stays; one that is idle for more than 12 h ends."""
    value = sessions.sign_in(sessions.new_link(math.inf))
    for _ in range(3):
        clock.now += 12 * 3600.0
        assert sessions.knows(value)
    clock.now += 12 * 3600.0 + 1.0
    assert not sessions.knows(value)


def test_eleventh_wrong_token_within_a_minute_is_not_looked_at(sessions, clock):
    """After ten wrong tokens the door is shut for the rest of the minute, for the right one too."""
    token = sessions.new_link(math.inf)
    for _ in range(10):
        with pytest.raises(Refused, match="wrong, used up or too old"):
            sessions.sign_in("wrong")
    with pytest.raises(Busy) as caught:
        sessions.sign_in(token)
    assert caught.value.seconds == pytest.approx(60.0)
    clock.now += 60.0
    assert sessions.knows(sessions.sign_in(token))


def test_nothing_secret_is_kept_but_the_key(sessions):
    """Links and sessions are kept as hashes: what they are cannot be read from memory."""
    token = sessions.new_link(math.inf)
    kept = repr({name: value for name, value in vars(sessions).items() if name != "key"})
    value = sessions.sign_in(token)
    kept += repr({name: value for name, value in vars(sessions).items() if name != "key"})
    assert token not in kept
    assert value not in kept


def test_number_of_sessions_and_links_is_bounded(sessions):
    """The 65th browser takes the place of the one that was idle longest; the 17th link that of the oldest."""
    values = [sessions.sign_in(sessions.new_link()) for _ in range(64)]
    assert sessions.knows(values[0])
    newest = sessions.sign_in(sessions.new_link())
    assert sessions.knows(newest)
    assert sessions.knows(values[0])
    assert not sessions.knows(values[1])
    links = [sessions.new_link() for _ in range(17)]
    with pytest.raises(Refused, match="wrong, used up or too old"):
        sessions.sign_in(links[0])
    assert sessions.sign_in(links[1])


def test_browser_signs_in_and_out(stranger):
    """A link becomes a cookie that scripts cannot read and other sites cannot send, until somebody signs out."""
    token = stranger.app.state.rocking.sessions.new_link(math.inf)
    assert stranger.get("/api/session").json() == {"signed_in": False}
    answer = stranger.post("/api/session", json={"token": token}, headers=ORIGIN)
    assert answer.json() == {"signed_in": True}
    words = answer.headers["Set-Cookie"].lower().split("; ")
    assert words[0].startswith("rocking-8765=")
    assert {"httponly", "samesite=strict", "path=/"} <= set(words)
    assert "secure" not in words  # the connection is not encrypted: with it the browser would drop the cookie
    assert not [word for word in words if word.startswith("domain")]
    assert stranger.get("/api/session").json() == {"signed_in": True}
    assert stranger.delete("/api/session", headers=ORIGIN).json() == {"signed_in": False}
    assert stranger.get("/api/session").json() == {"signed_in": False}


def test_cookie_is_secure_where_the_connection_is(app):
    """Behind an encrypted connection the cookie is marked Secure."""
    with TestClient(app, base_url="https://127.0.0.1:8765") as browser:  # type: ignore[arg-type]
        token = browser.app.state.rocking.sessions.new_link(math.inf)  # type: ignore[attr-defined]
        head = {"Origin": "https://127.0.0.1:8765"}
        answer = browser.post("/api/session", json={"token": token}, headers=head)
    assert "; secure" in answer.headers["Set-Cookie"].lower()


def test_signed_in_browser_makes_a_link_for_another(client, stranger):
    """A link made by somebody signed in signs a stranger in."""
    url = client.post("/api/session/link").json()["url"]
    assert url.startswith("http://127.0.0.1:8765/#token=")
    token = url.partition("#token=")[2]
    assert stranger.post("/api/session", json={"token": token}, headers=ORIGIN).status_code == 200
    assert stranger.get("/api/session").json() == {"signed_in": True}
