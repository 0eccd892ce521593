"""Attacks on the web application by the head of a request, each with a name: all are refused.

The same requests with one protection switched off succeed: what is tested is the protection, not a typing error here.
"""

from dataclasses import dataclass, field

import pytest
from web_clients import OWN, Page

from rocking_workbench.security import gate
from rocking_workbench.security import request_body as limits

pytestmark = pytest.mark.verifies("damage", control="test_without_the_protection_the_attack_succeeds", room="doors")

LINK = "/api/session/link"
JSON = {"content-type": "application/json"}
FORBIDDEN, UNKNOWN, TYPE, METHOD = {403}, {401}, {415}, {405}


@dataclass(frozen=True)
class Attack:
    """A request that differs from a good one in one way; a header that is None is left out."""

    name: str
    refused: set[int]
    method: str = "POST"
    path: str = LINK
    head: dict[str, str | None] = field(default_factory=dict)
    content: bytes = b""


def by_head(refused, header, values, **more):
    return [Attack(name, refused, head={header: value}, **more) for name, value in values.items()]


HOSTS = by_head(
    FORBIDDEN,
    "host",
    {
        "host: foreign name": "evil.example",
        "host: foreign name with the right port": "evil.example:8765",
        "host: no port": "127.0.0.1",
        "host: another port": "127.0.0.1:8766",
        "host: own name as a subdomain": "127.0.0.1.evil.example:8765",
        "host: own name as a prefix": "localhost.evil.example:8765",
        "host: user part": "127.0.0.1:8765@evil.example",
        "host: address as one number": "2130706433:8765",
        "host: address in octal": "0177.0.0.1:8765",
        "host: every address": "0.0.0.0:8765",
        "host: trailing dot": "localhost.:8765",
        "host: empty": "",
        "host: list": "127.0.0.1:8765, evil.example",
        "host: path": "127.0.0.1:8765/evil",
        "host: mapped address": "[::ffff:127.0.0.1]:8765",
    },
    method="GET",
    path="/api/session",
)
REBINDING = [
    Attack(f"rebinding: {what}", FORBIDDEN, method, path, head)
    for what, method, path, head in (
        ("page reads", "GET", "/", {"host": "evil.example:8765"}),
        ("script reads", "GET", "/api/openapi.json", {"host": "evil.example:8765"}),
        ("script writes", "POST", LINK, {"host": "evil.example:8765", "origin": "http://evil.example:8765"}),
        ("forwarded host", "GET", "/", {"host": "evil.example", "x-forwarded-host": "127.0.0.1:8765"}),
        ("forwarded", "GET", "/", {"host": "evil.example", "forwarded": "host=127.0.0.1:8765"}),
    )
]
ORIGINS = by_head(
    FORBIDDEN,
    "origin",
    {
        "origin: missing": None,
        "origin: null": "null",
        "origin: foreign": "http://evil.example",
        "origin: foreign with the right port": "http://evil.example:8765",
        "origin: https": "https://127.0.0.1:8765",
        "origin: no port": "http://127.0.0.1",
        "origin: another port of this machine": "http://127.0.0.1:3000",
        "origin: own name as a subdomain": "http://127.0.0.1:8765.evil.example",
        "origin: user part": "http://127.0.0.1:8765@evil.example",
        "origin: file": "file://",
        "origin: extension": "chrome-extension://abcdefghijklmnop",
        "origin: with a path": "http://127.0.0.1:8765/",
        "origin: two": "http://127.0.0.1:8765 http://evil.example",
        "origin: wildcard": "*",
        "origin: empty": "",
    },
)
ORIGINS += [
    Attack("origin: foreign page reads", FORBIDDEN, "GET", "/api/session", {"origin": "http://evil.example"}),
    Attack("origin: missing on DELETE", FORBIDDEN, "DELETE", "/api/session", {"origin": None}),
    Attack("origin: missing, own referer", FORBIDDEN, head={"origin": None, "referer": f"{OWN}/"}),
    Attack("origin: preflight", METHOD, "OPTIONS", head={"access-control-request-method": "POST"}),
    Attack(
        "origin: preflight of a private network",
        METHOD,
        "OPTIONS",
        head={"access-control-request-private-network": "true"},
    ),
]
FRAME = {"sec-fetch-mode": "navigate", "sec-fetch-dest": "iframe"}
SITES = [
    Attack("site: cross-site write", FORBIDDEN, head={"sec-fetch-site": "cross-site"}),
    Attack("site: write from another port of this machine", FORBIDDEN, head={"sec-fetch-site": "same-site"}),
    Attack("site: unknown word", FORBIDDEN, head={"sec-fetch-site": "same-origin, cross-site"}),
    Attack("site: read of the API", FORBIDDEN, "GET", "/api/session", {"sec-fetch-site": "cross-site"}),
    Attack("site: frame", FORBIDDEN, "GET", "/", {"sec-fetch-site": "cross-site", **FRAME}),
    Attack("site: script of ours in a foreign page", FORBIDDEN, "GET", "/app/main.js",
           {"sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors", "sec-fetch-dest": "script"}),
    Attack("site: API opened as a page", FORBIDDEN, "GET", "/api/openapi.json",
           {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}),
]  # fmt: skip
CONTENTS = by_head(
    TYPE,
    "content-type",
    {
        "content: form": "application/x-www-form-urlencoded",
        "content: multipart form": "multipart/form-data; boundary=x",
        "content: text form": "text/plain",
        "content: no type": None,
        "content: XML": "application/xml",
        "content: JSON of another kind": "application/ld+json",
        "content: policy report": "application/csp-report",
        "content: JSON in UTF-16": "application/json; charset=utf-16",
        "content: JSON in UTF-7": "application/json; charset=utf-7",
        "content: JSON and a form": "application/json, text/plain",
        "content: JSON in a parameter": "text/plain; application/json",
    },
    content=b"{}",
)
CONTENTS += [
    Attack(f"content: packed by {packing}", TYPE, head={**JSON, "content-encoding": packing}, content=b"\x1f\x8b\x08")
    for packing in ("gzip", "deflate", "br", "zstd", "gzip, gzip")
]
METHODS = [
    Attack(f"method: {method}", METHOD, method) for method in ("PUT", "PATCH", "TRACE", "PROPFIND", "OPTIONS", "X")
]
METHODS.append(Attack("method: GET with a body", {400}, "GET", "/api/session", {}, b"{}"))


