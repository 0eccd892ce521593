"""Scene and curves of a response: drawn is what Python computes, in time, to the dot, to the end of a fall."""

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
from browser_pages import DECISIVE, GENTLE, LEANING, link, pasted, response, saved
from playwright.sync_api import expect
from waiting import allowed

from rocking.bodies import Block, Region, Section
from rocking.bodies.shapes import trapezoid
from rocking.dynamics import Response, simulate
from rocking.motions import GroundMotion, pulses
from rocking.outcome import Outcome

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


def test_a_body_that_overturns_comes_to_lie_and_stays(answered: Callable[..., Any], shot: Callable[..., Path]) -> None:
    """At the end of the animation the block that overturned has turned by a quarter and lies on its side."""
    page = answered(link(DECISIVE))
    page.get_by_test_id("scene-time").focus()
    page.keyboard.press("End")
    assert "90.00\u00b0" in page.get_by_test_id("scene-rotation").inner_text()
    shot(page, "response-overturned")


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


@pytest.mark.speed
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
    assert statistics.median(times) < 1000.0 * allowed(0.15), times


@pytest.mark.speed
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
    assert 1.0 / rate <= allowed(1.0 / 55.0)
    assert script_ms < 1000.0 * allowed(0.004)


@pytest.mark.speed
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
        assert seconds / taken < 1.5 * speed
        assert taken < allowed(0.8)
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
    found = simulate(body, pulses.pulse("sine:amplitude=6,period=0.8"), "ked")
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
    expect(page.get_by_test_id("response-charts").locator("..")).to_contain_text("until a corner touches the ground")


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
    expect(page.get_by_text("Curves of an overturning body end at 1.5 \u03b1")).to_be_visible()
    chart = page.get_by_test_id("chart-rotation")
    chart.get_by_text("Show as table").click()
    page.get_by_role("button", name=re.compile("Copy table: Rotation over slenderness")).click()
    rows = [row.split("\t") for row in pasted(page).splitlines()[1:]]
    found = response(DECISIVE, "ked")
    alpha = found.parameters.right.slenderness_angle
    fall = float(found.time[int(np.argmax(np.abs(found.rotation) > 1.5 * alpha))])
    shown = [(float(time), abs(float(share))) for time, share in (row[:2] for row in rows) if share.strip()]
    assert max(share for _, share in shown) <= 1.5
    assert shown[-1][0] <= fall
    assert float(rows[-1][0]) > fall


# white noise of 50 s: its friction demand, velocities and energies are spikes of one sample
NOISE = [0.0, *np.random.default_rng(3).normal(scale=2.2, size=10_000)]


RATTLED = "".join(f"{0.005 * k:.3f},{a:.9f}\n" for k, a in enumerate(NOISE)).encode()


CURVE = """(svg) => {
  const numbers = (path) => path.getAttribute("d").match(/-?[0-9.]+/g).map(Number);
  const [left, , width] = numbers(svg.querySelector("clipPath path"));
  const paths = (wide) => [...svg.querySelectorAll(`g[clip-path] path[stroke-width="${wide}"]`)];
  return { left, width,
    marks: paths(1).map(numbers).map(([x1, y1, x2, y2]) => [x1, x2, y1, y2]),
    curves: paths(1.6).map((each) => each.getAttribute("d")) };
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
    text = Path(saved(page, "SVG", f"chart {title}").path()).read_text(encoding="utf-8").split("\n", 1)[1]
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
