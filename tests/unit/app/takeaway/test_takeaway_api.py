"""The endpoints of the take-away: every format opens in its own program and holds the library's numbers."""

import csv
import io
import json
import re
import shutil
import subprocess
import tomllib
import xml.etree.ElementTree as ET
import zipfile

import numpy as np
import openpyxl
import pytest
import scipy.io
import xarray
from PIL import Image, ImageSequence

import rocking as rk

INPUTS = {
    "body": {"units": "cm", "width": 50, "height": 200, "name": "Vase 3"},
    "motion": {"pulse": "sine:amplitude=3,period=0.8", "scale": 1.05},
    "restitution": {"models": ["ked", "housner"]},
}
BLOCK = rk.Block(width=50 * 0.01, height=200 * 0.01)
RESPONSES = [rk.simulate(BLOCK, rk.pulses.sine(3.0, 0.8), model, scale=1.05) for model in ("ked", "housner")]
OCTETS = {"Content-Type": "application/octet-stream"}
TABLES = ("body", "coefficients", "measures", "motion", "spectrum", "response", "outcomes", "impacts")


def sent(client, path, document=None, **query):
    """Return the bytes of an answer that must be good."""
    answer = client.post(f"/api/{path}", json=INPUTS if document is None else document, params=query)
    assert answer.status_code == 200, answer.text
    assert answer.headers["Content-Disposition"].startswith("attachment; filename=")
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    return answer.content


def rows_of(data):
    """Return the rows of a CSV file."""
    assert data.startswith(b"\xef\xbb\xbf")
    return list(csv.DictReader(io.StringIO(data.decode("utf-8-sig"), newline="")))


@pytest.mark.parametrize("what", ["body", "coefficients", "stages", "motion", "response"])
def test_pictures_are_pictures(client, what):
    """Every picture opens as SVG and as PNG, and says nothing of anybody's server."""
    root = ET.fromstring(sent(client, f"picture/{what}.svg"))
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    if what == "body":
        assert sent(client, "picture/body.png").startswith(b"\x89PNG")


def test_pictures_name_the_body_and_the_verdict(client):
    """The picture of the body carries its name; that of several responses says whether the model decides."""
    assert "Vase 3" in "".join(ET.fromstring(sent(client, "picture/body.svg")).itertext())
    words = "".join(ET.fromstring(sent(client, "picture/response.svg")).itertext())
    assert "With every one of these models the body stays standing." in words
    alone = "".join(ET.fromstring(sent(client, "picture/response.svg", restitution=1)).itertext())
    assert "restitution: Housner;" in alone


def test_the_same_picture_is_the_same_bytes(client):
    """A picture depends on the inputs alone."""
    assert sent(client, "picture/body.svg") == sent(client, "picture/body.svg")


@pytest.mark.parametrize("what", TABLES)
def test_tables_agree_across_formats(client, what):
    """CSV, Excel and netCDF hold the same columns with the same numbers, bit for bit."""
    table = rows_of(sent(client, f"table/{what}.csv"))
    heads = list(table[0])
    # the first response alone: its sheet is then the first one
    page = openpyxl.load_workbook(io.BytesIO(sent(client, f"table/{what}.xlsx", restitution=0))).worksheets[0]
    lines = list(page.iter_rows(values_only=True))
    assert list(lines[0]) == heads
    assert len(lines) - 1 == len(table)
    with xarray.open_dataset(io.BytesIO(sent(client, f"table/{what}.nc")), engine="h5netcdf") as data:
        for k, head in enumerate(heads):
            cells = [row[head] for row in table]
            name = head.partition(" [")[0]
            if all(isinstance(line[k], (int, float)) for line in lines[1:]):
                numbers = [float(cell) for cell in cells]
                assert [float(line[k]) for line in lines[1:]] == numbers
                assert data[name].values.tolist() == numbers


