"""Finished campaigns as files: every history, or the fragility that they make."""

import json
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.campaigns import disk
from rocking.campaigns.jobs.comparison import COMPARED, comparable, comparison, comparison_table
from rocking.campaigns.jobs.findings import answer, refuse_unfinished
from rocking.campaigns.jobs.folder import JobFolder
from rocking.campaigns.jobs.fragility_export import ANALYSES, fragility_model, write_fragility
from rocking.campaigns.jobs.measures import MEASURES, measure_comparison, measures_table, told_of
from rocking.campaigns.jobs.results import Results
from rocking.campaigns.jobs.round_status import finished_rounds
from rocking.errors import InvalidValueError
from rocking.statistics.goodness import FEWEST
from rocking.studies.fragility.curves import Crossing, check_crossing
from rocking.tables import (
    Grid,
    Table,
    add_to_netcdf,
    target_of,
    to_csv,
    to_excel,
    to_mat,
    to_netcdf,
    to_parquet,
)

MOST_REPETITIONS = 100_000
"""Most repetitions of a bootstrap."""

Progress = Callable[[int], None] | None

FORMATS: dict[str, Callable[[Grid, Path], object]] = {
    ".nc": to_netcdf,
    ".parquet": to_parquet,
    ".csv": to_csv,
    ".mat": lambda grid, path: to_mat(grid, path, "campaign"),
    ".xlsx": lambda grid, path: to_excel([(grid.row, grid)], path, grid.provenance, others=".nc, .parquet or .csv"),
}
"""What writes every history, by the end of the file's name."""

TABLE_FORMATS: dict[str, Callable[[Table, Path], object]] = {
    ".csv": to_csv,
    ".parquet": to_parquet,
    ".mat": lambda table, path: to_mat(table, path, "table", apart=True),
    ".xlsx": lambda table, path: to_excel([(table.row, table)], path, table.provenance),
}
"""What writes a table, by the end of the file's name."""

SPECIAL: dict[str, tuple[str, ...]] = {
    **ANALYSES,
    "refined": tuple(TABLE_FORMATS),
    "boundary": tuple(TABLE_FORMATS),
    "crossings": (".nc", *TABLE_FORMATS),
    "minima": (".nc", *TABLE_FORMATS),
    **dict.fromkeys(COMPARED, (".nc", *TABLE_FORMATS)),
    MEASURES: (".nc", *TABLE_FORMATS),
}
"""What can be exported of some kinds beside their histories, and how."""

_OF_ONE = (*ANALYSES, MEASURES)
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
        return ["histories", *ANALYSES, *ranked, *compared]
    if study.search is None:
        return ["histories", *compared]
    if folder.job.document.map is not None:
        return ["histories", "refined", "boundary"]
    return ["crossings", "minima", "histories"]


