"""Files to take away: every format opens in its own program and holds the library's numbers; pictures."""

import csv
import io
import re
import shutil
import subprocess
import tomllib
import xml.etree.ElementTree as ET
import zipfile

import matplotlib as mpl
import numpy as np
import openpyxl
import pytest
import scipy.io
import xarray
from matplotlib.figure import Figure
from PIL import Image, ImageSequence
from web_clients import refusal

import rocking as rk
from rocking.evidence._coefficient_table import default_models
from rocking_workbench.downloads import pictures
from rocking_workbench.downloads.evaluation import Evaluation
from rocking_workbench.downloads.pictures import _looks, comparison_picture, drawn, figure_of
from rocking_workbench.inputs import Inputs

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


def pictured(what, document):
    """Return a picture of the report."""
    return drawn(lambda: figure_of(what, Evaluation(Inputs.model_validate(document), None)))


@pytest.mark.parametrize("what", ["body", "coefficients", "stages", "motion", "response"])
def test_pictures_are_pictures(what):
    """Every picture of the report is an SVG file, the same for the same inputs."""
    picture = pictured(what, INPUTS)
    assert ET.fromstring(picture).tag == "{http://www.w3.org/2000/svg}svg"
    assert pictured(what, INPUTS) == picture


def test_the_picture_of_responses_tells_the_verdict():
    """That of several responses says whether the model decides, that of one with which it was computed."""
    words = "".join(ET.fromstring(pictured("response", INPUTS)).itertext())
    assert "The body does not overturn with any of these models." in words
    alone = pictured("response", {**INPUTS, "restitution": {"models": ["housner"]}})
    assert "restitution: Housner;" in "".join(ET.fromstring(alone).itertext())


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
    assert [float(row["pseudo_acceleration [m/s2]"]) for row in spectrum] == shown["spectrum"]["pseudo_acceleration"]
    measures = rows_of(sent(client, "table/measures.csv"))
    assert {row["key"]: float(row["value [unit of its row]"]) for row in measures} == shown["intensity"]
    impact = client.post("/api/impact", json={"body": INPUTS["body"]}).json()["coefficients"]["right"]
    coefficients = rows_of(sent(client, "table/coefficients.csv"))
    assert {row["model"]: float(row["coefficient [-]"]) for row in coefficients} == {
        row["model"]: row["coefficient"] for row in impact
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
            f"{rk.coefficient_of_restitution(BLOCK, 'ked'):.6f}",
            "3.15",
            "Outcome",
            "Housner",
            "[restitution]",
        ):
            assert part in words
        read, _, typed = words.partition("How to repeat the computation")  # from there on it is what a machine reads
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


