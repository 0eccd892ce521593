"""What a hostile name does in the files that the application gives away: nothing, in any format."""

import csv
import io
import os
import re
import shutil
import subprocess
import tomllib
import xml.etree.ElementTree as ET
import zipfile
from html.parser import HTMLParser

import numpy as np
import openpyxl
import pytest
import scipy.io
import xarray

from rocking.motions import GroundMotion
from rocking.plots.style import new_figure
from rocking.reports import Document
from rocking.reports.document import Cell, Listing, Pair, Paragraph, Picture, ReportSection, ReportTable, response_pdf
from rocking_workbench.answers import attachment
from rocking_workbench.downloads.animation import page_of
from rocking_workbench.downloads.archive import bundle_of
from rocking_workbench.downloads.documents import report_of
from rocking_workbench.downloads.evaluation import Evaluation
from rocking_workbench.downloads.inputs_file import inputs_as_toml, inputs_from_toml
from rocking_workbench.downloads.pictures import drawn, drawn_text, figure_of
from rocking_workbench.downloads.tables import as_table, body_table, measures_table, table_of, written
from rocking_workbench.errors import Refused
from rocking_workbench.inputs import Inputs
from rocking_workbench.plain_text import plain_line
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import Limits

pytestmark = pytest.mark.verifies("damage", control="test_these_checks_find_what_they_look_for", room="doors")

SVG = "{http://www.w3.org/2000/svg}"
DRAWN = {"svg", "g", "path", "defs", "style", "text", "tspan", "use", "clipPath", "rect", "metadata", "image", "title"}
NAMES = [
    "=cmd|' /C calc'!A0",
    "=HYPERLINK(\"https://evil.example\",\"click\")",
    "+1+1|cmd",
    "-2+3+cmd|' /C calc'!A0",
    "@SUM(1+1)*cmd|' /C calc'!A0",
    "\t=1+1",
    "\r=1+1",
    "\n=1+1",
    "  =1+1",
    "\x1b =1+1",
    "\u202e=1+1",
    "\uff1d1+1",
    "\ufeff=1+1",
    'x"\n=1+1,"y',
    "a;=1+1",
    "<script>alert(1)</script>",
    "<svg onload=alert(1)>",
    "\"><img src=x onerror=alert(1)>",
    "</text></svg><script>alert(1)</script>",
    "]]><script>alert(1)</script><![CDATA[",
    "<!--",
    "<!ENTITY x SYSTEM 'file:///etc/passwd'>&x;",
    "<a href='javascript:alert(1)'>x</a>",
    "&lt;script&gt;alert(1)&lt;/script&gt;",
    "javascript:alert(1)",
    "#eval(\"panic()\")",
    "#read(\"/etc/passwd\")",
    "#import \"@preview/x:1.0.0\"",
    "$ integral $ #pagebreak()",
    "*bold* _it_ `raw` = head",
    "$\\frac{1}{0}$ \\input{/etc/passwd} ^{_{x",
    'x"]\n[restitution]\nvalue = 0.0\n#',
    "\"\"\"\n'''\n[settings]\ngravity = 1.0",
    "../../../etc/passwd",
    "..\\..\\windows\\win.ini",
    "CON",
    "a\x00b",
    "a\r\nSet-Cookie: session=1",
    "x\"; filename=evil.exe",
    "$(touch /tmp/x); `id` && rm -rf ~ | cat",
    "\x1b]0;title\x07\x1b[31m",
    "\u2028\u2029\x85",
    "e\u0301" * 40,
    "\u77f3\u706f\u7c60 \u0418\u0432\u0430\u043d",
    "A" * 5000,
]  # fmt: skip
IDS = [f"{k:02d}" for k in range(len(NAMES))]
WAVE = "\n".join(f"{0.01 * k:.2f} {2.8 * np.sin(0.0628 * k):.6f}" for k in range(200)).encode()
names = pytest.mark.parametrize("name", NAMES, ids=IDS)


def inputs_named(name, **motion):
    """Return inputs whose body, and record if there is one, have a name."""
    moved = motion or {"pulse": "sine:amplitude=3,period=0.8"}
    return Inputs.model_validate({"body": {"units": "m", "width": 0.5, "height": 2.0, "name": name}, "motion": moved})


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    """Return a store of records that holds none yet."""
    return RecordStore(tmp_path_factory.mktemp("data"), Limits())


def check_svg(data):
    """Return the text of an SVG file that holds nothing but a drawing."""
    root = ET.fromstring(data)
    for element in root.iter():
        if element.tag.startswith(SVG):
            assert element.tag.removeprefix(SVG) in DRAWN, element.tag
        for key, value in element.attrib.items():
            assert not key.lower().startswith("on"), key
            if key.endswith("href"):
                assert value.startswith(("#", "data:image/png;base64,")), value
    return "".join(root.itertext())


