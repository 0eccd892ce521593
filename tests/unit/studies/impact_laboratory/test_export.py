"""Studies of the laboratory as tables and files: nothing is lost on the way."""

import csv
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from rocking.errors import InvalidValueError
from rocking.restitution.bed import fast
from rocking.studies.impact_laboratory import (
    Laboratory,
    LaboratoryStudy,
    large_bodies_study,
    profile_study,
    slenderness_study,
    velocity_study,
)

pytestmark = pytest.mark.skipif(not fast.available(), reason="the bed's fast engine was not built")

STUDIES = {
    "slenderness": lambda: slenderness_study([2.0, 4.0], Laboratory(points=5)),
    "release": lambda: velocity_study([0.2, 0.6], Laboratory(points=5)),
    "amplitude": lambda: profile_study("concave", [0.0, 1e-4], Laboratory(points=5)),
    "width": lambda: large_bodies_study([0.1, 1.0], laboratory=Laboratory(points=5)),
}


@pytest.mark.parametrize("varied", STUDIES)
def test_files_hold_the_same_numbers(varied: str, tmp_path: Path) -> None:
    """CSV and netCDF read back give the bits of the dataset, with units in headings and attributes."""
    found: LaboratoryStudy = STUDIES[varied]()
    with found.to_csv(tmp_path / "study.csv").open(newline="", encoding="utf-8") as file:
        heads, *rows = list(csv.reader(file))
    with xr.open_dataset(found.to_netcdf(tmp_path / "study.nc"), engine="h5netcdf") as back:
        assert back.identical(found.dataset)
        assert back.attrs["software"].startswith("rocking ")
        assert "points=5" in back.attrs["laboratory"]
        assert all(back[name].attrs["units"] for name in back.variables)
    assert heads[0].startswith(f"{varied} [")
    frame = found.to_dataframe()
    assert list(frame.columns) == heads
    assert frame.attrs == found.dataset.attrs
    for at, head in enumerate(heads):
        name = head.split(" [")[0]
        np.testing.assert_array_equal([float(row[at]) for row in rows], found[name].values)
        np.testing.assert_array_equal(frame[head].to_numpy(), found[name].values)


def test_units_of_a_study() -> None:
    """Columns name their units, a number without one says so."""
    heads = list(STUDIES["slenderness"]().to_dataframe().columns)
    assert {"coefficient [-]", "landing_velocity [rad/s]", "peak_force [N]", "bed_loss [J]"} <= set(heads)


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    """A path that cannot be written is refused, not created."""
    with pytest.raises(InvalidValueError, match="no folder"):
        STUDIES["slenderness"]().to_csv(tmp_path / "nowhere" / "study.csv")
