"""The view of the response, used as a person uses it: models ticked, sliders moved, the animation played."""

import base64
import json
import math
import re
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import expect

from rocking.bodies import Block, Region, Section
from rocking.bodies.shapes import trapezoid
from rocking.dynamics import free_rocking, simulate
from rocking.dynamics.response import Response
from rocking.motions import GroundMotion
from rocking.motions.pulses import pulse
from rocking.outcome import Outcome

PHONE = {"width": 360, "height": 740}
BODY = {"units": "m", "width": 0.5, "height": 2.0}
GENTLE, DECISIVE = "sine:amplitude=3,period=0.8", "cosine:amplitude=7.25,period=0.6"
MODELS = ["ked", "housner"]

SLIDE = """async ([words, count]) => {
  const labels = [...document.querySelectorAll("#view-response label")];
  const label = labels.find((one) => one.textContent === words);
  const slider = document.getElementById(label.htmlFor);
  const results = document.querySelector(".response-results");
  const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
  const times = [];
  for (let k = 0; k < count; k += 1) {
    const before = results.dataset.drawn;
    const started = performance.now();
    slider.value = String(Number(slider.min) + (slider.max - slider.min) * (0.5 + 0.01 * (k + 1)));
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    while (results.dataset.drawn === before) await frame();
    times.push(performance.now() - started);
  }
  return times;
}"""
COLOURED = """(canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  const [r, g, b] = getComputedStyle(canvas).getPropertyValue("--scene-impact").match(/[0-9a-f]{2}/gi)
    .map((two) => parseInt(two, 16));
  let found = 0;
  for (let k = 0; k < data.length; k += 4) {
    if (Math.abs(data[k] - r) + Math.abs(data[k + 1] - g) + Math.abs(data[k + 2] - b) < 12) found += 1;
  }
  return found;
}"""


def link(motion: str | None = GENTLE, **more: Any) -> str:
    """Return the fragment of a permanent link."""
    inputs = {"body": BODY, "restitution": {"models": MODELS}, **more}
    if motion is not None:
        inputs["motion"] = {"pulse": motion}
    text = base64.urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    return f"in={text}&view=response"


def response(motion: str, restitution: Any) -> Response:
    """Return the response of the same body in Python."""
    return simulate(Block(width=0.5, height=2.0), pulse(motion), restitution)


def card(page: Any, label: str) -> Any:
    """Return the card of a model's outcome."""
    return page.get_by_test_id(f"outcome-{label}")


def pasted(page: Any) -> str:
    """Return what a user pastes after copying, once the page says that it has copied."""
    page.get_by_text("paste them into Excel").wait_for()
    page.evaluate("document.body.append(Object.assign(document.createElement('textarea'), { id: 'paste' }))")
    page.locator("#paste").focus()
    page.keyboard.press("Control+V")
    text: str = page.locator("#paste").input_value()
    return text


@pytest.fixture
def answered(open_page: Callable[..., Any]) -> Callable[..., Any]:
    """Open the view by a link and wait for its answer."""

    def opened(fragment: str | None = None, **more: Any) -> Any:
        page = open_page(fragment or link(), **more)
        page.locator(".response-results[data-drawn]").wait_for()
        return page

    return opened


def test_the_verdict_is_that_of_python(answered: Callable[..., Any], shot: Callable[..., Path]) -> None:
    """Outcome, coefficient, peak and number of impacts of every model are what `simulate` finds."""
    page = answered()
    assert page.get_by_test_id("verdict").get_attribute("data-kind") == "rocks"
    for label in MODELS:
        found = response(GENTLE, label)
        text = card(page, label).inner_text()
        ratio = found.peak_rotation / found.parameters.right.slenderness_angle
        assert f"r = {found.parameters.right.coefficient:.4g}" in text
        assert f"peak {ratio:.3g}" in text
        assert f"{found.impacts.size} impacts" in text
    shot(page, "response-light")