def test_samples_are_those_of_python(client):
    """The samples of a response are the float64 of the library in CSV, MATLAB and netCDF."""
    for place, response in enumerate(RESPONSES):
        table = rows_of(sent(client, "table/response.csv", restitution=place))
        assert [float(row["rotation [rad]"]) for row in table] == response.rotation.tolist()
        mat = scipy.io.loadmat(io.BytesIO(sent(client, "table/response.mat", restitution=place)), squeeze_me=True)
        assert np.array_equal(mat["rocking"]["rotation"].item(), response.rotation)
        impacts = scipy.io.loadmat(io.BytesIO(sent(client, "table/impacts.mat")), squeeze_me=True)["rocking"]
        label = ("ked", "housner")[place]
        mine = [
            t for t, name in zip(impacts["time"].item(), impacts["restitution"].item(), strict=True) if name == label
        ]
        assert mine == response.impacts["time"].tolist()
    assert not np.array_equal(RESPONSES[0].rotation, RESPONSES[1].rotation)


def test_a_workbook_holds_every_response(client):
    """The workbook of the responses has outcomes, impacts, and the samples of each on a sheet of its own."""
    book = openpyxl.load_workbook(io.BytesIO(sent(client, "table/response.xlsx")), read_only=True)
    assert book.sheetnames == ["outcomes", "impacts", "ked", "housner"]
    column = [row[1] for row in book["housner"].iter_rows(min_row=2, values_only=True)]
    assert column == RESPONSES[1].rotation.tolist()


def test_tables_are_those_of_the_screen(client):
    """Spectrum, measures and coefficients are the numbers that the pages show."""
    shown = client.post("/api/motion", json={"motion": INPUTS["motion"]}).json()
    spectrum = rows_of(sent(client, "table/spectrum.csv"))
    assert [float(row["period [s]"]) for row in spectrum] == shown["spectrum"]["period"]
    assert [float(row["pseudo_acceleration [m/s2]"]) for row in spectrum] == shown["spectrum"]["acceleration"]
    measures = rows_of(sent(client, "table/measures.csv"))
    assert {row["key"]: float(row["value [unit of its row]"]) for row in measures} == {
        one["name"]: one["value"] for one in shown["measures"]
    }
    impact = client.post("/api/impact", json={"body": INPUTS["body"]}).json()["coefficients"]["right"]
    coefficients = rows_of(sent(client, "table/coefficients.csv"))
    assert {row["model"]: float(row["coefficient_of_restitution [-]"]) for row in coefficients} == {
        row["model"]: row["coefficient_of_restitution"] for row in impact
    }


def test_the_report_has_its_parts(client):
    """The report says body, date, coefficient of KED, scaled peak of the ground, outcomes, and the inputs."""
    data = sent(client, "report.pdf", date="2026-11-21")
    assert data.startswith(b"%PDF-")
    if shutil.which("pdftotext"):
        told = subprocess.run(["pdftotext", "-layout", "-", "-"], input=data, capture_output=True, check=True).stdout
        words = " ".join(told.decode().split())
        for part in (
            "Vase 3",
            "21 November 2026",
            f"{rk.coefficient_of_restitution(BLOCK, 'ked'):.5f}",
            "3.15",
            "How it ends",
            "Housner",
            "[restitution]",
        ):
            assert part in words
        read, _, typed = words.partition("To do it again")  # from there on it is what a machine reads
        assert "housner" in typed
        assert "housner" not in read
        assert not re.search(r"\bked\b", read)


def test_animations(client):
    """The page of the animation is one file that declares its own policy; the GIF has frames."""
    page = sent(client, "animation.html").decode()
    assert "Content-Security-Policy" in page
    assert "default-src 'none'" in page
    short = {**INPUTS, "motion": {"pulse": "sine:amplitude=12,period=0.4"}, "restitution": {"value": 0.5}}
    drawn = Image.open(io.BytesIO(sent(client, "animation.gif", short)))
    assert drawn.format == "GIF"
    frames = [frame.convert("L").tobytes() for frame in ImageSequence.Iterator(drawn)]
    assert 10 < len(frames) <= 150
    assert len(set(frames)) > len(frames) // 2  # the body moves


