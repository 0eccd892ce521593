"""A real server, a real Chromium, and a recorder that forgives nothing."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import httpx
import pytest
from browser_pages import OwnServer, link
from waiting import HANG

playwright = pytest.importorskip("playwright.sync_api")

CHROMIUM = os.environ.get("ROCKING_CHROMIUM", "/usr/bin/chromium")
WIDE = {"width": 1360, "height": 900}
# A window without tabs in sight: Chromium would draw a page for the list under its address bar in each, at 2 s of CPU.
# The switch replaces that of Playwright, whose features are the others.
DISABLED = [
    "WebUIOmniboxPopup", "WebUIOmniboxAimPopup", "WebUIOmniboxFullPopup", "SpareRendererForSitePerProcess",
    "AvoidUnnecessaryBeforeUnloadCheckSync", "DestroyProfileOnBrowserClose", "HttpsUpgrades",
    "HttpsFirstBalancedModeAutoEnable", "LensOverlay", "MediaRouter", "PaintHolding", "ThirdPartyStoragePartitioning",
    "AvoidCorsURLLoaderRestartOnRedirect", "OptimizationHints", "NetworkTimeServiceQuerying", "AimEnabled",
    "PreconnectToSearch",
]  # fmt: skip


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let everything here be told from the rest: what measures time is marked where it stands."""
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.browser)


@dataclass
class Served:
    """Where the server of a test listens."""

    url: str
    token: str
    port: int
    folder: Path
    key: str

    @cached_property
    def client(self) -> httpx.Client:
        """The client of a script; a new one for each call would read all certificates again, at 60 ms of CPU."""
        head = {"Authorization": f"Bearer {self.key}", "Origin": self.url}
        once = httpx.Limits(max_keepalive_connections=0)  # the server may close an idle connection at any time
        return httpx.Client(base_url=f"{self.url}/api/", headers=head, timeout=HANG, limits=once)

    def api(self, path: str, **options: Any) -> Any:
        """Call the API as a script does, past the browser."""
        answer = self.client.request(options.pop("method", "POST"), path, **options)
        answer.raise_for_status()
        return answer.json()