def test_one_sees_that_the_model_decides(answered: Callable[..., Any], shot: Callable[..., Path]) -> None:
    """Where one model overturns the body and the other does not, the banner says so in words."""
    assert response(DECISIVE, "ked").outcome != response(DECISIVE, "housner").outcome
    page = answered(link(DECISIVE))
    verdict = page.get_by_test_id("verdict")
    assert verdict.get_attribute("data-kind") == "differs"
    assert "KED" in verdict.inner_text()
    assert "housner" not in verdict.inner_text()
    assert card(page, "ked").get_attribute("data-outcome") == "overturned"
    assert card(page, "housner").get_attribute("data-outcome") == "rocked"
    shot(page, "response-decides")
    page.get_by_role("checkbox", name="Housner").uncheck()
    page.locator("[data-testid=verdict][data-kind=falls]").wait_for()


def test_a_body_that_overturns_comes_to_lie_and_stays(answered: Callable[..., Any], shot: Callable[..., Path]) -> None:
    """At the end of the animation the block that overturned has turned by a quarter and lies on its side."""
    page = answered(link(DECISIVE))
    page.get_by_test_id("scene-time").focus()
    page.keyboard.press("End")
    assert "90.00\u00b0" in page.get_by_test_id("scene-rotation").inner_text()
    shot(page, "response-overturned")


def models_of(page: Any) -> list[str]:
    """Return the models in the order in which the inputs have them."""
    found: list[str] = page.evaluate("JSON.parse(sessionStorage.getItem('rocking.inputs')).restitution.models")
    return found


def test_a_ticked_model_comes_last_and_the_main_one_is_chosen_by_name(answered: Callable[..., Any]) -> None:
    """A third model leaves the first one first; another becomes the main model only where one says so."""
    page = answered(link(GENTLE, restitution={"models": ["ked"]}))
    page.get_by_role("checkbox", name="Housner").check()
    page.get_by_role("checkbox", name="shifted impulse").check()
    assert models_of(page) == ["ked", "housner", "shifted-impulse"]
    expect(page.get_by_test_id("outcomes").locator(".outcome").first).to_contain_text("KED")
    page.get_by_label("Main model").select_option("housner")
    assert models_of(page) == ["housner", "ked", "shifted-impulse"]
    expect(page.get_by_test_id("outcomes").locator(".outcome").first).to_contain_text("Housner")


def test_the_chosen_model_is_shown_in_every_part_and_file(answered: Callable[..., Any]) -> None:
    """With Housner's card chosen, energy, impacts and the saved curves are Housner's, after another tick too."""
    page = answered()
    card(page, "housner").click()
    page.get_by_role("checkbox", name="shifted impulse").check()
    expect(page.get_by_test_id("outcomes").locator(".outcome")).to_have_count(3)
    expect(card(page, "housner").locator("input")).to_be_checked()
    expect(page.get_by_test_id("chart-energy").locator("figcaption")).to_have_text("Energy (Housner)")
    expect(page.locator(".impacts").get_by_label("Model", exact=True)).to_have_value("housner")
    expect(page.get_by_test_id("files-model")).to_contain_text("Housner")
    with page.expect_download() as waiting:
        page.get_by_role("button", name="Curves, CSV").click()
    assert "housner" in waiting.value.suggested_filename
    wanted = response(GENTLE, "housner")
    last = Path(waiting.value.path()).read_text(encoding="utf-8-sig").splitlines()
    head = next(k for k, line in enumerate(last) if "rotation" in line and not line.startswith("#"))
    place = next(k for k, name in enumerate(last[head].split(",")) if name.strip('"').startswith("rotation"))
    rotations = [float(line.split(",")[place]) for line in last[head + 1 :]]
    assert rotations == wanted.rotation.tolist()
    assert rotations != response(GENTLE, "ked").rotation.tolist()


def test_the_fall_does_not_hide_the_rocking(answered: Callable[..., Any]) -> None:
    """Velocity is drawn until 1.5 times the slenderness angle; with the whole fall its extreme would be larger."""
    page = answered(link(DECISIVE, restitution={"models": ["ked"]}))
    found = response(DECISIVE, "ked")
    alpha = found.parameters.right.slenderness_angle
    fallen = int(np.argmax(np.abs(found.rotation) > 1.5 * alpha))
    shown, whole = np.abs(found.angular_velocity[:fallen]).max(), np.abs(found.angular_velocity).max()
    assert whole > 1.3 * shown
    label = page.get_by_test_id("chart-velocity").locator("[role=img]").get_attribute("aria-label")
    drawn = [abs(float(word.replace("\u2212", "-"))) for word in re.findall(r"[-\u2212]?[0-9.]+(?= (?:to|rad))", label)]
    assert max(drawn[1:]) < 1.1 * shown


