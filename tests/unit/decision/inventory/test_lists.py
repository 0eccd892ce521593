"""Lists as people keep them: workbooks, encodings, languages, units in cells, round bodies, and what may be wrong."""

# ruff: noqa: E501, RUF001 - rows of lists are one line; words of other alphabets are meant

import io
import math
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openpyxl import Workbook
from PIL import Image
from unit.decision.inventory.museum_list import write_museum_list

import rocking as rk
from rocking.decision.inventory import InventoryObject, parse_inventory, read_inventory
from rocking.decision.inventory.lists.cells import ABOUT, DecimalMark, measure, parts
from rocking.decision.inventory.lists.columns import WORDS, header_of
from rocking.errors import InvalidValueError, RockingError

HEADS = {
    "en": "object;width (cm);depth (cm);height (cm);weight (kg);note",
    "de": "Objekt;Breite [cm];Tiefe in cm;Höhe cm;Gewicht/kg;Bemerkung",
    "it": "Oggetto;Larghezza cm;Profondità cm;Altezza cm;Peso kg;Osservazioni",
    "es": "Objeto;Ancho (cm);Profundidad (cm);Altura (cm);Peso (kg);Observaciones",
    "el": "Αντικείμενο;Πλάτος (εκ.);Βάθος (εκ.);Ύψος (εκ.);Βάρος (kg);Παρατηρήσεις",
    "zh": "名称;宽（厘米）;深（厘米）;高（厘米）;重量（公斤）;备注",
    "tr": "Eser adı;Genişlik (cm);Derinlik (cm);Yükseklik (cm);Ağırlık (kg);Açıklama",
}
OLD = {"en": "cp1252", "de": "cp1252", "it": "cp1252", "es": "cp1252", "el": "cp1253", "zh": "gb18030", "tr": "cp1254"}
ROW = "Urne;20,5;25;100;12;alt"


def only(text):
    """The single object of a text."""
    found = parse_inventory(text)
    assert found.not_assessed == ()
    (one,) = found.objects
    return one


@pytest.mark.slow
@pytest.mark.parametrize("language", HEADS)
def test_every_language_in_every_encoding(language, tmp_path):
    """The same object whatever the language and the encoding of the list; which one was assumed is said."""
    path = tmp_path / "list.csv"
    text = f"{HEADS[language]}\n{ROW}\n"
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", OLD[language]):
        path.write_bytes(text.encode(encoding))
        found = read_inventory(path)
        (one,) = found.objects
        assert (one.width, one.depth, one.height, one.mass) == pytest.approx((0.205, 0.25, 1.0, 12.0))
        assert (found.language, found.ignored, one.note) == (language, (), "alt")
        ascii_alone = text.isascii() and encoding == OLD[language]
        assert found.source == ("list.csv" if ascii_alone or "utf" in encoding else f"list.csv ({encoding})")


def test_mac_roman_is_told_by_its_header(tmp_path):
    """The umlaut of an old Macintosh makes a word only in its own encoding."""
    path = tmp_path / "list.csv"
    path.write_bytes("Objekt;Breite cm;Tiefe cm;Höhe cm\nKästchen;20;20;30".encode("mac_roman"))
    found = read_inventory(path)
    assert (found.objects[0].name, found.source) == ("Kästchen", "list.csv (mac_roman)")


@pytest.mark.parametrize("language", WORDS["headers"])
def test_words_of_a_language_do_not_contradict(language):
    """No word of a language means two things, and a header of its first words is understood whole, in that language."""
    words = [word.strip() for text in WORDS["headers"][language].values() for word in text.split(",")]
    assert len(words) == len(set(words))
    first = {field: text.split(",")[0] for field, text in WORDS["headers"][language].items()}
    found = header_of(
        [f"{word} cm" if field in {"width", "depth", "height"} else word for field, word in first.items()]
    )
    assert found.language == language
    assert [each.stem for each in found.columns] == list(first)


@pytest.mark.parametrize(
    ("title", "field"),
    [
        ("Hoehe (cm)", "height"), ("HÖHE_cm", "height"), ("H [cm]", "height"), ("Maß T (cm)", "depth"),
        ("Gesamtbreite in cm", "width"), ("max. Höhe cm", "height"), ("Länge cm", "depth"), ("Ø cm", "diameter"),
        ("Stärke mm", "depth"), ("Fussbreite cm", "base_width"), ("Masse kg", "weight"),
    ],
)  # fmt: skip
def test_spellings_of_a_title(title, field):
    """Case, umlauts in both spellings, brackets and fillers do not matter; a length is the side that is not given."""
    found = header_of(["Objekt", "Breite" if field == "depth" else "Standort", title]).columns[2]
    assert field in {found.stem, *found.fields}
    assert found.factor in {0.01, 0.001, 1.0}


