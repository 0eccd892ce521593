"""Projects in the page: saved by themselves, with a way back, in agreement with other tabs and after a restart."""

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

expect = pytest.importorskip("playwright.sync_api").expect
KILLS = 50 if os.environ.get("ROCKING_CAMPAIGN") else 4


def saved(page: Any) -> None:
    """Wait until all that was typed is on disk."""
    expect(page.get_by_test_id("project-saved")).to_have_text("saved")


def typed(page: Any, label: str, value: str) -> None:
    page.get_by_label(label).fill(value)
    expect(page.get_by_test_id("project-saved")).not_to_have_text("not saved")
    page.wait_for_timeout(450)
    saved(page)


def opened_dialog(page: Any) -> Any:
    page.get_by_test_id("project").click()
    dialog = page.get_by_test_id("projects")
    expect(dialog).to_be_visible()
    return dialog


def test_what_was_typed_is_there_in_another_browser(open_page: Callable[..., Any], served: Any) -> None:
    """No button was pressed: another browser, which knows nothing of the first one, opens what was typed."""
    page = open_page()
    typed(page, "Width", "0.75")
    other = open_page()
    expect(other.get_by_label("Width")).to_have_value("0.75")
    (project,) = served.api("projects", method="GET")["projects"]
    document = served.api(f"projects/{project['id']}", method="GET")["document"]
    assert document["inputs"]["body"]["width"] == 0.75
    states = served.api(f"projects/{project['id']}/history", method="GET")["states"]
    assert [each["description"] for each in states] == ["body", "begun"]


def test_who_leaves_at_once_loses_nothing(
    open_page: Callable[..., Any], served: Any, until: Callable[..., None]
) -> None:
    """What was typed just before the page was left is saved on the way out."""
    page = open_page()
    page.get_by_label("Width").fill("0.85")
    page.goto("about:blank")
    (project,) = served.api("projects", method="GET")["projects"]
    where = f"projects/{project['id']}"
    until(page, lambda: served.api(where, method="GET")["document"]["inputs"]["body"]["width"] == 0.85)
    expect(open_page().get_by_label("Width")).to_have_value("0.85")


def test_a_reload_does_not_bring_back_what_is_old(open_page: Callable[..., Any], served: Any) -> None:
    """A tab that nobody touched since shows what was saved elsewhere, and saves nothing over it."""
    page = open_page()
    typed(page, "Width", "0.75")
    (project,) = served.api("projects", method="GET")["projects"]
    where = f"projects/{project['id']}"
    document = served.api(where, method="GET")["document"]
    document["inputs"]["body"]["width"] = 0.77
    served.api(where, json={"version": project["version"], "document": document, "description": "elsewhere"})
    page.reload()
    expect(page.get_by_label("Width")).to_have_value("0.77")
    assert served.api(where, method="GET")["document"]["inputs"]["body"]["width"] == 0.77


@pytest.mark.parametrize("reloaded", [True, False])
def test_a_save_that_was_never_answered_is_no_clash(
    open_page: Callable[..., Any], served: Any, until: Callable[..., None], record: Any, reloaded: bool
) -> None:
    """A tab that never heard that its save came through has changed nothing elsewhere; what it typed since is saved."""
    page = open_page()
    came: list[Any] = []

    def unheard(route: Any) -> None:
        if route.request.method != "POST" or came:
            return route.continue_()
        came.append(route.fetch())
        return None if reloaded else route.abort()

    page.route(re.compile(r"/api/projects/[^/]+$"), unheard)
    page.get_by_label("Width").fill("0.75")
    until(page, lambda: came)
    page.get_by_label("Height").fill("3")
    if reloaded:
        page.reload()
        page.wait_for_selector("#view-body[data-ready=true]")
    expect(page.get_by_label("Height")).to_have_value("3")
    saved(page)
    expect(page.get_by_test_id("clash")).not_to_be_visible()
    (project,) = served.api("projects", method="GET")["projects"]
    body = served.api(f"projects/{project['id']}", method="GET")["document"]["inputs"]["body"]
    assert (body["width"], body["height"]) == (0.75, 3)
    record.faults[:] = [fault for fault in record.faults if "ERR_FAILED" not in fault]  # the answer that was cut off


