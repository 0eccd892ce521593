"""Rows that are kept: doubtful measures with an interval and a remark, formats with units, pedestals, shapes."""

# ruff: noqa: E501 - rows of lists are one line

import io
import math
import zipfile

import numpy as np
import pytest
from openpyxl import Workbook
from unit.decision.inventory.test_lists import open_document

from rocking.decision.inventory import InventoryObject, parse_inventory, read_inventory
from rocking.decision.inventory.lists.cells import DecimalMark, measure, parts
from rocking.decision.inventory.lists.columns import WORDS
from rocking.errors import InvalidValueError

H_B_T = ("height", "width", "depth")
HEAD = "Objekt;Breite cm;Tiefe cm;Höhe cm"


@pytest.mark.parametrize(
    ("cell", "value", "half"),
    [
        ("cm 120", 1.2, 0.0), ("120 (mit Sockel)", 1.2, 0.06), ("120 cm inkl. Sockel", 1.2, 0.06), ("(40)", 0.4, 0.02),
        ("(40) cm", 0.4, 0.02), ("[ca. 40] cm", 0.4, 0.02), ("max. 120", 1.2, 0.06), ("cm ca. 120", 1.2, 0.06),
        ("120/130", 1.25, 0.05), ("130/120 cm", 1.25, 0.05), ("120 cm (47 1/4 in.)", 1.2, 0.0), ("120 a 130", 1.25, 0.05),
        ("120 (130 mit Rahmen)", 1.25, 0.05), ("1/2 m", 0.5, 0.0), ("3/4 in", 0.01905, 0.0), ("54 1/2 in", 1.3843, 0.0),
    ],
)  # fmt: skip
def test_what_can_be_read_is(cell, value, half):
    """Units before numbers, remarks behind them, brackets, limits and two sizes: kept, with an interval if in doubt."""
    found = measure("Höhe", cell, 0.01, DecimalMark([]))
    assert (found.value, found.half_width) == pytest.approx((value, half), rel=1e-12, abs=1e-15)


@pytest.mark.parametrize(
    ("cell", "words"),
    [
        ("3/4", "ambiguous: '3/4' could be 0.75 or 3-4"), ("120 (48)", "contains two different sizes"), ("30 kg", "with a unit of m, cm"),
        ("120 mit 130", "must be one number"), ("(40", "must be one number"), ("120 + 10", "must be one number"),
    ],
)  # fmt: skip
def test_what_could_be_two_things_is_not(cell, words):
    """Negative control: a fraction or a range, two sizes that are no one size, a weight as a length."""
    with pytest.raises(InvalidValueError, match=words.replace("(", r"\(")):
        measure("Höhe", cell, 0.01, DecimalMark([]))


@pytest.mark.parametrize(
    ("cell", "order", "expected"),
    [
        ("H 120, Ø 30 cm", (), {"height": 1.2, "diameter": 0.3}),
        ("H 120, Ø 30 cm", H_B_T, {"height": 1.2, "diameter": 0.3}),
        ("Ø 30 cm", H_B_T, {"diameter": 0.3}),
        ("cm 120x40x35", H_B_T, {"height": 1.2, "width": 0.4, "depth": 0.35}),
        ("h. cm 120; diam. cm 30", (), {"height": 1.2, "diameter": 0.3}),
        ("cm 120 x 40 x 35 ca.", H_B_T, {"height": 1.2, "width": 0.4, "depth": 0.35}),
        ("120 (mit Sockel) x (40) x 35 cm", H_B_T, {"height": 1.2, "width": 0.4, "depth": 0.35}),
        ("48 x 16 x 14 in. (122 x 41 x 36 cm)", H_B_T, {"height": 1.2192, "width": 0.4064, "depth": 0.3556}),
        ("48 x 16 x 14 in. (122 x 61 x 36 cm)", H_B_T, "contains two different sizes"),
    ],
)
def test_several_parts_as_they_are_written(cell, order, expected):
    """Heights beside diameters, units first, remarks within, the same in two units, and a contradiction."""
    if isinstance(expected, str):
        with pytest.raises(InvalidValueError, match=expected):
            parts("Maße", cell, order, None, DecimalMark([]), "it")
        return
    found = parts("Maße", cell, order, None, DecimalMark([]), "it")
    assert {side: one.value for side, one in found.items()} == pytest.approx(expected)


