"""What tests of the page share: ``from browser_pages import facts, settled``, ``card, link, response``."""

import base64
import json
import math
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from waiting import HANG

from rocking.bodies import Block
from rocking.dynamics import Response, simulate
from rocking.motions import pulses

PHONE = {"width": 360, "height": 740}
BODY = {"units": "m", "width": 0.5, "height": 2.0}
GENTLE, DECISIVE = "sine:amplitude=3,period=0.8", "cosine:amplitude=7.25,period=0.6"
MODELS = ["ked", "housner"]


def link(motion: str | None = GENTLE, **more: Any) -> str:
    """Return the fragment of a permanent link."""
    inputs = {"body": BODY, "restitution": {"models": MODELS}, **more}
    if motion is not None:
        inputs["motion"] = {"pulse": motion}
    text = base64.urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    return f"in={text}&view=response"


def response(motion: str, restitution: Any) -> Response:
    """Return the response of the same body in Python."""
    return simulate(Block(width=0.5, height=2.0), pulses.pulse(motion), restitution)


def open_board(page: Any) -> None:
    """Turn the body into a polygon, whose board is shown."""
    page.get_by_label("Shape").select_option("section")
    page.get_by_test_id("board").wait_for()


def card(page: Any, label: str) -> Any:
    """Return the card of a model's outcome."""
    return page.get_by_test_id(f"outcome-{label}")


def saved(page: Any, kind: str, what: str) -> Any:
    """Save "chart Probe", or another figure, by its menu; returns the download."""
    page.get_by_label(f"Save the {what}", exact=True).click()
    with page.expect_download() as waiting:
        page.get_by_role("button", name=f"{kind} of the {what}", exact=True).click()
    return waiting.value


def finished(served: Any, name: str, kind: str = "stripes", **tables: Any) -> str:
    """Compute a study, as a script asks for it, and return its name in addresses."""
    job = {"campaign": {"name": name, "kind": kind}, "body": BODY, **tables}
    job = {key: table for key, table in job.items() if table is not None}
    made = served.api("studies", json={"job": job})["id"]
    until = time.perf_counter() + HANG
    while time.perf_counter() < until:
        found = served.api(f"studies/{made}", method="GET")
        if found["state"] == "done":
            return str(made)
        assert found["state"] in {"waiting", "running"}, found
        time.sleep(0.1)
    pytest.fail(f"{name} did not finish")


def pasted(page: Any) -> str:
    """Return what a user pastes after copying, once the page says that it has copied."""
    page.get_by_text("Paste them into a spreadsheet").wait_for()
    page.evaluate("document.body.append(Object.assign(document.createElement('textarea'), { id: 'paste' }))")
    page.locator("#paste").focus()
    page.keyboard.press("Control+V")
    text: str = page.locator("#paste").input_value()
    return text


LEANING = {"units": "m", "trapezoid": {"base": 0.5, "top": 0.3, "height": 1.8, "lean": 0.1}}


def facts(page: Any) -> dict[str, list[str]]:
    """Return the table of numbers with full digits, by quantity and unit."""
    rows = page.evaluate(
        "[...document.querySelectorAll('[data-testid=facts-table] tbody tr')].map("
        "row => [...row.children].map(cell => cell.title || cell.textContent))"
    )
    return {f"{name} {unit}".strip(): values for name, *values, unit in rows}


def number(page: Any, name: str, column: int = 0) -> float:
    """Return one number of the table."""
    return float(facts(page)[name][column])


def settled(page: Any, name: str, expected: float, column: int = 0, rel: float = 1e-9) -> None:
    """Wait until a number of the table is what it must be."""
    deadline = time.monotonic() + HANG
    seen = math.nan
    while time.monotonic() < deadline:
        found = facts(page).get(name)
        seen = float(found[column]) if found and column < len(found) else math.nan
        if seen == pytest.approx(expected, rel=rel, abs=0.0):
            return
        page.wait_for_timeout(20)
    raise AssertionError(f"{name}: {seen}, expected {expected}")


def scan(folder: Path, *, hole: bool = True, faces: int = 768) -> Path:
    """Write a leaning block without symmetry, in mm, with a hole if wanted; finer with more faces."""
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.box((400.0, 250.0, 1200.0))
    while len(mesh.faces) < faces:
        mesh = mesh.subdivide()
    points = mesh.vertices.copy()
    points[:, 2] += 600.0
    points[:, 0] = points[:, 0] * (1.0 - points[:, 2] / 3000.0) + 0.04 * points[:, 2]
    points[:, 1] += 0.02 * points[:, 2]
    path = folder / "leaning block.stl"
    trimesh.Trimesh(points, mesh.faces[1:] if hole else mesh.faces, process=False).export(path)
    return path


def scan_sent(section: Any, name: str) -> None:
    """Wait until a file has arrived."""
    expect = pytest.importorskip("playwright.sync_api").expect
    expect(section.get_by_role("list", name="Files")).to_contain_text(name)


def asked_in_space(page: Any, what: str, path: Path | None = None) -> Any:
    """Send a scan, ask, and wait for the picture of the answer."""
    expect = pytest.importorskip("playwright.sync_api").expect
    section = page.locator("#view-space")
    if path:
        section.get_by_label("Drop a scan here, or").set_input_files(path)
        scan_sent(section, "leaning-block.stl")
        section.get_by_label("Unit of the file").select_option("mm")
    section.get_by_label("Analysis").select_option(what)
    section.get_by_role("button", name="Compute", exact=True).click()
    outcome = section.get_by_test_id("outcome")
    expect(outcome.get_by_role("heading", level=2)).to_contain_text(
        {"equilibria": "Stable poses", "restitution": "Edges", "simulate": "Response"}[what]
    )
    expect(outcome).to_have_attribute("data-state", "done")
    expect(outcome.get_by_test_id("space-stage")).to_have_attribute("data-drawn", "true")
    return outcome


class OwnServer:
    """A server on a port of its own that can be killed and started again."""

    def __init__(self, folder: Path) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self._command = [
            sys.executable, "-m", "rocking", "serve", "--json", "--no-browser", "--port", str(port), "--data",
            str(folder),
        ]  # fmt: skip
        self.start()

    def start(self) -> None:
        self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        self.told = json.loads(self._process.stdout.readline())

    def kill(self) -> None:
        self._process.kill()
        self._process.wait()
        assert self._process.stdout is not None
        self._process.stdout.close()
