"""Reports of inventories in other languages, with photos: no English left, keys unchanged, no photo fails."""

import json
import re
from dataclasses import replace

import pytest

from rocking.language import catalogue, language
from rocking.reports.inventory_document import inventory_document
from rocking.reports.inventory_folder import thumbnails, write_inventory_file
from rocking.studies.inventory import Inventory, InventoryObject, assess, parse_inventory
from rocking.studies.inventory.hazard import Hazard, IntensityLevel
from rocking.studies.inventory.objects import NotAssessed
from rocking.studies.inventory.table import answer_of

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


def words_in(text):
    """Stretches of three words or more, without numbers, of the English catalogue that a text holds."""
    stretches = {stretch.strip() for each in catalogue("en").values() for stretch in re.split(r"\{.*?\}", each)}
    return sorted(each for each in stretches if len(each.split()) > 2 and each in text)


def texts(document):
    """Everything that a document says."""
    return json.dumps(document.plain(), ensure_ascii=False)


def test_no_english_sentence_in_the_german_report(found, monkeypatch):
    """Not a stretch of three words of the English catalogue; with one German entry deleted there is one."""
    text = texts(inventory_document(found))
    assert words_in(text) == []
    for german in ("Welche Objekte stehen bleiben", "PGA 0,25 g", "Startzahl 1", "kippt in", "Was zuerst zu tun ist"):
        assert german in text
    assert not re.search(r"(?<![\d:.])\d\.\d+ (?:g|cm|m/s)\b", text)
    english = texts(inventory_document(replace(found, language="en")))
    assert len(words_in(english)) > 30
    monkeypatch.setitem(language("de").entries, "advice.green", catalogue("en")["advice.green"])  # negative control
    assert words_in(texts(inventory_document(found))) == [catalogue("en")["advice.green"]]


def test_files_are_in_the_language_and_keys_are_not(found, tmp_path):
    """HTML, PDF and workbook in German; keys of JSON and columns of CSV in English, lights there too."""
    openpyxl = pytest.importorskip("openpyxl")
    made = {
        form: write_inventory_file(found, tmp_path / f"x.{form}") for form in ("html", "pdf", "xlsx", "csv", "json")
    }
    html = made["html"].read_text("utf-8")
    assert '<html lang="de">' in html
    assert words_in(re.sub(r"<[^>]+>", " ", html)) == []
    book = openpyxl.load_workbook(made["xlsx"])
    assert book.sheetnames == ["Rangliste", "Maßnahmen", "Was es bedeutet"]
    cells = [str(cell.value) for sheet in book for row in sheet.iter_rows() for cell in row]
    assert words_in("\n".join(cells)) == []
    assert made["csv"].read_text("utf-8-sig").startswith("rank,light,inventory number,name,count,")
    assert ",red,,Vase," in made["csv"].read_text("utf-8-sig")
    plain = json.loads(made["json"].read_text("utf-8"))
    assert plain.keys() == answer_of(replace(found, language="en")).plain().keys()
    assert plain["objects"][0]["light"] == "red"
    assert plain["plan"][0]["in_words"].startswith("Vase: Standfläche auf jeder Seite ")


def test_a_language_without_words_says_so(found):
    """Chinese: in English, and the report says that there are no words of it yet."""
    text = texts(inventory_document(replace(found, language="zh")))
    assert "in the language zh, of which there are no words yet" in text
    assert "Which objects stay standing" in text


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
    assert "Sein Foto cut.png lässt sich nicht zeigen." in html
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
        item=replace(first.item, remarks=("Maß '1,2?': height taken as 1.2 m, give or take 0.06 m", "it has no name")),
    )
    text = texts(inventory_document(replace(found, verdicts=(noted, *others))))
    assert "Hinweis: Maß '1,2?': Höhe angenommen zu 1,2 m, plus oder minus 0,06 m; es hat keinen Namen." in text
    assert "Vase (x 2), Meißen; Folgen eines Sturzes: schwer" in text


def test_reasons_of_the_reader_are_translated():
    """What the reader itself says of rows that it refuses is in German where it is reported in German."""
    text = "name,width_cm,depth_cm,height_cm,base_width_cm\nurn,30,30,90,40\nmirror,75,?,160,"
    inventory = replace(parse_inventory(text), objects=OBJECTS[2:], language="de")
    hazard = Hazard.of_family("firm-ground", IntensityLevel("PGA", 1.0), count=1)
    said = texts(inventory_document(assess(inventory, hazard)))
    assert "Breite der Standfläche darf höchstens so groß sein wie die Breite des Körpers, 0,3 m" in said
    assert words_in(said) == []


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
            translated = language(code).translated(sentence)
            assert translated != sentence, sentence
            assert not re.search(
                r"\b(must|the|is|was|its|got|not|which)\b", re.sub(r"'.*?'|\".*?\"", "", translated)
            ), translated
    one = Hazard.of_family("firm-ground", IntensityLevel("PGA", 1.0), count=1)
    assert language("de").translated(one.source).startswith("1 synthetisches Erdbeben der Familie")