def test_what_is_typed_during_an_undo_is_kept(open_page: Callable[..., Any], served: Any) -> None:
    """The answer of the undo comes later than what is typed: that is a state of its own, on the screen and saved."""
    page = open_page()
    typed(page, "Width", "0.75")
    page.route("**/undo", lambda route: (page.get_by_label("Height").fill("3"), route.continue_()))
    page.get_by_role("button", name="Previous state").click()
    expect(page.get_by_label("Height")).to_have_value("3")
    page.wait_for_timeout(600)
    saved(page)
    (project,) = served.api("projects", method="GET")["projects"]
    assert served.api(f"projects/{project['id']}", method="GET")["document"]["inputs"]["body"]["height"] == 3


def test_another_project_waits_until_this_one_is_saved(open_page: Callable[..., Any]) -> None:
    """Where the server saves nothing, the project that is open stays, with what was typed."""
    page = open_page()
    typed(page, "Width", "0.75")
    page.route("**/api/projects/*", lambda route: route.fulfill(status=413, json={"error": {"kind": "too-large",
        "message": "full"}}) if route.request.method == "POST" else route.continue_())  # fmt: skip
    page.get_by_label("Width").fill("0.93")
    expect(page.get_by_test_id("project-saved")).to_have_text("not saved")
    dialog = opened_dialog(page)
    dialog.get_by_label("Name of a new project").fill("Another")
    dialog.get_by_role("button", name="Create").click()
    expect(page.locator("#status")).to_contain_text("are not saved yet")
    expect(page.get_by_label("Width")).to_have_value("0.93")


def test_what_is_asked_belongs_to_the_project(open_page: Callable[..., Any], served: Any, tmp_path: Path) -> None:
    """Typed in Decide, chosen in Inventory and Measure: so it is elsewhere, after undo, and from the file."""
    page = open_page(view="decide")
    decide = page.locator("#view-decide")
    typed(page, "Author", "A. Person")
    decide.get_by_label("Analysis").select_option("predict")
    decide.get_by_label("friction", exact=True).fill("0.4")
    page.locator("#tab-inventory").click()
    rows = {"name": "list.csv", "mimeType": "text/csv", "buffer": b"name,width_cm,height_cm\nvase,20,100\n"}
    page.get_by_label("Drop a list here, or").set_input_files(rows)
    expect(page.locator("#view-inventory").get_by_role("list", name="Files")).to_contain_text("list.csv")
    page.locator("#tab-measure").click()
    page.locator("#view-measure").get_by_label("Column").fill("rotation")
    page.wait_for_timeout(450)
    saved(page)
    other = open_page(view="decide")
    expect(other.locator("#view-decide").get_by_label("friction", exact=True)).to_have_value("0.4")
    other.locator("#tab-inventory").click()
    expect(other.locator("#view-inventory").get_by_role("list", name="Files")).to_contain_text("list.csv")
    other.locator("#tab-measure").click()
    column = other.locator("#view-measure").get_by_label("Column")
    expect(column).to_have_value("rotation")
    other.get_by_role("button", name="Previous state").click()
    expect(column).to_have_value("")
    other.get_by_role("button", name="Next state").click()
    expect(column).to_have_value("rotation")
    (project,) = served.api("projects", method="GET")["projects"]
    states = served.api(f"projects/{project['id']}/history", method="GET")["states"]
    assert "measure" in states[0]["description"].split(", ")
    dialog = opened_dialog(other)
    with other.expect_download() as told:
        dialog.get_by_role("button", name=f"Export: {project['name']}").click()
    told.value.save_as(tmp_path / "project.zip")
    dialog.get_by_label("Name of a new project").fill("Hall 4")
    dialog.get_by_role("button", name="Create").click()
    expect(column).to_have_value("")
    dialog.get_by_label("Import a project file").set_input_files(tmp_path / "project.zip")
    expect(column).to_have_value("rotation")


