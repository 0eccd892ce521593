"""Files of labelled results: netCDF, or tables with one row per cell."""

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from rocking.errors import InvalidValueError
from rocking.quantities import QUANTITIES
from rocking.tables.arrays import to_mat, to_netcdf
from rocking.tables.rows import to_csv, to_excel
from rocking.tables.table import Column, Table, target_of

if TYPE_CHECKING:
    import xarray as xr

ENDINGS = (".nc", ".csv", ".xlsx", ".mat")


def save(dataset: "xr.Dataset", path: str | PathLike[str]) -> Path:
    """Save labelled results, such as those of `simulate_many`, in the format of the extension, with units.

    A netCDF file contains the arrays with their dimensions, units and provenance. The other files contain a table with
    one row per cell. The last dimension changes fastest. The header of a CSV or Excel file contains the units. A MATLAB
    file contains one structure, `rocking`, with the columns, and `rocking.units`.

    Parameters
    ----------
    dataset : xarray.Dataset
        Results over dimensions, such as those of `simulate_many`, `overturning_map` and `rocking_spectrum`.
    path : path-like
        File: .nc, .csv, .xlsx or .mat.

    Returns
    -------
    pathlib.Path
        The written file.

    Raises
    ------
    InvalidValueError
        If the extension is none of these, the folder does not exist, no variable has all dimensions (except in netCDF
        files), or the table is too large for the format.
    MissingExtraError
        If the module for the format is not installed.

    Examples
    --------
    >>> import rocking as rk, tempfile
    >>> from pathlib import Path
    >>> from rocking.tables import save
    >>> block, pulse = rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=1.0, period=0.5)
    >>> batch = rk.simulate_many(block, pulse, "housner", scale=[4.0, 8.0])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(batch, Path(folder) / "batch.csv").read_text().splitlines()[0].split(",")[:3]
    ['body', 'motion', 'scale [1]']
    """
    target = target_of(path)
    ending = target.suffix.lower()
    if ending not in ENDINGS:
        raise InvalidValueError("Unsupported file. Use {extensions}.", extensions=", ".join(ENDINGS))
    if ending == ".nc":
        to_netcdf(dataset, target)
    elif ending == ".xlsx":
        to_excel([("cells", _cells(dataset))], target, dataset.attrs, others=".nc or .csv")
    elif ending == ".mat":
        to_mat(_cells(dataset), target)
    else:
        to_csv(_cells(dataset), target, blank=False)
    return target


def _cells(dataset: "xr.Dataset") -> Table:
    """Return a dataset as a table with one row per cell."""
    dataset = dataset.drop_dims("point", errors="ignore")  # the table does not contain the points of a refined map
    over = max(dataset.data_vars.values(), key=lambda variable: variable.ndim)
    if missing := set(map(str, dataset.sizes)) - set(map(str, over.dims)):
        raise InvalidValueError(
            "no variable has all dimensions: {name} is without {dims}", name=over.name, dims=", ".join(sorted(missing)),
            hint="use .nc",
        )  # fmt: skip
    names = (*over.dims, *dataset.data_vars, *(name for name in dataset.coords if name not in over.dims))
    rows = {name: dataset[name].broadcast_like(over).transpose(*over.dims).values.ravel() for name in names}
    codes = {name: QUANTITIES[name].codes if name in QUANTITIES else {} for name in map(str, names)}
    # names of restitutions have no unit
    units = {name: dataset[name].attrs.get("units", "") for name in names}
    columns = {str(name): Column(row, units[name], codes=codes[str(name)]) for name, row in rows.items()}
    return Table("row", columns, provenance=dataset.attrs, no_unit="1")
