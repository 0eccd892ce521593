"""`rocking spectrum`: numbers equal the study, slenderness and periods in words, refusals."""

import csv
import json
import math

import numpy as np
import pytest

import rocking as rk
from rocking.cli.spectrum import _angles, _periods
from rocking.motions.filters import geometric
from rocking.spec.fields import Values

COMMAND = "spectrum"

G = 9.80665
SINE, COSINE = "sine:amplitude=3,period=0.8", "cosine:amplitude=3,period=0.8"
FEW = ("--slenderness", "4,6", "--periods", "1:8:9")


def test_json_is_the_python_call(answered):
    """Modes and peaks of both motions are those of the study, bit by bit; counts add up to the blocks."""
    told = answered(SINE, "--motion", COSINE, *FEW, "--scale", "1.5")
    motions = [rk.pulses.sine(3.0, 0.8), rk.pulses.cosine(3.0, 0.8)]
    found = rk.rocking_spectrum(motions, np.arctan([1 / 4, 1 / 6]), geometric(1, 8, 9), scale=1.5)
    assert told["mode"] == found["mode"].values.tolist()
    assert told["peak_ratio"] == found["peak_ratio"].values.tolist()
    assert told["motions"] == [motion.name for motion in motions]
    assert told["semi_diagonal"] == pytest.approx(
        0.75 * G * (np.geomspace(1, 8, 9) / (2 * math.pi)) ** 2, rel=1e-12, abs=0.0
    )
    assert len(told["curves"]) == 4
    for one, mode in zip(told["curves"], found["mode"].values.reshape(4, 9), strict=True):
        assert one["largest_overturned_period"] == max(found["period"].values[mode >= 0], default=None)
        assert one["not_lifted"] + one["rocked"] + one["overturned"] + one["failed"] == 9


def test_page_and_files(printed, tmp_path):
    """A heading for every motion, a line for every slenderness; files are named and hold all digits."""
    openpyxl, io = pytest.importorskip("openpyxl"), pytest.importorskip("scipy.io")
    files = [tmp_path / name for name in ("a.svg", "a.csv", "a.nc", "a.xlsx", "a.mat")]
    options = [word for file in files for word in ("--output", file)]
    out = printed(SINE, COSINE, *FEW, *options)
    lines = out.splitlines()
    for name in ("sine pulse, 3 m/s2, 0.8 s", "cosine pulse, 3 m/s2, 0.8 s"):
        place = lines.index(name)
        table = lines[place : lines.index("", place)]
        assert [line.split()[0] for line in table[-2:]] == ["4", "6"]
    assert all(f"wrote {path}" in out and path.stat().st_size > 1000 for path in files)
    with files[1].open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    motions = [rk.pulses.sine(3.0, 0.8), rk.pulses.cosine(3.0, 0.8)]
    found = rk.rocking_spectrum(motions, np.arctan([1 / 4, 1 / 6]), geometric(1, 8, 9))
    peaks = found["peak_rotation"].values.ravel().tolist()
    assert [float(row["peak_rotation [rad]"]) for row in rows] == peaks
    heading, *cells = openpyxl.load_workbook(files[3])["cells"].iter_rows(values_only=True)
    column = heading.index("peak_rotation [rad]")
    assert [row[column] for row in cells] == pytest.approx(peaks, rel=1e-15)
    structure = io.loadmat(files[4], simplify_cells=True)["rocking"]
    assert structure["peak_rotation"].tolist() == peaks
    provenance = json.loads(structure["provenance"])
    assert provenance["motion_sha256"] == found.attrs["motion_sha256"]
    assert (provenance["restitution"], provenance["setting_gravity"]) == ("calibrated", G)


@pytest.mark.parametrize(
    ("word", "degrees"),
    [("1", [45.0]), ("10deg,15deg", [10.0, 15.0]), ("5deg:20deg:4", [5.0, 10.0, 15.0, 20.0]), ("0.2rad", [11.4591559])],
)
def test_slenderness_words(word, degrees):
    """Without a unit it is h/b = 1 / tan alpha, with one the angle."""
    assert np.degrees(_angles(word)) == pytest.approx(degrees, rel=1e-8)


def test_period_words():
    """A range goes by equal ratios unless it says otherwise."""
    for text, values in (("1:16:5", [1, 2, 4, 8, 16]), ("1:5:5:linear", [1, 2, 3, 4, 5]), ("1,3,4", [1, 3, 4])):
        assert Values.model_validate(_periods(text)).numbers() == pytest.approx(values, rel=1e-13, abs=0.0)
