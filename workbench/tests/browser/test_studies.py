"""Studies, as a user launches, watches, cancels and reads them."""

import json
import math
import time
from base64 import urlsafe_b64encode
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import pytest
from playwright.sync_api import expect
from waiting import allowed

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


def kept_inputs(page: Any) -> dict[str, Any]:
    """Return the inputs that the page keeps."""
    found: dict[str, Any] = page.evaluate("JSON.parse(sessionStorage.getItem('rocking.inputs'))")
    return found


def refused(page: Any, words: str) -> None:
    """Press Launch and read why nothing starts."""
    page.get_by_test_id("study-launch").click()
    expect(page.locator("#study-problem")).to_contain_text(words)


@pytest.fixture
def studies(open_page: Callable[..., Any]) -> Any:
    """Open the step Studies with a block and a pulse."""
    return open_page(fragment(PULSE))


def launched_map(page: Any, name: str, cells: int = 24) -> None:
    """Launch a map and wait for its picture."""
    counted(page, cells)
    page.locator("#study-name").fill(name)
    page.get_by_test_id("study-launch").click()
    page.get_by_test_id("map-canvas").wait_for()


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
    expect(studies.get_by_test_id("verdict")).to_be_visible()
    expect(studies.get_by_test_id("response-refusal")).to_be_empty()
    assert "view=response" in studies.evaluate("location.hash")
    assert None not in kept_inputs(studies).values()
    found = next(each for each in served.api("studies", method="GET")["studies"] if each["name"] == "first map")
    result = served.api(f"studies/{found['id']}/result", method="GET")
    assert len(result["outcome"]) == 2
    assert len(result["outcome"][0]) == len(result["outcome"][0][0]) == 24


def test_the_cell_that_was_clicked_is_opened(studies: Any, served: Any) -> None:
    """On the way from a clicked cell to the button other cells are passed: the clicked one opens, with a verdict."""
    launched_map(studies, "clicked cell", 12)
    canvas = studies.get_by_test_id("map-canvas")
    box = canvas.bounding_box()
    go = studies.get_by_role("button", name="Open in Response")
    canvas.hover(position={"x": 0.4 * box["width"], "y": 0.4 * box["height"]})
    expect(studies.get_by_test_id("cell-words")).to_contain_text("Click the cell")
    expect(go).to_be_disabled()
    canvas.click(position={"x": 0.5 * box["width"], "y": 0.2 * box["height"]})
    expect(go).to_be_enabled()
    told, words = (studies.get_by_test_id(name) for name in ("map-told", "cell-words"))
    clicked, story = told.inner_text(), words.inner_text()
    canvas.hover(position={"x": 0.8 * box["width"], "y": 0.8 * box["height"]})
    expect(told).not_to_have_text(clicked)
    studies.locator("[data-testid=cell-history] h3").hover()
    expect(told).to_have_text(clicked)
    expect(words).to_have_text(story)
    go.click()
    expect(studies.get_by_test_id("verdict")).to_be_visible()
    found = kept_inputs(studies)
    assert None not in found.values()
    answer = served.api("response", json=found)["answers"][0]
    assert story.startswith(answer["summary"])


def test_a_number_in_error_launches_nothing(studies: Any, served: Any) -> None:
    """With a field marked wrong nothing is launched: its last good number is not the one on the screen."""
    before = len(served.api("studies", method="GET")["studies"])
    studies.locator("#view-studies").get_by_label("from").first.fill("x")
    refused(studies, "invalid")
    assert len(served.api("studies", method="GET")["studies"]) == before


def test_axes_follow_the_motion_and_names_stay_apart(studies: Any) -> None:
    """A synthetic motion has no pulse frequency as an axis; the second study of one name gets a number."""
    across = studies.get_by_label("Horizontal axis", exact=True)
    assert across.input_value() == "frequency_ratio"
    for _ in range(2):
        launched_map(studies, "one name", 4)
        expect(studies.locator("#study-name")).to_have_value("")
    expect(studies.locator(".study strong", has_text="one name 2")).to_have_count(1)
    studies.get_by_role("tab", name="Motion").click()
    studies.locator("#view-motion .segment", has_text="Synthetic").click()
    studies.get_by_role("tab", name="Studies").click()
    expect(across).to_have_value("scale")
    expect(across.locator("option[value=frequency_ratio]")).to_have_count(0)
    counted(studies, 3)
    studies.get_by_test_id("study-launch").click()
    expect(studies.locator(".study", has_text="overturning map").first).to_have_attribute("data-state", "done")


