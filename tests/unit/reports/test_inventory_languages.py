"""Reports of inventories in other languages, with photos: no English left, keys unchanged, no photo fails."""

import csv
import json
import re
from dataclasses import replace

import pytest

from rocking.decision.inventory import Inventory, InventoryObject, assess, parse_inventory
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.decision.inventory.objects import NotAssessed
from rocking.decision.inventory.ranking import answer_of
from rocking.language import LANGUAGES, language, page_words
from rocking.reports.inventory_document import inventory_document
from rocking.reports.inventory_folder import thumbnails, write_inventory, write_inventory_file

OBJECTS = (
    InventoryObject(name="Vase", width=0.2, depth=0.22, height=0.95, base_width=0.14, count=2, consequence="high",
                    mass=9.0, note="Meißen", approximate={"height": 0.05}),
    InventoryObject(name="Vitrine", width=0.9, depth=0.42, height=1.6, row=1),
    InventoryObject(name="Truhe", width=1.2, depth=0.6, height=0.5, row=2, consequence="low"),
)  # fmt: skip


@pytest.fixture(scope="module")
def found():
    """An assessment of three objects, with a row that could not be read and a column that was not."""
    hazard = Hazard.of_family("soft-ground", IntensityLevel.of("PGA", "0.25g"), count=75, seed=1)
    refused = (NotAssessed(5, "Spiegel", "?"),)
    return assess(Inventory(OBJECTS, refused, ("Raum",), "liste.xlsx", "de"), hazard)


def stretches(code):
    """Stretches of three words or more, without facts, of the messages of a language."""
    messages = page_words("de").keys() if code == "en" else page_words(code).values()
    texts = [form for text in messages for form in (text if isinstance(text, list) else [text])]
    parts = (part.strip() for text in texts for part in re.split(r"\{.*?\}", text))
    return {part for part in parts if len(re.findall(r"[^\W\d_]{2,}", part)) > 2}


STRETCHES = {code: stretches(code) for code in LANGUAGES}


def foreign(text, code):
    """Stretches of the other languages that a text holds."""
    others = set().union(*STRETCHES.values()) - STRETCHES[code]
    return sorted(part for part in others if part in text)


def texts(document):
    """Everything that a document says."""
    return json.dumps(document.plain(), ensure_ascii=False)


@pytest.mark.slow
def test_the_report_is_in_german(found, monkeypatch):
    """Not a stretch of other languages; with one German message lost there is one."""
    text = texts(inventory_document(found))
    assert foreign(text, "de") == []
    for german in ("Umkippen von Objekten bei Erdbeben", "PGA 0,25 g", "Startwert 1", "kippt in", "Maßnahmenplan"):
        assert german in text
    assert not re.search(r"(?<![\d:.])\d\.\d+ (?:g|cm|m/s)\b", text)
    assert len(foreign(texts(inventory_document(replace(found, language="en"))), "de")) > 30
    lost = "No measure against rocking is needed. Check that the object cannot slide off."
    monkeypatch.delitem(language("de").catalogue._catalog, lost)  # negative control
    assert foreign(texts(inventory_document(found)), "de") == [lost]


def test_files_are_in_the_language_and_keys_are_not(found, tmp_path):
    """HTML, PDF and workbook in German; keys of JSON and columns of CSV in English, lights there too."""
    openpyxl = pytest.importorskip("openpyxl")
    made = {
        form: write_inventory_file(found, tmp_path / f"x.{form}") for form in ("html", "pdf", "xlsx", "csv", "json")
    }
    html = made["html"].read_text("utf-8")
    assert '<html lang="de">' in html
    assert foreign(re.sub(r"<[^>]+>", " ", html), "de") == []
    book = openpyxl.load_workbook(made["xlsx"])
    assert book.sheetnames == ["Rangliste", "Maßnahmen", "Erklärung"]
    cells = [str(cell.value) for sheet in book for row in sheet.iter_rows() for cell in row]
    assert foreign("\n".join(cells), "de") == []
    assert made["csv"].read_text("utf-8-sig").startswith("rank,rating,inventory number,name,count,")
    assert ",red,,Vase," in made["csv"].read_text("utf-8-sig")
    plain = json.loads(made["json"].read_text("utf-8"))
    assert plain.keys() == answer_of(replace(found, language="en")).plain().keys()
    assert plain["objects"][0]["rating"] == "red"
    assert plain["plan"][0]["text"].startswith("Vase: Standfläche auf jeder Seite ")


