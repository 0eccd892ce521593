"""Results that reopen
===================

Write a response for spreadsheets, MATLAB and xarray, and read all of it back.
"""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from scipy.io import loadmat

import rocking as rk

column = rk.Block(width=0.8, height=4.0, density=2500.0)
response = rk.simulate(column, rk.pulses.ricker(3.0, period=1.2), restitution="horizontal-momentum")
folder = Path("gallery-output")
folder.mkdir(exist_ok=True)

table = pd.read_csv(response.to_csv(folder / "column.csv"), comment="#")
print(table.columns.tolist())
matlab = loadmat(response.to_mat(folder / "column.mat"), simplify_cells=True)["rocking"]
with xr.open_dataset(response.to_netcdf(folder / "column.nc"), engine="h5netcdf") as reopened:
    print(reopened.attrs["software"], "|", reopened.attrs["outcome"], "|", reopened.rotation.attrs["units"])
    assert (reopened.rotation.values == response.rotation).all()
assert (np.ravel(matlab["rotation"]) == response.rotation).all()
assert len(table) == response.time.size