def table_of(amplitude: float) -> bytes:
    """Return a record of two columns that does not name its unit."""
    rows = (f"{0.01 * k:.2f},{amplitude * math.sin(6.0 * k * 0.01):.6f}" for k in range(401))
    return ("\n".join(rows) + "\n").encode()


def sent(served: Any, name: str, content: bytes) -> None:
    """Upload a record as a script does."""
    served.api("records", params={"name": name}, content=content, headers={"Content-Type": "application/octet-stream"})


def test_records_are_ticked_told_and_deleted(studies: Any, served: Any, shot: Any) -> None:
    """Records without a unit are asked for it once, the ticked ones make a cloud, and one is deleted."""
    for each in served.api("records", method="GET"):
        served.api(f"records/{each['record']}", method="DELETE")
    for k in range(4):
        sent(served, f"site{k}.csv", table_of(0.3 + 0.1 * k))
    studies.get_by_role("radio", name="Fragility").check(force=True)
    studies.get_by_role("radio", name="Cloud").check(force=True)
    studies.get_by_role("radio", name="Uploaded records").check(force=True)
    rows = studies.locator(".record-row")
    expect(rows).to_have_count(4)
    refused(studies, "No record is selected")
    for row in rows.all():
        row.get_by_label("Unit of the accelerations").select_option("g")
        row.get_by_role("button", name="Apply").click()
        expect(row.get_by_role("checkbox")).to_be_checked()
    rows.first.get_by_role("checkbox").uncheck()
    expect(studies.get_by_test_id("record-choice")).to_contain_text("3 of 4 records are selected")
    shot(studies, "studies-records")
    studies.locator("#study-name").fill("cloud of records")
    studies.get_by_test_id("study-launch").click()
    studies.get_by_test_id("fragility-fits").first.wait_for()
    assert studies.get_by_test_id("fragility-chart").count() >= 1
    studies.once("dialog", lambda dialog: dialog.accept())
    rows.first.get_by_role("button", name="Delete").click()
    expect(rows).to_have_count(3)
    assert len(served.api("records", method="GET")) == 3
    studies.reload()
    studies.get_by_role("radio", name="Fragility").check(force=True)
    studies.get_by_role("radio", name="Uploaded records").check(force=True)
    expect(studies.get_by_test_id("record-choice")).to_contain_text("3 of 3 records are selected")


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
    studies.get_by_test_id("fragility-fits").first.wait_for()
    assert studies.get_by_test_id("fragility-chart").count() >= 1
    assert "overturn" in studies.get_by_test_id("fragility-fits").first.inner_text()
    shot(studies, "studies-fragility")


def test_a_study_without_a_form_of_its_own(studies: Any, shot: Any) -> None:
    """Its fields are the keys of its table; a value that its class refuses starts nothing."""
    studies.get_by_role("radio", name="Histories").check(force=True)
    studies.get_by_label("scales").fill("one")
    refused(studies, "Scales must be")
    studies.get_by_label("scales").fill("0.5, 1, 2")
    studies.locator("#study-name").fill("three scales")
    studies.get_by_test_id("study-launch").click()
    expect(studies.get_by_test_id("study-counts").first).to_contain_text("overturns")
    shot(studies, "studies-histories")


def test_a_study_without_ground_motion(studies: Any, shot: Any) -> None:
    """A basin needs no motion; its summary and its picture are shown."""
    studies.get_by_role("radio", name="Basins").check(force=True)
    studies.get_by_label("phases").fill("12")
    studies.get_by_label("speeds").fill("12")
    studies.locator("#study-name").fill("small basin")
    studies.get_by_test_id("study-launch").click()
    expect(studies.get_by_test_id("sheet-findings")).to_contain_text("stability")
    expect(studies.locator("img.drawing")).to_have_js_property("complete", True)
    assert studies.locator("img.drawing").evaluate("image => image.naturalWidth") > 100
    shot(studies, "studies-basins")