def test_a_language_without_words_says_so(found):
    """French: in English, and the report says that there are no words of it yet."""
    text = texts(inventory_document(replace(found, language="fr")))
    assert "in the language fr. No translation exists" in text
    assert "Overturning of objects in earthquakes" in text


def test_photos_that_can_be_shown_are_and_others_fail_no_report(found, tmp_path, monkeypatch):
    """A picture beside its object in HTML and PDF; cut off, missing, a folder, text, too large: said, no failure."""
    image = pytest.importorskip("PIL.Image")
    good, cut, text = tmp_path / "good.png", tmp_path / "cut.png", tmp_path / "text.jpg"
    image.new("RGBA", (900, 500), (200, 30, 30, 255)).save(good)
    cut.write_bytes(good.read_bytes()[:60])
    text.write_text("no picture", encoding="utf-8")

    def shown(*photos):
        pairs = zip(found.verdicts, photos, strict=True)
        return replace(
            found, verdicts=tuple(replace(each, item=replace(each.item, photo=photo)) for each, photo in pairs)
        )

    mixed = shown(good, cut, None)
    (tmp_path / "small").mkdir()
    assert thumbnails(mixed, tmp_path / "small") == {0: "photo-0.jpg", 1: ""}
    with image.open(tmp_path / "small" / "photo-0.jpg") as small:
        assert (small.format, small.size) == ("JPEG", (240, 133))
    html = write_inventory_file(mixed, tmp_path / "x.html").read_text("utf-8")
    assert html.count("data:image/jpeg;base64,") == 1
    assert "Das Foto cut.png kann nicht gezeigt werden." in html
    bare = write_inventory_file(found, tmp_path / "bare.pdf").stat().st_size
    assert write_inventory_file(mixed, tmp_path / "x.pdf").stat().st_size > bare + 300
    assert thumbnails(shown(text, tmp_path / "none.jpg", tmp_path), tmp_path) == {0: "", 1: "", 2: ""}
    monkeypatch.setattr("rocking.reports.inventory_folder.MOST_PIXELS", 100_000)
    assert thumbnails(shown(good, None, None), tmp_path) == {0: ""}


def test_remarks_and_consequence_stand_beside_the_object(found):
    """What was assumed of a row is in its line; a consequence that is not medium too."""
    first, *others = found.verdicts
    noted = replace(
        first,
        item=replace(
            first.item,
            remarks=(*parse_inventory("Objekt;Höhe cm;Breite cm;Tiefe cm\n;120?;40;40").objects[0].remarks, "sic"),
        ),
    )
    text = texts(inventory_document(replace(found, verdicts=(noted, *others))))
    assert (
        "Hinweis: Höhe cm '120?': Höhe angenommen zu 1,2 m, plus oder minus 0,06 m; es hat keinen Namen; sic." in text
    )
    assert "Vase (x 2), Meißen; Folgen eines Sturzes: schwer" in text


def test_reasons_of_the_reader_are_translated():
    """What the reader itself says of rows that it refuses is in German where it is reported in German."""
    text = "name,width_cm,depth_cm,height_cm,base_width_cm\nurn,30,30,90,40\nmirror,75,?,160,"
    inventory = replace(parse_inventory(text), objects=OBJECTS[2:], language="de")
    hazard = Hazard.of_family("firm-ground", IntensityLevel("PGA", 1.0), count=1)
    said = texts(inventory_document(assess(inventory, hazard)))
    assert "Breite der Standfläche darf höchstens so groß sein wie die Breite des Körpers, 0,3 m" in said
    assert foreign(said, "de") == []


