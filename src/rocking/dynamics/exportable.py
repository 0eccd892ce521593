"""What every response can be handed over as: a dataset, a table, and files for Excel, MATLAB and netCDF."""

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd
    import xarray as xr

    from rocking.dynamics.exported import Exported


class Exportable(ABC):
    """A response whose samples, impacts and provenance can leave Python."""

    @abstractmethod
    def exported(self) -> "Exported":
        """Return what the files of this response hold.

        Returns
        -------
        Exported
            Samples, tables and provenance, with units.
        """

    def to_xarray(self) -> "xr.Dataset":
        """Return the response as a labelled dataset with units and provenance.

        Returns
        -------
        xarray.Dataset
            Samples over `time`, impacts over `impact`, and intervals over `interval` where the response has them.
        """
        from rocking.dynamics.export import to_xarray

        return to_xarray(self.exported())

    def to_dataframe(self) -> "pd.DataFrame":
        """Return the samples as a table.

        Returns
        -------
        pandas.DataFrame
            One row a sample, units in the column names.
        """
        from rocking.dynamics.export import to_dataframe

        return to_dataframe(self.exported())

    def to_csv(self, path: "str | Path") -> "Path":
        """Write the samples as comma-separated values.

        Parameters
        ----------
        path : str or Path
            The file.

        Returns
        -------
        Path
            The file.
        """
        from rocking.dynamics.export import to_csv

        return to_csv(self.exported(), path)

    def to_mat(self, path: "str | Path") -> "Path":
        """Write a file that MATLAB loads.

        Parameters
        ----------
        path : str or Path
            The file.

        Returns
        -------
        Path
            The file.
        """
        from rocking.dynamics.export import to_mat

        return to_mat(self.exported(), path)

    def to_netcdf(self, path: "str | Path") -> "Path":
        """Write a netCDF file, which xarray and MATLAB open.

        Parameters
        ----------
        path : str or Path
            The file.

        Returns
        -------
        Path
            The file.
        """
        from rocking.dynamics.export import to_netcdf

        return to_netcdf(self.exported(), path)