def test_rocking_spectra(studies: Any, shot: Any) -> None:
    """Spectra show one curve for every slenderness and model."""
    studies.get_by_role("radio", name="Rocking spectra").check(force=True)
    studies.locator("#study-name").fill("spectra of a pulse")
    studies.get_by_test_id("study-launch").click()
    studies.get_by_test_id("spectrum-chart").wait_for()
    assert studies.locator("[data-testid=spectrum-chart] .legend li").count() == 6
    keys = studies.locator("[data-testid=spectrum-chart] .legend li")
    looks = {}
    for key in keys.all():
        line = key.locator("path")
        looks[key.inner_text()] = (line.get_attribute("stroke"), line.get_attribute("stroke-dasharray"))
    assert len(set(looks.values())) == 6
    # the dash is the model's: KED's line is whole, Housner's is not; no colour is that of another model
    assert {dash for words, (_, dash) in looks.items() if "KED" in words} == {None}
    assert {dash for words, (_, dash) in looks.items() if "Housner" in words} == {"6 4"}
    assert not {colour for colour, _ in looks.values()} & {"#0070B2", "#D96C00"}
    shot(studies, "studies-spectra")


@pytest.mark.speed
def test_cancel_and_resume(open_page: Callable[..., Any], shot: Any, until: Callable[..., None]) -> None:
    """A long study shows progress, stops within a second of Cancel, keeps what is finished, and goes on."""
    models = ["ked", "housner", "horizontal-momentum", "shifted-impulse", "distributed-impulse", "plastic-winkler"]
    studies = open_page(fragment({**PULSE, "restitution": {"models": models, "values": [0.8, 0.85, 0.9, 0.95]}}))
    counted(studies, 400)
    studies.locator("#study-name").fill("long study")
    studies.get_by_test_id("study-launch").click()
    row = studies.locator(".study", has_text="long study")
    row.locator("progress").wait_for()
    expect(row).to_have_attribute("data-state", "running")
    until(studies, lambda: row.locator("progress").evaluate("bar => bar.value") > 0.0)
    shot(studies, "studies-running")
    start = time.perf_counter()
    row.get_by_role("button", name="Cancel").click()
    expect(row).to_have_attribute("data-state", "cancelled")
    assert time.perf_counter() - start < allowed(1.2)
    kept = row.locator("progress").evaluate("bar => bar.value")
    assert 0.0 < kept < 1.0
    row.get_by_role("button", name="Resume").click()
    expect(row).to_have_attribute("data-state", "done")


FOCUS = """async () => {
  const [{ html, render, signal }, { StudyList }] = await Promise.all(
    ["/parts/preact.js", "/views/studies-list.js"].map((each) => import(each)));
  const place = document.createElement("div");
  document.querySelector("#view-studies").append(place);
  const study = { id: "x", name: "running", kind: "stripes", state: "running", histories: 100, histories_done: 1 };
  const all = signal([study]);
  render(html`<${() => html`<${StudyList} studies=${all.value} acts=${{}} />`} />`, place);
  const heard = [];
  const told = async (more, first = []) => {
    all.value = [...first, { ...study, ...more }];
    await new Promise((resolve) => setTimeout(resolve, 50));
    heard.push([document.activeElement.textContent, place.querySelector("[data-testid=study-x] progress").value]);
  };
  place.querySelector("button:not([hidden])").focus();
  await told({ histories_done: 50 });
  await told({ histories_done: 60 }, [{ ...study, id: "y", name: "newer" }]);
  await told({ histories_done: 70, state: "cancelled" });
  await told({ histories_done: 70, state: "running" });
  await told({ histories_done: 100, state: "done" });
  render(null, place);
  place.remove();
  return heard;
}"""


def test_a_finished_study_takes_no_focus(studies: Any) -> None:
    """Who types while it is computed types on when it comes; who presses to see it is led to it."""
    counted(studies, 4)
    name = studies.locator("#study-name")
    name.fill("typed on")
    studies.get_by_test_id("study-launch").click()
    name.focus()
    title = studies.locator(".study-result-title")
    expect(title).to_have_text("typed on")
    canvas = studies.get_by_test_id("map-canvas")
    canvas.wait_for()
    expect(name).to_be_focused()
    studies.get_by_role("button", name="Show result: typed on").click()
    expect(title).to_be_focused()
    name.fill("looked at")
    canvas.focus()
    studies.get_by_test_id("study-launch").evaluate("node => node.click()")
    expect(title).to_have_text("looked at")
    expect(title).to_be_focused()  # what was looked at has gone


def test_the_focus_stays_with_a_study(studies: Any) -> None:
    """Neither progress nor a newer study takes the focus; where a button vanishes, the one in its place has it."""
    assert studies.evaluate(FOCUS) == [
        ["Cancel", 0.5], ["Cancel", 0.6], ["Resume", 0.7], ["Cancel", 0.7], ["Show result", 1.0],
    ]  # fmt: skip


