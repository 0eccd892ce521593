"""The view of the motion, used as a person uses it: files dropped, pulses chosen, sliders moved."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser_pages import link, pasted
from playwright.sync_api import expect

from rocking.motions import GroundMotion, pulses
from rocking.motions.formats import write_motion

STEP, COUNT = 0.01, 801
DROP = """([name, text]) => {
  const transfer = new DataTransfer();
  transfer.items.add(new File([text], name));
  const zone = document.querySelector("[data-testid=record-drop]");
  for (const kind of ["dragover", "drop"]) {
    zone.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }
}"""


def shaking() -> GroundMotion:
    """Return a decaying wave whose peak is known: 2.5 m/s2 at 1.0 s."""
    time = STEP * np.arange(COUNT)
    wave = np.sin(2.0 * np.pi * 1.25 * time) * np.exp(-0.4 * np.abs(time - 1.0))
    return GroundMotion(2.5 * wave / np.abs(wave).max(), STEP, vertical=0.5 * np.roll(wave, 7), name="test wave")


def inputs(page: Any) -> dict[str, Any]:
    """Return the inputs that the page keeps."""
    found: dict[str, Any] = page.evaluate("JSON.parse(sessionStorage.getItem('rocking.inputs'))")
    return found


def way(page: Any, text: str) -> None:
    """Choose where the motion comes from."""
    page.locator("#view-motion .segment", has_text=text).first.click()


def fact(page: Any, word: str) -> str:
    """Return one of the facts of the motion."""
    text: str = page.locator(f"[data-testid=motion-facts] dt:text-is('{word}') + dd").inner_text()
    return text


@pytest.fixture
def view(open_page: Callable[..., Any]) -> Any:
    """Open the view with the first motion measured."""
    page = open_page(view="motion")
    page.get_by_test_id("measures-table").wait_for()
    return page


@pytest.fixture
def of_two(view: Any, tmp_path: Path) -> Any:
    """Read a file of two components, which asks for the horizontal one."""
    path = tmp_path / "two.csv"
    write_motion(shaking(), path, "columns")
    way(view, "Record file")
    view.get_by_test_id("record-file").set_input_files(path)
    needs = view.get_by_test_id("record-needs")
    needs.get_by_label("Horizontal component").select_option("horizontal")
    needs.get_by_role("button", name="Apply").click()
    return view


def test_a_record_that_says_all_is_read_at_once(view: Any, tmp_path: Path, shot: Callable[..., Path]) -> None:
    """A PEER file names unit and step: chosen, it is measured, and its peak is the one that was written."""
    path = tmp_path / "wave.AT2"
    write_motion(GroundMotion(shaking().acceleration, STEP, name="test wave"), path, "peer")
    way(view, "Record file")
    view.get_by_test_id("record-file").set_input_files(path)
    view.get_by_test_id("record-held").get_by_text("wave.AT2").wait_for()
    view.get_by_test_id("motion-facts").filter(has_text="2.5").wait_for()
    assert fact(view, "Peak acceleration").startswith("2.5")
    assert fact(view, "Duration").startswith("8")
    assert len(inputs(view)["motion"]["record"]) == 64
    shot(view, "motion-record")


def test_what_a_file_does_not_say_is_asked_for(view: Any, shot: Callable[..., Path]) -> None:
    """A dropped table of two columns in g is asked for its unit; the answer makes the peak 0.25 g, not 0.25 m/s2."""
    rows = [f"{STEP * k:.3f},{0.25 * math.sin(0.25 * math.pi * k):.9f}" for k in range(201)]
    way(view, "Record file")
    view.evaluate(DROP, ["site.csv", "\n".join(rows) + "\n"])
    needs = view.get_by_test_id("record-needs")
    needs.get_by_label("Unit of the accelerations").wait_for()
    shot(view, "motion-needs")
    needs.get_by_label("Unit of the accelerations").select_option("g")
    needs.get_by_role("button", name="Apply").click()
    view.get_by_test_id("motion-facts").filter(has_text="0.25").wait_for()
    assert "(0.25\u00a0g)" in fact(view, "Peak acceleration")
    assert inputs(view)["motion"]["units"] == "g"


def test_components_are_chosen_and_the_vertical_one_is_drawn(of_two: Any) -> None:
    """A file of two components asks which is horizontal; with the other as vertical one a fourth curve stands there."""
    held = of_two.get_by_test_id("record-held")
    held.get_by_label("Vertical component").select_option("vertical")
    of_two.locator("[data-testid=motion-traces] figcaption", has_text="Vertical acceleration").wait_for()
    assert inputs(of_two)["motion"]["vertical"] == "vertical"


def test_a_file_that_is_no_record_is_refused_in_words(view: Any) -> None:
    """Of a file that is no record the server's sentence is shown, and the motion stays as it was."""
    before = inputs_or_first(view)
    way(view, "Record file")
    view.evaluate(DROP, ["letter.AT2", "Dear friend,\nthis is no record.\n"])
    told = view.locator("[data-testid=record-answer] .note.error")
    told.wait_for()
    assert "letter.AT2" in told.inner_text()
    assert inputs_or_first(view) == before


