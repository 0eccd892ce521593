"""Results on their way out: what can say what its files hold reopens in xarray, pandas, Excel, MATLAB and netCDF."""

from abc import ABC, abstractmethod
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from rocking.tables import Table


class Exported(ABC):
    """A result whose table says what files and frames of it hold."""

    _blank: ClassVar[bool] = True  # whether what is not known is blank in CSV, or nan

    @abstractmethod
    def exported(self) -> "Table":
        """Return what files and frames of it hold.

        Returns
        -------
        Table
            Columns with units, what has other rows beside them, and where it comes from.
        """

    def to_xarray(self) -> "xr.Dataset":
        """Return it as a labelled dataset with units and provenance.

        Returns
        -------
        xarray.Dataset
            Its rows and those beside them each have a dimension of their own.
        """
        from rocking.tables import to_dataset

        return to_dataset(self.exported())

    def to_dataframe(self) -> "pd.DataFrame":
        """Return its rows as a table.

        Returns
        -------
        pandas.DataFrame
            Units in the column names.
        """
        from rocking.tables import to_dataframe

        return to_dataframe(self.exported())

    def to_csv(self, path: str | PathLike[str]) -> Path:
        """Write its rows as comma-separated values.

        Parameters
        ----------
        path : str or path
            The file.

        Returns
        -------
        Path
            The file.
        """
        from rocking.tables import target_of, to_csv

        return to_csv(self.exported(), target_of(path), blank=self._blank)

    def to_mat(self, path: str | PathLike[str]) -> Path:
        """Write a file that MATLAB loads.

        Parameters
        ----------
        path : str or path
            The file.

        Returns
        -------
        Path
            The file.
        """
        from rocking.tables import target_of, to_mat

        return to_mat(self.exported(), target_of(path))

    def to_netcdf(self, path: str | PathLike[str]) -> Path:
        """Write a netCDF file, which xarray and MATLAB open.

        Parameters
        ----------
        path : str or path
            The file.

        Returns
        -------
        Path
            The file.
        """
        from rocking.tables import target_of, to_netcdf

        return to_netcdf(self.to_xarray(), target_of(path))
