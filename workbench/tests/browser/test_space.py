"""In space: a scan is dropped, what was mended is told, it stands, settles and moves, and three.js comes only then."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser_pages import asked_in_space as asked
from browser_pages import link, scan
from browser_pages import scan_sent as sent
from waiting import allowed

trimesh = pytest.importorskip("trimesh")
expect = pytest.importorskip("playwright.sync_api").expect
LIBRARY = "/vendor/three/"


def seen(page: Any) -> Any:
    """Return the picture as it is on the screen."""
    import io

    from PIL import Image

    shot = page.get_by_test_id("space-stage").screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def test_a_scan_stands_and_settles(
    open_page: Callable[..., Any], shot: Callable[..., Any], record: Any, served: Any, tmp_path: Path
) -> None:
    """What was mended is told; the picture changes with the pose; three.js was not asked for before the answer."""
    page = open_page(view="space")
    assert not [url for url in record.requests if LIBRARY in url]
    outcome = asked(page, "equilibria", scan(tmp_path))
    assert len({url for url in record.requests if LIBRARY in url}) == 2
    mended = outcome.get_by_role("list", name="Repairs").inner_text()
    assert "Closed 1 hole" in mended
    assert "% of the volume" in mended
    expect(outcome.get_by_role("list", name="Legend")).to_contain_text("closed by repair")
    question = served.api("questions", method="GET")["questions"][0]
    answer = served.api(f"questions/{question['id']}", method="GET")["answer"]
    words = outcome.get_by_test_id("space-words")
    expect(words).to_contain_text(f"Pose {answer['stands_in']}")
    expect(outcome.get_by_test_id("verdict")).to_contain_text(f"{len(answer['stable'])} stable poses")
    before = seen(page)
    assert len(np.unique(before.reshape(-1, 3), axis=0)) > 200  # shaded and coloured, not an empty ground
    outcome.get_by_label("Stable pose", exact=True).select_option("0")
    expect(words).to_contain_text("Pose 0")
    page.wait_for_timeout(1500)  # it turns for 0.7 s
    assert (np.abs(seen(page) - before).max(axis=2) > 30).mean() > 0.02
    shot(page, "space-stands")
    # in that pose it is asked again: what stands then is as high as the pose was
    outcome.get_by_role("button", name="Use pose 0").click()
    section = page.locator("#view-space")
    expect(section).to_contain_text("Pose 0 of the last result")
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(words).to_contain_text("Pose 0")
    expect(outcome).to_have_attribute("data-state", "done")
    question = served.api("questions", method="GET")["questions"][0]
    again = served.api(f"questions/{question['id']}", method="GET")["answer"]
    assert again["stands_in"] == 0
    assert again["body"]["centre_height"] == pytest.approx(answer["stable"][0]["centre_height"], rel=1e-6)
    # a browser that draws nothing in three dimensions says so, and tells the rest
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.reload()
    section.get_by_role("button", name="Show Stable poses").first.click()
    expect(section).to_contain_text("cannot draw in 3D")
    expect(words).to_contain_text("The centre of mass must rise")


def test_its_edges(open_page: Callable[..., Any], shot: Callable[..., Any], tmp_path: Path) -> None:
    """Every edge has its row with every model; the body can be turned by keys."""
    page = open_page(view="space")
    outcome = asked(page, "restitution", scan(tmp_path))
    table = outcome.get_by_role("table", name="Edges and corners")
    assert table.locator("tbody tr").count() == 4
    assert "ked-3d" in table.locator("thead").inner_text()
    before = seen(page)
    page.get_by_test_id("space-stage").focus()
    for key in ("ArrowLeft", "ArrowLeft", "ArrowUp", "+"):
        page.keyboard.press(key)
    assert (np.abs(seen(page) - before).max(axis=2) > 30).mean() > 0.02
    shot(page, "space-edges")


def test_it_moves_and_falls(
    open_page: Callable[..., Any], shot: Callable[..., Any], until: Any, tmp_path: Path
) -> None:
    """Played, stopped, scrubbed and stepped by keys; words say where it is, and that it fell."""
    page = open_page(link("sine:amplitude=6,period=0.8"))
    page.locator("#tab-space").click()
    section = page.locator("#view-space")
    section.get_by_label("Analysis").select_option("simulate")
    section.get_by_label("Impacts").select_option("")
    section.get_by_label("Coefficient of restitution").fill("0.6")
    section.get_by_label("Scale factor").fill("1.5")
    outcome = asked(page, "simulate", scan(tmp_path))
    expect(outcome.get_by_test_id("verdict")).to_contain_text("verturned")
    words, time = outcome.get_by_test_id("space-words"), outcome.get_by_test_id("space-time")
    expect(words).to_contain_text("At 0.00 s: tilt 0.00\u00b0, 4 contact points")
    outcome.get_by_label("Speed").select_option("0.1")  # a slow machine must not reach the end first
    outcome.get_by_test_id("space-play").click()
    until(page, lambda: page.evaluate("rockingFrames.count") > 10)
    page.get_by_test_id("space-stage").focus()
    page.keyboard.press(" ")
    expect(outcome.get_by_test_id("space-play")).to_have_text("Play")
    last = float(time.evaluate("node => node.max"))
    assert 0.0 < float(time.input_value()) < last
    move = "(node, to) => { node.value = to; node.dispatchEvent(new Event('input', { bubbles: true })); }"
    time.evaluate(move, last / 2.0)
    time.focus()
    page.keyboard.press("ArrowRight")
    until(page, lambda: float(time.input_value()) == pytest.approx(last / 2.0 + 0.05, abs=1e-3))
    time.evaluate(move, last)
    expect(words).to_contain_text("overturned")
    shot(page, "space-moves")
    page.emulate_media(reduced_motion="reduce")
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0


def test_the_body_of_the_project_is_asked_in_space(
    open_page: Callable[..., Any], shot: Callable[..., Any], served: Any, tmp_path: Path
) -> None:
    """A block over its depth stands, and rocks; scans that were sent stay in the project and can be chosen again."""
    block = {"units": "m", "width": 0.5, "height": 2.0, "depth": 0.4}
    page = open_page(link("sine:amplitude=4,period=0.8", body=block))
    page.locator("#tab-space").click()
    section = page.locator("#view-space")
    section.get_by_label("Drop a scan here, or").set_input_files(scan(tmp_path))
    sent(section, "leaning-block.stl")
    body = section.get_by_label("Body", exact=True)
    expect(body.locator("option:checked")).to_have_text("leaning-block.stl")
    body.select_option(label="the body of this project")
    expect(section.get_by_label("Unit of the file")).to_have_count(0)
    said = {
        "equilibria": "stable pose",
        "restitution": "Coefficient of restitution of each base edge",
        "simulate": "impact",
    }
    for what, verdict in said.items():
        outcome = asked(page, what)
        expect(outcome.get_by_test_id("verdict")).to_contain_text(verdict)
        question = served.api("questions", method="GET")["questions"][0]
        answer = served.api(f"questions/{question['id']}", method="GET")["answer"]
        assert answer["body"]["size"] == pytest.approx([0.5, 0.4, 2.0])
        shot(page, f"space-own-{what}")
    expect(page.get_by_test_id("project-saved")).to_have_text("saved")
    other = open_page(view="space").locator("#view-space").get_by_label("Body", exact=True)
    expect(other.locator("option")).to_have_text(["leaning-block.stl", "the body of this project"])
    expect(other.locator("option:checked")).to_have_text("the body of this project")


def test_what_cannot_be_a_body_is_refused(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """No scan, no unit, no number, a surface that is not closed: each in a sentence, none as a picture."""
    page = open_page(view="space")
    section = page.locator("#view-space")
    ask = section.get_by_role("button", name="Compute", exact=True)
    ask.click()
    expect(section.get_by_role("alert")).to_contain_text("Add a scan")
    section.get_by_label("Drop a scan here, or").set_input_files(scan(tmp_path))
    sent(section, "leaning-block.stl")
    ask.click()
    expect(section.get_by_role("alert")).to_contain_text("contain no unit")
    section.get_by_label("Unit of the file").select_option("mm")
    section.get_by_label("Analysis").select_option("simulate")
    section.get_by_label("Impacts").select_option("")
    section.get_by_label("Coefficient of restitution").fill("half")
    ask.click()
    expect(section.get_by_role("alert")).to_contain_text("Enter a coefficient from 0 to 1.")
    section.get_by_label("Analysis").select_option("equilibria")
    section.get_by_text("Mesh repairs", exact=True).click()
    section.get_by_label("Repairs", exact=True).select_option("none")
    ask.click()
    refused = section.get_by_test_id("outcome")
    expect(refused).to_have_attribute("data-state", "refused")
    expect(section.get_by_role("alert")).to_contain_text("The surface is not closed: 1 hole")
    assert section.get_by_test_id("space-stage").count() == 0


@pytest.mark.speed
def test_a_frame_costs_little(open_page: Callable[..., Any], until: Callable[..., None], tmp_path: Path) -> None:
    """A body of 50,000 faces is played with less than 4 ms of script in the median frame, and none over 16 ms."""
    page = open_page(link("sine:amplitude=4.5,period=0.8"))
    page.locator("#tab-space").click()
    section = page.locator("#view-space")
    section.get_by_label("Analysis").select_option("simulate")
    section.get_by_label("Impacts").select_option("")
    path = scan(tmp_path, hole=False, faces=49_000)
    outcome = asked(page, "simulate", path)
    outcome.get_by_label("Speed").select_option("0.1")
    outcome.get_by_test_id("space-play").click()
    until(page, lambda: page.evaluate("rockingFrames.count") > 120)
    times = np.array(json.loads(page.evaluate("JSON.stringify([...rockingFrames.times].slice(0, 120))")))
    assert np.median(times) < 1000.0 * allowed(0.004)
    assert times.max() < 1000.0 * allowed(0.016)
