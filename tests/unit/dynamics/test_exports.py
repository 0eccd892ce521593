"""What responses hand over: datasets, tables and files, of every mechanics."""

import json
import math
import re
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import loadmat

import rocking as rk
from rocking.dynamics import SpatialStart
from rocking.dynamics.plane_frictional import Start
from rocking.errors import InvalidValueError, MissingExtraError
from rocking.outcome import ContactMode, Regime
from rocking.quantities import QUANTITIES

pytestmark = pytest.mark.slow

BLOCK = rk.Block(width=0.5, height=2.0)
FORMULA = "=cmd|' /C calc'!A0"
RECORD = rk.GroundMotion(
    4.0 * np.sin(0.5 * np.arange(91)), 0.05, name=FORMULA,
    metadata={"station": "=1+1"}, provenance=("Tōhoku, read by hand", "cut"),
)  # fmt: skip
SHAKEN_UP = rk.GroundMotion(RECORD.acceleration, 0.05, vertical=2.0 * np.cos(0.3 * np.arange(91)))
with warnings.catch_warnings():  # 20 g: it would fly
    warnings.simplefilter("ignore")
    WITHIN = rk.simulate(BLOCK, rk.GroundMotion(np.array([-200.0] * 3 + [0.0]), 1.0), "ked")
RESPONSES = {
    "rocked": rk.simulate(BLOCK, RECORD, "housner", duration=4.5, stream=7),
    "free": rk.free_rocking(BLOCK, -0.1, {"left": 0.8, "right": 0.9}),
    "no uplift": rk.simulate(BLOCK, rk.pulses.sine(1.0, 0.5), "ked", duration=1.0),
    "overturned": rk.simulate(BLOCK, rk.pulses.sine(9.0, 1.0), "ked", scale=-1.0),
    "beyond the top": rk.free_rocking(BLOCK, 0.3, "ked"),
    "within the first step": WITHIN,
    "vertical": rk.simulate(BLOCK, SHAKEN_UP, "ked", scale=-0.5),
    "stopped": rk.free_rocking(BLOCK, 0.1, 0.95, most_events=4, duration=3.0, linear=True),
}
UNITS = {
    "time": "s", "rotation": "rad", "angular_velocity": "rad/s", "ground_acceleration": "m/s2", "kinetic_energy": "J",
    "potential_energy": "J", "work_of_ground": "J", "energy_lost": "J", "horizontal_force": "N", "vertical_force": "N",
}  # fmt: skip
UP = "vertical_ground_acceleration"
every = pytest.mark.parametrize("kind", RESPONSES)


def columns(response: Any) -> dict[str, np.ndarray]:
    """The samples that leave Python, by name."""
    return {name: column.values for name, column in response.exported().columns.items()}


def units(kind: str) -> dict[str, str]:
    """Units by column; the vertical acceleration comes after the horizontal one, where there is one."""
    if kind != "vertical":
        return UNITS
    names = list(UNITS)
    return {name: UNITS.get(name, "m/s2") for name in [*names[:4], UP, *names[4:]]}


@every
def test_columns(kind: str) -> None:
    """The columns are the response's own arrays under their names, all of one length and finite."""
    response = RESPONSES[kind]
    found = columns(response)
    up = [] if response.vertical_ground_acceleration is None else [response.vertical_ground_acceleration]
    expected = (
        response.time, response.rotation, response.angular_velocity, response.ground_acceleration, *up,
        response.energy.kinetic, response.energy.potential, response.energy.work, response.energy.lost,
        response.contact.horizontal, response.contact.vertical,
    )  # fmt: skip
    assert list(found) == list(units(kind))
    for values, wanted in zip(found.values(), expected, strict=True):
        np.testing.assert_array_equal(values, wanted[: response.time.size])
        assert values.shape == response.time.shape
        assert np.isfinite(values).all()


@every
def test_csv_holds_no_formulas(kind: str, tmp_path: Path) -> None:
    """No cell could be taken for a formula by a spreadsheet: headings are words, all else is a plain number."""
    text = RESPONSES[kind].to_csv(str(tmp_path / "out.csv")).read_text(encoding="utf-8")
    assert FORMULA not in text
    heading, *lines = text.splitlines()
    assert all(cell[0].isalpha() for cell in heading.split(","))
    assert not set("".join(lines)) - set("0123456789.,-e+")
    assert all(math.isfinite(float(cell)) for line in lines for cell in line.split(","))