@pytest.mark.parametrize(
    ("path", "change", "status"),
    [
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
    assert "UTF-8" in refusal(client.post("/api/inputs/read", content=b"\xff\xfe\x00", headers=OCTETS))


@pytest.mark.parametrize("path", ["inputs.toml", "table/body.csv"])
def test_half_a_character_is_refused(client, path):
    """A name with half of a surrogate pair, which no file can hold, is refused and never an error of the server."""
    content = b'{"body": {"units": "m", "width": 1.0, "height": 2.0, "name": "\\ud800"}}'
    answer = client.post(f"/api/{path}", content=content, headers={"Content-Type": "application/json"})
    assert 400 <= answer.status_code < 500


def noise(samples):
    """Return a figure with one long, lively curve that has a spike of one sample."""
    values = np.random.default_rng(7).normal(size=samples)
    values[samples // 3] = 9.0
    figure = Figure(figsize=(7.0, 3.0))
    (line,) = figure.subplots().plot(np.linspace(0.0, 300.0, samples), values, linewidth=0.8)
    return figure, line


def raster(figure):
    """Return what is seen, in grey."""
    stream = io.BytesIO()
    figure.savefig(stream, format="raw", dpi=100)
    return np.frombuffer(stream.getvalue(), np.uint8).reshape(300, 700, 4)[..., :3].mean(axis=-1)


def test_a_long_curve_is_thinned_and_keeps_its_spike(tmp_path):
    """60,000 samples become 10,802 at most, four for each of 2,700 dots; the extremes, the first and the last stay."""
    figure, line = noise(60_000)
    before = line.get_ydata().copy()
    pictures.draw_to(lambda: figure, tmp_path / "a.png")
    after = line.get_ydata()
    assert after.size <= 4 * 2700 + 2
    assert (after.max(), after.min(), after[0], after[-1]) == (9.0, before.min(), before[0], before[-1])


def test_the_picture_is_the_same_to_the_eye(tmp_path):
    """Fewer than one dot in a hundred differs visibly; without every other run many more do (negative control)."""
    with mpl.rc_context({"path.simplify": False}):
        whole = raster(noise(60_000)[0])
        figure, _ = noise(60_000)
        pictures.draw_to(lambda: figure, tmp_path / "a.png")
        figure.set_size_inches(7.0, 3.0)
        thin = raster(figure)
        crude, line = noise(60_000)
        line.set_data(line.get_xdata()[::20], line.get_ydata()[::20])
        cruder = raster(crude)
    assert (np.abs(thin - whole) > 64.0).mean() < 0.01
    assert (np.abs(cruder - whole) > 64.0).mean() > 0.05


def test_short_curves_and_those_that_go_back_are_left_alone(tmp_path):
    """A thousand samples, and a closed outline of any length, are drawn as they are."""
    figure, line = noise(1000)
    angle = np.linspace(0.0, 2.0 * np.pi, 20_000)
    (ring,) = figure.axes[0].plot(np.cos(angle), np.sin(angle))
    pictures.draw_to(lambda: figure, tmp_path / "a.png")
    assert (line.get_xdata().size, ring.get_xdata().size) == (1000, 20_000)


BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
PULSE = rk.pulses.sine(3.0, 0.8)
LABELS = [each.label for each in default_models()] + [
    "0.98*ked", "shifted-impulse:k=0.5", "shifted-impulse:k=0.6", "0.8", "0.9", "left 0.9, right 0.8",
]  # fmt: skip


def test_models_are_named(client):
    """Legend, verdict and rows name models by words; no label of the command line is left in the pictures."""
    labels = {"models": ["ked", "housner", "horizontal-momentum"], "values": [0.8]}
    inputs = {
        "body": {"units": "m", "width": 0.5, "height": 2.0},
        "motion": {"pulse": "sine:amplitude=3,period=0.8"},
        "restitution": labels,
    }
    for what in ("response", "coefficients"):
        picture = pictured(what, inputs)
        told = [text.strip().replace("\u00a0", " ") for text in ET.fromstring(picture).itertext() if text.strip()]
        assert not any(word in text for text in told for word in ("housner", "ked", "horizontal-momentum"))
        assert any("horizontal momentum (cos\u00b2\u03b1)" in text for text in told)
    page = client.post("/api/animation.html", json=inputs).text
    assert "restitution KED;" in page


def test_no_two_curves_look_alike():
    """Colour and dash together are different for every restitution, also for two of one family."""
    looks = _looks(LABELS)
    assert len({str(look) for look in looks.values()}) == len(LABELS)
    ked, other = looks["ked"], looks["0.98*ked"]
    assert ked["color"] != other["color"]


def test_every_response_has_its_curve():
    """Each of three responses is in each of three panels."""
    found = {label: rk.simulate(BODY, PULSE, label) for label in ("ked", "housner")} | {
        "0.8": rk.simulate(BODY, PULSE, 0.8)
    }
    figure = comparison_picture(found)
    colors = [look["color"] for look in _looks(list(found)).values()]
    for panel in figure.axes[1:4]:
        assert {line.get_color() for line in panel.get_lines()} >= set(colors)
