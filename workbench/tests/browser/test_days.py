"""A day of an engineer, a conservator and a lecturer: from an empty folder to a report, by the keyboard alone."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from browser_pages import scan
from playwright.sync_api import expect

from rocking import examples

MOUSE = """() => {
  window.mouse = [];
  for (const kind of ["mousedown", "pointerdown", "mousemove"])
    addEventListener(kind, (event) => event.isTrusted && mouse.push(kind), true);
}"""
FOCUS = """() => {
  const node = document.activeElement;
  const ids = (node.getAttribute("aria-labelledby") ?? "").split(" ");
  const label = ids.map((id) => document.getElementById(id)?.textContent).join(" ").trim();
  const name = node.getAttribute("aria-label") ?? (label || node.labels?.[0]?.textContent || node.textContent);
  const told = `${name.replace(/\\s+/g, " ").trim().slice(0, 120)} #${node.id} [${node.dataset.testid ?? ""}]`;
  if (node === document.body) return { told: "", fault: "" };
  const dotsOf = (paint) => {
    const canvas = new OffscreenCanvas(1, 1).getContext("2d");
    canvas.fillStyle = paint;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data];
  };
  const light = (paint) => {
    const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    const [r, g, b] = dotsOf(paint).map((part) => linear(part / 255));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const groundOf = (one) => {
    for (let each = one.parentElement; each; each = each.parentElement) {
      const paint = getComputedStyle(each).backgroundColor;
      if (dotsOf(paint)[3] === 255) return paint;
    }
    return "white";
  };
  const marks = [node, node.nextElementSibling, node.closest("label"), node.querySelector?.(".reach")].filter(Boolean);
  const best = Math.max(...marks.map((one) => {
    const { outlineStyle, outlineWidth, outlineColor, stroke, strokeWidth } = getComputedStyle(one);
    const ring = outlineStyle !== "none" && parseFloat(outlineWidth) >= 2;
    const line = one.matches(".reach") && parseFloat(strokeWidth) >= 2;
    if (!ring && !line) return 0;
    const both = [light(ring ? outlineColor : stroke), light(groundOf(one))].sort((a, b) => b - a);
    return (both[0] + 0.05) / (both[1] + 0.05);
  }));
  const seen = marks.some((one) => {
    const box = one.getBoundingClientRect();
    const wide = box.width > 1 && box.height > 1;
    return wide && box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth;
  });
  const fault = !seen ? "cannot be seen" : best < 3 ? `is marked with a contrast of ${best.toFixed(2)}` : "";
  return { told, fault };
}"""
MOST = 300


class Hands:
    """A user with a keyboard: goes from stop to stop, and minds each that is not seen."""

    def __init__(self, page: Any) -> None:
        self.page = page
        self.faults: list[str] = []
        self.stops: set[str] = set()
        page.on("filechooser", lambda _: None)  # from now on no dialog of the system opens

    def press(self, *keys: str) -> None:
        """Press keys one after another."""
        for key in keys:
            self.page.keyboard.press(key)

    def write(self, text: str) -> None:
        """Write over what is in a field."""
        self.press("Control+a")
        self.page.keyboard.type(text)

    def look(self) -> str:
        """Return what has the focus; note it if that cannot be seen."""
        found = self.page.evaluate(FOCUS)
        if found["fault"]:
            self.faults.append(f"{found['told']} {found['fault']}")
        self.stops.add(found["told"])
        told: str = found["told"]
        return told

    def to(self, words: str, *, back: bool = False) -> None:
        """Go by Tab, or back by Shift and Tab, to what is called so."""
        before, passed = None, []
        for _ in range(MOST):
            self.press("Shift+Tab" if back else "Tab")
            told = self.look()
            node = self.page.evaluate_handle("document.activeElement")
            stuck = before is not None and node.evaluate("(node, other) => node === other", before)
            assert not stuck, f"the focus stays at {told}"
            before = node
            if words in told:
                return
            passed.append(told)
        pytest.fail(f"no way to {words!r}: {passed[:80]}")

    def step(self, name: str) -> None:
        """Show a step by the arrow keys of the tabs."""
        chosen = self.page.locator("[role=tab][aria-selected=true]").get_attribute("id")
        self.to(f"#{chosen} ", back=True)
        for _ in range(12):
            if self.page.locator(f"#tab-{name}").get_attribute("aria-selected") == "true":
                break
            self.press("ArrowRight")
            self.look()
        self.page.wait_for_selector(f"#view-{name}[data-ready=true]:not([hidden])")

    def ask(self, step: str) -> Any:
        """Press Compute and wait for the answer."""
        self.to("Compute #")
        self.press("Enter")
        outcome = self.page.locator(f"#view-{step}").get_by_test_id("outcome")
        expect(outcome).not_to_have_attribute("data-state", re.compile("waiting|running"))
        expect(outcome).to_have_attribute("data-state", "done")
        return outcome

    def choose(self, words: str, path: Path) -> None:
        """Choose a file in the dialog of the system that a button opens."""
        self.to(words)
        with self.page.expect_file_chooser() as chooser:
            self.press("Enter")
        chooser.value.set_files(path)
        expect(self.page.get_by_role("list", name="Files").last).to_contain_text(path.name.replace(" ", "-"))

    def save(self, words: str, folder: Path) -> bytes:
        """Save a file by a button; returns what is in it."""
        self.to(words)
        with self.page.expect_download() as waiting:
            self.press("Enter")
        waiting.value.save_as(folder / "saved")
        return (folder / "saved").read_bytes()


@pytest.fixture
def hands(browser: Any, own: Any, record: Any) -> Iterator[Hands]:
    """Open the page of a server with an empty folder; in the end no mouse was used and every stop was seen."""
    context = browser.new_context(viewport={"width": 1360, "height": 900})
    context.add_init_script(f"({MOUSE})()")
    page = context.new_page()
    record.watch(page, own.told["url"].rstrip("/"))
    page.goto(f"{own.told['url']}#token={own.told['token']}")
    page.get_by_test_id("facts-table").wait_for()
    user = Hands(page)
    yield user
    assert page.evaluate("mouse") == []
    assert len(user.stops) > 40
    assert user.faults == []
    context.close()


@pytest.mark.walk
def test_an_engineer(hands: Hands, tmp_path: Path) -> None:
    """Past the menu, a project named, a body and a motion, a map walked, and the report of whether it stands."""
    page = hands.page
    hands.to("Skip to the content")
    hands.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"
    hands.to("[project]", back=True)
    hands.press("Enter")
    page.locator("dialog[open]").wait_for()
    hands.to("Name of the open project")
    hands.write("Pump hall")
    hands.to("Rename")
    hands.press("Enter")
    expect(page.get_by_test_id("project")).to_contain_text("Pump hall")
    hands.press("Escape")
    expect(page.get_by_test_id("project")).to_be_focused()
    hands.to("Width")
    hands.write("0.6")
    hands.to("Height")
    hands.write("2.4")
    hands.step("motion")
    hands.to("exactly")
    hands.write("4.5")
    hands.step("response")
    page.locator(".response-results[data-drawn]").wait_for()
    hands.step("studies")
    for _ in range(2):
        hands.to("number #")
        hands.write("6")
    hands.to("Launch #")
    hands.press("Enter")
    page.get_by_test_id("map-canvas").wait_for()
    hands.to("[map-canvas]")
    hands.press("ArrowRight", "ArrowUp", "+", "0")
    expect(page.get_by_test_id("map-told")).to_contain_text(" = ")
    hands.step("decide")
    hands.to("Author")
    hands.write("E. Ngineer")
    outcome = hands.ask("decide")
    assert hands.save("Report (PDF)", tmp_path).startswith(b"%PDF")
    expect(outcome.get_by_test_id("verdict")).to_be_visible()


def test_a_conservator(hands: Hands, tmp_path: Path) -> None:
    """A list of objects with its lights, a scan set down and turned, a row of it taken away, and a report."""
    page = hands.page
    hands.step("inventory")
    hands.choose("Choose a file", examples.path("objects"))
    hands.to("Number of motions")
    hands.write("10")
    outcome = hands.ask("inventory")
    expect(outcome.get_by_test_id("verdict")).to_contain_text("not assessed")
    hands.step("space")
    hands.choose("Choose a file", scan(tmp_path, hole=True))
    hands.to("Unit of the file")
    hands.press("ArrowDown")
    expect(page.locator("#view-space").get_by_label("Unit of the file")).to_have_value("mm")
    hands.ask("space")
    page.get_by_test_id("space-stage").wait_for()
    hands.to("[space-stage]")
    hands.press("ArrowLeft", "+")
    hands.to("Stable pose")
    hands.press("ArrowDown")
    hands.step("takeaway")
    assert hands.save("[take-report]", tmp_path).startswith(b"%PDF")


def test_a_lecturer(hands: Hands, until: Callable[..., None], tmp_path: Path) -> None:
    """In the dark and in German: the impact, the motion played and stopped, the models compared, and the report."""
    page = hands.page
    hands.to("#theme ")
    hands.press("Enter")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    hands.to("#language ", back=True)
    with page.expect_navigation():
        page.keyboard.type("D")
    page.get_by_test_id("facts-table").wait_for()
    assert page.evaluate("document.documentElement.lang") == "de"
    hands.step("impact")
    page.get_by_test_id("ledger").wait_for()
    hands.step("response")
    page.locator(".response-results[data-drawn]").wait_for()
    hands.to("[scene-stage]")
    hands.press("Space")
    until(page, lambda: page.evaluate("rockingFrames.count") > 5)
    hands.press("Space", "End")
    hands.step("compare")
    page.get_by_test_id("compare-verdict").wait_for()
    hands.step("takeaway")
    assert hands.save("[take-report]", tmp_path).startswith(b"%PDF")


def test_a_focus_that_is_not_seen_is_minded(page: Any) -> None:
    """Negative control: without the ring around what has the focus, every stop is a fault."""
    user = Hands(page)
    user.to("Height")
    assert user.faults == []
    page.evaluate("""() => {
      const sheet = new CSSStyleSheet();
      sheet.replaceSync("*:focus-visible { outline-color: #eee !important }");
      document.adoptedStyleSheets = [sheet];
    }""")  # fmt: skip
    user.to("Name")
    assert user.faults
