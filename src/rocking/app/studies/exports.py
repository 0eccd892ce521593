"""Finished studies as files: what `rocking campaign export` writes, pictures, and the job itself."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from rocking.app.errors import NotFound, Refused
from rocking.app.studies.opened import OpenStudy
from rocking.app.studies.study_folder import JOB
from rocking.errors import RockingError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Crossing = Literal["refuse", "common-dispersion"]

Kind = Literal["nc", "csv", "mat", "xlsx", "parquet", "toml", "png", "svg", "xml"]

MEDIA_TYPES: dict[str, str] = {
    "nc": "application/x-netcdf",
    "csv": "text/csv; charset=utf-8",
    "mat": "application/x-matlab-data",
    "xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    "parquet": "application/vnd.apache.parquet",
    "toml": "application/toml",
    "png": "image/png",
    "svg": "image/svg+xml",
    "xml": "application/xml",
}
"""What a browser is told of a file."""


def written(
    study: OpenStudy, kind: Kind, target: Path, what: str | None, restitution: int, crossing: Crossing | None = None
) -> None:
    """Write a finished study into a file."""
    labels = list(study.job.job.problem.restitutions)
    if not 0 <= restitution < len(labels):
        raise NotFound(f"restitution must be a number from 0 to {len(labels) - 1}, got {restitution}")
    if kind == "toml":
        target.write_bytes((study.folder.path / JOB).read_bytes())
    elif kind in {"png", "svg"}:
        from rocking.app.takeaway.drawing import draw_to

        draw_to(_picture(study, restitution), target)
    else:
        _exported(study, target, what or ("fragility" if kind == "xml" else None), labels[restitution], crossing)


def _exported(study: OpenStudy, target: Path, what: str | None, label: str, crossing: Crossing | None) -> None:
    from rocking.campaigns.jobs import export

    of_curves = what in {"fragility", "fema-p58"}
    try:
        export(study.job, target, what, restitution=label if of_curves else None, crossing=crossing)
    except RockingError as error:
        raise Refused(study.folder.without_paths(str(error)).replace(f"{target.parent}/", "")) from error


def _picture(study: OpenStudy, restitution: int) -> "Callable[[], Figure]":
    kind = str(study.job.job.document.campaign.kind)
    makers: dict[str, Callable[[OpenStudy, int], Figure]] = {
        "overturning-map": _map,
        "rocking-spectrum": _spectrum,
        "stripes": _fragility,
        "cloud": _fragility,
        "incremental": _incremental,
    }
    if kind not in makers:
        raise Refused(f'a study of kind "{kind}" has no picture; take its table (.csv, .xlsx, .nc)')
    return lambda: makers[kind](study, restitution)


def _map(study: OpenStudy, restitution: int) -> "Figure":
    from rocking.plots.overturning_map import overturning_map_picture

    return overturning_map_picture(study.dataset(restitution))


def _spectrum(study: OpenStudy, restitution: int) -> "Figure":
    from rocking.plots.rocking_spectrum import rocking_spectrum_picture

    return rocking_spectrum_picture(study.dataset(restitution))


def _fragility(study: OpenStudy, restitution: int) -> "Figure":
    from rocking.plots.fragility import fragility_picture

    return fragility_picture(_analysis(study, restitution))


def _incremental(study: OpenStudy, restitution: int) -> "Figure":
    from rocking.plots.incremental_dynamic_analysis import incremental_dynamic_analysis_picture

    return incremental_dynamic_analysis_picture(_analysis(study, restitution))


def _analysis(study: OpenStudy, restitution: int) -> Any:
    return list(study.analyses.values())[restitution]
