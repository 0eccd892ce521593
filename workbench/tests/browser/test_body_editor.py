"""The board of the Body view: near vertices, grid, pen, dimensions, arcs, mirrors, photographs, what is wrong."""

import itertools
import json
import math
from collections.abc import Callable
from typing import Any

import pytest
from browser_pages import link, number, open_board, settled
from playwright.sync_api import expect

BOARD = ".board"
# in one go: the board is drawn anew whenever an answer comes
DOTS = """() => [...document.querySelectorAll('.vertex')].map((each) => {
  const box = each.querySelector('.dot').getBoundingClientRect();
  return [each.getAttribute('aria-label'), box.x + box.width / 2, box.y + box.height / 2];
})"""


def drawn(page: Any, outline: list[tuple[float, float]] | None = None) -> Any:
    """Show the board with a polygon, by default the rectangle of 0.5 m by 2 m."""
    open_board(page)
    if outline:
        page.get_by_text("Paste points from Excel").click()
        page.get_by_label("Points: x and y per line").fill("\n".join(f"{x} {y}" for x, y in outline))
        page.get_by_role("button", name="Use as outline").click()
        expect(page.locator(".vertex")).to_have_count(len(outline))
        page.get_by_text("Paste points from Excel").click()
    page.locator(BOARD).scroll_into_view_if_needed()
    return page.get_by_test_id("board")


def outline(page: Any, region: int = 0) -> list[tuple[float, float]]:
    """Return the outline that the page asks about."""
    path = f"JSON.parse(sessionStorage.getItem('rocking.inputs')).body.section.region[{region}].outline"
    return [tuple(point) for point in page.evaluate(path)]


def pixel(page: Any, x: float, y: float) -> tuple[float, float]:
    """Return where a point of the drawing is on the screen, from two vertices that are known."""
    known = []
    for label, across, down in page.evaluate(DOTS):
        words = label.split(": x ")[1].split(" m")[0].replace("\u2212", "-")
        known.append((*(float(part) for part in words.split(", y ")), across, down))
    one, two = max(itertools.combinations(known, 2), key=lambda pair: math.dist(pair[0][:2], pair[1][:2]))
    scale = math.dist(one[2:], two[2:]) / math.dist(one[:2], two[:2])
    return one[2] + scale * (x - one[0]), one[3] - scale * (y - one[1])


def dot(page: Any, vertex: int) -> tuple[float, float]:
    """Return where a vertex is on the screen."""
    _, across, down = page.evaluate(DOTS)[vertex - 1]
    return across, down


def middle(mark: Any) -> tuple[float, float]:
    """Return the middle of a mark on the screen, seen or not."""
    box = mark.evaluate(
        "each => { const b = each.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }"
    )
    return box[0], box[1]


