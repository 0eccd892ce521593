"""The shell of the application in a real browser: sign-in, steps, keyboard, theme, link, phone."""

import re
import time
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from browser_pages import link, saved
from matplotlib import image
from waiting import allowed

playwright = pytest.importorskip("playwright.sync_api")
expect = playwright.expect

PHONE, WIDE = {"width": 360, "height": 740}, {"width": 1360, "height": 900}
STATIC = Path(str(files("rocking_workbench"))) / "static"
STEPS = [
    "body",
    "impact",
    "motion",
    "records",
    "response",
    "compare",
    "studies",
    "decide",
    "inventory",
    "measure",
    "space",
    "takeaway",
]


def test_every_step_opens_by_arrow_keys_without_a_fault(page: Any, record: Any, served: Any) -> None:
    """Tab list: right arrow walks the ten steps; nothing leaves the machine and no policy is violated."""
    page.locator("#tab-body").focus()
    for name in STEPS[1:]:
        page.keyboard.press("ArrowRight")
        page.wait_for_selector(f"#view-{name}[data-ready]")
        assert page.locator(f"#view-{name}").get_attribute("data-ready") == "true"
        assert page.locator(f"#tab-{name}").get_attribute("aria-selected") == "true"
        assert page.evaluate("document.activeElement.id") == f"tab-{name}"
    page.keyboard.press("ArrowRight")
    assert page.locator("#tab-body").get_attribute("aria-selected") == "true"
    assert all(url.startswith((served.url, "blob:", "data:")) for url in record.requests)


def test_the_recorder_sees_what_it_must_refuse(
    browser: Any, served: Any, new_record: Callable[[], Any], until: Callable[..., None]
) -> None:
    """Negative control: a foreign request, an inline style and an uncaught error are all recorded."""
    seen = new_record()
    page = browser.new_page()
    seen.watch(page, served.url)
    page.goto(served.url)
    page.evaluate("document.body.setAttribute('style', 'color: red')")
    page.evaluate("fetch('http://127.0.0.1:9/').catch(() => {})")
    page.evaluate("setTimeout(() => { throw new Error('on purpose') })")
    told = ("style", "127.0.0.1:9", "on purpose")
    until(page, lambda: all(any(words in each for each in seen.faults) for words in told))
    page.goto(served.url.replace("127.0.0.1", "localhost") + "/style/icon.svg")
    page.close()
    assert any(each.startswith("request to http://localhost:") for each in seen.faults)
    assert any("Content Security Policy" in each and "style" in each for each in seen.faults)
    assert any("Content Security Policy" in each and "127.0.0.1:9" in each for each in seen.faults)
    assert any("on purpose" in each for each in seen.faults)


@pytest.mark.speed
def test_first_page_under_one_second(browser: Any, served: Any, signed_in: Any) -> None:
    """From an empty cache to the numbers of the first body ; the limit is 1 s at the pace of the machine."""
    seconds: list[float] = []
    for _ in range(3):
        started = time.perf_counter()
        context = browser.new_context(storage_state=signed_in)
        page = context.new_page()
        page.goto(served.url)
        page.get_by_test_id("facts-table").wait_for()
        seconds.append(time.perf_counter() - started)
        context.close()
    assert min(seconds) < allowed(1.0), seconds


LEAVE = """async () => {
  localStorage.left = sessionStorage.left = document.cookie = "left=1";
  await new Promise((done) => { indexedDB.open("left").onsuccess = done; });
  await caches.open("left");
}"""
LEFT = """async () => [document.cookie.includes("left"), "left" in localStorage, "left" in sessionStorage,
  (await indexedDB.databases()).length > 0, await caches.has("left")]"""
FROM_SERVER = """() => performance.getEntriesByType("resource").filter((file) => /[.](m?js|css)$/.test(file.name))
  .map((file) => file.transferSize > 0)"""


def test_no_test_sees_the_storage_of_another(contexts: Any, served: Any) -> None:
    """A context given back is lent again without what was stored in it; files of the page come from its cache.

    Control: before the context is given back, all of it is there; the first page has its files from the server.
    """

    def opened() -> Any:
        page = contexts.new_page(locale="fr-CH")
        page.goto(served.url)
        page.get_by_test_id("facts-table").wait_for()
        return page

    first = opened()
    asked = first.evaluate(FROM_SERVER)
    assert len(asked) > 80
    assert all(asked)
    first.evaluate(LEAVE)
    assert first.evaluate(LEFT) == [True] * 5
    contexts.give_back()
    again = opened()
    assert again.context is first.context
    assert again.evaluate(LEFT) == [False] * 5
    assert not any(again.evaluate(FROM_SERVER))
    contexts.give_back()