@pytest.mark.parametrize(
    ("cell", "value", "half"),
    [
        ("120", 1.2, 0.0), (120.0, 1.2, 0.0), ("120 cm", 1.2, 0.0), ("1,2 m", 1.2, 0.0), ("1200mm", 1.2, 0.0),
        ("4 ft 6 in", 1.3716, 0.0), ("4' 6\"", 1.3716, 0.0), ('54"', 1.3716, 0.0), ('54 1/2"', 1.3843, 0.0),
        ("54½ in", 1.3843, 0.0), ("1 m 20 cm", 1.2, 0.0), ("120 厘米", 1.2, 0.0), ("120 εκ.", 1.2, 0.0),
        ("ca. 120", 1.2, 0.06), ("~120", 1.2, 0.06), ("etwa 120 cm", 1.2, 0.06), ("circa 1,2 m", 1.2, 0.06),
        ("about 120", 1.2, 0.06), ("ungefähr 120", 1.2, 0.06), ("περίπου 120", 1.2, 0.06), ("约120", 1.2, 0.06),
        ("120?", 1.2, 0.06), ("120 (ca.)", 1.2, 0.06), ("120-130", 1.25, 0.05), ("120 \u2013 130 cm", 1.25, 0.05),
        ("120 bis 130", 1.25, 0.05), ("1,2-1,3 m", 1.25, 0.05), ("120 ± 5", 1.2, 0.05), ("120 +/- 5 cm", 1.2, 0.05),
    ],
)  # fmt: skip
def test_measures(cell, value, half):
    """A number with or without its unit, about, between two or give or take: its value and half its interval."""
    found = measure("height", cell, 0.01, DecimalMark(["1,2"]))
    assert (found.value, found.half_width) == pytest.approx((value, half), rel=1e-12, abs=1e-15)
    assert ABOUT == 0.05


@pytest.mark.parametrize(
    ("cell", "order", "expected"),
    [
        ("120 x 80 x 220 cm", ("height", "width", "depth"), {"height": 1.2, "width": 0.8, "depth": 2.2}),
        ("120×80×220 mm", ("width", "depth", "height"), {"width": 0.12, "depth": 0.08, "height": 0.22}),
        ("H 120 cm, B 80 cm, T 40 cm", (), {"height": 1.2, "width": 0.8, "depth": 0.4}),
        ("Höhe: 1,2 m; Breite: 80 cm; Tiefe: 40 cm", (), {"height": 1.2, "width": 0.8, "depth": 0.4}),
        ("Ø 30 x 60 cm", ("height", "width", "depth"), {"diameter": 0.3, "height": 0.6}),
        ("L 120 x B 80 x H 40 cm", (), {"depth": 1.2, "width": 0.8, "height": 0.4}),
        ("120 x 80 x 220 cm", (), None), ("120 x 80 cm", ("height", "width", "depth"), None), ("120", (), None),
        ("H 120 x H 80 x T 40 cm", (), None), ("120 x 80 x 40", ("height", "width", "depth"), None),
    ],
)  # fmt: skip
def test_measures_of_several_parts(cell, order, expected):
    """Sides by the order of the header or by their own letters; without either, or without a unit, nothing is guessed."""
    if expected is None:
        with pytest.raises(InvalidValueError, match=r"order|parts|unit"):
            parts("Maße", cell, order, None, DecimalMark(["1,2"]), "de")
        return
    found = parts("Maße", cell, order, None, DecimalMark(["1,2"]), "de")
    assert {side: one.value for side, one in found.items()} == pytest.approx(expected)


def test_user_says_what_columns_are():
    """Own titles are mapped to ours; one that is nothing is left out, one that is not there or no target refused."""
    text = "Ding;Maß 1;Maß 2;Maß 3;Rahmenbreite\nx;20;30;90;4"
    with pytest.raises(InvalidValueError, match="must contain the columns"):
        parse_inventory(text)
    ours = "Ding=name, Maß 1=width_cm, Maß 2=depth_cm, Maß 3=height_cm"
    with pytest.raises(InvalidValueError, match="unknown column 'Rahmenbreite' resembles a size"):
        parse_inventory(text, map_columns=ours)
    found = parse_inventory(text, map_columns=f"{ours}, Rahmenbreite=")
    assert (found.objects[0].width, found.objects[0].height, found.ignored) == (0.2, 0.9, ("Rahmenbreite",))
    for wrong, words in (
        ("Dinge=name", "no column 'Dinge'. Its columns are Ding"),
        ("Ding=colour", "cannot be 'colour'"),
        ("x", "own title"),
    ):
        with pytest.raises(InvalidValueError, match=words):
            parse_inventory(text, map_columns=f"{ours}, Rahmenbreite=, {wrong}")
    sized = parse_inventory("Objekt;Maße\nx;90 x 20 x 30 cm", map_columns={"Maße": "height x width x depth"})
    assert (sized.objects[0].height, sized.objects[0].depth) == (0.9, 0.3)


