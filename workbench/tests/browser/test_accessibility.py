"""axe finds nothing in any step, by day and by night, wide and narrow; no bar is needed at twice the size."""

import os
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


CUT = """() => [...document.querySelectorAll("button, .button, label, h1, h2, h3, [role=tab], th, .segment")]
  .filter((node) => node.checkVisibility() && !node.closest(".visually-hidden, .table-scroll"))
  .filter((node) => node.clientWidth > 0 && node.scrollWidth > node.clientWidth + 1
    && getComputedStyle(node).overflowX !== "visible")
  .map((node) => node.textContent)"""
LOW = """() => [...document.querySelectorAll("button, select, input[type=text]")]
  .filter((node) => node.offsetParent && node.getBoundingClientRect().height < 39.5)
  .map((node) => node.textContent || node.id)"""
FINGER = {"body", "impact", "decide", "inventory", "measure", "records", "space"}


def faults(page: Any, step: str = "body") -> list[str]:
    """Return what does not fit, what moves by itself, and what a finger does not hit."""
    wide = page.evaluate("document.documentElement.scrollWidth - innerWidth")
    moving = page.evaluate("document.getAnimations().length")
    cut = [f"cut: {text}" for text in page.evaluate(CUT)]
    low = [f"low: {text}" for text in page.evaluate(LOW)] if step in FINGER else []
    return [*([f"wider by {wide}"] if wide > 0 else []), *cut, *([f"{moving} move"] if moving else []), *low]


NARROW = [{"viewport": {"width": width, "height": 800}} for width in (320, 768, 1024)]
TWICE = {"viewport": {"width": 640, "height": 450}, "device_scale_factor": 2}  # a window of 1280 x 900
LOOKS = [*NARROW, {**TWICE, "locale": "de"}, {"viewport": {"width": 1280, "height": 900}, "locale": "de", "text": 32}]
if os.environ.get("ROCKING_CAMPAIGN"):
    LOOKS += [{**TWICE, "locale": code, "color_scheme": "dark"} for code in ("en", "de", "it", "zh")]
    LOOKS += [{**LOOKS[4], "locale": code} for code in ("en", "it", "zh")]


def named(look: dict[str, Any]) -> str:
    """Return the name of a look."""
    return "-".join([str(look["viewport"]["width"]), *(str(one) for key, one in look.items() if key != "viewport")])


@pytest.mark.parametrize("look", LOOKS, ids=[named(look) for look in LOOKS])
def test_no_bar_below(open_page: Callable[..., Any], look: dict[str, Any]) -> None:
    """Nothing is wider than the window, cut or too low for a finger; nothing plays for who wants less motion.

    At 320 pixels too, which is a window of 640 at twice the size; at twice the size in the longest words; and with
    the browser's own letters at twice theirs.
    """
    text = look.get("text")
    options = {name: value for name, value in look.items() if name != "text"}
    page = open_page(link(), reduced_motion="reduce", **options)
    if text:
        page.context.new_cdp_session(page).send("Page.setFontSizes", {"fontSizes": {"standard": text}})
        assert page.evaluate("getComputedStyle(document.documentElement).fontSize") == f"{text}px"
    assert set(steps(page)) >= FINGER
    for step in steps(page):
        page.locator(f"#tab-{step}").click()
        page.wait_for_selector(f"#view-{step}[data-ready=true]")
        page.wait_for_load_state("networkidle")
        assert faults(page, step) == [], step


def test_what_does_not_fit_is_seen(open_page: Callable[..., Any]) -> None:
    """Negative control: a line that is too long, a button that is cut and low, and a sign that turns for ever."""
    page = open_page(reduced_motion="reduce")
    assert faults(page) == []
    page.evaluate("""() => {
      const made = (kind, words, looks) => {
        const node = document.createElement(kind);
        node.textContent = words;
        Object.assign(node.style, looks);
        document.querySelector("main").append(node);
        return node;
      };
      made("p", "long", { width: "3000px" });
      made("button", "words that are cut", { width: "20px", overflow: "hidden", whiteSpace: "nowrap" });
      made("p", "turns", {}).animate([{ opacity: 0 }, { opacity: 1 }], { duration: 1000, iterations: Infinity });
    }""")
    assert [each.split()[0] for each in faults(page)] == ["wider", "cut:", "1", "low:"]