BEYOND = """() => [
  document.documentElement.scrollWidth - innerWidth,
  ...[...document.querySelectorAll('[role=tab][data-view], h1, h2')].filter((each) => each.checkVisibility())
    .map((each) => each.scrollWidth - each.clientWidth - 3),
].filter((each) => each > 0)"""


@pytest.mark.parametrize("width", [390, 1024])
def test_letters_twice_as_large(open_page: Callable[..., Any], shot: Callable[..., Any], width: int) -> None:
    """By a style of the reader's own: in no step is anything beyond the page, nor a title or a step beyond its place.

    Control: in a place of half of its width the title is.
    """
    page = open_page(link(), viewport={"width": width, "height": 900})
    page.evaluate("""() => {
      const own = new CSSStyleSheet();
      own.replaceSync("html { font-size: 200% }");
      document.adoptedStyleSheets = [...document.adoptedStyleSheets, own];
    }""")
    for step in page.locator("[role=tab][data-view]").evaluate_all("tabs => tabs.map(tab => tab.dataset.view)"):
        page.locator(f"#tab-{step}").evaluate("tab => tab.click()")
        page.wait_for_selector(f"#view-{step}[data-ready=true]")
        page.wait_for_load_state("networkidle")
        assert page.evaluate(BEYOND) == [], step
    shot(page, f"large letters {width}")
    title = page.locator("section:not([hidden]) > .view-head h1").first
    title.evaluate("node => Object.assign(node.style, { width: '2rem', overflowWrap: 'normal' })")
    assert page.evaluate(BEYOND)


def test_every_module_of_the_first_page_is_preloaded() -> None:
    """The list in index.html is the closure of what main.js and views/body.js import: no wait for a late module."""
    wanted: set[str] = set()
    waiting = ["/app/main.js", "/views/body.js"]
    while waiting:
        name = waiting.pop()
        if name not in wanted:
            wanted.add(name)
            waiting += re.findall(r'from "(/[^"]+)"', (STATIC / name[1:]).read_text(encoding="utf-8"))
    page = (STATIC / "index.html").read_text(encoding="utf-8")
    assert set(re.findall(r'rel="modulepreload" href="([^"]+)"', page)) == wanted


def test_no_script_parses_markup_or_text() -> None:
    """No module writes HTML from text or runs text as a program."""
    forbidden = re.compile(r"innerHTML|outerHTML|insertAdjacentHTML|\beval\(|new Function|document\.write")
    ours = [path for path in STATIC.rglob("*.js") if "vendor" not in path.parts]
    assert len(ours) > 30
    assert [path.name for path in ours if forbidden.search(path.read_text(encoding="utf-8"))] == []
    assert forbidden.search("node.innerHTML = name")


def test_theme_is_kept_and_follows_the_system(open_page: Callable[..., Any], shot: Callable[..., Any]) -> None:
    """Dark by the system, light by the button, and light again after a reload."""
    page = open_page(color_scheme="dark")

    def theme() -> Any:
        return page.evaluate("document.documentElement.dataset.theme")

    assert theme() == "dark"
    page.get_by_test_id("facts-table").wait_for()
    shot(page, "body-dark")
    page.get_by_role("button", name="Switch between light and dark").click()
    assert theme() == "light"
    page.reload()
    page.get_by_test_id("facts-table").wait_for()
    assert theme() == "light"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_contrast_is_aa(open_page: Callable[..., Any], scheme: str) -> None:
    """Words on their ground reach 4.5 to 1 in both themes, and a grey on grey is found out."""
    page = open_page(color_scheme=scheme)
    grounds = {
        "--surface": ["--ink", "--ink-soft", "--accent", "--error"],
        "--paper": ["--ink", "--ink-soft"],
        "--surface-2": ["--ink-soft"],
        "--accent": ["--accent-ink"],
        **{f"--{kind}-soft": [f"--{kind}"] for kind in ("accent", "good", "warning", "error")},
    }
    pairs = [(ink, ground) for ground, inks in grounds.items() for ink in inks]
    read = "name => getComputedStyle(document.documentElement).getPropertyValue(name)"
    ratios = {pair: _contrast(*(page.evaluate(read, name) for name in pair)) for pair in pairs}
    assert min(ratios.values()) >= 4.5, ratios
    assert _contrast("#8a8a8a", "#b0b0b0") < 4.5
    assert _contrast("#000000", "#ffffff") == pytest.approx(21.0)