def open_document(rows, merged=""):
    """Bytes of an .ods with two tables; the second repeats empty cells and rows a million times."""

    def cell(value):
        if isinstance(value, float):
            return f'<table:table-cell office:value-type="float" office:value="{value!r}"><text:p>x</text:p></table:table-cell>'
        return f'<table:table-cell office:value-type="string"{merged}><text:p>{value}</text:p></table:table-cell>'

    lines = "".join(f"<table:table-row>{''.join(map(cell, row))}</table:table-row>" for row in rows)
    blank = '<table:table-row table:number-rows-repeated="1048570"><table:table-cell table:number-columns-repeated="16384"/></table:table-row>'
    content = (
        '<?xml version="1.0"?><office:document-content xmlns:office="o" xmlns:table="t" xmlns:text="x"><office:body><office:spreadsheet>'
        f'<table:table table:name="A">{blank}</table:table><table:table table:name="B">{lines}{blank}</table:table>'
        "</office:spreadsheet></office:body></office:document-content>"
    )
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("content.xml", content)
    return file.getvalue()


def test_open_document(tmp_path):
    """An .ods gives numbers as they are, the table that is a list, and does not trip over a million empty rows."""
    path = tmp_path / "list.ods"
    path.write_bytes(
        open_document(
            [["Titel der Liste"], ["Objekt", "Breite cm", "Tiefe cm", "Höhe cm"], ["Urne", 12.345, 20.0, "ca. 90"]]
        )
    )
    found = read_inventory(path)
    (one,) = found.objects
    assert (one.width, one.row, found.source) == (0.12345, 3, "list.ods (B)")
    assert one.approximate == pytest.approx({"height": 0.045})


def workbook(path, sheets, merge=()):
    """Write an .xlsx."""
    book = Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
        for each in merge:
            sheet.merge_cells(each)
    book.save(path)
    return path


HEAD = ["Objekt", "Breite cm", "Tiefe cm", "Höhe cm"]


@pytest.mark.slow
def test_merged_cells_and_several_sheets(tmp_path):
    """What is merged downwards holds in each of its rows; two lists in one workbook are refused."""
    rows = [HEAD, ["a", 20, 30, 90], ["b", 20, None, 80]]
    found = read_inventory(workbook(tmp_path / "m.xlsx", {"x": rows}, ["C2:C3"]))
    assert [one.depth for one in found.objects] == [0.3, 0.3]
    with pytest.raises(InvalidValueError, match=r"the file contains several lists: two.xlsx \(x\), two.xlsx \(y\)"):
        read_inventory(workbook(tmp_path / "two.xlsx", {"x": rows, "y": rows}))
    with pytest.raises(InvalidValueError, match="the header contains no height, only 'Objekt' as name"):
        read_inventory(workbook(tmp_path / "none.xlsx", {"x": [HEAD[:3], ["a", 1, 2]]}))


@pytest.mark.slow
def test_a_cell_far_away_is_quick(tmp_path):
    """A workbook whose last row and column are as far away as they can be is read without them."""
    book = Workbook()
    for row in (HEAD, ["a", 20, 30, 90]):
        book.active.append(row)
    book.active.cell(900_000, 16_384, "x")
    book.save(tmp_path / "far.xlsx")
    assert len(read_inventory(tmp_path / "far.xlsx").objects) == 1