def test_components_can_be_chosen_after_a_reload(of_two: Any) -> None:
    """A page loaded again asks the server for the components; neither list offers what the other has taken."""
    held = of_two.get_by_test_id("record-held")
    expect(held.locator(".record-name")).to_be_focused()
    of_two.reload()
    vertical = held.get_by_label("Vertical component")
    expect(vertical.locator("option")).to_have_text(["none", "vertical"])
    vertical.focus()
    vertical.select_option("vertical")
    expect(held.get_by_label("Horizontal component").locator("option")).to_have_text(["horizontal"])
    expect(held.get_by_label("Vertical component")).to_be_focused()
    assert inputs(of_two)["motion"]["vertical"] == "vertical"


def test_a_clash_of_components_is_undone_in_the_page(of_two: Any) -> None:
    """With one component for both, as a link may have it, each list is whole and the refusal goes with a choice."""
    expect(of_two.get_by_test_id("record-held").locator(".record-name")).to_be_visible()
    found = inputs(of_two)
    found["motion"] |= {"vertical": "horizontal"}
    of_two.evaluate("(given) => sessionStorage.setItem('rocking.inputs', JSON.stringify(given))", found)
    of_two.reload()
    expect(of_two.get_by_test_id("motion-refusal")).not_to_be_empty()
    held = of_two.get_by_test_id("record-held")
    expect(held.get_by_label("Horizontal component").locator("option")).to_have_text(["horizontal", "vertical"])
    expect(held.get_by_label("Vertical component").locator("option")).to_have_text(["none", "horizontal", "vertical"])
    held.get_by_label("Vertical component").select_option("vertical")
    expect(of_two.get_by_test_id("motion-refusal")).to_be_empty()


def test_without_a_motion_each_way_can_be_chosen(open_page: Callable[..., Any]) -> None:
    """After free rocking and a reload no way looks chosen; a pulse shakes the body again, and so does the last one."""
    page = open_page(view="motion")
    page.get_by_test_id("pulse-parameters").get_by_label("Period, exactly").fill("0.55")
    page.get_by_role("tab", name="Response").click()
    page.get_by_label("Start from an initial rotation").check()
    page.reload()
    page.get_by_role("tab", name="Motion").click()
    expect(page.get_by_test_id("motion-refusal")).to_contain_text("No motion is selected")
    ways = page.get_by_role("group", name="Source of the motion").get_by_role("radio")
    expect(ways).to_have_count(3)
    expect(ways.and_(page.locator(":checked"))).to_have_count(0)
    way(page, "Pulse")
    expect(ways.and_(page.locator(":checked"))).to_have_count(1)
    expect(page.get_by_test_id("motion-facts")).to_be_visible()
    assert "period=0.55" in inputs(page)["motion"]["pulse"]
    page.get_by_role("tab", name="Response").click()
    page.get_by_label("Start from an initial rotation").check()
    page.reload()
    page.get_by_label("Start from an initial rotation").uncheck()
    expect(page.get_by_test_id("verdict")).to_be_visible()
    assert "period=0.55" in inputs(page)["motion"]["pulse"]


