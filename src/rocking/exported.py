"""Export of results to xarray, pandas, CSV, MATLAB and netCDF."""

from abc import ABC, abstractmethod
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from rocking.tables import Table


class Exported(ABC):
    """A result with a table for files and data frames."""

    _blank: ClassVar[bool] = True  # True: missing values are empty in CSV; False: nan

    @abstractmethod
    def exported(self) -> "Table":
        """Return the table for files and data frames.

        Returns
        -------
        Table
            Columns with units, further tables with other rows, and provenance.
        """

    def to_xarray(self) -> "xr.Dataset":
        """Return the result as a labelled dataset with units and provenance.

        Returns
        -------
        xarray.Dataset
            Dataset with one dimension for the rows of each table.
        """
        from rocking.tables import to_dataset

        return to_dataset(self.exported())

    def to_dataframe(self) -> "pd.DataFrame":
        """Return the rows as a data frame.

        Returns
        -------
        pandas.DataFrame
            Rows, with units in the column names.
        """
        from rocking.tables import to_dataframe

        return to_dataframe(self.exported())

    def to_csv(self, path: str | PathLike[str]) -> Path:
        """Write the rows as comma-separated values.

        Parameters
        ----------
        path : str or path
            Path of the file.

        Returns
        -------
        Path
            Path of the file.
        """
        from rocking.tables import target_of, to_csv

        return to_csv(self.exported(), target_of(path), blank=self._blank)

    def to_mat(self, path: str | PathLike[str]) -> Path:
        """Write a MATLAB file.

        Parameters
        ----------
        path : str or path
            Path of the file.

        Returns
        -------
        Path
            Path of the file.
        """
        from rocking.tables import target_of, to_mat

        return to_mat(self.exported(), target_of(path))

    def to_netcdf(self, path: str | PathLike[str]) -> Path:
        """Write a netCDF file, for xarray and MATLAB.

        Parameters
        ----------
        path : str or path
            Path of the file.

        Returns
        -------
        Path
            Path of the file.
        """
        from rocking.tables import target_of, to_netcdf

        return to_netcdf(self.to_xarray(), target_of(path))
