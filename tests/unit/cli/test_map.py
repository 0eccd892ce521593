"""`rocking map`: what it prints and writes equals the study, axes with units, refusals in one sentence with code 2."""

import csv
import io
import json
import math
import sys

import numpy as np
import pytest
from scipy import ndimage

import rocking as rk
from rocking.cli.numbers import row
from rocking.cli.page import bar
from rocking.plots.overturning_map import ISLAND, classes_of
from rocking.studies import axes, overturning_map, safe_islands
from rocking.studies.sensitivity import map_sensitivity

COMMAND = "map"

G = 9.80665
SIZE = ("--width", "0.5", "--height", "2")
PULSE = "sine:amplitude=3,period=0.6"
AXES = ("--x", "frequency_ratio=1:7:13", "--y", "amplitude_ratio=1:10:19")
BLOCK = rk.Block(width=0.5, height=2.0)
SINE = rk.pulses.sine(amplitude=3.0, period=0.6)
RATIOS = (("frequency_ratio", np.linspace(1, 7, 13)), ("amplitude_ratio", np.linspace(1, 10, 19)))


def test_json_is_the_python_call(answered):
    """Modes, peaks, shares and islands are those of the study, bit by bit."""
    out = answered(*SIZE, "--motion", PULSE, *AXES, "--restitution", "0.9")
    told, found = out, overturning_map(BLOCK, SINE, *RATIOS, 0.9)
    assert told["mode"] == found["mode"].values.tolist()
    assert told["peak_ratio"] == found["peak_ratio"].values.tolist()
    assert told["x"]["values"] == found["frequency_ratio"].values.tolist()
    assert sum(one["count"] for one in told["modes"]) == told["cells"] == 13 * 19
    assert told["islands"]["count"] == len(safe_islands(found))
    y, x = np.nonzero(found["mode"].values >= 0)
    assert told["overturning"]["first"]["y"] == told["y"]["values"][y.min()]
    assert told["overturning"]["x"] == [told["x"]["values"][x.min()], told["x"]["values"][x.max()]]
    assert (told["refined_points"], told["sensitivity"]) == (None, None)


def test_a_varied_restitution_is_not_a_stated_model(run):
    """With the restitution as an axis no model is named; without, the stated model is named."""
    words = ("--width", 0.5, "--height", 2, "--motion", PULSE, "--y", "pga=2,6")
    out = run(*words, "--x", "restitution=0.5,0.9")[1]
    assert "Restitution: varied" in out
    assert "The coefficient of restitution is varied along an axis of the map." in out
    assert "calibrated" not in out
    assert "ked, as stated in the input" in run(*words, "--x", "slenderness_ratio=3,4", "--restitution", "ked")[1]


@pytest.mark.slow
def test_islands_are_those_of_the_picture(run, answered):
    """Cells without overturning that overturning surrounds are counted, drawn and defined, with what is not decided."""
    words = ("--width", 0.6, "--height", 2, "--motion", "sine:amplitude=1,period=0.5")
    axes = ("--x", "frequency_ratio=0.5:10:100", "--y", "amplitude_ratio=1:12:100")
    told = answered(*words, *axes)
    mode = np.array(told["mode"])
    labels, count = ndimage.label(mode < 0, np.ones((3, 3)))  # an independent count: regions that touch no edge
    edge = {*labels[0], *labels[-1], *labels[:, 0], *labels[:, -1]}
    cells = sorted(int((labels == k).sum()) for k in range(1, count + 1) if k not in edge)
    assert len(cells) > 0
    assert sorted(island["cells"] for island in told["islands"]["all"]) == cells
    assert told["islands"]["definition"] in told["islands"]["sentences"][0]
    block, pulse = rk.Block(width=0.6, height=2.0), rk.pulses.sine(amplitude=1.0, period=0.5)
    grid = ("frequency_ratio", np.linspace(0.5, 10, 100)), ("amplitude_ratio", np.linspace(1, 12, 100))
    found = overturning_map(block, pulse, *grid)
    assert (classes_of(found) == ISLAND).sum() == sum(cells)
    still = sum(island["still_rocking"] for island in told["islands"]["all"])
    page = run(*words, *axes, "--details")[1]
    assert f"Safe islands: {len(cells)}, with {sum(cells)} of 10000 cells. A safe island is" in page
    assert (f"Cells still rocking at the end of the computation: {still} of {sum(cells)}" in page) is (still > 0)


