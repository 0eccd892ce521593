"""The page of the API in a real browser: all of it, from this server alone, and its calls work."""

import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import uvicorn
from fastapi import FastAPI

from rocking.app import server
from rocking.app.address import listen
from rocking.app.application import create_app
from rocking.app.folder import write_private
from rocking.app.settings import Settings

playwright = pytest.importorskip("playwright.sync_api")


@pytest.fixture
def served(tmp_path: Path) -> Iterator[tuple[FastAPI, str]]:
    with listen("127.0.0.1", 0, search=False) as door:
        settings = Settings(folder=tmp_path, port=door.getsockname()[1])
        app = create_app(settings)
        write_private(tmp_path / "api-key", app.state.rocking.sessions.key)
        running = uvicorn.Server(server._config(app))
        thread = threading.Thread(target=running.run, kwargs={"sockets": [door]})
        thread.start()
        while not running.started:
            time.sleep(0.01)
        yield app, settings.origin
        running.should_exit = True
        thread.join(20)


def test_page_shows_every_endpoint_and_its_calls_work(served: tuple[FastAPI, str], tmp_path: Path) -> None:
    """Every operation has a card, nothing is asked elsewhere, no policy is broken, and the Python call runs."""
    app, origin = served
    operations = sum(len(set(item) & {"get", "post", "delete"}) for item in app.openapi()["paths"].values())
    told: list[str] = []
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