def test_names_are_not_translated(studies: Any) -> None:
    """A study's name stands in its row and over its result as it was given."""
    launched_map(studies, "running", 4)
    names = studies.locator("#view-studies [translate=no]").filter(has_text="running")
    expect(names).to_have_count(2)


def test_exports(studies: Any, tmp_path: Path) -> None:
    """Every file of a finished map is saved, is not empty, and begins as its kind does."""
    launched_map(studies, "exports")
    begins = {
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
    page = open_page(fragment({**PULSE, "motion": None, "response": {"initial_rotation": 0.5}}))
    page.get_by_test_id("study-launch").click()
    assert "motion" in page.locator("#study-problem").inner_text()


def test_phone_and_dark(open_page: Callable[..., Any], shot: Any) -> None:
    """The step fits a phone, light and dark, without anything wider than the screen."""
    for scheme in ("light", "dark"):
        page = open_page(fragment(PULSE), viewport={"width": 360, "height": 740}, color_scheme=scheme)
        launched_map(page, f"phone {scheme}", 12)
        assert page.evaluate("document.documentElement.scrollWidth") <= 360
        shot(page, f"studies-phone-{scheme}")


def test_a_spectrum_of_one_slenderness_wears_the_look_of_its_model(studies: Any) -> None:
    """With one angle KED is KED's whole orange line and Housner his blue dashes, as everywhere in the page."""
    studies.get_by_role("radio", name="Rocking spectra").check(force=True)
    parts = studies.locator("#view-studies .range-fields")
    upper, lower = parts.nth(0).bounding_box(), parts.nth(1).bounding_box()
    assert lower["y"] - upper["y"] - upper["height"] > 8.0
    for field, text in (("from", "0.2"), ("to", "0.2"), ("number", "1")):
        parts.nth(0).get_by_label(field).fill(text)
    parts.nth(1).get_by_label("number").fill("8")
    studies.locator("#study-name").fill("one slenderness")
    studies.get_by_test_id("study-launch").click()
    keys = studies.locator("[data-testid=spectrum-chart] .legend li")
    expect(keys).to_have_count(2)
    ked, housner = (keys.filter(has_text=name).locator("path") for name in ("KED", "Housner"))
    expect(ked).to_have_attribute("stroke", "#D96C00")
    assert ked.get_attribute("stroke-dasharray") is None
    expect(housner).to_have_attribute("stroke", "#0070B2")
    expect(housner).to_have_attribute("stroke-dasharray", "6 4")


@pytest.mark.parametrize(("view", "words"), [("studies", "Studies"), ("takeaway", "Export")])
def test_each_step_has_a_heading(open_page: Callable[..., Any], view: str, words: str) -> None:
    """A screen reader finds the step by its first heading."""
    expect(open_page(view=view).get_by_role("heading", level=1)).to_have_text(words)


LARGE_MAP = """async (count) => {
  const [{ layersOf, cellWords }, { OverturningMap }, { html, render }] = await Promise.all(
    ["/views/studies-layers.js", "/views/studies-map.js", "/parts/preact.js"].map((each) => import(each)));
  const many = (value) => Array.from({ length: count }, (_, k) => value(k));
  const grid = (value) => many((iy) => many((ix) => value(ix, iy)));
  const axis = { values: many((k) => 1 + k), unit: "1", description: "a" };
  const fell = (ix, iy) => ix > iy;
  const found = {
    x: axis, y: axis, restitutions: ["ked"], contours: [[]],
    outcome: [grid((ix, iy) => (fell(ix, iy) ? 2 : 1))], impacts: [grid((ix, iy) => (ix === 3 && iy === 5 ? 41 : 2))],
    peak: [grid((ix) => ix / count)],
  };
  const place = document.createElement("div");
  document.querySelector("#view-studies").append(place);
  const busy = () => performance.now(), started = busy();
  const app = { call: async () => ({ stored: { impacts: 2 } }) }, chosen = { restitution: 0 };
  render(html`<${OverturningMap} app=${app} study=${{ id: "x" }} result=${found} chosen=${chosen} />`, place);
  const shown = busy() - started, canvas = place.querySelector("canvas"), box = canvas.getBoundingClientRect();
  const again = busy();
  for (let k = 0; k < 20; k += 1) {
    canvas.dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + 100 + 10 * k, clientY: box.top + 100 }));
    await new Promise((done) => setTimeout(done));
  }
  const moved = (busy() - again) / 20;
  const paint = (x, y) => Array.from(canvas.getContext("2d").getImageData(
    Math.round(x * canvas.width), Math.round(y * canvas.height), 1, 1).data);
  const legend = layersOf(found, 0, null)[2].legend.map((each) => each.label);
  const words = cellWords(found, 0, { ix: 3, iy: 5 });
  return { legend, words, shown, moved, upper: paint(0.3, 0.2), lower: paint(0.85, 0.6) };
}"""


@pytest.mark.parametrize("count", [400, 1000])
def test_a_large_map_is_drawn_and_can_be_walked(studies: Any, count: int) -> None:
    """A map of 1000 x 1000 cells appears, names its most impacts, and a pointer that moves over it redraws at once."""
    found = studies.evaluate(LARGE_MAP, count)
    assert "41" in found["legend"]
    assert "rocks, does not overturn" in found["words"]
    assert (found["upper"], found["lower"]) == ([0x9C, 0xC9, 0xE8, 255], [0xF5, 0xDC, 0x57, 255])
    print(f"{count} x {count}: drawn in {found['shown']:.0f} ms, again in {found['moved']:.1f} ms")
    # the picture of the cells is kept: what a move draws again is the frame, however many cells there are
    assert found["moved"] < found["shown"]


DRAWN = {
    "body": {
        "units": "cm", "name": "leaning stele",
        "section": {"depth": 21.5, "feet": [3.25, 47.5], "region": [
            {"outline": [[0, 0], [50, 0], [61.125, 180.0625], [7, 201.3]], "density": 2345.6,
             "holes": [[[20, 40], [30, 41], [27, 60]]]},
        ]},
    },
    "motion": {"pulse": "sine:amplitude=3,period=0.6", "scale": 1.0625},
    "restitution": {"models": ["housner", "ked"]},
    "response": {"assumed_friction": 0.375},
}  # fmt: skip


def test_the_drawn_body_outlasts_a_cell(open_page: Callable[..., Any], shot: Any) -> None:
    """A cell, then another one opened in Response: a button brings what was drawn back, to the last digit, and again.

    Neither a reload nor a change of the cell's numbers comes between; what was dropped on purpose is gone.
    """
    page = open_page(fragment(DRAWN))
    own = kept_inputs(page)
    assert own == DRAWN
    line, canvas = page.get_by_test_id("lent"), page.get_by_test_id("map-canvas")
    launched_map(page, "lent", 6)
    for place in (0.3, 0.6):
        canvas.click(position={"x": place * canvas.bounding_box()["width"], "y": 100})
        go = page.get_by_role("button", name="Open in Response")
        expect(go).to_be_enabled()
        go.click()
        expect(page.get_by_test_id("verdict")).to_be_visible()
        expect(line).to_contain_text("a cell of \u201clent\u201d")
        assert kept_inputs(page) != own
        page.get_by_role("tab", name="Studies").click()
    page.get_by_role("tab", name="Response").click()
    shot(page, "response-lent", full_page=False)
    page.get_by_label("Scale of the motion").focus()
    page.keyboard.press("ArrowRight")
    changed = kept_inputs(page)
    page.reload()
    page.get_by_role("button", name="Restore my inputs").click()
    assert kept_inputs(page) == own
    page.get_by_role("tab", name="Body").click()
    expect(page.get_by_test_id("editor")).to_be_visible()
    expect(page.get_by_label("Name")).to_have_value("leaning stele")
    page.get_by_role("button", name="Show the other inputs").click()
    assert kept_inputs(page) == changed
    page.get_by_role("button", name="Restore my inputs").click()
    page.get_by_role("button", name="Discard the other inputs").click()
    expect(line).to_be_hidden()
    assert kept_inputs(page) == own


def test_a_link_or_a_file_replaces_nothing_for_good(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Inputs of a link pasted into the tab, and the body of a dropped file, stand in for one's own, which come back."""
    page = open_page(fragment(DRAWN, "body"))
    page.evaluate("(hash) => { location.hash = hash; }", fragment(PULSE, "body"))
    expect(page.get_by_test_id("lent")).to_contain_text("a link")
    drawing = tmp_path / "wedge.wkt"
    drawing.write_text("POLYGON ((0 0, 60 0, 10 200, 0 0))", encoding="utf-8")
    page.get_by_label("Unit of the file").select_option("cm")
    page.get_by_label("Body file").set_input_files(drawing)
    expect(page.get_by_test_id("lent")).to_contain_text("the file wedge.wkt")
    page.get_by_role("button", name="Restore my inputs").click()
    assert kept_inputs(page) == DRAWN
