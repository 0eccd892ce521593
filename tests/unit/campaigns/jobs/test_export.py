"""Finished campaigns as files: the same numbers in every format, with units and provenance, in little memory."""

import csv
import hashlib
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rocking.campaigns import Campaign, CampaignIncompleteError, CampaignStorageError
from rocking.campaigns.jobs import Job, JobFolder, export
from rocking.campaigns.jobs.exporting import FORMATS
from rocking.campaigns.jobs.findings import datasets
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.quantities import QUANTITIES
from rocking.studies.islands import safe_islands
from rocking.studies.study_plan import TYPES

xr = pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")


def truth(folder):
    """What is known of all histories."""
    return folder.job.study.derived(0, folder.campaign.plan.count, folder.campaign.results())


def from_netcdf(path):
    file = xr.load_dataset(path, engine="h5netcdf")
    assert all(file[name].attrs["units"] == QUANTITIES[name].unit for name in file.data_vars if name in QUANTITIES)
    assert file.attrs["software"].startswith("rocking ")
    return {name: file[name].values.ravel() for name in file.data_vars}, file.attrs["provenance"]


def from_parquet(path):
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(path)
    assert parquet.ParquetFile(path).metadata.num_row_groups == 5  # 2 bodies x 3 pulses x 4 scales x 2 models by 10
    assert table["restitution"].to_pylist()[:2] == ["housner", "ked"]
    assert table["scale"].to_pylist()[:4] == [2.5, 2.5, 5.0, 5.0]
    assert table.schema.field("peak_rotation").metadata[b"units"] == b"rad"
    return {name: table[name].to_numpy() for name in TYPES}, table.schema.metadata[b"provenance"]


def heading(name):
    return name if QUANTITIES[name].unit == "1" else f"{name} [{QUANTITIES[name].unit}]"


def from_csv(path):
    """Nothing stands for what is no number, and the provenance beside the file."""
    rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
    assert "nan" not in {row[heading(name)] for row in rows for name in TYPES}
    columns = {name: np.array([float(row[heading(name)] or "nan") for row in rows]) for name in TYPES}
    return columns, path.with_name("r.csv.provenance.json").read_text()


def from_matlab(path):
    """One structure with arrays of the shape of the study."""
    from scipy.io import loadmat

    found = loadmat(path, simplify_cells=True)["campaign"]
    assert list(found["dimensions"]) == ["motion", "body", "scale", "restitution"]
    assert found["results"]["peak_rotation"].shape == (3, 2, 4, 2)
    assert found["units"]["peak_rotation"] == "rad"
    assert found["coordinates"]["scale"].tolist() == [2.5, 5.0, 8.0, 11.0]
    return {name: values.ravel() for name, values in found["results"].items()}, found["provenance"]


def from_excel(path):
    """A sheet of rows, and one of provenance; Excel keeps 15 digits and a bit."""
    book = pytest.importorskip("openpyxl").load_workbook(path)
    header, *rows = book["histories"].iter_rows(values_only=True)
    cells = {name: [row[header.index(heading(name))] for row in rows] for name in TYPES}
    columns = {
        name: np.array([np.nan if cell is None else cell for cell in each], float) for name, each in cells.items()
    }
    return columns, dict(book["provenance"].iter_rows(values_only=True, max_col=2))["provenance"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("end", "read", "within"),
    [
        (".nc", from_netcdf, 0.0), (".parquet", from_parquet, 0.0), (".csv", from_csv, 0.0), (".mat", from_matlab, 0.0),
        (".xlsx", from_excel, 1e-15),
    ],
)  # fmt: skip
def test_every_format_holds_all_numbers(finished, tmp_path, end, read, within):
    """All columns to the last bit, with units, coordinates and a provenance that parses."""
    folder = finished("histories", 10)
    columns, provenance = read(export(folder, tmp_path / f"r{end}"))
    for name, values in truth(folder).items():
        np.testing.assert_allclose(columns[name], values, rtol=within, atol=0.0, err_msg=name)
    assert json.loads(provenance) == folder.job.provenance


