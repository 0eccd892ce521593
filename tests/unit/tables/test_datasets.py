"""Labelled results in files: the same values, with units, in each format."""

import csv

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.tables import save

SCALES = np.array([3.0, 7.6, 9.0])


@pytest.fixture(scope="module")
def batch():
    """Three amplitudes and two restitutions of an asymmetric body."""
    body = rk.Section([rk.Region([(0.0, 0.0), (0.6, 0.0), (0.4, 2.0), (0.0, 2.0)])])
    pulse = rk.pulses.sine(amplitude=1.0, period=0.5)
    return rk.simulate_many(body, pulse, ["ked", "housner"], scale=SCALES)


@pytest.fixture
def rows(batch):
    """Peak rotations in the order of the rows: the last dimension changes fastest."""
    return batch["peak_rotation"].values.ravel()


def test_netcdf_contains_the_dimensions(batch, tmp_path):
    """Xarray opens the same dataset."""
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(save(batch, tmp_path / "batch.nc"), engine="h5netcdf") as opened:
        assert opened["peak_rotation"].dims == batch["peak_rotation"].dims
        assert opened["peak_rotation"].attrs["units"] == "rad"
        np.testing.assert_array_equal(opened["peak_rotation"], batch["peak_rotation"])
        np.testing.assert_array_equal(opened["scale"], SCALES)


def test_csv_has_one_row_per_cell(batch, rows, tmp_path):
    """All digits and the coordinates are in the file; a path as text is allowed."""
    with save(batch, str(tmp_path / "batch.csv")).open(encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    np.testing.assert_array_equal([float(row["peak_rotation [rad]"]) for row in table], rows)
    assert [float(row["scale [1]"]) for row in table] == np.repeat(SCALES, 2).tolist()
    assert [row["restitution"] for row in table] == ["ked", "housner"] * 3


def test_excel_has_the_rows_of_the_csv_file(batch, rows, tmp_path):
    """The header contains the units."""
    openpyxl = pytest.importorskip("openpyxl")
    header, *table = openpyxl.load_workbook(save(batch, tmp_path / "batch.xlsx"))["cells"].iter_rows(values_only=True)
    np.testing.assert_allclose([row[header.index("peak_rotation [rad]")] for row in table], rows, rtol=1e-15)


def test_matlab_has_columns_and_units(batch, rows, tmp_path):
    """One structure has the columns of all cells, with the coordinates."""
    from scipy.io import loadmat

    rocking = loadmat(save(batch, tmp_path / "batch.mat"), simplify_cells=True)["rocking"]
    np.testing.assert_array_equal(rocking["peak_rotation"], rows)
    np.testing.assert_array_equal(rocking["scale"], np.repeat(SCALES, 2))
    assert rocking["units"]["peak_rotation"] == "rad"


@pytest.mark.parametrize("name", ["batch.txt", "batch", "missing/batch.csv"])
def test_other_files_are_refused(batch, tmp_path, name):
    """Nothing is written."""
    with pytest.raises(InvalidValueError):
        save(batch, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_table_needs_a_variable_with_all_dimensions(batch, tmp_path):
    """A variable of another dimension has no cell in the table; a netCDF file contains it."""
    more = batch.assign(other=("number", [1.0, 2.0]))
    with pytest.raises(InvalidValueError, match=r"is without number.*use \.nc"):
        save(more, tmp_path / "batch.csv")
    assert save(more, tmp_path / "batch.nc").exists()
