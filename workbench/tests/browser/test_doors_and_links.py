"""Signing in, and links that carry the inputs."""

import base64
import json
import re
from collections.abc import Callable
from typing import Any

import pytest

expect = pytest.importorskip("playwright.sync_api").expect


def link_of(inputs: dict[str, Any], view: str = "body") -> str:
    """Return the fragment of a permanent link, made here and not by the page."""
    text = base64.urlsafe_b64encode(json.dumps(inputs).encode()).decode().rstrip("=")
    return f"in={text}&view={view}"


def test_a_used_token_opens_no_door(browser: Any, served: Any, signed_in: Any) -> None:
    """The one-time link works once; a second browser is asked for a link and sees no inputs."""
    page = browser.new_page()
    page.goto(f"{served.url}/#token={served.token}")
    page.get_by_test_id("door").wait_for()
    assert page.get_by_label("Shape").count() == 0
    assert served.token not in page.url
    page.close()


def test_the_permanent_link_carries_every_input(open_page: Callable[..., Any]) -> None:
    """A link made outside the page opens with its inputs, and the page's own link opens the same again."""
    inputs = {
        "body": {"units": "cm", "width": 31.25, "height": 140, "name": "Vase \u00fc\u6f22"},
        "restitution": {"value": 0.875},
    }
    page = open_page(link_of(inputs))
    assert page.locator("#view-body").get_by_label("Width").input_value() == "31.25"
    assert page.get_by_label("Name").input_value() == "Vase \u00fc\u6f22"
    page.get_by_label("Height").fill("155,5")
    page.get_by_test_id("facts-table").wait_for()
    link = page.evaluate("import('/app/inputs.js').then(m => m.encode(JSON.parse(sessionStorage['rocking.inputs'])))")
    again = open_page(f"in={link}")
    assert again.get_by_label("Height").input_value() == "155.5"
    assert again.locator("#view-body").get_by_label("Width").input_value() == "31.25"


def test_a_broken_link_says_so_and_starts_as_usual(open_page: Callable[..., Any]) -> None:
    """A link cut in two leaves a sentence and the usual body, not an error."""
    page = open_page("in=eyJib2R5Ijp7&view=body")
    assert "no readable inputs" in page.locator("#status").inner_text()
    assert page.locator("#view-body").get_by_label("Width").input_value() == "0.5"


def test_a_link_pasted_into_the_open_tab_is_followed(page: Any, served: Any) -> None:
    """On another view, the link's inputs and view are taken; the address keeps the view alone."""
    page.locator("#tab-impact").click()
    page.get_by_test_id("ledger").wait_for()
    page.goto(f"{served.url}/#{link_of({'body': {'units': 'cm', 'width': 31.25, 'height': 140}}, 'body')}")
    expect(page.locator("#view-body").get_by_label("Width")).to_have_value("31.25")
    assert page.locator("#tab-body").get_attribute("aria-selected") == "true"
    assert page.url == f"{served.url}/#view=body"
    page.go_back()
    expect(page.locator("#view-impact")).to_be_visible()
    assert page.evaluate("JSON.parse(sessionStorage['rocking.inputs']).body.width") == 31.25


def test_edits_after_a_link_outlast_a_reload(open_page: Callable[..., Any]) -> None:
    """What was typed after a link was opened is there after a reload, not the link's number."""
    page = open_page(link_of({"body": {"units": "m", "width": 1, "height": 4}}))
    page.locator("#view-body").get_by_label("Width").fill("1.005")
    page.get_by_test_id("facts-table").wait_for()
    page.reload()
    expect(page.locator("#view-body").get_by_label("Width")).to_have_value("1.005")
    expect(page.get_by_label("Height")).to_have_value("4")


def test_a_new_link_signs_an_open_tab_in_again(open_page: Callable[..., Any], served: Any) -> None:
    """A session that ended asks for a link over the page; the link opened in that tab lets the work go on."""
    page = open_page()
    page.get_by_test_id("facts-table").wait_for()
    page.context.clear_cookies()
    page.locator("#view-body").get_by_label("Width").fill("0.75")
    door = page.get_by_role("dialog", name="Sign in again")
    door.wait_for()
    assert "Authorization" not in page.locator("body").inner_text()
    page.goto(served.api("session/link")["url"])
    expect(door).to_have_count(0)
    expect(page.locator("#view-body").get_by_label("Width")).to_have_value("0.75")
    expect(page.get_by_test_id("facts-table")).to_contain_text("2.6667")
    assert "token" not in page.url


def test_a_call_refused_before_the_sign_in_is_repeated(
    open_page: Callable[..., Any], served: Any, until: Callable[..., None]
) -> None:
    """The refusal of a call that was sent without the cookie arrives after the sign-in: no second dialog."""
    page = open_page()
    page.get_by_test_id("facts-table").wait_for()
    page.context.clear_cookies()
    refused: list[Any] = []
    page.route("**/api/questions", lambda route: refused.append((route, route.fetch())), times=1)
    page.evaluate("() => void (window.late = import('/app/api.js').then((api) => api.call('questions')))")
    page.locator("#view-body").get_by_label("Width").fill("0.75")
    door = page.get_by_role("dialog", name="Sign in again")
    door.wait_for()
    until(page, lambda: refused)
    assert [answer.status for _, answer in refused] == [401]
    page.goto(served.api("session/link")["url"])
    expect(door).to_have_count(0)
    route, answer = refused[0]
    route.fulfill(response=answer)
    assert page.evaluate("window.late.then((answer) => answer.questions)") == []
    expect(door).to_have_count(0)


