"""Files of finished studies: of the model that is shown, and NRML only where there is something to write."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from browser_pages import finished
from playwright.sync_api import expect

NRML = "{http://openquake.org/xmlns/nrml/0.5}"


def opened(page: Any, study: str) -> None:
    """Show the result of a study."""
    page.get_by_test_id(f"study-{study}").get_by_role("button", name="Show result").click()
    page.get_by_test_id("export-csv").wait_for()


def saved(page: Any, testid: str, folder: Path) -> Path:
    """Press a button and keep its file."""
    with page.expect_download() as download:
        page.get_by_test_id(testid).click()
    target = folder / f"{time.perf_counter_ns()} {download.value.suggested_filename}"
    download.value.save_as(target)
    return target


def test_nrml_needs_a_curve(open_page: Callable[..., Any], served: Any, shot: Any) -> None:
    """Where nothing overturns there is no curve: the button cannot be pressed, and a sentence says why."""
    few = {"motions": {"pulse": ["sine:amplitude=1,period=0.4", "sine:amplitude=1,period=0.7"]}}
    made = finished(served, "nothing falls", fragility={"levels": [0.1, 0.2], "limit_states": []}, **few)
    page = open_page(view="studies")
    opened(page, made)
    expect(page.get_by_test_id("export-xml")).to_be_disabled()
    expect(page.get_by_test_id("no-nrml")).to_have_text("NRML needs a fitted curve. This study has none.")
    expect(page.get_by_test_id("export-csv")).to_be_enabled()
    shot(page, "studies-no-nrml")


def test_curves_that_cross_are_saved_with_one_dispersion(
    open_page: Callable[..., Any], served: Any, tmp_path: Path, shot: Any
) -> None:
    """Curves that cross are replaced on the page, with the reason, and NRML contains the curves of the page."""
    made = finished(
        served, "curves that cross", fragility={"levels": [2.0, 4.0, 6.0, 8.0, 10.0], "limit_states": [0.5]},
        motions={"synthetic": "pulse-like", "count": 12, "seed": 7}, restitution={"model": "ked"},
    )  # fmt: skip
    page = open_page(view="studies")
    opened(page, made)
    expect(page.get_by_test_id("adjusted")).to_contain_text("so that their curves do not cross.")
    shot(page, "studies-curves-cross")
    root = ET.fromstring(saved(page, "export-xml", tmp_path).read_bytes())
    assert root.tag == f"{NRML}nrml"
    assert "so that their curves do not cross." in root.find(f".//{NRML}description").text


def test_files_are_of_the_model_that_is_shown(open_page: Callable[..., Any], served: Any, tmp_path: Path) -> None:
    """NRML is of the restitution that was chosen, and differs from that of the first one."""
    pulses = [f"sine:amplitude=1,period={period}" for period in (0.4, 0.5, 0.7, 0.9, 1.2)]
    made = finished(
        served, "two coefficients", fragility={"levels": [2.0, 4.0, 6.0, 8.0], "limit_states": []},
        motions={"pulse": pulses}, restitution={"values": [0.98, 0.4]},
    )  # fmt: skip
    page = open_page(view="studies")
    opened(page, made)
    first = {kind: saved(page, f"export-{kind}", tmp_path).read_bytes() for kind in ("xml", "csv")}
    page.get_by_test_id("study-result").get_by_label("Restitution").select_option(label="0.4")
    second = {kind: saved(page, f"export-{kind}", tmp_path).read_bytes() for kind in ("xml", "csv")}
    assert first["xml"] != second["xml"]
    assert first["csv"] == second["csv"]  # a table holds all of them


def test_where_no_curve_fits_the_chart_says_so(open_page: Callable[..., Any], served: Any, shot: Any) -> None:
    """Uplift under a given PGA is certain or impossible: dots alone, no legend of a curve, and the reason."""
    same = {"motions": {"pulse": ["sine:amplitude=1,period=0.8", "sine:amplitude=1,period=0.82"]}}
    made = finished(served, "a step", fragility={"levels": [0.5, 1.0, 40.0, 60.0], "limit_states": [0.5]}, **same)
    page = open_page(view="studies")
    opened(page, made)
    why = page.get_by_test_id("no-curve").first
    # tan(alpha) g of a block of h/b 4
    expect(why).to_contain_text(f"No curve: no uplift below {9.80665 / 4:.3f}\u00a0m/s\u00b2")
    expect(why).to_contain_text("a step from 0 to 1")
    chart = page.get_by_test_id("fragility-chart").first
    assert "maximum likelihood" not in chart.inner_text()
    assert "95 % band" not in chart.inner_text()
    expect(chart).to_contain_text("Probability")
    shot(page, "studies-no-curve")
