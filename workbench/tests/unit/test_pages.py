"""The pages: scripts that hold for much data, and the page of the API in a real browser."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time
from base64 import b64encode
from importlib.resources import files
from pathlib import Path

import httpx
import pytest
import uvicorn
from waiting import HANG

from rocking_workbench import server
from rocking_workbench.application import create_app
from rocking_workbench.pages import PageFiles
from rocking_workbench.server import listen, write_private
from rocking_workbench.settings import ServerSettings


@pytest.fixture
def served(tmp_path):
    with listen("127.0.0.1", 0, search=False) as door:
        settings = ServerSettings(folder=tmp_path, port=door.getsockname()[1])
        app = create_app(settings)
        write_private(tmp_path / "api-key", app.state.rocking.sessions.key)
        running = uvicorn.Server(server._config(app))
        thread = threading.Thread(target=running.run, kwargs={"sockets": [door]})
        thread.start()
        while not running.started:
            assert thread.is_alive(), "the server did not start"
            time.sleep(0.01)
        yield app, settings.origin
        running.should_exit = True
        thread.join(HANG)


def _check_answers(page, app):
    """Every card says what comes back: fields with their units, or types of files; errors are told once."""
    for path, item in app.openapi()["paths"].items():
        for method, operation in item.items():
            card = page.locator(f"section[aria-label='{method} {path}']")
            told = card.text_content()
            assert "Response" in told, path
            good = next(value for status, value in operation["responses"].items() if status.startswith("2"))
            assert all(kind in told for kind in good["content"] if kind != "application/json"), path
    words = page.locator("section[aria-label='post /api/response']").text_content()
    assert "answers.series.angular_velocity" in words
    assert "angular velocity [rad/s]" in words
    assert "body.outline.holes" in words
    found = page.locator("section[aria-label='get /api/studies/{study}/result']").text_content()
    assert all(part in found for part in ("an overturning map", "fragility curves", "analyses.fits.median_95"))
    errors = page.get_by_test_id("api-errors").text_content()
    assert all(f"{status}" in errors for status in (400, 401, 403, 404, 413, 422, 429, 500))
    assert page.get_by_test_id("api-errors").count() == 1


def test_page_shows_every_endpoint_and_its_calls_work(served, tmp_path):
    """Every operation has a card, nothing is asked elsewhere, no policy is broken, and the Python call runs."""
    playwright = pytest.importorskip("playwright.sync_api")
    app, origin = served
    operations = sum(len(set(item) & {"get", "post", "delete"}) for item in app.openapi()["paths"].values())
    told = []
    with playwright.sync_playwright() as browsers:
        chromium = shutil.which("chromium") or shutil.which("chromium-browser")
        browser = browsers.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 360, "height": 760})
        page.on("console", lambda message: told.append(message.text))
        page.on("pageerror", lambda error: told.append(str(error)))
        page.on("request", lambda asked: asked.url.startswith(origin) or told.append(asked.url))
        page.goto(f"{origin}/api-docs")
        page.wait_for_selector("[data-testid=endpoint]")
        assert page.locator("[data-testid=endpoint]").count() == operations
        assert page.evaluate("document.documentElement.scrollWidth") <= 360
        _check_answers(page, app)
        if os.environ.get("ROCKING_SHOTS"):
            page.screenshot(path=f"{os.environ['ROCKING_SHOTS']}/api-docs-phone.png", full_page=False)
        card = page.locator("section[aria-label='post /api/response']")
        card.locator("[data-testid=calls] summary").click()
        assert "curl -X POST" in card.locator("pre").inner_text()
        card.get_by_label("Python", exact=True).check()
        call = card.locator("pre").inner_text()
        browser.close()
    assert told == []
    run = subprocess.run([sys.executable, "-c", call], check=False, capture_output=True, text=True, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert "'label': 'ked'" in run.stdout


def test_the_origin_is_that_of_the_server(served):
    """A script is told the origin that this server asks for, on any port."""
    app, origin = served
    told = app.openapi()["info"]["description"]
    assert f"`Origin: {origin}`" in told
    assert origin.endswith(":8765") or "8765" not in told
    assert '`{"error": {"kind", "message", ...}}`' in told


STATIC = Path(str(files("rocking_workbench"))) / "static"


def test_addresses_change_with_every_file(tmp_path):
    """Another content, name or division of the same bytes has another fingerprint; the same files have the same."""
    made = {}
    for label, contents in {
        "first": {"app/a.js": b"ab", "b.css": b"c"},
        "content": {"app/a.js": b"aB", "b.css": b"c"},
        "name": {"app/c.js": b"ab", "b.css": b"c"},
        "division": {"app/a.js": b"abb.css 1 c"},
        "same": {"app/a.js": b"ab", "b.css": b"c"},
    }.items():
        for name, content in contents.items():
            path = tmp_path / label / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        made[label] = PageFiles.read(tmp_path / label)
        assert made[label].contents == contents
    assert made["same"].fingerprint == made["first"].fingerprint
    assert len({files.fingerprint for files in made.values()}) == len(made) - 1


@pytest.mark.parametrize("address", ["/", "/index.html", "/api-docs", "/api-docs.html"])
def test_files_of_a_page_are_kept_by_the_browser(served, address):
    """All links, scripts and imports of a page lead to its present files; its import map is the one that is allowed."""
    _, origin = served
    answer = httpx.get(origin + address)
    page = answer.text
    linked = re.findall(r'<(?:link|script)\b[^>]*?(?:href|src)="([^"]+)"', page)
    (imports,) = re.findall(r'<script type="importmap">(.*?)</script>', page)
    named = json.loads(imports)["imports"]
    folders = {f"/{path.relative_to(STATIC).parts[0]}/" for path in STATIC.glob("*/**/*.*js")}
    assert {name for name in named if name.startswith("/")} == folders
    targets = [*linked, *(path for path in named.values() if not path.endswith("/"))]
    assert len(targets) > 8
    with httpx.Client(base_url=origin) as client:
        for target in targets:
            file = client.get(target)
            assert file.headers["Cache-Control"] == "private, max-age=31536000, immutable", target
            assert file.content == (STATIC / target.split("/", 2)[2]).read_bytes(), target
    allowed = b64encode(hashlib.sha256(imports.encode()).digest()).decode()
    assert f"'sha256-{allowed}'" in answer.headers["Content-Security-Policy"]


# a browser's stack ends at about 120,000 arguments of one call
SPREAD = re.compile(r"(Math\.(?:max|min)|\.push)\((?:[^()]*,\s*)?\.\.\.\w")


def test_no_call_takes_data_as_its_arguments():
    """Extremes of data are taken in loops: no call whose arguments are as many as the data."""
    assert SPREAD.search("Math.max(1, ...impacts.flat().filter(Number.isFinite))")
    found = {
        path.relative_to(STATIC).as_posix()
        for path in STATIC.rglob("*.js")
        if "vendor" not in path.parts and SPREAD.search(path.read_text(encoding="utf-8"))
    }
    assert not found


def test_libraries_are_unchanged():
    """Every file of a library has the hash that its SOURCE.txt says, a licence and a version beside it; not another."""
    stated, there = {}, {}
    for source in STATIC.glob("vendor/*/SOURCE.txt"):
        words = source.read_text(encoding="utf-8")
        assert re.search(r"\d+\.\d+\.\d+.*licence", words, re.DOTALL), source
        assert (source.parent / "LICENSE").is_file()
        stated |= {
            source.parent / name: sha for sha, name in re.findall(r"^([0-9a-f]{64})  (\S+)$", words, re.MULTILINE)
        }
        kept = (path for path in source.parent.iterdir() if path.name not in {"SOURCE.txt", "LICENSE"})
        there |= {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in kept}
    assert len(there) > 5
    assert there == stated


def test_the_page_has_one_script_of_its_own(client):
    """The import map is allowed by its hash; a changed one would not be, nor any other script in the page."""
    page, policy = client.get("/"), client.get("/").headers["Content-Security-Policy"]
    (words,) = re.findall(r"<script(?! type=\"module\"| src=)[^>]*>(.*?)</script>", page.text, re.DOTALL)
    assert f"'sha256-{b64encode(hashlib.sha256(words.encode()).digest()).decode()}'" in policy
    assert f"'sha256-{b64encode(hashlib.sha256(b'{}').digest()).decode()}'" not in policy
    paths = [path for path in json.loads(words)["imports"].values() if not path.endswith("/")]
    assert len(paths) == 3
    for path in paths:
        assert client.get(path).headers["Content-Type"].startswith("text/javascript")
