"""Inventories from files: columns, units, decimals, rows that are refused, and the objects they make."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.bodies import Block
from rocking.decision.inventory import InventoryObject, parse_inventory, read_inventory
from rocking.decision.inventory.lists.cells import DecimalMark
from rocking.decision.inventory.objects import DIRECTIONS
from rocking.errors import InvalidValueError

HEAD = "name,width_cm,depth_cm,height_cm"
GOOD = "vase,20,25,100"


def only(text):
    """The single object of a text."""
    found = parse_inventory(text)
    assert found.not_assessed == ()
    (one,) = found.objects
    return one


@pytest.mark.parametrize(
    "text",
    [
        "name,width_cm,depth_cm,height_cm\nvase,12.5,20,100",
        "name;width_cm;depth_cm;height_cm\nvase;12,5;20;100",
        "name;width_cm;depth_cm;height_cm\r\nvase;12.5;20.0;100\r\n",
        "name\twidth_cm\tdepth_cm\theight_cm\nvase\t12,5\t20\t100",
        'name,width_cm,depth_cm,height_cm\nvase,"12,5",20,100',
        "\ufeffName , Width (cm),Depth [cm],HEIGHT cm\nvase, 12.5 ,20,1e2\n\n",
        "height_m,name,width_mm,depth_in\n1,vase,125,7.874015748031496",
        "\n name;width_cm;depth_cm;height_cm\nvase;12,5;20;100\n;;;\n",
    ],
)
def test_same_object_however_it_is_written(text):
    """Commas, semicolons, tabs, decimal commas, units by the column, blanks and empty lines: one vase."""
    vase = only(text)
    assert vase.name == "vase"
    assert (vase.width, vase.depth, vase.height) == pytest.approx((0.125, 0.2, 1.0), rel=1e-12, abs=0.0)


def test_every_column():
    """Optional columns arrive in SI units; what is not known is named as not read."""
    head = "room,base_width_cm,base_depth_mm,centre of mass height (cm),weight_g,count,note," + HEAD
    found = parse_inventory(f"{head}\nhall,10,120,45,5000,3,on a shelf,{GOOD}")
    (vase,) = found.objects
    assert (vase.base_width, vase.base_depth, vase.centre_of_mass_height, vase.mass) == pytest.approx(
        (0.1, 0.12, 0.45, 5.0)
    )
    assert (vase.count, vase.note, vase.row, found.ignored) == (3, "on a shelf", 2, ("room",))
    assert only(f"center_of_mass_height_cm,{HEAD}\n30,{GOOD}").centre_of_mass_height == 0.3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("x,,25,100", "Enter width_cm"),
        ("x,20,25", "the line has 3 fields, but the header has 4; Check the separator"),
        ("x,20,5,25,100", "Check for a decimal comma"),
        ("x,20 stone,25,100", "with a unit of m, cm, mm"),
        ("x,20 30,25,100", "must be one number"),
        ("x,130-120,25,100", "from the smaller to the larger"),
        ("x,#REF!,25,100", "width_cm is '#REF!'"),
        ("x,?,25,100", "width_cm is '?'"),
        ("x,2024-05-12,25,100", "a date"),
        ("x,1/0,25,100", "from the smaller to the larger"),
        ("x,abc,25,100", "must be one number"),
        ("x,nan,25,100", "must be one number"),
        ("x,inf,25,100", "must be one number"),
        ("x,1e999,25,100", "must be finite"),
        ("x,-20,25,100", "width must be in"),
        ("x,0,25,100", "width must be in"),
        ("x,20,25,100000", "Check the unit"),
        ("x,0x14,25,100", "must be one number"),
        ("x,1_000,25,100", "must be one number"),
        ("x,=20,25,100", "must be one number"),
        ("x,\u0662\u0660,25,100", "must be one number"),
        ('x,"1,234",25,100', "ambiguous"),
        ('x,"1.234.5",25,100', "separators of thousands"),
        ("x,20 300,25,100", "must be one number"),
        ("x,20..5,25,100", "must be one number"),
    ],
)
def test_bad_row_is_reported_and_touches_no_other(row, words):
    """The row is named with its line and the reason; the rows around it are read as if it were not there."""
    found = parse_inventory(f"{HEAD}\n{GOOD}\n{row}\nbox,30,30,60")
    assert [one.name for one in found.objects] == ["vase", "box"]
    assert found.objects[0] == only(f"{HEAD}\n{GOOD}")
    (bad,) = found.not_assessed
    assert (bad.row, bad.name) == (3, row.split(",", maxsplit=1)[0])
    assert words in str(bad.reason)


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("base_width_cm", "21", "at most the width"),
        ("centre_of_mass_height_cm", "120", "below the height"),
        ("base_width_cm", "abc", "must be one number"),
    ],
)
def test_bad_value_that_decides(column, value, words):
    """A base or centre that does not fit the others makes the row one that is not assessed."""
    found = parse_inventory(f"{HEAD},{column}\n{GOOD},{value}\n{GOOD},")
    assert len(found.objects) == 1
    assert words in str(found.not_assessed[0].reason)


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("weight_kg", "1e7", "Check the units of weight"),
        ("weight_kg", "heavy", "weight was ignored"),
        ("count", "1.5", "not a count; 1 is used"),
        ("count", "1e300", "not a count; 1 is used"),
        ("count", "many", "not a count; 1 is used"),
        ("count", "0", "count must be a whole number"),
        ("friction", "smooth", "friction was ignored"),
        ("friction", "-1", "friction was ignored"),
        ("consequence", "***", "high is used"),
        ("photo", "no-such.jpg", "no picture in the folder of the list"),
        ("base_cm", "?", "the default is used"),
    ],
)
def test_bad_value_that_does_not_decide(column, value, words):
    """What does not change how an object rocks is left aside with a remark, and the object is assessed."""
    first, second = parse_inventory(f"{HEAD},{column}\n{GOOD},{value}\n{GOOD},").objects
    assert words in " ".join(map(str, first.remarks))
    assert first.consequence == ("high" if column == "consequence" else "medium")  # the careful side
    assert replace(first, remarks=(), row=3, consequence="medium") == second


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "the first line must contain the columns"),
        ("vase,20,25,100", "the first line must contain the columns"),
        ("name,width,depth,height\nvase,20,25,100", "'width' must state its unit: width_m, width_cm"),
        (HEAD, "at least one row"),
        (f"{HEAD},width_mm\n{GOOD},200", "two columns contain the width"),
        (f"{HEAD},base_width\n{GOOD},10", "must state its unit: base_width_m"),
        (f"{HEAD},base_width_km\n{GOOD},10", "must state its unit"),
        (f"{HEAD},base_widht_cm\n{GOOD},10", "similar: base_width_cm"),
        (f"{HEAD},wieght_kg\n{GOOD},10", "similar: weight_kg"),
        (f"{HEAD},foot_width_cm\n{GOOD},10", "unknown column 'foot_width_cm' resembles a size"),
        (f"{HEAD},diameter\n{GOOD},10", "'diameter' must state its unit"),
        (f"{HEAD},Rahmenbreite\n{GOOD},10", "resembles a size"),
        (f"{HEAD},Sockel\n{GOOD},10", "unknown column 'Sockel' resembles a size"),
        (f"{HEAD},length_cm\n{GOOD},10", "unknown column 'length_cm' resembles a size, in addition to width and depth"),
        ("Objekt;Breite cm;Farbe\nx;1;2", "the header contains no depth and no height, only 'Objekt' as name"),
        (
            "name,width_cm,height_cm\nvase,20,90",
            "add a column depth_cm, or map one with map_columns=; if the depth is unknown, copy the width",
        ),
        (f"{HEAD},gross (kg)\n{GOOD},10", "resembles a size"),
        (f"{HEAD},centre of area\n{GOOD},10", "resembles a size"),
        (f"{HEAD},base\n{GOOD},10", "'base' must state its unit: base_m"),
        (f"{HEAD},base_cm,base_depth_cm\n{GOOD},10,9", "two columns contain the base depth"),
        (f"{HEAD},mass_kg,weight_kg\n{GOOD},10,9", "two columns contain the mass"),
        ("sep=|\nname|width_cm|depth_cm|height_cm\nvase|1|2|3", "the first line must contain the columns"),
        ("sep=;\n" + HEAD + "\n" + GOOD, "the first line must contain the columns"),
        (f'{HEAD}\n"vase,20,25,100', "quotation mark"),
    ],
)
def test_file_that_cannot_be_understood(text, words):
    """A header without columns or units, or a broken table, refuses the whole file: nothing is guessed."""
    with pytest.raises(InvalidValueError, match=words):
        parse_inventory(text)


@pytest.mark.parametrize(
    ("cells", "cell", "value"),
    [
        (["1,5", "1,234"], "1,234", 1.234),
        (["0,125"], "0,125", 0.125),
        (["1.234"], "1.234", None),
        (["12.5", "1.234"], "1.234", 1.234),
        (["12.5", "7,25", "1.234"], "1.234", None),
        (["12,5", "1.234"], "1.234", None),
        (["12,5", "7.5", "1,234"], "1,234", None),
        (["1,234"], "1,234", None),
        (["1234,567"], "1234,567", 1234.567),
        (["1,2345"], "1,2345", 1.2345),
        (["-1,5e-3"], "-1,5e-3", -0.0015),
        ([], "1.234,5", 1234.5),
        ([], "1,234.5", 1234.5),
        ([], "12.345.678", 12345678.0),
        ([], "1'234", 1234.0),
        ([], "2\u202f350", 2350.0),
        ([], "2 350,5", 2350.5),
        (["1.234,5"], "1.234", 1234.0),
        (["1.234,5", "12.5"], "1.234", None),
    ],
)
def test_decimal_mark(cells, cell, value):
    """A comma or point before three digits is read only where the table itself settles what it is."""
    mark = DecimalMark(cells)
    if value is None:
        with pytest.raises(InvalidValueError, match="ambiguous"):
            mark.number("width_cm", cell)
    else:
        assert mark.number("width_cm", cell) == pytest.approx(value, rel=1e-15, abs=0.0)


def test_a_point_before_three_digits_needs_proof_unless_commas_part_the_fields():
    """1.800 in a German table of millimetres is not taken for 1.8 mm; between commas decimals have points."""
    german = "name;width_cm;depth_cm;height_mm\nvase;30;30;1.800"
    for text in (german, german.replace(";", "\t")):
        found = parse_inventory(text)
        assert found.objects == ()
        assert "'1.800' could be 1.800 or 1800. Write 1.8000 or 1800" in str(found.not_assessed[0].reason)
    proven = parse_inventory("name;width_cm;depth_cm;height_cm\nvase;30;30;1.800\nbox;12.5;30;40")
    assert proven.objects[0].height == pytest.approx(0.018)
    assert only("name,width_m,depth_m,height_m\nvase,0.3,0.3,1.800").height == 1.8


@pytest.mark.parametrize(
    ("column", "field", "value"),
    [
        ("mass_kg", "mass", 5.0),
        ("Mass [g]", "mass", 5.0),
        ("centre_of_gravity_cm", "centre_of_mass_height", 0.05),
        ("center of gravity (mm)", "centre_of_mass_height", 0.005),
        ("com_height_cm", "centre_of_mass_height", 0.05),
        ("center_of_mass_height_cm", "centre_of_mass_height", 0.05),
        ("base_cm", "base_width", 0.05),
        ("base_cm", "base_depth", 0.05),
    ],
)
def test_other_names_of_columns(column, field, value):
    """Names that people use give the field they mean; a base without a direction is that of both."""
    cell = "5000" if column == "Mass [g]" else "5"
    assert getattr(only(f"{HEAD},{column}\n{GOOD},{cell}"), field) == pytest.approx(value)


def test_a_narrow_base_is_not_dropped():
    """The base of 5 cm under a body of 20 cm sets the uplift: g 5/100, not g 20/100."""
    vase = only(f"{HEAD},base_cm\n{GOOD},5")
    assert vase.uplift_acceleration("width") == pytest.approx(0.05 * 9.80665, rel=1e-14, abs=0.0)
    assert vase.uplift_acceleration("depth") == pytest.approx(0.05 * 9.80665, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(("line", "mark"), [("sep=;", ";"), ('"sep=;"', ";"), ("SEP=,", ","), ("sep=\t", "\t")])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_the_line_that_excel_writes_first(line, mark, end):
    """Excel's line about the separator is no header, gives the separator, and is counted among the lines."""
    found = parse_inventory(end.join([line, HEAD.replace(",", mark), GOOD.replace(",", mark)]))
    assert (found.objects[0].width, found.objects[0].row) == (0.2, 3)


