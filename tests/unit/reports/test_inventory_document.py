"""The report of an inventory: lights without colours, text that stays text, files that open."""

import json
import re
import sys
from pathlib import Path

import pytest

from rocking.decision.inventory import Thresholds, assess, parse_inventory
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.decision.inventory.ranking import as_csv
from rocking.errors import MissingExtraError, RockingError
from rocking.reports.document import render_html
from rocking.reports.inventory_document import inventory_document
from rocking.reports.inventory_folder import write_inventory, write_spreadsheet

HOSTILE = '<script>alert(1)</script> #strong[x] $x$ \\ & *b* @cite ""'
TEXT = f"""name;width_cm;depth_cm;height_cm;note;room
tall vase;12;12;95;;hall
display case;45;200;180;{HOSTILE.replace('"', "")};hall
chest;120;60;50;;hall
=cmd();50;50;60;=1+1;hall
<b>mirror</b>;?;20;160;;hall
"""


@pytest.fixture(scope="module")
def assessment():
    """A red, an amber and two green objects, and a row that says nothing."""
    hazard = Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=100, seed=3)
    return assess(parse_inventory(TEXT, "list.csv"), hazard, restitution="ked")


def page(assessment):
    """The HTML."""
    return render_html(inventory_document(assessment), Path())


@pytest.fixture(scope="module")
def html(assessment):
    """The page of the whole list."""
    return page(assessment)


@pytest.mark.slow
def test_lights_are_letters_and_words(html):
    """Without styles and colours the page still says red, amber and green, and the worst stands first."""
    bare = re.sub(r"<style>.*?</style>|<[^>]+>", " ", html, flags=re.S)
    order = [bare.index(word) for word in ("RED", "AMBER", "GREEN")]
    assert order == sorted(order)
    assert "1 red, 1 amber, 2 green, 1 not assessed" in bare


def test_page_is_complete_in_itself_and_says_what_it_rests_on(html):
    """What users typed stays words, nothing is fetched; thresholds, seed, family, models, limits are on the page."""
    for word in ("<script>", "src=", "@import", "http://", "https://", "{{", "nan", "inf "):
        assert word not in html
    for words in (
        "&lt;script&gt;alert(1)&lt;/script&gt;", "&lt;b&gt;mirror&lt;/b&gt;",
        "At least 20% of the motions", "seed 3", "point-source", "illustrative ranges", "no hazard model", "housner",
        "Sliding is not assessed", "not of a code of practice", "Ignored columns of the list:", "room",
        "line</th>", "width_cm is &#39;?&#39;",
    ):  # fmt: skip
        assert words in html, words


def test_pages_of_other_lists(assessment):
    """Bad rows alone make a report that says so; a level of 99.9 % is printed as such, not as 100 %."""
    bare = page(assess(parse_inventory("name,width_cm,depth_cm,height_cm\nx,?,1,1"), assessment.hazard))
    items = [verdict.item for verdict in assessment.verdicts]
    own = page(assess(items, assessment.hazard, thresholds=Thresholds(level=0.999)))
    for html, words in (
        (bare, "No row could be assessed."),
        (bare, "0 red, 0 amber, 0 green, 1 not assessed"),
        (own, "99.9% interval [%]"),
    ):
        assert words in html
    assert "100% interval" not in own


def test_folder_has_every_form(assessment, tmp_path, monkeypatch):
    """HTML, PDF, CSV and JSON are written and nothing else; what needs a missing library is named with the remedy."""
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    monkeypatch.setitem(sys.modules, "openpyxl.styles", None)
    written, left_out = write_inventory(assessment, tmp_path / "a" / "b")
    assert [path.name for path in written] == [f"inventory.{kind}" for kind in ("html", "pdf", "csv", "json")]
    assert sorted((tmp_path / "a" / "b").iterdir()) == sorted(written)
    assert left_out == ['the spreadsheet needs openpyxl: pip install "rocking[excel]"']
    assert written[1].read_bytes().startswith(b"%PDF")
    assert written[2].read_bytes().startswith(b"\xef\xbb\xbfrank,")
    assert "'=cmd()" in written[2].read_text(encoding="utf-8-sig")
    plain = json.loads(written[3].read_text(encoding="utf-8"))
    assert {item["name"] for item in plain["objects"]} == {"tall vase", "display case", "chest", "=cmd()"}
    assert plain["columns_not_read"] == ["room"]
    with pytest.raises(MissingExtraError, match=r'"rocking\[excel\]"'):
        write_spreadsheet(assessment, tmp_path / "x.xlsx")
    # a file in the place of the folder is refused in one sentence
    (tmp_path / "taken").write_text("", encoding="utf-8")
    with pytest.raises(RockingError, match="cannot write to"):
        write_inventory(assessment, tmp_path / "taken")


def test_spreadsheet_holds_numbers_and_no_formula(assessment, tmp_path):
    """Opened again: the worst first, numbers as numbers, text as text, no cell a formula, lights in words."""
    openpyxl = pytest.importorskip("openpyxl")
    write_spreadsheet(assessment, tmp_path / "x.xlsx")
    book = openpyxl.load_workbook(tmp_path / "x.xlsx")
    assert book.sheetnames == ["Ranking", "Measures", "Explanation"]
    rows = list(book["Ranking"].iter_rows())
    assert [row[0].value for row in rows[1:]] == [1, 2, 3, 4, None]
    assert [row[1].value for row in rows[1:]] == ["red", "amber", "green", "green", "not assessed"]
    assert {cell.data_type for sheet in book for row in sheet.iter_rows() for cell in row} <= {"n", "s"}
    assert isinstance(rows[1][7].value, float)
    assert "'=cmd()" in {row[3].value for row in rows}
    assert "Sliding is not assessed" in " ".join(str(row[1].value) for row in book["Explanation"].iter_rows())


def test_spreadsheet_and_csv_name_the_columns_that_were_not_read(assessment, tmp_path):
    """Who opens the table alone learns which columns had no say; without such columns nothing is said."""
    openpyxl = pytest.importorskip("openpyxl")
    whole = assess(parse_inventory(TEXT.replace(";room", ";note 2").replace(";note;", ";room;")), assessment.hazard)
    complete = assess(parse_inventory("name,width_cm,depth_cm,height_cm\nvase,12,12,95"), assessment.hazard)
    for given, named in ((assessment, "room"), (whole, "room, note 2"), (complete, None)):
        write_spreadsheet(given, tmp_path / "list.xlsx")
        sheet = openpyxl.load_workbook(tmp_path / "list.xlsx")["Explanation"]
        facts = {row[0]: row[1] for row in sheet.iter_rows(values_only=True)}
        last = as_csv(given).splitlines()[-1]
        if named is None:
            assert "ignored" not in facts
            assert "not read" not in last
        else:
            assert facts["ignored"] == f"columns of the list: {named}"
            assert f"columns of the list that were not read: {named}" in last
