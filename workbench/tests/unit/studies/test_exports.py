"""Finished studies as files: the numbers of the study in every format, pictures and names that do nothing."""

import csv
import io
import tomllib
from typing import get_args
from xml.etree import ElementTree as ET

import h5netcdf
import numpy as np
import openpyxl
import pytest
from scipy.io import loadmat

from rocking.campaigns.jobs import Job
from rocking_workbench.answers import MEDIA_TYPES
from rocking_workbench.errors import NotFound, Refused
from rocking_workbench.studies.finished import Kind, written

NAME = '=cmd|" /C calc"!A0<script>alert(1)</script>'


@pytest.fixture(scope="module")
def study(computed, map_job):
    return computed(map_job(5, campaign={"name": NAME, "kind": "overturning-map"}))


@pytest.fixture(scope="module")
def stripes(computed, map_job):
    pulses = [f"sine:amplitude=1,period={p}" for p in (0.4, 0.5, 0.7, 0.9, 1.2)]
    return computed(map_job(
        campaign={"name": NAME, "kind": "stripes"}, map=None, motions={"pulse": pulses},
        restitution={"values": [0.98, 0.4]}, fragility={"levels": [2.0, 4.0, 6.0, 8.0], "limit_states": []},
    ))  # fmt: skip


def _written(study, kind, folder, what=None, restitution=0):
    path = folder / f"study.{kind}"
    written(study, kind, path, what, restitution)
    return path


def test_every_table_has_the_numbers_of_the_study(study, tmp_path):
    """CSV, Excel, MATLAB, netCDF and Parquet hold the same modes and peaks, to the last digit; no name is a formula."""
    modes, peaks = study.results["mode"], study.results["peak_ratio"]
    text = _written(study, "csv", tmp_path).read_text()
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [int(row["mode"]) for row in rows] == modes.ravel().tolist()
    assert [float(row["peak_ratio"]) for row in rows] == peaks.ravel().tolist()
    assert not [cell for row in csv.reader(io.StringIO(text)) for cell in row if cell[:1] in set("=+@\t\r")]
    book = openpyxl.load_workbook(_written(study, "xlsx", tmp_path))
    head, *cells = book["histories"].iter_rows(values_only=True)
    assert [row[head.index("mode")] for row in cells] == modes.ravel().tolist()
    assert not [cell for sheet in book for row in sheet.iter_rows() for cell in row if cell.data_type == "f"]
    mat = loadmat(_written(study, "mat", tmp_path), simplify_cells=True)["campaign"]
    assert np.array_equal(mat["results"]["peak_ratio"], peaks)
    with h5netcdf.File(_written(study, "nc", tmp_path)) as file:
        assert np.array_equal(file["peak_ratio"][...], peaks)
    parquet = pytest.importorskip("pyarrow.parquet")
    assert parquet.read_table(_written(study, "parquet", tmp_path))["mode"].to_pylist() == modes.ravel().tolist()


def test_the_job_file_gives_the_same_study(study, tmp_path):
    """The command line takes the TOML and has the same histories, told by their key."""
    path = _written(study, "toml", tmp_path)
    assert tomllib.loads(path.read_text())["campaign"]["name"] == NAME
    assert Job.read(path).study.histories.key() == study.opened.campaign.plan.key


def test_pictures_are_inert(study, stripes, tmp_path):
    """No script, event or address stands in the SVG of a comparison."""
    pictures = [_written(each, "svg", tmp_path).read_bytes() for each in (study, stripes)]
    for element in (each for picture in pictures for each in ET.fromstring(picture).iter()):
        assert element.tag.rpartition("}")[2] not in {"script", "foreignObject", "iframe"}
        assert not [name for name in element.attrib if name.lower().startswith("on")]
        links = [value for name, value in element.attrib.items() if name.endswith("href")]
        assert all(link.startswith(("#", "data:image/png")) for link in links)


def test_fragility_goes_to_openquake_and_into_tables(stripes, tmp_path):
    """NRML is well formed and of the restitution that was asked for; parameters of curves are written where asked."""
    first, second = (_written(stripes, "xml", tmp_path, restitution=k).read_bytes() for k in (0, 1))
    assert ET.fromstring(first).tag == "{http://openquake.org/xmlns/nrml/0.5}nrml"
    assert b"<script>" not in first
    assert first != second
    for what in ("fragility", "fema-p58"):
        assert "overturned" in _written(stripes, "csv", tmp_path, what, 1).read_text()


@pytest.mark.parametrize(
    ("kind", "what", "restitution", "error"),
    [
        ("xml", None, 0, Refused), ("csv", "fragility", 0, Refused), ("csv", "../../x", 0, Refused),
        ("csv", None, 9, NotFound), ("svg", None, -1, NotFound),
    ],
)  # fmt: skip
def test_what_a_map_does_not_have_is_refused(kind, what, restitution, error, study, tmp_path):
    """A map has no fragility, no other restitution, and no file of any other name; no path is told."""
    with pytest.raises(error) as caught:
        _written(study, kind, tmp_path, what, restitution)
    assert str(tmp_path) not in str(caught.value)


def test_every_format_has_a_type():
    """None is sent as a page."""
    assert set(get_args(Kind)) == {"nc", "csv", "mat", "xlsx", "parquet", "toml", "svg", "xml"}
    assert all("html" not in MEDIA_TYPES[kind] for kind in get_args(Kind))


def test_a_picture_compares_all_restitutions(computed, map_job, stripes, tmp_path):
    """What differs is drawn of all choices at once; a study with one is refused."""
    both = _written(stripes, "svg", tmp_path).read_bytes()
    assert both.count(b"<path") > 10
    one = computed(map_job(3, restitution={"model": "ked"}))
    with pytest.raises(Refused, match="nothing to compare"):
        written(one, "svg", tmp_path / "one.svg", None, 0)


def test_a_picture_of_an_incremental_study_has_its_curves(computed, map_job, tmp_path):
    """It is of one restitution, and no comparison: a study with one has it too."""
    asked = {
        "campaign": {"name": "rise", "kind": "incremental"}, "map": None,
        "fragility": {"levels": [2.0, 4.0, 8.0, 12.0]},
        "motions": {"pulse": [f"sine:amplitude={a},period={p}" for a in (2.0, 4.0) for p in (0.4, 0.7)]},
    }  # fmt: skip
    one = computed(map_job(**asked, restitution={"value": 0.9}))
    two = computed(map_job(**asked, restitution={"values": [0.9, 0.4]}))
    alone, same, other = (
        _written(each, "svg", tmp_path, restitution=k).read_bytes() for each, k in ((one, 0), (two, 0), (two, 1))
    )
    assert alone.count(b"<path") > 10
    assert alone == same != other