@pytest.mark.slow
def test_the_same_bytes_whatever_the_chunks(text, tmp_path):
    """The bytes of the file do not depend on the chunks, which cut through rows; those of another study differ."""
    files = {}
    for chunk, words in ((3, ""), (7, ""), (63, ""), (7, "to = 8")):
        job = Job.of_text(text("overturning-map").replace("to = 7", words or "to = 7"))
        folder = JobFolder(tmp_path / f"c{chunk}{words}", job)
        Campaign.create(folder.path / "histories", job.study.histories, chunk).run(workers=1, order_seed=chunk)
        assert folder.campaign.plan.size == chunk
        path = export(folder, tmp_path / "r.nc")
        files[chunk, words] = hashlib.sha256(path.read_bytes()).hexdigest()
    assert files[3, ""] == files[7, ""] == files[63, ""] != files[7, "to = 8"]


@pytest.mark.parametrize(
    ("end", "limit", "words"),
    [
        (
            ".xlsx",
            "rocking.tables.rows.MOST_ROWS_OF_EXCEL",
            "a sheet of Excel has at most 10 rows, but the table has 48 histories",
        ),
        (
            ".mat",
            "rocking.tables.arrays.MOST_BYTES_OF_MATLAB",
            "MATLAB files allow arrays up to 2 GiB, and this result has arrays of 3.58e-07 GiB",
        ),
    ],
)
def test_too_many_for_the_format(finished, tmp_path, monkeypatch, end, limit, words):
    """What a format cannot hold is refused with the formats that can."""
    monkeypatch.setattr(limit, 10)
    with pytest.raises(InvalidValueError, match=words):
        export(finished("histories"), tmp_path / f"r{end}")
    assert not (tmp_path / f"r{end}").exists()


def test_words_that_are_no_formulas(text, finished, tmp_path):
    """A body file cannot smuggle a formula into a spreadsheet; labels that start like one are quoted."""
    folder = finished("histories", None, text("histories").replace("a small histories", "=cmd()"))
    openpyxl = pytest.importorskip("openpyxl")
    cells = [c for row in openpyxl.load_workbook(export(folder, tmp_path / "r.xlsx"))["provenance"] for c in row]
    assert all(cell.data_type != "f" for cell in cells)


@pytest.mark.slow
@pytest.mark.parametrize("end", [".nc", ".csv", ".mat", ".xlsx", ".xml"])
def test_fragility(finished, tmp_path, end, text):
    """Fragility curves in every format; the parameters in CSV and NRML are those of the analysis."""
    if end == ".xlsx":
        pytest.importorskip("openpyxl")
    from rocking.campaigns.jobs import analyses

    folder = finished("incremental", None, text("incremental").replace("9.0]", "7.0, 8.0, 9.0]"))
    path = export(folder, tmp_path / f"f{end}", "fragility")
    assert path.stat().st_size > 300
    fit = analyses(folder)["0.9"].fits["overturned"]
    if end == ".csv":
        assert repr(fit.median) in path.read_text()
    if end == ".xml":
        assert "nrml" in path.read_text()
        assert (tmp_path / "f.xml.provenance.json").exists()
    if end == ".nc":
        assert "provenance" in xr.load_dataset(path, engine="h5netcdf").attrs


@pytest.mark.parametrize(
    ("name", "what", "options", "wanted"),
    [
        ("r.pdf", "histories", {}, r"histories can be written as \.nc, \.parquet, \.csv, \.mat, \.xlsx, got '\.pdf'"),
        ("r", "histories", {}, "got 'no ending'"),
        ("r.xml", "histories", {}, "NRML"),
        ("r.nc", "maps", {}, "table must be one of histories, fragility, .*, minima, .*got 'maps'"),
        ("r.nc", "fragility", {}, 'a campaign of kind "histories" has no fragility'),
        ("r.nc", "histories", {"restitution": "ked"}, "restitution applies to fragility"),
        ("none/r.nc", "histories", {}, "no folder"),
    ],
)
def test_refusals(finished, tmp_path, name, what, options, wanted):
    """What cannot be exported is refused before anything is written."""
    folder = finished("histories")
    before = set(tmp_path.iterdir())
    with pytest.raises(InvalidValueError, match=wanted):
        export(folder, tmp_path / name, what, **options)
    assert set(tmp_path.iterdir()) == before


@pytest.mark.slow
def test_which_restitution(finished, tmp_path, text):
    """With several restitutions one must be named, and it decides the curve."""
    words = text("incremental").replace("value = 0.9", "values = [0.85, 0.95]")
    folder = finished("incremental", None, words)
    with pytest.raises(InvalidValueError, match=r"must be one of 0\.85, 0\.95, because every restitution has"):
        export(folder, tmp_path / "f.csv", "fragility")
    with pytest.raises(InvalidValueError, match=r"got '0\.9'"):
        export(folder, tmp_path / "f.csv", "fragility", restitution="0.9")
    one = export(folder, tmp_path / "f.csv", "fragility", restitution="0.85").read_text()
    assert one != export(folder, tmp_path / "g.csv", "fragility", restitution="0.95").read_text()