def test_encodings(tmp_path):
    """A list from an older spreadsheet is read, the encoding that was assumed is said; one that is named is taken."""
    path = tmp_path / "objects.csv"
    path.write_bytes(f"{HEAD}\nfigurine en gr\u00e8s,20,25,100".encode("cp1252"))
    with pytest.raises(InvalidValueError, match="CSV UTF-8"):
        read_inventory(path, "utf-8")
    found = read_inventory(path)
    assert (found.objects[0].name, found.source) == ("figurine en gr\u00e8s", "objects.csv (cp1252)")
    assert read_inventory(path, "cp1252").source == "objects.csv (cp1252)"
    with pytest.raises(InvalidValueError, match="state its encoding"):
        read_inventory(path, "no-such")


@pytest.mark.slow
@given(st.text(max_size=60), st.sampled_from([",", ";", "\t"]))
def test_any_text_is_an_inventory_or_an_error(junk, mark):
    """Whatever stands below the header is an object, a row with a reason, or refused: never another exception."""
    head = HEAD.replace(",", mark)
    try:
        found = parse_inventory(f"{head}\n{junk}\n{GOOD.replace(',', mark)}")
    except InvalidValueError:
        return
    assert all(row.reason for row in found.not_assessed)
    assert found.objects or found.not_assessed