def test_undo_and_redo(open_page: Callable[..., Any]) -> None:
    """By buttons and by keys, not while a field is typed in, whose own undo that is; and after a reload."""
    page = open_page()
    width = page.get_by_label("Width")
    typed(page, "Width", "0.75")
    typed(page, "Width", "0.9")
    page.get_by_role("button", name="Previous state").click()
    expect(width).to_have_value("0.75")
    page.locator("#tab-body").focus()
    page.keyboard.press("Control+z")
    expect(width).to_have_value("0.5")
    expect(page.get_by_role("button", name="Previous state")).to_have_attribute("aria-disabled", "true")
    page.keyboard.press("Control+Shift+z")
    expect(width).to_have_value("0.75")
    page.reload()
    expect(width).to_have_value("0.75")
    page.get_by_role("button", name="Next state").click()
    expect(width).to_have_value("0.9")
    width.focus()
    page.keyboard.press("Control+z")
    page.wait_for_timeout(300)
    saved(page)
    expect(page.get_by_role("button", name="Next state")).to_have_attribute("aria-disabled", "true")


def test_two_tabs_agree(open_page: Callable[..., Any]) -> None:
    """What one tab of a browser changes the other one shows, and may change in turn."""
    page = open_page()
    other = page.context.new_page()
    other.goto(page.url)
    expect(other.get_by_test_id("project-saved")).to_have_text("saved")
    typed(page, "Width", "0.75")
    expect(other.get_by_label("Width")).to_have_value("0.75")
    typed(other, "Height", "3")
    expect(page.get_by_label("Height")).to_have_value("3")


@pytest.mark.parametrize("mine", [True, False], ids=["kept as a copy", "given up"])
def test_two_browsers_that_change_the_same(open_page: Callable[..., Any], served: Any, mine: bool) -> None:
    """The later one is asked: nothing of either is lost, whatever it chooses."""
    page, other = open_page(), open_page()
    typed(page, "Width", "0.75")
    other.get_by_label("Width").fill("0.6")
    clash = other.get_by_test_id("clash")
    expect(clash).to_be_visible()
    for _ in range(3):  # it stays until something is chosen
        other.keyboard.press("Escape")
    expect(clash).to_be_visible()
    clash.get_by_role("button", name="Save my version as a copy" if mine else "Open the other version").click()
    expect(clash).not_to_be_visible()
    expect(other.get_by_label("Width")).to_have_value("0.6" if mine else "0.75")
    names = {each["name"] for each in served.api("projects", method="GET")["projects"]}
    assert names == {"My first project"} | ({"My first project (mine)"} if mine else set())
    typed(other, "Height", "3")
    expect(page.get_by_label("Width")).to_have_value("0.75")


def test_two_browsers_that_change_different_parts(open_page: Callable[..., Any], served: Any) -> None:
    """Nobody is asked: both changes are kept, and shown where the later one was made; the same part is still asked."""
    page, other = open_page(), open_page(view="motion")
    typed(page, "Width", "0.75")
    page.locator("#tab-decide").click()
    typed(page, "Author", "A. Person")
    amplitude = other.get_by_label("Peak acceleration, exactly")
    typed(other, "Peak acceleration, exactly", "7.77")
    expect(other.get_by_test_id("clash")).not_to_be_visible()
    expect(amplitude).to_have_value("7.77")
    other.locator("#tab-body").click()
    expect(other.get_by_label("Width")).to_have_value("0.75")
    (project,) = served.api("projects", method="GET")["projects"]
    document = served.api(f"projects/{project['id']}", method="GET")["document"]
    assert document["inputs"]["body"]["width"] == 0.75
    assert "7.77" in document["inputs"]["motion"]["pulse"]
    assert document["forms"]["decide"]["author"] == "A. Person"
    page.locator("#tab-body").click()
    typed(page, "Height", "3")  # beside the motion of the other one, which it takes over
    other.get_by_label("Height").fill("4")
    expect(other.get_by_test_id("clash")).to_be_visible()


