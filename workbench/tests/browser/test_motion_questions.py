"""What a record file does not say is asked for until it is said; a wrong answer costs nothing."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import expect

COUNT = 201
STEP = "Time between two samples"
UNIT = "Unit of the accelerations"


def column(path: Path, scale: float = 100.0) -> Path:
    """Write a bare column of numbers, which says neither unit nor step."""
    path.write_text("\n".join(f"{scale * math.sin(0.7 * k):.6f}" for k in range(COUNT)), encoding="utf-8")
    return path


def inputs(page: Any) -> dict[str, Any]:
    """Return the inputs that the page keeps."""
    found: dict[str, Any] = page.evaluate("JSON.parse(sessionStorage.getItem('rocking.inputs'))")
    return found


@pytest.fixture
def asked(open_page: Callable[..., Any], tmp_path: Path) -> Any:
    """Open the step Motion with a column chosen, of which unit and step are asked."""
    page = open_page(view="motion")
    page.locator("#view-motion .segment", has_text="Record file").first.click()
    page.get_by_test_id("record-file").set_input_files(column(tmp_path / "column.txt"))
    expect(page.get_by_test_id("record-needs").get_by_label(STEP)).to_be_visible()
    return page


def about(field: Any) -> str:
    """Return what stands beside a field for its reader."""
    text: str = field.evaluate("node => document.getElementById(node.getAttribute('aria-describedby')).textContent")
    return text


@pytest.mark.parametrize("wrong", ["0", "-1", "1e9", "1e-12", "soon", ""])
def test_a_wrong_step_leaves_the_question_as_it_was_answered(
    asked: Any, wrong: str, calm: Callable[[Any], None]
) -> None:
    """After a step that no record has, unit and number stand as typed, the error beside it; corrected it is read."""
    needs = asked.get_by_test_id("record-needs")
    needs.get_by_label(UNIT).select_option("gal")
    step = needs.get_by_label(STEP)
    step.fill(wrong)
    needs.get_by_role("button", name="Apply").click()
    expect(asked.locator(f"#{step.get_attribute('aria-describedby')}")).to_have_text(
        re.compile(r"At least|At most|not a number|Enter a number")
    )
    calm(asked)
    expect(needs.get_by_label(UNIT)).to_have_value("gal")
    expect(step).to_have_value(wrong)
    expect(step).to_have_attribute("aria-invalid", "true")
    expect(step).to_be_focused()
    assert "ime_step" not in asked.locator("#view-motion").inner_text()
    step.fill("0.01")
    needs.get_by_role("button", name="Apply").click()
    expect(asked.get_by_test_id("record-held")).to_contain_text("column.txt")
    assert inputs(asked)["motion"]["units"] == "gal"
    assert inputs(asked)["motion"]["time_step"] == 0.01


def test_read_it_so_says_what_is_missing(asked: Any) -> None:
    """Pressed with nothing chosen, each question says what it needs and nothing is asked of the server."""
    sent: list[str] = []
    asked.on("request", lambda request: sent.append(request.url))
    needs = asked.get_by_test_id("record-needs")
    needs.get_by_role("button", name="Apply").click()
    unit = needs.get_by_label(UNIT)
    expect(unit).to_have_attribute("aria-invalid", "true")
    assert "Choose" in about(unit)
    assert "Enter a number" in about(needs.get_by_label(STEP))
    expect(needs.locator("[aria-invalid=true]").first).to_be_focused()
    assert sent == []
    unit.select_option("g")
    expect(unit).not_to_have_attribute("aria-invalid", "true")


def test_what_the_server_refuses_stands_beside_its_field(asked: Any) -> None:
    """A step that only the server refuses is marked at its field, in words and not by a name of the code."""
    allowed = {"kind": "range", "low": 0, "high": None, "low_open": True, "high_open": False, "unit": ""}
    parameter = {"kind": "parameter", "path": "time_step", "shown": "time_step"}
    data = {
        "parameter": "time_step", "text": "{parameter} must be a number {allowed}, got {value}",
        "value": "0.5", "allowed": {"sentence": "> 0"}, "unit": "", "places": [], "more": 0,
        "facts": {"parameter": parameter, "allowed": allowed, "value": "0.5"}, "hint": {"text": "", "facts": {}},
    }  # fmt: skip
    message = "time_step must be a number > 0, got 0.5"
    words = {"error": {"kind": "invalid-value", "message": message, **data}}
    asked.route(re.compile(r"/api/records\?.*time_step="), lambda route: route.fulfill(status=422, json=words))
    needs = asked.get_by_test_id("record-needs")
    needs.get_by_label(UNIT).select_option("gal")
    step = needs.get_by_label(STEP)
    step.fill("0.5")
    needs.get_by_role("button", name="Apply").click()
    expect(step).to_have_attribute("aria-invalid", "true")
    assert about(step) == "The time between two samples must be more than 0; it is 0.5"
    expect(needs.get_by_label(UNIT)).to_have_value("gal")


def test_the_same_file_can_be_chosen_again_once_it_is_mended(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """A file that was refused, mended on the disk and chosen again under its name is read as it is now."""
    path = tmp_path / "wave.txt"
    path.write_text("Dear friend,\nthis is no record.\n", encoding="utf-8")
    page = open_page(view="motion")
    page.locator("#view-motion .segment", has_text="Record file").first.click()
    chooser = page.get_by_test_id("record-file")
    chooser.set_input_files(path)
    expect(page.locator("[data-testid=record-answer] .note.error")).to_contain_text("wave.txt")
    assert chooser.evaluate("node => node.files.length") == 0
    chooser.set_input_files(column(path))
    needs = page.get_by_test_id("record-needs")
    expect(needs.get_by_label(STEP)).to_be_visible()
    column(path, 200.0)
    needs.get_by_label(UNIT).select_option("gal")
    needs.get_by_label(STEP).fill("0.01")
    needs.get_by_role("button", name="Apply").click()
    expect(page.get_by_test_id("record-held")).to_contain_text("wave.txt")
    # what was chosen was a hundred gal, whatever the disk says since
    expect(page.get_by_test_id("motion-facts")).to_contain_text(re.compile(r"acceleration(1|0\.99\d*)\s*m"))


def test_a_body_file_that_changed_on_the_disk_is_read_again(page: Any, tmp_path: Path) -> None:
    """Another unit reads the file as it was chosen; chosen once more after a change it is the new one."""
    path = tmp_path / "plate.wkt"
    path.write_text("POLYGON ((0 0, 1 0, 1 4, 0 4, 0 0))", encoding="utf-8")
    chooser = page.get_by_label("Body file")
    chooser.set_input_files(path)
    unit = page.get_by_label("Unit of the file")
    expect(unit).to_have_attribute("aria-invalid", "true")
    path.write_text("POLYGON ((0 0, 2 0, 2 4, 0 4, 0 0))", encoding="utf-8")
    unit.select_option("m")
    slender = page.locator("[data-testid=facts-table] tr", has_text="Slenderness h/b")
    expect(slender).to_contain_text(re.compile(r"h/b4$|h/b4\b"))
    unit.select_option("cm")
    expect(unit).not_to_have_attribute("aria-invalid", "true")
    chooser.set_input_files(path)
    expect(slender).to_contain_text(re.compile(r"h/b2\b"))
