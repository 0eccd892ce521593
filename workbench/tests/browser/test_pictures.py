"""Every figure is saved as it is seen: one drawing on the screen and in the file, light, and whole in itself."""

import json
import math
import re
from base64 import urlsafe_b64encode
from collections.abc import Callable
from importlib.resources import files
from io import BytesIO
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from browser_pages import asked_in_space, finished, saved, scan
from matplotlib import image
from playwright.sync_api import expect

SVG = "{http://www.w3.org/2000/svg}"
DRAWN = {
    "svg", "title", "desc", "g", "path", "rect", "circle", "line", "text", "tspan", "defs", "pattern", "clipPath",
    "image",
}  # fmt: skip
NAME = "Vase \u201c3\u201d </text><script>alert(1)</script> \u77f3"
BODY = {"units": "m", "trapezoid": {"base": 0.5, "top": 0.3, "height": 1.8, "lean": 0.1}, "name": NAME}
BARE = """() => {
  const own = new CSSStyleSheet();
  own.replaceSync(`.u-cursor-x, .u-cursor-y, .u-cursor-pt { display: none !important }
    canvas { border-color: transparent !important; border-radius: 0 !important }`);
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, own];
}"""
# what shows something without a menu; the board, the strip below the stage and the sketches of pulses are controls
MENULESS = """(section) => [...section.querySelectorAll("canvas, img, svg.picture, svg[role=img]")]
  .filter((each) => each.checkVisibility())
  .filter((each) => !each.closest(".scene-strip, .key, .dash-key, [role=application]:not(canvas)"))
  .filter((each) => !each.closest(".figure, .chart, .pictured, .scene-holder, div:has(> .drawing)")?.parentElement
    .querySelector(".chart-files")).map((each) => each.outerHTML.slice(0, 200))"""
DARK = "document.documentElement.dataset.theme"


def drawing(path: Path) -> ET.Element:
    """Read an SVG file, which must do nothing and need nothing that is not in it."""
    root = ET.fromstring(path.read_bytes())
    ids = {f"url(#{each.get('id')})" for each in root.iter()}
    for each in root.iter():
        assert each.tag.removeprefix(SVG) in DRAWN, each.tag
        for key, value in each.attrib.items():
            assert not re.match(r"on|class|style", key), key
            assert not re.search(r"var\(|currentcolor", value), value
            assert "url(" not in value or value in ids, value
            assert not key.endswith("href") or value.startswith("data:image/png;base64,"), value[:80]
    return root


def words_of(root: ET.Element) -> list[str]:
    """Return the texts of a drawing."""
    return ["".join(each.itertext()) for each in root.iter(f"{SVG}text")]


def seen(page: Any, figure: Any) -> np.ndarray:
    """Return what is seen of a figure."""
    page.mouse.move(0, 0)
    return np.asarray(image.imread(BytesIO(figure.screenshot()), format="png"))[..., :3]


def drawn(root: ET.Element, pixels: np.ndarray, *, below: bool) -> np.ndarray:
    """Return the drawing in a saved PNG, without title and words about it; below: without its legend."""
    (node,) = root.findall(f"{SVG}svg")
    x, y, width, height = (float(node.get(key, "0")) for key in ("x", "y", "width", "height"))
    if below:
        head = float(re.findall(r"[\d.]+", node.findall(f"{SVG}g")[-1].get("transform", ""))[-1])
        y, height = y + head, height - head
    return pixels[round(2 * y) : round(2 * (y + height)), round(2 * x) : round(2 * (x + width)), :3]


MOST = 0.04
"""Letters of a canvas and of an SVG are not of the same dots."""


