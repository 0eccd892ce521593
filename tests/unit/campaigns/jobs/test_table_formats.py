"""Tables of adaptive studies and of comparisons for MATLAB and netCDF: the numbers of the CSV file."""

import csv
import json
import re

import numpy as np
import pytest
from scipy.io import loadmat

from rocking.campaigns.jobs import Job, JobFolder, export
from rocking.errors import InvalidValueError
from rocking.tables import Column, Table, add_to_netcdf, text_array, to_mat

xr = pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")

BODY = '[body]\nunits = "m"\nwidth = 0.5\nheight = 2.0\n'
PULSE = '[motions]\npulse = ["sine:amplitude=3,period=0.6", "sine:amplitude=3,period=1.1"]\n'
MINIMUM = """[campaign]
name = "minima"
kind = "minimum-acceleration"
{body}{pulse}[restitution]
values = [0.85, 0.93]
[minimum]
highest = {highest}
points = 20
levels = 1
"""
MAP = """[campaign]
name = "two models"
kind = "overturning-map"
{body}[motions]
pulse = "sine:amplitude=3,period=0.6"
[restitution]
models = ["housner", "ked"]
[map]
x = {{ axis = "frequency_ratio", from = 2, to = 8, count = 9 }}
y = {{ axis = "amplitude_ratio", from = 1, to = 9, count = 7 }}
"""
STRIPES = """[campaign]
name = "stripes"
kind = "stripes"
{body}[motions]
synthetic = "pulse-like"
count = 30
seed = 1
[restitution]
models = ["housner", "ked"]
[fragility]
levels = {{ from = 2, to = 12, count = 6 }}
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Campaigns that are through."""
    place = tmp_path_factory.mktemp("made")
    texts = {
        "minimum": MINIMUM.format(body=BODY, pulse=PULSE, highest=20.0),
        "nothing": MINIMUM.format(body=BODY, pulse=PULSE, highest=2.6),
        "map": MAP.format(body=BODY),
        "stripes": STRIPES.format(body=BODY),
    }
    folders = {name: JobFolder.create(place / name, Job.of_text(text)) for name, text in texts.items()}
    for folder in folders.values():
        folder.run(workers=1)
    return folders


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


def test_refined_maps(tmp_path, made):
    """Points and vertices of refined maps go to MATLAB too."""
    text = MAP.format(body=BODY).replace('models = ["housner", "ked"]', 'model = "ked"') + "refine = 1\n"
    folder = JobFolder.create(tmp_path / "refined", Job.of_text(text))
    folder.run(workers=1)
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
    with pytest.raises(InvalidValueError, match=r"up to 2 GiB, this one has 20 rows; take \.nc"):
        to_mat(table, tmp_path / "s.mat")
    add_to_netcdf({"row": table}, tmp_path / "s.nc", {})
