"""Finished campaigns as files: every history, or the fragility that they make."""

import json
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from rocking.errors import InvalidValueError
from rocking.studies.campaign import disk
from rocking.studies.fragility.nesting import Crossing, check_crossing, nested
from rocking.studies.job.comparison import COMPARED, comparable, comparison, comparison_sheet
from rocking.studies.job.findings import answer, refuse_unfinished
from rocking.studies.job.folder import JobFolder
from rocking.studies.job.matlab import sheet_to_matlab, to_matlab
from rocking.studies.job.measures import MEASURES, measure_comparison, measures_sheet, told_of
from rocking.studies.job.netcdf import to_netcdf
from rocking.studies.job.results import Results
from rocking.studies.job.round_status import finished_rounds
from rocking.studies.job.rows import to_csv, to_excel, to_parquet
from rocking.studies.job.sheets import SHEET_FORMATS, sheets_to_netcdf

Progress = Callable[[int], None] | None

FORMATS: dict[str, Callable[[Results, Path], None]] = {
    ".nc": to_netcdf,
    ".parquet": to_parquet,
    ".csv": to_csv,
    ".mat": to_matlab,
    ".xlsx": to_excel,
}
"""What writes every history, by the end of the file's name."""

SPECIAL: dict[str, tuple[str, ...]] = {
    "fragility": (".nc", ".csv", ".mat", ".xlsx", ".xml"),
    "fema-p58": (".csv",),
    "refined": tuple(SHEET_FORMATS),
    "boundary": tuple(SHEET_FORMATS),
    "crossings": (".nc", *SHEET_FORMATS),
    "minima": (".nc", *SHEET_FORMATS),
    **dict.fromkeys(COMPARED, tuple(SHEET_FORMATS)),
    MEASURES: (".nc", ".mat", *SHEET_FORMATS),
}
"""What can be exported of some kinds beside their histories, and how."""

_ANALYSES = ("fragility", "fema-p58")
_OF_ONE = (*_ANALYSES, MEASURES)
"""What each restitution has of its own."""


def exports_of(folder: JobFolder) -> list[str]:
    """Return what can be exported of a campaign.

    Parameters
    ----------
    folder : JobFolder
        The campaign.

    Returns
    -------
    list of str
        The first is what is written unless something else is asked for.
    """
    study = folder.job.study
    compared = COMPARED if comparable(folder) else ()
    if study.finish is not None:
        ranked = (MEASURES,) if folder.job.document.campaign.kind == "cloud" else ()
        return ["histories", *_ANALYSES, *ranked, *compared]
    if study.search is None:
        return ["histories", *compared]
    if folder.job.document.map is not None:
        return ["histories", "refined", "boundary"]
    return ["crossings", "minima", "histories"]


def export(
    folder: JobFolder, path: str | os.PathLike[str], what: str | None = None, *, restitution: str | None = None,
    crossing: Crossing | None = None, progress: Progress = None,
) -> Path:  # fmt: skip
    """Write a finished campaign into a file, which is there as a whole or not at all.

    Parameters
    ----------
    folder : JobFolder
        The campaign.
    path : path
        The file; the end of its name says the format.
    what : str, optional
        ``histories``, every one (.nc, .parquet, .csv, .mat, .xlsx); the .nc of a refined map holds its points and
        polylines too. Of fragility campaigns ``fragility``, the curves (.nc, .csv, .mat, .xlsx, and .xml for NRML),
        and ``fema-p58``, a table (.csv); of refined maps ``refined``, all points, and ``boundary``, the vertices of the
        polylines (.csv, .parquet, .xlsx); of minimum accelerations ``crossings`` and ``minima`` (the same, and both in
        one .nc), with ``histories`` for the first samples; of jobs with several restitutions ``flips``, what each of
        them changes against the first, and ``differences``, cell by cell (.csv, .parquet, .xlsx); of clouds
        ``measures``, the ranking of intensity measures (.nc, .csv, .mat, .parquet, .xlsx). The first of `exports_of` if
        not given.
    restitution : str, optional
        Label of the restitution whose fragility or measures are meant, where there are several.
    crossing : {"refuse", "common-dispersion"}, optional
        What to do with fragility curves that cross: NRML and FEMA P-58 refuse them, or all states get one dispersion in
        every file. What the job says if not given; "refuse" if it says nothing.
    progress : callable, optional
        Called with the number of histories done since the last call.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If there is no such format, or the kind of the campaign has nothing of the sort.
    CampaignIncompleteError
        If the campaign is not finished.
    """
    from rocking.studies.fragility.export import checked_path

    target = checked_path(path)
    what = exports_of(folder)[0] if what is None else what
    _check_what(what, target.suffix.lower(), restitution, crossing, folder)
    refuse_unfinished(folder)
    results = Results(folder.job.study, folder.campaign, provenance_of(folder), progress)
    unfinished = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    with disk.guarded(target.parent, lambda: "the campaign itself is safe"):
        try:
            if what == MEASURES:
                results = _measures(results, unfinished, restitution, folder)
            elif what in _ANALYSES:
                _fragility(results, unfinished, what, restitution, crossing, folder)
            else:
                _tables(results, unfinished, what, folder)
            if target.suffix.lower() in {".csv", ".xml"}:  # neither has room for it
                write_provenance(results.provenance, target)
            unfinished.replace(target)
        finally:
            unfinished.unlink(missing_ok=True)
    return target