@pytest.mark.slow
def test_every_reason_and_remark_of_the_reader_is_translated():
    """Rows with every slip that the reader names, in German and Italian: no stretch of the English words is left."""
    slips = (
        "a;konisch;40;30;120;1;5;;", "b;dreieckig;40;30;120;1;5;;", "c;;400000;30;120;0;-4;-1;", "d;;30 kg;30;120;1;;;",
        "e;;120 (48);30;120;1;;;", "f;;3/4;30;120;viele;schwer;glatt;", ";;(40);30;max. 120;0;-3;-1;60",
        "h;;40;30;120;1;;;20", "p;;40;30;120;viele;schwer;glatt;",
        "i;;?;30;120;1;;;", "j;;130-120;30;120;1;;;", "k;;40;30;120;1;;;weit", "l;rund;40;30;120;1;1e999;;",
    )  # fmt: skip
    head = "Objekt;Form;Breite cm;Tiefe cm;Höhe cm;Anzahl;Gewicht kg;Reibung;Sockel Ø cm"
    found = parse_inventory("\n".join([head, *slips, "x;rund"]))
    sizes = parse_inventory("Objekt;Maße\nm;120 x 40 cm\nn;160 x ? x 30 cm\no;H 120 B 40 T ? cm")
    said = [each.reason for one in (found, sizes) for each in one.not_assessed]
    said += [remark for one in found.objects for remark in one.remarks]
    assert len(said) > 15
    assert found.objects[-1].name != found.objects[0].name
    assert "Zeile 8" in [each.name for each in found.objects]
    for code in ("de", "it"):
        for sentence in said:
            translated = language(code)(sentence)
            assert translated != str(sentence), sentence
            assert not re.search(
                r"\b(must|the|is|was|its|got|not|which)\b", re.sub(r"'.*?'|\".*?\"", "", translated)
            ), translated
    one = Hazard.of_family("firm-ground", IntensityLevel("PGA", 1.0), count=1)
    assert language("de")(one.source).startswith("1 synthetisches Erdbeben der Familie")


LISTS = {
    "en": "name;width cm;depth cm;height cm;weight kg;comment\nvase;20;20;ca. 90;?;chipped\n;30;30;80;;\n"
    "box;12x;3;?;;\nchest;90;60;50;-4;\nTotal;;;;;\n",
    "de": "Objekt;Breite cm;Tiefe cm;Höhe cm;Gewicht kg;Zustand\nVase;20;20;ca. 90;?;bestoßen\n;30;30;80;;\n"
    "Kiste;12x;3;?;;\nTruhe;90;60;50;-4;\nSumme;;;;;\n",
    "it": "oggetto;larghezza cm;profondità cm;altezza cm;peso kg;stato\nvaso;20;20;ca. 90;?;scheggiato\n;30;30;80;;\n"
    "cassa;12x;3;?;;\nbaule;90;60;50;-4;\nTotale;;;;;\n",
}


@pytest.mark.slow
@pytest.mark.parametrize("code", LANGUAGES)
@pytest.mark.parametrize("listed", LISTS)
def test_a_list_of_one_language_in_a_report_of_another(tmp_path, listed, code):
    """Report, pictures, workbook, table and answer have the sentences of one language; names of files are the same."""
    openpyxl = pytest.importorskip("openpyxl")
    inventory = parse_inventory(LISTS[listed], "list.csv", language=code)
    assert [item.name.split()[0] for item in inventory.objects][1] == language(code)("line")
    hazard = Hazard.of_family("firm-ground", IntensityLevel("PGA", 3.0), count=4)
    assessment = assess(inventory, hazard)
    assert assessment.not_assessed
    assert assessment.not_objects
    written, left_out = write_inventory(assessment, tmp_path / "made")
    assert {path.name for path in written} == {f"inventory.{form}" for form in ("html", "pdf", "xlsx", "csv", "json")}
    assert left_out == []
    plain = json.loads((tmp_path / "made/inventory.json").read_text("utf-8"))
    book = openpyxl.load_workbook(tmp_path / "made/inventory.xlsx")
    table = list(csv.reader((tmp_path / "made/inventory.csv").read_text("utf-8-sig").splitlines()))[1:]
    said = [
        re.sub(r"<[^>]+>", " ", (tmp_path / "made/inventory.html").read_text("utf-8")),
        "\n".join(str(cell.value) for sheet in book for row in sheet.iter_rows() for cell in row),
        " ".join(book.sheetnames),
        "\n".join(" ".join(row[2:]) for row in table),  # titles and lights are English in every language
        json.dumps(plain, ensure_ascii=False),
    ]
    assert [foreign(text, code) for text in said] == [[]] * len(said)