def test_an_unreadable_file_takes_the_question_of_the_last_one_along(view: Any) -> None:
    """While a file waits the old motion is named as such; after a file that is none nothing is asked any more."""
    rows = "\n".join(f"{STEP * k:.3f},{math.sin(0.7 * k):.6f}" for k in range(201))
    way(view, "Record file")
    pending = view.get_by_test_id("motion-pending")
    expect(pending).to_contain_text("still")
    view.evaluate(DROP, ["site.csv", rows + "\n"])
    expect(view.get_by_test_id("record-needs").get_by_role("button", name="Apply")).to_be_visible()
    expect(pending).to_contain_text("not read yet")
    view.evaluate(DROP, ["README.md", "# Notes\nnothing here\n"])
    expect(view.locator("[data-testid=record-answer] .note.error")).to_contain_text("README.md")
    expect(view.get_by_test_id("record-needs")).to_be_empty()
    way(view, "Pulse")
    expect(pending).to_be_empty()


def test_a_refused_file_leaves_what_was_answered(view: Any) -> None:
    """Of a file that cannot be read as it was told the reason is shown; the answers stay, and can be changed."""
    words = {"error": {"kind": "record", "message": "site.csv: the file is damaged"}}
    view.route(re.compile(r"/api/records\?.*units=gal"), lambda route: route.fulfill(status=422, json=words))
    way(view, "Record file")
    view.evaluate(DROP, ["site.csv", "\n".join(f"{STEP * k:.3f},{math.sin(0.7 * k):.6f}" for k in range(201))])
    unit = view.get_by_test_id("record-needs").get_by_label("Unit of the accelerations")
    unit.select_option("gal")
    view.get_by_role("button", name="Apply").click()
    expect(view.locator("[data-testid=record-answer] .note.error")).to_contain_text("damaged")
    expect(unit).to_have_value("gal")
    unit.select_option("g")
    view.get_by_role("button", name="Apply").click()
    expect(view.get_by_test_id("record-held")).to_contain_text("site.csv")


def inputs_or_first(page: Any) -> Any:
    """Return what the page keeps; nothing before the first change."""
    return page.evaluate("sessionStorage.getItem('rocking.inputs')")


def test_a_pulse_follows_its_slider_and_its_number(view: Any, shot: Callable[..., Path]) -> None:
    """A pulse chosen by keyboard and typed to 4 m/s2 and 0.5 s has a_p T / pi as the peak of its velocity."""
    view.locator(".pulse-card input[value=sine]").focus()
    view.keyboard.press("ArrowRight")
    assert inputs(view)["motion"]["pulse"].startswith("cosine:")
    view.keyboard.press("ArrowLeft")
    fields = view.get_by_test_id("pulse-parameters")
    fields.get_by_label("Peak acceleration, exactly").fill("4")
    fields.get_by_label("Period, exactly").fill("0.5")
    assert inputs(view)["motion"]["pulse"] == "sine:amplitude=4,period=0.5"
    wanted = f"{4.0 * 0.5 / math.pi:.4g}"
    view.locator("[data-testid=measures-table] tr", has_text="peak ground velocity").get_by_text(wanted).wait_for()
    slider = fields.locator("input[type=range]").first
    slider.focus()
    slider.press("ArrowRight")
    assert inputs(view)["motion"]["pulse"] != "sine:amplitude=4,period=0.5"
    shot(view, "motion-pulse")


