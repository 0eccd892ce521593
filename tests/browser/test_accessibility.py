"""axe finds nothing in any step, by day and by night, wide and narrow; no bar is needed at twice the size."""

from collections.abc import Callable
from typing import Any

import pytest
from browser_pages import link

Axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe

DAY = {"color_scheme": "light", "viewport": {"width": 1440, "height": 900}}
NIGHT_PHONE = {"color_scheme": "dark", "viewport": {"width": 390, "height": 800}}


def found(page: Any) -> list[str]:
    """Return what axe minds, with where it stands."""
    results = Axe().run(page, options={"resultTypes": ["violations"]}).response["violations"]
    return [f"{one['id']}: {node['target']} {node['failureSummary']}" for one in results for node in one["nodes"]]


def steps(page: Any) -> list[str]:
    """Return the steps of the page."""
    names: list[str] = page.locator("[role=tab][data-view]").evaluate_all("tabs => tabs.map(tab => tab.dataset.view)")
    return names


@pytest.mark.parametrize("look", [DAY, NIGHT_PHONE], ids=["day", "night"])
def test_axe_minds_nothing(open_page: Callable[..., Any], look: dict[str, Any]) -> None:
    """Every step with a body and a motion in it."""
    page = open_page(link(), **look)
    assert len(steps(page)) >= 9
    for step in steps(page):
        page.locator(f"#tab-{step}").click()
        page.wait_for_selector(f"#view-{step}[data-ready=true]")
        page.wait_for_load_state("networkidle")
        assert found(page) == [], step


def test_axe_minds_what_is_wrong(open_page: Callable[..., Any]) -> None:
    """Negative control: a picture without words, a button without a name, grey on grey."""
    page = open_page()
    page.evaluate(
        "document.querySelector('main').insertAdjacentHTML('beforeend',"
        "'<img src=\"data:,\"><button></button><p class=faint>pale</p>');"
        "document.querySelector('.faint').style.cssText = 'color: #bbb; background: #ccc'"
    )
    assert {one.split(":")[0] for one in found(page)} >= {"image-alt", "button-name", "color-contrast"}


@pytest.mark.parametrize("width", [320, 768, 1024])
def test_no_bar_below(open_page: Callable[..., Any], width: int) -> None:
    """Nothing is wider than the window, at 320 pixels too: a window of 640 at twice the size."""
    page = open_page(link(), viewport={"width": width, "height": 800})
    for step in steps(page):
        page.locator(f"#tab-{step}").click()
        page.wait_for_selector(f"#view-{step}[data-ready=true]")
        page.wait_for_load_state("networkidle")
        wide = page.evaluate("document.documentElement.scrollWidth")
        assert wide <= width, (step, wide)