def test_models_have_dashes_of_their_own(answered: Callable[..., Any]) -> None:
    """In the list of models no two lines without regard to colour are alike but that of KED, which is whole."""
    page = answered()
    keys = page.locator(".model-row .dash-key path")
    dashes = [key.get_attribute("stroke-dasharray") for key in keys.all()]
    assert len(dashes) == len(set(dashes)) >= 6


def test_a_coefficient_of_ones_own(answered: Callable[..., Any]) -> None:
    """A typed coefficient joins the models under its own card and curve."""
    page = answered()
    page.get_by_label("A coefficient of my own").check()
    slider = page.get_by_label("Coefficient of restitution r")
    slider.focus()
    slider.press("Home")
    page.locator("[data-testid=outcomes] .outcome", has_text=re.compile(r"given value.*r = 0 \u00b7")).wait_for()
    assert page.get_by_test_id("outcomes").locator(".outcome").count() == 3
    page.get_by_test_id("chart-rotation").locator(".legend li").nth(2).wait_for()


def test_free_rocking_and_back(answered: Callable[..., Any]) -> None:
    """Let go from half its angle the block rocks as `free_rocking` says; switched back it is shaken again."""
    page = answered()
    page.get_by_label("Let it go from a lean instead").check()
    found = free_rocking(Block(width=0.5, height=2.0), 0.5 * math.atan(0.25), "ked")
    card(page, "ked").filter(has_text=f"{found.impacts.size} impacts").wait_for()
    assert "peak 0.5" in card(page, "ked").inner_text()
    page.get_by_label("Let it go from a lean instead").uncheck()
    card(page, "ked").filter(has_text=f"{response(GENTLE, 'ked').impacts.size} impacts").wait_for()


def test_without_a_motion_it_says_what_to_do(open_page: Callable[..., Any]) -> None:
    """A link without a motion leads to two buttons, of which one lets the body go."""
    page = open_page(link(None))
    page.get_by_role("button", name="Let it go from a lean").click()
    page.locator(".response-results[data-drawn]").wait_for()


def test_size_is_turned(answered: Callable[..., Any], until: Callable[..., None]) -> None:
    """The slider of the size makes every length larger and keeps the shape: p falls with the root of the size."""
    page = answered()
    page.get_by_label("Size of the body, all lengths").focus()
    page.keyboard.press("End")
    kept = "(({ width, height }) => [width, height])(JSON.parse(sessionStorage.getItem('rocking.inputs')).body)"
    until(page, lambda: page.evaluate(kept) != [0.5, 2.0])
    assert page.evaluate(kept) == [2.5, 10.0]


@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        (
            {"units": "cm", "trapezoid": {"base": 50.0, "top": 30.0, "height": 90.0, "lean": 4.0, "density": 2600.0}},
            {"units": "cm", "trapezoid": {"base": 100.0, "top": 60.0, "height": 180.0, "lean": 8.0, "density": 2600.0}},
        ),
        (
            {
                "units": "m",
                "section": {"region": [{"outline": [[0, 0], [1, 0], [0, 2]], "density": 2.0}], "feet": [0, 1]},
            },
            {
                "units": "m",
                "section": {"region": [{"outline": [[0, 0], [2, 0], [0, 4]], "density": 2.0}], "feet": [0, 2]},
            },
        ),
        (
            {"units": "m", "mass_points": {"points": [[0, 1]], "masses": [3.0], "feet": [-1, 1]}},
            {"units": "m", "mass_points": {"points": [[0, 2]], "masses": [24.0], "feet": [-2, 2]}},
        ),
        (
            {"units": "m", "regular_polygon": {"sides": 6, "radius": 0.5}},
            {"units": "m", "regular_polygon": {"sides": 6, "radius": 1.0}},
        ),
    ],
)
def test_every_kind_of_body_is_scaled(page: Any, body: dict[str, Any], wanted: dict[str, Any]) -> None:
    """Twice as large means every length times two, masses times eight, densities, units and counts as they were."""
    script = "async (body) => (await import('/views/response-size.js')).scaledBody(body, 2)"
    assert page.evaluate(script, body) == wanted