G = 9.80665
SIZE = {"name": "thing", "width": 0.4, "depth": 0.3, "height": 1.2}


def test_uplift_is_g_b_over_h():
    """Without base and centre: g B / H in either direction; the block itself says the same."""
    thing = InventoryObject(**SIZE)
    assert thing.uplift_acceleration("width") == pytest.approx(G * 0.4 / 1.2, rel=1e-14, abs=0.0)
    assert thing.uplift_acceleration("depth") == pytest.approx(G * 0.3 / 1.2, rel=1e-14, abs=0.0)
    assert thing.body("width") == Block(width=0.4, height=1.2, depth=0.3)


@pytest.mark.parametrize("centre", [None, 0.3, 0.6, 0.9])
@pytest.mark.parametrize("base", [None, 0.2])
def test_body_has_the_base_and_the_centre_that_were_measured(base, centre):
    """Mass, height of the centre and half the base come out; alpha = atan(b / z); uplift is g b / z."""
    thing = InventoryObject(**SIZE, mass=80.0, base_width=base, base_depth=base, centre_of_mass_height=centre)
    height = 0.6 if centre is None else centre
    for way in DIRECTIONS:
        half = 0.5 * (base or SIZE[way])
        for foot in ("left", "right"):
            side = thing.body(way).side(foot)
            assert side.mass == pytest.approx(80.0, rel=1e-12, abs=0.0)
            assert side.centre_height == pytest.approx(height, rel=1e-12, abs=0.0)
            assert side.slenderness_angle == pytest.approx(math.atan(half / height), rel=1e-12, abs=0.0)
            assert side.uplift_acceleration == pytest.approx(thing.uplift_acceleration(way), rel=1e-12, abs=0.0)


