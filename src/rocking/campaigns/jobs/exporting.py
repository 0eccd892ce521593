"""Finished campaigns as files: every history, or what the study makes of them, with their provenance."""

import json
import os
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.campaigns import disk
from rocking.campaigns.jobs.findings import (
    analyses,
    answer,
    comparable,
    comparison,
    datasets,
    label_of,
    measure_comparison,
    pieces_of,
    refuse_unfinished,
)
from rocking.campaigns.jobs.folder import JobFolder
from rocking.campaigns.jobs.rounds import finished_rounds
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.outcome import contact_sentence, lost_contact
from rocking.spec.questions.fragility import ANALYSES, MEASURES
from rocking.statistics.goodness import FEWEST
from rocking.studies.fragility.curves import Crossing, check_crossing
from rocking.studies.fragility.measure_comparison import MeasureComparison
from rocking.studies.islands import safe_islands
from rocking.studies.sensitivity.comparison import Sensitivity
from rocking.tables import (
    Column,
    Grid,
    Table,
    add_to_netcdf,
    target_of,
    text_array,
    to_csv,
    to_excel,
    to_mat,
    to_netcdf,
    to_parquet,
)
from rocking.tables.table import written_whole

MOST_REPETITIONS = 100_000  # most repetitions of a bootstrap
MOST_CELLS = 100_000  # of maps whose safe islands are counted
MAP = ("mode", "still_rocking")  # what safe islands are found from
COMPARED = ("flips", "differences")  # tables of a comparison

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

ENDINGS: dict[str, tuple[str, ...]] = {
    "histories": tuple(FORMATS),
    "fragility": (".nc", ".csv", ".mat", ".xlsx", ".xml"),
    "fragility-points": (".csv",),
    "fema-p58": (".csv",),
    "refined": tuple(TABLE_FORMATS),
    "boundary": tuple(TABLE_FORMATS),
    **dict.fromkeys(("crossings", "minima", *COMPARED, MEASURES), (".nc", *TABLE_FORMATS)),
}
"""What can be exported of campaigns, and how."""

_OF_ONE = (*ANALYSES, MEASURES)
_WHY = {
    MEASURES: ", which are compared over the motions of a cloud as they are",
    **dict.fromkeys(COMPARED, " without several restitutions to compare"),
}
_MAIN = ("software", "campaign", "kind", "engine", "histories_key")
_CURVES = {"fragility": "parameters", "fragility-points": "points", "fema-p58": "fema-p58"}
_RANKED = {
    "efficiency": "scatter of ln(theta/alpha) about its line over the ln of the measure",
    "slope": "slope of that line",
    "proficiency": "efficiency over the size of the slope",
    "determination": "R squared of that line",
    "overturning_dispersion": "dispersion of the lognormal curve of overturning",
    "overturning_verdict": "what can be said of that curve",
    "rocked": "histories that the line rests on",
    "overturned": "histories that overturned",
    "barely_lifted": "histories that rocked too little for the line",
}


def exports_of(folder: JobFolder) -> list[str]:
    """Return what can be exported of a campaign; the first is written unless something else is asked for."""
    return [*folder.job.study.exports, *(COMPARED if comparable(folder) else ())]


def export(
    folder: JobFolder, path: str | os.PathLike[str], what: str | None = None, *, restitution: str | None = None,
    crossing_curves: Crossing | None = None, bootstrap: int | None = None,
    progress: Callable[[int], None] | None = None,
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
        .xlsx, and .xml for NRML), ``fragility-points``, observed and fitted level by level, and ``fema-p58`` (.csv). As
        tables (.csv, .parquet, .mat, .xlsx): of refined maps ``refined``, all points, and ``boundary``, the vertices of
        the polylines; of minimum accelerations ``crossings`` and ``minima`` (both in one .nc); with several
        restitutions ``flips``, what each changes against the first, and ``differences``, cell by cell; of clouds
        ``ims``, the ranking of intensity measures (.nc, too). The first of `exports_of` if not given.
    restitution : str, optional
        Label of the restitution whose fragility or measures are meant, where there are several.
    crossing_curves : {"keep-uplift", "common-dispersion", "refuse"}, optional
        Treatment of fragility curves that cross, the same in every file, as in `model_of`. That of the job if not
        given; "keep-uplift" if the job states none.
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
    target, what = checked(folder, path, what, restitution, crossing_curves, bootstrap)
    refuse_unfinished(folder)
    provenance = provenance_of(folder)
    if what == "histories" and folder.job.document.axes:
        provenance |= {"safe_islands": _islands(folder)}
    with disk.guarded(target.parent, lambda: "the campaign itself is safe"), written_whole(target) as unfinished:
        if what in ANALYSES:
            _write_fragility(folder, unfinished, what, restitution, crossing_curves, bootstrap)
        elif what == MEASURES:
            ranking = measure_comparison(folder, restitution, progress)
            provenance |= {"ims_left_out": dict(ranking.left_out), "least_rotation_over_alpha": ranking.least}
            provenance |= {} if restitution is None else {"restitution": restitution}
            _write_tables([measures_table(ranking)], unfinished, attributes_of(folder, provenance))
        elif what in COMPARED:
            table = comparison_table(comparison(folder), what)
            _write_tables([table], unfinished, attributes_of(folder, provenance))
        else:
            _write_study(folder, unfinished, what, attributes_of(folder, provenance), progress)
        if target.suffix.lower() in {".csv", ".xml"}:  # neither has room for it
            write_provenance(provenance, target)
    return target


