"""The view of the response, used as a person uses it: models ticked, sliders moved, tables copied, files saved."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser_pages import DECISIVE, GENTLE, MODELS, card, link, pasted, response, saved
from playwright.sync_api import expect

from rocking.bodies import Block
from rocking.dynamics import free_rocking


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


def test_models_have_dashes_of_their_own(answered: Callable[..., Any]) -> None:
    """In the list of models no two lines without regard to colour are alike but that of KED, which is whole."""
    page = answered()
    keys = page.locator(".model-row .dash-key path")
    dashes = [key.get_attribute("stroke-dasharray") for key in keys.all()]
    assert len(dashes) == len(set(dashes)) >= 6


def test_a_coefficient_of_ones_own(answered: Callable[..., Any]) -> None:
    """A typed coefficient joins the models under its own card and curve."""
    page = answered()
    page.get_by_label("Own coefficient").check()
    slider = page.get_by_label("Coefficient of restitution r")
    slider.focus()
    slider.press("Home")
    page.locator("[data-testid=outcomes] .outcome", has_text=re.compile(r"given value.*r = 0 \u00b7")).wait_for()
    assert page.get_by_test_id("outcomes").locator(".outcome").count() == 3
    page.get_by_test_id("chart-rotation").locator(".legend li").nth(2).wait_for()


def test_free_rocking_and_back(answered: Callable[..., Any]) -> None:
    """Let go from half its angle the block rocks as `free_rocking` says; switched back it is shaken again."""
    page = answered()
    page.get_by_label("Start from an initial rotation").check()
    found = free_rocking(Block(width=0.5, height=2.0), 0.5 * math.atan(0.25), "ked")
    card(page, "ked").filter(has_text=f"{found.impacts.size} impacts").wait_for()
    assert "peak 0.5" in card(page, "ked").inner_text()
    page.get_by_label("Start from an initial rotation").uncheck()
    card(page, "ked").filter(has_text=f"{response(GENTLE, 'ked').impacts.size} impacts").wait_for()


def test_without_a_motion_it_says_what_to_do(open_page: Callable[..., Any]) -> None:
    """A link without a motion leads to two buttons, of which one lets the body go."""
    page = open_page(link(None))
    page.get_by_role("button", name="Start from an initial rotation").click()
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
    assert [row[5] for row in rows[1:]] == found["foot"].tolist()


@pytest.mark.parametrize("name", ["Curves, CSV", "Animation, page"])
def test_files_are_saved(answered: Callable[..., Any], name: str) -> None:
    """Every button of the part to take away gives a file that is not empty."""
    page = answered()
    with page.expect_download() as waiting:
        page.get_by_role("button", name=name).click()
    assert Path(waiting.value.path()).stat().st_size > 1000


def test_many_impacts_scroll_in_a_box(answered: Callable[..., Any]) -> None:
    """Let go from 0.9 of alpha a body impacts more often than a screen has lines: the table scrolls, not the page."""
    page = answered(link(None, response={"initial_rotation": 0.9}, restitution={"value": 0.98}))
    table = page.get_by_test_id("impacts-table")
    expect(table.locator("tbody tr").nth(60)).to_be_attached()
    box = page.get_by_test_id("impacts").locator(".table-scroll")
    assert box.evaluate("node => node.scrollHeight > 2 * node.clientHeight")
    assert box.evaluate("node => node.clientHeight <= innerHeight / 1.5")
    box.evaluate("node => node.scrollTo(0, node.scrollHeight)")
    head = table.locator("thead th").first.bounding_box()
    assert abs(head["y"] - box.bounding_box()["y"]) < 3.0


def test_one_time_for_the_body_and_every_figure(answered: Callable[..., Any]) -> None:
    """What is sought in the animation is read in every figure, and a pointer on a figure moves the body there."""
    page = answered()
    readouts = page.get_by_test_id("response-charts").locator(".chart-readout")
    page.get_by_test_id("scene-time").focus()
    for key in ("Home", *("PageUp",) * 3):
        page.keyboard.press(key)
    now = float(page.get_by_test_id("scene-now").inner_text().split()[0])
    assert now > 1.0
    told = [float(text.split()[1]) for text in readouts.all_inner_texts()]
    assert len(told) == 6
    assert told == pytest.approx([now] * 6, abs=0.02)  # each names its nearest sample
    over = page.get_by_test_id("chart-force").locator(".u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    page.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 40)
    expect(page.get_by_test_id("scene-now")).not_to_have_text(f"{now:.3f} s")
    there = float(page.get_by_test_id("scene-now").inner_text().split()[0])
    told = [float(text.split()[1]) for text in readouts.all_inner_texts()]
    assert told == pytest.approx([there] * 6, abs=0.02)


def test_a_body_at_rest_has_all_of_the_time(answered: Callable[..., Any], until: Callable[..., None]) -> None:
    """Nothing moves: the animation ends with the figures, and what is zero all along has an axis of ones around it."""
    page = answered(link("sine:amplitude=1,period=0.8"))
    chart = page.get_by_test_id("chart-velocity")
    chart.scroll_into_view_if_needed()
    page.get_by_test_id("scene-time").focus()
    page.keyboard.press("End")
    end = float(page.get_by_test_id("scene-now").inner_text().split()[0])
    told = chart.locator(".chart-readout")
    until(page, lambda: re.search(r"[1-9]", told.inner_text()))
    assert float(told.inner_text().split()[1]) == pytest.approx(end, abs=0.02)
    assert end > 0.8
    heights = """async data => {
        const { lineChart } = await import("/charts/line.js");
        const place = document.body.appendChild(document.createElement("div"));
        const y = { label: "", unit: "" };
        const chart = lineChart(place, { title: "", x: y, y, series: [{ label: "", colour: "--ink" }] });
        chart.setData(data);
        await new Promise(requestAnimationFrame);
        const { min, max } = chart.plot.scales.y;
        chart.destroy();
        place.remove();
        return [min, max];
    }"""
    assert page.evaluate(heights, [[0, 1, 2], [0, 0, 0]]) == [-1, 1]
    assert page.evaluate(heights, [[0, 1, 2], [0, 5, 10]]) == [0, 11]


def test_impacts_are_ticks_on_the_axis(answered: Callable[..., Any]) -> None:
    """A figure has a short tick for each impact of the model that is looked at, where it lies in time."""
    page = answered()
    script = "text => new DOMParser().parseFromString(text, 'image/svg+xml').documentElement.outerHTML"
    text = Path(saved(page, "SVG", "chart Angular velocity").path()).read_text(encoding="utf-8").split("\n", 1)[1]
    inside = page.evaluate(script, text).rpartition("clip-path")[2]
    lines = np.array(re.findall(r'd="M(\S+) (\S+)L(\S+) (\S+)"', inside), dtype=float)
    ticks = lines[(lines[:, 0] == lines[:, 2]) & (np.abs(lines[:, 1] - lines[:, 3]) < 8.0)]
    impacts = response(GENTLE, "ked").impacts["time"]
    assert len(ticks) == impacts.size
    assert np.corrcoef(ticks[:, 0], impacts)[0, 1] > 1.0 - 1e-9


def test_looking_into_a_part_and_back(answered: Callable[..., Any]) -> None:
    """All figures look into the part that was dragged across in one; a button shows all of it again."""
    page = answered()
    charts = page.get_by_test_id("response-charts").locator("..")
    over = page.get_by_test_id("chart-energy").locator(".u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 40)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 50, steps=3)
    page.mouse.up()
    expect(charts).to_have_attribute("data-window", re.compile(r"\d \d"))
    page.get_by_role("button", name="Show the full duration").click()
    expect(charts).to_have_attribute("data-window", "")


@pytest.mark.parametrize("width", [320, 768, 1024, 1920, 3840])
def test_the_stage_uses_the_width(answered: Callable[..., Any], width: int) -> None:
    """No bar below the window; results stand before what is turned where it is narrow; a wide screen is used."""
    page = answered(viewport={"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    figures, controls = (page.locator(each).bounding_box() for each in (".stage-figures", ".response-controls"))
    if width < 1024:
        assert controls["y"] > figures["y"] + figures["height"]
    else:
        assert controls["x"] > figures["x"] + figures["width"]
        assert controls["x"] + controls["width"] > 0.96 * width