def test_impacts_are_those_of_python(answered: Callable[..., Any]) -> None:
    """The table copies every impact with every digit."""
    page = answered()
    page.get_by_test_id("impacts").get_by_role("button", name="Copy table").click()
    rows = [line.split("\t") for line in pasted(page).splitlines()]
    found = response(GENTLE, "ked").impacts
    assert len(rows) == found.size + 1
    assert [float(row[1]) for row in rows[1:]] == found["time"].tolist()
    assert [row[5] for row in rows[1:]] == found["onto"].tolist()


@pytest.mark.timed
@pytest.mark.parametrize(
    "words", ["Scale of the motion", "Size of the body, all lengths", "Coefficient of restitution r"]
)
def test_a_slider_redraws_within_150_ms(answered: Callable[..., Any], words: str) -> None:
    """From the move of a slider to redrawn curves and scene of five restitutions: below 150 ms at the median of 30."""
    models = ["ked", "housner", "horizontal-momentum", "shifted-impulse"]
    page = answered(link(GENTLE, restitution={"models": models, "values": [0.9]}))
    page.evaluate(SLIDE, [words, 3])
    times = page.evaluate(SLIDE, [words, 30])
    print(f"{words}: median {statistics.median(times):.1f} ms, largest {max(times):.1f} ms")
    assert len(times) == 30
    assert statistics.median(times) < 150.0, times


@pytest.mark.timed
def test_sixty_frames_a_second(answered: Callable[..., Any], until: Callable[..., None]) -> None:
    """Played in slow motion, at least 55 frames a second are drawn, and the script of one takes below 4 ms."""
    page = answered()
    page.get_by_test_id("scene-speed").select_option("0.1")
    page.get_by_test_id("scene-play").click()
    until(page, lambda: page.evaluate("rockingFrames.count") > 10)
    script = """async () => {
      const first = rockingFrames.count, started = performance.now();
      while (rockingFrames.count < first + 120) await new Promise(requestAnimationFrame);
      return [(rockingFrames.count - first) / (performance.now() - started) * 1000, rockingFrames.meanMs];
    }"""
    rate, script_ms = page.evaluate(script)
    print(f"{rate:.1f} frames a second, {script_ms:.2f} ms of script each")
    assert rate >= 55.0
    assert script_ms < 4.0


@pytest.mark.timed
def test_space_plays_and_the_speed_is_true(answered: Callable[..., Any], calm: Callable[[Any], None]) -> None:
    """Space starts and stops; at real speed the animation keeps time with the page's clock, else a tenth of it."""
    page = answered()
    now = page.get_by_test_id("scene-now")
    script = """async (seconds) => {
      const space = () => document.activeElement.dispatchEvent(
        new KeyboardEvent("keydown", { key: " ", bubbles: true, cancelable: true }));
      const shown = () => parseFloat(document.querySelector("[data-testid=scene-now]").textContent);
      const started = performance.now();
      space();
      while (shown() < seconds) await new Promise(requestAnimationFrame);
      space();
      return (performance.now() - started) / 1000;
    }"""
    page.get_by_test_id("scene-stage").focus()
    for speed in (1.0, 0.1):
        page.get_by_test_id("scene-speed").select_option(f"{speed:g}")
        page.get_by_test_id("scene-stage").focus()
        page.keyboard.press("Home")
        taken = page.evaluate(script, 0.8 * speed)
        seconds = float(now.inner_text().split()[0])
        assert 0.75 * speed < seconds / taken < 1.5 * speed
        calm(page)
        assert float(now.inner_text().split()[0]) == seconds


def test_scrubbing_shows_the_rotation_of_that_instant(answered: Callable[..., Any]) -> None:
    """Moved by keys to an instant, the picture names the rotation that `Response.at` has there."""
    page = answered()
    page.get_by_test_id("scene-time").focus()
    found = response(GENTLE, "ked")
    for key in ("Home", *("PageUp",) * 3):
        page.keyboard.press(key)
    instant = float(page.get_by_test_id("scene-now").inner_text().split()[0])
    shown = page.get_by_test_id("scene-rotation").inner_text().split()[2].rstrip("\u00b0,").replace("\u2212", "-")
    assert instant > 1.0
    assert abs(float(shown) - math.degrees(found.at(instant).item())) < 0.02


