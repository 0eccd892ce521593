"""Inventory number, name and remarks of each row, in every form in which an inventory is given."""

import csv
import io
import json
import re
import shutil
import subprocess

import pytest

import rocking as rk
from rocking.campaigns.jobs import Job, JobFolder, export
from rocking.decision.inventory import Inventory, InventoryObject, assess, parse_inventory
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.plots import inventory_distribution, inventory_picture
from rocking.reports.inventory_document import MOST_DRAWN
from rocking.reports.inventory_folder import write_inventory_file

LIST = """Inv.-Nr.;Objekt;Breite cm;Tiefe cm;Höhe cm;Bemerkung
A-17;Vase;12;12;60;Fuß geklebt
A-18;Vase;20;20;30;
A-19;Vase;?;20;30;fehlt zur Zeit
Summe: 3;;;;;
"""
FEW = {"count": 5, "seed": 1}


@pytest.fixture(scope="module")
def hazard():
    """Five synthetic motions."""
    return Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), **FEW)


@pytest.fixture(scope="module")
def found(hazard):
    """Two vases that only their numbers tell apart, one that cannot be assessed, and a sum."""
    return assess(parse_inventory(LIST, "liste.csv"), hazard)


@pytest.mark.slow
def test_json(found, tmp_path):
    """The number has a key of its own, for objects, refused rows and measures; lines that are no objects are named."""
    plain = json.loads(write_inventory_file(found, tmp_path / "x.json").read_text("utf-8"))
    assert [(each["number"], each["name"], each["note"]) for each in plain["objects"]] == [
        ("A-17", "Vase", "Fuß geklebt"),
        ("A-18", "Vase", ""),
    ]
    (refused,) = plain["not_assessed"]
    assert (refused["row"], refused["number"], refused["name"], refused["note"]) == (
        4,
        "A-19",
        "Vase",
        "fehlt zur Zeit",
    )
    assert plain["not_objects"] == [{"row": 5, "text": "Summe: 3", "reason": "eine Summe oder ein Mittelwert"}]
    assert plain["plan"][0]["number"] == "A-17"
    assert plain["header_lines"] == [1]
    assert plain["plan"][0]["text"].startswith("A-17 Vase: ")


def test_tables(found, tmp_path):
    """Workbook and CSV have a column of numbers; each row of the list is in them, with its note or its reason."""
    openpyxl = pytest.importorskip("openpyxl")
    write_inventory_file(found, tmp_path / "x.xlsx")
    book = openpyxl.load_workbook(tmp_path / "x.xlsx")
    sheet = [[cell.value for cell in row] for row in book["Rangliste"].iter_rows()]
    text = write_inventory_file(found, tmp_path / "x.csv").read_text("utf-8-sig")
    for (head, *rows), title, note in (
        (sheet, "Inventarnummer", "Bemerkung"),
        (list(csv.reader(io.StringIO(text))), "inventory number", "note"),
    ):
        place, notes = head.index(title), head.index(note)
        assert [row[place] or "" for row in rows[:4]] == ["A-17", "A-18", "A-19", ""]
        assert [row[notes] or "" for row in rows[:4]] == ["Fuß geklebt", "", "fehlt zur Zeit", ""]
        assert "Summe: 3" in rows[3]
        assert any("ine Summe" in str(each) or "a sum or an average" in str(each) for each in rows[3])
    assert [cell.value for cell in list(book["Maßnahmen"].iter_rows())[1][:2]] == ["A-17", "Vase"]


def words_of_pdf(path):
    """What a PDF says, on one line; nothing where no program reads it."""
    if shutil.which("pdftotext") is None:
        return ""
    read = subprocess.run(["pdftotext", str(path), "-"], capture_output=True, check=True)
    return " ".join(read.stdout.decode("utf-8").split())