def test_units_in_formats_of_numbers(tmp_path):
    """What a number's format writes beside it counts, in .xlsx and .ods; millimetres there are no centimetres."""
    book = Workbook()
    for row in (
        ["Objekt", "Höhe", "Breite", "Tiefe", "Gewicht"],
        ["a", 1200, 40.5, 30, 12],
        ["b", 900, "41 cm", 30, 12],
    ):
        book.active.append(row)
    for line in (2, 3):
        formats = ('0" mm"', "#,##0.0\\ \\c\\m", '"ca. "0.0" cm";-0', '_-* 0 "kg"_-')
        for place, written in enumerate(formats, start=2):
            book.active.cell(line, place).number_format = written
    book.save(tmp_path / "list.xlsx")
    first, second = read_inventory(tmp_path / "list.xlsx").objects
    assert (first.height, first.width, first.depth, first.mass) == pytest.approx((1.2, 0.405, 0.3, 12.0))
    assert (second.width, first.approximate["depth"]) == pytest.approx((0.41, 0.015))
    content = open_document([["Objekt", "Breite", "Tiefe", "Höhe"], ["a", 40.0, 30.0, 120.0]])
    file = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(file, "w") as new:
        text = old.read("content.xml").decode()
        assert "<text:p>x</text:p>" in text
        new.writestr("content.xml", text.replace("<text:p>x</text:p>", "<text:p>40,0 cm</text:p>"))
    (tmp_path / "list.ods").write_bytes(file.getvalue())
    assert read_inventory(tmp_path / "list.ods").objects[0].height == 1.2
    (tmp_path / "list.ods").write_bytes(content)  # negative control: without the words nothing says the unit
    with pytest.raises(InvalidValueError, match="must state its unit"):
        read_inventory(tmp_path / "list.ods")


@pytest.mark.slow
@pytest.mark.parametrize(
    "title", ["Sockel Ø cm", "Sockel-Durchmesser (cm)", "Durchmesser des Sockels cm", "Ø zoccolo cm"]
)
def test_a_pedestal_refuses_no_list(title):
    """Within the object it is its base, beyond it or without a unit it is left aside, and each time that is said."""
    found = parse_inventory(f"{HEAD};{title}\na;40;30;120;20\nb;40;30;120;50\nc;40;30;120;-\nd;40;30;120;rund")
    assert [one.base_width for one in found.objects] == [0.2, None, None, None]
    said = [" ".join(map(str, one.remarks)) for one in found.objects]
    assert ["is used as its base" in said[0], "larger than the object" in said[1], said[2]] == [True, True, ""]
    assert "was ignored" in said[3]
    bare = parse_inventory(f"{HEAD};{title.replace('cm', '').replace('()', '')}\na;40;30;120;20")
    assert (bare.objects[0].base_width, len(bare.ignored)) == (None, 1)


def test_titles_with_commas_are_quoted():
    """A title in quotation marks may have commas; without them they part it."""
    text = 'Objekt;"Maß, B";"Tiefe, innen cm";Tiefe cm;Höhe cm\na;40;20;30;120'
    found = parse_inventory(text, map_columns='"Maß, B"=width_cm, "Tiefe, innen cm"=')
    assert (found.objects[0].width, found.objects[0].depth, found.ignored) == (0.4, 0.3, ("Tiefe, innen cm",))
    with pytest.raises(InvalidValueError, match="own title=name"):
        parse_inventory(text, map_columns="Maß, B=width_cm")


def test_risk_is_the_consequence_in_every_language():
    """A column of risk is read, and as it was not left out, it moves the thresholds."""
    words = {
        "en": "Risk",
        "de": "Risiko",
        "it": "Rischio",
        "fr": "Risque",
        "es": "Riesgo",
        "el": "Κίνδυνος",
        "zh": "风险",
        "tr": "Risk",
    }
    assert words.keys() == WORDS["headers"].keys()
    for word in words.values():
        (one,) = parse_inventory(f"{HEAD};{word}\na;40;30;120;high").objects
        assert one.consequence == "high"


def moments(vertices):
    """Area, centre and second moment about the centre along x of a polygon, by its triangles."""
    (x, y), (u, v) = vertices.T, np.roll(vertices, -1, axis=0).T
    cross = x * v - u * y
    area = 0.5 * cross.sum()
    centre = np.array([((x + u) * cross).sum(), ((y + v) * cross).sum()]) / (6.0 * area)
    return area, centre, ((x * x + x * u + u * u) * cross).sum() / (12.0 * area) - centre[0] ** 2


def nearest_side(vertices):
    """Distance of the centre from the nearest side."""
    along = np.roll(vertices, -1, axis=0) - vertices
    to = moments(vertices)[1] - vertices
    return (np.abs(along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) / np.hypot(*along.T)).min()


def taken(word, width, depth):
    """The object of a row."""
    (one,) = parse_inventory(f"{HEAD};Form\na;{width * 100:.12f};{depth * 100:.12f};120;{word}").objects
    return one


@pytest.mark.parametrize("apex", [0.0, 0.3, 0.5])
@pytest.mark.parametrize(("width", "depth"), [(0.4, 0.3), (0.3, 0.5), (0.4, 0.4 * math.sqrt(0.75))])
def test_a_triangle_is_no_better_than_it_is(apex, width, depth):
    """The body taken reaches no further than the nearest side, and its mass lies no wider; the box reaches further."""
    corners = np.array([[0.0, 0.0], [width, 0.0], [apex * width, depth]])
    one = taken("dreieckig", width, depth)
    radius, spread = 0.5 * one.base("width"), moments(corners)[2]
    assert one.shape == "round"
    assert "the inscribed round body is used" in str(one.remarks[0])
    assert radius <= nearest_side(corners) * (1.0 + 1e-9)
    assert radius == pytest.approx(nearest_side(corners[[0, 1, 2]]), rel=1e-9) or apex > 0.0  # with a right angle, just
    assert one.body("width").local_moments.xx / one.body("width").mass <= spread
    assert 0.5 * min(width, depth) > nearest_side(corners)  # negative control


