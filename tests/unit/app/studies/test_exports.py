"""Finished studies as files."""

import csv
import io
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import h5netcdf
import numpy as np
import openpyxl
import pytest
from scipy.io import loadmat

from rocking.app.errors import NotFound, Refused
from rocking.app.studies.exports import MEDIA_TYPES, written
from rocking.app.studies.opened import OpenStudy
from rocking.campaigns.jobs import Job

Tables = dict[str, Any]
NAME = '=cmd|" /C calc"!A0<script>alert(1)</script>'


@pytest.fixture
def study(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]) -> OpenStudy:
    return computed(map_job(5, campaign={"name": NAME, "kind": "overturning-map"}))


def _written(study: OpenStudy, kind: Any, folder: Path, what: str | None = None, restitution: int = 0) -> Path:
    path = folder / f"study.{kind}"
    written(study, kind, path, what, restitution)
    return path


def test_every_table_has_the_numbers_of_the_study(study: OpenStudy, tmp_path: Path) -> None:
    """CSV, Excel, MATLAB and netCDF hold the same modes and peaks, to the last digit."""
    modes, peaks = study.results["mode"], study.results["peak_ratio"]
    rows = list(csv.DictReader(io.StringIO(_written(study, "csv", tmp_path).read_text())))
    assert [int(row["mode"]) for row in rows] == modes.ravel().tolist()
    assert [float(row["peak_ratio"]) for row in rows] == peaks.ravel().tolist()
    sheet = openpyxl.load_workbook(_written(study, "xlsx", tmp_path))["histories"]
    head, *cells = sheet.iter_rows(values_only=True)
    assert [row[head.index("mode")] for row in cells] == modes.ravel().tolist()
    found = loadmat(_written(study, "mat", tmp_path), simplify_cells=True)["campaign"]
    assert np.array_equal(found["results"]["peak_ratio"], peaks)
    with h5netcdf.File(_written(study, "nc", tmp_path)) as file:
        assert np.array_equal(file["peak_ratio"][...], peaks)


def test_parquet_is_written(study: OpenStudy, tmp_path: Path) -> None:
    """A table for data frames, where pyarrow is there."""
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(_written(study, "parquet", tmp_path))
    assert table["mode"].to_pylist() == study.results["mode"].ravel().tolist()


def test_the_job_file_gives_the_same_study(study: OpenStudy, tmp_path: Path) -> None:
    """The command line takes the TOML and has the same histories, told by their key."""
    path = _written(study, "toml", tmp_path)
    assert tomllib.loads(path.read_text())["campaign"]["name"] == NAME
    assert Job.read(path).study.histories.key() == study.job.campaign.key


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_pictures_are_inert(kind: str, study: OpenStudy, tmp_path: Path) -> None:
    """A picture is one, and no script, event or address stands in its SVG."""
    first, second = (_written(study, kind, tmp_path, restitution=k).read_bytes() for k in (0, 1))
    assert first != second
    if kind == "png":
        assert first.startswith(b"\x89PNG")
        return
    for element in ET.fromstring(first).iter():
        assert element.tag.rpartition("}")[2] not in {"script", "foreignObject", "iframe"}
        assert not [name for name in element.attrib if name.lower().startswith("on")]
        links = [value for name, value in element.attrib.items() if name.endswith("href")]
        assert all(link.startswith(("#", "data:image/png")) for link in links)


def test_names_are_no_formulas(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables],
                               tmp_path: Path) -> None:  # fmt: skip
    """A name that a spreadsheet would run is text in every cell of CSV and Excel."""
    study = computed(map_job(2, campaign={"name": NAME, "kind": "overturning-map"}))
    rows = csv.reader(io.StringIO(_written(study, "csv", tmp_path).read_text()))
    assert not [cell for row in rows for cell in row if cell[:1] in set("=+@\t\r")]
    book = openpyxl.load_workbook(_written(study, "xlsx", tmp_path))
    assert not [cell for sheet in book for row in sheet.iter_rows() for cell in row if cell.data_type == "f"]


@pytest.fixture
def stripes(computed: Callable[[Tables], OpenStudy], map_job: Callable[..., Tables]) -> OpenStudy:
    pulses = [f"sine:amplitude=1,period={p}" for p in (0.4, 0.5, 0.7, 0.9, 1.2)]
    fragility = {"levels": [2.0, 4.0, 6.0, 8.0], "states": []}
    campaign = {"name": NAME, "kind": "stripes"}
    tables = {"fragility": fragility, "motions": {"pulse": pulses}, "restitution": {"values": [0.98, 0.4]}}
    return computed(map_job(campaign=campaign, map=None, **tables))


def test_fragility_goes_to_openquake(stripes: OpenStudy, tmp_path: Path) -> None:
    """NRML is well formed, names the states, and is of the restitution that was asked for."""
    first, second = (_written(stripes, "xml", tmp_path, restitution=k).read_bytes() for k in (0, 1))
    root = ET.fromstring(first)
    assert root.tag == "{http://openquake.org/xmlns/nrml/0.5}nrml"
    assert b"<script>" not in first
    assert first != second


@pytest.mark.parametrize("what", ["fragility", "fema-p58"])
def test_curves_are_tables(what: str, stripes: OpenStudy, tmp_path: Path) -> None:
    """The parameters of the curves are written where they are asked for."""
    assert "overturned" in _written(stripes, "csv", tmp_path, what, 1).read_text()


def test_fragility_has_a_picture(stripes: OpenStudy, tmp_path: Path) -> None:
    """As a map has."""
    assert _written(stripes, "png", tmp_path).read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("kind", "what", "restitution", "error"),
    [
        ("xml", None, 0, Refused), ("csv", "fragility", 0, Refused), ("csv", "../../x", 0, Refused),
        ("csv", None, 9, NotFound), ("png", None, -1, NotFound),
    ],
)  # fmt: skip
def test_what_a_map_does_not_have_is_refused(
    kind: str, what: str | None, restitution: int, error: type[Exception], study: OpenStudy, tmp_path: Path
) -> None:
    """A map has no fragility, no other restitution, and no file of any other name; no path is told."""
    with pytest.raises(error) as caught:
        _written(study, kind, tmp_path, what, restitution)
    assert str(tmp_path) not in str(caught.value)


def test_every_format_has_a_type() -> None:
    """None is sent as a page."""
    assert all("html" not in kind for kind in MEDIA_TYPES.values())
    assert set(MEDIA_TYPES) == {"nc", "csv", "mat", "xlsx", "parquet", "toml", "png", "svg", "xml"}