def test_a_refusal_read_after_the_sign_in_opens_no_second_dialog(
    open_page: Callable[..., Any], served: Any, until: Callable[..., None]
) -> None:
    """The status of a refusal arrives before the sign-in and its content after it: the call is repeated."""
    page = open_page()
    page.get_by_test_id("facts-table").wait_for()
    page.evaluate("""() => {
      const read = Response.prototype.json;
      Response.prototype.json = function () {
        if (!this.url.endsWith('/api/questions') || this.status !== 401) return read.call(this);
        return new Promise((resolve) => (window.arrive = resolve)).then(() => read.call(this));
      };
    }""")
    page.context.clear_cookies()
    page.evaluate("() => void (window.late = import('/app/api.js').then((api) => api.call('questions')))")
    until(page, lambda: page.evaluate("window.arrive !== undefined"))
    page.locator("#view-body").get_by_label("Width").fill("0.75")
    door = page.get_by_role("dialog", name="Sign in again")
    door.wait_for()
    page.goto(served.api("session/link")["url"])
    expect(door).to_have_count(0)
    page.evaluate("window.arrive()")
    assert page.evaluate("window.late.then((answer) => answer.questions)") == []
    expect(door).to_have_count(0)


def test_a_refused_call_keeps_the_message_of_the_dialog(open_page: Callable[..., Any], served: Any) -> None:
    """A call that is refused while the dialog shows that a link is wrong does not remove this message."""
    page = open_page()
    page.get_by_test_id("facts-table").wait_for()
    page.context.clear_cookies()
    page.get_by_label("Height").fill("3")
    door = page.get_by_role("dialog", name="Sign in again")
    door.get_by_label("Link or token").fill(f"{served.url}/#token=nothing")
    door.get_by_role("button", name="Sign in").click()
    door.get_by_text("wrong, used up or too old").wait_for()
    refused = "import('/app/api.js').then((api) => api.call('questions')).catch((error) => error.status)"
    assert page.evaluate(refused) == 401
    expect(door).to_contain_text("wrong, used up or too old")


def test_the_door_of_an_open_tab_takes_a_pasted_link(open_page: Callable[..., Any], served: Any) -> None:
    """A wrong link is refused in words and may be corrected on the spot."""
    page = open_page()
    page.get_by_test_id("facts-table").wait_for()
    page.context.clear_cookies()
    page.get_by_label("Height").fill("3")
    door = page.get_by_role("dialog", name="Sign in again")
    door.get_by_label("Link or token").fill(f"{served.url}/#token=nothing")
    door.get_by_role("button", name="Sign in").click()
    door.get_by_text("wrong, used up or too old").wait_for()
    door.get_by_label("Link or token").fill(served.api("session/link")["url"])
    page.keyboard.press("Enter")
    expect(door).to_have_count(0)
    expect(page.get_by_test_id("facts-table")).to_contain_text("1.5207")


def test_the_door_keeps_the_link_that_led_to_it(browser: Any, served: Any, signed_in: Any) -> None:
    """A colleague who opens a permanent link first and signs in then sees its view with its inputs."""
    page = browser.new_page()
    page.goto(f"{served.url}/#{link_of({'body': {'units': 'cm', 'width': 42, 'height': 168}}, 'impact')}")
    page.get_by_label("Link or token").fill(served.api("session/link")["url"])
    page.get_by_role("button", name="Sign in").click()
    page.get_by_test_id("ledger").wait_for()
    page.locator("#tab-body").click()
    expect(page.locator("#view-body").get_by_label("Width")).to_have_value("42")
    page.close()


def test_a_signed_in_browser_lets_another_in(page: Any, browser: Any) -> None:
    """The button at the foot shows a link; another browser opens it and is in."""
    page.get_by_role("button", name="Link for another browser").click()
    link = page.get_by_label("Sign-in link for another browser").input_value()
    other = browser.new_page()
    other.goto(link)
    other.get_by_test_id("facts-table").wait_for()
    other.close()
    page.get_by_role("button", name="Close").click()
    expect(page.get_by_role("dialog")).to_have_count(0)


@pytest.mark.parametrize(
    "wrong",
    [
        {"motion": 5}, {"motion": {"pulse": 3}}, {"motion": {}}, {"restitution": []},
        {"restitution": {"models": "ked"}}, {"response": 1}, {"settings": "all"}, {"elsewhere": {}},
        {"body": {"units": "m", "width": "x", "height": 1}}, {"body": {"units": "yard", "width": 1, "height": 1}},
        {"body": {"units": "m", "section": {"region": {}}}},
        {"body": {"units": "m", "section": {"region": [{"outline": [1, 2, 3]}]}}},
    ],
    ids=lambda wrong: re.sub(r"\W+", "-", json.dumps(wrong)).strip("-")[:60],
)  # fmt: skip
def test_inputs_of_the_wrong_shape_are_not_taken(open_page: Callable[..., Any], wrong: dict[str, Any]) -> None:
    """A link with a number for a motion, or the like, is refused in words and no view breaks on it."""
    page = open_page(link_of({"body": {"units": "m", "width": 1, "height": 4}, **wrong}, "motion"))
    expect(page.locator("#status")).to_contain_text("no readable inputs")
    assert "Cannot read" not in page.locator("#view-motion").inner_text()


def test_nulls_of_a_link_are_left_out(open_page: Callable[..., Any]) -> None:
    """Absent tables written as null are absent; the other inputs are taken."""
    inputs = {"body": {"units": "m", "width": 1, "height": 4, "depth": None}, "response": None, "motion": None}
    page = open_page(link_of(inputs))
    expect(page.get_by_label("Height")).to_have_value("4")
    assert page.evaluate("JSON.parse(sessionStorage['rocking.inputs'])") == {
        "body": {"units": "m", "width": 1, "height": 4}
    }
