"""The door of records: corrected step by step, before and after; sets of them for a spectrum; all crossings."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser_pages import link

from rocking import plausibility
from rocking.motions import processed
from rocking.motions.formats import read_motion

expect = pytest.importorskip("playwright.sync_api").expect
DROP = "Drop records or a folder here, or"
STEP = re.compile("^time step")


def record(path: Path, frequency: float) -> Path:
    """Write a record with an offset, of a decaying wave [Hz]."""
    time = 0.01 * np.arange(1200)
    values = np.sin(2.0 * np.pi * frequency * time) * np.exp(-0.3 * time) + 0.05
    lines = "\n".join(f"{t:.2f} {a:.6f}" for t, a in zip(time, values, strict=True))
    path.write_text(f"# time [s], acceleration [m/s2]\n{lines}\n")
    return path


def asked(section: Any, state: str = "done") -> Any:
    """Press the button, and wait for the answer or the refusal."""
    section.get_by_role("button", name="Compute", exact=True).click()
    outcome = section.get_by_test_id("outcome")
    expect(outcome).to_have_attribute("data-state", state)
    return outcome


def saved(page: Any, button: Any, path: Path) -> Path:
    """Take a file away."""
    with page.expect_download() as told:
        button.click()
    told.value.save_as(path)
    return path


def test_a_spectrum_says_what_it_needs(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Without its acceleration no spectrum is asked for: the field says so, and has the keyboard."""
    page = open_page(view="records")
    section = page.locator("#view-records")
    section.get_by_label(DROP).set_input_files(record(tmp_path / "hall.txt", 1.0))
    section.get_by_label("Result").select_option("target")
    ground = section.get_by_role("textbox", name=re.compile("^ag "))
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(ground).to_be_focused()
    expect(ground).to_have_accessible_description("Enter a number.")
    expect(section.get_by_test_id("outcome")).to_have_count(0)


def test_before_and_after(open_page: Callable[..., Any], shot: Callable[..., Any], tmp_path: Path) -> None:
    """The chain gives what Python gives; an error stands at its step; a reload keeps file, steps and answer."""
    page = open_page(view="records")
    section = page.locator("#view-records")
    section.get_by_label(DROP).set_input_files(record(tmp_path / "hall.txt", 1.0))
    expect(section.get_by_role("list", name="Files")).to_contain_text("hall.txt")
    for name in ("mean", "taper", "bandpass"):
        section.get_by_label("Add a step").select_option(name)
    band = section.get_by_role("listitem", name="Step 3, bandpass")
    band.get_by_label("low").fill("0,2")
    band.get_by_label("high").fill("80")
    asked(section, "refused")
    expect(band.get_by_role("alert")).to_contain_text("High must be in (0.2, 50) Hz, got 80")
    expect(section.get_by_role("listitem", name="Step 1, mean").get_by_role("alert")).to_have_count(0)

    band.get_by_label("high").fill("20")
    section.get_by_role("button", name="Move bandpass earlier").click()
    section.get_by_label("Output format").select_option("smc-usgs")
    outcome = asked(section)
    with plausibility.before_processing():
        read = read_motion(tmp_path / "hall.txt")
    expected = processed(read, "mean; bandpass:low=0.2,high=20; taper")
    done = outcome.get_by_role("list", name="Processing")
    assert done.locator("li").all_inner_texts()[1:] == list(expected.provenance)[1:]
    first = outcome.locator("img.drawing").get_attribute("src")
    assert outcome.locator("img.drawing").evaluate("image => image.decode().then(() => image.naturalWidth)") > 100
    for ending, share in (("SMC", 1e-4), ("CSV", 1e-12)):
        button = outcome.get_by_role("button", name=f"Record ({ending})")
        written = read_motion(saved(page, button, tmp_path / f"new.{ending.lower()}"))
        assert written.acceleration == pytest.approx(expected.acceleration, abs=share * expected.peak)
    expect(outcome.locator("pre").last).to_contain_text("bandpass:low=0.2,high=20")
    shot(page, "records")

    rows = outcome.get_by_role("table", name="Before and after").locator("tbody tr")
    before, after = rows.all_inner_texts()
    section.get_by_role("listitem", name="Step 2, bandpass").get_by_label("low").fill("2")
    outcome = asked(section)
    expect(done).to_contain_text("band-pass 2 to 20 Hz")
    assert outcome.locator("img.drawing").get_attribute("src") != first
    assert (rows.nth(0).inner_text() == before, rows.nth(1).inner_text() == after) == (True, False)

    page.reload()
    stays_and_is_used(page, section)


