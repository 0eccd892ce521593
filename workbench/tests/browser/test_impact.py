"""The Impact view as a user meets it: coefficients, evidence, impulse, energy, stages, warnings."""

import base64
import json
import math
import re
from collections.abc import Callable
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")
expect = playwright.expect

HOUSNER = 1.0 - 1.5 * math.sin(math.atan(0.25)) ** 2
COSINE = math.cos(math.atan(0.25)) ** 2


@pytest.fixture
def impact(open_page: Callable[..., Any]) -> Any:
    """Open the Impact view of the first body."""
    page = open_page(view="impact")
    page.get_by_test_id("ledger").wait_for()
    return page


def rows(page: Any) -> dict[str, list[str]]:
    """Return the table of models with full digits, by model."""
    found = page.evaluate(
        "[...document.querySelectorAll('[data-testid=coefficients] tbody tr')].map("
        "row => [...row.children].map(cell => cell.title || cell.textContent))"
    )
    return {name: values for name, *values in found}


def test_every_model_has_its_coefficient(impact: Any, shot: Callable[..., Any]) -> None:
    """A block of h/b 4: Housner and cos2(alpha) by their closed forms, all rows with interval and loss."""
    found = rows(impact)
    assert len(found) >= 7
    assert float(found["Housner"][0]) == pytest.approx(HOUSNER, rel=1e-12, abs=0.0)
    assert float(found["horizontal momentum (cos\u00b2\u03b1)"][0]) == pytest.approx(COSINE, rel=1e-12, abs=0.0)
    assert float(found["Housner"][2]) == pytest.approx(1.0, rel=1e-9, abs=0.0)
    assert found["Housner"][3].startswith(f"{100.0 * (1.0 - HOUSNER**2):.1f}")
    assert all("\u2026" in values[1] and values[5] in ("yes", "no") for values in found.values())
    shot(impact, "impact")


def test_ked_is_not_housner(impact: Any) -> None:
    """Negative control: the rows are the models' own, not one number seven times."""
    values = {float(each[0]) for each in rows(impact).values()}
    assert len(values) == len(rows(impact)) >= 7
    assert float(rows(impact)["KED"][0]) != pytest.approx(HOUSNER, abs=1e-2)


def test_the_evidence_is_drawn_with_this_body(impact: Any) -> None:
    """Every published measurement has a marker in the picture, every model a dot and an interval."""
    cloud = impact.get_by_test_id("measured-picture")
    assert cloud.locator(".marker").count() == 39
    assert cloud.locator("circle").count() == len(rows(impact))
    assert impact.get_by_test_id("interval-picture").locator("circle").count() == len(rows(impact))
    assert "39 published coefficients of restitution" in cloud.get_attribute("aria-label")


def test_impulse_positions_stand_where_they_are_said_to_be(impact: Any) -> None:
    """In the picture Housner's dot lies on the line of the foot and k = 2/3 two thirds of the way to it."""
    places = impact.evaluate(
        """() => {
          const picture = document.querySelector('[data-testid=impulse-picture]');
          const centre = each => { const b = each.getBoundingClientRect(); return b.left + b.width / 2; };
          const dots = Object.fromEntries([...picture.querySelectorAll('g')]
            .filter(g => g.querySelector(':scope > circle'))
            .map(g => [g.querySelector('text').textContent, centre(g.querySelector('circle'))]));
          const base = picture.querySelector('.base-bar').getBoundingClientRect();
          return { dots, left: base.left, right: base.right };
        }"""
    )
    span = places["right"] - places["left"]
    assert places["dots"]["Housner"] == pytest.approx(places["right"], abs=0.01 * span)
    shifted = next(at for name, at in places["dots"].items() if name.startswith("shifted"))
    assert (shifted - places["left"]) / span == pytest.approx(2.0 / 3.0, abs=0.01)