@pytest.mark.parametrize("motion", ["no-preference", "reduce"])
def test_impacts_flash_unless_less_motion_is_wanted(answered: Callable[..., Any], motion: str) -> None:
    """Just after an impact its ring is on the canvas, and is not where the system asks for reduced motion."""
    page = answered(reduced_motion=motion)
    time = float(response(GENTLE, "ked").impacts["time"][1])
    script = """async (time) => {
      const stage = document.querySelector("[data-testid=scene-stage]");
      stage.focus();
      const key = (name, shiftKey = false) =>
        stage.dispatchEvent(new KeyboardEvent("keydown", { key: name, shiftKey, bubbles: true }));
      key("Home");
      const now = () => parseFloat(document.querySelector("[data-testid=scene-now]").textContent);
      while (now() < time) key("ArrowRight");
    }"""
    page.evaluate(script, time)
    painted = page.get_by_test_id("scene-stage").evaluate(COLOURED)
    assert painted > 30 if motion == "no-preference" else painted == 0


def test_bodies_turn_as_in_python(page: Any) -> None:
    """The points of a turned body are those of the package itself, for both feet; with the other sign they are not."""
    from rocking.plots.animation_scene import DrawnShape

    shape = DrawnShape.of(Block(width=0.5, height=2.0))
    corners = shape.corners
    script = """async ([corners, rotation, feet]) => {
      const { turned } = await import("/scene/geometry.js");
      return corners.map(([x, y]) => turned(x, y, rotation, feet));
    }"""
    for rotation in (0.2, -0.3):
        drawn = page.evaluate(script, [corners.tolist(), rotation, list(shape.feet)])
        assert drawn == pytest.approx(shape.turned(corners, rotation), abs=1e-12)
        assert drawn != pytest.approx(shape.turned(corners, -rotation), abs=1e-3)


def test_a_fall_is_shown_as_it_is_computed(open_page: Callable[..., Any], served: Any, shot: Any) -> None:
    """At the end of the animation the leaning body lies on its side, and the page says how it got there."""
    inputs = {"body": {**LEANING, "name": "leaning"}, "motion": {"pulse": "sine:amplitude=6,period=0.8"}}
    answer = served.api("response", json={**inputs, "restitution": {"models": ["ked"]}})["answers"][0]
    body = Section([Region(trapezoid(0.5, 0.3, 1.8, lean=0.1))])
    found = simulate(body, pulse("sine:amplitude=6,period=0.8"), "ked")
    assert answer["outcome"] == "overturned"
    text = base64.urlsafe_b64encode(json.dumps({**inputs, "restitution": {"models": ["ked"]}}).encode()).decode()
    page = open_page(f"in={text.rstrip('=')}&view=response")
    page.locator(".response-results[data-drawn]").wait_for()
    page.get_by_test_id("scene-time").focus()
    page.keyboard.press("End")
    lies = math.degrees(answer["fall"]["lying"][found.side > 0])
    assert abs(lies) > 80.0
    shown = page.get_by_test_id("scene-rotation")
    expect(shown).to_contain_text(f"{abs(lies):.2f}\u00b0")
    shot(page, "response-lying")
    expect(page.get_by_test_id("response-charts").locator("..")).to_contain_text("by the same equation")


def test_tracks_are_straight_between_samples(page: Any) -> None:
    """A track asked forwards, backwards and beyond its ends answers as linear interpolation does."""
    script = """async ([time, values, asked]) => {
      const { Track } = await import("/scene/track.js");
      const track = new Track(time, values);
      return asked.map((instant) => track.at(instant));
    }"""
    time, values = [0.0, 0.1, 0.4, 0.5, 2.0], [1.0, -1.0, 5.0, 5.0, 2.0]
    asked = [-1.0, 0.0, 0.05, 0.25, 0.45, 1.25, 3.0, 0.3, 0.02]
    wanted = [1.0, 1.0, 0.0, 2.0, 5.0, 3.5, 2.0, 3.0, 0.6]
    assert page.evaluate(script, [time, values, asked]) == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("name", ["Picture, PNG", "Picture, SVG", "Curves, CSV", "Animation, page"])
def test_files_are_saved(answered: Callable[..., Any], name: str) -> None:
    """Every button of the part to take away gives a file that is not empty."""
    page = answered()
    with page.expect_download() as waiting:
        page.get_by_role("button", name=name).click()
    assert Path(waiting.value.path()).stat().st_size > 1000


