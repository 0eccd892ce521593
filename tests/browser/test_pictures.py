"""Every picture can be saved, and the file shows what the page shows."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest
from browser_pages import saved
from matplotlib import image
from playwright.sync_api import expect

SVG = "{http://www.w3.org/2000/svg}"


def drawing(path: Path) -> ET.Element:
    """Read an SVG file, which must need nothing from outside it."""
    text = path.read_text(encoding="utf-8")
    assert "var(" not in text
    assert "class=" not in text
    assert not re.search(r'(href|src)="(?!#)', text)
    return ET.fromstring(text)


@pytest.mark.parametrize(
    ("title", "word", "count"),
    [("Where the impulse acts", "foot it lands on", 6), ("Where the energy goes, by KED", "Stage 1", 4)],
)
def test_the_pictures_of_an_impact_are_saved(open_page: Callable[..., Any], title: str, word: str, count: int) -> None:
    """The SVG has words, rows and colours without the page's style sheet; the PNG is twice as wide and not blank."""
    page = open_page(view="impact")
    page.get_by_test_id("ledger").wait_for()
    root = drawing(saved(page, "SVG", f"picture {title}").path())
    words = ["".join(each.itertext()) for each in root.iter(f"{SVG}text")]
    assert words[0] == f"{title}, right foot"
    assert any(word in each for each in words)
    marks = [each for each in root.iter() if each.tag in (f"{SVG}circle", f"{SVG}rect") and each.get("fill")]
    assert len(marks) >= count
    assert len({each.get("fill") for each in marks}) >= 3
    pixels = image.imread(saved(page, "PNG", f"picture {title}").path(), format="png")
    assert pixels.shape[1] == 2 * round(float(root.get("width", "0")))
    assert pixels.reshape(-1, pixels.shape[2]).std(axis=0).max() > 0.01
    assert pixels[..., 3].min() == 1.0


def turn_of(path: str) -> float:
    """Return how far the base of a block, the first edge of its outline, has turned clockwise [degrees]."""
    (x0, y0), (x1, y1) = (tuple(map(float, each.split())) for each in path.strip("MZ").split("L")[:2])
    return math.degrees(math.atan2(y1 - y0, x1 - x0))


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
    words = ["".join(each.itertext()) for each in root.iter(f"{SVG}text")]
    assert words[0] == f"The body at {page.get_by_test_id('scene-now').inner_text()}"
    models = page.locator(".outcome-model").all_inner_texts()
    assert len(models) > 1
    assert set(models) <= set(words)
    bodies = [each for each in root.iter(f"{SVG}path") if each.get("fill-rule") == "evenodd"]
    assert len(bodies) == len(models)
    (lead,) = [each for each in bodies if each.get("fill") != "none"]
    assert abs(degrees) > 0.5
    assert turn_of(lead.get("d", "")) == pytest.approx(degrees, abs=0.2)
    pixels = image.imread(saved(page, "PNG", "picture The body at this instant").path(), format="png")
    assert pixels.shape[1] == 2 * round(float(root.get("width", "0")))