def test_late_modes_are_one_line(run, tmp_path):
    """Under a long record all that overturns after more than 3 impacts is one line; JSON parts it."""
    time = np.arange(1500) * 0.01
    shaking = 2.0 * np.sin(6.0 * time) * np.exp(-(((time - 6.0) / 3.0) ** 2))
    np.savetxt(tmp_path / "record.txt", np.stack([time, shaking], axis=1))
    over = ("--x", "pga=0.3g:1g:15", "--y", "semi_diagonal=0.5:2:10")
    words = (*SIZE, tmp_path / "record.txt", "--units", "m/s2", *over)
    told = json.loads(run(*words, "--json")[1])
    late = [one["count"] for one in told["modes"] if one["mode"] > 3]
    assert len(late) > 1
    row = next(line for line in run(*words)[1].splitlines() if "4 or more impacts" in line)
    assert int(row.split()[-3]) == sum(late)


def test_nothing_overturns(run):
    """At or below g tan alpha nothing is lifted: the page says so, and JSON has no overturning."""
    over = ("--x", "frequency_ratio=1,2,3", "--y", "amplitude_ratio=0.2:1:5")
    _, out, _ = run(*SIZE, PULSE, *over)
    assert "Overturning in 0 of 15 cells." in out
    told = json.loads(run(*SIZE, PULSE, *over, "--json")[1])
    assert told["overturning"] is None
    assert [(one["mode"], one["share"]) for one in told["modes"]] == [(-2, 1.0)]


@pytest.mark.slow
def test_several_restitutions(run, printed, tmp_path):
    """Flips between every two are those of `map_sensitivity`; files hold every map."""
    models = ("--restitution", "ked", "--restitution", "housner", "--restitution", "0.8")
    words = (*SIZE, PULSE, *AXES, *models)
    told = json.loads(run(*words, "--json")[1])["sensitivity"]
    found = map_sensitivity(BLOCK, SINE, *RATIOS, {"ked": "ked", "housner": "housner", "0.8": 0.8})
    assert told["baseline"] == "ked"
    pairs = {(one["first"], one["second"]): one for one in told["pairs"]}
    assert set(pairs) == {("ked", "housner"), ("ked", "0.8"), ("housner", "0.8")}
    for (a, b), one in pairs.items():
        falls = [found.datasets[label]["mode"].values >= 0 for label in (a, b)]
        assert one["count"] == int((falls[0] != falls[1]).sum())
        assert one["fraction"] == one["count"] / (13 * 19)
    assert pairs["ked", "0.8"]["count"] > 0
    out = printed(*words, "--output", tmp_path / "a.csv", "--output", tmp_path / "a.nc")
    assert "With housner instead of ked, the outcome differs in" in out
    with (tmp_path / "a.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 * 13 * 19
    assert {row["restitution"] for row in rows} == {"ked", "housner", "0.8"}
    import xarray

    with xarray.open_dataset(tmp_path / "a.nc") as kept:
        assert (kept["mode"].sel(restitution="0.8") == found.datasets["0.8"]["mode"]).all()


@pytest.mark.slow
def test_files(printed, tmp_path):
    """Picture, table and netCDF are written and named; the table holds all digits."""
    files = [tmp_path / name for name in ("a.png", "a.csv", "a.nc")]
    options = [word for name, path in zip(("--output", "--output", "--output"), files, strict=True)
               for word in (name, path)]  # fmt: skip
    out = printed(*SIZE, PULSE, *AXES, "--refine", 2, *options)
    assert all(f"wrote {path}" in out and path.stat().st_size > 2000 for path in files)
    found = overturning_map(BLOCK, SINE, *RATIOS, refine=2)
    with files[1].open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["peak_rotation [rad]"]) for row in rows] == found["peak_rotation"].values.ravel().tolist()
    import xarray

    with xarray.open_dataset(files[2]) as kept:
        assert kept.sizes["point"] == found.sizes["point"]