def test_vertical_acceleration_is_the_scaled_record() -> None:
    """The vertical column is the vertical part of the record times the scale, and zero once that is over."""
    found = columns(RESPONSES["vertical"])[UP]
    assert SHAKEN_UP.vertical is not None
    np.testing.assert_allclose(found[:91], -0.5 * SHAKEN_UP.vertical, rtol=0.0, atol=1e-14)
    assert found.size > 91
    assert not found[91:].any()
    assert UP not in columns(RESPONSES["rocked"])


def test_provenance() -> None:
    """What was computed from what: version, engine, body, coefficients, motion with its history, every setting."""
    found = RESPONSES["rocked"].exported().provenance
    housner = 1.0 - 1.5 * math.sin(math.atan(0.25)) ** 2
    assert found["software"] == f"rocking {rk.__version__}"
    assert (found["body"], found["mass"]) == ("Block", pytest.approx(2400.0))
    assert found["coefficient_left"] == found["coefficient_right"] == pytest.approx(housner, rel=1e-14, abs=0.0)
    assert found["slenderness_angle_left"] == pytest.approx(math.atan(0.25), rel=1e-15, abs=0.0)
    assert (found["motion"], found["motion_provenance"]) == (FORMULA, "Tōhoku, read by hand; cut")
    assert (found["random_stream"], found["scale"], found["setting_gravity"]) == (7, 1.0, 9.80665)
    assert (found["outcome"], found["status"]) == ("ROCKED", "GOOD")
    assert found["summary"] == RESPONSES["rocked"].summary
    free = RESPONSES["free"].exported().provenance
    assert (free["motion"], free["restitution"]) == ("none: free rocking", "left 0.8, right 0.9")
    assert free["motion_provenance"] == "ground at rest"
    pulse = RESPONSES["overturned"].exported().provenance
    assert "Sinusoids" in pulse["motion_provenance"]
    assert pulse["scale"] == -1.0
    assert RESPONSES["stopped"].exported().provenance["setting_linear"] is True
    json.dumps(found, allow_nan=False)