def test_nothing_to_export(tmp_path, text):
    """A campaign that is not finished is not exported, not even in part; the sentence says how to go on."""
    folder = JobFolder.create(tmp_path / "c", Job.of_text(text("histories", 10)))
    with pytest.raises(CampaignIncompleteError, match=r"nothing to export because 0 of 5 chunks .* campaign resume"):
        export(folder, tmp_path / "r.nc")
    assert not list(tmp_path.glob("*r*.nc"))


def test_disk_full(finished, tmp_path, monkeypatch):
    """A disk that is full leaves no file, and an older one stays as it was."""
    folder = finished("histories")
    path = export(folder, tmp_path / "r.nc")
    before = path.read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setitem(FORMATS, ".nc", full)
    with pytest.raises(CampaignStorageError, match="No space left on device; the campaign itself is safe"):
        export(folder, path)
    assert path.read_bytes() == before
    assert not list(tmp_path.glob(".*part*"))


def test_missing_extra(finished, tmp_path, monkeypatch):
    """Without pyarrow the sentence names what to install."""
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MissingExtraError, match=r'Parquet needs pyarrow: pip install "rocking\[parquet\]"'):
        export(finished("histories"), tmp_path / "r.parquet")


MANY = r"""
import re, sys
from pathlib import Path
from rocking.campaigns.jobs import Job, JobFolder, export

def peak():
    # ru_maxrss would begin with that of the process that started this one
    return int(re.search(r"VmHWM:\s*(\d+)", Path("/proc/self/status").read_text())[1])

folder = JobFolder.create(sys.argv[1], Job.of_text(open(sys.argv[2]).read()))
folder.campaign.run(workers=1)
running = peak()
Path("/proc/self/clear_refs").write_text("5")  # the peak starts anew
before = peak()
export(folder, sys.argv[3])
print(folder.campaign.plan.count, running, before, peak())
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/clear_refs").exists(), reason="the peak of memory is read from /proc")
@pytest.mark.parametrize(("end", "most"), [(".nc", 50e6), (".parquet", 200e6)])
def test_memory_stays_bounded(tmp_path, text, end, most):
    """A million histories, 115 MB as arrays, are written piece by piece."""
    if end == ".parquet":
        pytest.importorskip("pyarrow")
    words = text("overturning-map").replace("count = 9", "count = 1000").replace("count = 7", "count = 1000")
    # most of them below uplift, where a history takes a microsecond
    words = words.replace('"amplitude_ratio", from = 1, to = 9', '"amplitude_ratio", from = 0.1, to = 1.2')
    (tmp_path / "job.toml").write_text(words, encoding="utf-8")
    arguments = [str(tmp_path / "c"), str(tmp_path / "job.toml"), str(tmp_path / f"r{end}")]
    found = subprocess.run([sys.executable, "-c", MANY, *arguments], capture_output=True, text=True, check=True)
    count, running, before, after = (int(word) for word in found.stdout.split())
    assert count == 1_000_000
    assert Path(arguments[2]).stat().st_size > 1_000_000
    # libraries and a few pieces: 44 and 167 MB, for four times the histories too; Arrow keeps 100 MB of that to itself
    assert 1024 * (after - before) < most
    assert 1024 * max(running, after) < 300_000_000


@pytest.mark.slow
@pytest.mark.parametrize("end", [".nc", ".csv"])
def test_a_map_says_what_its_safe_islands_are(finished, tmp_path, end):
    """The provenance in the file, or beside it, has the sentences of the Python attribute, by restitution."""
    folder = finished("overturning-map")
    path = export(folder, tmp_path / f"r{end}")
    if end == ".nc":
        with xr.open_dataset(path, engine="h5netcdf") as found:
            told = json.loads(found.attrs["provenance"])["safe_islands"]
    else:
        told = json.loads(path.with_name(f"{path.name}.provenance.json").read_text("utf-8"))["safe_islands"]
    assert told == {label: list(safe_islands(found).sentences) for label, found in datasets(folder).items()}
    assert all("A safe island is" in sentences[0] for sentences in told.values())
