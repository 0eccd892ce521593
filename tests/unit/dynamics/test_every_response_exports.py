"""All three kinds of response leave Python the same way: read back by other programs they are equal bit by bit."""

import json
import math

import numpy as np
import pytest
from scipy.io import loadmat

import rocking as rk
from rocking.dynamics import SpatialStart
from rocking.dynamics.contact import Start
from rocking.errors import InvalidValueError

BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
SQUAT = rk.Block(width=1.2, height=2.0)
BOX = rk.dynamics.SpatialBody.box(0.5, 0.5, 2.0)
WAVE = rk.GroundMotion(3.5 * np.sin(0.4 * np.arange(60)), 0.03, name="wave", provenance=("made by hand",))
RESPONSES = {
    "pure": rk.simulate(BODY, WAVE, "housner"),
    "pure, at rest": rk.simulate(BODY, rk.pulses.sine(1.0, 0.5), "ked"),
    "slide and rock": rk.simulate(SQUAT, rk.pulses.sine(9.0, 0.9), None, friction=0.62),
    "slide": rk.simulate(SQUAT, WAVE, None, friction=0.2),
    "no force": rk.free_rocking(
        SQUAT, restitution=None, friction=2.5, start=Start(rotation=0.1, horizontal_velocity=1.0)
    ),
    "rest": rk.simulate(SQUAT, WAVE, None, friction=1.0, scale=0.1),
    "corner": rk.free_rocking(BOX, restitution="housner", start=SpatialStart(0.1, 0.7), duration=1.0),
    "space, at rest": rk.simulate(BOX, WAVE, "housner", scale=0.1, duration=1.0),
    "space, overturned": rk.simulate(BOX, {"x": WAVE, "y": WAVE}, "housner", scale=4.0),
}
STRUCTS = {"impact": "impacts", "interval": "intervals"}
every = pytest.mark.parametrize("kind", RESPONSES)


def equal(found, wanted):
    """Same values to the last bit, numbers or words."""
    found, wanted = np.atleast_1d(np.asarray(found)), np.asarray(wanted)
    if wanted.dtype.kind in "US":
        return [str(word) for word in found.ravel()] == wanted.tolist()
    return found.ravel().astype(np.float64).tobytes() == wanted.astype(np.float64).tobytes()


@every
def test_every_sample_has_a_unit_and_is_finite(kind):
    """Every sample is a finite number under a name with unit and meaning, all of one length."""
    content = RESPONSES[kind].exported()
    count = RESPONSES[kind].time.size
    assert next(iter(content.columns)) == "time"
    for one in content.columns.values():
        assert one.unit
        assert one.attributes["long_name"]
        assert one.values.shape == (count,)
        assert np.isfinite(one.values).all()
    for table in content.beside.values():
        assert len({one.values.size for one in table.columns.values()}) == 1
        assert all(one.unit or one.values.dtype.kind == "U" for one in table.columns.values())
    assert json.loads(json.dumps(content.provenance, allow_nan=False))["software"] == f"rocking {rk.__version__}"


@every
def test_csv_is_read_by_pandas(kind, tmp_path):
    """pandas reads the CSV back to the last bit, under the headings of the data frame."""
    pandas = pytest.importorskip("pandas")
    response = RESPONSES[kind]
    path = response.to_csv(tmp_path / "out.csv")
    found, frame = pandas.read_csv(path, dtype=str), response.to_dataframe()
    assert list(found.columns) == list(frame.columns)
    numbers = [heading for heading in found.columns if not heading.endswith("_meaning")]
    assert all(heading.endswith("]") for heading in numbers)
    for heading, one in zip(numbers, response.exported().columns.values(), strict=True):
        assert equal([float(cell) for cell in found[heading]], one.values)


