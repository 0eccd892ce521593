"""What the choice of the restitution changes in a finished campaign: the comparison, and its tables."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.campaigns.jobs.answer import variable_of
from rocking.campaigns.jobs.findings import analyses, refuse_unfinished
from rocking.campaigns.jobs.folder import JobFolder
from rocking.campaigns.jobs.results import Results
from rocking.campaigns.jobs.study import TYPES
from rocking.dynamics.impact_laws import ImpactLaw, RandomRestitution
from rocking.errors import InvalidValueError, extra
from rocking.quantities import attributes
from rocking.studies.sensitivity.comparison import Sensitivity
from rocking.tables import Column, Table, text_array

if TYPE_CHECKING:
    import xarray as xr

COMPARED = ("flips", "differences")
"""Tables of a comparison."""

_KEPT = ("outcome", "peak_ratio")


def comparable(folder: JobFolder) -> bool:
    """Return whether a campaign has several restitutions that can be compared.

    Returns whether `comparison` has something to say of it.
    """
    study = folder.job.study
    return len(folder.job.problem.restitutions) > 1 and study.search is None and study.assess is None


def comparison(folder: JobFolder) -> Sensitivity:
    """Return how the restitution changes the results of a finished campaign, as the Python calls do.

    Parameters
    ----------
    folder : JobFolder
        The campaign of a job with several restitutions; the first one is what the others are compared with.

    Returns
    -------
    Sensitivity
        What `map_sensitivity`, `spectrum_sensitivity` and `fragility_sensitivity` return.

    Raises
    ------
    InvalidValueError
        If there is only one restitution, or the kind of the campaign has none to compare.
    CampaignIncompleteError
        If the campaign is not finished.
    """
    if not comparable(folder):
        raise InvalidValueError("a comparison needs a map, spectra, fragility or histories with several restitutions")
    refuse_unfinished(folder)
    choices = folder.job.problem.restitutions
    results = _datasets(folder) if folder.job.study.finish is None else analyses(folder)
    drawn = [label for label, law in choices.items() if isinstance(law, ImpactLaw) and law.kind == _RANDOM]
    return Sensitivity(results, baseline=next(iter(choices)), drawn=drawn)


def comparison_table(found: Sensitivity, what: str) -> Table:
    """Return a table of a comparison."""
    return _flips(found) if what == "flips" else _differences(found)


_RANDOM = RandomRestitution.kind


def _datasets(folder: JobFolder) -> "dict[str, xr.Dataset]":
    xarray: Any = extra("xarray", "comparing restitutions")
    study, labels = folder.job.study, list(folder.job.problem.restitutions)
    flat = {name: np.empty(study.histories.count, TYPES[name]) for name in _KEPT}
    for first, last, found in Results(study, folder.campaign, {}).pieces():
        for name in _KEPT:
            flat[name][first:last] = found[name]
    axis = list(study.dims).index("restitution")
    whole = {name: np.moveaxis(values.reshape(study.shape), axis, 0) for name, values in flat.items()}
    dims = [name for name in study.dims if name != "restitution"]
    along = {name: study.coordinates[name] for name in dims if name in study.coordinates}
    coords = {name: each.values for name, each in along.items() if each.dims == (name,)}
    told = {name: attributes(name) for name in _KEPT}
    return {
        label: xarray.Dataset({name: (dims, whole[name][k], told[name]) for name in _KEPT}, coords)
        for k, label in enumerate(labels)
    }


def _flips(found: Sensitivity) -> Table:
    rows = found.summary()
    names = dict.fromkeys(name for row in rows for name in row)
    columns: dict[str, Column] = {}
    for name in names:
        columns[name] = Column(_values([row.get(name) for row in rows]), variable=variable_of(name, columns))
    return Table("choice", columns)


def _values(given: list[Any]) -> np.ndarray:
    if any(isinstance(value, str) for value in given):
        return text_array(["" if value is None else str(value) for value in given])
    return np.array([np.nan if value is None else value for value in given])


def _differences(found: Sensitivity) -> Table:
    # analyses call the largest rotation over alpha by its own name
    known = found.datasets[found.baseline]
    verdict, peak = (
        found.differences("verdict"),
        found.differences("peak_ratio" if "peak_ratio" in known else "rotation"),
    )
    columns = {}
    for k, name in enumerate(verdict.dims):
        values = np.asarray(verdict[name].values)
        # words are kept once: written out they would take many times the room of the numbers
        whole = values if values.dtype.kind in "iufb" else text_array([str(value) for value in values])
        shape = [-1 if k == axis else 1 for axis in range(verdict.ndim)]
        columns[str(name)] = Column(np.broadcast_to(whole.reshape(shape), verdict.shape).ravel())
    columns["verdict"] = Column(verdict.values.ravel(), meaning=str(verdict.attrs["long_name"]))
    columns["peak_ratio"] = Column(peak.values.ravel(), meaning=str(peak.attrs["long_name"]))
    return Table("difference", columns)
