"""The web application in a folder of its own, and those who ask it: a script with its key, a page that is signed in."""

import contextlib
import hashlib
import json
import math
import subprocess
import sys
from pathlib import Path

from fastapi.testclient import TestClient
from waiting import HANG

from rocking_workbench.application import create_app
from rocking_workbench.settings import Limits, ServerSettings

OWN = ServerSettings().origin


def new_application(folder, limits=None, **settings):
    """Return an application that keeps its data in a folder, which is made if needed."""
    folder.mkdir(exist_ok=True)
    return create_app(ServerSettings(folder=folder, limits=Limits(**limits or {}), **settings))


def script_of(app, **options):
    """Return a client that has the key and names its origin."""
    state = app.state.rocking
    origin = state.settings.origin
    head = {"Authorization": f"Bearer {state.sessions.key}", "Origin": origin}
    return TestClient(app, base_url=origin, headers=head, **options)


def refusal(answer, status=422):
    """Return the sentence of an answer that is a refusal with this status, without a trace of the program."""
    assert answer.status_code == status, answer.text
    assert "Traceback" not in answer.text
    return answer.json()["error"]["message"]


@contextlib.contextmanager
def serving(folder, *words):
    """Run `rocking serve` in a process of its own: the process, its address, and what a script sends as head."""
    command = [sys.executable, "-m", "rocking", "serve", "--json", "--no-browser", "--data", str(folder), *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        try:
            told = json.loads(process.stdout.readline())
            url, key = told["url"].partition("/#")[0].rstrip("/"), Path(told["key_file"]).read_text("utf-8").strip()
            yield process, url, {"Authorization": f"Bearer {key}", "Origin": url}
        finally:
            process.terminate()
            try:
                process.wait(HANG)
            except subprocess.TimeoutExpired:
                process.kill()


class Page:
    """Our own page in a browser that is signed in, and what an attacker may know of it."""

    def __init__(self, folder, **limits):
        self.app = new_application(folder, limits)
        self.client = TestClient(self.app, base_url=OWN)
        self.sessions = self.app.state.rocking.sessions
        value = self.sessions.sign_in(self.sessions.new_link(math.inf))
        key = self.sessions.key
        self.known = {
            "value": value,
            "short": value[:-1],
            "upper": value.upper(),
            "hash": hashlib.sha256(value.encode()).hexdigest(),
            "token": self.sessions.new_link(math.inf),
            "key": key,
            "key_short": key[:-1],
        }
        self.head = {"host": OWN.removeprefix("http://"), "origin": OWN, "cookie": f"rocking-8765={value}"}
