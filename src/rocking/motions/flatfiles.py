"""Intensity measures of many records in one table, and spectra over all directions."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rocking.conventions import FloatArray
from rocking.errors import RockingError
from rocking.messages import listed as in_one_line
from rocking.motions.components import Components, rotd_pga
from rocking.motions.formats.record_set import mapped
from rocking.motions.intensity import MEASURES
from rocking.motions.spectrum import directional_spectra, response_spectrum
from rocking.tables import Column, Table, text_array, to_dataset

if TYPE_CHECKING:
    import xarray as xr

PERIODS = np.geomspace(0.02, 10.0, 30)
"""Default periods of spectra [s]."""

SPECTRA = {
    "sa_x": "PSA of x", "sa_y": "PSA of y", "sa_rotd50": "median over all directions of PSA, RotD50",
    "sa_rotd100": "largest over all directions of PSA, RotD100",
}  # fmt: skip
_METADATA = ("event", "station", "date", "format")


@dataclass(frozen=True, eq=False)
class Flatfile:
    """Measures of records, one row per record.

    Parameters
    ----------
    table : Table
        Metadata and measures of the records. Column names end with ``_x`` and ``_y`` for horizontal components, and
        with ``_z`` for the vertical component.
    periods : ndarray
        Periods of the spectra [s].
    damping : float
        Damping ratio of the spectra [-].
    spectra : dict of str to ndarray
        PSA by name, one row per record [m/s2]. NaN without a second component.
    left_out : tuple of pairs of str
        Records without measures, with the reason.
    """

    table: Table
    periods: FloatArray
    damping: float
    spectra: dict[str, FloatArray]
    left_out: tuple[tuple[str, str], ...]

    def flat(self) -> Table:
        """Return measures and spectra as one table, with a column for every spectrum and period.

        Returns
        -------
        Table
            One row per record.
        """
        columns = dict(self.table.columns)
        for name, values in self.spectra.items():
            for k, period in enumerate(self.periods.tolist()):
                columns[f"{name}({period:.4g})"] = Column(values[:, k], "m/s2", f"{SPECTRA[name]} at {period:.4g} s")
        return Table(self.table.row, columns, self.table.provenance)

    def to_xarray(self) -> "xr.Dataset":
        """Return measures and spectra as a labelled dataset.

        Returns
        -------
        xarray.Dataset
            Dimension ``record``, for spectra also ``period``; with units.
        """
        dataset = to_dataset(self.table).assign_coords(period=("period", self.periods, {"units": "s"}))
        for name, values in self.spectra.items():
            dataset[name] = (("record", "period"), values, {"units": "m/s2", "long_name": SPECTRA[name]})
        return dataset


def flatfile(
    records: Iterable[Components],
    periods: ArrayLike = PERIODS,
    damping: float = 0.05,
    *,
    workers: int = 1,
    progress: Callable[[int], None] | None = None,
) -> Flatfile:
    """Compute all intensity measures and the spectra of records.

    Parameters
    ----------
    records : RecordSet or iterable of Components
        As `rocking.motions.formats.read_records` returns them.
    periods : array_like
        Periods of the spectra [s].
    damping : float
        Damping ratio of the spectra [-].
    workers : int
        Number of processes.
    progress : callable, optional
        Called with the number of newly measured records.

    Returns
    -------
    Flatfile
        Measures and spectra, one row per record.

    Examples
    --------
    >>> from rocking.motions.motion import GroundMotion
    >>> motion = GroundMotion([0.0, 3.0, 0.0], 0.01, name="one")
    >>> result = flatfile([Components(motion, motion, None)], [0.1])
    >>> result.table.columns["pga_rotd100"].values.round(9).tolist(), list(result.spectra)
    ([4.242640687], ['sa_x', 'sa_y', 'sa_rotd50', 'sa_rotd100'])
    """
    periods = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    recordings = list(records)
    measure = partial(_measured, periods=periods, damping=damping)
    results = list(mapped(measure, recordings, workers, progress))
    kept = [(record, result) for record, result in zip(recordings, results, strict=True) if not isinstance(result, str)]
    left_out = tuple(
        (_files(record), result) for record, result in zip(recordings, results, strict=True) if isinstance(result, str)
    )
    columns: dict[str, Column] = {"record": Column(text_array([name_of(record) for record, _ in kept]), "", "name")}
    listed = sorted({key for record, _ in kept for key in record.metadata if key.startswith("PEER ")})
    for key in (*_METADATA, *listed):
        values = [str(record.metadata.get(key, "")) for record, _ in kept]
        columns[key.replace(" ", "_")] = Column(text_array(values), "", "as in the file")
    columns["files"] = Column(text_array([_files(record) for record, _ in kept]), "", "record files")
    doubts = (
        dict.fromkeys(component.metadata.get("doubts", "") for component in record.parts if component is not None)
        for record, _ in kept
    )
    columns["doubts"] = Column(text_array([in_one_line(texts) for texts in doubts]), "", "doubts")
    components = [next(component for component in record.parts if component is not None) for record, _ in kept]
    columns["time_step"] = Column(
        np.array([component.time_step for component in components]), "s", "step between samples"
    )
    columns["samples"] = Column(
        np.array([len(component) for component in components], dtype=np.int64), "1", "number of samples"
    )
    for name, (unit, meaning) in _columns().items():
        columns[name] = Column(np.array([result[0].get(name, np.nan) for _, result in kept]), unit, meaning)
    empty = np.full(periods.size, np.nan)
    spectra = {
        name: np.array([result[1].get(name, empty) for _, result in kept]).reshape(-1, periods.size) for name in SPECTRA
    }
    provenance = {"damping_ratio": damping, "periods": "PSA in m/s2"}
    return Flatfile(Table("record", columns, provenance), periods, damping, spectra, left_out)


def name_of(record: Components) -> str:
    """Return the name of a record, which consists of the different names of its components."""
    return ", ".join(dict.fromkeys(component.name for component in record.parts if component is not None))


def _files(record: Components) -> str:
    components = [component for component in record.parts if component is not None]
    return ", ".join(dict.fromkeys(component.metadata.get("file", component.name) for component in components))


def _columns() -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the measures by column name."""
    listed = [measure for measure in MEASURES.values() if measure.is_listed and not measure.needs_body]
    columns = {
        f"{measure.name}_{axis}": (measure.unit, f"{measure.description}, {axis}")
        for measure in listed
        for axis in "xyz"
    }
    for percent, meaning in ((50, "median over all directions"), (100, "largest over all directions")):
        columns[f"pga_rotd{percent}"] = ("m/s2", f"peak ground acceleration, {meaning}")
    return columns


def _measured(
    record: Components, periods: FloatArray, damping: float
) -> tuple[dict[str, float], dict[str, FloatArray]] | str:
    """Return measures and spectra of a record by name, or the reason of a failure."""
    try:
        measures = {}
        for axis, component in zip("xyz", record.parts, strict=True):
            for measure in MEASURES.values() if component is not None else ():
                if measure.is_listed and not measure.needs_body:
                    measures[f"{measure.name}_{axis}"] = measure.of(component)
        if record.x is None or record.y is None:
            only = {"sa_x": record.x, "sa_y": record.y}
            alone = {name: component for name, component in only.items() if component is not None}
            return measures, {
                k: response_spectrum(component, periods, damping).pseudo_acceleration for k, component in alone.items()
            }
        measures |= {f"pga_rotd{percent}": rotd_pga(record.x, record.y, percent) for percent in (50, 100)}
        spectra = directional_spectra(record.x, record.y, periods, damping)
        half, full = np.percentile(spectra, (50.0, 100.0), axis=1)
        return measures, {"sa_x": spectra[:, 0], "sa_y": spectra[:, 90], "sa_rotd50": half, "sa_rotd100": full}
    except RockingError as error:
        return str(error)