def bomb(name, size):
    """Bytes of an archive that unpacks to zeros of a size."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, b"\0" * size)
    return file.getvalue()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (bomb("xl/workbook.xml", 70 << 20), "the unpacked file is larger"),
        (bomb("xl/workbook.xml", 9), "the workbook is damaged"),
        (bomb("content.xml", 9), "the workbook is damaged"),
        (bomb("other", 9), "unsupported file"),
        (b"\xd0\xcf\x11\xe0 old", "an old .xls"),
        (b"PK\x03\x04 cut off", "the workbook is damaged"),
        (bytes(range(256)) * 9, "not text in any encoding"),
        (bytes(range(1, 256)) * 9, "must contain the columns"),
        (b"", "must contain the columns"),
    ],
)
def test_files_that_are_no_list(content, words, tmp_path):
    """Bombs, the workbook is damageds and other files are refused in one sentence."""
    path = tmp_path / "list.xlsx"
    path.write_bytes(content)
    with pytest.raises(InvalidValueError, match=words):
        read_inventory(path)


@pytest.mark.slow
def test_photos_stay_beside_the_list(tmp_path):
    """A picture beside the list or in a folder there is taken; one elsewhere, missing or broken is a remark."""
    folder = tmp_path / "lists"
    (folder / "photos").mkdir(parents=True)
    for place in (folder / "photos" / "a.png", tmp_path / "secret.png"):
        Image.new("RGB", (2, 2)).save(place)
    (folder / "broken.png").write_bytes(b"none")
    (folder / "link.png").symlink_to(tmp_path / "secret.png")
    names = [
        "photos/a.png",
        "photos\\a.png",
        "../secret.png",
        str(tmp_path / "secret.png"),
        "broken.png",
        "no.png",
        "link.png",
    ]
    path = folder / "list.csv"
    path.write_text("name,width_cm,depth_cm,height_cm,photo\n" + "".join(f"x,1,1,1,{name}\n" for name in names))
    found = read_inventory(path)
    assert [one.photo == folder / "photos" / "a.png" for one in found.objects] == [True, True] + [False] * 5
    assert all("is no picture in the folder of the list" in str(one.remarks[0]) for one in found.objects[2:])


@pytest.mark.parametrize("centre", [None, 0.3, 0.9])
@pytest.mark.parametrize("base", [0.4, 0.3])
def test_a_round_object_is_a_cylinder(base, centre):
    """Inertia about the edge of its base in closed form; KED's integral by an independent sum over its chords."""
    urn = InventoryObject(
        name="urn", width=0.4, depth=0.4, height=1.2, shape="round", mass=80.0, base_width=base, base_depth=base,
        centre_of_mass_height=centre,
    )  # fmt: skip
    body, middle, radius = urn.body("width"), centre or 0.6, 0.2
    below = 80.0 * (1.2 - middle) / 1.2
    inertia = 80.0 * (0.25 * radius**2 + 0.25 * base**2)
    for mass, low, high in ((below, 0.0, middle), (80.0 - below, middle, 1.2)):
        inertia += mass * ((high - low) ** 2 / 12.0 + (0.5 * (low + high)) ** 2)
    side = body.side("right")
    assert (side.mass, side.centre_height) == pytest.approx((80.0, middle), rel=1e-12, abs=0.0)
    assert side.moment_of_inertia == pytest.approx(inertia, rel=1e-12, abs=0.0)
    # midpoints of strips of x = r sin(t), of which the chord is 2 r cos(t)
    turn = math.pi * ((np.arange(400) + 0.5) / 400 - 0.5)
    x, share = radius * np.sin(turn), 2.0 / 400 * np.cos(turn) ** 2
    total = 0.0
    for mass, low, high in ((below, 0.0, middle), (80.0 - below, middle, 1.2)):
        y = low + (high - low) * (np.arange(400) + 0.5) / 400
        total += mass / 400 * float((share[:, None] * y**4 / ((x[:, None] - 0.5 * base) ** 2 + y**2)).sum())
    # the sum of midpoints is within 1e-5
    assert rk.coefficient_of_restitution(body, "ked", foot="right") == pytest.approx(
        math.sqrt(total / inertia), rel=2e-5
    )
    # negative control: the box of the same size is another body
    block = InventoryObject(name="box", width=0.4, depth=0.4, height=1.2, centre_of_mass_height=centre, mass=80.0)
    assert block.body("width").side("right").moment_of_inertia > 1.001 * inertia or base < 0.4
    solid = urn.as_solid()
    assert solid.centre[2] == pytest.approx(middle, rel=1e-12)
    assert solid.base.radius == pytest.approx(0.5 * base, rel=1e-12)


