"""Bodies that are drawn: points pasted, the board by keyboard and by pointer, regions, undo."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from browser_pages import facts, number, open_board, settled
from playwright.sync_api import expect

L_SHAPE = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0)]


def test_pasted_points_become_the_body(page: Any, shot: Callable[..., Any]) -> None:
    """An L of two rectangles pasted from Excel with decimal commas has the centre of the composite."""
    page.get_by_label("Shape").select_option("section")
    page.get_by_text("Paste points from Excel").click()
    text = "x\ty\n" + "\n".join(f"{x:.2f}\t{y:.2f}".replace(".", ",") for x, y in L_SHAPE)
    page.get_by_label("Points: x and y per line").fill(text)
    assert "6 points read" in page.get_by_test_id("editor").inner_text()
    page.get_by_role("button", name="Use as outline").click()
    centre = ((1.0 * 4.0 * 0.5 + 1.0 * 1.0 * 1.5) / 5.0, (4.0 * 2.0 + 1.0 * 0.5) / 5.0)
    settled(page, "Centre of mass, x m", centre[0])
    assert number(page, "Centre of mass, y m") == pytest.approx(centre[1], rel=1e-12, abs=0.0)
    assert number(page, "Slenderness angle \u03b1 rad", 0) == pytest.approx(
        math.atan2(centre[0], centre[1]), rel=1e-9, abs=0.0
    )
    shot(page, "body-polygon")


def test_a_polygon_chosen_before_the_first_answer_has_vertices(page: Any) -> None:
    """The board is never empty: without facts of the server the polygon is the rectangle that was typed."""
    made = """async () => (await import('/views/body-shapes.js')).asShape(
        { units: 'cm', width: 60, height: 200, depth: 40 }, 'section', null)"""
    outline = [[0, 0], [60, 0], [60, 200], [0, 200]]
    assert page.evaluate(made) == {"units": "cm", "section": {"region": [{"outline": outline}], "depth": 40}}


def test_points_are_read_in_every_usual_form(page: Any) -> None:
    """Tabs, semicolons, commas, blanks and decimal commas mean the same; three columns and words are refused."""
    read = """async text => (await import('/views/body-points.js')).parsePoints(text)"""
    triangle = [[0, 0], [1.5, 0], [0, 2.25]]
    for text in (
        "0\t0\n1,5\t0\n0\t2,25", "0;0\n1,5;0\n0;2,25", "0,0\n1.5,0\n0,2.25", "0 0\n1.5 0\n0 2.25\n0 0",
        "0, 0\n1,5, 0\n0, 2,25", "[0, 0],\n[1.5, 0],\n[0, 2.25]", "x;y\n0;0\n1.5;0\n0;2.25\n",
    ):  # fmt: skip
        assert page.evaluate(read, text) == {"points": triangle, "fault": ""}, text
    for text in ("0 0 0\n1 0 0\n0 1 0", "0,0\n1,5,0,0\n2,2", "0 0\n1 1", "0 0\nfoot here\n1 1\n2 2"):
        assert page.evaluate(read, text)["fault"], text


def test_the_board_by_keyboard_alone(page: Any) -> None:
    """A vertex moves by arrow keys, one is added and deleted, and undo and redo walk back and forth."""
    open_board(page)
    settled(page, "Centre of mass, x m", 0.25)
    page.get_by_label("Grid step").fill("0.1")
    corner = page.get_by_role("button", name="Vertex 3 of region 1: x 0.5, y 2 m")
    corner.focus()
    for _ in range(5):
        page.keyboard.press("ArrowLeft")
    # A right triangle of base 0.5 and height 2 with the right angle at the origin, once the corners meet.
    page.keyboard.press("Delete")
    settled(page, "Centre of mass, x m", 0.5 / 3.0)
    settled(page, "Centre of mass, y m", 2.0 / 3.0)
    for _ in range(6):
        page.keyboard.press("Control+z")
    settled(page, "Centre of mass, x m", 0.25)
    page.get_by_role("button", name="Redo").click()
    settled(page, "Centre of mass, x m", _trapezoid_centre(0.5, 0.4, 2.0))
    page.get_by_role("button", name="Vertex 1 of region 1").focus()
    page.keyboard.press("Insert")
    assert page.locator(".vertex").count() == 5


def _trapezoid_centre(base: float, top: float, height: float) -> float:
    """Return x of the centre of a right trapezoid with its upright side at x = 0."""
    rectangle, triangle = top * height, 0.5 * (base - top) * height
    return (rectangle * top / 2.0 + triangle * (top + (base - top) / 3.0)) / (rectangle + triangle)


def test_the_board_by_pointer(page: Any, shot: Callable[..., Any], calm: Callable[[Any], None]) -> None:
    """Dragging a vertex widens the body, clicking an edge adds a vertex, a hole takes mass away."""
    open_board(page)
    settled(page, "Mass kg", 0.5 * 2.0 * 0.5 * 2400.0)
    calm(page)  # the board is drawn anew when the answer comes
    for name in ("Vertex 2 of region 1", "Vertex 3 of region 1"):
        page.get_by_role("button", name=name).wait_for()
    handle = page.get_by_role("button", name="Vertex 2 of region 1").bounding_box()
    top = page.get_by_role("button", name="Vertex 3 of region 1").bounding_box()
    height = handle["y"] - top["y"]
    x, y = handle["x"] + handle["width"] / 2, handle["y"] + handle["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + height / 8, y, steps=4)
    page.mouse.move(x + height / 4, y, steps=4)
    page.mouse.up()
    settled(page, "Mass kg", (0.5 + 0.25) * 2.0 * 0.5 * 2400.0)
    page.mouse.click(handle["x"] - 60 + handle["width"] / 2, y)
    assert page.locator(".vertex").count() == 5
    page.get_by_role("button", name="Undo").click()
    before = number(page, "Mass kg")
    page.get_by_role("button", name="Add hole").click()
    settled(page, "Mass kg", before - 1.0 / 4.0 * 2.0 / 4.0 * 0.5 * 2400.0)
    shot(page, "body-editor")


def test_regions_have_densities_of_their_own(page: Any) -> None:
    """A second region on top, four times as dense, moves the centre as the composite of two rectangles."""
    open_board(page)
    page.get_by_role("button", name="Add region").click()
    page.get_by_label("Density of region 2").fill("9600")
    lower, upper = 2.0 * 2400.0, 0.5 * 9600.0
    settled(page, "Centre of mass, y m", (lower * 1.0 + upper * 2.25) / (lower + upper))
    assert page.locator(".vertex").count() == 8


def test_a_mass_puts_densities_aside(page: Any) -> None:
    """Typed over two densities it outlasts Undo and another shape; emptied, they are back; a density ends it."""
    open_board(page)
    page.get_by_role("button", name="Add region").click()
    page.get_by_label("Density of region 1").fill("1000")
    page.get_by_label("Density of region 2").fill("9600")
    dense = 0.5 * 0.5 * (2.0 * 1000.0 + 0.5 * 9600.0)
    settled(page, "Mass kg", dense)
    mass = page.get_by_role("textbox", name="Mass kg")
    mass.fill("300")
    settled(page, "Mass kg", 300.0)
    expect(page.get_by_label("Density of region 2")).to_have_value("")
    page.get_by_role("button", name="Undo").click()  # regions that had densities: the mass still holds
    settled(page, "Mass kg", 300.0)
    page.get_by_role("button", name="Redo").click()
    mass.fill("")
    settled(page, "Mass kg", dense)
    expect(page.get_by_label("Density of region 2")).to_have_value("9600")
    mass.fill("300")
    settled(page, "Mass kg", 300.0)
    page.get_by_label("Density of region 2").fill("4800")
    expect(mass).to_have_value("")
    settled(page, "Mass kg", 0.5 * 0.5 * (2.0 * 2400.0 + 0.5 * 4800.0))
    mass.fill("300")
    page.get_by_label("Shape").select_option("block")
    expect(page.get_by_label("Width")).to_be_visible()
    expect(mass).to_have_value("300")
    settled(page, "Mass kg", 300.0)
    open_board(page)
    expect(mass).to_have_value("300")
    settled(page, "Mass kg", 300.0)


def test_a_mass_outlasts_another_shape(page: Any) -> None:
    """A block of 300 kg is a polygon of 300 kg, and its own density is back once the mass is emptied."""
    page.get_by_label("Density").fill("500")
    mass = page.get_by_role("textbox", name="Mass kg")
    mass.fill("300")
    settled(page, "Mass kg", 300.0)
    expect(page.get_by_label("Density")).to_have_value("")
    mass.fill("")
    settled(page, "Mass kg", 0.5 * 2.0 * 0.5 * 500.0)
    mass.fill("300")
    settled(page, "Mass kg", 300.0)
    open_board(page)
    expect(mass).to_have_value("300")
    settled(page, "Mass kg", 300.0)


def test_what_is_wrong_has_the_keyboard(page: Any) -> None:
    """Points that cannot be read, an arc without a rise, a file without a unit: marked, and the keyboard is there."""
    open_board(page)
    paste(page, "0 0 0", "Use as outline")
    points = page.get_by_label("Points: x and y per line")
    expect(points).to_be_focused()
    expect(points).to_have_attribute("aria-invalid", "true")
    points.fill("0 0\n1 0\n0 1")
    expect(points).not_to_have_attribute("aria-invalid", "true")
    page.get_by_test_id("edge").locator("summary").click()
    page.get_by_role("button", name="Replace by an arc").click()
    rise = page.get_by_label("Rise of the arc")
    expect(rise).to_be_focused()
    expect(rise).to_have_accessible_description("Enter a rise other than 0.")
    rise.fill("0.1")
    expect(rise).not_to_have_attribute("aria-invalid", "true")
    wkt = {"name": "a.wkt", "mimeType": "text/plain", "buffer": b"POLYGON ((0 0, 1 0, 1 2, 0 2, 0 0))"}
    page.get_by_label("Body file").set_input_files(wkt)
    units = page.get_by_label("Unit of the file")
    expect(units).to_be_focused()
    expect(units).to_have_attribute("aria-invalid", "true")
    units.select_option("m")
    settled(page, "Slenderness h/b", 2.0)
    expect(units).not_to_have_attribute("aria-invalid", "true")
    page.get_by_label("Left foot").fill("-3")
    page.get_by_label("Right foot").fill("0.4")
    expect(page.get_by_label("Left foot")).to_have_attribute("aria-invalid", "true")


def square(x: float, y: float, width: float, height: float) -> str:
    """Return the corners of a rectangle as lines to paste."""
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    return "\n".join(f"{across} {up}" for across, up in corners)


def paste(page: Any, text: str, use: str) -> None:
    """Paste points into the editor and use them."""
    if not page.get_by_label("Points: x and y per line").is_visible():
        page.get_by_text("Paste points from Excel").click()
    page.get_by_label("Points: x and y per line").fill(text)
    page.get_by_role("button", name=use).click()


def test_a_drawing_outlasts_a_look_at_another_shape(page: Any) -> None:
    """Polygon, Block, Polygon: two regions with eight vertices are still there, and so is the way back."""
    open_board(page)
    page.get_by_role("button", name="Add region").click()
    expect(page.locator(".vertex")).to_have_count(8)
    page.get_by_label("Shape").select_option("block")
    page.get_by_role("radio", name="cm", exact=True).check()
    page.get_by_label("Shape").select_option("section")
    expect(page.locator(".vertex")).to_have_count(8)
    settled(page, "Mass kg", 0.5 * 2.5 * 0.5 * 2400.0)
    page.get_by_role("button", name="Undo").click()
    expect(page.locator(".vertex")).to_have_count(4)
    settled(page, "Mass kg", 0.5 * 2.0 * 0.5 * 2400.0)


def test_undo_keeps_the_focus_when_nothing_is_left_to_undo(page: Any) -> None:
    """The keyboard stays on the button that has done its last step."""
    open_board(page)
    page.get_by_role("button", name="Add region").click()
    undo = page.get_by_role("button", name="Undo")
    undo.focus()
    page.keyboard.press("Enter")
    expect(undo).to_have_attribute("aria-disabled", "true")
    expect(undo).to_be_focused()


def test_refusals_speak_as_the_page_does(page: Any) -> None:
    """Regions count from one, places are in the unit of the drawing, and no key of the API is named."""
    page.get_by_role("radio", name="cm", exact=True).check()
    open_board(page)
    refusal = page.get_by_test_id("body-refusal")
    paste(page, square(0, 100, 50, 150), "Add as region")
    expect(refusal).to_contain_text("Regions 1 and 2 overlap over 5000 cm\u00b2")
    page.get_by_role("button", name="Undo").click()
    expect(refusal).to_be_empty()
    paste(page, "0 200\n50 250\n50 200\n0 250", "Add as region")
    expect(refusal).to_contain_text("Region 2: outline crosses or touches itself near x = 25 cm, y = 225 cm")
    assert "section" not in refusal.inner_text()


HOLED = (
    "units = 'm'\n[section]\nfeet = [0.1, 1.9]\n"
    "[[section.region]]\noutline = [[0, 0], [2, 0], [2, 2], [0, 2]]\ndensity = 2000\n"
    "holes = [[[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]]\n"
    "[[section.region]]\noutline = [[0, 2], [2, 2], [2, 3], [0, 3]]\ndensity = 1000\n"
)


def test_a_pasted_outline_is_the_whole_body(page: Any, tmp_path: Path, shot: Callable[..., Any]) -> None:
    """Pasted over a body with a hole, a second region and feet inside, 1 m by 3 m has h/b 3; Undo restores all."""
    path = tmp_path / "holed.toml"
    path.write_text(HOLED, encoding="utf-8")
    page.get_by_label("Body file").set_input_files(path)
    former = 2000.0 * (4.0 - 1.0) + 1000.0 * 2.0
    settled(page, "Mass kg", former)
    paste(page, "0,0\n1,0\n1,3\n0,3", "Use as outline")
    settled(page, "Slenderness h/b", 3.0)
    assert number(page, "Mass kg") == pytest.approx(2000.0 * 3.0, rel=1e-12, abs=0.0)
    assert page.get_by_label("Left foot").input_value() == ""
    told = page.get_by_test_id("editor").locator(".paste [role=status]")
    expect(told).to_contain_text("1 hole, 1 other region and the feet")
    expect(told).to_contain_text("Undo restores them")
    shot(page, "body-pasted")
    undo, redo = (page.get_by_role("button", name=name, exact=True) for name in ("Undo", "Redo"))
    undo.click()
    settled(page, "Mass kg", former)
    assert page.get_by_label("Left foot").input_value() == "0.1"
    redo.click()
    settled(page, "Slenderness h/b", 3.0)
    undo.click()
    expect(page.get_by_label("Right foot")).to_have_value("1.9")
    settled(page, "Mass kg", former)


def test_undo_of_a_drawing_leaves_feet_that_were_typed_since(page: Any) -> None:
    """A region added and undone takes nothing along that was typed in the form between the two."""
    open_board(page)
    page.get_by_role("button", name="Add region").click()
    page.get_by_label("Left foot").fill("0.1")
    page.get_by_label("Right foot").fill("0.4")
    settled(page, "Slenderness h/b", 1.25 / 0.15)
    page.get_by_role("button", name="Undo").click()
    settled(page, "Slenderness h/b", 1.0 / 0.15)


def test_a_regular_polygon_becomes_a_polygon_with_every_digit(page: Any) -> None:
    """The corners of a hexagon of radius 1 m are those of the closed form, whatever unit was shown in between."""
    page.get_by_label("Shape").select_option("regular_polygon")
    page.get_by_label("Sides").fill("6")
    page.get_by_label("Radius").fill("1")
    settled(page, "Slenderness h/b", math.sqrt(3.0))
    before = facts(page)
    open_board(page)
    for unit in ("ft", "mm", "m"):
        page.get_by_role("radio", name=unit, exact=True).check()
    found = page.evaluate("JSON.parse(sessionStorage.getItem('rocking.inputs')).body.section.region[0].outline")
    sides = [math.dist(a, b) for a, b in zip(found, [*found[1:], found[0]], strict=True)]
    assert sides == pytest.approx([1.0] * 6, rel=1e-15, abs=4e-16)
    settled(page, "Mass kg", float(before["Mass kg"][0]), rel=1e-15)