def dragged(page: Any, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag with the mouse."""
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=4)
    page.mouse.up()


def grid(page: Any) -> tuple[float, float]:
    """Return the drawn step of the grid: as it is said, and as its lines stand, in lengths."""
    said = float(page.locator(f"{BOARD} [data-step]").get_attribute("data-step"))
    lines = page.locator(f"{BOARD} [data-step] path").evaluate_all(
        "all => all.map(each => each.getAttribute('d')).filter(d => /V/.test(d)).map(d => parseFloat(d.slice(1)))"
    )
    lines.sort()
    gaps = [b - a for a, b in itertools.pairwise(lines)]
    assert max(gaps) - min(gaps) < 1e-6 * max(gaps) + 1e-9
    top, low = pixel(page, 0.0, 1.0), pixel(page, 0.0, 0.0)
    return said, gaps[0] / (low[1] - top[1])


NEAR = [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.502, 2.0), (0.5, 2.001), (0.498, 2.0), (0.0, 2.0)]


def test_vertices_two_millimetres_apart_are_picked(page: Any) -> None:
    """On the whole body the nearest is picked although another lies on top; zoomed in, each is dragged alone."""
    board = drawn(page, NEAR)
    covered = page.get_by_role("button", name="Vertex 4 of region 1")
    # the control: what lies on top at the middle of vertex 4 is another vertex
    x, y = dot(page, 4)
    top = "([x, y]) => document.elementFromPoint(x, y).closest('.vertex').dataset.place"
    assert page.evaluate(top, [x, y]) != "0:-1:3"
    page.mouse.click(x, y)
    expect(covered).to_have_class("vertex chosen")
    for _ in range(30):
        page.keyboard.press("PageUp")
    page.get_by_role("button", name="Vertex 5 of region 1").focus()  # outside of what is seen: the board goes there
    x, y = dot(page, 5)
    assert math.dist(dot(page, 4), (x, y)) > 100.0
    dragged(page, (x, y), (x, y - 60.0))
    after = outline(page)
    assert after[4][1] > 2.0011
    assert [*after[:4], *after[5:]] == [*NEAR[:4], *NEAR[5:]]
    page.keyboard.press("Home")
    assert board.is_visible()
    expect(page.locator(".vertex")).to_have_count(7)


@pytest.mark.parametrize("nearer", [0, 4, 11, 25])
def test_what_snaps_is_what_is_drawn(page: Any, nearer: int) -> None:
    """At every zoom the lines stand one arrow key apart, and a dragged vertex lands on two of them."""
    drawn(page)
    page.get_by_role("button", name="Vertex 3 of region 1").focus()
    first = grid(page)[0]
    # nearer about the middle between two vertices, so that their places tell the scale
    for _ in range(nearer):
        page.keyboard.press("PageUp")
    said, seen = grid(page)
    assert seen == pytest.approx(said, rel=1e-6)  # pixels of a screenshot box are single precision
    assert (said < first) == (nearer > 3)
    page.keyboard.press("ArrowRight")
    assert outline(page)[2] == pytest.approx((0.5 + said, 2.0), rel=1e-12)
    start = dot(page, 3)
    dragged(page, start, (start[0] - 47.3, start[1] + 31.9))
    moved = outline(page)[2]
    assert moved != pytest.approx((0.5 + said, 2.0), rel=1e-12)
    for value in moved:
        assert value / said == pytest.approx(round(value / said), abs=1e-6)
    # the control: without snapping it is on no line
    page.get_by_label("Snap to grid").uncheck()
    start = dot(page, 3)
    dragged(page, start, (start[0] - 13.37, start[1] + 7.77))
    assert any(abs(value / said - round(value / said)) > 1e-3 for value in outline(page)[2])


def test_wheel_and_empty_board(page: Any) -> None:
    """The wheel zooms about the pointer once the board is in use, else the page scrolls; an empty place pans."""
    board = drawn(page)
    before = dot(page, 1)
    frame = board.bounding_box()
    page.mouse.move(frame["x"] + 60, frame["y"] + 60)
    page.mouse.wheel(0, -200)
    assert page.locator(f"{BOARD} [data-step]").get_attribute("data-step") == "0.1"
    frame = board.bounding_box()
    page.mouse.click(frame["x"] + 60, frame["y"] + 60)
    at = pixel(page, 0.5, 2.0)
    page.mouse.move(*at)
    page.mouse.wheel(0, -400)
    expect(page.locator(f"{BOARD} [data-step]")).not_to_have_attribute("data-step", "0.1")
    # the place of a wheel is told in whole pixels; about the middle of the board it would move by some hundred
    assert pixel(page, 0.5, 2.0) == pytest.approx(at, abs=2.0)
    at = pixel(page, 0.5, 2.0)
    assert dot(page, 1)[1] > before[1] + 100.0
    dragged(page, (frame["x"] + 60, frame["y"] + 200), (frame["x"] + 90, frame["y"] + 180))
    assert pixel(page, 0.5, 2.0) == pytest.approx((at[0] + 30, at[1] - 20), abs=1.0)
    assert outline(page) == [(0, 0), (0.5, 0), (0.5, 2), (0, 2)]
    for name in ("Zoom out", "Pan left", "Show the whole body"):
        page.get_by_role("button", name=name, exact=True).click()
    assert page.locator(f"{BOARD} [data-step]").get_attribute("data-step") == "0.1"


def test_two_fingers_zoom(open_page: Callable[..., Any]) -> None:
    """A pinch to twice the spread halves what is seen; the body stays as it is."""
    page = open_page(viewport={"width": 390, "height": 800}, has_touch=True)
    board = drawn(page)
    page.wait_for_load_state("networkidle")
    frame = board.bounding_box()
    size = "() => { const [a, b] = [...document.querySelectorAll('.vertex')].map(e => e.getBoundingClientRect());"
    size += " return Math.abs(a.x - b.x); }"
    before = page.evaluate(size)
    client = page.context.new_cdp_session(page)
    x, y = frame["x"] + frame["width"] / 2, max(frame["y"], 0) + 200
    for kind, spread in [("touchStart", 40), *[("touchMove", 40 + 10 * k) for k in range(1, 5)], ("touchEnd", 0)]:
        points = [{"x": x - spread, "y": y, "id": 0}, {"x": x + spread, "y": y, "id": 1}] if spread else []
        client.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    expect(board).to_be_visible()
    assert page.evaluate(size) == pytest.approx(2.0 * before, rel=0.05)  # moves come in whole pixels, finger by finger
    assert page.evaluate("visualViewport.scale") == 1


def test_pen_by_pointer(page: Any, shot: Callable[..., Any]) -> None:
    """A right triangle of three clicks closed on its first point is the body; Undo brings the rectangle back."""
    drawn(page)
    page.get_by_role("button", name="Pen", exact=True).click()
    corners = [(-0.5, 0.0), (0.7, 0.0), (-0.5, 1.5)]
    for point in [*corners, corners[0]]:
        page.mouse.click(*pixel(page, *point))
    settled(page, "Centre of mass, y m", 0.5)
    assert outline(page) == corners
    assert number(page, "Centre of mass, x m") == pytest.approx((-0.5 - 0.5 + 0.7) / 3.0, rel=1e-9)
    shot(page, "body-pen")
    page.get_by_role("button", name="Undo").click()
    settled(page, "Mass kg", 0.5 * 2.0 * 0.5 * 2400.0)


def test_pen_by_keyboard(page: Any) -> None:
    """Arrows and Space set the corners of a hole; Escape leaves the body alone."""
    drawn(page)
    settled(page, "Mass kg", 1200.0)
    pen = page.get_by_role("button", name="Pen", exact=True)
    pen.focus()
    page.keyboard.press("Enter")
    expect(pen).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("Space")
    page.keyboard.press("Escape")
    expect(pen).to_have_attribute("aria-pressed", "false")
    assert len(outline(page)) == 4
    pen.focus()
    page.keyboard.press("Enter")
    # the cursor begins at the middle of what is seen or at the chosen vertex: it is moved to a known place by its words
    page.keyboard.press("ArrowUp")
    told = page.get_by_test_id("board-told")
    expect(told).to_contain_text("cursor at x")
    words = told.inner_text().split("at x ")[1].split(" m")[0].replace("\u2212", "-")
    x, y = (round(10 * float(part)) for part in words.split(", y "))

    def go(to_x: int, to_y: int) -> None:
        nonlocal x, y
        for _ in range(abs(to_x - x)):
            page.keyboard.press("ArrowRight" if to_x > x else "ArrowLeft")
        for _ in range(abs(to_y - y)):
            page.keyboard.press("ArrowUp" if to_y > y else "ArrowDown")
        x, y = to_x, to_y
        page.keyboard.press("Space")

    for corner in ((1, 5), (4, 5), (4, 9)):
        go(*corner)
    expect(told).to_contain_text("3 points set")
    page.get_by_role("button", name="Close as hole").click()
    settled(page, "Mass kg", (0.5 * 2.0 - 0.5 * 0.3 * 0.4) * 0.5 * 2400.0)


def test_a_vertex_is_pulled_from_an_edge(page: Any) -> None:
    """Pressed in the middle of the right side and pulled out, the edge has a new vertex where it was let go."""
    drawn(page)
    dragged(page, pixel(page, 0.5, 1.0), pixel(page, 0.9, 1.2))
    assert outline(page) == [(0, 0), (0.5, 0), (0.9, 1.2), (0.5, 2), (0, 2)]
    page.get_by_role("button", name="Undo").click()
    assert len(outline(page)) == 4


def test_an_error_stands_at_its_place(page: Any, shot: Callable[..., Any]) -> None:
    """A crossing is marked where it is, overlapping regions are outlined, a foot off the base has its place."""
    drawn(page, [(0, 0), (2, 0), (0, 3), (1, 4)])
    mark = page.get_by_test_id("board-refusal")
    mark.wait_for()
    # the second edge, x = 2 - 2 y / 3, and the fourth, y = 4 x
    x = 2.0 / (1.0 + 8.0 / 3.0)
    assert middle(mark.locator("circle")) == pytest.approx(pixel(page, x, 4.0 * x), abs=0.5)
    expect(page.locator(".board-refusal")).to_contain_text("crosses or touches itself")
    shot(page, "body-refused")
    page.get_by_role("button", name="Undo").click()
    expect(mark).to_have_count(0)
    expect(page.locator(".board-refusal")).to_be_hidden()
    page.get_by_role("button", name="Add region").click()
    page.get_by_label("Vertex y").fill("1")
    expect(mark.locator("path")).to_have_count(2)
    page.get_by_role("button", name="Undo").click()
    page.get_by_role("button", name="Undo").click()
    expect(mark).to_have_count(0)
    page.get_by_text("Paste points from Excel").click()
    page.get_by_label("Points: x and y per line").fill("0 2\n0.2 2\n0.5 2")
    page.get_by_role("button", name="Add as region").click()
    expect(page.locator(".board-refusal")).to_contain_text("Region 2")  # without any width, it touches itself
    assert middle(mark.locator("circle")) == pytest.approx(pixel(page, 0.2, 2.0), abs=0.5)
    page.get_by_role("button", name="Undo").click()
    expect(mark).to_have_count(0)
    page.get_by_label("Left foot").fill("-3")
    page.get_by_label("Right foot").fill("0.4")
    mark.locator("circle").wait_for(state="attached")
    assert middle(mark.locator("circle")) == pytest.approx(pixel(page, -3.0, 0.0), abs=0.5)


def test_a_refused_outline_has_no_feet(page: Any) -> None:
    """Feet and centre are drawn of the body that is shown, not of the one before that was refused."""
    drawn(page)
    marks = page.locator(".board-facts")
    expect(marks).to_have_count(1)
    paste = page.get_by_text("Paste points from Excel")
    paste.click()
    page.get_by_label("Points: x and y per line").fill("0 0\n2 0\n0 3\n1 4")
    page.get_by_role("button", name="Use as outline").click()
    expect(page.locator(".board-refusal")).to_contain_text("crosses or touches itself")
    expect(marks).to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(marks).to_have_count(1)


@pytest.mark.parametrize("width", [390, 1360, 1440])
def test_no_vertex_lies_under_a_button(open_page: Callable[..., Any], shot: Callable[..., Any], width: int) -> None:
    """Of a flat and a tall outline that fill the board every vertex is what a pointer meets there."""
    page = open_page(viewport={"width": width, "height": 1000})
    for outline in ([(0, 0), (2, 0), (2, 1), (0, 1)], [(0, 0), (9, 0), (9, 5), (0, 5)]):
        drawn(page, outline)
        page.get_by_role("button", name="Show the whole body").click()
        met = page.evaluate(
            DOTS.replace(
                "each.getAttribute('aria-label')",
                """
            document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2)?.closest('.vertex') === each""",
            )
        )
        assert [found for found, *_ in met] == [True] * 4, outline
    shot(page, f"body-board-{width}")


def test_feet_stand_on_the_ground_wherever_that_is(open_page: Callable[..., Any]) -> None:
    """Of a section on a ground of y = 1 its feet are marked there, and so is one that is off the base."""
    section = {"ground": 1.0, "region": [{"outline": [[0, 1], [2, 1], [2, 4], [0, 4]], "density": 2400}]}
    fragment = link(body={"units": "m", "section": section}).replace("view=response", "view=body")
    page = open_page(fragment)
    marks = page.locator(".board-facts path.accent-fill")
    expect(marks).to_have_count(2)
    for k, x in enumerate((0.0, 2.0)):
        box = marks.nth(k).bounding_box()
        assert (box["x"] + box["width"] / 2, box["y"]) == pytest.approx(pixel(page, x, 1.0), abs=1.0)
    page.get_by_label("Left foot").fill("-3")
    page.get_by_label("Right foot").fill("0.4")
    mark = page.get_by_test_id("board-refusal").locator("circle")
    mark.wait_for(state="attached")
    assert middle(mark) == pytest.approx(pixel(page, -3.0, 1.0), abs=0.5)


def test_dimensions_are_typed(page: Any) -> None:
    """The edge after the chosen vertex says its length and angle, and takes others: its end moves."""
    drawn(page, [(0, 0), (4, 0), (4, 3), (0, 3)])
    page.get_by_role("button", name="Vertex 2 of region 1").focus()
    edge = page.get_by_test_id("edge")
    edge.locator("summary").click()
    length, angle = edge.get_by_label("Edge length"), edge.get_by_label("Edge angle")
    assert (length.input_value(), angle.input_value()) == ("3", "90")
    expect(page.locator(".edge-picked text")).to_have_text("3\u00a0m, 90°")
    length.fill("5")
    assert outline(page)[2] == pytest.approx((4.0, 5.0), rel=1e-12)
    angle.fill("150")
    assert outline(page)[2] == pytest.approx((4.0 - 5.0 * math.sqrt(0.75), 2.5), rel=1e-11)
    length.fill("0")
    assert "More than" in edge.inner_text()
    assert outline(page)[2] == pytest.approx((4.0 - 5.0 * math.sqrt(0.75), 2.5), rel=1e-11)


@pytest.mark.parametrize("most", [0.1, 0.003])
def test_an_edge_becomes_an_arc(page: Any, most: float) -> None:
    """A half circle on top of a square: its points lie on it, its chords are as near as asked, one less is not."""
    drawn(page, [(0, 0), (2, 0), (2, 2), (0, 2)])
    page.get_by_role("button", name="Vertex 3 of region 1").focus()
    edge = page.get_by_test_id("edge")
    edge.locator("summary").click()
    edge.get_by_label("Rise of the arc").fill("1")
    edge.get_by_label("Largest deviation from the arc").fill(str(most))
    edge.get_by_role("button", name="Replace by an arc").click()
    points = outline(page)[2:]
    chords = len(points) - 1
    assert all(math.dist(each, (1.0, 2.0)) == pytest.approx(1.0, rel=1e-11) for each in points)
    assert all(each[1] >= 2.0 for each in points)

    def off(count: int) -> float:
        return 1.0 - math.cos(0.5 * math.pi / count)

    assert off(chords) <= most < off(chords - 1)
    expect(page.get_by_test_id("board-told")).to_contain_text(f"Arc of {chords} chords")
    # area of the polygon of chords: n equal triangles under half a circle
    area = 4.0 + chords * 0.5 * math.sin(math.pi / chords)
    settled(page, "Mass kg", area * 0.5 * 2400.0)


def test_mirrors(page: Any) -> None:
    """Left becomes right, the feet with it; half a profile doubled over its upright edge is symmetric."""
    drawn(page, [(0, 0), (2, 0), (1, 3), (0, 3)])
    page.get_by_label("Left foot").fill("0.1")
    page.get_by_label("Right foot").fill("1.5")
    settled(page, "Centre of mass, x m", (3.0 * 0.5 + 1.5 * (1.0 + 1.0 / 3.0)) / 4.5)
    page.get_by_role("button", name="Mirror", exact=True).click()
    settled(page, "Centre of mass, x m", 2.0 - (3.0 * 0.5 + 1.5 * (1.0 + 1.0 / 3.0)) / 4.5)
    assert page.get_by_label("Left foot").input_value() == "0.5"
    assert page.get_by_label("Right foot").input_value() == "1.9"
    page.get_by_role("button", name="Undo").click()
    for foot in ("Left foot", "Right foot"):
        page.get_by_label(foot).fill("")
    page.get_by_role("button", name="Vertex 4 of region 1").focus()
    page.get_by_test_id("edge").locator("summary").click()
    page.get_by_role("button", name="Complete by symmetry").click()
    settled(page, "Mass kg", 2.0 * 4.5 * 0.5 * 2400.0)
    assert sorted(outline(page)) == sorted([(0, 0), (2, 0), (1, 3), (0, 3), (-1, 3), (-2, 0)])


def test_mass_and_centre_by_hand(page: Any) -> None:
    """A polygon weighs what was typed, in place of its density, about the centre that was typed; without, as before."""
    drawn(page)
    settled(page, "Mass kg", 1200.0)
    page.get_by_label("Mass kg").fill("300")
    settled(page, "Mass kg", 300.0)
    page.get_by_label("Centre of mass x").fill("0.2")
    page.get_by_label("Centre of mass y").fill("0.7")
    settled(page, "Centre of mass, y m", 0.7)
    assert number(page, "Centre of mass, x m") == pytest.approx(0.2, rel=1e-12)
    page.get_by_role("button", name="Vertex 3 of region 1").focus()
    page.keyboard.press("Shift+ArrowRight")
    expect(page.locator(".vertex")).to_have_count(4)
    settled(page, "Mass kg", 300.0)
    page.get_by_label("Mass kg").fill("")
    settled(page, "Mass kg", 0.5 * (0.5 + 1.5) * 2.0 * 0.5 * 2400.0)


def photographed(page: Any) -> Any:
    """Lay a picture of 400 by 200 pixels under the drawing; returns the part of the editor about it."""
    drawn(page)
    picture = page.evaluate(
        "async () => { const c = new OffscreenCanvas(400, 200); const g = c.getContext('2d'); g.fillStyle = '#a64';"
        " g.fillRect(50, 0, 100, 200); const b = await c.convertToBlob();"
        " return [...new Uint8Array(await b.arrayBuffer())]; }"
    )
    part = page.get_by_test_id("photo")
    part.locator("summary").click()
    files = {"name": "probe-of-a-statue.png", "mimeType": "image/png", "buffer": bytes(picture)}
    part.get_by_label("Picture", exact=True).set_input_files(files)
    page.locator(f"{BOARD} image").wait_for()
    return part


def test_a_photograph_has_a_scale(page: Any, shot: Callable[..., Any]) -> None:
    """Two points 100 of 400 pixels apart that are 0.3 m make a picture 1.2 m wide, in another unit too."""
    part, image = photographed(page), page.locator(f"{BOARD} image")
    part.get_by_role("button", name="Set two points").click()
    page.locator(BOARD).scroll_into_view_if_needed()
    box = image.bounding_box()
    for share in (0.125, 0.375):
        page.mouse.click(box["x"] + share * box["width"], box["y"] + 0.5 * box["height"])
    part.get_by_label("Length between the two points").fill("0.3")
    part.get_by_role("button", name="Apply the length").click()
    expect(page.get_by_test_id("board-told")).to_contain_text("1.2 by 0.6 m")
    part.get_by_label("Opacity").fill("0.3")
    expect(image).to_have_attribute("opacity", "0.3")
    shot(page, "body-photograph")
    before = image.bounding_box()
    page.get_by_role("radio", name="cm", exact=True).check()
    expect(page.locator(f"{BOARD} [data-step]")).to_have_attribute("data-step", "10")
    after = image.bounding_box()
    assert [after[key] for key in "xy"] == pytest.approx([before[key] for key in "xy"], abs=0.5)
    assert after["width"] == pytest.approx(before["width"], rel=1e-3)  # of boxes in single precision


def test_a_photograph_stays_in_the_browser(page: Any, record: Any) -> None:
    """No request after it carries it, though some are made; nothing is kept; what is no picture is refused."""
    sent: list[str] = []
    page.on("request", lambda request: sent.append(request.post_data or ""))
    part = photographed(page)
    asked = len(record.requests)
    page.get_by_role("button", name="Add region").click()
    settled(page, "Mass kg", 0.5 * 2.5 * 0.5 * 2400.0)
    later = record.requests[asked:]
    assert any("/api/" in each for each in later)
    assert all("/api/" in each for each in later), later
    assert any('"section"' in each for each in sent)  # the control: what is sent is seen
    assert not any("statue" in each or "blob:" in each or "data:" in each for each in sent)
    assert max(len(each) for each in sent) < 20_000
    kept = page.evaluate("JSON.stringify({...sessionStorage, ...localStorage})")
    assert "section" in kept
    assert "blob:" not in kept
    assert "statue" not in kept
    part.get_by_role("button", name="Remove the picture").click()
    expect(page.locator(f"{BOARD} image")).to_have_count(0)
    words = {"name": "x.png", "mimeType": "image/png", "buffer": json.dumps("no picture").encode()}
    part.get_by_label("Picture", exact=True).set_input_files(words)
    expect(page.get_by_test_id("board-told")).to_contain_text("cannot show this file")


DAY = {"color_scheme": "light"}
NIGHT_PHONE = {"color_scheme": "dark", "viewport": {"width": 320, "height": 800}}


@pytest.mark.parametrize("look", [DAY, NIGHT_PHONE], ids=["day", "night"])
def test_axe_minds_nothing_of_the_tools(open_page: Callable[..., Any], look: dict[str, Any]) -> None:
    """With a refusal on the board, the pen held, and every part unfolded; nothing is wider than the window."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe
    page = open_page(**look)
    drawn(page, [(0, 0), (2, 0), (0, 3), (1, 4)])
    page.get_by_test_id("board-refusal").wait_for()
    for part in ("edge", "photo"):
        page.get_by_test_id(part).locator("summary").click()
    page.get_by_role("button", name="Pen", exact=True).click()
    results = (
        axe().run(page, context="[data-testid=editor]", options={"resultTypes": ["violations"]}).response["violations"]
    )
    assert [(one["id"], node["target"]) for one in results for node in one["nodes"]] == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