def differing(one: np.ndarray, other: np.ndarray) -> float:
    """Return in which share of the squares of twelve dots that have anything in them two pictures differ."""
    high, wide = (min(a, b) // 12 * 12 for a, b in zip(one.shape[:2], other.shape[:2], strict=True))
    cut = [each[:high, :wide].reshape(high // 12, 12, wide // 12, 12, 3).mean(axis=(1, 3)) for each in (one, other)]
    full = (cut[0] < 0.985).any(axis=-1) | (cut[1] < 0.985).any(axis=-1)
    return float((np.abs(cut[0] - cut[1]).max(axis=-1) > 0.12)[full].mean())


def alike(one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two pictures are the same, one perhaps a dot aside: a figure may begin within a dot."""
    beside = [(0, 0), *((x, y) for x in (-1, 0, 1) for y in (-1, 0, 1))]
    return any(differing(one, np.roll(other, shift, axis=(0, 1))) < MOST for shift in beside)


def compared(page: Any, section: Any, about: list[str], *, dark: bool = True) -> list[str]:
    """Save every figure that a view draws, compare it with the screen, and return their names.

    The control: the same drawing sixteen dots aside, or upside down, is another.
    """
    assert section.evaluate(MENULESS) == []
    names = []
    for menu in section.locator(".chart-files:visible").all():
        what = menu.locator("summary").get_attribute("aria-label").removeprefix("Save the ")
        kind, title = what.split(" ", 1)
        place = menu.locator("xpath=ancestor::*[contains(@class, 'chart-foot')]/..")
        if place.locator("> img").count():
            continue  # a file of the server on both sides
        still = title == "The body at this instant"
        figure = place.locator(".u-wrap" if kind == "chart" else ".scene-stage" if still else "> .pictured").first
        path = Path(saved(page, "SVG", what).path())
        root = drawing(path)
        words = words_of(root)
        head = " ".join(words[:4])
        assert still or words[0].startswith(title)
        assert all(each in head for each in about), head
        pixels = image.imread(saved(page, "PNG", what).path(), format="png")
        assert pixels.shape[1] == 2 * round(float(root.get("width", "0")))
        assert pixels[..., 3].min() == 1.0
        one, other = seen(page, figure), drawn(root, pixels, below=kind == "chart" or still)
        one = one[2:-2, 2:-2] if still else one  # its border
        assert alike(one, other), (what, differing(one, other))
        assert differing(one, np.roll(other, 16, axis=(0, 1))) > MOST, what
        assert differing(one, other[::-1]) > MOST, what
        names.append(what)
        if dark:
            page.locator("#theme").click()
            again = Path(saved(page, "SVG", what).path())
            assert page.evaluate(DARK) == "dark"
            assert seen(page, figure).mean() < 0.5 or title == "Overturning map"
            bare = [re.sub(r"(clip|cut)-\d+", "", each.read_text("utf-8")) for each in (path, again)]
            assert bare[0] == bare[1], what
            page.locator("#theme").click()
            dark = False  # one of each view is enough
    return names


def opened_light(open_page: Callable[..., Any], view: str, **more: Any) -> tuple[Any, Any]:
    """Open a view, with two dots of the screen for one as in a PNG."""
    inputs = {
        "body": BODY, "motion": {"pulse": "sine:amplitude=4,period=0.8", "scale": 1.2},
        "restitution": {"models": ["ked", "housner"]}, **more,
    }  # fmt: skip
    text = urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    page = open_page(f"in={text}&view={view}", device_scale_factor=2, color_scheme="light")
    page.evaluate(BARE)
    return page, page.locator(f"#view-{view}")


MOTION = "1.2 \u00d7 sine pulse, 4 m/s\u00b2, 0.8 s"
FIGURES = {
    "body": ([NAME], 1),
    "impact": ([NAME], 6),
    "motion": ([MOTION], 4),
    "response": ([NAME, MOTION], 7),
    "compare": ([NAME, MOTION], 4),
}


@pytest.mark.parametrize("view", FIGURES)
def test_every_figure_is_saved_as_it_is_seen(open_page: Callable[..., Any], served: Any, view: str) -> None:
    """SVG and PNG have the marks of the screen, say what they are of, and are the same where the page is dark."""
    for study in served.api("studies", method="GET")["studies"]:  # of other tests, which Compare would draw
        served.api(f"studies/{study['id']}", method="DELETE")
    page, section = opened_light(open_page, view)
    about, count = FIGURES[view]
    if view == "impact":
        bed = page.get_by_test_id("bed")
        bed.get_by_role("button", name="Compute").click()
        page.get_by_test_id("bed-chart").wait_for()
    expect(section.locator(".chart-files:visible")).to_have_count(count)
    page.wait_for_load_state("networkidle")
    if view == "response":
        page.get_by_test_id("scene-stage").focus()
        page.keyboard.press("Home")
    assert len(compared(page, section, about)) == count


def test_figures_of_studies_are_saved_as_they_are_seen(open_page: Callable[..., Any], served: Any) -> None:
    """So are a map, looked into, the history of its cell, curves of fragility and spectra; each names its study."""
    pulse = {"motions": {"pulse": ["sine:amplitude=4,period=0.8"]}, "restitution": {"models": ["ked", "housner"]}}
    axes = {"x": {"axis": "frequency_ratio", "from": 0.5, "to": 8, "count": 12},
            "y": {"axis": "amplitude_ratio", "from": 1, "to": 10, "count": 9}}  # fmt: skip
    made = {
        "map": finished(served, NAME, "overturning-map", body=BODY, map=axes, **pulse),
        "spectra": finished(
            served, NAME, "rocking-spectrum", body=None,
            spectrum={"slenderness_angles": [0.2, 0.3], "periods": [2.0, 3.0, 4.0]}, **pulse,
        ),
        "stripes": finished(
            served, NAME, "stripes", body=BODY, restitution={"model": "ked"},
            fragility={"levels": [2.0, 4.0, 6.0, 8.0, 10.0], "limit_states": []},
            motions={"synthetic": "pulse-like", "count": 12, "seed": 7},
        ),
    }  # fmt: skip
    page, _ = opened_light(open_page, "studies")
    for kind, study in made.items():
        page.get_by_test_id(f"study-{study}").get_by_role("button", name="Show result").click()
        page.get_by_test_id("export-csv").wait_for()
        result = page.get_by_test_id("study-result")
        if kind == "map":
            canvas = page.get_by_test_id("map-canvas")
            canvas.focus()
            page.keyboard.press("+")
            assert compared(page, result, [NAME, "KED"]) == ["picture Overturning map"]
            canvas.click(position={"x": 200, "y": 150})
            result.locator(".chart").wait_for()
            continue
        count = {"spectra": 1, "stripes": 2}[kind]
        assert len(compared(page, result, [NAME, "KED"], dark=False)) == count


def test_a_body_in_space_is_saved_as_it_is_seen(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """So are a body in WebGL and its marks, turned as it is; the SVG has them as an image, with their legend."""
    page, section = opened_light(open_page, "space")
    asked_in_space(page, "restitution", scan(tmp_path))
    page.get_by_test_id("space-stage").focus()
    for _ in range(3):
        page.keyboard.press("ArrowLeft")
    assert compared(page, section, ["leaning-block.stl", "4 edges"]) == ["picture Edges of the base"]
    root = drawing(Path(saved(page, "SVG", "picture Edges of the base").path()))
    assert len(list(root.iter(f"{SVG}image"))) == 1
    assert {"edge with its number", "corner", "centre of mass and plumb line"} <= set(words_of(root))


def turn_of(transform: str) -> float:
    """Return how far a matrix turns clockwise [degrees]."""
    a, b, *_ = map(float, re.findall(r"-?[\d.]+(?:e-?\d+)?", transform))
    return math.degrees(math.atan2(b, a))


def test_a_still_of_the_scene_is_saved(open_page: Callable[..., Any], shot: Callable[..., Path]) -> None:
    """The still has the body of every model, named, the followed one filled and turned as the readout says."""
    page = open_page(view="response")
    # the stage is there before the answer, and keys that are pressed until then go nowhere
    page.locator(".response-results[data-drawn]").wait_for()
    page.get_by_test_id("scene-stage").focus()
    page.keyboard.press("Home")
    for k in range(4):
        expect(page.get_by_test_id("scene-now")).to_have_text(f"{0.5 * k:.3f} s")
        if k < 3:
            page.keyboard.press("Shift+ArrowRight")
    shot(page, "response-still")
    readout = page.get_by_test_id("scene-rotation").inner_text().replace("\u2212", "-")
    degrees = float(readout.split("\u00b0")[0].split("=")[1])
    root = drawing(saved(page, "SVG", "picture The body at this instant").path())
    words = words_of(root)
    assert words[0] == f"The body at {page.get_by_test_id('scene-now').inner_text()}"
    models = page.locator(".outcome-model").all_inner_texts()
    assert len(models) > 1
    assert set(models) <= set(words)
    moved = [each for each in root.iter(f"{SVG}path") if each.get("transform")]
    assert len({each.get("stroke") for each in moved if each.get("stroke-dasharray") or each.get("fill")}) >= 1
    (lead,) = [each for each in moved if each.get("fill-rule") == "evenodd"]
    outlines = {each.get("stroke") for each in moved if each.get("d") == lead.get("d") and each.get("stroke")}
    assert len(outlines) == len(models)
    assert abs(degrees) > 0.5
    assert turn_of(lead.get("transform", "")) == pytest.approx(degrees, abs=0.2)


STATIC = Path(str(files("rocking_workbench"))) / "static"
ASKED = re.compile(r"picture/|\.png\b|export\.\$\{\w+\}.*(svg|png)|drawing/picture-tools")
OF_THE_SERVER = {
    "views/studies-counts.js",
    "views/studies-fragility.js",
    "questions/parts.js",
    "views/compare-studies.js",
}  # answers and comparisons: drawn there, and shown so


def test_a_chart_draws_what_is_in_sight(page: Any) -> None:
    """A part is drawn to a value on either side of it, and all of it without one; with no value there are no words."""
    script = """async ([columns, part]) => {
        const { lineChart } = await import("/charts/line.js");
        const { chartStill } = await import("/charts/curves.js");
        const place = document.body.appendChild(document.createElement("div"));
        const series = [{ label: "", colour: "--ink" }];
        const options = { title: "", x: { label: "time" }, y: { label: "angle" }, series };
        const chart = lineChart(place, options);
        chart.setData(columns, part);
        await new Promise(requestAnimationFrame);
        const drawing = chartStill(chart.plot, options, columns, { horizontal: [1] });
        const curve = [...drawing.querySelectorAll("path")].find((each) => each.getAttribute("stroke-width") === "1.6");
        const words = [...drawing.querySelectorAll("text")].map((each) => each.textContent);
        const text = drawing.outerHTML;
        chart.destroy();
        place.remove();
        return [(curve?.getAttribute("d").match(/[ML]/g) ?? []).length, words.includes("angle"), /NaN/.test(text)];
    }"""
    times = list(range(100))
    heights: list[int | None] = [k % 7 for k in times]
    assert page.evaluate(script, [[times, heights], None]) == [100, True, False]
    assert page.evaluate(script, [[times, heights], [40, 49]]) == [12, True, False]
    heights[39] = heights[50] = heights[51] = None
    assert page.evaluate(script, [[times, heights], [40, 49]]) == [12, True, False]  # to 38 and 52, with gaps
    assert page.evaluate(script, [[times, [None] * 100], None]) == [0, False, False]


def test_a_pen_of_svg_draws_small_bodies_and_clear_colours(page: Any) -> None:
    """Places in metres keep their digits, and a colour with a share is one that every reader of SVG knows."""
    script = """async () => {
        const { SvgPen } = await import("/charts/pen.js");
        const pen = new SvgPen();
        pen.moveTo(0.00012345, 2);
        pen.lineTo(1234.5678, -3);
        pen.fillStyle = "#11223380";
        pen.fill();
        const [d, fill, opacity] = ["d", "fill", "fill-opacity"].map((name) => pen.node.firstChild.getAttribute(name));
        return [d, fill, Number(opacity)];
    }"""
    d, fill, opacity = page.evaluate(script)
    assert (d, fill) == ("M0.00012345 2L1234.568 -3", "#112233")
    assert opacity == pytest.approx(128 / 255, rel=1e-6)


def test_no_script_asks_for_a_picture_of_what_it_draws() -> None:
    """Whatever a script draws it saves itself: a file of the server is shown, or it is not a picture."""
    scripts = {str(path.relative_to(STATIC)): path.read_text("utf-8") for path in STATIC.rglob("*.js")}
    ours = {name: text for name, text in scripts.items() if not name.startswith(("vendor/", "manual/"))}
    assert len(ours) > 100
    assert [name for name, text in ours.items() if ASKED.search(text)] == []
    assert {name for name, text in ours.items() if "<${Fetched}" in text} == OF_THE_SERVER
    assert {name for name, text in ours.items() if "<img" in text} == {"charts/pictured.js"}
    assert ASKED.search("app.download(`picture/${what}.${kind}${query}`)")
