"""Lists of museums in five languages and three forms: headers of several rows, headings, sums, signatures."""

# ruff: noqa: E501, RUF001 - rows of lists are one line; signs of other languages are meant

from dataclasses import replace

import pytest
from unit.decision.inventory.kept_lists import LISTS, write

from rocking.decision.inventory import parse_inventory, read_inventory
from rocking.decision.inventory.lists.columns import header_of
from rocking.decision.inventory.lists.header import find_header
from rocking.decision.inventory.lists.sheets import Sheet
from rocking.errors import InvalidValueError

FORMS = [("xlsx", ""), ("ods", ""), ("csv", "utf-8-sig"), ("csv", "utf-8"), ("csv", "cp1252")]


def outcome(kept, path):
    """What a list gives, as it is stated of kept lists."""
    found = read_inventory(path)
    objects = {
        each.row: (each.number, each.name, each.width, each.depth, each.height, each.count) for each in found.objects
    }
    assert objects.keys() == kept.objects.keys()
    assert all(objects[row][:2] == kept.objects[row][:2] for row in objects)
    assert [objects[row][2:] for row in objects] == [pytest.approx(kept.objects[row][2:], rel=1e-12) for row in objects]
    assert tuple(each.row for each in found.not_assessed) == kept.refused
    assert tuple(each.row for each in found.not_objects) == kept.others
    assert all(each.reason for each in (*found.not_assessed, *found.not_objects))
    assert found.language == kept.language
    by_row = {each.row: each for each in found.objects}
    assert {row: by_row[row].mass for row in kept.masses} == pytest.approx(kept.masses)
    bases = {row: (by_row[row].base_width, by_row[row].base_depth) for row in kept.bases}
    assert bases == {row: pytest.approx(base) for row, base in kept.bases.items()}
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", LISTS)
def test_every_object_of_a_kept_list_is_read(name, tmp_path):
    """Number, name, sizes, count, weight and base of every object as a workbook and as text; every other row is named."""
    kept = LISTS[name]
    for form, encoding in FORMS:
        if encoding == "cp1252" and "\u202f" in "".join(kept.rows):
            continue
        outcome(kept, write(kept, tmp_path / f"list.{form}", encoding))


@pytest.mark.slow
def test_the_comparison_notices_a_column_in_another_place(tmp_path):
    """Negative control: depth and height exchanged, and a sum that has become an object, are noticed."""
    kept = LISTS["merged"]
    swapped = replace(kept, rows=[kept.rows[0], "||Breite|Höhe|Tiefe|||", *kept.rows[2:]])
    with pytest.raises(AssertionError):
        outcome(kept, write(swapped, tmp_path / "swapped.csv"))
    longer = replace(kept, rows=[*kept.rows[:6], "A-21|Krug|20|20|30|2|1|", *kept.rows[7:]])
    with pytest.raises(AssertionError):
        outcome(kept, write(longer, tmp_path / "longer.csv"))


def test_the_header_is_where_most_measures_are_below():
    """Of a row that names all that is needed and two that do so too, those are taken that give every row three sizes."""
    rows = [
        (1, ["Nr.", "Objekt", "Maße (cm)", "", ""]),
        (2, ["", "", "Breite", "Tiefe", "Höhe"]),
        (3, ["1", "Uhr", "40", "30", "200"]),
    ]
    assert header_of(rows[0][1]).missing == []  # the first alone is complete by its words
    found = find_header(Sheet("list", rows), {})
    assert (found.first, found.end, found.header.fields) == (0, 2, {"number", "name", "width", "depth", "height"})
    whole = [(1, ["Nr.", "Objekt", "Maße (cm)"]), (2, ["1", "Uhr", "H 200 x B 40 x T 30"])]
    assert find_header(Sheet("list", whole), {}).end == 1


@pytest.mark.parametrize(
    ("title", "field", "factor"),
    [
        ("Breite / Larghezza (cm)", "width", 0.01), ("Höhe – Altezza [mm]", "height", 0.001),
        ("Profondità (Tiefe) cm", "depth", 0.01), ("Höhe / Altezza / Hauteur / Height in cm", "height", 0.01),
        ("Breite (cm) / Larghezza (cm)", "width", 0.01), ("Gewicht [kg]\nPeso [kg]", "mass", 1.0),
        ("Breite\n(cm)", "width", 0.01), ("Breite / širina (cm)", "width", 0.01),
        (("Maße (cm)", "Breite"), "width", 0.01), (("Maße", "B", "[cm]"), "width", 0.01),
        (("Standfläche", "Tiefe (mm)"), "base_depth", 0.001), (("Gewicht", "t"), "mass", 1000.0),
        (("Dimensions", "Width", "in"), "width", 0.0254), (("Inventar-", "Nr."), "number", 1.0), (("Q.tà", "n."), "count", 1.0),
        (("Sockelmaße in cm", "Breite"), "", None),
        ("Q.tà", "count", 1.0), ("Qté", "count", 1.0), ("Cant.", "count", 1.0), ("Stück / Q.tà", "count", 1.0),
        ("N. d'inv.", "number", 1.0), ("N° inv.", "number", 1.0), ("Nº de inventario", "number", 1.0),
        ("Inv.-Nr. / N. inv.", "number", 1.0), ("Anzahl (Stk.)", "count", 1.0), ("Höhe ohne Sockel cm", "", None),
        (("Höhe (cm)", "ohne Sockel"), "height", 0.01), (("Sockel (cm)", "Höhe"), "", None),
        (("Transportkiste", "Breite cm"), "", None), (("Bestand im Erdgeschoss", "Tiefe cm"), "depth", 0.01),
        ("Breite / Fuß (cm)", "", None), ("Höhe / mit Sockel (cm)", "", None), (("Inventar", "Standort"), "", None),
        (("Höhe (cm)", "vorne"), "", None),
    ],
)  # fmt: skip
def test_titles_of_groups_and_of_two_languages(title, field, factor):
    """A title below another, or beside its translation, is what both say together; of another thing it is nothing."""
    (column,) = header_of([title]).columns
    assert (column.fields[0] if column else "", column.factor if column else None) == (field, factor)