def test_dark_and_phone(answered: Callable[..., Any], shot: Callable[..., Path]) -> None:
    """In the dark, and at 360 px, everything is there and nothing is wider than the screen."""
    for name, options in (("dark", {"color_scheme": "dark"}), ("phone", {"viewport": PHONE})):
        page = answered(link(DECISIVE), **options)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        page.get_by_test_id("scene-ground").select_option("magnified")
        shot(page, f"response-{name}")


def test_the_fallen_body_is_told_with_one_angle(answered: Callable[..., Any]) -> None:
    """Lying on its side a block of h/b 4 has turned 90 degrees, which are 90 / 14.04 of alpha and not more."""
    page = answered(link(DECISIVE, restitution={"models": ["ked"]}))
    page.get_by_test_id("scene-stage").focus()
    page.keyboard.press("End")
    alpha = math.degrees(response(DECISIVE, "ked").parameters.right.slenderness_angle)
    words = page.get_by_test_id("scene-rotation").inner_text().replace("\u2212", "-")
    degrees, share = (abs(float(each)) for each in re.findall(r"-?[0-9.]+", words))
    assert degrees == pytest.approx(90.0, abs=0.01)
    assert share == pytest.approx(90.0 / alpha, abs=0.006)


def test_the_curve_of_a_fall_ends(answered: Callable[..., Any]) -> None:
    """The rotation is drawn up to 1.5 alpha, as the words under it say: no flat line goes on after it."""
    page = answered(link(DECISIVE, restitution={"models": ["ked"]}))
    expect(page.get_by_text("Curves of a body that overturns end at 1.5 \u03b1")).to_be_visible()
    chart = page.get_by_test_id("chart-rotation")
    chart.locator("summary").click()
    page.get_by_role("button", name=re.compile("Copy table: Rotation over slenderness")).click()
    rows = [row.split("\t") for row in pasted(page).splitlines()[1:]]
    found = response(DECISIVE, "ked")
    alpha = found.parameters.right.slenderness_angle
    fall = float(found.time[int(np.argmax(np.abs(found.rotation) > 1.5 * alpha))])
    shown = [(float(time), abs(float(share))) for time, share in (row[:2] for row in rows) if share.strip()]
    assert max(share for _, share in shown) <= 1.5
    assert shown[-1][0] <= fall
    assert float(rows[-1][0]) > fall


def test_many_impacts_scroll_in_a_box(answered: Callable[..., Any]) -> None:
    """Let go from 0.9 of alpha a body impacts more often than a screen has lines: the table scrolls, not the page."""
    page = answered(link(None, response={"free": 0.9}, restitution={"value": 0.98}))
    table = page.get_by_test_id("impacts-table")
    expect(table.locator("tbody tr").nth(60)).to_be_attached()
    box = page.get_by_test_id("impacts").locator(".table-scroll")
    assert box.evaluate("node => node.scrollHeight > 2 * node.clientHeight")
    assert box.evaluate("node => node.clientHeight <= innerHeight / 1.5")
    box.evaluate("node => node.scrollTo(0, node.scrollHeight)")
    head = table.locator("thead th").first.bounding_box()
    assert abs(head["y"] - box.bounding_box()["y"]) < 3.0


# white noise of 50 s: its friction demand, velocities and energies are spikes of one sample
NOISE = [0.0, *np.random.default_rng(3).normal(scale=2.2, size=10_000)]
RATTLED = "".join(f"{0.005 * k:.3f},{a:.9f}\n" for k, a in enumerate(NOISE)).encode()
LEANING = {"units": "m", "trapezoid": {"base": 0.5, "top": 0.3, "height": 1.8, "lean": 0.1}}
CURVE = """(svg) => {
  const numbers = (node, ...keys) => keys.map((key) => Number(node.getAttribute(key)));
  const [left, width] = numbers(svg.querySelector("clipPath rect"), "x", "width");
  return { left, width,
    marks: [...svg.querySelectorAll("g[clip-path] line")].map((each) => numbers(each, "x1", "x2", "y1", "y2")),
    curves: [...svg.querySelectorAll("g[clip-path] path")].map((each) => each.getAttribute("d")) };
}"""