@every
def test_mat_is_read_by_scipy(kind, tmp_path):
    """scipy reads samples, tables, units and provenance back from one structure, numbers and words."""
    content = RESPONSES[kind].exported()
    found = loadmat(RESPONSES[kind].to_mat(tmp_path / "out.mat"), simplify_cells=True)["rocking"]
    for name, one in content.columns.items():
        assert equal(found[name], one.values)
        assert found["units"][name] == one.unit
    for row, table in content.beside.items():
        for name, one in table.columns.items():
            assert equal(found[STRUCTS[row]][name], one.values)
            assert not one.unit or found[f"{row}_units"][name] == one.unit
    assert json.loads(found["provenance"]) == content.provenance


@every
def test_netcdf_is_read_by_xarray(kind, tmp_path):
    """xarray reads the file back as the dataset: dimensions, values, units, provenance."""
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    content = RESPONSES[kind].exported()
    path = RESPONSES[kind].to_netcdf(tmp_path / "out.nc")
    with xarray.open_dataset(path, engine="h5netcdf", decode_timedelta=False) as file:
        opened = file.load()
    for found in (opened, RESPONSES[kind].to_xarray()):
        for name, one in content.columns.items():
            assert found[name].dims == ("time",)
            assert equal(found[name].to_numpy(), one.values)
            assert (found[name].attrs["units"], found[name].attrs["long_name"]) == (
                one.unit,
                one.attributes["long_name"],
            )
        for row, table in content.beside.items():
            for name, one in table.columns.items():
                assert found[f"{row}_{name}"].dims == (row,)
                assert equal(found[f"{row}_{name}"].to_numpy(), one.values)
        for name, value in content.provenance.items():
            assert np.array_equal(found.attrs[name], value), name


def test_tables_are_the_response():
    """Impacts and intervals are those of the response, row by row."""
    sliding, corner = RESPONSES["slide and rock"], RESPONSES["corner"]
    tables = sliding.exported().beside
    assert tables["impact"].columns["lost"].values.tolist() == sliding.impacts["lost"].tolist()
    assert tables["impact"].columns["slips"].values.astype(bool).tolist() == sliding.impacts["slips"].tolist()
    assert tables["interval"].columns["regime"].values.tolist() == sliding.regimes["regime"].tolist()
    assert {"SLIDE", "SLIDE_ROCK"} & set(tables["interval"].columns["regime"].values)
    tables = corner.exported().beside
    rows = zip(*(one.values.tolist() for one in tables["interval"].columns.values()), strict=True)
    spelt = [(a, b, c.name.lower(), "-".join(map(str, points))) for a, b, c, points in corner.intervals]
    assert list(rows) == spelt
    assert "vertex" in tables["interval"].columns["contact"].values
    assert not RESPONSES["no force"].exported().beside["interval"].columns["start"].values.size


def test_direction_is_told_only_where_it_overturned():
    """A number that does not exist is left out of the provenance: no NaN is written as if it were one."""
    fell, stood = RESPONSES["space, overturned"], RESPONSES["corner"]
    assert fell.exported().provenance["overturning_direction_rad"] == fell.overturning_direction
    assert math.isnan(stood.overturning_direction)
    assert "overturning_direction_rad" not in stood.exported().provenance


def test_rounded_digits_are_seen():
    """Negative control: the same time axis written with 15 digits in place of all is told apart by the check."""
    time = RESPONSES["corner"].time
    assert equal(time, time)
    assert not equal([float(f"{value:.15g}") for value in time], time)


@pytest.mark.parametrize("kind", ["pure", "slide", "corner"])
@pytest.mark.parametrize("write", ["to_csv", "to_mat", "to_netcdf"])
def test_what_is_no_file_is_refused(kind, write, tmp_path):
    """A folder, a file in none, and what is no path: one sentence, nothing written."""
    pytest.importorskip("h5netcdf")
    refused = {tmp_path: "got the folder", tmp_path / "none" / "out": "no folder", 3: "path of a file, got 3"}
    for path, words in refused.items():
        with pytest.raises(InvalidValueError, match=words):
            getattr(RESPONSES[kind], write)(path)
    assert not list(tmp_path.iterdir())