@dataclass
class Record:
    """What the pages of one test did that they must not do."""

    faults: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def watch(self, page: Any, origin: str) -> None:
        """Listen to a page."""
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.faults.append(f"uncaught: {error}"))
        page.on("request", lambda request: self._request(request.url, origin))

    def _console(self, message: Any) -> None:
        text = message.text
        # Chromium logs every refused call; that a refusal is shown to the user is what the tests look at.
        refused = text.startswith("Failed to load resource") and "/api/" in message.location.get("url", "")
        violation = "Content Security Policy" in text or "Content-Security-Policy" in text
        if violation or (message.type == "error" and not (refused and "status of 4" in text)):
            self.faults.append(f"console: {text} {message.location}")

    def _request(self, url: str, origin: str) -> None:
        self.requests.append(url)
        if not url.startswith((origin + "/", "blob:", "data:")):
            self.faults.append(f"request to {url}")


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """Start `rocking serve` as a process of its own and stop it afterwards."""
    folder = tmp_path_factory.mktemp("data")
    command = [sys.executable, "-m", "rocking", "serve", "--json", "--no-browser", "--port", "0", "--data", str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            told = json.loads(process.stdout.readline())
            key = Path(told["key_file"]).read_text(encoding="utf-8").strip()
            server = Served(told["url"].rstrip("/"), told["token"], told["port"], folder, key)
            with server.client:
                yield server
        finally:
            process.terminate()
            process.wait(timeout=HANG)


# Messages vanish after 5 s or 12 s, which on a busy machine is before a test reads them.
SLOWLY = """{
  const after = window.setTimeout;
  window.setTimeout = (act, pause, ...given) => after(act, pause >= 5000 ? 100 * pause : pause, ...given);
}"""


def _patient(opened: Any) -> Any:
    """Set the guard against hanging of a context or page, let its messages stay, and return it."""
    opened.set_default_timeout(1000.0 * HANG)
    opened.add_init_script(SLOWLY)
    return opened


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Start the system's Chromium once."""
    if not Path(CHROMIUM).exists():
        pytest.skip(f"no Chromium at {CHROMIUM}; install it, or name another in ROCKING_CHROMIUM")
    with playwright.sync_playwright() as driver:
        playwright.expect.set_options(timeout=1000.0 * HANG)
        arguments = ["--no-sandbox", f"--disable-features={','.join(DISABLED)}"]
        launched = driver.chromium.launch(executable_path=CHROMIUM, args=arguments)
        new_context, new_page = launched.new_context, launched.new_page
        launched.new_context = lambda **options: _patient(new_context(**options))
        launched.new_page = lambda **options: _patient(new_page(**options))
        yield launched
        launched.close()


@pytest.fixture(scope="session")
def signed_in(browser: Any, served: Served) -> Any:
    """Open the link once and keep its cookie for every test."""
    context = browser.new_context()
    page = context.new_page()
    page.goto(f"{served.url}/#token={served.token}")
    page.wait_for_selector("#view-body[data-ready=true]")
    state = context.storage_state()
    context.close()
    return {"cookies": state["cookies"], "origins": []}


@pytest.fixture
def record() -> Iterator[Record]:
    """Fail the test at its end if a page did what it must not."""
    seen = Record()
    yield seen
    assert seen.faults == []


@pytest.fixture(scope="session")
def new_record() -> Callable[[], Record]:
    """Make a recorder that fails nothing by itself, for negative controls."""
    return Record


@pytest.fixture(autouse=True)
def no_projects(request: pytest.FixtureRequest) -> None:
    """Delete the projects of other tests."""
    if "served" not in request.fixturenames:
        return
    served = request.getfixturevalue("served")
    for project in served.api("projects", method="GET")["projects"]:
        served.api(f"projects/{project['id']}", method="DELETE")


@dataclass
class Contexts:
    """Contexts of a signed-in user; a context that is given back is emptied, and keeps the files of the page."""

    browser: Any
    served: Served
    cookies: list[Any]
    free: dict[str, list[Any]] = field(default_factory=dict)
    lent: list[tuple[str, Any]] = field(default_factory=list)

    def new_page(self, **options: Any) -> Any:
        """Return a page in a context with these options that no other test uses."""
        options = {"viewport": WIDE, **options}
        key = repr(sorted(options.items()))
        context = self.free[key].pop() if self.free.get(key) else self.browser.new_context(**options)
        self.lent.append((key, context))
        context.clear_cookies()
        context.clear_permissions()
        context.grant_permissions(["clipboard-read", "clipboard-write"], origin=self.served.url)
        page = context.new_page()
        session = context.new_cdp_session(page)
        session.send("Storage.clearDataForOrigin", {"origin": self.served.url, "storageTypes": "all"})
        session.detach()
        context.add_cookies(self.cookies)
        return page

    def give_back(self) -> None:
        """Close all pages."""
        while self.lent:
            key, context = self.lent.pop()
            for page in context.pages:
                page.close()
            self.free.setdefault(key, []).append(context)


@pytest.fixture(scope="session")
def contexts(browser: Any, served: Served, signed_in: Any) -> Contexts:
    """Return the contexts of a signed-in user."""
    return Contexts(browser, served, signed_in["cookies"])


@pytest.fixture
def open_page(contexts: Contexts, served: Served, record: Record) -> Iterator[Callable[..., Any]]:
    """Open pages of a signed-in user; `open_page(fragment="", view="body", **context options)`."""

    def opened(fragment: str = "", *, view: str | None = None, **options: Any) -> Any:
        page = contexts.new_page(**options)
        record.watch(page, served.url)
        page.goto(f"{served.url}/#{fragment or (f'view={view}' if view else '')}")
        page.wait_for_selector("main section[data-ready=true]:not([hidden])")
        return page

    yield opened
    contexts.give_back()


@pytest.fixture
def page(open_page: Callable[..., Any]) -> Any:
    """Open the first page."""
    return open_page()


@pytest.fixture(scope="session")
def until() -> Callable[..., None]:
    """Wait for a state of the test itself: `until(page, condition)`; what never comes fails.

    `page.wait_for_function` evaluates its text in the page once more, which the policy of the page refuses, unless the
    state is there at once.
    """

    def waited(page: Any, condition: Callable[[], Any]) -> None:
        deadline = time.monotonic() + HANG
        while time.monotonic() < deadline:
            if condition():
                return
            page.wait_for_timeout(20)
        pytest.fail("the state that was waited for did not come")

    return waited


@pytest.fixture(scope="session")
def calm() -> Callable[[Any], None]:
    """Let a page do what it has begun: its tasks are run and two frames are drawn; for what must not happen."""

    def drawn(page: Any) -> None:
        page.evaluate("async () => { for (let k = 0; k < 2; k += 1) await new Promise(requestAnimationFrame); }")
        page.wait_for_load_state("networkidle")

    return drawn


@pytest.fixture(scope="session")
def shot(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Save screenshots, to the folder given by ROCKING_SHOTS or a temporary one."""
    folder = Path(os.environ.get("ROCKING_SHOTS") or tmp_path_factory.mktemp("shots"))
    folder.mkdir(parents=True, exist_ok=True)

    def taken(page: Any, name: str, *, full_page: bool = True) -> Path:
        target = folder / f"{name}.png"
        page.screenshot(path=str(target), full_page=full_page)
        return target

    return taken


@pytest.fixture
def answered(open_page: Callable[..., Any]) -> Callable[..., Any]:
    """Open the view by a link and wait for its answer."""

    def opened(fragment: str | None = None, **more: Any) -> Any:
        page = open_page(fragment or link(), **more)
        page.locator(".response-results[data-drawn]").wait_for()
        return page

    return opened


@pytest.fixture
def own(tmp_path: Path) -> Iterator[OwnServer]:
    """Serve, and kill in the end."""
    server = OwnServer(tmp_path / "data")
    yield server
    server.kill()