@pytest.mark.slow
@pytest.mark.parametrize("sides", [5, 6, 8])
@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_a_polygon_is_no_better_than_it_is(sides, turn):
    """Of regular polygons, whichever way their size was taken; a box of that size reaches further."""
    angle = turn + 2.0 * np.pi * np.arange(sides) / sides
    corners = 0.2 * np.column_stack([np.cos(angle), np.sin(angle)])
    width, depth = np.ptp(corners, axis=0)
    radius = 0.5 * taken("achteckig", width, depth).base("width")
    assert 0.8 * nearest_side(corners) < radius <= nearest_side(corners) * (1.0 + 1e-9)
    assert 0.5 * min(width, depth) > nearest_side(corners) * 0.999
    assert str(parse_inventory(f"{HEAD};Form\na;0;0;120;achteckig").not_assessed[0].reason).startswith(
        "width must be in"
    )
    alone = parse_inventory("Objekt;Breite cm;Höhe cm;Form\na;40;120;sechseckig").objects[0]
    assert alone.width == alone.depth == pytest.approx(0.4 * math.cos(math.pi / 5.0))


def test_an_ellipse_is_an_ellipse():
    """Its second moment along either axis is a quarter of that half axis squared; a box of its size has more."""
    one = taken("oval", 0.4, 0.3)
    for way, size in (("width", 0.4), ("depth", 0.3)):
        moments_of = one.body(way).local_moments
        assert moments_of.xx / moments_of.mass == pytest.approx(0.0625 * size**2, rel=1e-12)
        assert one.body(way).mass == pytest.approx(one.body("width").mass, rel=1e-12)
        box = InventoryObject(name="box", width=0.4, depth=0.3, height=1.2).body(way)
        assert box.side("left").moment_of_inertia / box.mass > (
            one.body(way).side("left").moment_of_inertia / one.body(way).mass
        )
    with pytest.raises(InvalidValueError, match="its shape above the smaller base is unknown"):
        one.as_solid()


@pytest.mark.parametrize("word", ["konisch", "L-förmig", "bauchig"])
def test_an_unknown_shape_is_refused_with_those_that_are_known(word):
    """A box of its size might stand better; an empty cell or a question mark is a box, as ever."""
    found = parse_inventory(f"{HEAD};Form\na;40;30;120;{word}\nb;40;30;120;\nc;40;30;120;?\nd;40;30;120;eckig")
    assert [(one.name, one.shape) for one in found.objects] == [("b", "box"), ("c", "box"), ("d", "box")]
    assert "Use round, oval, rectangular, triangular or polygonal" in str(found.not_assessed[0].reason)


@pytest.mark.parametrize("cell", ["Fuß 12", "Piedi 12", "in 12", "Fuss: 12"])
def test_a_foot_before_a_number_is_no_unit(cell):
    """It is that of the object: 12 cm would become 3.66 m, which stands better; behind the number it is one."""
    with pytest.raises(InvalidValueError, match="must be one number"):
        measure("Breite cm", cell, 0.01, DecimalMark([]))
    assert measure("Breite cm", "12 Fuß", 0.01, DecimalMark([])).value == pytest.approx(12 * 0.3048)


def test_the_height_of_a_pedestal_is_ignored_remark():
    """It refuses no list, and the report names it among what was not read; an unknown width still does."""
    found = parse_inventory("Objekt;Breite cm;Tiefe cm;Höhe cm;Sockelhöhe cm\nA;12;12;60;5\n")
    assert (found.objects[0].height, found.ignored) == (0.6, ("Sockelhöhe cm",))
    with pytest.raises(InvalidValueError, match="resembles a size"):
        parse_inventory("Objekt;Breite cm;Tiefe cm;Höhe cm;Rahmenbreite cm\nA;12;12;60;5\n")


def test_a_row_of_units_below_the_header():
    """It is that of its columns, if it holds units alone; a row with a name is an object, and kilograms no length."""
    rows = "A;12;12;600;5\n"
    (one,) = parse_inventory(f"Objekt;Breite;Tiefe;Höhe;Gewicht\n;cm;(cm);[mm];kg\n{rows}").objects
    assert (one.width, one.depth, one.height, one.mass) == (0.12, 0.12, 0.6, 5.0)
    with pytest.raises(InvalidValueError, match="must state its unit"):
        parse_inventory(f"Objekt;Breite;Tiefe;Höhe;Gewicht\n;kg;cm;mm;kg\n{rows}")
    named = parse_inventory(f"Objekt;Breite cm;Tiefe cm;Höhe cm;Gewicht kg\nUnits;cm;cm;mm;kg\n{rows}")
    assert (len(named.objects), named.not_assessed[0].name) == (1, "Units")