def test_the_energy_ledger_starts_whole_and_loses_twice(impact: Any) -> None:
    """Stage 1 leaves cos2-like 16/17 of the energy of a block of h/b 4; bars get shorter, the last loses nothing."""
    words = impact.get_by_test_id("ledger").get_attribute("aria-label")
    shares = [float(each.split("\u202f")[0].split()[-1]) for each in words.split(":")[1].split(",")]
    # Horizontal part of a rotation about a corner: (4/3) h^2 of (4/3) (h^2 + b^2).
    assert shares[1] == pytest.approx(100.0 * 16.0 / 17.0, abs=0.05)
    assert shares[0] == 100.0
    assert shares[0] > shares[1] > shares[2] == shares[3]
    widths = [each.bounding_box()["width"] for each in impact.get_by_test_id("ledger").locator(".bar-kept").all()]
    assert widths[1] / widths[0] == pytest.approx(16.0 / 17.0, abs=0.005)


def test_the_three_stages_are_drawn(impact: Any) -> None:
    """Four panels; after stage 1 every arrow is level, before it not, which is the control."""
    level = """name => [...document.querySelectorAll(`.stage-arrows.${name} .arrow`)].filter(each => {
      const [x0, y0, x1, y1] = each.getAttribute('d').match(/-?[0-9.]+/g).map(Number);
      return Math.abs(y1 - y0) > 0.11;
    }).length"""
    assert impact.locator(".stage").count() == 4
    assert impact.evaluate(level, "stage-1") == 0
    assert impact.evaluate(level, "before") > 10


def test_sides_that_differ_can_be_chosen(open_page: Callable[..., Any]) -> None:
    """A leaning trapezoid has a coefficient for each foot, and the choice swaps the table."""
    inputs = {"body": {"units": "m", "trapezoid": {"base": 1.0, "top": 0.6, "height": 3.0, "lean": 0.3}}}
    text = base64.urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    page = open_page(f"in={text}&view=impact")
    page.get_by_test_id("ledger").wait_for()
    right = float(rows(page)["Housner"][0])
    page.get_by_role("radio", name="left foot").check()
    assert float(rows(page)["Housner"][0]) != pytest.approx(right, abs=1e-3)
    assert page.get_by_text("impact on the left foot").is_visible()