def rows_of(text, **options):
    """Of each object its row, number, name and sizes in centimetres."""
    found = parse_inventory(text, **options)
    return found, [
        (each.row, each.number, each.name, *(round(100.0 * size, 6) for size in (each.width, each.depth, each.height)))
        for each in found.objects
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ("Maße (B x T x H) in cm;40 x 30 x 120", (40, 30, 120)), ("Maße HxBxT cm;120/40/30", (40, 30, 120)),
        ("Maße;40 x 30 x 120 cm (B x T x H)", (40, 30, 120)), ("Maße (cm);H 120 x B 40 x T 30", (40, 30, 120)),
        ("Dimensions (H × l × P) en cm;120 × 40 × 30", (40, 30, 120)), ("Dimensioni cm (HxLxP);120x40x30,5", (40, 30.5, 120)),
        ("Medidas (alto x ancho x fondo, cm);120 x 40 x 30", (40, 30, 120)), ("Size (W x D x H, mm);400 x 300 x 1200", (40, 30, 120)),
        ("Maße B-T-H (cm);40 x 30 x 120", (40, 30, 120)), ("Dimensions (cm);H. 120, l. 40, L. 90", (90, 40, 120)),
    ],
)  # fmt: skip
def test_all_measures_in_one_column(cells, expected):
    """The order is that of the header, of the cell, or of letters; without any of them nothing is guessed."""
    title, cell = cells.split(";")
    _, rows = rows_of(f"Inv.-Nr.;Objekt;{title}\n7;Uhr;{cell}")
    assert rows == [(2, "7", "Uhr", *expected)]
    found, rows = rows_of("Inv.-Nr.;Objekt;Maße (cm)\n7;Uhr;40 x 30 x 120\n8;Uhr;H 120 x B 40 x T 30")
    assert ([row[1] for row in rows], [each.number for each in found.not_assessed]) == (["8"], ["7"])


def test_three_columns_below_one_title_that_names_their_order():
    """A title of an order above as many columns of numbers gives each its side; beside empty ones it stays whole."""
    expected = [(2, "1", "Uhr", 40, 30, 200)]
    assert rows_of("Nr.;Objekt;Maße (B x T x H) in cm;;;Stück\n1;Uhr;40;30;200;1")[1] == expected
    assert rows_of("Nr.;Objekt;Maße (B x T x H) in cm;;\n1;Uhr;40 x 30 x 200;;")[1] == expected


@pytest.mark.slow
@pytest.mark.parametrize("line", ["Alle Maße in mm", "Maßangaben in mm, Gewicht in kg", "Breite, Tiefe, Höhe in mm"])
@pytest.mark.parametrize("place", ["above", "below"])
def test_a_unit_beside_the_table_is_used_and_named(line, place):
    """A line above or below the table states the unit, and the list says which; two that contradict are not used."""
    table = ["Inv.-Nr.;Objekt;Breite;Tiefe;Höhe", "A1;Uhr;400;300;2000"]
    lines = [line, "", *table] if place == "above" else [*table, "", line]
    found, rows = rows_of("\n".join(lines))
    assert [row[1:] for row in rows] == [("A1", "Uhr", 40, 30, 200)]
    assert str(found.stated[0]) == f"line {1 if place == 'above' else 4} of the list states the unit mm"
    with pytest.raises(InvalidValueError, match="must state its unit"):
        parse_inventory("\n".join(table))
    with pytest.raises(InvalidValueError, match="must state its unit"):
        parse_inventory("\n".join([*lines, "", "Alle Angaben in cm"]))


def test_a_header_is_not_read_without_its_group():
    """Sizes of a crate alone are no sizes of the object, though the row of ``B``, ``T``, ``H`` would do by itself."""
    text = "Inv.-Nr.;Objekt;{} (cm);;\nInv.-Nr.;Objekt;B;T;H\n1;Uhr;60;50;220"
    with pytest.raises(InvalidValueError, match="no width and no depth and no height"):
        parse_inventory(text.format("Transportkiste"))
    assert rows_of(text.format("Maße"))[1] == [(3, "1", "Uhr", 60, 50, 220)]  # the control
    above = "Museum, Abteilung Holz,,,,\nInv.-Nr.,Objekt,B cm,T cm,H cm\n1,Uhr,60,50,220"
    assert rows_of(above)[1] == [(3, "1", "Uhr", 60, 50, 220)]


