"""`rocking serve` as a process: it starts, says where, and ends cleanly."""

import json
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest

from rocking.cli import main

pytestmark = pytest.mark.timed

COMMAND = [sys.executable, "-m", "rocking", "serve"]


@contextmanager
def running(*words: str) -> Iterator[tuple[dict[str, Any], subprocess.Popen[str]]]:
    process = subprocess.Popen(
        [*COMMAND, "--json", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8"
    )
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        assert line, process.communicate(timeout=20)[1]
        yield json.loads(line), process
    finally:
        process.kill()
        process.communicate()


def post(url: str, path: str, content: Any, **headers: str) -> Any:
    head = {"Origin": url, "Content-Type": "application/json", **headers}
    request = Request(url + path, data=json.dumps(content).encode(), headers=head, method="POST")
    with urlopen(request, timeout=10) as answer:
        return json.load(answer), answer.headers


def second(*words: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([*COMMAND, *words], check=False, capture_output=True, text=True, timeout=30)


def test_serve_from_start_to_end(tmp_path: Path) -> None:
    """The link signs in once, the key opens the API, a second start joins, and Ctrl-C leaves the folder tidy."""
    data = tmp_path / "data"
    with running("--port", "0", "--data", str(data)) as (told, process):
        url = told["url"]
        assert url == f"http://127.0.0.1:{told['port']}"
        start = time.perf_counter()
        with urlopen(url, timeout=10) as page:
            assert b"<!doctype html>" in page.read().lower()
        assert time.perf_counter() - start < 1.0
        answer, head = post(url, "/api/session", {"token": told["token"]})
        assert answer == {"signed_in": True}
        assert "HttpOnly" in head["Set-Cookie"]
        with pytest.raises(HTTPError) as refused:
            post(url, "/api/session", {"token": told["token"]})
        assert refused.value.code == 401
        refused.value.close()
        key = Path(told["key_file"]).read_text(encoding="utf-8")
        made, _ = post(url, "/api/session/link", None, Authorization=f"Bearer {key}")
        assert made["url"].startswith(f"{url}/#token=")
        again = second("--no-browser", "--data", str(data))
        assert again.returncode == 0, again.stderr
        assert again.stdout.startswith(f"{url}/#token=")
        scripted = second("--json", "--data", str(data))
        assert scripted.returncode == 2
        assert "another rocking serve runs" in scripted.stderr
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 0
        assert process.stderr is not None
        assert process.stderr.read() == ""
    assert not (data / "api-key").exists()
    assert not (data / "server.json").exists()


def test_sigterm_ends_it_like_ctrl_c(tmp_path: Path) -> None:
    """A system that shuts down leaves the folder tidy as well."""
    with running("--port", "0", "--data", str(tmp_path)) as (_, process):
        assert (tmp_path / "api-key").exists()
        process.terminate()
        assert process.wait(10) == 0
    assert not (tmp_path / "api-key").exists()


LONG = """
import sys, threading, time
from rocking.app.api import response
from rocking.cli import main
response._answer = lambda *_: time.sleep(60)
main(["serve", "--json", "--port", "0", "--data", sys.argv[1]])
"""


def test_the_end_does_not_wait_for_a_long_computation(tmp_path: Path) -> None:
    """SIGTERM while something computes for a minute: that request is told so as JSON, and the end comes in seconds."""
    command = [sys.executable, "-c", LONG, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        told = json.loads(process.stdout.readline())
        key = Path(told["key_file"]).read_text(encoding="utf-8")
        asked = {"body": {"units": "m", "width": 1, "height": 3}, "response": {"free": 0.5}}
        answers: list[tuple[int, Any]] = []

        def ask() -> None:
            with pytest.raises(HTTPError) as ended:
                post(told["url"], "/api/response", asked, Authorization=f"Bearer {key}")
            answers.append((ended.value.code, json.load(ended.value)))
            ended.value.close()

        asking = threading.Thread(target=ask)
        asking.start()
        time.sleep(0.7)
        process.terminate()
        try:
            assert process.wait(15) == 0
        finally:
            process.kill()
        asking.join(10)
    assert answers[0][0] == 503
    assert answers[0][1]["error"]["kind"] == "busy"
    assert not (tmp_path / "api-key").exists()


def test_killed_server_does_not_shut_its_folder(tmp_path: Path) -> None:
    """After kill -9 the next start takes the folder and makes a new key."""
    with running("--port", "0", "--data", str(tmp_path)) as (_, process):
        key = (tmp_path / "api-key").read_text()
        process.kill()
        process.wait(10)
    with running("--port", "0", "--data", str(tmp_path)):
        assert (tmp_path / "api-key").read_text() != key


def test_refusals_are_sentences(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """An address for others without the flag: exit code 2 and one sentence."""
    with pytest.raises(SystemExit) as left:
        main(["serve", "--host", "192.0.2.7", "--data", str(tmp_path), "--no-browser"])
    assert left.value.code == 2
    assert "add --allow-remote" in capsys.readouterr().err


def test_missing_extra_is_a_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Without the web extra the command says what to install."""
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    monkeypatch.delitem(sys.modules, "rocking.app.server", raising=False)
    with pytest.raises(SystemExit) as left:
        main(["serve", "--data", str(tmp_path), "--no-browser"])
    assert left.value.code == 2
    assert "pip install '.[web]'" in capsys.readouterr().err