def stays_and_is_used(page: Any, section: Any) -> None:
    """After a reload file, steps and answer are there, and the record becomes the motion."""
    done = section.get_by_role("list", name="Processing")
    expect(section.get_by_test_id("outcome")).to_have_attribute("data-state", "done")
    expect(done).to_contain_text("band-pass 2 to 20 Hz")
    expect(section.get_by_role("listitem", name="Step 2, bandpass").get_by_label("low")).to_have_value("2")
    expect(section.get_by_role("list", name="Files")).to_contain_text("hall.txt")
    section.get_by_role("button", name="Use as motion").click()
    expect(page.locator("#status")).to_contain_text("hall-corrected.csv is the motion")
    page.locator("#tab-motion").click()
    expect(page.get_by_test_id("record-held")).to_contain_text("hall-corrected.csv")
    expect(page.get_by_test_id("motion-name")).to_contain_text("hall-corrected")


def test_what_is_no_record(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Nothing, and a text that is no record, are refused in words; the page goes on."""
    page = open_page(view="records")
    section = page.locator("#view-records")
    section.get_by_role("button", name="Compute", exact=True).click()
    expect(section.get_by_role("alert")).to_contain_text("Add a record")
    letter = {"name": "letter.txt", "mimeType": "text/plain", "buffer": b"Dear all, no record is in here.\n"}
    section.get_by_label(DROP).set_input_files(letter)
    expect(section.get_by_role("list", name="Files")).to_contain_text("letter.txt")
    asked(section, "refused")
    expect(section.get_by_role("alert")).to_contain_text("etter.txt: unknown format, allowed are")
    section.get_by_role("button", name="Remove letter.txt").click()
    section.get_by_label(DROP).set_input_files(record(tmp_path / "hall.txt", 1.0))
    expect(section.get_by_role("list", name="Files")).to_contain_text("hall.txt")
    outcome = asked(section)
    expect(outcome.get_by_test_id("verdict")).to_contain_text("g before")


def test_a_folder_for_a_spectrum(open_page: Callable[..., Any], shot: Callable[..., Any], tmp_path: Path) -> None:
    """A folder becomes a table; for a target the closest are chosen and scaled, by a code and by a file."""
    folder = tmp_path / "set"
    folder.mkdir()
    for k, frequency in enumerate((0.8, 1.3, 2.1)):
        record(folder / f"site-{k}.txt", frequency)
    (folder / "notes.txt").write_text("no record\n")
    page = open_page(view="records")
    section = page.locator("#view-records")
    section.get_by_label("A folder", exact=True).set_input_files(folder)
    expect(section.get_by_role("list", name="Files").get_by_role("listitem")).to_have_count(4)
    outcome = asked(section)
    table = outcome.get_by_role("table", name="Records").locator("tbody tr")
    expect(table).to_have_count(3)
    expect(outcome.get_by_role("table", name="Ignored files")).to_contain_text("notes.txt")

    section.get_by_label("Result").select_option("target")
    section.get_by_label("ag").fill("0.2g")
    section.get_by_label("ground").fill("C")
    section.get_by_label("count").fill("2")
    section.get_by_label("periods").fill("0.3, 2")
    outcome = asked(section)
    verdict = outcome.get_by_test_id("verdict")
    expect(verdict).to_contain_text("2 records scaled by")
    expect(verdict).to_contain_text("ground C, ag 1.96133 m/s2, 0.3 to 2 s")
    expect(table).to_have_count(2)
    expect(outcome.get_by_role("columnheader", name="misfit")).to_be_visible()
    text = saved(page, outcome.get_by_role("button", name="CSV"), tmp_path / "table.csv").read_text()
    assert text.startswith("record,")
    assert len(text.splitlines()) == 3
    shot(page, "records-set")
    section.get_by_label("Target spectrum").select_option("file")
    (tmp_path / "target.csv").write_text("T [s],Sa [g]\n0.1,0.5\n1,0.3\n3,0.1\n")
    section.get_by_label("Drop the spectrum here, or").set_input_files(tmp_path / "target.csv")
    expect(section).to_contain_text("target.csv")
    outcome = asked(section)
    expect(outcome.get_by_test_id("verdict")).to_contain_text("target.csv")


def plain(path: Path, factor: float, heading: str = "") -> Path:
    """Write accelerations alone: 0.3 g at most, over the factor [m/s2], below a heading."""
    values = 0.3 * 9.80665 * np.cos(0.2 * np.arange(200)) * np.exp(-0.02 * np.arange(200)) / factor
    path.write_text(heading + "\n".join(f"{value:.8f}" for value in values) + "\n")
    return path


def mixed_set(open_page: Callable[..., Any], folder: Path) -> tuple[Any, Any, Any]:
    """Send three records of mixed units, of which one has a heading; return the page, the view and its options."""
    folder.mkdir()
    plain(folder / "a.txt", 9.80665)
    plain(folder / "b.txt", 0.01)
    plain(folder / "c.txt", 1.0, "17 rows\n18 rows\n")
    page = open_page(view="records")
    section = page.locator("#view-records")
    section.get_by_label("A folder", exact=True).set_input_files(folder)
    expect(section.get_by_role("list", name="Files").get_by_role("listitem")).to_have_count(3)
    section.get_by_text("Missing in the file").click()
    section.get_by_label(STEP).fill("0,01")
    return page, section, section.get_by_role("group", name="Options per file")


def peaks(rows: Any) -> list[list[str]]:
    """Return names and PGA [g] of the table of records."""
    return [row.split("\t")[:2] for row in rows.all_inner_texts()]


def test_a_unit_for_each_file(open_page: Callable[..., Any], shot: Callable[..., Any], tmp_path: Path) -> None:
    """Files of mixed units are one set: the page offers unit, step, format and skip at each file that was not read."""
    page, section, options = mixed_set(open_page, tmp_path / "mixed")
    asked(section, "refused")
    expect(section.get_by_role("alert")).to_contain_text("a.txt: the file does not state its unit: enter it in")
    first, second, third = (options.get_by_role("listitem", name=f"{name}.txt") for name in "abc")
    expect(first).to_contain_text("The file does not state its unit.")
    expect(options.get_by_role("listitem")).to_have_count(1)
    first.get_by_label("units").select_option("g")
    outcome = asked(section)
    rows = outcome.get_by_role("table", name="Records").locator("tbody tr")
    assert peaks(rows) == [["a", "0.3"]]
    left_out = outcome.get_by_role("table", name="Ignored files")
    expect(left_out.locator("tbody tr")).to_have_count(2)
    expect(left_out).to_contain_text("unit: enter it in the form")
    expect(options.get_by_role("listitem")).to_have_count(3)

    second.get_by_label("units").select_option("cm/s2")
    third.get_by_label("units").select_option("m/s2")
    third.get_by_label(STEP).fill("0,02")
    third.get_by_label("skip").fill("2")
    shot(page, "records-units")
    outcome = asked(section)
    expect(rows).to_have_count(3)
    assert peaks(rows) == [["a", "0.3"], ["b", "0.3"], ["c", "0.3"]]
    expect(left_out).to_have_count(0)
    outcome.get_by_text("Command line").click()
    table = '[motions.files."c.txt"]\nunits = "m/s2"\ntime_step = 0.02\nskip = 2'
    expect(outcome.locator("pre").last).to_contain_text(table)


def test_a_wrong_unit_of_one_file(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """A wrong unit gives another peak, a wrong step is marked at its file; a reload keeps what was typed."""
    page, section, options = mixed_set(open_page, tmp_path / "mixed")
    section.get_by_role("button", name="Remove c.txt").click()
    section.get_by_label("units").select_option("g")
    section.get_by_label("Add a file with other options").select_option("b.txt")
    second = options.get_by_role("listitem", name="b.txt")
    second.get_by_label("units").select_option("mm/s2")
    second.get_by_label(STEP).fill("-1")
    asked(section, "refused")
    expect(second.get_by_label(STEP)).to_have_attribute("aria-invalid", "true")
    expect(section.locator("form [aria-invalid=true]")).to_have_count(1)
    second.get_by_label(STEP).fill("0,02")
    outcome = asked(section)
    rows = outcome.get_by_role("table", name="Records").locator("tbody tr")
    assert peaks(rows) == [["a", "0.3"], ["b", "0.03"]]

    section.get_by_label("Result").select_option("b.txt")
    outcome = asked(section)
    expect(outcome.get_by_test_id("verdict")).to_contain_text("PGA 0.03 g before")
    done = outcome.get_by_role("list", name="Processing")
    expect(done).to_contain_text("stated by the user: unit mm/s2, time step 0.02 s")
    page.reload()
    expect(second.get_by_label("units")).to_have_value("mm/s2")
    second.get_by_role("button", name="Remove the options of b.txt").click()
    expect(options.get_by_role("listitem")).to_have_count(0)


def test_a_unit_for_each_file_that_shakes_the_body(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Decide offers the same at the file that it refuses; what is stated there is in the question."""
    for name, unit in (("a.txt", 9.80665), ("b.txt", 0.01)):
        lines = [f"{0.01 * k:.2f} {value}" for k, value in enumerate(plain(tmp_path / name, unit).read_text().split())]
        (tmp_path / name).write_text("\n".join(lines))
    page = open_page(link("sine:amplitude=3.2,period=0.8"))
    page.locator("#tab-decide").click()
    section = page.locator("#view-decide")
    section.get_by_label("Analysis").select_option("predict")
    section.get_by_label("count").fill("4")
    section.get_by_label("Ground motions").select_option("records")
    section.get_by_label("Drop records here, or").set_input_files([tmp_path / "a.txt", tmp_path / "b.txt"])
    expect(section.get_by_role("list", name="Files").get_by_role("listitem")).to_have_count(2)
    section.get_by_label("Unit of the accelerations").fill("cm/s2")
    options = section.get_by_role("group", name="Options per file")
    section.get_by_label("Add a file with other options").select_option("a.txt")
    options.get_by_label("units").select_option("g")
    outcome = asked(section)
    outcome.get_by_text("Command line").click()
    told = outcome.locator("pre").last
    expect(told).to_contain_text('units = "cm/s2"')
    expect(told).to_contain_text('[motions.files."a.txt"]\nunits = "g"')
    section.get_by_label("Unit of the accelerations").fill("")
    asked(section, "refused")
    expect(options.get_by_role("listitem", name="b.txt")).to_contain_text("The file does not state its unit.")


def test_crossings(open_page: Callable[..., Any], shot: Callable[..., Any], served: Any) -> None:
    """The lowest factor is said first and is that of the command line; a range that is none is refused."""
    page = open_page(link("sine:amplitude=3.2,period=0.8"))
    page.locator("#tab-decide").click()
    section = page.locator("#view-decide")
    section.get_by_label("Analysis").select_option("overturning-pga")
    section.get_by_label("samples").fill("60")
    section.get_by_label("bisections").fill("1")
    section.get_by_label("max pga").fill("20")
    outcome = asked(section)
    question = served.api("questions", method="GET")["questions"][0]
    answer = served.api(f"questions/{question['id']}", method="GET")["answer"]
    first = answer["minimum_acceleration"]
    expect(outcome.get_by_test_id("verdict")).to_contain_text(f"{first / 9.80665:.4g} g, {first / 3.2:.4g} times")
    rows = outcome.get_by_role("table", name="Crossings").locator("tbody tr")
    assert rows.count() == min(len(answer["crossings"]), 20)
    expect(outcome.locator("img.drawing")).to_be_visible()
    shot(page, "crossings")
    section.get_by_label("min pga").fill("30")
    asked(section, "refused")
    expect(section.get_by_role("alert")).to_contain_text("below max pga, got 30 and 20 m/s2")
