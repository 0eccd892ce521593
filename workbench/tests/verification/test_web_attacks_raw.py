"""Attacks that no client library sends: bytes on a socket of a real server, each with a name; all are refused."""

import contextlib
import json
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from urllib.request import urlopen

import pytest
import uvicorn
from waiting import HANG

from rocking_workbench import server
from rocking_workbench.application import create_app
from rocking_workbench.settings import ServerSettings

pytestmark = pytest.mark.verifies("damage", room="doors")

SECRET = "root:x:"
GONE = 0
"""No answer: the server waits for the rest, or has ended the connection."""
CHUNKED = b"Transfer-Encoding: chunked\r\n"
UPGRADE = b"GET /api/studies/live HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"


@dataclass(frozen=True)
class Target:
    """A server that listens."""

    port: int
    key: str
    folder: Path

    @property
    def head(self) -> bytes:
        return (
            f"Host: 127.0.0.1:{self.port}\r\nOrigin: http://127.0.0.1:{self.port}\r\n"
            f"Authorization: Bearer {self.key}\r\nContent-Type: application/json\r\n"
        ).encode()

    def answers(self, sent: bytes, patience: float = HANG) -> tuple[list[int], bytes]:
        """Return the statuses that come back, and everything that does; patience is for the first of them."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=patience) as line:
            came = bytearray()
            with contextlib.suppress(ConnectionError, TimeoutError):
                line.sendall(sent)
                while piece := line.recv(1 << 16):
                    came += piece
                    line.settimeout(0.1)
        return [int(status) for status in re.findall(rb"^HTTP/1\.1 (\d{3})", came, re.MULTILINE)], bytes(came)


@pytest.fixture(scope="module")
def target(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Target]:
    folder = tmp_path_factory.mktemp("data")
    command = [sys.executable, "-m", "rocking", "serve", "--json", "--port", "0", "--data", str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        told = json.loads(process.stdout.readline())
        yield Target(told["port"], Path(told["key_file"]).read_text(), folder)
        process.terminate()
        _, errors = process.communicate(timeout=HANG)
    assert process.returncode == 0
    assert "Traceback" not in errors


def get(path: bytes) -> bytes:
    return b"GET " + path + b" HTTP/1.1\r\n{head}\r\n"


PATHS = {
    "dots": b"/../../../../etc/passwd",
    "dots in the middle": b"/app/../../../../../../etc/passwd",
    "dots at the end": b"/app/..",
    "encoded dots": b"/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
    "encoded slashes": b"/..%2f..%2f..%2fetc%2fpasswd",
    "encoded twice": b"/%252e%252e%252fetc%252fpasswd",
    "overlong UTF-8": b"/%c0%ae%c0%ae/etc/passwd",
    "backslashes": b"/..\\..\\..\\etc\\passwd",
    "encoded backslashes": b"/..%5c..%5cetc%5cpasswd",
    "dots and semicolon": b"/..;/..;/etc/passwd",
    "absolute in two slashes": b"//etc/passwd",
    "NUL": b"/index.html%00.png",
    "hidden file": b"/.git/config",
    "drive": b"/C:/Windows/win.ini",
    "stream": b"/index.html::$DATA",
    "own source": b"/application.py",
    "own source by dots": b"/../application.py",
    "folder listing": b"/app/",
    "key of the data folder": b"/api-key",
    "encoded API": b"/%61pi/session/link",
    "API in capitals": b"/API/session/link",
    "API by two slashes": b"/api//session/link",
    "API by dots": b"/app/../api/session/link",
    "question mark encoded": b"/api/session%3f",
    "line break": b"/%0d%0aSet-Cookie:%20a=b",
    "very long": b"/" + b"a" * 8000,
    "very long query": b"/?" + b"a" * 8000,
    "record by dots": b"/api/records/..%2f..%2fapi-key",
    "study by dots": b"/api/studies/../../api-key",
    "study that is no study": b"/api/studies/%2e%2e/result",
    "another server": b"http://evil.example/",
    "authority": b"evil.example:80",
    "star": b"*",
}


@pytest.mark.parametrize("name", PATHS)
def test_path_leads_nowhere(target: Target, name: str) -> None:
    """No form of a path leads out of the pages or around the gate; nothing secret comes back."""
    statuses, came = target.answers(get(PATHS[name]).replace(b"{head}", target.head))
    assert set(statuses) <= {400, 404, 405, 414, 422}
    assert SECRET not in came.decode("latin-1")
    assert target.key.encode() not in came
    assert b"Set-Cookie" not in came


def post(extra: bytes, body: bytes, path: bytes = b"/api/session/link") -> bytes:
    return b"POST " + path + b" HTTP/1.1\r\n{head}" + extra + b"\r\n" + body


SMUGGLED = b"POST /api/session/link HTTP/1.1\r\nHost: evil.example\r\n\r\n"
RAW: dict[str, tuple[bytes, set[int]]] = {
    "two hosts": (get(b"/").replace(b"{head}", b"{head}Host: evil.example\r\n"), {400}),
    "no host": (b"GET / HTTP/1.1\r\n\r\n", {400, 403}),
    "no host, HTTP/1.0": (b"GET / HTTP/1.0\r\n\r\n", {403}),
    "HTTP/0.9": (b"GET /\r\n\r\n", {400}),
    "HTTP/2 by force": (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", {400, 405, 505}),
    "TLS": (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + b"\x00" * 100, {400}),
    "small letters": (get(b"/").replace(b"GET", b"get"), {400, 405}),
    "space in the method": (get(b"/").replace(b"GET", b"GE T"), {400}),
    "two origins": (post(b"Origin: http://evil.example\r\nContent-Length: 2\r\n", b"{}"), {400}),
    "two keys": (post(b"Authorization: Bearer x\r\nContent-Length: 2\r\n", b"{}"), {400}),
    "two types": (post(b"Content-Type: text/plain\r\nContent-Length: 2\r\n", b"{}"), {400}),
    "two lengths": (post(b"Content-Length: 2\r\nContent-Length: 60\r\n", b"{}" + SMUGGLED), {400}),
    "length and chunks": (post(b"Content-Length: 6\r\n" + CHUNKED, b"0\r\n\r\n" + SMUGGLED), {200, 400}),
    "chunks of another name": (post(b"Transfer-Encoding: xchunked\r\n", b"0\r\n\r\n"), {400, 501}),
    "chunks and gzip": (post(b"Transfer-Encoding: gzip, chunked\r\n", b"0\r\n\r\n"), {400, 501}),
    "chunks in a folded line": (post(b"Transfer-Encoding:\r\n chunked\r\n", b"0\r\n\r\n"), {200, 400}),
    "space before the colon": (post(b"Content-Length : 2\r\n", b"{}"), {400}),
    "negative length": (post(b"Content-Length: -2\r\n", b"{}"), {400}),
    "length with a sign": (post(b"Content-Length: +2\r\n", b"{}"), {400}),
    "length in hexadecimal": (post(b"Content-Length: 0x2\r\n", b"{}"), {400}),
    "length with more digits than a number has": (post(b"Content-Length: " + b"9" * 30 + b"\r\n", b"{}"), {400, 413}),
    "length that lies": (post(b"Content-Length: 60\r\n", b"{}"), {GONE, 400}),
    "length of a gigabyte": (post(b"Content-Length: 1000000000\r\n", b"{}"), {413}),
    "chunk of a wrong size": (post(CHUNKED, b"zz\r\n{}\r\n0\r\n\r\n"), {400}),
    "chunk of an enormous size": (post(CHUNKED, b"f" * 40 + b"\r\n{}\r\n0\r\n\r\n"), {400}),
    "flood in chunks": (post(CHUNKED, (b"10000\r\n" + b"x" * 65536 + b"\r\n") * 40 + b"0\r\n\r\n"), {413}),
    "long header": (get(b"/").replace(b"{head}", b"{head}X: " + b"a" * 100_000 + b"\r\n"), {GONE, 400, 431}),
    "many headers": (get(b"/").replace(b"{head}", b"{head}" + b"X: a\r\n" * 20_000), {GONE, 400, 431}),
    "NUL in a header": (get(b"/").replace(b"{head}", b"{head}X: a\x00b\r\n"), {400}),
    "line break in a header": (get(b"/").replace(b"{head}", b"{head}X: a\rSet-Cookie: b\r\n"), {400}),
    "line feed alone": (post(b"X: a\n\nContent-Length: 0\r\n", SMUGGLED), {200, 400, 415, 422}),
    "second request behind": (get(b"/") + SMUGGLED, {200, 403}),
    "upgrade to HTTP/2": (get(b"/").replace(b"{head}", b"{head}Connection: Upgrade\r\nUpgrade: h2c\r\n"), {200}),
    "connect": (b"CONNECT 127.0.0.1:22 HTTP/1.1\r\n{head}\r\n", {400, 404, 405}),
    "trace": (b"TRACE / HTTP/1.1\r\n{head}\r\n", {405}),
    "deep JSON": (post(b"Content-Length: 200000\r\n", b"[" * 200_000, b"/api/session"), {422}),
    "numbers without end": (post(b"Content-Length: 200000\r\n", b"9" * 200_000, b"/api/session"), {422}),
    "websocket of another page": (
        UPGRADE + b"Host: 127.0.0.1:{port}\r\nOrigin: http://evil.example\r\nSec-WebSocket-Version: 13\r\n"
        b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n",
        {403},
    ),
    "websocket with bad words": (UPGRADE + b"{head}Sec-WebSocket-Version: 99\r\n\r\n", {400, 426}),
}  # fmt: skip


@pytest.mark.parametrize("name", RAW)
def test_raw_attack_is_refused(target: Target, name: str) -> None:
    """Bytes that two readers could take for different requests, floods and lies are refused; nothing is smuggled."""
    sent, allowed = RAW[name]
    sent = sent.replace(b"{head}", target.head).replace(b"{port}", str(target.port).encode())
    statuses, came = target.answers(sent, 1.0 if GONE in allowed else HANG)
    assert set(statuses or [GONE]) <= allowed
    assert SECRET not in came.decode("latin-1")
    assert b"Traceback" not in came
    assert came.count(b"#token=") <= 1  # the request in front may succeed, what hides in its body never does
    with urlopen(f"http://127.0.0.1:{target.port}/", timeout=HANG) as page:
        assert page.status == 200


@pytest.mark.verifies("behaviour")
def test_names_are_many() -> None:
    """Paths and raw requests together are at least 60, each with a name."""
    assert len(PATHS) + len(RAW) >= 60


@pytest.fixture
def impatient(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Target]:
    monkeypatch.setattr(server, "_HEAD_SECONDS", 1.0)
    with socket.create_server(("127.0.0.1", 0)) as door:
        port = door.getsockname()[1]
        app = create_app(ServerSettings(folder=tmp_path, port=port))
        served = uvicorn.Server(server._config(app))
        thread = threading.Thread(target=served.run, kwargs={"sockets": [door]})
        thread.start()
        while not served.started:
            time.sleep(0.01)
        yield Target(port, app.state.rocking.sessions.key, tmp_path)
        served.should_exit = True
        thread.join(HANG)


def given_up(target: Target, within: float) -> bool:
    with socket.create_connection(("127.0.0.1", target.port), timeout=HANG) as line:
        line.sendall(b"GET / HTTP/1.1\r\nX: ")
        line.settimeout(0.05)
        return ended_within(line, within)


@pytest.mark.verifies(control="within")
def test_slow_head_is_given_up(impatient: Target, monkeypatch: pytest.MonkeyPatch) -> None:
    """A head that arrives letter by letter is given up in time; without that limit (the control) it never is."""
    assert given_up(impatient, HANG)
    monkeypatch.setattr(server, "_HEAD_SECONDS", 2.0 * HANG)
    assert not given_up(impatient, 2.5)


def test_the_head_of_a_later_request_is_timed_too(impatient: Target) -> None:
    """After an answered request, half a head is given up in time, also while letters of it go on to arrive."""
    with socket.create_connection(("127.0.0.1", impatient.port), timeout=HANG) as line:
        line.sendall(b"GET /api/session HTTP/1.1\r\n" + impatient.head + b"\r\n")
        assert line.recv(1 << 16).startswith(b"HTTP/1.1 200")
        line.sendall(b"GET / HTTP/1.1\r\nX: ")
        line.settimeout(0.05)
        assert ended_within(line, HANG)


def ended_within(line: socket.socket, seconds: float) -> bool:
    start = time.perf_counter()
    while time.perf_counter() - start < seconds:
        try:
            line.sendall(b"a")
            if not line.recv(1 << 16):
                return True
        except TimeoutError:
            continue
        except ConnectionError:
            return True
    return False


@pytest.mark.verifies("behaviour")
def test_a_live_websocket_outlasts_the_patience(impatient: Target) -> None:
    """What has become a websocket is no unfinished head: it answers a ping long after the patience for heads."""
    key = b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
    with socket.create_connection(("127.0.0.1", impatient.port), timeout=HANG) as line:
        line.sendall(UPGRADE + impatient.head + key)
        assert line.recv(1 << 16).startswith(b"HTTP/1.1 101")
        time.sleep(2.0)
        line.sendall(b"\x89\x80\x00\x00\x00\x00")
        came = b""
        while b"\x8a\x00" not in came:
            piece = line.recv(1 << 16)
            assert piece, "the websocket was cut"
            came += piece


@pytest.mark.verifies("behaviour")
def test_patience_ends_with_the_first_request(impatient: Target) -> None:
    """A connection that has asked something stays open for the next request."""
    with socket.create_connection(("127.0.0.1", impatient.port), timeout=HANG) as line:
        for _ in range(2):
            line.sendall(b"GET /api/session HTTP/1.1\r\n" + impatient.head + b"\r\n")
            came = b""
            while not came.endswith(b"}"):
                piece = line.recv(1 << 16)
                assert piece, "the connection was ended"
                came += piece
            assert came.startswith(b"HTTP/1.1 200")
            time.sleep(1.2)