def provenance_of(folder: JobFolder) -> dict[str, Any]:
    """Return where the results of a finished campaign come from, of an adaptive study with rounds and all histories."""
    if folder.job.study.search is None or (noted := finished_rounds(folder.path)) is None:
        return dict(folder.job.provenance)
    return {**folder.job.provenance, "rounds": noted["rounds"], "all_histories": noted["histories"]}


def _islands(folder: JobFolder) -> dict[str, list[str]]:
    """Return sentences on the safe islands of a map, by restitution; large maps are written in pieces, uncounted."""
    if folder.campaign.plan.count > MOST_CELLS:
        why = f"Safe islands are not counted in maps of more than {MOST_CELLS} cells."
        return {label: [why] for label in folder.job.problem.restitutions}
    return {label: list(safe_islands(found).sentences) for label, found in datasets(folder, MAP).items()}


def write_provenance(provenance: dict[str, Any], beside: Path) -> Path:
    """Write where a file comes from into another beside it, of the same name with ``.provenance.json`` behind it."""
    path = beside.with_name(f"{beside.name}.provenance.json")
    disk.write_new(path, (json.dumps(provenance, indent=1, sort_keys=True) + "\n").encode())
    return path


def attributes_of(folder: JobFolder, provenance: dict[str, Any]) -> dict[str, Any]:
    """Return the provenance as attributes of a file: the main facts each by itself, and all of it as JSON."""
    about = folder.job.study.attributes
    plain = {name: int(v) if isinstance(v, bool) else v for name, v in about.items() if v is not None}
    main = {name: provenance[name] for name in _MAIN}
    return {**main, **plain, "provenance": json.dumps(provenance, sort_keys=True)}


def checked(
    folder: JobFolder, path: str | os.PathLike[str], what: str | None, restitution: str | None,
    crossing_curves: Crossing | None, bootstrap: int | None = None,
) -> tuple[Path, str]:  # fmt: skip
    """Return the file and what it will hold, after refusing what `export` would."""
    target = target_of(path)
    what = exports_of(folder)[0] if what is None else checks.one_of("what", what, ENDINGS)
    suffix = target.suffix.lower()
    if suffix not in ENDINGS[what]:
        hint = ".xml (NRML) is for the fragility" if suffix == ".xml" and what == "histories" else ""
        if suffix == ".nc" and what in {"refined", "boundary"}:
            hint = "the .nc of the histories (--output histories=FILE.nc) holds points and polylines too"
        raise InvalidValueError(
            "{content} can be written as {endings}, got {ending!r}", content=what, endings=", ".join(ENDINGS[what]),
            ending=suffix or "no ending", hint=hint,
        )  # fmt: skip
    if what not in _OF_ONE and restitution is not None:
        raise InvalidValueError("restitution goes with fragility, fema-p58 and ims; every history has its own")
    if what not in ANALYSES and crossing_curves is not None:
        raise InvalidValueError("crossing_curves goes with fragility and fema-p58: it is about curves")
    if what not in exports_of(folder):
        raise InvalidValueError(
            'nothing to export because a campaign of kind "{kind}" has no {content}{reason}',
            kind=folder.job.document.campaign.kind, content=what, reason=_WHY.get(what, ""),
        )  # fmt: skip
    if what in ANALYSES:
        check_crossing("keep-uplift" if crossing_curves is None else crossing_curves)
    if what in _OF_ONE:
        label_of(what, restitution, list(folder.job.problem.restitutions))
    if bootstrap is not None and what not in ANALYSES:
        raise InvalidValueError("bootstrap goes with fragility, fragility-points and fema-p58: it is about curves")
    whole = checks.within("bootstrap", bootstrap or 0, 0, MOST_REPETITIONS, hint="how many times the study is repeated")
    if 0 < whole < FEWEST or whole != int(whole):
        raise InvalidValueError(parameter="bootstrap", allowed=f"0 or a whole number >= {FEWEST}", value=bootstrap)
    return target, what


def _write_study(
    folder: JobFolder, path: Path, what: str, attributes: dict[str, Any], progress: Callable[[int], None] | None
) -> None:
    """Write histories, or the tables of an adaptive study; a refined map has room for both in one .nc."""
    study, suffix = folder.job.study, path.suffix.lower()
    if what == "histories":

        def pieces() -> Iterator[tuple[int, int, Arrays]]:
            return pieces_of(study, folder.campaign.pieces(), progress)

        if suffix != ".csv":  # which has no attributes
            attributes = {**attributes, "contact": _contact_words(folder)}
        FORMATS[suffix](Grid("histories", study.dims, study.coordinates, study.types, pieces, attributes), path)
        if suffix != ".nc" or "refined" not in study.exports:
            return
    result = answer(folder)
    tables = [*result.tables.values()] if suffix == ".nc" else [result.tables[what]]
    _write_tables(tables, path, attributes | result.attributes)


