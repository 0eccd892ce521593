"""The server: where it listens, whose the data folder is, what it computes ahead; a process that ends cleanly."""

import json
import signal
import stat
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest
from waiting import HANG

from rocking.errors import InvalidValueError
from rocking.evidence import hierarchy
from rocking.evidence.store import data_folder
from rocking_workbench import server as warm_up
from rocking_workbench.server import DataFolder, FolderInUseError, check_host, listen, write_private
from rocking_workbench.settings import ServerSettings

SERVE = [sys.executable, "-m", "rocking", "serve"]


@contextmanager
def running(*words):
    process = subprocess.Popen(
        [*SERVE, "--json", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8"
    )
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        assert line, process.communicate(timeout=HANG)[1]
        yield json.loads(line), process
    finally:
        process.kill()
        process.communicate()


def post(url, path, content, **headers):
    head = {"Origin": url, "Content-Type": "application/json", **headers}
    request = Request(url + path, data=json.dumps(content).encode(), headers=head, method="POST")
    with urlopen(request, timeout=HANG) as answer:
        return json.load(answer), answer.headers


def second(*words):
    return subprocess.run([*SERVE, *words], check=False, capture_output=True, text=True, timeout=HANG)


def test_serve_from_start_to_end(tmp_path):
    """The link signs in once, the key opens the API, a second start joins, and Ctrl-C leaves the folder tidy."""
    data = tmp_path / "data"
    with running("--port", "0", "--data", str(data)) as (told, process):
        url = told["url"]
        assert url == f"http://127.0.0.1:{told['port']}"
        with urlopen(url, timeout=HANG) as page:
            assert b"<!doctype html>" in page.read().lower()
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
        assert "another rocking serve uses" in scripted.stderr
        process.send_signal(signal.SIGINT)
        assert process.wait(HANG) == 0
        assert process.stderr is not None
        assert process.stderr.read() == ""
    assert not (data / "api-key").exists()
    assert not (data / "server.json").exists()


LONG = """
import sys, threading, time
from rocking_workbench.api import response
from rocking.cli import main
response._answer = lambda *_: print("computing", flush=True) or time.sleep(7200)
main(["serve", "--json", "--port", "0", "--data", sys.argv[1]])
"""


def test_the_end_does_not_wait_for_a_long_computation(tmp_path):
    """SIGTERM while something computes for two hours: that request is told so as JSON, and the server ends."""
    command = [sys.executable, "-c", LONG, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        told = json.loads(process.stdout.readline())
        key = Path(told["key_file"]).read_text(encoding="utf-8")
        asked = {"body": {"units": "m", "width": 1, "height": 3}, "response": {"initial_rotation": 0.5}}
        answers = []

        def ask():
            with pytest.raises(HTTPError) as ended:
                post(told["url"], "/api/response", asked, Authorization=f"Bearer {key}")
            answers.append((ended.value.code, json.load(ended.value)))
            ended.value.close()

        asking = threading.Thread(target=ask)
        asking.start()
        assert process.stdout.readline() == "computing\n"
        process.terminate()
        try:
            assert process.wait(HANG) == 0
        finally:
            process.kill()
        asking.join(HANG)
    assert answers[0][0] == 503
    assert answers[0][1]["error"]["kind"] == "busy"
    assert not (tmp_path / "api-key").exists()


def test_a_killed_server_does_not_shut_its_folder_and_one_that_is_ended_leaves_it_tidy(tmp_path):
    """After kill -9 the next start takes the folder and makes a new key; SIGTERM ends it as Ctrl-C does."""
    with running("--port", "0", "--data", str(tmp_path)) as (_, process):
        key = (tmp_path / "api-key").read_text()
        process.kill()
        process.wait(HANG)
    with running("--port", "0", "--data", str(tmp_path)) as (_, process):
        assert (tmp_path / "api-key").read_text() != key
        process.terminate()
        assert process.wait(HANG) == 0
    assert not (tmp_path / "api-key").exists()


def test_missing_extra_is_a_sentence(monkeypatch, refuses, tmp_path):
    """Without a dependency the command names it."""
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    monkeypatch.delitem(sys.modules, "rocking_workbench.server", raising=False)
    refuses(("serve", "--data", tmp_path, "--no-browser"), "pip install uvicorn")


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1"])
def test_loopback_needs_no_word(host):
    """Loopback is allowed as it is."""
    check_host(host, allow_remote=False)


def test_other_addresses_need_the_flag():
    """An address that others reach is refused without the flag, and all addresses at once always."""
    check_host("192.0.2.7", allow_remote=True)
    with pytest.raises(InvalidValueError, match="--allow-remote"):
        check_host("192.0.2.7", allow_remote=False)
    for everywhere in ("0.0.0.0", "::", ""):
        with pytest.raises(InvalidValueError, match="all addresses"):
            check_host(everywhere, allow_remote=True)


def test_taken_port_gives_the_next_only_if_none_was_asked_for():
    """A taken port: the next one where any serves, a sentence where that one was asked for."""
    with listen("127.0.0.1", 0, search=False) as first:
        taken = first.getsockname()[1]
        with pytest.raises(InvalidValueError, match=f"port {taken} is in use"):
            listen("127.0.0.1", taken, search=False)
        with listen("127.0.0.1", taken, search=True) as second:
            assert taken < second.getsockname()[1] < taken + 50


@pytest.mark.parametrize(
    ("host", "port"), [("127.0.0.1", 70_000), ("127.0.0.1", -1), ("192.0.2.7", 0), ("no.invalid", 0)]
)
def test_impossible_addresses_are_told(host, port):
    """A port out of range and an address that is not of this machine are refused in words."""
    with pytest.raises(InvalidValueError):
        listen(host, port, search=False)


def test_folder_is_private_and_of_one_server(tmp_path):
    """The data folder and the key are for their owner only, of one server at a time, and the key goes with it."""
    path = tmp_path / "deep" / "data"
    with DataFolder(path) as folder:
        key_file = folder.publish("http://127.0.0.1:1", "key")
        if sys.platform != "win32":
            assert stat.S_IMODE(path.stat().st_mode) == 0o700
            assert stat.S_IMODE(key_file.stat().st_mode) == 0o600
        assert key_file.read_text() == "key"
        assert DataFolder(path).running() == ("http://127.0.0.1:1", "key")
        with pytest.raises(FolderInUseError, match="another rocking serve"), DataFolder(path):
            pass
        assert key_file.exists()
    assert not key_file.exists()
    assert DataFolder(path).running() is None
    with DataFolder(path):
        pass


def test_key_is_never_written_through_a_link(tmp_path):
    """A link that lies where the key goes is replaced, and what it points to stays as it is."""
    victim = tmp_path / "victim"
    victim.write_text("mine")
    link = tmp_path / "api-key"
    link.symlink_to(victim)
    write_private(link, "key")
    assert victim.read_text() == "mine"
    assert link.read_text() == "key"
    assert not link.is_symlink()


def test_folder_that_cannot_be_made_is_told(tmp_path):
    """A file in the way of the data folder is told in words."""
    (tmp_path / "file").write_text("")
    with pytest.raises(InvalidValueError, match="--data"), DataFolder(tmp_path / "file" / "data"):
        pass


def test_note_of_another_machine_is_not_followed(tmp_path):
    """On a shared disk a server of another machine is not asked on this one."""
    (tmp_path / "server.json").write_text(json.dumps({"url": "http://127.0.0.1:1", "machine": "elsewhere"}))
    (tmp_path / "api-key").write_text("key")
    assert DataFolder(tmp_path).running() is None


def test_default_folder_follows_the_system(monkeypatch, tmp_path):
    """The data folder is where the system keeps data of programs."""
    if sys.platform != "win32":
        monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
        assert data_folder() == tmp_path / "rocking"
        monkeypatch.delenv("XDG_DATA_HOME")
        assert data_folder() == Path.home() / ".local" / "share" / "rocking"


def test_origin_of_the_page():
    """The address of the page, with brackets where the address has colons."""
    assert ServerSettings().origin == "http://127.0.0.1:8765"
    assert ServerSettings(host="::1", port=9).origin == "http://[::1]:9"


def test_warm_up_leaves_nothing_to_fit():
    """Afterwards the calibration is there, and an answer on the impact of a block."""
    warm_up.warm_up()
    fits = hierarchy._calibrated.cache_info().misses
    warm_up._impact()
    assert hierarchy._calibrated.cache_info().currsize >= 1
    assert hierarchy._calibrated.cache_info().misses == fits


def test_what_is_not_installed_is_left_out(monkeypatch):
    """A picture that cannot be drawn without its extra does not end the thread with a traceback."""
    done = []

    def missing():
        raise ImportError("no matplotlib here")

    monkeypatch.setattr(warm_up, "_impact", missing)
    monkeypatch.setattr(warm_up, "_response", lambda: done.append("response"))
    monkeypatch.setattr(warm_up, "_picture", missing)
    warm_up.warm_up(lambda: done.append("more"))
    assert done == ["response", "more"]