def export(
    folder: JobFolder, path: str | os.PathLike[str], what: str | None = None, *, restitution: str | None = None,
    crossing: Crossing | None = None, bootstrap: int | None = None, progress: Progress = None,
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
        polylines too. Of fragility campaigns ``fragility``, the curves with their goodness of fit (.nc, .csv, .mat,
        .xlsx, and .xml for NRML), ``fragility-points``, observed and fitted level by level (.csv), and ``fema-p58``, a
        table (.csv); of refined maps ``refined``, all points, and ``boundary``, the vertices of the polylines (.csv,
        .parquet, .mat, .xlsx); of minimum accelerations ``crossings`` and ``minima`` (the same, and both in one .nc),
        with ``histories`` for the first samples; of jobs with several restitutions ``flips``, what each of them changes
        against the first, and ``differences``, cell by cell (the same, and .nc); of clouds ``measures``, the ranking of
        intensity measures (the same, and .nc). The first of `exports_of` if not given.
    restitution : str, optional
        Label of the restitution whose fragility or measures are meant, where there are several.
    crossing : {"refuse", "common-dispersion"}, optional
        What to do with fragility curves that cross: NRML and FEMA P-58 refuse them, or all states get one dispersion in
        every file. What the job says if not given; "refuse" if it says nothing.
    bootstrap : int, optional
        Repetitions of the study for intervals and bands of fragility curves beside the usual ones, none if 0. What the
        job says if not given; none if it says nothing.
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
    target = target_of(path)
    what = exports_of(folder)[0] if what is None else what
    _check_what(what, target.suffix.lower(), restitution, crossing, folder)
    _check_bootstrap(what, bootstrap)
    refuse_unfinished(folder)
    results = Results(folder.job.study, folder.campaign, provenance_of(folder), progress)
    unfinished = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    with disk.guarded(target.parent, lambda: "the campaign itself is safe"):
        try:
            if what == MEASURES:
                results = _measures(results, unfinished, restitution, folder)
            elif what in ANALYSES:
                model = fragility_model(folder, restitution, crossing, bootstrap)
                write_fragility(model, unfinished, what, results.provenance)
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

    Returns that of the job; of an adaptive study also ``rounds`` and ``all_histories``.
    """
    if folder.job.study.search is None or (told := finished_rounds(folder.path)) is None:
        return folder.job.provenance
    return {**folder.job.provenance, "rounds": told["rounds"], "all_histories": told["histories"]}


def write_provenance(provenance: dict[str, Any], beside: Path) -> Path:
    """Write where a file comes from into another beside it.

    Returns the same name with ``.provenance.json`` behind it.
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
    labels = list(folder.job.problem.restitutions)
    if what not in _OF_ONE and restitution is not None:
        raise InvalidValueError("restitution goes with fragility, fema-p58 and measures; every history has its own")
    if what not in ANALYSES and crossing is not None:
        raise InvalidValueError("crossing goes with fragility and fema-p58: it is about curves")
    if what not in exports_of(folder):
        why = f'a campaign of kind "{folder.job.document.campaign.kind}" has no {what}{_WHY.get(what, "")}'
        raise InvalidValueError(f"nothing to export because {why}")
    if what in ANALYSES:
        check_crossing("refuse" if crossing is None else crossing)
    if what in _OF_ONE:
        _check_label(what, restitution, labels)


def _check_bootstrap(what: str, bootstrap: int | None) -> None:
    if bootstrap is None:
        return
    if what not in ANALYSES:
        raise InvalidValueError("bootstrap goes with fragility, fragility-points and fema-p58: it is about curves")
    whole = checks.within("bootstrap", bootstrap, 0, MOST_REPETITIONS, hint="how many times the study is repeated")
    if 0 < whole < FEWEST or whole != int(whole):
        raise InvalidValueError(f"bootstrap must be 0 or a whole number >= {FEWEST}, got {bootstrap!r}")


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
        _table(comparison_table(comparison(folder), what), path, results.attributes)
        return
    if what == "histories":
        FORMATS[suffix](results.grid, path)
    if not several or (what == "histories" and (suffix != ".nc" or folder.job.document.map is None)):
        return
    found = answer(folder)
    attributes = results.attributes | found.attributes
    if suffix == ".nc":
        add_to_netcdf(found.tables, path, attributes)
    else:
        _table(found.tables[what], path, attributes)


def _table(table: Table, path: Path, attributes: dict[str, Any]) -> None:
    suffix = path.suffix.lower()
    if suffix == ".nc":
        add_to_netcdf({table.row: table}, path, attributes)
    else:
        TABLE_FORMATS[suffix](replace(table, provenance=attributes), path)


def _measures(results: Results, path: Path, restitution: str | None, folder: JobFolder) -> Results:
    """Write the ranking of measures; return the results, which know what cannot be said in its rows."""
    found = measure_comparison(folder, restitution, results.progress)
    about = told_of(found) | ({} if restitution is None else {"restitution": restitution})
    results = replace(results, provenance=results.provenance | about)
    _table(measures_table(found), path, results.attributes)
    return results