@pytest.mark.slow
def test_columns_keep_the_language_of_the_list():
    """What a user says of columns is in our words, and the report in the language of the list; a lower title serves."""
    for own, code in (("Ding;Maß 1;Maß 2;Maß 3", "de"), ("Cosa;Misura A;Misura B;Misura C", "it")):
        titles = own.split(";")
        columns = dict(zip(titles, ("name", "width_cm", "depth_cm", "height_cm"), strict=True))
        found, rows = rows_of(f"{own}\nUrne;12,5;20;90", map_columns=columns)
        assert (found.language, rows) == (code, [(2, "", "Urne", 12.5, 20, 90)])
    text = "Nr.;Objekt;Korpus (cm);;\n;;X;Y;Z\n1;Urne;12;20;90"
    assert rows_of(text, map_columns="X=width_cm, Y=depth_cm, Korpus (cm) Z=height_cm")[1] == [
        (3, "1", "Urne", 12, 20, 90)
    ]


@pytest.mark.parametrize("own", ["Breite", "Maße (cm)"])
def test_a_title_above_several_columns_names_none_of_them(own):
    """What a user states of a title that two columns have is refused by the whole titles, and not passed over."""
    text = "Nr.;Objekt;Maße (cm);;;Transportkiste (cm);\n;;Breite;Tiefe;Höhe;Breite;Tiefe\n1;Uhr;60;50;220;70;60"
    with pytest.raises(
        InvalidValueError, match=r"no column '.*'\. Its columns are Nr\., Objekt, Maße \(cm\): Breite, "
    ):
        rows_of(text, map_columns={own: "depth_cm"})
    columns = {"Maße (cm): Breite": "depth_cm", "Maße (cm): Tiefe": "width_cm"}
    assert rows_of(text, map_columns=columns)[1] == [(3, "1", "Uhr", 50, 60, 220)]


def test_rows_that_are_no_objects_have_a_reason():
    """Headings, sums and remarks are named with their rows; a row with a number of the list stays one that is missing."""
    found = parse_inventory(
        "Inv.-Nr.;Objekt;Breite cm;Tiefe cm;Höhe cm;Anzahl\nErdgeschoss;;;;;\nA1;Totenmaske;40;30;20;1\n"
        "Summe Erdgeschoss;;;;;1\nSkulpturen;;;;;\nA2;Uhr;40;30;200;1\n;Summe;;;;1\n;;;;;2\nA3;Krug;;;;1\nA4;;;;;\n"
        "5;;;;;\n* ohne Sockel;;;;;\nSumme;80;60;220;2;\nUnterschrift: ____;;;;;\n"
    )
    assert [each.number for each in found.objects] == ["A1", "A2"]
    assert [(each.row, each.number) for each in found.not_assessed] == [(9, "A3"), (10, "A4")]
    reasons = {each.row: str(each.reason) for each in found.not_objects}
    assert reasons == {
        2: "a heading", 4: "a sum or an average", 5: "a heading", 7: "a sum or an average",
        8: "no name, number or size", 11: "only a number", 12: "a remark or a signature",
        13: "a sum or an average", 14: "a remark or a signature",
    }  # fmt: skip


@pytest.mark.slow
def test_one_bad_row_touches_no_other():
    """Whatever stands in one row below a header of two rows, the others are read as without it."""
    head, good = "Nr.;Objekt;Maße (cm);;\n;;B;T;H\n", ("1;Uhr;40;30;200", "2;Krug;20;20;30")
    whole = parse_inventory(f"{head}{good[0]}\n\n{good[1]}").objects
    for bad in (
        "9;x;?;1;1",
        "9;x",
        "9;x;1;1;1;1;1",
        ";;;;",
        "Saal 3;;;;",
        "9;x;1e999;ca.;-",
        "Nr.;Objekt;B;T;H",
        "9;=1+1;#REF!;#NAME?;1",
    ):
        assert parse_inventory(f"{head}{good[0]}\n{bad}\n{good[1]}").objects == whole, bad


def test_thousands_settled_by_their_column():
    """A mark before three digits parts thousands where the other numbers of the column are near, and it is remarked."""
    text = "No.;Object;Width (mm);Depth (mm);Height (mm)\n1;Chest;1,250;800;900.5\n2;Box;350;300;900\n3;Box;360;300;900\n4;Box;370;300;900"
    found, rows = rows_of(text)
    assert rows[0] == (2, "1", "Chest", 125, 80, 90.05)
    assert "read with a thousands separator" in str(found.objects[0].remarks[0])
    found, rows = rows_of(text.replace("370", "1.5"))  # negative control: one number of the column is near neither
    assert [each.number for each in found.not_assessed] == ["1"]