def test_the_archive_is_whole(client):
    """The archive holds the inputs, the record with the bytes that were uploaded, and the commands."""
    wave = 4.0 * np.sin(2.0 * np.pi * np.arange(300) * 0.01)
    record = "\n".join(f"{k * 0.01:.2f} {a:.6f}" for k, a in enumerate(wave)).encode()
    made = client.post("/api/records?name=my%20wave.txt&units=m/s2", content=record, headers=OCTETS).json()
    motion = {"record": made["record"], "file_name": made["file_name"], "units": "m/s2"}
    data = sent(client, "inputs.zip", {**INPUTS, "motion": motion})
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        names = archive.namelist()
        told = tomllib.loads(archive.read("response.toml").decode())
        assert names == ["response.toml", told["motion"]["record"], "README.txt"]
        assert archive.read(told["motion"]["record"]) == record
        assert b"rocking simulate response.toml" in archive.read("README.txt")
    assert data == sent(client, "inputs.zip", {**INPUTS, "motion": motion})
    read = client.post(
        "/api/inputs/read", content=sent(client, "inputs.toml", {**INPUTS, "motion": motion}), headers=OCTETS
    )
    assert read.json()["motion"] == motion


def test_inputs_survive_the_file(client):
    """What is saved and opened again is the document that was saved."""
    read = client.post("/api/inputs/read", content=sent(client, "inputs.toml"), headers=OCTETS)
    assert read.status_code == 200
    assert json.dumps(read.json()["body"], sort_keys=True) == json.dumps(
        {"units": "cm", "width": 50.0, "height": 200.0, "name": "Vase 3"}, sort_keys=True
    )
    again = client.post("/api/response", json={**read.json(), "points": 100}).json()
    assert again["answers"][0]["peak_rotation_rad"] == RESPONSES[0].peak_rotation


@pytest.mark.parametrize(
    ("path", "change", "status"),
    [
        ("picture/motion.png", {"motion": None}, 422),
        ("picture/response.png", {"motion": None}, 422),
        ("picture/body.pdf", {}, 422),
        ("picture/shadow.png", {}, 422),
        ("table/body.exe", {}, 422),
        ("table/response.csv?restitution=7", {}, 422),
        ("table/response.csv?restitution=-1", {}, 422),
        ("table/response.csv", {"restitution": {"values": [k / 100.0 for k in range(60)]}}, 413),
        ("report.pdf?date=tomorrow", {}, 422),
        ("report.pdf", {"motion": None}, 422),
        ("animation.gif", {"motion": None}, 422),
        ("animation.mp4", {}, 422),
        ("inputs.zip", {"motion": {"record": "ab" * 32}}, 404),
        ("table/motion.csv", {"motion": {"record": "ab" * 32}}, 404),
        ("inputs.toml", {"surprise": 1}, 422),
        ("inputs.toml", {"body": {"units": "m", "width": 1.0, "height": 2.0, "name": 3}}, 422),
    ],
)
def test_refusals(client, path, change, status):
    """What cannot be done is refused with a kind and a sentence, and no trace of the program."""
    answer = client.post(f"/api/{path}", json={**INPUTS, **change})
    assert answer.status_code == status, answer.text
    assert set(answer.json()["error"]) >= {"kind", "message"}
    assert "Traceback" not in answer.text


def test_bytes_that_are_no_text_are_refused(client):
    """A file of inputs that is no UTF-8 is refused in words."""
    answer = client.post("/api/inputs/read", content=b"\xff\xfe\x00", headers=OCTETS)
    assert answer.status_code == 422
    assert "UTF-8" in answer.json()["error"]["message"]


@pytest.mark.parametrize("path", ["inputs.toml", "table/body.csv", "picture/body.svg"])
def test_half_a_character_is_refused(client, path):
    """A name with half of a surrogate pair, which no file can hold, is refused and never an error of the server."""
    content = b'{"body": {"units": "m", "width": 1.0, "height": 2.0, "name": "\\ud800"}}'
    answer = client.post(f"/api/{path}", content=content, headers={"Content-Type": "application/json"})
    assert 400 <= answer.status_code < 500