@pytest.mark.parametrize("apart", [True, False], ids=["another part", "the same part"])
def test_what_was_not_saved_before_a_reload_is_joined(open_page: Callable[..., Any], served: Any, apart: bool) -> None:
    """Somebody else changed it meanwhile: another part is joined after the reload; of the same one is asked."""
    page = open_page()
    typed(page, "Width", "0.75")
    (project,) = served.api("projects", method="GET")["projects"]
    where = f"projects/{project['id']}"
    page.route(f"**/api/{where}", lambda route: route.fulfill(status=429, json={"error": {"kind": "too-many",
        "message": "later"}}) if route.request.method == "POST" else route.continue_())  # fmt: skip
    page.get_by_label("Height").fill("3")
    expect(page.get_by_test_id("project-saved")).to_have_text("not saved")
    document = served.api(where, method="GET")["document"]
    if apart:
        document["forms"] = {"decide": {"author": "A. Person"}}
    else:
        document["inputs"]["body"]["width"] = 0.77
    served.api(where, json={"version": project["version"], "document": document, "description": "elsewhere"})
    page.reload()
    expect(page.get_by_label("Height")).to_have_value("3")
    if not apart:
        for _ in range(2):  # once more asks once more, and the other one's is not written over
            expect(page.get_by_test_id("clash")).to_be_visible()
            page.unroute_all()
            page.reload()
        expect(page.get_by_test_id("clash")).to_be_visible()
        assert served.api(where, method="GET")["document"]["inputs"]["body"]["width"] == 0.77
        return
    page.unroute_all()
    page.get_by_label("Width").fill("0.8")
    saved(page)
    expect(page.get_by_test_id("clash")).not_to_be_visible()
    document = served.api(where, method="GET")["document"]
    assert (document["inputs"]["body"]["width"], document["inputs"]["body"]["height"]) == (0.8, 3)
    assert document["forms"]["decide"]["author"] == "A. Person"


def test_an_empty_table_is_no_change(open_page: Callable[..., Any], served: Any) -> None:
    """A motion that is chosen makes no table of the start: who changed the start has changed another part."""
    page = open_page(view="motion")
    saved(page)
    (project,) = served.api("projects", method="GET")["projects"]
    where = f"projects/{project['id']}"
    document = served.api(where, method="GET")["document"]
    document["inputs"]["response"] = {"assumed_friction": 0.3}
    served.api(where, json={"version": project["version"], "document": document, "description": "elsewhere"})
    typed(page, "Peak acceleration, exactly", "5")
    expect(page.get_by_test_id("clash")).not_to_be_visible()
    inputs = served.api(where, method="GET")["document"]["inputs"]
    assert inputs["response"] == {"assumed_friction": 0.3}
    assert "amplitude=5" in inputs["motion"]["pulse"]
    empty = "async table => (await import('/app/shape.js')).inputsOf({ body: { units: 'm' }, ...table })"
    assert page.evaluate(empty, {"response": {}, "settings": {}}) == {"body": {"units": "m"}}


def test_a_project_that_is_worked_on_is_not_gone(open_page: Callable[..., Any], served: Any) -> None:
    """Deleted in another browser while somebody types in it: it is back with what was typed, and both are told."""
    page = open_page()
    typed(page, "Width", "0.75")
    (project,) = served.api("projects", method="GET")["projects"]
    served.api(f"projects/{project['id']}", method="DELETE")
    page.get_by_label("Height").fill("3")
    expect(page.locator("#status")).to_contain_text("It is restored")
    saved(page)
    (again,) = served.api("projects", method="GET")["projects"]
    assert again["id"] == project["id"]
    document = served.api(f"projects/{project['id']}", method="GET")["document"]
    assert (document["inputs"]["body"]["width"], document["inputs"]["body"]["height"]) == (0.75, 3)


