"""What every response can be handed over as: a dataset, a table, and files for Excel, MATLAB and netCDF."""

from abc import ABC, abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.lazy import presenter

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from rocking.tables import Table


def motion_provenance(motion: Any) -> str:
    """Return where a motion comes from.

    >>> motion_provenance(None)
    'ground at rest'
    """
    return "ground at rest" if motion is None else "; ".join(getattr(motion, "provenance", ())) or repr(motion)


class Exportable(ABC):
    """A response whose samples, impacts and provenance can leave Python."""

    @abstractmethod
    def exported(self) -> "Table":
        """Return what the files of this response hold.

        Returns
        -------
        Table
            Samples, with tables of impacts and the like beside them, units and provenance.
        """

    def to_xarray(self) -> "xr.Dataset":
        """Return the response as a labelled dataset with units and provenance.

        Returns
        -------
        xarray.Dataset
            Samples over `time`, impacts over `impact`, and intervals over `interval` where the response has them.
        """
        from rocking.tables import to_dataset

        return to_dataset(self.exported())

    def to_dataframe(self) -> "pd.DataFrame":
        """Return the samples as a table.

        Returns
        -------
        pandas.DataFrame
            One row a sample, units in the column names.
        """
        from rocking.tables import to_dataframe

        return to_dataframe(self.exported())

    def to_csv(self, path: str | Path) -> Path:
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
        from rocking.tables import target_of, to_csv

        return to_csv(self.exported(), target_of(path), blank=False)

    def to_mat(self, path: str | Path) -> Path:
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
        from rocking.tables import target_of, to_mat

        return to_mat(self.exported(), target_of(path))

    def to_netcdf(self, path: str | Path) -> Path:
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
        from rocking.tables import target_of, to_netcdf

        return to_netcdf(self.to_xarray(), target_of(path))


class Drawable(Exportable):
    """A response that can be drawn."""

    def plot(self, path: str | Path | None = None, **options: Any) -> "Figure":
        """Draw the response.

        Parameters
        ----------
        path : str or Path, optional
            Where to write the picture, too: .png, .svg or .pdf.
        **options
            Of the picture of this kind of response in `rocking.plots`: `friction` where it rocks alone.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        RockingError
            If the ending of the path is another.
        """
        figure: Figure = presenter(f"picture of {type(self).__name__}")(self, **options)
        if path is not None:
            presenter("writer of pictures")(figure, Path(path))
        return figure