def _contrast(first: str, second: str) -> float:
    """Return the contrast ratio of WCAG 2.2."""
    light, dark = sorted((_luminance(first), _luminance(second)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def _luminance(colour: str) -> float:
    parts = [int(colour.strip()[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    red, green, blue = (each / 12.92 if each <= 0.04045 else ((each + 0.055) / 1.055) ** 2.4 for each in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def test_numbers_are_written_and_read_as_people_do(page: Any) -> None:
    """A real minus, thin spaces, powers of ten out; decimal commas in; words are refused."""
    found = page.evaluate(
        """async () => {
          const { number, parseNumber, quantity } = await import('/app/format.js');
          return [number(-0.5), number(12345.6, 6), number(1.25e-7), number(2e9), number(0), number(null),
            number(NaN), quantity(9.81, 'm/s2'), parseNumber('1,5'), parseNumber('\u22122.5e-3'),
            parseNumber('1.5 m'), parseNumber(''),
            parseNumber('1e999')];
        }"""
    )
    assert found == [
        "\u22120.5", "12\u202f345.6", "1.25\u00d710\u207b\u2077", "2\u00d710\u2079", "0", "\u2013", "\u2013",
        "9.81\u00a0m/s\u00b2", 1.5, -0.0025, None, None, None,
    ]  # fmt: skip


def test_copied_cells_cannot_be_formulas(page: Any) -> None:
    """Text that a spreadsheet would run gets an apostrophe; numbers keep every digit."""
    text = page.evaluate(
        """import('/app/copy.js').then(({ asText }) => asText(
          [{ label: 'Name' }, { label: 'x', unit: 'm' }],
          [['=cmd|calc', 0.1 + 0.2], ['+1+1', -1.5], ['@sum', null], ['plain', 1e-300]]))"""
    )
    assert text.split("\r\n") == [
        "Name\tx [m]", "'=cmd|calc\t0.30000000000000004", "'+1+1\t-1.5", "'@sum\t", "plain\t1e-300",
    ]  # fmt: skip


def test_only_the_newest_call_follows_the_one_in_flight(page: Any) -> None:
    """Of twenty slider calls at once two reach the server: the first and the last."""
    counted: list[Any] = []
    page.route("**/api/body", lambda route: (counted.append(route.request.post_data_json), route.continue_()))
    outcome = page.evaluate(
        """async () => {
          const { latest } = await import('/app/api.js');
          const calls = Array.from({ length: 20 }, (_, k) =>
            latest('probe', 'body', { body: { units: 'm', width: 1 + k, height: 4 } })
              .then(() => k, (error) => error.name));
          return Promise.all(calls);
        }"""
    )
    assert outcome == [0, *["AbortError"] * 18, 19]
    assert [each["body"]["width"] for each in counted] == [1, 20]


def _check_vector(page: Any, folder: Path) -> None:
    """The SVG of the chart has its curves where its axes say, with gaps, dashes and words; the PNG is twice as wide."""
    saved_as = {}
    for kind in ("SVG", "PNG", "CSV"):
        download = saved(page, kind, "chart Probe")
        saved_as[kind] = folder / download.suggested_filename
        download.save_as(saved_as[kind])
    assert [path.name for path in saved_as.values()] == ["probe.svg", "probe.png", "probe.csv"]
    rows = saved_as["CSV"].read_text(encoding="utf-8").splitlines()
    assert rows == ['"time [s]","first [rad]","second [rad]"', "0,0,0", "1,2,", "2,-1,1", "3,0,1.5"]
    root = ET.parse(saved_as["SVG"]).getroot()
    named = {element.tag.removeprefix("{http://www.w3.org/2000/svg}") for element in root.iter()}
    assert named == {"svg", "title", "desc", "rect", "text", "g", "line", "clipPath", "path"}
    words = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
    assert {"Probe", "first", "second", "time [s]", "angle [rad]"} <= set(words)
    paths = [path.attrib for path in root.iter("{http://www.w3.org/2000/svg}path")]
    first, second = (path for path in paths if path.get("stroke-width") == "1.6")  # axes and marks are thinner
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = ((float(a) for a in one.split()) for one in first["d"][1:].split("L"))
    assert x1 - x0 == pytest.approx(x3 - x2, abs=0.02)
    assert y3 == y0
    assert y0 - y1 == pytest.approx(2.0 * (y2 - y0), abs=0.05)  # the values are 0, 2, -1, 0
    assert second["d"].count("M") == 2  # a value is missing in between
    assert second["stroke-dasharray"] == "4 2"
    drawn = image.imread(saved_as["PNG"])
    assert drawn.shape[1] == 2 * int(root.attrib["width"])
    assert len(np.unique(drawn.reshape(-1, drawn.shape[2]), axis=0)) > 20


def test_a_chart_is_words_and_table_too(page: Any, tmp_path: Path) -> None:
    """A line chart says its range to a screen reader, shows a table on request, and saves itself as PNG."""
    page.evaluate(
        """async () => {
          const { lineChart } = await import('/charts/line.js');
          const box = document.createElement('div');
          document.querySelector('#view-body').prepend(box);
          const chart = lineChart(box, { title: 'Probe',
            x: { label: 'time', unit: 's' }, y: { label: 'angle', unit: 'rad' },
            series: [{ label: 'first', colour: '#0070B2' }, { label: 'second', colour: '--accent', dash: [4, 2] }] });
          chart.setData([[0, 1, 2, 3], [0, 2, -1, 0], [0, null, 1, 1.5]]);
          chart.setMarks({ vertical: [1.5], horizontal: [1, -1] });
          window.probe = chart;
        }"""
    )
    stage = page.locator(".chart-stage").first
    words = stage.get_attribute("aria-label")
    assert "Probe, over time from 0 to 3 s" in words
    assert "first from \u22121 to 2 rad" in words
    assert "second from 0 to 1.5 rad" in words
    assert page.locator(".chart .legend path").nth(1).get_attribute("stroke-dasharray") == "4 2"
    assert page.locator(".chart .legend path").nth(0).get_attribute("stroke-dasharray") is None
    page.get_by_text("Show as table of Probe").click()
    expect(page.locator(".chart-table tbody tr")).to_have_count(4)
    _check_vector(page, tmp_path)
    page.get_by_role("button", name="Switch between light and dark").click()
    page.evaluate("window.probe.destroy()")
    assert page.locator(".chart").count() == 0


def test_the_skip_link_stays_in_the_view(page: Any, calm: Callable[[Any], None]) -> None:
    """Skip to the content, pressed in Impact, moves the focus and nothing else."""
    page.locator("#tab-impact").click()
    page.get_by_test_id("ledger").wait_for()
    page.locator(".skip").focus()
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"
    calm(page)
    assert page.locator("#view-impact").is_visible()
    assert page.locator("#view-body").is_hidden()


@pytest.mark.parametrize("text", ["abc", "1.000,5", "0"])
def test_a_field_in_error_stops_downloads_and_dims_results(page: Any, text: str) -> None:
    """Nothing is saved of inputs that are not those on the screen; every view names the field."""
    page.get_by_test_id("facts-table").wait_for()
    page.locator("#view-body").get_by_label("Width").fill(text)
    expect(page.locator(".card.stale")).to_have_count(2)
    saved: list[str] = []
    page.on("download", lambda file: saved.append(file.suggested_filename))
    page.get_by_role("button", name="as CSV").first.click()
    expect(page.locator("#status")).to_contain_text("Not saved")
    expect(page.locator("#status")).to_contain_text("Width")
    page.locator("#tab-impact").click()
    expect(page.get_by_test_id("summary-faults")).to_contain_text("Width")
    expect(page.get_by_test_id("impact-results")).to_have_class(re.compile("stale"))
    for step, dimmed in (("response", ".verdict-part"), ("compare", ".compare")):
        page.locator(f"#tab-{step}").click()
        view = page.locator(f"#view-{step}")
        expect(view.locator(dimmed)).to_have_class(re.compile("stale"))
        expect(view.get_by_text("belong to the last valid inputs")).to_contain_text("Width")
    assert saved == []
    page.locator("#tab-body").click()
    page.locator("#view-body").get_by_label("Width").fill("0.6")
    expect(page.locator(".card.stale")).to_have_count(0)
    with page.expect_download():
        page.get_by_role("button", name="as CSV").first.click()


def test_a_field_that_was_left_behind_stops_nothing(page: Any) -> None:
    """The wrong width of a block is forgotten with the block."""
    page.locator("#view-body").get_by_label("Width").fill("abc")
    expect(page.locator(".card.stale")).to_have_count(2)
    page.get_by_label("Shape").select_option("regular_polygon")
    expect(page.locator(".card.stale")).to_have_count(0)


def test_a_view_that_did_not_come_is_asked_for_again(browser: Any, served: Any, signed_in: Any) -> None:
    """A module that fails while the server is down is loaded when the view is next shown."""
    context = browser.new_context(storage_state=signed_in)
    page = context.new_page()
    page.goto(served.url)
    page.get_by_test_id("facts-table").wait_for()
    page.route("**/views/impact.js", lambda route: route.abort())
    page.locator("#tab-impact").click()
    page.get_by_text("did not send this view").wait_for()
    expect(page.get_by_role("button", name="Reload the page")).to_be_visible()
    page.unroute("**/views/impact.js")
    page.locator("#tab-body").click()
    page.locator("#tab-impact").click()
    page.get_by_test_id("ledger").wait_for()
    context.close()


def test_a_server_that_comes_back_is_asked_again(browser: Any, served: Any, signed_in: Any) -> None:
    """Numbers that could not be had while the server was away come by themselves once it answers."""
    context = browser.new_context(storage_state=signed_in)
    page = context.new_page()
    page.goto(served.url)
    page.get_by_test_id("facts-table").wait_for()
    page.route("**/api/**", lambda route: route.abort())
    page.locator("#view-body").get_by_label("Width").fill("0.75")
    expect(page.get_by_test_id("body-refusal")).to_contain_text("does not respond")
    page.unroute("**/api/**")
    expect(page.get_by_test_id("facts-table")).to_contain_text("2.6667")
    expect(page.get_by_test_id("body-refusal")).to_be_empty()
    context.close()


def test_a_step_chosen_while_the_page_still_starts_is_taken(open_page: Callable[..., Any]) -> None:
    """On a slow machine a click on a step waits for the application; it is never swallowed."""
    page = open_page()
    second = "new Promise((go) => setTimeout(go, 1000))"
    page.add_init_script(f"const soon = fetch; window.fetch = (...all) => {second}.then(() => soon(...all));")
    page.reload()
    page.get_by_role("tab", name="Impact").click()
    expect(page.locator("#view-impact")).to_be_visible()


def test_a_step_on_its_way_holds_up_no_other(
    page: Any, until: Callable[..., None], calm: Callable[[Any], None]
) -> None:
    """Another step opens while one is still loading; that one is not told that it is shown when it comes too late."""
    held: list[Any] = []
    lines: list[Any] = []
    page.on("websocket", lambda line: lines.extend([line]))
    page.route("**/views/studies.js", lambda route: held.extend([route]))
    page.locator("#tab-studies").click()
    until(page, lambda: held)
    page.locator("#tab-space").click()
    page.wait_for_selector("#view-space[data-ready=true]:not([hidden])")
    held[0].continue_()
    page.wait_for_selector("#view-studies[data-ready=true]", state="attached")
    calm(page)
    assert not lines  # of the studies as they go on, which nobody looks at
    page.locator("#tab-studies").click()
    until(page, lambda: lines)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ({"status": 500, "json": {"error": {"kind": "internal", "message": "internal error"}}}, "nternal error"),
        ({"status": 429, "json": {"error": {"kind": "busy", "message": "too much at once; try again"}}}, "at once"),
        (None, "The server does not respond"),
    ],
)
def test_a_start_that_fails_says_what_failed(
    browser: Any, served: Any, signed_in: Any, answer: Any, words: str, shot: Callable[..., Any]
) -> None:
    """A user who is signed in is told what went wrong and tries again; nobody asks for a link of the terminal."""
    context = browser.new_context(storage_state=signed_in)
    page = context.new_page()
    page.route("**/api/info", lambda route: route.fulfill(**answer) if answer else route.abort())
    page.goto(f"{served.url}/#view=impact")
    failure = page.get_by_test_id("failure")
    expect(failure).to_contain_text(words)
    expect(page.get_by_test_id("door")).to_have_count(0)
    shot(page, f"start-failed-{(answer or {}).get('status', 0)}")
    page.unroute("**/api/info")
    failure.get_by_role("button", name="Try again").click()
    page.wait_for_selector("#view-impact[data-ready=true]:not([hidden])")
    context.close()