def _contact_words(folder: JobFolder) -> str:
    """Return in how many histories the ground would have to pull."""
    counts = np.zeros(2, np.int64)
    for piece in folder.campaign.pieces():
        lost = lost_contact(piece.results)
        counts += np.bincount(lost[np.isfinite(lost)].astype(np.int64), minlength=2)
    return contact_sentence(int(counts[1]), int(counts.sum()))


def _write_tables(tables: list[Table], path: Path, attributes: dict[str, Any]) -> None:
    suffix = path.suffix.lower()
    if suffix == ".nc":
        add_to_netcdf({table.row: table for table in tables}, path, attributes)
    else:
        TABLE_FORMATS[suffix](replace(tables[0], provenance=attributes), path)


def _write_fragility(
    folder: JobFolder,
    path: Path,
    what: str,
    restitution: str | None,
    crossing_curves: Crossing | None,
    bootstrap: int | None,
) -> None:
    """Write the curves of a finished campaign with goodness of fit; all random numbers have its seed."""
    from rocking.studies.fragility import export as files
    from rocking.studies.fragility.curves import model_of

    question: Any = folder.job.document
    campaign, stated = question.campaign, question.export
    every = analyses(folder)
    analysis = every[restitution] if restitution else next(iter(every.values()))
    repetitions = stated.bootstrap if bootstrap is None else bootstrap
    model = model_of(
        analysis,
        campaign.name,
        crossing_curves=crossing_curves or stated.crossing_curves,
        bootstrap=repetitions,
        seed=campaign.seed,
    )
    suffix = path.suffix.lower()
    if suffix == ".csv":
        files.to_csv(model, path, _CURVES[what])
    elif suffix == ".xml":
        files.to_nrml(model, path)
    else:
        about = {**model.about, "provenance": json.dumps(provenance_of(folder), sort_keys=True)}
        writers: dict[str, Any] = {".nc": files.to_netcdf, ".mat": files.to_mat, ".xlsx": files.to_excel}
        writers[suffix](replace(model, about=about), path)


def measures_table(ranking: MeasureComparison) -> Table:
    """Return a ranking of measures as a table, the most efficient first, with ``p(name)`` for each metadata column."""
    rows = [row | {"unit": "1" if row["unit"] == "-" else row["unit"]} for row in ranking.rows()]
    tested = {name: f"p-value of the residuals over {name[2:-1]}" for row in rows for name in row if name[:2] == "p("}
    return _of_rows("rank", rows, _RANKED | tested)


def comparison_table(compared: Sensitivity, what: str) -> Table:
    """Return the ``flips`` of a comparison, or its ``differences`` cell by cell."""
    if what == "flips":
        rows = compared.summary()
        return _of_rows("choice", rows, {name: "" for row in rows for name in row})
    # analyses call the largest rotation over alpha by its own name
    peak_name = "peak_ratio" if "peak_ratio" in compared.datasets[compared.baseline] else "rotation"
    verdict, peak = compared.differences("verdict"), compared.differences(peak_name)
    columns = {}
    for name, place in zip(verdict.dims, np.indices(verdict.shape, sparse=True), strict=True):
        values = np.asarray(verdict[name].values)
        # words are kept once: written out they would take many times the room of the numbers
        whole = values if values.dtype.kind in "iufb" else text_array([str(value) for value in values])
        columns[str(name)] = Column(np.broadcast_to(whole[place], verdict.shape).ravel())
    columns["verdict"] = Column(verdict.values.ravel(), meaning=str(verdict.attrs["long_name"]))
    columns["peak_ratio"] = Column(peak.values.ravel(), meaning=str(peak.attrs["long_name"]))
    return Table("difference", columns)


def _of_rows(row: str, rows: list[dict[str, Any]], meanings: Mapping[str, str]) -> Table:
    """Return rows of any keys as a table; NaN, or no text, where a row has none."""
    columns: dict[str, Column] = {}
    for name in dict.fromkeys(name for each in rows for name in each):
        values = [each.get(name) for each in rows]
        if any(isinstance(value, str) for value in values):
            array = text_array(["" if value is None else str(value) for value in values])
        else:
            array = np.array([np.nan if value is None else value for value in values])
        columns[name] = Column(array, meaning=meanings.get(name, name), variable=variable_of(name, columns))
    return Table(row, columns)


def variable_of(name: str, taken: Mapping[str, Column]) -> str:
    """Return a name that MATLAB and netCDF take, and no other column has.

    >>> variable_of("overturned: median ratio", {})
    'overturned_median_ratio'
    """
    variable = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")
    others = {each.variable for each in taken.values()}
    count = 2
    while (unique := variable if count == 2 and variable not in others else f"{variable}_{count}") in others:
        count += 1
    return unique