class Tags(HTMLParser):
    """Collects the elements and the handlers of a page."""

    def __init__(self, text):
        super().__init__()
        self.found, self.handlers = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.append(tag)
        self.handlers += [
            key for key, value in attrs if key.startswith("on") or (value or "").startswith("javascript:")
        ]


@names
def test_pictures_show_a_name_and_nothing_else(name):
    """A picture with a hostile title has the elements of a drawing alone, and the title as its text."""
    figure = new_figure(4.0, 1.0)[0]
    figure.suptitle(drawn_text(name, 80))
    text = check_svg(drawn(lambda: figure))
    assert "".join(plain_line(name, 80).split()) in "".join(text.split())


@pytest.mark.parametrize("name", [NAMES[18], NAMES[30], NAMES[36]])
def test_titles_of_motions_and_responses_are_text(name):
    """Names that a record file brings along are text in the pictures of motion and response."""
    wave = GroundMotion(4.0 * np.sin(0.0628 * np.arange(200)), 0.01, name=name, provenance=(name,))
    asked = Evaluation(inputs_named("x"), None)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rocking_workbench.downloads.evaluation.motion_from", lambda chosen, records: wave)
        patch.setattr("rocking_workbench.inputs.motion_from", lambda chosen, records: wave)
        text = check_svg(drawn(lambda: figure_of("motion", asked)))
        assert plain_line(name)[:20].replace(" ", "") in text.replace(" ", "")
        check_svg(drawn(lambda: figure_of("response", asked)))
        for kind in ("csv", "mat", "nc", "xlsx"):
            assert table_of("response", kind, asked)


@names
def test_tables_hold_text_and_no_formula(name):
    """In CSV and Excel no hostile name begins a formula, opens a row or a column; MATLAB and netCDF hold it.

    NetCDF takes long: each name is written in one of the three tables, with ROCKING_CAMPAIGN=1 in all.
    """
    asked = Evaluation(inputs_named(name), None)
    motion = GroundMotion(np.sin(np.arange(50.0)), 0.1, name=name)
    sheets = (
        body_table(asked.body, 9.80665, name, {"body": name}),
        measures_table(motion, {"motion": name}),
        as_table({name: name}, {"label": ("", [name, None]), "value": ("-", [1.5, None])}),
    )
    in_netcdf = sheets if os.environ.get("ROCKING_CAMPAIGN") == "1" else (sheets[NAMES.index(name) % 3],)
    for sheet in sheets:
        check_csv(written([(name, sheet)], "csv"), sheet)
        check_excel(written([(name, sheet), (name, sheet)], "xlsx"), sheet)
        mat = scipy.io.loadmat(io.BytesIO(written([(name, sheet)], "mat")), squeeze_me=True)["rocking"]
        assert set(mat.dtype.names) >= set(sheet.columns)
    for sheet in in_netcdf:
        with xarray.open_dataset(io.BytesIO(written([(name, sheet)], "nc")), engine="h5netcdf") as data:
            assert set(data.variables) == set(sheet.columns)


def check_csv(data, sheet):
    """Read a CSV file with two readers: commas, and the semicolons that Excel takes in other countries."""
    text = data.decode("utf-8-sig")
    rows = list(csv.reader(io.StringIO(text, newline="")))
    assert {len(row) for row in rows} == {len(sheet.columns)}
    assert len(rows) == len(sheet) + 1
    for other in csv.reader(io.StringIO(text, newline=""), delimiter=";"):
        assert not re.match(r"[=+@\t\r\uff1d\uff0b\uff20]|-[^0-9]", other[0])
        assert len(other) == 1
    for row, values in zip(rows[1:], sheet.rows, strict=True):
        for found, value in zip(row, values, strict=True):
            if isinstance(value, str):
                assert not found.startswith(("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20"))


def check_excel(data, sheet):
    """Open a workbook as Excel does: words are strings, and no cell is a formula or a link."""
    book = openpyxl.load_workbook(io.BytesIO(data))
    assert len({title.lower() for title in book.sheetnames}) == 2
    for page in book.worksheets:
        for row in page.iter_rows():
            for one in row:
                assert one.data_type in {"s", "n", "inlineStr"}
                assert one.hyperlink is None
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert not [part for part in archive.namelist() if "vba" in part.lower() or "external" in part.lower()]
        assert b"<f>" not in archive.read("xl/worksheets/sheet1.xml")