def sessions():
    values = {
        "session: none": None,
        "session: empty": "rocking-8765=",
        "session: guessed": "rocking-8765=" + "A" * 43,
        "session: cookie of another port": "rocking-8766={value}",
        "session: cookie without a port": "rocking={value}",
        "session: cut short": "rocking-8765={short}",
        "session: in capitals": "rocking-8765={upper}",
        "session: its hash": "rocking-8765={hash}",
        "session: the token of a link": "rocking-8765={token}",
        "session: the key as a cookie": "rocking-8765={key}",
        "session: an array": "rocking-8765[]={value}",
    }
    cookies = by_head(UNKNOWN, "cookie", values)
    keys = {
        "key: wrong": "Bearer " + "A" * 43,
        "key: empty": "Bearer ",
        "key: cut short": "Bearer {key_short}",
        "key: with more behind": "Bearer {key}x",
        "key: no scheme": "{key}",
        "key: as a password": "Basic {key}",
        "key: the value of a session": "Bearer {value}",
        "key: None": "Bearer None",
    }
    cookies += [Attack(name, UNKNOWN, head={"cookie": None, "authorization": value}) for name, value in keys.items()]
    nobody = {"cookie": None}
    cookies += [
        Attack("key: in the query", UNKNOWN, path=f"{LINK}?key={{key}}&token={{token}}", head=nobody),
        Attack("session: public path with a slash", {401, 404}, "GET", "/api/session/", nobody),
        Attack("session: public path in front", UNKNOWN, path="/api/session/link", head=nobody),
        Attack("session: override of the method", UNKNOWN, head={**nobody, "x-http-method-override": "GET"}),
        Attack("session: override of the address", UNKNOWN, head={**nobody, "x-original-url": "/api/session"}),
    ]
    return cookies


ATTACKS = [*HOSTS, *REBINDING, *ORIGINS, *SITES, *CONTENTS, *METHODS, *sessions()]


def suffers(page, attack):
    head = {**page.head, **({"origin": None} if attack.method == "GET" else {}), **attack.head}
    told = {name: value.format(**page.known) for name, value in head.items() if value is not None}
    path = attack.path.format(**page.known)
    answer = page.client.request(attack.method, path, headers=told, content=attack.content or None)
    assert "Traceback" not in answer.text
    assert not [name for name in answer.headers if name.lower().startswith("access-control")]
    return answer.status_code


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return Page(tmp_path_factory.mktemp("data"))


@pytest.fixture
def fresh(tmp_path):
    return Page(tmp_path)


@pytest.fixture(autouse=True)
def _no_cookies_are_kept(page):
    page.client.cookies.clear()


@pytest.mark.verifies("behaviour")
def test_there_are_enough_attacks_and_each_has_a_name():
    """The table holds at least 80 attacks, no name twice; raw ones and contents come on top of it elsewhere."""
    names = [attack.name for attack in ATTACKS]
    assert len(names) == len(set(names)) >= 80


