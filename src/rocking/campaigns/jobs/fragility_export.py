"""Fragility curves of finished campaigns as files, as the Python calls write them."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.campaigns.jobs.findings import analyses
from rocking.campaigns.jobs.folder import JobFolder
from rocking.studies.fragility.curves import Crossing, nested

if TYPE_CHECKING:
    from rocking.studies.fragility.curves import FragilityModel

ANALYSES: dict[str, tuple[str, ...]] = {
    "fragility": (".nc", ".csv", ".mat", ".xlsx", ".xml"),
    "fragility-points": (".csv",),
    "fema-p58": (".csv",),
}
"""What can be written of the curves of one restitution, and how."""

_TABLES = {"fragility": "parameters", "fragility-points": "points", "fema-p58": "fema-p58"}


def fragility_model(
    folder: JobFolder, restitution: str | None = None, crossing: Crossing | None = None, bootstrap: int | None = None
) -> "FragilityModel":
    """Return the fragility curves of a finished campaign, ready for export.

    Returns curves with goodness of fit; all random numbers have the seed of the campaign.
    """
    from rocking.studies.fragility.curves import model_of

    document = folder.job.document
    told = document.export
    found = analyses(folder)
    repetitions = (told.bootstrap if told is not None else 0) if bootstrap is None else bootstrap
    model = model_of(
        found[restitution] if restitution else next(iter(found.values())), document.campaign.name,
        bootstrap=repetitions, seed=document.campaign.seed,
    )  # fmt: skip
    way = (told.crossing if told is not None else "refuse") if crossing is None else crossing
    return nested(model, way) if way == "common-dispersion" else model


def write_fragility(model: "FragilityModel", path: Path, what: str, provenance: dict[str, Any]) -> None:
    """Write fragility curves into a file."""
    from rocking.studies.fragility import export as files
    from rocking.studies.fragility.export import to_nrml

    suffix = path.suffix.lower()
    if suffix == ".csv":
        files.to_csv(model, path, _TABLES[what])
        return
    if suffix != ".xml":
        model = replace(model, about={**model.about, "provenance": json.dumps(provenance, sort_keys=True)})
    writers: dict[str, Callable[[Any, Path], Path]] = {
        ".nc": files.to_netcdf, ".mat": files.to_mat, ".xlsx": files.to_excel, ".xml": to_nrml,
    }  # fmt: skip
    writers[suffix](model, path)