def test_moment_of_inertia_is_that_of_two_rectangles():
    """Centre at a third: two thirds of the mass below it, one third above, each even; I about the foot by hand."""
    thing = InventoryObject(**SIZE, mass=90.0, centre_of_mass_height=0.4)
    inertia = 0.0
    for mass, height, middle in ((60.0, 0.4, 0.2), (30.0, 0.8, 0.8)):
        inertia += mass * ((0.4**2 + height**2) / 12.0 + 0.2**2 + middle**2)
    assert thing.body("width").side("left").moment_of_inertia == pytest.approx(inertia, rel=1e-12, abs=0.0)


def test_weight_does_not_matter():
    """Frequency parameter and angle are those of any other weight."""
    light, heavy = (InventoryObject(**SIZE, mass=mass).body("width").side("left") for mass in (2.0, 2000.0))
    assert light.frequency_parameter == pytest.approx(heavy.frequency_parameter, rel=1e-12, abs=0.0)
    assert light.slenderness_angle == heavy.slenderness_angle


def test_base_as_wide_as_the_body_is_the_body():
    """A base that equals the width but for the rounding of units is the width."""
    thing = InventoryObject(**SIZE, base_width=0.4 * (1.0 + 1e-12))
    assert thing.base("width") == 0.4
    assert isinstance(thing.body("width"), Block)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"name": " "}, "name must not be empty"),
        ({"width": 0.0}, "width must be in"),
        ({"depth": -1.0}, "depth must be in"),
        ({"height": math.nan}, "height must be finite"),
        ({"height": math.inf}, "height must be finite"),
        ({"height": 180.0}, "Check the unit"),
        ({"width": "0.4"}, "width must be a number"),
        ({"base_width": 0.5}, "base_width must be at most the width of the body, 0.4 m"),
        ({"base_depth": 0.31}, "base_depth must be at most the depth"),
        ({"centre_of_mass_height": 1.2}, "must be below the height"),
        ({"centre_of_mass_height": 0.0}, "centre_of_mass_height must be in"),
        ({"mass": 0.0}, "weight must be > 0"),
        ({"mass": 80000.0}, "Check the units of weight"),
        ({"mass": 0.08}, "Check the units of weight"),
        ({"count": 0}, "count must be a whole number"),
        ({"count": 1.5}, "count must be a whole number"),
        ({"count": True}, "count must be a whole number"),
    ],
)
def test_refusals(change, words):
    """Every value outside its range is refused, and the error names what was measured."""
    with pytest.raises(InvalidValueError, match=words):
        InventoryObject(**(SIZE | change))