def test_a_squat_body_is_warned_of_in_words(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """Far outside the measured slenderness there are sentences, and none for a body within it."""
    usual = open_page(view="impact")
    usual.get_by_test_id("ledger").wait_for()
    assert usual.get_by_test_id("impact-warnings").locator(".note").count() == 0
    squat = open_page("view=impact&in=eyJib2R5Ijp7InVuaXRzIjoibSIsIndpZHRoIjoyLCJoZWlnaHQiOjEuNn19")
    squat.get_by_test_id("impact-warnings").locator(".note").first.wait_for()
    assert len(squat.get_by_test_id("impact-warnings").inner_text()) > 40
    shot(squat, "impact-warned")


def test_the_table_is_saved(impact: Any) -> None:
    """The CSV of the table has every digit."""
    with impact.expect_download() as saved:
        impact.get_by_role("button", name="as CSV").first.click()
    assert "0.9117647058823529" in saved.value.path().read_text(encoding="utf-8-sig")


def test_phone(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """At 360 px all pictures keep to the window and their words to the pictures."""
    page = open_page(view="impact", viewport={"width": 360, "height": 740}, color_scheme="dark")
    page.get_by_test_id("ledger").wait_for()
    cut = page.evaluate(
        "[...document.querySelectorAll('#view-impact svg text')].filter(each => {"
        " const box = each.getBoundingClientRect(); return box.width && (box.left < 0 || box.right > innerWidth); })"
        ".map(each => each.textContent)"
    )
    assert cut == []
    shot(page, "impact-phone-dark")


def fragment(body: dict[str, Any], view: str = "impact") -> str:
    """Return the fragment of a link to a body."""
    text = base64.urlsafe_b64encode(json.dumps({"body": body}).encode()).decode().rstrip("=")
    return f"in={text}&view={view}"


CROSSED_FEET = {"units": "m", "block": {"width": 0.5, "height": 2, "feet": [0.4, 0.1]}}


def test_a_refused_body_at_the_first_visit_is_said_and_nothing_waits(open_page: Callable[..., Any]) -> None:
    """No "Computing" for ever and no blank cards: only why there is no answer."""
    page = open_page(fragment(CROSSED_FEET))
    expect(page.get_by_test_id("impact-refusal")).to_contain_text("a left and a right foot on the base")
    expect(page.get_by_test_id("impact-results")).to_be_hidden()
    expect(page.locator("#view-impact .waiting")).to_be_hidden()


def test_older_results_are_dimmed_under_a_refusal(impact: Any, served: Any) -> None:
    """A refused body leaves the last answer, marked as such; a good body brings it up to date."""
    impact.goto(f"{served.url}/#{fragment(CROSSED_FEET)}")
    expect(impact.get_by_test_id("impact-refusal")).to_contain_text("last valid inputs")
    expect(impact.get_by_test_id("impact-results")).to_have_class(re.compile("stale"))
    impact.goto(f"{served.url}/#{fragment({'units': 'm', 'width': 1, 'height': 4})}")
    expect(impact.get_by_test_id("impact-refusal")).to_be_empty()
    expect(impact.get_by_test_id("impact-results")).not_to_have_class(re.compile("stale"))


def test_an_error_does_not_outlast_its_cause(open_page: Callable[..., Any]) -> None:
    """An answer that failed once is asked for again when the view is next shown."""
    page = open_page()
    page.get_by_test_id("facts-table").wait_for()
    busy = '{"error": {"kind": "busy", "message": "too much at once"}}'
    page.route("**/api/impact", lambda route: route.fulfill(status=429, body=busy, content_type="application/json"))
    page.locator("#tab-impact").click()
    expect(page.get_by_test_id("impact-refusal")).to_contain_text("Too much at once")
    page.unroute("**/api/impact")
    page.locator("#tab-body").click()
    page.locator("#tab-impact").click()
    page.get_by_test_id("ledger").wait_for()
    expect(page.get_by_test_id("impact-refusal")).to_be_empty()


def test_every_model_has_a_key_of_its_own_without_colour(impact: Any) -> None:
    """The dashes of the keys differ by pairs, in the table as in the picture."""
    keys = impact.locator("[data-testid=coefficients] .dash-key path")
    dashes = [key.get_attribute("stroke-dasharray") for key in keys.all()]
    assert len(dashes) == len(rows(impact)) >= 7
    named = [dash for dash in dashes if dash]
    assert len(set(named)) == len(named) >= 5


def test_the_contact_bed(impact: Any) -> None:
    """The laboratory takes the body's slenderness and width, draws what comes out, and refuses in words."""
    bed = impact.get_by_test_id("bed")
    bed.get_by_label("Varied parameter").select_option("damping")
    with impact.expect_response("**/api/contact-bed") as told:
        bed.get_by_role("button", name="Compute").click()
    asked = json.loads(told.value.request.post_data)
    assert (asked["varied"], asked["slenderness"], asked["width"]) == ("damping", 4.0, 0.5)
    chart = bed.get_by_test_id("bed-chart")
    expect(chart.locator(".chart-stage")).to_have_attribute("aria-label", re.compile("damping.*contact bed.*Housner"))
    bed.get_by_label("Show", exact=True).select_option("peak_force")
    expect(chart.locator("figcaption")).to_contain_text("peak force")
    bed.get_by_text("Range and bed parameters").click()
    bed.get_by_label("from", exact=True).fill("-1")
    bed.get_by_role("button", name="Compute").click()
    expect(bed.get_by_role("alert")).to_contain_text("Damping must be at least 0; it is \u22121.")
    bed.get_by_label("from", exact=True).fill("")
    density = bed.get_by_role("textbox", name="density")
    density.fill("-3")
    bed.get_by_role("button", name="Compute").click()
    expect(density).to_be_focused()
    expect(density).to_have_accessible_description("Density must be more than 0; it is \u22123.")
