"""Studies, as a user launches, watches, cancels and reads them."""

import json
import time
from base64 import urlsafe_b64encode
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import pytest
from playwright.sync_api import expect

PULSE = {
    "body": {"units": "m", "width": 0.5, "height": 2.0},
    "motion": {"pulse": "sine:amplitude=3,period=0.6"},
    "restitution": {"models": ["ked", "housner"]},
}


def fragment(inputs: dict[str, Any], view: str = "studies") -> str:
    """Return the link of inputs."""
    packed = urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    return urlencode({"in": packed, "view": view})


def counted(page: Any, number: int) -> None:
    """Type how many values both axes have."""
    for field in page.locator("#view-studies").get_by_label("number", exact=True).all():
        field.fill(str(number))


@pytest.fixture
def studies(open_page: Callable[..., Any]) -> Any:
    """Open the step Studies with a block and a pulse."""
    return open_page(fragment(PULSE))


def launched_map(page: Any, name: str, cells: int = 24) -> None:
    """Launch a map and wait for its picture."""
    counted(page, cells)
    page.locator("#study-name").fill(name)
    page.get_by_test_id("study-launch").click()
    page.get_by_test_id("map-canvas").wait_for(timeout=60_000)


def test_a_map_from_launch_to_the_history_of_a_cell(studies: Any, shot: Any, served: Any) -> None:
    """A map is launched, appears by itself, is hovered, walked by keys, and a cell opens as a response."""
    launched_map(studies, "first map")
    canvas = studies.get_by_test_id("map-canvas")
    box = canvas.bounding_box()
    canvas.hover(position={"x": 0.3 * box["width"], "y": 0.3 * box["height"]})
    told = studies.get_by_test_id("map-told")
    expect(told).to_contain_text(": ")
    before = told.inner_text()
    canvas.focus()
    studies.keyboard.press("ArrowRight")
    studies.keyboard.press("ArrowDown")
    assert told.inner_text() != before
    studies.locator("[data-testid=cell-history] canvas").wait_for()
    shot(studies, "studies-map")
    studies.get_by_role("button", name="Open in Response").click()
    studies.wait_for_selector("#view-response[data-ready=true]:not([hidden])")
    inputs = studies.evaluate("location.hash")
    assert "view=response" in inputs
    found = next(each for each in served.api("studies", method="GET")["studies"] if each["name"] == "first map")
    result = served.api(f"studies/{found['id']}/result", method="GET")
    assert len(result["outcome"]) == 2
    assert len(result["outcome"][0]) == len(result["outcome"][0][0]) == 24


def test_where_the_models_differ(studies: Any, shot: Any) -> None:
    """The layer of differences names both models and draws another picture than the verdict."""
    launched_map(studies, "differences")
    canvas = studies.get_by_test_id("map-canvas")
    first = canvas.screenshot()
    studies.get_by_role("radio", name="Difference to").check(force=True)
    assert "overturns only with" in studies.locator(".map-legend").inner_text()
    assert canvas.screenshot() != first
    shot(studies, "studies-difference")


def test_a_fragility(studies: Any, shot: Any) -> None:
    """A fragility by stripes of a synthetic set shows a curve, a band, and a table of fits."""
    studies.get_by_role("radio", name="Fragility").check(force=True)
    studies.locator("#study-name").fill("fragility of a column")
    studies.get_by_test_id("study-launch").click()
    studies.get_by_test_id("fragility-fits").first.wait_for(timeout=90_000)
    assert studies.get_by_test_id("fragility-chart").count() >= 1
    assert "overturn" in studies.get_by_test_id("fragility-fits").first.inner_text()
    shot(studies, "studies-fragility")


def test_rocking_spectra(studies: Any, shot: Any) -> None:
    """Spectra show one curve for every slenderness and model."""
    studies.get_by_role("radio", name="Rocking spectra").check(force=True)
    studies.locator("#study-name").fill("spectra of a pulse")
    studies.get_by_test_id("study-launch").click()
    studies.get_by_test_id("spectrum-chart").wait_for(timeout=60_000)
    assert studies.locator("[data-testid=spectrum-chart] .legend li").count() == 6
    shot(studies, "studies-spectra")


def test_cancel_and_resume(studies: Any, shot: Any) -> None:
    """A long study shows progress, stops within a second of Cancel, keeps what is finished, and goes on."""
    counted(studies, 400)
    studies.locator("#study-name").fill("long study")
    studies.get_by_test_id("study-launch").click()
    row = studies.locator(".study", has_text="long study")
    row.locator("progress").wait_for(timeout=30_000)
    expect(row).to_have_attribute("data-state", "running", timeout=60_000)
    until = time.perf_counter() + 60.0
    while row.locator("progress").evaluate("bar => bar.value") == 0.0 and time.perf_counter() < until:
        time.sleep(0.02)
    shot(studies, "studies-running")
    start = time.perf_counter()
    row.get_by_role("button", name="Cancel").click()
    expect(row).to_have_attribute("data-state", "cancelled")
    # a second for the cancel itself, and a fifth for the push that tells it
    assert time.perf_counter() - start < 1.2
    kept = row.locator("progress").evaluate("bar => bar.value")
    assert 0.0 < kept < 1.0
    row.get_by_role("button", name="Resume").click()
    expect(row).to_have_attribute("data-state", "done", timeout=120_000)


def test_exports(studies: Any, tmp_path: Path) -> None:
    """Every file of a finished map is saved, is not empty, and begins as its kind does."""
    launched_map(studies, "exports")
    begins = {
        "png": b"\x89PNG",
        "svg": b"<?xml",
        "xlsx": b"PK",
        "nc": b"\x89HDF",
        "parquet": b"PAR1",
        "toml": b"",
        "csv": b"",
    }
    for suffix, magic in begins.items():
        with studies.expect_download() as saved:
            studies.get_by_test_id(f"export-{suffix}").click()
        target = tmp_path / f"x.{suffix}"
        saved.value.save_as(target)
        assert target.read_bytes().startswith(magic)
        assert target.stat().st_size > 100


def test_what_is_refused_is_said(open_page: Callable[..., Any], record: Any) -> None:
    """A study without a motion is refused in a sentence beside the button."""
    page = open_page(fragment({**PULSE, "motion": None, "response": {"free": 0.5}}))
    page.get_by_test_id("study-launch").click()
    assert "motion" in page.locator("#study-problem").inner_text()


def test_phone_and_dark(open_page: Callable[..., Any], shot: Any) -> None:
    """The step fits a phone, light and dark, without anything wider than the screen."""
    for scheme in ("light", "dark"):
        page = open_page(fragment(PULSE), viewport={"width": 360, "height": 740}, color_scheme=scheme)
        launched_map(page, f"phone {scheme}", 12)
        assert page.evaluate("document.documentElement.scrollWidth") <= 360
        shot(page, f"studies-phone-{scheme}")