def rattle(page: Any, served: Any) -> Response:
    """Shake a leaning body with noise, in the page and in Python."""
    sent = page.request.post(
        f"{served.url}/api/records", params={"name": "noise.csv"}, data=RATTLED,
        headers={"Content-Type": "application/octet-stream", "Origin": served.url},
    ).json()  # fmt: skip
    motion = {"record": sent["record"], "units": "m/s2", "file_name": "noise.csv"}
    inputs = {"body": LEANING, "motion": motion, "restitution": {"models": ["ked"]}}
    text = base64.urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    page.evaluate("(hash) => { location.hash = hash; }", f"in={text}&view=response")
    expect(page.get_by_test_id("outcomes").locator(".outcome")).to_have_count(1)
    time, values = np.loadtxt(RATTLED.decode().splitlines(), delimiter=",").T
    return simulate(Section([Region(trapezoid(0.5, 0.3, 1.8, lean=0.1))]), GroundMotion(values, float(time[1])), "ked")


def drawn(page: Any, title: str) -> tuple[dict[str, Any], np.ndarray]:
    """Save a chart as SVG and return its frame and the points of its curve [dots]."""
    with page.expect_download() as waiting:
        page.get_by_role("button", name=f"SVG of the chart {title}", exact=True).click()
    text = Path(waiting.value.path()).read_text(encoding="utf-8").split("\n", 1)[1]
    script = f"(text) => ({CURVE})(new DOMParser().parseFromString(text, 'image/svg+xml').documentElement)"
    found = page.evaluate(script, text)
    pairs = re.findall(r"(-?[\d.]+) (-?[\d.]+)", "".join(found["curves"]))
    return found, np.array(pairs, dtype=float)


def test_curves_reach_their_peaks_to_the_dot(answered: Callable[..., Any], served: Any, shot: Any) -> None:
    """The rotation is drawn to its largest and least value between all samples, within a dot, and so is a part of it.

    Looked into, that part has every sample. A double click shows all of it again.
    """
    page = answered()
    found = rattle(page, served)
    assert found.outcome is Outcome.ROCKED
    fine = np.linspace(0.0, found.time[-1], 20 * found.time.size)
    alphas = found.parameters.left.slenderness_angle, found.parameters.right.slenderness_angle
    share = found.at(fine) / np.where(found.at(fine) > 0.0, alphas[1], alphas[0])
    title = "Rotation over slenderness angle"
    frame, points = drawn(page, title)
    upper, lower = (line[2] for line in frame["marks"] if line[0] == frame["left"] and line[2] == line[3])
    if upper > lower:
        upper, lower = lower, upper
    of_dots = lambda y: 1.0 - 2.0 * (y - upper) / (lower - upper)  # noqa: E731 - marks stand at +1 and -1
    dot = 2.0 / (lower - upper)
    assert of_dots(points[:, 1].min()) == pytest.approx(share.max(), abs=0.5 * dot)
    assert of_dots(points[:, 1].max()) == pytest.approx(share.min(), abs=0.5 * dot)
    assert points.shape[0] < 0.7 * found.time.size
    stage = page.get_by_test_id("chart-rotation").locator(".u-over")
    box = stage.bounding_box()
    page.mouse.move(box["x"] + 0.30 * box["width"], box["y"] + 50)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.34 * box["width"], box["y"] + 60, steps=4)
    page.mouse.up()
    charts = page.get_by_test_id("response-charts").locator("..")
    expect(charts).to_have_attribute("data-window", re.compile(r"\d \d"))
    first, last = map(float, charts.get_attribute("data-window").split())
    shot(page, "response-looked-into")
    frame, points = drawn(page, title)
    inside = points[(points[:, 0] >= frame["left"] - 0.01) & (points[:, 0] <= frame["left"] + frame["width"] + 0.01)]
    samples = np.count_nonzero((found.time >= first) & (found.time <= last))
    assert 100 < samples <= inside.shape[0]
    within = share[(fine >= first) & (fine <= last)]
    upper, lower = sorted(line[2] for line in frame["marks"] if line[0] == frame["left"] and line[2] == line[3])
    assert of_dots(inside[:, 1].min()) == pytest.approx(within.max(), abs=dot)
    assert of_dots(inside[:, 1].max()) == pytest.approx(within.min(), abs=dot)
    stage.dblclick()
    expect(charts).to_have_attribute("data-window", "")
