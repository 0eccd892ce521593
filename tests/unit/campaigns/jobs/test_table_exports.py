"""Tables of adaptive studies and of comparisons: as the Python calls have them, the same numbers in every format."""

import csv
import json
import re

import numpy as np
import pytest
from campaign_jobs import BODY, PULSE, TWO_MODELS, axes, finished, job
from scipy.io import loadmat

import rocking as rk
from rocking import conventions
from rocking.campaigns.jobs import comparison, export
from rocking.campaigns.jobs.exporting import exports_of
from rocking.errors import InvalidValueError
from rocking.studies import map_sensitivity
from rocking.tables import Column, Table, add_to_netcdf, text_array, to_mat

xr = pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")

X, Y = np.linspace(2.0, 8.0, 9), np.linspace(1.0, 9.0, 7)
MAP = PULSE + axes((2, 8, 9), (1, 9, 7))
MINIMUM = """[motions]
pulse = ["sine:amplitude=3,period=0.6", "sine:amplitude=3,period=1.1"]
[restitution]
values = [0.85, 0.93]
[minimum]
samples = 20
bisections = 1
"""
STRIPES = """[motions]
synthetic = "pulse-like"
count = 30
seed = 1
[fragility]
levels = { from = 2, to = 12, count = 6 }
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Campaigns that are through."""
    texts = {
        "minimum": job("minimum-acceleration", BODY, MINIMUM, "max_pga = 20.0\n"),
        "nothing": job("minimum-acceleration", BODY, MINIMUM, "max_pga = 2.6\n"),
        "map": job("overturning-map", BODY, TWO_MODELS, MAP),
        "one model": job("overturning-map", BODY, MAP),
        "histories": job("histories", BODY, TWO_MODELS, PULSE, "[histories]\nscales = [1, 2, 3]\n"),
        "stripes": job("stripes", BODY, TWO_MODELS, STRIPES),
    }
    place = tmp_path_factory.mktemp("made")
    return {name: finished(place / name, text) for name, text in texts.items()}


def rows_of(path):
    """Return header without units, and rows, of a CSV file."""
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    return [re.sub(r" \[[^\]]*\]$", "", name) for name in header], rows


def agree(cells, values):
    """Whether cells of a CSV file say what an array says."""
    values = np.atleast_1d(values)
    if values.dtype.kind in "OUS":
        return list(cells) == [str(value) if np.size(value) else "" for value in values]  # MATLAB's empty word
    return np.array_equal([float(cell) if cell else np.nan for cell in cells], values.astype(float), equal_nan=True)


CASES = [("minimum", "crossings"), ("minimum", "minima"), ("map", "flips"), ("map", "differences")]
CASES += [("stripes", "flips"), ("stripes", "differences")]


@pytest.mark.slow
@pytest.mark.parametrize(("which", "what"), CASES)
def test_matlab(made, tmp_path, which, what):
    """A structure of columns with the values of the CSV file to the last bit, and where they come from."""
    header, rows = rows_of(export(made[which], tmp_path / "r.csv", what))
    path = export(made[which], tmp_path / "r.mat", what)
    found = loadmat(path, squeeze_me=True, struct_as_record=False)["table"]
    names = {getattr(found.names, word): word for word in found.names._fieldnames}
    assert list(names) == header
    for k, name in enumerate(header):
        assert agree([row[k] for row in rows], getattr(found.columns, names[name])), name
    assert all(re.fullmatch(r"[A-Za-z]\w*", word) for word in names.values())
    assert json.loads(found.provenance)["job"] == made[which].job.text


@pytest.mark.slow
@pytest.mark.parametrize(("which", "what"), CASES[2:])
def test_netcdf(made, tmp_path, which, what):
    """Flips and differences as variables along the rows of their tables, with the values of the CSV file."""
    header, rows = rows_of(export(made[which], tmp_path / "r.csv", what))
    found = xr.load_dataset(export(made[which], tmp_path / "r.nc", what), engine="h5netcdf")
    assert len(found.variables) == len(header)
    for k, name in enumerate(header):
        assert agree([row[k] for row in rows], found[re.sub(r"\W+", "_", name).strip("_")].values), name
    assert json.loads(found.attrs["provenance"]) == made[which].job.provenance


def test_crossings_in_netcdf(made, tmp_path):
    """One .nc holds both tables, and its crossings are those of the MATLAB file; another restitution's are not."""
    both = xr.load_dataset(export(made["minimum"], tmp_path / "r.nc", "crossings"), engine="h5netcdf")
    path = export(made["minimum"], tmp_path / "r.mat", "crossings")
    table = loadmat(path, squeeze_me=True, struct_as_record=False)["table"].columns
    assert np.array_equal(both["crossing_acceleration"].values, table.crossing_acceleration)
    assert "case_minimum" in both
    own = both["crossing_restitution"].values == "0.85"
    assert not np.array_equal(both["crossing_acceleration"].values[own], both["crossing_acceleration"].values[~own])