def test_scaling_scales(view: Any) -> None:
    """Typed as one half, the factor halves the peak of 3 m/s2; nought is refused beside the field."""
    factor = view.get_by_label("Factor", exact=False)
    factor.fill("0.5")
    view.get_by_test_id("motion-facts").filter(has_text="1.5").wait_for()
    assert fact(view, "Peak acceleration").startswith("1.5")
    factor.fill("0")
    view.get_by_text("Enter a value other than 0.", exact=True).wait_for()
    assert inputs(view)["motion"]["scale"] == 0.5


def test_another_synthetic_motion_and_its_level(view: Any, shot: Callable[..., Path]) -> None:
    """Another member is another motion, and scaled to a PGA of 2 m/s2 it has that peak."""
    way(view, "Synthetic")
    view.get_by_test_id("motion-name").filter(has_text="pulse-like").wait_for()
    first = fact(view, "Peak acceleration")
    view.get_by_role("button", name="Next realization").click()
    view.get_by_test_id("motion-facts").filter(has_not_text=first).wait_for()
    assert inputs(view)["motion"]["member"] == 1
    way(view, "Scaled to PGA")
    view.get_by_label("Peak ground acceleration").fill("2")
    view.get_by_test_id("motion-facts").filter(has_text=re.compile(r"acceleration2\s*m")).wait_for()
    assert inputs(view)["motion"]["pga"] == 2
    shot(view, "motion-synthetic")


def test_measures_are_copied_with_every_digit(view: Any) -> None:
    """The table goes to the clipboard with tabs and more digits than are shown, and to a CSV file."""
    block = view.get_by_test_id("motion-measures")
    block.get_by_role("button", name="Copy table").click()
    text = pasted(view)
    row = next(line for line in text.splitlines() if line.startswith("peak ground velocity"))
    assert math.isclose(float(row.split("\t")[1]), 3.0 * 0.8 / math.pi, rel_tol=1e-9)
    with view.expect_download() as waiting:
        block.get_by_role("button", name="CSV").click()
    assert "peak ground velocity" in Path(waiting.value.path()).read_text(encoding="utf-8-sig").lower()


SKETCH = """async ([name, places]) => {
  const { SHAPES } = await import("/views/motion-sketch.js");
  return places.map((place) => SHAPES[name](place));
}"""
WINDOWS = {
    "ricker": (10.0 / (math.sqrt(2.0) * math.pi), 4.0),
    "antisymmetric-ricker": (5.0 * math.sqrt(3.0) / math.pi, 5.0),
}
ARGUMENTS = {
    "rectangular": "amplitude=1,duration=1",
    "mavroeidis-papageorgiou": "velocity=1,period=1",
    "harmonic": "amplitude=1,period=1,cycles=4",
}


def test_sketches_show_the_pulses(page: Any) -> None:
    """The small drawing of every pulse has the shape of its acceleration; turned round it would not."""
    places = np.linspace(0.02, 0.98, 97)
    for name in pulses.catalogue():
        drawn = np.array(page.evaluate(SKETCH, [name, places.tolist()]))
        real = pulses.pulse(f"{name}:{ARGUMENTS.get(name, 'amplitude=1,period=1')}")
        # wavelets are drawn without their flat ends
        width, whole = WINDOWS.get(name, (real.duration, real.duration))
        truth = real.acceleration(0.5 * whole + width * (places - 0.5))
        truth = truth / np.abs(truth).max()
        assert np.abs(drawn - truth).max() < 0.05, name
        assert np.abs(drawn + truth).max() > 0.5, name


@pytest.mark.parametrize(("label", "given"), [("Peak acceleration", ["0", "1e9"]), ("Period", ["0", "-2"])])
def test_a_wrong_number_is_marked_at_its_field(view: Any, label: str, given: list[str]) -> None:
    """What no pulse can have is refused beside its box, and the motion stays as it was; others are taken."""
    box = view.get_by_test_id("pulse-parameters").get_by_label(f"{label}, exactly")
    for text in given:
        box.fill(text)
        expect(box).to_have_attribute("aria-invalid", "true")
        about = view.locator(f"[id='{box.get_attribute('aria-describedby')}']")
        expect(about).to_have_text(re.compile("^(At least|At most|Enter a value)"))
    assert inputs(view)["motion"]["pulse"] == "sine:amplitude=3,period=0.8"
    box.fill("2")
    expect(box).not_to_have_attribute("aria-invalid", "true")