@pytest.mark.parametrize("models", [("ked", "housner"), ("ked",)])
def test_workbook_and_matlab_file(models, printed, tmp_path):
    """Both files contain the cells of all models, without the points of a refined map, and the provenance."""
    openpyxl, matlab = pytest.importorskip("openpyxl"), pytest.importorskip("scipy.io")
    refine, files = 2 * (len(models) == 1), [tmp_path / "a.xlsx", tmp_path / "a.mat"]
    options = [word for name in models for word in ("--restitution", name)] + ["--refine", refine] * bool(refine)
    outputs = [word for path in files for word in ("--output", path)]
    printed(*SIZE, PULSE, "--x", "frequency_ratio=1:7:4", "--y", "amplitude_ratio=1:10:5", *options, *outputs)
    ratios = (("frequency_ratio", np.linspace(1, 7, 4)), ("amplitude_ratio", np.linspace(1, 10, 5)))
    maps = [overturning_map(BLOCK, SINE, *ratios, refine=refine, restitution=name) for name in models]
    peaks = [value for dataset in maps for value in dataset["peak_rotation"].values.ravel().tolist()]
    book = openpyxl.load_workbook(files[0])
    heading, *cells = book["cells"].iter_rows(values_only=True)
    assert [row[heading.index("peak_rotation [rad]")] for row in cells] == pytest.approx(peaks, rel=1e-15)
    structure = matlab.loadmat(files[1], simplify_cells=True)["rocking"]
    assert structure["peak_rotation"].tolist() == peaks
    if len(models) == 2:
        labels = [name for name in models for _ in range(20)]
        assert [row[heading.index("restitution")] for row in cells] == labels
        assert structure["restitution"].tolist() == labels
    assert json.loads(structure["provenance"])["setting_gravity"] == G
    assert float(dict(book["provenance"].iter_rows(values_only=True))["setting_gravity"]) == G


@pytest.mark.parametrize(
    ("word", "values"),
    [
        ("pga=0.1g:0.3g:3", [0.1 * G, 0.2 * G, 0.3 * G]),
        ("pga=1:3:3", [1.0, 2.0, 3.0]),
        ("pgv=10cm/s,0.5m/s", [0.1, 0.5]),
        ("semi_diagonal=40cm,80cm", [0.4, 0.8]),
        ("slenderness_angle=5deg:20deg:4", [math.radians(a) for a in (5, 10, 15, 20)]),
        ("scale=1:100:3:log", [1.0, 10.0, 100.0]),
        ("period=200ms,.4s", [0.2, 0.4]),
        ("scale=-1,1e0", [-1.0, 1.0]),
    ],
)
def test_axis_words(word, values):
    """Ranges, lists, equal ratios and units give the values that they say."""
    name, _, text = word.partition("=")
    assert row("--x", text, axes()[name].unit)[0] == pytest.approx(values, rel=1e-14, abs=0.0)


def test_bar_on_a_terminal_only(monkeypatch):
    """A terminal sees how many of how many are done; a file sees nothing."""

    class Terminal(io.StringIO):
        def isatty(self):
            return True

    for kind, shown in ((Terminal, True), (io.StringIO, False)):
        stream = kind()
        monkeypatch.setattr(sys, "stderr", stream)
        with bar("histories", 40) as tell:
            tell(10)
            tell(30)
        assert ("40/40" in stream.getvalue()) == shown
