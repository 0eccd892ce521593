"""What the page holds does not grow with its use: heap, nodes and listeners after 1,000 interactions as after 200."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from browser_pages import asked_in_space, link, scan

MANY = 1000 if os.environ.get("ROCKING_CAMPAIGN") else 100
SLIDE = """async (share) => {
  const labels = [...document.querySelectorAll("#view-response label")];
  const label = labels.find((one) => one.textContent === "Scale of the motion");
  const slider = document.getElementById(label.htmlFor);
  const results = document.querySelector(".response-results");
  const before = results.dataset.drawn;
  slider.value = String(Number(slider.min) + (slider.max - slider.min) * share);
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  const late = performance.now() + 20000;
  while (results.dataset.drawn === before && performance.now() < late) await new Promise(requestAnimationFrame);
  return results.dataset.drawn !== before;
}"""


def held(page: Any) -> dict[str, float]:
    """Return what a page holds once all that can be forgotten is: used heap [byte], nodes and listeners."""
    page.wait_for_load_state("networkidle")
    session = page.context.new_cdp_session(page)
    looks = []
    for _ in range(3):  # the least of three: what is just being drawn is not held
        page.wait_for_timeout(100)
        session.send("HeapProfiler.collectGarbage")
        counted = session.send("Memory.getDOMCounters")
        heap = session.send("Runtime.getHeapUsage")["usedSize"]
        looks.append({"heap": heap, "nodes": counted["nodes"], "listeners": counted["jsEventListeners"]})
    session.detach()
    return {name: min(look[name] for look in looks) for name in looks[0]}


def opened(page: Any, step: str) -> None:
    """Show a step; what is waited for is not held, as by the handles of `wait_for_selector`."""
    page.locator(f"#tab-{step}").click()
    page.locator(f"#view-{step}[data-ready=true]:not([hidden])").wait_for()


def interactions(page: Any, scanned: bool) -> Iterator[None]:
    """Use the page: each turn is one thing that a user does, and its answer."""
    k = 0
    while True:
        k += 1
        opened(page, "response")
        yield
        assert page.evaluate(SLIDE, 0.2 + 0.6 * (0.618 * k % 1.0))
        yield
        opened(page, "compare")
        page.get_by_test_id("compare-verdict").wait_for()
        yield
        opened(page, "space")
        if scanned:
            page.get_by_test_id("space-stage").wait_for()
        yield
        opened(page, "body")
        page.locator("#view-body").get_by_label("Width", exact=False).first.fill(f"{0.41 + 0.003 * (k % 29):.3f}")
        page.locator("[data-testid=project-saved][data-state=saved]").wait_for()
        yield
        page.get_by_role("button", name="Previous state of the project").click()
        page.locator("[data-testid=project-saved][data-state=saved]").wait_for()
        yield
        for step in ("impact", "motion", "studies", "takeaway"):
            opened(page, step)
            yield


def grown(page: Any, turns: Iterator[None], many: int = MANY) -> dict[str, float]:
    """Use the page so many times; returns by how much what it holds has grown since a fifth of them [-]."""
    seen = []
    for count in range(1, many + 1):
        next(turns)
        if count % (many // 5) == 0:
            seen.append(held(page))
            print(count, seen[-1])
    return {name: seen[-1][name] / seen[0][name] - 1.0 for name in seen[0]}


def test_it_does_not_grow(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Steps, sliders, answers, Compare, In space and undo, again and again: neither nodes nor listeners, nor the heap.

    The heap has the code in it that a browser still compiles of what is used often: it may grow by a tenth, which over
    800 interactions is 1.4 kB each, where one answer that is kept has some 100 kB.
    """
    page = open_page(link())
    opened(page, "space")
    asked_in_space(page, "equilibria", scan(tmp_path, hole=False))
    found = grown(page, interactions(page, scanned=True))
    assert found["nodes"] < 0.02, found
    assert found["listeners"] < 0.02, found
    assert found["heap"] < 0.1, found


def test_what_grows_is_seen(open_page: Callable[..., Any]) -> None:
    """Negative control: a script that keeps nodes and their listeners at every click."""
    page = open_page(link())
    turns = interactions(page, scanned=False)
    grown(page, turns, 10)  # every step has been shown
    page.evaluate("""() => {
      window.kept = [];
      document.addEventListener("click", () => {
        for (let k = 0; k < 600; k += 1) {
          const node = document.createElement("p");
          node.addEventListener("click", () => kept.length);
          kept.push(node);
        }
      });
    }""")
    found = grown(page, turns, 10)
    assert found["nodes"] > 0.3, found
    assert found["listeners"] > 1.0, found