@pytest.mark.parametrize("pulse", ["sine:amplitude=0,period=1", "sine:amplitude=3,period=-2"])
def test_what_the_server_refuses_is_marked_at_its_field(open_page: Callable[..., Any], pulse: str) -> None:
    """A link with a wrong number shows it marked, and in German nothing is said in English; corrected, it is asked."""
    page = open_page(link(pulse) + "&view=motion", locale="de")
    box = page.locator("[data-testid=pulse-parameters] .exact input[aria-invalid=true]")
    expect(box).to_have_count(1)
    for said in (page.get_by_test_id("motion-refusal"), page.locator(".field-error")):
        assert not re.search(r"\b(must|got|nothing|throughout)\b", said.inner_text())
    expect(page.get_by_test_id("motion-pending")).to_be_empty()
    box.fill("2")
    page.get_by_test_id("measures-table").wait_for()
    expect(page.locator("[data-testid=pulse-parameters] [aria-invalid=true]")).to_have_count(0)


def counts(folder: Path) -> tuple[Path, Path]:
    """Write a miniSEED file of counts and the StationXML file that says what they are."""
    obspy = pytest.importorskip("obspy")
    inventory = pytest.importorskip("obspy.core.inventory")
    trace = obspy.Trace(np.rint(4000.0 * shaking().acceleration).astype(np.int32))
    trace.stats.update({"network": "XX", "station": "ABC", "channel": "HNE", "delta": STEP})
    trace.write(str(folder / "counts.mseed"), format="MSEED")
    place = {"latitude": 1.0, "longitude": 2.0, "elevation": 3.0}
    response = inventory.Response.from_paz([], [-300.0], 4000.0, input_units="M/S**2", output_units="COUNTS")
    channel = inventory.Channel("HNE", "", depth=0.0, sample_rate=1.0 / STEP, response=response, **place)
    station = inventory.Station("ABC", channels=[channel], **place)
    inventory.Inventory([inventory.Network("XX", [station])]).write(str(folder / "abc.xml"), format="STATIONXML")
    return folder / "counts.mseed", folder / "abc.xml"


def test_counts_and_their_stations_belong_together(view: Any, tmp_path: Path) -> None:
    """Dropped at once, both lie in Records with the step that needs both; what comes of it becomes the motion."""
    way(view, "Record file")
    view.get_by_test_id("record-file").set_input_files(counts(tmp_path))
    records = view.locator("#view-records")
    expect(records.get_by_role("list", name="Files")).to_contain_text("counts.mseed")
    expect(records.get_by_role("list", name="Files")).to_contain_text("abc.xml")
    step = records.get_by_role("listitem", name="Step 1, response")
    expect(step.get_by_label("stations")).to_have_value("abc.xml")
    step.get_by_label("high").fill("20")
    records.get_by_role("button", name="Compute", exact=True).click()
    use = records.get_by_role("button", name="Use as motion")
    use.click()
    expect(view.locator("#status")).to_contain_text("is the motion of this project")
    view.locator("#tab-motion").click()
    expect(view.get_by_test_id("record-held")).to_contain_text("counts-corrected.csv")


def test_several_records_are_no_motion(view: Any, tmp_path: Path) -> None:
    """Two files without a StationXML are refused together, and the motion stays."""
    before = inputs(view)["motion"]
    for name in ("a.txt", "b.txt"):
        (tmp_path / name).write_text("0 0.1\n0.01 0.2\n")
    way(view, "Record file")
    view.get_by_test_id("record-file").set_input_files([tmp_path / "a.txt", tmp_path / "b.txt"])
    expect(view.get_by_test_id("record-answer")).to_contain_text("Add several records in the step Records")
    assert inputs(view)["motion"] == before