@pytest.mark.parametrize(
    ("missing", "write", "what", "wanted"),
    [
        ("xarray", "to_xarray", "a labelled dataset", "xarray"),
        ("pandas", "to_dataframe", "a table", "pandas"),
        ("h5netcdf", "to_netcdf", "netCDF", '"rocking[netcdf]"'),
        ("h5py", "to_netcdf", "netCDF", '"rocking[netcdf]"'),
    ],
)
def test_missing_packages(
    missing: str, write: str, what: str, wanted: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a package the error names it and how to get it; files that do not need it are written."""
    monkeypatch.setitem(sys.modules, missing, None)
    arguments = [tmp_path / "out"] if write == "to_netcdf" else []
    with pytest.raises(MissingExtraError, match=re.escape(f"{what} needs {missing}: pip install {wanted}")):
        getattr(RESPONSES["free"], write)(*arguments)
    assert not list(tmp_path.iterdir())
    assert RESPONSES["free"].to_csv(tmp_path / "out.csv").stat().st_size > 1000
    assert RESPONSES["free"].to_mat(tmp_path / "out.mat").stat().st_size > 1000


def test_many_needs_xarray(monkeypatch: pytest.MonkeyPatch) -> None:
    """So does `simulate_many`, before it computes anything."""
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(MissingExtraError, match="simulate_many needs xarray"):
        rk.simulate_many(BLOCK, RECORD)


BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
SQUAT = rk.Block(width=1.2, height=2.0)
BOX = rk.dynamics.SpatialBody.box(0.5, 0.5, 2.0)
WAVE = rk.GroundMotion(3.5 * np.sin(0.4 * np.arange(60)), 0.03, name="wave", provenance=("made by hand",))
EVERY = RESPONSES | {
    "pure": rk.simulate(BODY, WAVE, "housner"),
    "pure, at rest": rk.simulate(BODY, rk.pulses.sine(1.0, 0.5), "ked"),
    "slide and rock": rk.simulate(SQUAT, rk.pulses.sine(9.0, 0.9), None, friction=0.62),
    "slide": rk.simulate(SQUAT, WAVE, None, friction=0.2),
    "struck": rk.free_rocking(
        SQUAT, restitution=None, friction=2.5, start=Start(rotation=0.1, horizontal_velocity=1.0)
    ),
    "rest": rk.simulate(SQUAT, WAVE, None, friction=1.0, scale=0.1),
    "corner": rk.free_rocking(BOX, restitution="housner", start=SpatialStart(0.1, 0.7), duration=1.0),
    "space, at rest": rk.simulate(BOX, WAVE, "housner", scale=0.1, duration=1.0),
    "space, overturned": rk.simulate(BOX, {"x": WAVE, "y": WAVE}, "housner", scale=4.0),
}
STRUCTS = {"impact": "impacts", "interval": "intervals"}
every_response = pytest.mark.parametrize("kind", EVERY)


def equal(found, wanted):
    """Same values to the last bit, numbers or words."""
    found, wanted = np.atleast_1d(np.asarray(found)), np.asarray(wanted)
    if wanted.dtype.kind in "US":
        return [str(word) for word in found.ravel()] == wanted.tolist()
    return found.ravel().astype(np.float64).tobytes() == wanted.astype(np.float64).tobytes()


@every_response
def test_every_sample_has_a_unit_and_is_finite(kind):
    """Every sample is a finite number under a name with unit and meaning, all of one length."""
    content = EVERY[kind].exported()
    count = EVERY[kind].time.size
    assert next(iter(content.columns)) == "time"
    for one in content.columns.values():
        assert one.unit
        assert one.attributes["long_name"]
        assert one.values.shape == (count,)
        assert np.isfinite(one.values).all()
    for table in content.related.values():
        assert len({one.values.size for one in table.columns.values()}) == 1
        assert all(one.unit or one.values.dtype.kind == "U" for one in table.columns.values())
    assert json.loads(json.dumps(content.provenance, allow_nan=False))["software"] == f"rocking {rk.__version__}"


@every_response
def test_csv_is_read_by_pandas(kind, tmp_path):
    """pandas reads the CSV back to the last bit, under the headings of the data frame."""
    pandas = pytest.importorskip("pandas")
    response = EVERY[kind]
    path = response.to_csv(tmp_path / "out.csv")
    found, frame = pandas.read_csv(path, dtype=str), response.to_dataframe()
    assert list(found.columns) == list(frame.columns)
    numbers = [heading for heading in found.columns if not heading.endswith("_meaning")]
    assert all(heading.endswith("]") for heading in numbers)
    for heading, (name, one) in zip(numbers, response.exported().columns.items(), strict=True):
        assert heading == f"{name} [{one.unit}]".replace("[1]", "[-]")
        assert equal([float(cell) for cell in found[heading]], one.values)


@every_response
def test_mat_is_read_by_scipy(kind, tmp_path):
    """scipy reads samples, tables, units and provenance back from one structure, numbers and words."""
    content = EVERY[kind].exported()
    found = loadmat(EVERY[kind].to_mat(tmp_path / "out.mat"), simplify_cells=True)["rocking"]
    for name, one in content.columns.items():
        assert equal(found[name], one.values)
        assert found["units"][name] == one.unit
    for row, table in content.related.items():
        for name, one in table.columns.items():
            assert equal(found[STRUCTS[row]][name], one.values)
            assert not one.unit or found[f"{row}_units"][name] == one.unit
    assert json.loads(found["provenance"]) == content.provenance


@every_response
def test_netcdf_is_read_by_xarray(kind, tmp_path):
    """xarray reads the file back as the dataset: dimensions, values, units, provenance."""
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    content = EVERY[kind].exported()
    path = EVERY[kind].to_netcdf(tmp_path / "out.nc")
    with xarray.open_dataset(path, engine="h5netcdf", decode_timedelta=False) as file:
        opened = file.load()
    for found in (opened, EVERY[kind].to_xarray()):
        for name, one in content.columns.items():
            assert found[name].dims == ("time",)
            assert equal(found[name].to_numpy(), one.values)
            assert (found[name].attrs["units"], found[name].attrs["long_name"]) == (
                one.unit,
                one.attributes["long_name"],
            )
        for row, table in content.related.items():
            for name, one in table.columns.items():
                assert found[f"{row}_{name}"].dims == (row,)
                assert equal(found[f"{row}_{name}"].to_numpy(), one.values)
        for name, value in content.provenance.items():
            assert np.array_equal(found.attrs[name], value), name


def test_tables_are_the_response():
    """Impacts and intervals are those of the response, row by row."""
    rocked, sliding, corner = EVERY["rocked"], EVERY["slide and rock"], EVERY["corner"]
    impacts = rocked.exported().related["impact"].columns
    foot = [{"right": 1, "left": -1}[foot] for foot in rocked.impacts["foot"].tolist()]
    numbers = ("time", "velocity_before", "velocity_after", "coefficient")
    assert list(impacts) == [*numbers, "foot"]
    assert {1, -1} == set(foot)
    assert impacts["foot"].values.tolist() == foot
    assert all(impacts[name].values.tolist() == rocked.impacts[name].tolist() for name in numbers)
    tables = sliding.exported().related
    assert tables["impact"].columns["energy_lost"].values.tolist() == sliding.impacts["energy_lost"].tolist()
    assert tables["impact"].columns["slips"].values.astype(bool).tolist() == sliding.impacts["slips"].tolist()
    regimes = [Regime[name].code for name in sliding.regimes["regime"].tolist()]
    assert tables["interval"].columns["regime"].values.tolist() == regimes
    assert {Regime.SLIDE.code, Regime.SLIDE_ROCK.code} & set(regimes)
    tables = corner.exported().related
    rows = zip(*(one.values.tolist() for one in tables["interval"].columns.values()), strict=True)
    spelt = [(a, b, c.code, "-".join(map(str, points))) for a, b, c, points in corner.intervals]
    assert list(rows) == spelt
    assert ContactMode.VERTEX.code in tables["interval"].columns["contact"].values
    assert corner.exported().columns["tilt"].values.tolist() == corner.tilt.tolist()
    assert sliding.exported().columns["rotation"].values.tolist() == sliding.rotation.tolist()
    assert set(sliding.to_dataframe()["regime_meaning"]) <= set(QUANTITIES["regime"].codes.values())
    assert (sliding.to_xarray().attrs["friction"], corner.to_xarray().attrs["restitution"]) == (0.62, "housner-3d")
    assert EVERY["struck"].exported().related["impact"].columns["time"].values[0] == 0.0


def test_direction_is_told_only_where_it_overturned():
    """A number that does not exist is left out of the provenance: no NaN is written as if it were one."""
    fell, stood = EVERY["space, overturned"], EVERY["corner"]
    assert fell.exported().provenance["direction"] == fell.overturning_direction
    assert math.isnan(stood.overturning_direction)
    assert "direction" not in stood.exported().provenance


def test_rounded_digits_are_seen():
    """Negative control: the same time axis written with 15 digits in place of all is told apart by the check."""
    time = EVERY["corner"].time
    assert equal(time, time)
    assert not equal([float(f"{value:.15g}") for value in time], time)


@pytest.mark.parametrize("kind", ["pure", "slide", "corner"])
@pytest.mark.parametrize("write", ["to_csv", "to_mat", "to_netcdf"])
def test_what_is_no_file_is_refused(kind, write, tmp_path):
    """A folder, a file in none, and what is no path: one sentence, nothing written."""
    pytest.importorskip("h5netcdf")
    folder, none = "the path of a file, got the folder", r"no folder .*none for out"
    refused = [(tmp_path, folder), ("", folder), (tmp_path / "none" / "out", none)]
    refused += [(path, "path must be the path of a file, got") for path in (None, 3, b"out.csv", ["out.csv"])]
    for path, words in refused:
        with pytest.raises(InvalidValueError, match=words):
            getattr(EVERY[kind], write)(path)
    assert not list(tmp_path.iterdir())
