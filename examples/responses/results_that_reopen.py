"""Results in other programs
=========================

A response is exported to Excel, MATLAB and xarray with units and provenance. For users of several programs.
"""

import numpy as np
import pandas as pd
import xarray as xr
from scipy.io import loadmat

import rocking as rk
from rocking.plots import journal_style, new_figure, write

# %%
# A column under one wavelet.

column = rk.Block(width=0.8, height=4.0, density=2500.0)
response = rk.simulate(column, rk.pulses.ricker(3.0, period=1.2), restitution="horizontal-momentum")

# %%
# CSV for spreadsheets and pandas: comments in the header contain the provenance, and each column contains its unit.

table = pd.read_csv(response.to_csv("column.csv"), comment="#")
print(*table.columns, sep="\n")
assert len(table) == response.time.size

# %%
# MATLAB, and netCDF for xarray: all digits are preserved.

matlab = loadmat(response.to_mat("column.mat"), simplify_cells=True)["rocking"]
with xr.open_dataset(response.to_netcdf("column.nc"), engine="h5netcdf") as reopened:
    print(reopened.attrs["software"], "|", reopened.attrs["outcome"], "|", reopened.rotation.attrs["units"])
    assert (reopened.rotation.values == response.rotation).all()
assert (np.ravel(matlab["rotation"]) == response.rotation).all()

# %%
# Plotted from the file.

with journal_style():
    figure, axes = new_figure(6.0, 3.2, rows=2, sharex=True)
    for panel, name in zip(axes, ("rotation [rad]", "vertical_force [N]"), strict=True):
        panel.plot(table["time [s]"], table[name])
        panel.set_ylabel(name.replace("_", " "))
    axes[-1].set_xlabel("time [s]")
write(figure, "results_that_reopen.png")