def test_all_projects(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Begun, renamed, copied, taken away, deleted, brought back, and brought in from the file."""
    page = open_page()
    typed(page, "Width", "0.75")
    dialog = opened_dialog(page)
    dialog.get_by_label("Name of the open project").fill("Hall 3")
    dialog.get_by_role("button", name="Rename").click()
    expect(page.get_by_test_id("project")).to_have_text("Hall 3")
    with page.expect_download() as told:
        dialog.get_by_role("button", name="Export: Hall 3").click()
    told.value.save_as(tmp_path / "hall.zip")
    dialog.get_by_label("Name of a new project").fill("Hall 4")
    dialog.get_by_role("button", name="Create").click()
    expect(page.get_by_test_id("project")).to_have_text("Hall 4")
    expect(page.get_by_label("Width")).to_have_value("0.5")
    dialog.get_by_role("button", name="Copy: Hall 3").click()
    expect(page.get_by_test_id("project")).to_have_text("Hall 3 (copy)")
    expect(page.get_by_label("Width")).to_have_value("0.75")
    dialog.get_by_role("button", name="Delete: Hall 3", exact=True).click()
    gone = dialog.get_by_role("list", name="Deleted").get_by_role("button", name="Restore: Hall 3", exact=True)
    expect(gone).to_be_visible()
    gone.click()
    dialog.get_by_role("button", name="Open: Hall 3", exact=True).click()
    expect(dialog).not_to_be_visible()
    expect(page.get_by_label("Width")).to_have_value("0.75")
    dialog = opened_dialog(page)
    dialog.get_by_label("Import a project file").set_input_files(tmp_path / "hall.zip")
    expect(dialog.get_by_role("button", name="Open: Hall 3", exact=True)).to_have_count(1)
    expect(page.get_by_label("Width")).to_have_value("0.75")
    dialog.get_by_label("Import a project file").set_input_files(
        {"name": "x.zip", "mimeType": "application/zip", "buffer": b"nothing"}
    )
    expect(page.locator("#status")).to_contain_text("one ZIP archive")


def test_what_is_said_is_seen_over_a_dialog(open_page: Callable[..., Any]) -> None:
    """On a phone the dialog covers the page: what is said of it lies over it, and stays when it is closed."""
    page = open_page(viewport={"width": 390, "height": 700})
    saved(page)
    dialog = opened_dialog(page)
    dialog.get_by_label("Import a project file").set_input_files(
        {"name": "x.zip", "mimeType": "application/zip", "buffer": b"nothing"}
    )
    told = page.locator("#status")
    expect(told).to_contain_text("one ZIP archive")
    over = """node => { const { x, y, width, height } = node.getBoundingClientRect();
        return node.contains(document.elementFromPoint(x + width / 2, y + height / 2)); }"""
    assert told.evaluate(over)
    assert dialog.locator("#status").count() == 1
    dialog.get_by_role("button", name="Close").click()
    expect(told).to_contain_text("one ZIP archive")
    assert told.evaluate(over)


def test_back_to_a_state_of_the_history(open_page: Callable[..., Any]) -> None:
    """Any earlier state is one press away, and what was there stays in the history."""
    page = open_page()
    for value in ("0.6", "0.7", "0.8"):
        typed(page, "Width", value)
    dialog = opened_dialog(page)
    dialog.get_by_role("button", name="Restore state 2").click()
    expect(page.get_by_label("Width")).to_have_value("0.6")
    expect(dialog.get_by_role("list", name="History").get_by_role("listitem")).to_have_count(5)
    dialog.get_by_role("button", name="Close").click()
    page.get_by_role("button", name="Previous state").click()
    expect(page.get_by_label("Width")).to_have_value("0.8")


def test_studies_belong_to_a_project(open_page: Callable[..., Any], served: Any) -> None:
    """A study is in the list of its own project, and of all projects where that is asked."""
    page = open_page(view="studies")
    studies = page.get_by_test_id("study-list").get_by_role("listitem")
    others = sum(not study["project"] for study in served.api("studies", method="GET")["studies"])
    expect(studies).to_have_count(others)
    page.get_by_role("button", name="Launch").click()
    expect(studies).to_have_count(others + 1)
    dialog = opened_dialog(page)
    dialog.get_by_label("Name of a new project").fill("Another")
    dialog.get_by_role("button", name="Create").click()
    dialog.get_by_role("button", name="Close").click()
    page.locator("#tab-body").click()
    page.locator("#tab-studies").click()
    expect(studies).to_have_count(others)
    page.get_by_label("Studies of all projects").check()
    expect(studies).not_to_have_count(others)


@pytest.mark.parametrize("width", [320, 390, 768, 1024, 1440])
def test_no_bar_at_any_width(open_page: Callable[..., Any], shot: Callable[..., Any], width: int) -> None:
    """The line and the dialog fit, with a long name too."""
    page = open_page(viewport={"width": width, "height": 800})
    dialog = opened_dialog(page)
    dialog.get_by_label("Name of the open project").fill("Depot of the western wing, second floor, showcases " * 3)
    dialog.get_by_role("button", name="Rename").click()
    expect(page.get_by_test_id("project")).to_contain_text("Depot")
    shot(page, f"projects-{width}", full_page=False)
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert dialog.evaluate("node => node.scrollWidth - node.clientWidth") <= 0


def test_a_server_that_is_killed_loses_nothing(browser: Any, own: Any) -> None:
    """Killed again and again, with changes before and while it is gone: signed in still, and all of it is there."""
    context = browser.new_context()
    page = context.new_page()
    page.goto(f"{own.told['url']}#token={own.told['token']}")
    width = page.get_by_label("Width")
    expect(width).to_have_value("0.5")
    for turn in range(KILLS):
        before, while_gone = f"{0.61 + 0.01 * turn:.4g}", f"{1.61 + 0.01 * turn:.4g}"
        typed(page, "Width", before)
        own.kill()
        width.fill(while_gone)
        expect(page.get_by_test_id("project-saved")).to_have_text("not saved")
        own.start()
        expect(page.get_by_test_id("project-saved")).to_have_text("saved")
        other = context.new_page()
        other.goto(own.told["url"])
        expect(other.get_by_label("Width")).to_have_value(while_gone)
        other.close()
    dialog = opened_dialog(page)
    more = dialog.get_by_role("button", name="All ")
    if more.count():
        more.click()
    expect(dialog.get_by_role("list", name="History").get_by_role("listitem")).to_have_count(1 + 2 * KILLS)
    context.close()


def test_what_was_turned_in_a_project_stays_there(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Pulse, seed, record and a file that waits for an answer are forgotten where another project is shown."""
    page = open_page(view="motion")
    motion = page.locator("#view-motion")
    page.get_by_label("Peak acceleration, exactly").fill("7.77")
    motion.locator(".segment", has_text="Synthetic").click()
    page.get_by_label("Seed").fill("6")
    motion.locator(".segment", has_text="Record file").click()
    steps = "\n".join(f"{0.01 * k:.2f} {k % 7}" for k in range(200)).encode()
    told = {"name": "hall.csv", "mimeType": "text/csv", "buffer": b"time [s],a [m/s2]\n" + steps.replace(b" ", b",")}
    page.get_by_test_id("record-file").set_input_files(told)
    expect(page.get_by_test_id("record-held")).to_contain_text("hall.csv")
    page.get_by_test_id("record-file").set_input_files({**told, "name": "wait.txt", "buffer": steps})
    expect(page.locator(".record-form")).to_be_visible()
    saved(page)
    dialog = opened_dialog(page)
    dialog.get_by_label("Name of a new project").fill("Another")
    dialog.get_by_role("button", name="Create").click()
    expect(page.get_by_test_id("project")).to_have_text("Another")
    dialog.get_by_role("button", name="Close").click()
    expect(page.locator(".record-form")).to_have_count(0)
    motion.locator(".pulse-card input[value=ricker]").check()
    motion.locator(".pulse-card input[value=sine]").check()
    expect(page.get_by_label("Peak acceleration, exactly")).to_have_value("3")
    motion.locator(".segment", has_text="Synthetic").click()
    expect(page.get_by_label("Seed")).to_have_value("0")
    motion.locator(".segment", has_text="Record file").click()
    expect(page.get_by_test_id("record-held")).to_be_empty()


def test_a_late_file_is_in_no_other_project(open_page: Callable[..., Any], until: Callable[..., None]) -> None:
    """Another project was opened while it was being sent: it is not in that one, and that is said."""
    page = open_page(view="records")
    saved(page)
    held: list[Any] = []
    page.route("**/api/files?*", lambda route: held.extend([route]))
    told = {"name": "hall.csv", "mimeType": "text/csv", "buffer": b"time [s],a [m/s2]\n0,1\n"}
    page.get_by_label("Drop records or a folder here, or").set_input_files(told)
    until(page, lambda: held)
    dialog = opened_dialog(page)
    dialog.get_by_label("Name of a new project").fill("Another")
    dialog.get_by_role("button", name="Create").click()
    expect(page.get_by_test_id("project")).to_have_text("Another")
    dialog.get_by_role("button", name="Close").click()
    held[0].continue_()
    expect(page.locator("#status")).to_contain_text("Repeat the action")
    expect(page.locator("#view-records").get_by_role("list", name="Files")).to_have_count(0)
    page.unroute_all()
    page.get_by_label("Drop records or a folder here, or").set_input_files(told)
    expect(page.locator("#view-records").get_by_role("list", name="Files")).to_contain_text("hall.csv")


def test_undo_drops_what_cannot_be_saved(open_page: Callable[..., Any]) -> None:
    """What the server refuses is gone after one step back, which shows what was saved last; it is not sent again."""
    page = open_page()
    typed(page, "Width", "0.75")
    sent: list[str] = []

    def refused(route: Any) -> Any:
        if route.request.method != "POST" or '"height":3' not in (route.request.post_data or ""):
            return route.continue_()
        sent.append("refused")
        return route.fulfill(status=422, json={"error": {"kind": "invalid", "message": "too tall"}})

    page.route("**/api/projects/*", refused)
    page.get_by_label("Height").fill("3")
    expect(page.get_by_test_id("project-saved")).to_have_text("not saved")
    expect(page.locator("#status")).to_contain_text("Too tall")
    page.get_by_role("button", name="Previous state").click()
    saved(page)
    expect(page.locator("#status")).to_be_hidden()
    expect(page.get_by_label("Height")).to_have_value("2")
    expect(page.get_by_label("Width")).to_have_value("0.75")
    assert len(sent) <= 2  # as it was typed, and before the step
    page.get_by_role("button", name="Previous state").click()
    expect(page.get_by_label("Width")).to_have_value("0.5")


def test_a_whole_number_that_no_number_holds_is_refused(open_page: Callable[..., Any], served: Any) -> None:
    """9007199254740993 would be kept as another number: the field says so, and the seed stays what it was."""
    page = open_page(view="motion")
    page.locator("#view-motion .segment", has_text="Synthetic").click()
    seed = page.get_by_label("Seed")
    for digits in ("9007199254740993", "9" * 20):
        seed.fill("6")
        saved(page)
        seed.fill(digits)
        expect(seed).to_have_attribute("aria-invalid", "true")
        expect(page.get_by_text("At most 9007199254740991.", exact=True)).to_be_visible()
    page.wait_for_timeout(450)
    saved(page)
    (project,) = served.api("projects", method="GET")["projects"]
    assert served.api(f"projects/{project['id']}", method="GET")["document"]["inputs"]["motion"]["seed"] == 6