@names
def test_files_of_inputs_keep_the_name_and_nothing_of_it_runs(name, records):
    """TOML has the five tables and the name to the last character; archive and README hold three plain entries."""
    inputs = inputs_named(name)
    text = inputs_as_toml(inputs)
    told = tomllib.loads(text)
    assert set(told) == {"response", "body", "motion", "restitution"}
    assert told["body"]["name"] == name
    if "\0" in name:  # refused at this door as at that of the JSON
        with pytest.raises(Refused, match="NUL"):
            inputs_from_toml(text, lambda word: None)
        return
    assert inputs_from_toml(text, lambda word: None).body.name == name
    head = text.partition("[response]")[0].splitlines()
    assert all(line.startswith("# ") and line.isprintable() for line in head if line)
    record = records.add(WAVE, name or "x").record
    moved = inputs_named(name, record=record, units="m/s2", file_name=name[:200])
    with zipfile.ZipFile(io.BytesIO(bundle_of(Evaluation(moved, records)))) as archive:
        first, second, third = archive.namelist()
        assert (first, third) == ("response.toml", "README.txt")
        assert re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9._-]{0,90}", second)
        assert archive.read(second) == WAVE
        assert tomllib.loads(archive.read(first).decode())["motion"]["record"] == second
        assert inputs_from_toml(archive.read(first).decode(), lambda word: record if word == record else None) == moved
        assert all(line.isprintable() for line in archive.read(third).decode().split("\n"))


@names
def test_names_of_files_are_harmless(name):
    """The header that names a download is one line of ASCII in quotes, without a folder."""
    header = attachment(b"", f"{plain_line(name)} report.pdf").headers["Content-Disposition"]
    assert re.fullmatch(r'attachment; filename="[A-Za-z0-9][A-Za-z0-9._-]{0,90}"', header), header


@names
def test_the_report_sets_a_name_as_it_is(name):
    """In the report a name is text wherever it stands: title, line, cell, caption, listing."""
    shown = plain_line(name, 60)
    table = ReportTable(shown, [shown, "v"], [[Cell(shown), Cell("1.0")]], shown)
    picture = Picture("body", shown)
    blocks = [Paragraph(shown, shown, "fair"), table, picture, Pair(picture, table), Listing(shown, shown)]
    sections = [ReportSection(shown or "-", blocks)]
    pages = Document(shown or "-", shown, sections, verdict=[Paragraph(shown)], footer=shown)
    empty = b'<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10"><rect width="9" height="9"/></svg>'
    assert_says(response_pdf(pages, {"body": empty}), shown)


def assert_says(data, words):
    """Check that a PDF holds words as text, no link and no script."""
    assert data.startswith(b"%PDF-")
    assert not re.search(rb"/(JavaScript|JS|Launch|URI|EmbeddedFile|OpenAction)\b", data)
    if shutil.which("pdftotext") and words.isascii():
        text = subprocess.run(["pdftotext", "-", "-"], input=data, capture_output=True, check=True).stdout.decode()
        assert re.sub(r"[\W_]", "", words) in re.sub(r"[\W_]", "", text)


@pytest.mark.parametrize("name", [NAMES[26]])
def test_the_whole_report_with_a_hostile_name(name):
    """The report from end to end says the name as it is."""
    assert_says(report_of(Evaluation(inputs_named(name), None), "21 November 2026"), plain_line(name, 60))


@names
def test_the_page_of_the_animation_gains_no_element(name):
    """The page has the elements of a page with a harmless name, and no handler."""

    def page(word):
        wave = GroundMotion(4.0 * np.sin(0.0628 * np.arange(200)), 0.01, name=word)
        asked = Evaluation(inputs_named(word), None)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("rocking_workbench.inputs.motion_from", lambda chosen, records: wave)
            return Tags(page_of(asked.chosen(None)).decode())

    hostile, harmless = page(name), page("x")
    assert hostile.found == harmless.found
    assert hostile.handlers == []


@pytest.mark.verifies("negative control", "a formula, a script in a drawing, a handler in a page")
def test_these_checks_find_what_they_look_for():
    """The checks have teeth: a formula, a script in a drawing and a handler in a page are found."""
    bad = b'<svg xmlns="http://www.w3.org/2000/svg"><script>1</script></svg>'
    with pytest.raises(AssertionError):
        check_svg(bad)
    with pytest.raises(AssertionError):
        check_svg(b'<svg xmlns="http://www.w3.org/2000/svg" onload="x()"></svg>')
    sheet = as_table({}, {"label": ("", ["=1+1"])})
    with pytest.raises(AssertionError):
        check_csv(b"\xef\xbb\xbflabel\r\n=1+1\r\n", sheet)
    book = openpyxl.Workbook()
    book.active["A1"] = "=1+1"
    book.create_sheet("y")
    stream = io.BytesIO()
    book.save(stream)
    with pytest.raises(AssertionError):
        check_excel(stream.getvalue(), sheet)
    assert Tags("<img src=x onerror=alert(1)>").handlers == ["onerror"]
