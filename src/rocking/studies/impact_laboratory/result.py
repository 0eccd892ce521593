"""What a study of the laboratory found, with the files it goes into."""

from typing import TYPE_CHECKING, Any

from rocking.quantities import Quantity
from rocking.restitution.bed import fast
from rocking.tables import Column, Table, target_of, to_csv, to_dataframe, to_netcdf
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd
    import xarray as xr

# long names of what studies find; a name that is not here says it all
_WORDS = {
    "coefficient": "theta_dot after over theta_dot before, by the next peak",
    "coefficient_by_energy": "the same by the energy at the end, hops counted",
    "hardness": "landing speed of the new foot times sqrt(k / m) over gravity",
    "landing_velocity": "theta_dot of rigid rocking as it reaches the base",
    "peak_force": "greatest force of the bed",
    "bed_loss": "energy lost in compression",
    "friction_loss": "energy lost in friction",
    "contacts": "how often the body came into contact: hops are one less",
    "audit": "energy at the end plus losses minus energy at the start, over the energy before the impact",
}


_ABOUT = ("units", "long_name")


class LaboratoryStudy:
    """A study of the impact laboratory: an `xarray.Dataset` over what was varied, that also goes into files.

    Every attribute and index of the dataset is one of the study.

    >>> from rocking.studies.impact_laboratory.dependence import slenderness_study
    >>> found = slenderness_study([2.0, 4.0])
    >>> found.to_dataframe()["coefficient [-]"].round(2).tolist()
    [0.84, 0.96]
    """

    def __init__(self, dataset: "xr.Dataset") -> None:
        self.dataset = dataset

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the dataset."""
        if name.startswith("__") or name == "dataset":
            raise AttributeError(name)
        return getattr(self.dataset, name)

    def __getitem__(self, key: Any) -> Any:
        """Return a variable of the dataset."""
        return self.dataset[key]

    def __repr__(self) -> str:
        """Return the dataset in words."""
        return repr(self.dataset)

    @property
    def exported(self) -> Table:
        """What files hold: the varied quantity first, then every result, with units; and the provenance."""
        names = [*self.dataset.coords, *self.dataset.data_vars]
        samples = {
            str(name): Column(self.dataset[name].values, *(self.dataset[name].attrs.get(a, "") for a in _ABOUT))
            for name in names
        }
        return Table("value", samples, dict(self.dataset.attrs), no_unit="-")

    def to_dataframe(self) -> "pd.DataFrame":
        """Return the study as a table.

        Returns A row a value; columns such as ``peak_force [N]``; the provenance in its `attrs`.
        """
        frame = to_dataframe(self.exported)
        frame.attrs.update(self.dataset.attrs)
        return frame

    def to_csv(self, path: "str | Path") -> "Path":
        """Write the study as comma-separated values, all digits kept; headings as in `to_dataframe`."""
        return to_csv(self.exported, target_of(path), blank=False)

    def to_netcdf(self, path: "str | Path") -> "Path":
        """Write the study as netCDF 4, with units and provenance, which xarray and MATLAB open."""
        return to_netcdf(self.dataset, target_of(path))


def about(name: str, unit: str) -> dict[str, str]:
    """Return unit and meaning of a result."""
    return Quantity(name, unit, _WORDS.get(name, "")).attributes


def provenance(study: str, laboratory: object) -> dict[str, str]:
    """Return what a study was computed from, and with what."""
    engine = "contact bed, fast" if fast.available() else "contact bed, reference"
    return {"software": SOFTWARE, "engine": engine, "study": study, "laboratory": repr(laboratory)}
