"""What tests of the page share: ``from browser_pages import facts, settled``, ``card, link, response``."""

import base64
import json
import math
import time
from typing import Any

import pytest

from rocking.bodies import Block
from rocking.dynamics import Response, simulate
from rocking.motions.pulses import pulse

PHONE = {"width": 360, "height": 740}
BODY = {"units": "m", "width": 0.5, "height": 2.0}
GENTLE, DECISIVE = "sine:amplitude=3,period=0.8", "cosine:amplitude=7.25,period=0.6"
MODELS = ["ked", "housner"]


def link(motion: str | None = GENTLE, **more: Any) -> str:
    """Return the fragment of a permanent link."""
    inputs = {"body": BODY, "restitution": {"models": MODELS}, **more}
    if motion is not None:
        inputs["motion"] = {"pulse": motion}
    text = base64.urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    return f"in={text}&view=response"


def response(motion: str, restitution: Any) -> Response:
    """Return the response of the same body in Python."""
    return simulate(Block(width=0.5, height=2.0), pulse(motion), restitution)


def card(page: Any, label: str) -> Any:
    """Return the card of a model's outcome."""
    return page.get_by_test_id(f"outcome-{label}")


def saved(page: Any, kind: str, what: str) -> Any:
    """Save "chart Probe", or another figure, by its menu; returns the download."""
    page.get_by_label(f"Save the {what}", exact=True).click()
    with page.expect_download() as waiting:
        page.get_by_role("button", name=f"{kind} of the {what}", exact=True).click()
    return waiting.value


def pasted(page: Any) -> str:
    """Return what a user pastes after copying, once the page says that it has copied."""
    page.get_by_text("paste them into Excel").wait_for()
    page.evaluate("document.body.append(Object.assign(document.createElement('textarea'), { id: 'paste' }))")
    page.locator("#paste").focus()
    page.keyboard.press("Control+V")
    text: str = page.locator("#paste").input_value()
    return text


LEANING = {"units": "m", "trapezoid": {"base": 0.5, "top": 0.3, "height": 1.8, "lean": 0.1}}


def facts(page: Any) -> dict[str, list[str]]:
    """Return the table of numbers with full digits, by quantity and unit."""
    rows = page.evaluate(
        "[...document.querySelectorAll('[data-testid=facts-table] tbody tr')].map("
        "row => [...row.children].map(cell => cell.title || cell.textContent))"
    )
    return {f"{name} {unit}".strip(): values for name, *values, unit in rows}


def number(page: Any, name: str, column: int = 0) -> float:
    """Return one number of the table."""
    return float(facts(page)[name][column])


def settled(page: Any, name: str, expected: float, column: int = 0, rel: float = 1e-9) -> None:
    """Wait until a number of the table is what it must be."""
    deadline = time.monotonic() + 20.0
    seen = math.nan
    while time.monotonic() < deadline:
        found = facts(page).get(name)
        seen = float(found[column]) if found and column < len(found) else math.nan
        if seen == pytest.approx(expected, rel=rel, abs=0.0):
            return
        page.wait_for_timeout(20)
    raise AssertionError(f"{name}: {seen}, expected {expected}")