@pytest.mark.parametrize("end", [".mat", ".nc", ".csv", ".parquet", ".xlsx"])
def test_no_crossings(made, tmp_path, end):
    """A search that finds nothing makes files without rows, not errors."""
    for name, package in ((".parquet", "pyarrow"), (".xlsx", "openpyxl")):
        if end == name:
            pytest.importorskip(package)
    path = export(made["nothing"], tmp_path / f"r{end}", "crossings")
    if end == ".csv":
        header, rows = rows_of(path)
        assert (header[0], rows) == ("motion", [])
    if end == ".mat":
        table = loadmat(path, squeeze_me=True, struct_as_record=False)["table"].columns
        assert np.size(table.crossing_acceleration) == np.size(table.crossing_motion) == 0


@pytest.mark.slow
def test_refined_maps(tmp_path):
    """Points and vertices of refined maps go to MATLAB too."""
    folder = finished(tmp_path / "refined", job("overturning-map", BODY, MAP, "refine = 1\n"))
    for what, name in (("refined", "refined_mode"), ("boundary", "boundary_x")):
        _, rows = rows_of(export(folder, tmp_path / "r.csv", what))
        path = export(folder, tmp_path / "r.mat", what)
        table = loadmat(path, squeeze_me=True, struct_as_record=False)["table"].columns
        assert len(rows) == getattr(table, name).size > 10


def test_too_large_for_matlab(tmp_path, monkeypatch):
    """A table beyond the format is refused with the format that takes it; the same table fits where words are few."""
    monkeypatch.setattr("rocking.tables.arrays.MOST_BYTES_OF_MATLAB", 1000)
    numbers, words = Column(np.arange(20.0)), Column(text_array(["a"] * 20))
    to_mat(Table("row", {"x": numbers}), tmp_path / "r.mat")
    table = Table("row", {"x": numbers, "w": words})
    with pytest.raises(InvalidValueError, match=r"up to 2 GiB, this table has 20 rows; use \.nc"):
        to_mat(table, tmp_path / "s.mat")
    add_to_netcdf({"row": table}, tmp_path / "s.nc", {})


def from_python(models):
    """The same comparison by the call."""
    body, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(3.0, 0.6)
    return map_sensitivity(body, pulse, ("frequency_ratio", X), ("amplitude_ratio", Y), models)


def test_the_same_comparison_as_from_python(made):
    """Flips and differences of the campaign are those of `map_sensitivity`; those of the reverse order are not."""
    found, wanted = comparison(made["map"]), from_python(["housner", "ked"])
    assert found.summary() == wanted.summary()
    assert found.summary()[1]["flips"] > 0
    for name in ("verdict", "peak_ratio"):
        np.testing.assert_array_equal(found.differences(name).values, wanted.differences(name).values)
    assert found.summary() != from_python(["ked", "housner"]).summary()


def test_comparisons_add_up(made, tmp_path):
    """The files have a row for each choice and each cell, and add up to the flips."""
    tables = {}
    for what in ("flips", "differences"):
        header, rows = rows_of(export(made["map"], tmp_path / f"{what}.csv", what))
        tables[what] = [dict(zip(header, row, strict=True)) for row in rows]
    flips, cells = tables.values()
    assert [row["choice"] for row in flips] == ["housner", "ked"]
    assert len(cells) == X.size * Y.size
    assert {row["restitution"] for row in cells} == {"ked"}
    changed = [row for row in cells if float(row["verdict"]) in {-1.0, 1.0}]
    assert len(changed) == float(flips[1]["flips"])
    gained = [row for row in changed if float(row["verdict"]) == 1.0]
    assert len(gained) == float(flips[1]["only_second"])
    block = rk.Block(width=0.5, height=2.0)
    period = 2.0 * np.pi / (float(gained[0]["frequency_ratio"]) * block.frequency_parameter)
    amplitude = float(gained[0]["amplitude_ratio"]) * conventions.g * np.tan(block.slenderness_angle)
    outcomes = [rk.simulate(block, rk.pulses.sine(amplitude, period), r).outcome for r in ("housner", "ked")]
    assert outcomes == [rk.Outcome.ROCKED, rk.Outcome.OVERTURNED]


def test_comparisons_of_other_kinds(made, tmp_path):
    """Histories and stripes with several restitutions are compared too; stripes tell how their curves move."""
    assert comparison(made["histories"]).summary()[1]["computed"] == 3
    header, rows = rows_of(export(made["stripes"], tmp_path / "flips.csv", "flips"))
    # KED loses less than Housner, so that its median is lower
    assert float(rows[1][header.index("overturned: median ratio")]) < 1.0


def test_refusals_of_comparisons(made, tmp_path):
    """One restitution has nothing to compare, and a format that does not fit is refused."""
    assert exports_of(made["one model"]) == ["histories"]
    assert exports_of(made["map"]) == ["histories", "flips", "differences"]
    with pytest.raises(InvalidValueError, match="several restitutions"):
        comparison(made["one model"])
    with pytest.raises(InvalidValueError, match="has no flips"):
        export(made["one model"], tmp_path / "x.csv", "flips")
    with pytest.raises(InvalidValueError, match=r"flips can be written as \.nc, \.csv, .*got '\.pdf'"):
        export(made["map"], tmp_path / "x.pdf", "flips")
