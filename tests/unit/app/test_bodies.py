"""Bodies of requests: limits while they arrive, JSON that is only JSON."""

import asyncio
from typing import Any

import pytest

from rocking.app.errors import Refused
from rocking.app.security.bodies import BodyLimits, check_json
from rocking.app.settings import Limits


def test_plain_json_passes() -> None:
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
        (b"[1e999]", "larger than float64"),
        (b"[9223372036854775808]", "64 bits"),
        (b"[" + b"9" * 5000 + b"]", "64 bits"),
        (b'{"a": 1, "a": 2}', "'a' is there twice"),
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
def test_other_json_is_refused(data: bytes, words: str) -> None:
    """What a lenient reader lets through is refused with a sentence that names it."""
    with pytest.raises(Refused, match=words):
        check_json(data, 32)


class Exchange:
    """A request that arrives in pieces, and what was answered."""

    def __init__(self, pieces: list[bytes], headers: dict[str, str], pause: float = 0.0) -> None:
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

    async def app(self, scope: Any, receive: Any, send: Any) -> None:
        self.seen = (await receive())["body"]
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def receive(self) -> dict[str, Any]:
        await asyncio.sleep(self.pause)
        if not self.pieces:
            return {"type": "http.disconnect"}
        piece = self.pieces.pop(0)
        self.taken += len(piece)
        return {"type": "http.request", "body": piece, "more_body": bool(self.pieces)}

    async def send(self, message: dict[str, Any]) -> None:
        self.status = message.get("status", self.status)

    def through(self, limits: Limits) -> "Exchange":
        doors = BodyLimits(self.app, limits)
        asyncio.run(doors(self.scope, self.receive, self.send))
        assert doors._held == 0
        return self


FILE = {"content-type": "application/octet-stream"}
JSON = {"content-type": "application/json"}


def test_body_arrives_whole() -> None:
    """A body in pieces is handed on as one."""
    assert Exchange([b"ab", b"", b"c"], FILE).through(Limits()).seen == b"abc"


def test_body_of_exactly_the_limit_passes() -> None:
    """The limit itself is allowed, one byte more is not, however it is cut."""
    limits = Limits(upload_bytes=10, json_bytes=5)
    assert Exchange([b"x" * 10], FILE).through(limits).seen == b"x" * 10
    for pieces in ([b"x" * 11], [b"x"] * 11):
        refused = Exchange(pieces, FILE).through(limits)
        assert (refused.status, refused.seen) == (413, None)
    assert Exchange([b'"xxx"'], JSON).through(limits).status == 200
    assert Exchange([b'"xxxx"'], JSON).through(limits).status == 413


def test_declared_length_is_refused_before_anything_is_kept() -> None:
    """A length beyond the limit is refused by the head alone; one that is no number as well."""
    for declared in ("11", "99999999999999999999999999", "-1", "0x10", "1e3"):
        assert Exchange([b"x"], {**FILE, "content-length": declared}).through(Limits(upload_bytes=10)).status == 413


def test_lying_length_does_not_help() -> None:
    """Bytes are counted, whatever length the head states."""
    assert Exchange([b"x" * 11], {**FILE, "content-length": "2"}).through(Limits(upload_bytes=10)).status == 413


def test_refused_body_is_read_on_only_for_a_while() -> None:
    """An endless body is refused after a bounded number of bytes."""
    endless = Exchange([b"x" * (1 << 20)] * 200, FILE).through(Limits(upload_bytes=10))
    assert endless.status == 413
    assert endless.taken <= 66 << 20


def test_slow_body_is_refused() -> None:
    """A body that does not arrive in time is given up with 408."""
    slow = Exchange([b"x"] * 100, FILE, pause=0.02).through(Limits(body_seconds=0.1))
    assert (slow.status, slow.seen) == (408, None)


def test_all_bodies_together_are_limited() -> None:
    """Beyond the bytes that all requests may hold together, the answer is 429."""
    assert Exchange([b"x" * 20], FILE).through(Limits(bytes_in_flight=10)).status == 429


def test_who_goes_away_is_forgotten() -> None:
    """A client that leaves in the middle gets no answer and holds nothing."""
    gone = Exchange([], FILE).through(Limits())
    assert (gone.status, gone.seen) == (0, None)


def test_long_json_is_checked_as_well() -> None:
    """A long document, which is checked beside the event loop, is refused like a short one."""
    long = b'{"a": "' + b"x" * 100_000 + b'", "b": NaN}'
    assert Exchange([long], JSON).through(Limits()).status == 422
    assert Exchange([long.replace(b"NaN", b"1.0")], JSON).through(Limits()).status == 200