def test_documents(found, tmp_path):
    """HTML and PDF name every row by number and name, in each of their tables, and begin with a picture of them all."""
    html = write_inventory_file(found, tmp_path / "x.html").read_text("utf-8")
    bare = " ".join(re.sub(r"<style>.*?</style>|<[^>]+>", " ", html, flags=re.S).split())
    pdf = words_of_pdf(write_inventory_file(found, tmp_path / "x.pdf"))
    for text in filter(None, (bare, pdf)):
        for words in ("A-17 Vase, Fuß geklebt", "A-18 Vase", "A-19 Vase", "Summe: 3", "Höchste Priorität : A-17 Vase"):
            assert words in text.replace("Höchste Priorität:", "Höchste Priorität :"), words
    assert html.index("<svg") < html.index("<table")
    assert "A-18 Vase" in html[html.index("<svg") : html.index("</svg>")]


def test_a_light_is_written_once(found, tmp_path):
    """No cell has the letter of a light beside its word."""
    english = assess(parse_inventory(LIST.replace("Objekt", "name").replace("Bemerkung", "note"), "x"), found.hazard)
    for assessment in (found, english):
        html = write_inventory_file(assessment, tmp_path / "x.html").read_text("utf-8")
        text = write_inventory_file(assessment, tmp_path / "x.csv").read_text("utf-8-sig")
        assert not re.search(
            r"\b(R|A|G|V|Ge|Gr)[\s\xa0]+(RED|AMBER|GREEN|ROT|GELB|GRÜN|red|amber|green)\b", html + text
        )
    assert re.search(r">(RED|ROT)<", html)


@pytest.mark.slow
def test_labelled_data(hazard, tmp_path):
    """The dataset has numbers, notes and remarks along its objects and refused rows, also after a file of netCDF."""
    xarray = pytest.importorskip("xarray")
    (tmp_path / "list.csv").write_text(LIST, "utf-8")
    ranking = rk.inventory(tmp_path / "list.csv", hazard)
    ranking.to_netcdf(tmp_path / "x.nc")
    with xarray.open_dataset(tmp_path / "x.nc") as opened:
        for each in (ranking, opened):
            assert each["number"].values.tolist() == ["A-17", "A-18"]
            assert each["note"].values.tolist() == ["Fuß geklebt", ""]
            assert each["not_assessed_number"].values.tolist() == ["A-19"]
            assert each["not_object"].values.tolist() == [5]


@pytest.mark.slow
def test_a_campaign(tmp_path):
    """Exported histories have the number and the note of each object."""
    xarray = pytest.importorskip("xarray")
    (tmp_path / "list.csv").write_text(LIST, "utf-8")
    (tmp_path / "job.toml").write_text(
        '[campaign]\nname = "x"\nkind = "inventory"\n[inventory]\nobjects = "list.csv"\npga = "0.3g"\n'
        '[motions]\nsynthetic = "point-source"\ncount = 2\nseed = 1\n'
    )
    folder = JobFolder.create(tmp_path / "c", Job.read(tmp_path / "job.toml"))
    folder.run(workers=1)
    export(folder, tmp_path / "x.nc")
    with xarray.open_dataset(tmp_path / "x.nc") as opened:
        assert opened["number"].values.tolist() == ["A-17", "A-18"]
        assert opened["note"].values.tolist() == ["Fuß geklebt", ""]


def test_pictures(found, hazard, tmp_path):
    """A picture labels objects by number and name; of a long list the worst are drawn, and all are counted beside."""
    labels = [label.get_text() for label in inventory_picture(found).axes[0].get_yticklabels()]
    assert labels == ["A-17 Vase", "A-18 Vase"]
    many = MOST_DRAWN + 3
    objects = tuple(
        InventoryObject(name="urn", number=f"U-{k}", width=0.2, depth=0.2, height=0.3 + 0.05 * k) for k in range(many)
    )
    long = assess(Inventory(objects), hazard)
    drawn = inventory_picture(long, MOST_DRAWN)
    assert len(drawn.axes[0].get_yticklabels()) == MOST_DRAWN
    assert drawn.axes[0].get_yticklabels()[0].get_text() == long.verdicts[0].item.label
    assert drawn.axes[1].get_xlim()[1] > 0.3  # the peak of the shaking is within, also where no object reaches it
    assert drawn.get_suptitle().endswith(f"the worst {MOST_DRAWN} of {many} objects")
    for panel in inventory_distribution(long).axes:
        assert sum(bar.get_height() for bar in panel.patches) == many
    html = write_inventory_file(long, tmp_path / "x.html").read_text("utf-8")
    assert html.count("<svg") == 2