def test_round_words():
    """A diameter, a shape that is round, and a sign of diameters give a cylinder, of two sizes an ellipse; what contradicts is refused."""
    head = "Objekt;Form;Breite cm;Tiefe cm;Höhe cm;Durchmesser cm"
    found = parse_inventory(
        f"{head}\na;;;;90;ca. 30\nb;rund;30;;90;\nc;;Ø 30;;90;\nd;oval;30;20;90;\ne;rund;30;20;90;\nf;;30;20;90;30\ng;eckig;;;90;30"
    )
    assert [(one.name, one.shape, one.width, one.depth) for one in found.objects] == [
        ("a", "round", 0.3, 0.3), ("b", "round", 0.3, 0.3), ("c", "round", 0.3, 0.3), ("d", "round", 0.3, 0.2),
        ("e", "round", 0.3, 0.2),
    ]  # fmt: skip
    assert found.objects[0].approximate == pytest.approx({"width": 0.015, "depth": 0.015})
    assert [row.name for row in found.not_assessed] == ["f", "g"]


def test_words_of_consequence_and_count():
    """Consequences in every language; counts with their words."""
    head = "name;width_cm;depth_cm;height_cm;consequence;count"
    rows = (("hoch", "2 Stk."), ("alta", "3x"), ("低", "Paar"), ("orta", "4"))
    found = parse_inventory("\n".join([head, *(f"x;1;1;1;{how};{many}" for how, many in rows)]))
    assert [(one.consequence, one.count) for one in found.objects] == [
        ("high", 2),
        ("high", 3),
        ("low", 2),
        ("medium", 4),
    ]


@pytest.mark.slow
def test_museum_list(tmp_path):
    """Thirty untidy objects: each is an object, with what was assumed, or named with the reason why it is none."""
    write_museum_list(tmp_path / "liste.xlsx")
    Image.new("RGB", (2, 2)).save(tmp_path / "amphore.png")
    found = read_inventory(tmp_path / "liste.xlsx")
    assert (len(found.objects), len(found.not_assessed)) == (23, 7)
    assert (found.language, found.source, found.ignored) == ("de", "liste.xlsx (Objekte)", ("Standort",))
    objects = {one.name: one for one in found.objects}
    assert [objects["Säule"].count, objects["Leuchterpaar"].count, objects["Vitrine"].count] == [2, 2, 3]
    assert (objects["Amphore"].shape, objects["Amphore"].base_width, objects["Amphore"].consequence) == (
        "round",
        0.12,
        "high",
    )
    assert objects["Amphore"].photo == tmp_path / "amphore.png"
    assert objects["Modellschiff"].depth == pytest.approx(54 * 0.0254)
    assert objects["Grabplatte"].approximate == pytest.approx({"height": 0.1})
    assert tuple(map(str, objects["T-28"].remarks)) == ("it has no name",)
    assert {row.name: str(row.reason).partition(" ")[0] for row in found.not_assessed} == {
        "Stehspiegel": "Breite", "Rüstung": "base_depth", "Ofenschirm": "Tiefe", "Lesepult": "Höhe",
        "Kerzenständer": "Durchmesser", "Hausaltar": "base_width", "Obelisk": "The",
    }  # fmt: skip


CELLS = st.one_of(
    st.text(max_size=12), st.sampled_from(["ca. 12", "1/0", "Ø", "12 x 3", "#REF!", "-", "1e999", "9" * 300, "½", "'"])
)
TITLES = st.one_of(
    st.text(max_size=10),
    st.sampled_from([w for words in WORDS["headers"].values() for t in words.values() for w in t.split(", ")]),
)


@pytest.mark.slow
@given(st.lists(TITLES, max_size=4), st.lists(CELLS, min_size=4, max_size=8))
@settings(max_examples=150, deadline=None)
def test_any_header_and_cells(titles, cells):
    """Whatever titles and cells say, it is an inventory or our own error."""
    head = [*("Objekt", "Breite cm", "Maße (HxBxT)", "Höhe", "Anzahl", "Gewicht kg", "Form", "Durchmesser cm"), *titles]
    text = "\n".join(
        "\t".join(cell.replace("\t", " ").replace("\n", " ") for cell in row)
        for row in (head, [*cells, *cells, *cells][: len(head)])
    )
    try:
        found = parse_inventory(text)
    except RockingError:
        return
    assert found.objects or found.not_assessed


@pytest.mark.slow
@given(st.binary(max_size=60), st.integers(0, 400))
@settings(max_examples=60, deadline=None)
def test_damaged_workbooks(junk, place):
    """A workbook with bytes changed is read, or refused in our words."""
    import tempfile
    from pathlib import Path

    content = bytearray(open_document([HEAD, ["a", 20.0, 30.0, 90.0]]))
    content[place : place + len(junk)] = junk
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "list.ods"
        path.write_bytes(content)
        try:
            read_inventory(path)
        except RockingError:
            return
