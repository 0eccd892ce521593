"""What a batch in space can be handed over as: dataset, table, and files for Excel, netCDF and MATLAB."""

import csv
import json

import numpy as np
import pytest

import rocking as rk
from rocking import conventions
from rocking.dynamics.space import SpatialBody, SpatialStart, fast_engine
from rocking.dynamics.space.batch import batch_in_space
from rocking.dynamics.space.fast_engine import FLOATS, WHOLES
from rocking.errors import InvalidValueError

pytestmark = pytest.mark.skipif(not fast_engine.available(), reason="the batch engine was not built")

BOX = SpatialBody.box(0.5, 0.6, 2.0)
PULSE = rk.pulses.sine(amplitude=4.0, period=0.8)


@pytest.fixture(scope="module")
def batch():
    """Two bodies, two scales, two laws, two starts; the second body is none."""
    loose = type("Loose", (), {"mass": 1.0, "centre": (2.0, 0.0, 1.0), "inertia": np.eye(3), "base": BOX.base})()
    starts = [SpatialStart(), SpatialStart(0.05, 0.3)]
    return batch_in_space([BOX, loose], (PULSE, PULSE), ["housner-3d", 0.9], scales=[0.5, 2.5], start=starts)


def _row(batch, number):
    return tuple(int(i) for i in np.unravel_index(number, batch.shape))


def test_a_table_has_one_row_a_history_with_its_labels(batch):
    """Row 5 of the table is the history that the arrays hold at its place; units are in the headings."""
    frame = batch.to_dataframe()
    assert len(frame) == len(batch) == 16
    body, motion, scale, law, start = _row(batch, 5)
    row = frame.iloc[5]
    assert (row["body [-]"], row["motion [-]"], row["start [-]"]) == (body, motion, start)
    assert row["scale [-]"] == (0.5, 2.5)[scale]
    assert row["restitution"] == ("housner-3d", "0.9")[law]
    assert row["peak_tilt [rad]"] == batch.peak_tilt[body, motion, scale, law, start]
    # negative control: the same at the smaller scale differs
    assert frame.iloc[1]["peak_tilt [rad]"] != row["peak_tilt [rad]"]


def test_a_csv_keeps_every_digit(batch, tmp_path):
    """Numbers read back from the file are the same bits, NaN where there is no result."""
    with batch.to_csv(tmp_path / "batch.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    read = np.array([float(row["peak_tilt [rad]"]) for row in rows])
    np.testing.assert_array_equal(read, batch.values["peak_tilt"])
    assert np.isnan(read[8:]).all()
    names = {name.partition(" [")[0] for name in rows[0]} - {"outcome_meaning", "status_meaning"}
    assert names == {"body", "motion", "start", "motion_name", "restitution", "scale", "overturned", *FLOATS, *WHOLES}


def test_a_netcdf_file_keeps_axes_units_and_provenance(batch, tmp_path):
    """The five axes, the arrays, their units, and of what all was computed come back."""
    import xarray

    with xarray.open_dataset(batch.to_netcdf(tmp_path / "batch.nc"), engine="h5netcdf") as data:
        assert data["peak_tilt"].dims == ("body", "motion", "scale", "restitution", "start")
        np.testing.assert_array_equal(data["peak_tilt"].values, batch.peak_tilt)
        assert data["lost"].attrs["units"] == "J"
        assert list(data["restitution"].values) == ["housner-3d", "0.9"]
        told = data.attrs
    assert told["software"] == f"rocking {rk.__version__}"
    assert told["setting_gravity"] == conventions.g
    assert json.loads(told["bodies"])[0]["mass_kg"] == BOX.mass
    assert json.loads(told["bodies"])[1] is None
    assert "1" in json.loads(told["refused"])
    assert json.loads(told["starts"])[1][:2] == [0.05, 0.3]


def test_a_matlab_file_has_columns_and_units(batch, tmp_path):
    """The structure has every column, its unit, and the provenance as JSON."""
    from scipy.io import loadmat

    made = loadmat(batch.to_mat(tmp_path / "batch.mat"), simplify_cells=True)["rocking"]
    np.testing.assert_array_equal(made["peak_tilt"], batch.values["peak_tilt"])
    np.testing.assert_array_equal(made["scale"], np.tile(np.repeat([0.5, 2.5], 4), 2))
    assert made["units"]["direction"] == "rad"
    assert json.loads(made["provenance"])["bodies_sha256"] == batch.provenance["bodies_sha256"]


def test_another_body_has_another_digest(batch):
    """The digest stands for the bodies: the same again, another with a millimetre more."""
    same = batch_in_space([BOX], PULSE).provenance["bodies_sha256"]
    assert same == batch_in_space([BOX], PULSE, scales=2.0).provenance["bodies_sha256"]
    other = batch_in_space([SpatialBody.box(0.501, 0.6, 2.0)], PULSE).provenance["bodies_sha256"]
    assert same != other


def test_a_folder_that_is_not_there_is_named(batch, tmp_path):
    """Writing into a missing folder is refused in words."""
    with pytest.raises(InvalidValueError, match="no folder"):
        batch.to_netcdf(tmp_path / "none" / "batch.nc")
