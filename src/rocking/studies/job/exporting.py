"""Finished campaigns as files: every history, or the fragility that they make."""

import json
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from rocking.errors import InvalidValueError
from rocking.studies.campaign import CampaignIncompleteError, disk
from rocking.studies.job.folder import JobFolder
from rocking.studies.job.matlab import to_matlab
from rocking.studies.job.netcdf import to_netcdf
from rocking.studies.job.results import Results
from rocking.studies.job.rows import to_csv, to_excel, to_parquet

Progress = Callable[[int], None] | None

FORMATS: dict[str, Callable[[Results, Path], None]] = {
    ".nc": to_netcdf,
    ".parquet": to_parquet,
    ".csv": to_csv,
    ".mat": to_matlab,
    ".xlsx": to_excel,
}
"""What writes every history, by the end of the file's name."""

WHAT = ("histories", "fragility", "fema-p58")
"""What can be exported."""


def export(
    folder: JobFolder, path: str | os.PathLike[str], what: str = "histories", *, restitution: str | None = None,
    progress: Progress = None,
) -> Path:  # fmt: skip
    """Write a finished campaign into a file, which is there as a whole or not at all.

    Parameters
    ----------
    folder : JobFolder
        The campaign.
    path : path
        The file; the end of its name says the format.
    what : {"histories", "fragility", "fema-p58"}
        Every history (.nc, .parquet, .csv, .mat, .xlsx), the fragility curves (.nc, .csv, .mat, .xlsx, and .xml for
        NRML), or a table as FEMA P-58 asks for it (.csv).
    restitution : str, optional
        Label of the restitution whose fragility is meant, where there are several.
    progress : callable, optional
        Called with the number of histories done since the last call.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If there is no such format, or the kind of the campaign has no fragility.
    CampaignIncompleteError
        If the campaign is not finished.
    """
    from rocking.studies.fragility.export import checked_path

    target = checked_path(path)
    _check_what(what, target.suffix.lower(), restitution, folder)
    status = folder.campaign.status()
    if not status.complete:
        raise CampaignIncompleteError(
            f"nothing to export because {status.chunks_done} of {status.chunks} chunks of {folder.path} are finished; "
            f"go on with: rocking campaign resume {folder.path}"
        )
    results = Results(folder.job.study, folder.campaign, folder.job.provenance, progress)
    unfinished = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    with disk.guarded(target.parent, lambda: "the campaign itself is safe"):
        try:
            if what == "histories":
                FORMATS[target.suffix.lower()](results, unfinished)
            else:
                _fragility(results, unfinished, what, restitution, folder.job.document.campaign.name)
            if target.suffix.lower() in {".csv", ".xml"}:  # neither has room for it
                told = json.dumps(results.provenance, indent=1, sort_keys=True) + "\n"
                disk.write_new(target.with_name(f"{target.name}.provenance.json"), told.encode())
            unfinished.replace(target)
        finally:
            unfinished.unlink(missing_ok=True)
    return target


def _check_what(what: str, suffix: str, restitution: str | None, folder: JobFolder) -> None:
    if what not in WHAT:
        raise InvalidValueError(f"what must be one of {', '.join(WHAT)}, got {what!r:.60}")
    allowed = {"histories": list(FORMATS), "fragility": [".nc", ".csv", ".mat", ".xlsx", ".xml"], "fema-p58": [".csv"]}
    if suffix not in allowed[what]:
        more = "; .xml (NRML) is for the fragility" if suffix == ".xml" and what == "histories" else ""
        raise InvalidValueError(
            f"{what} can be written as {', '.join(allowed[what])}, got {suffix or 'no ending'!r}{more}"
        )
    labels = list(folder.job.parts.choices)
    if what == "histories":
        if restitution is not None:
            raise InvalidValueError("restitution goes with fragility and fema-p58; every history has its own")
        return
    if folder.job.study.finish is None:
        raise InvalidValueError(f'a campaign of kind "{folder.job.document.campaign.kind}" has no {what}')
    if restitution is None and len(labels) > 1:
        raise InvalidValueError(f"restitution must be one of {', '.join(labels)}: each has a {what} of its own")
    if restitution is not None and restitution not in labels:
        raise InvalidValueError(f"restitution must be one of {', '.join(labels)}, got {restitution!r:.60}")


def analyses(folder: JobFolder) -> dict[str, Any]:
    """Return the fragility analyses of a finished campaign.

    Parameters
    ----------
    folder : JobFolder
        The campaign.

    Returns
    -------
    dict
        By label of the restitution: what `multiple_stripes`, `cloud` or `incremental` return.

    Raises
    ------
    InvalidValueError
        If the kind of the campaign has none.
    """
    study = folder.job.study
    if study.finish is None:
        raise InvalidValueError(f'a campaign of kind "{folder.job.document.campaign.kind}" has no fragility')
    return study.finish(folder.campaign.results())


def _fragility(results: Results, path: Path, what: str, restitution: str | None, name: str) -> None:
    from rocking.studies.fragility import export as files
    from rocking.studies.fragility.curves import model_of
    from rocking.studies.fragility.nrml import to_nrml

    assert results.study.finish is not None  # checked before
    found = results.study.finish(results.campaign.results())
    model = model_of(found[restitution] if restitution else next(iter(found.values())), name)
    if what == "fema-p58":
        files.to_csv(model, path, "fema-p58")
        return
    if path.suffix.lower() == ".xml":
        to_nrml(model, path)
        return
    told = {"provenance": json.dumps(results.provenance, sort_keys=True)}
    model = replace(model, about={**model.about, **told})
    writers: dict[str, Callable[[Any, Path], Path]] = {
        ".nc": files.to_netcdf, ".csv": files.to_csv, ".mat": files.to_mat, ".xlsx": files.to_excel,
    }  # fmt: skip
    writers[path.suffix.lower()](model, path)
