"""The measures of many records in one table, with their spectra in all directions."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rocking.conventions import FloatArray
from rocking.errors import RockingError
from rocking.motions.components import Components, rotd_pga
from rocking.motions.formats.record_set import mapped
from rocking.motions.intensity import MEASURES
from rocking.motions.spectrum import directional_spectra, response_spectrum
from rocking.tables import Column, Table, text_array, to_dataset

if TYPE_CHECKING:
    import xarray as xr

PERIODS = np.geomspace(0.02, 10.0, 30)
"""Periods of spectra where nobody says otherwise [s]."""

SPECTRA = {
    "sa_x": "PSA of x", "sa_y": "PSA of y", "sa_rotd50": "median over all directions of PSA, RotD50",
    "sa_rotd100": "largest over all directions of PSA, RotD100",
}  # fmt: skip
_TOLD = ("event", "station", "date", "format")


@dataclass(frozen=True, eq=False)
class Flatfile:
    """Measures of records, one row a record.

    Parameters
    ----------
    table : Table
        What is known of each record, and its measures: ``_x`` and ``_y`` of its horizontal components, ``_z`` upwards.
    periods : ndarray
        Periods of the spectra [s].
    damping : float
        Their damping ratio [-].
    spectra : dict of str to ndarray
        PSA by name, one row a record; NaN where there is no second component [m/s2].
    left_out : tuple of pairs of str
        Records that could not be measured, and why.
    """

    table: Table
    periods: FloatArray
    damping: float
    spectra: dict[str, FloatArray]
    left_out: tuple[tuple[str, str], ...]

    def flat(self) -> Table:
        """Return all of it as one table, with a column for every spectrum and period.

        Returns
        -------
        Table
            For files with a row a line.
        """
        columns = dict(self.table.columns)
        for name, values in self.spectra.items():
            for k, period in enumerate(self.periods.tolist()):
                columns[f"{name}({period:.4g})"] = Column(values[:, k], "m/s2", f"{SPECTRA[name]} at {period:.4g} s")
        return Table(self.table.row, columns, self.table.provenance)

    def to_xarray(self) -> "xr.Dataset":
        """Return all of it as a labelled dataset.

        Returns
        -------
        xarray.Dataset
            Over ``record``, spectra over ``period`` too, with units.
        """
        found = to_dataset(self.table).assign_coords(period=("period", self.periods, {"units": "s"}))
        for name, values in self.spectra.items():
            found[name] = (("record", "period"), values, {"units": "m/s2", "long_name": SPECTRA[name]})
        return found


def flatfile(
    records: Iterable[Components],
    periods: ArrayLike = PERIODS,
    damping: float = 0.05,
    *,
    workers: int = 1,
    progress: Callable[[int], None] | None = None,
) -> Flatfile:
    """Return all intensity measures of records, and their spectra.

    Parameters
    ----------
    records : RecordSet or iterable of Components
        As `rocking.motions.formats.read_records` returns them.
    periods : array_like
        Periods of the spectra [s].
    damping : float
        Damping ratio of the spectra [-].
    workers : int
        Processes that measure many records.
    progress : callable, optional
        Called with the number of records that were measured since.

    Returns
    -------
    Flatfile
        One row a record.

    Examples
    --------
    >>> from rocking.motions.motion import GroundMotion
    >>> one = GroundMotion([0.0, 3.0, 0.0], 0.01, name="one")
    >>> found = flatfile([Components(one, one, None)], [0.1])
    >>> found.table.columns["pga_rotd100"].values.round(9).tolist(), list(found.spectra)
    ([4.242640687], ['sa_x', 'sa_y', 'sa_rotd50', 'sa_rotd100'])
    """
    periods = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    given = list(records)
    measure = partial(_measured, periods=periods, damping=damping)
    found = list(mapped(measure, given, workers, progress))
    kept = [(record, each) for record, each in zip(given, found, strict=True) if not isinstance(each, str)]
    left_out = tuple((_files(one), each) for one, each in zip(given, found, strict=True) if isinstance(each, str))
    columns: dict[str, Column] = {"record": Column(text_array([name_of(one) for one, _ in kept]), "", "name")}
    listed = sorted({key for one, _ in kept for key in one.metadata if key.startswith("PEER ")})
    for key in (*_TOLD, *listed):
        values = [str(one.metadata.get(key, "")) for one, _ in kept]
        columns[key.replace(" ", "_")] = Column(text_array(values), "", "as the file says it")
    columns["files"] = Column(text_array([_files(one) for one, _ in kept]), "", "record files")
    doubts = (
        dict.fromkeys(part.metadata.get("doubts", "") for part in one.parts if part is not None) for one, _ in kept
    )
    columns["doubts"] = Column(text_array(["; ".join(filter(None, each)) for each in doubts]), "", "what is doubted")
    parts = [next(part for part in one.parts if part is not None) for one, _ in kept]
    columns["time_step"] = Column(np.array([part.time_step for part in parts]), "s", "step between samples")
    columns["samples"] = Column(np.array([len(part) for part in parts], dtype=np.int64), "1", "number of samples")
    for name, (unit, words) in _columns().items():
        columns[name] = Column(np.array([each[0].get(name, np.nan) for _, each in kept]), unit, words)
    empty = np.full(periods.size, np.nan)
    spectra = {
        name: np.array([each[1].get(name, empty) for _, each in kept]).reshape(-1, periods.size) for name in SPECTRA
    }
    told = {"damping_ratio": damping, "periods": "PSA in m/s2"}
    return Flatfile(Table("record", columns, told), periods, damping, spectra, left_out)


def name_of(record: Components) -> str:
    """Return what a record is called: the name of its components, each name once."""
    return ", ".join(dict.fromkeys(part.name for part in record.parts if part is not None))


def _files(record: Components) -> str:
    parts = [part for part in record.parts if part is not None]
    return ", ".join(dict.fromkeys(part.metadata.get("file", part.name) for part in parts))


def _columns() -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the measures by their column."""
    listed = [one for one in MEASURES.values() if one.is_listed and not one.needs_body]
    found = {f"{one.name}_{axis}": (one.unit, f"{one.words}, {axis}") for one in listed for axis in "xyz"}
    for percent, words in ((50, "median over all directions"), (100, "largest over all directions")):
        found[f"pga_rotd{percent}"] = ("m/s2", f"peak ground acceleration, {words}")
    return found


def _measured(
    record: Components, periods: FloatArray, damping: float
) -> tuple[dict[str, float], dict[str, FloatArray]] | str:
    """Return measures and spectra of a record by their names, or why there are none."""
    try:
        found = {}
        for axis, part in zip("xyz", record.parts, strict=True):
            for one in MEASURES.values() if part is not None else ():
                if one.is_listed and not one.needs_body:
                    found[f"{one.name}_{axis}"] = one.of(part)
        if record.x is None or record.y is None:
            only = {"sa_x": record.x, "sa_y": record.y}
            alone = {name: part for name, part in only.items() if part is not None}
            return found, {
                k: response_spectrum(part, periods, damping).pseudo_acceleration for k, part in alone.items()
            }
        found |= {f"pga_rotd{percent}": rotd_pga(record.x, record.y, percent) for percent in (50, 100)}
        every = directional_spectra(record.x, record.y, periods, damping)
        half, full = np.percentile(every, (50.0, 100.0), axis=1)
        return found, {"sa_x": every[:, 0], "sa_y": every[:, 90], "sa_rotd50": half, "sa_rotd100": full}
    except RockingError as error:
        return str(error)