def provenance_of(folder: JobFolder) -> dict[str, Any]:
    """Return where the results of a finished campaign come from.

    Parameters
    ----------
    folder : JobFolder
        The campaign.

    Returns
    -------
    dict
        That of the job; of an adaptive study also ``rounds`` and ``all_histories``.
    """
    if folder.job.study.search is None or (told := finished_rounds(folder.path)) is None:
        return folder.job.provenance
    return {**folder.job.provenance, "rounds": told["rounds"], "all_histories": told["histories"]}


def write_provenance(provenance: dict[str, Any], beside: Path) -> Path:
    """Write where a file comes from into another beside it.

    Parameters
    ----------
    provenance : dict
        Plain values.
    beside : Path
        The file that has no room for it.

    Returns
    -------
    Path
        The same name with ``.provenance.json`` behind it.
    """
    path = beside.with_name(f"{beside.name}.provenance.json")
    disk.write_new(path, (json.dumps(provenance, indent=1, sort_keys=True) + "\n").encode())
    return path


def _check_what(
    what: str, suffix: str, restitution: str | None, crossing: Crossing | None, folder: JobFolder
) -> None:  # fmt: skip
    every = ["histories", *SPECIAL]
    if what not in every:
        raise InvalidValueError(f"what must be one of {', '.join(every)}, got {what!r:.60}")
    allowed = FORMATS if what == "histories" else SPECIAL[what]
    if suffix not in allowed:
        more = "; .xml (NRML) is for the fragility" if suffix == ".xml" and what == "histories" else ""
        if suffix == ".nc" and what in {"refined", "boundary"}:
            more = "; the .nc of the histories (--what histories) holds points and polylines too"
        raise InvalidValueError(f"{what} can be written as {', '.join(allowed)}, got {suffix or 'no ending'!r}{more}")
    labels = list(folder.job.parts.choices)
    if what not in _OF_ONE and restitution is not None:
        raise InvalidValueError("restitution goes with fragility, fema-p58 and measures; every history has its own")
    if what not in _ANALYSES and crossing is not None:
        raise InvalidValueError("crossing goes with fragility and fema-p58: it is about curves")
    if what not in exports_of(folder):
        why = f'a campaign of kind "{folder.job.document.campaign.kind}" has no {what}{_WHY.get(what, "")}'
        raise InvalidValueError(f"nothing to export because {why}")
    if what in _ANALYSES:
        check_crossing("refuse" if crossing is None else crossing)
    if what in _OF_ONE:
        _check_label(what, restitution, labels)


_WHY = {
    MEASURES: ", which are compared over the motions of a cloud as they are",
    **dict.fromkeys(COMPARED, " without several restitutions to compare"),
}


def _check_label(what: str, restitution: str | None, labels: list[str]) -> None:
    if restitution is None and len(labels) > 1:
        raise InvalidValueError(f"restitution must be one of {', '.join(labels)}: each has a {what} of its own")
    if restitution is not None and restitution not in labels:
        raise InvalidValueError(f"restitution must be one of {', '.join(labels)}, got {restitution!r:.60}")


def _tables(results: Results, path: Path, what: str, folder: JobFolder) -> None:
    """Write histories, or the tables of an adaptive study."""
    suffix, several = path.suffix.lower(), folder.job.study.search is not None
    if what in COMPARED:
        SHEET_FORMATS[suffix](comparison_sheet(comparison(folder), what), path, results.attributes)
        return
    if what == "histories":
        FORMATS[suffix](results, path)
    if not several or (what == "histories" and (suffix != ".nc" or folder.job.document.map is None)):
        return
    found = answer(folder)
    attributes = results.attributes | found.attributes
    if suffix == ".nc":
        sheets_to_netcdf(found.sheets, path, attributes)
    else:
        SHEET_FORMATS[suffix](found.sheets[what], path, attributes)


def _measures(results: Results, path: Path, restitution: str | None, folder: JobFolder) -> Results:
    """Write the ranking of measures; return the results, which know what cannot be said in its rows."""
    found = measure_comparison(folder, restitution, results.progress)
    about = told_of(found) | ({} if restitution is None else {"restitution": restitution})
    results = replace(results, provenance=results.provenance | about)
    sheet, suffix = measures_sheet(found), path.suffix.lower()
    if suffix == ".nc":
        sheets_to_netcdf({MEASURES: sheet}, path, results.attributes)
    else:
        write = sheet_to_matlab if suffix == ".mat" else SHEET_FORMATS[suffix]
        write(sheet, path, results.attributes)
    return results


def _fragility(
    results: Results, path: Path, what: str, restitution: str | None, crossing: Crossing | None, folder: JobFolder
) -> None:  # fmt: skip
    from rocking.studies.fragility import export as files
    from rocking.studies.fragility.curves import model_of
    from rocking.studies.fragility.nrml import to_nrml

    assert results.study.finish is not None  # checked before
    found = results.study.finish(results.campaign.results())
    document = folder.job.document
    model = model_of(found[restitution] if restitution else next(iter(found.values())), document.campaign.name)
    told = document.export.crossing if document.export is not None else "refuse"
    if (told if crossing is None else crossing) == "common-dispersion":
        model = nested(model, "common-dispersion")
    if what == "fema-p58":
        files.to_csv(model, path, "fema-p58")
        return
    if path.suffix.lower() == ".xml":
        to_nrml(model, path)
        return
    provenance = json.dumps(results.provenance, sort_keys=True)
    model = replace(model, about={**model.about, "provenance": provenance})
    writers: dict[str, Callable[[Any, Path], Path]] = {
        ".nc": files.to_netcdf, ".csv": files.to_csv, ".mat": files.to_mat, ".xlsx": files.to_excel,
    }  # fmt: skip
    writers[path.suffix.lower()](model, path)