@pytest.mark.verifies("negative control", "the request that attacks alter")
def test_the_harness_is_good(page):
    """What the attacks alter is a request that succeeds."""
    assert suffers(page, Attack("nothing", set())) == 200
    assert suffers(page, Attack("nothing", set(), "GET", "/api/session")) == 200
    assert suffers(page, Attack("nothing", set(), "GET", "/")) == 200
    assert suffers(page, Attack("nothing", set(), "POST", LINK, dict(JSON), b"{}")) == 200


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.name)
def test_attack_is_refused(page, attack):
    """Each attack is answered with the refusal that it deserves."""
    assert suffers(page, attack) in attack.refused


WITHOUT = {
    "host": ("rebinding: script reads", 200),
    "origin": ("origin: foreign", 200),
    "site": ("site: cross-site write", 200),
    "content": ("content: text form", 200),
    "session": ("session: none", 200),
    "method": ("method: GET with a body", 200),
}


@pytest.mark.verifies("negative control", "one protection switched off")
@pytest.mark.parametrize("protection", WITHOUT)
def test_without_the_protection_the_attack_succeeds(fresh, monkeypatch, protection):
    """Negative control: with one check switched off, the attack that it stops gets through."""
    name, status = WITHOUT[protection]
    attack = next(attack for attack in ATTACKS if attack.name == name)
    assert suffers(fresh, attack) in attack.refused
    monkeypatch.delitem(gate.CHECKS, protection)
    if name == "content: text form":  # the checks of JSON are not what is tried here
        monkeypatch.setattr(limits, "check_json", lambda data, depth: None)
    assert suffers(fresh, attack) == status


def sign_in(page, token, **head):
    told = {"host": "127.0.0.1:8765", "origin": OWN, **head}
    return page.client.post("/api/session", json={"token": token}, headers=told)


def test_token_is_good_once(fresh):
    """Token reuse: the second browser with the same link is refused."""
    assert sign_in(fresh, fresh.known["token"]).status_code == 200
    assert sign_in(fresh, fresh.known["token"]).status_code == 401


def test_fixed_session_is_not_taken_over(fresh):
    """Session fixation: a cookie that an attacker planted is worth nothing after somebody signs in."""
    planted = "rocking-8765=" + "F" * 43
    answer = sign_in(fresh, fresh.known["token"], cookie=planted)
    assert planted not in answer.headers["Set-Cookie"]
    fresh.client.cookies.clear()
    assert suffers(fresh, Attack("planted", set(), head={"cookie": planted})) == 401


@pytest.mark.verifies(control="within")
def test_guessing_is_slowed_down(fresh, tmp_path):
    """Token guessing: ten a minute are looked at; without that limit (the control) all are."""
    statuses = [sign_in(fresh, f"{guess:043d}").status_code for guess in range(30)]
    assert statuses == [401] * 10 + [429] * 20
    assert sign_in(fresh, fresh.known["token"]).headers["Retry-After"]
    patient = Page(tmp_path / "patient", wrong_tokens=10_000)
    assert {sign_in(patient, f"{guess:043d}").status_code for guess in range(30)} == {401}


def test_guessing_does_not_shut_out_who_is_inside(fresh):
    """A stranger who guesses can neither sign anybody out nor stop a script with the key."""
    for guess in range(30):
        sign_in(fresh, f"{guess:043d}")
    assert suffers(fresh, Attack("inside", set())) == 200


@pytest.mark.verifies(control="within")
def test_flood_is_refused_before_it_is_read(tmp_path):
    """A body beyond the limit is 413; with a higher limit (the control) it is read."""
    attack = Attack(
        "flood", {413}, path="/api/session", head=dict(JSON), content=b'{"token": "' + b"x" * 3_000_000 + b'"}'
    )
    assert suffers(Page(tmp_path / "a"), attack) == 413
    assert suffers(Page(tmp_path / "b", json_bytes=4_000_000), attack) == 422


@pytest.mark.verifies(control="within")
def test_duplicate_keys_do_not_smuggle(fresh, monkeypatch):
    """A key twice, of which two readers may take different ones, is refused; without the check one of them wins."""
    content = ('{"token": "wrong", "token": "' + fresh.known["token"] + '"}').encode()
    attack = Attack("twice", {422}, path="/api/session", head={**JSON, "cookie": None}, content=content)
    assert suffers(fresh, attack) == 422
    monkeypatch.setattr(limits, "check_json", lambda data, depth: None)
    assert suffers(fresh, attack) == 200
