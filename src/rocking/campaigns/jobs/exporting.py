"""Finished campaigns as files: all histories, or results of the study, with their provenance."""

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

MOST_REPETITIONS = 100_000  # largest number of repetitions of a bootstrap
MOST_CELLS = 100_000  # largest number of cells for a count of safe islands
MAP = ("mode", "still_rocking")  # results for safe islands
COMPARED = ("flips", "differences")  # tables of a comparison

FORMATS: dict[str, Callable[[Grid, Path], object]] = {
    ".nc": to_netcdf,
    ".parquet": to_parquet,
    ".csv": to_csv,
    ".mat": lambda grid, path: to_mat(grid, path, "campaign"),
    ".xlsx": lambda grid, path: to_excel([(grid.row, grid)], path, grid.provenance, others=".nc, .parquet or .csv"),
}
"""Writers of all histories, by extension."""

TABLE_FORMATS: dict[str, Callable[[Table, Path], object]] = {
    ".csv": to_csv,
    ".parquet": to_parquet,
    ".mat": lambda table, path: to_mat(table, path, "table", apart=True),
    ".xlsx": lambda table, path: to_excel([(table.row, table)], path, table.provenance),
}
"""Writers of a table, by extension."""

ENDINGS: dict[str, tuple[str, ...]] = {
    "histories": tuple(FORMATS),
    "fragility": (".nc", ".csv", ".mat", ".xlsx", ".xml"),
    "fragility-points": (".csv",),
    "fema-p58": (".csv",),
    "refined": tuple(TABLE_FORMATS),
    "boundary": tuple(TABLE_FORMATS),
    **dict.fromkeys(("crossings", "minima", *COMPARED, MEASURES), (".nc", *TABLE_FORMATS)),
}
"""Exports of campaigns, with their extensions."""

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
    "overturning_verdict": "table can be said of that curve",
    "rocked": "histories that the line rests on",
    "overturned": "histories that overturned",
    "barely_lifted": "histories that rocked too little for the line",
}


def exports_of(folder: JobFolder) -> list[str]:
    """Return the possible exports of a campaign; the first is the default."""
    return [*folder.job.study.exports, *(COMPARED if comparable(folder) else ())]


def export(
    folder: JobFolder, path: str | os.PathLike[str], table: str | None = None, *, restitution: str | None = None,
    crossing_curves: Crossing | None = None, bootstrap: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Path:  # fmt: skip
    """Write a finished campaign into a file, which is complete or absent.

    Parameters
    ----------
    folder : JobFolder
        The campaign.
    path : path
        The file; the extension selects the format.
    table : str, optional
        Table of the export. Default: the first of `exports_of`.

        - ``histories``: all histories (.nc, .parquet, .csv, .mat, .xlsx). The .nc of a refined map also contains its
          points and polylines.
        - ``fragility``: curves with goodness of fit (.nc, .csv, .mat, .xlsx, and .xml for NRML).
        - ``fragility-points``: observed and fitted fractions per level (.csv). ``fema-p58``: FEMA P-58 table (.csv).
        - ``refined``, ``boundary``: points and polylines of a refined map (.csv, .parquet, .mat, .xlsx).
        - ``crossings``, ``minima``: tables of minimum accelerations (also .nc, with both tables).
        - ``flips``, ``differences``: effect of the restitution compared with the first one, in total and per cell.
        - ``ims``: ranking of the intensity measures of a cloud.
    restitution : str, optional
        Label of the restitution of a fragility or ranking; required if there are several.
    crossing_curves : {"keep-uplift", "common-dispersion", "refuse"}, optional
        Treatment of crossing fragility curves, as in `model_of`. Default: from the job, else "keep-uplift".
    bootstrap : int, optional
        Repetitions for intervals and bands of fragility curves, 0 for none. Default: from the job, else 0.
    progress : callable, optional
        Called with the number of histories since the last call.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If the format is unknown, or the kind of the campaign has no such table.
    CampaignIncompleteError
        If the campaign is not finished.
    """
    target, table = checked(folder, path, table, restitution, crossing_curves, bootstrap)
    refuse_unfinished(folder)
    provenance = provenance_of(folder)
    if table == "histories" and folder.job.document.axes:
        provenance |= {"safe_islands": _islands(folder)}
    with disk.guarded(target.parent, lambda: "the campaign itself is safe"), written_whole(target) as unfinished:
        if table in ANALYSES:
            _write_fragility(folder, unfinished, table, restitution, crossing_curves, bootstrap)
        elif table == MEASURES:
            ranking = measure_comparison(folder, restitution, progress)
            provenance |= {"ims_left_out": dict(ranking.left_out), "min_rotation_over_alpha": ranking.min_rotation}
            provenance |= {} if restitution is None else {"restitution": restitution}
            _write_tables([measures_table(ranking)], unfinished, attributes_of(folder, provenance))
        elif table in COMPARED:
            compared = comparison_table(comparison(folder), table)
            _write_tables([compared], unfinished, attributes_of(folder, provenance))
        else:
            _write_study(folder, unfinished, table, attributes_of(folder, provenance), progress)
        if target.suffix.lower() in {".csv", ".xml"}:  # these formats have no attributes
            write_provenance(provenance, target)
    return target


def provenance_of(folder: JobFolder) -> dict[str, Any]:
    """Return the provenance of the results of a finished campaign, with the rounds of an adaptive study."""
    if folder.job.study.search is None or (noted := finished_rounds(folder.path)) is None:
        return dict(folder.job.provenance)
    return {**folder.job.provenance, "rounds": noted["rounds"], "all_histories": noted["histories"]}


def _islands(folder: JobFolder) -> dict[str, list[str]]:
    """Return sentences on the safe islands of a map, by restitution; none for large maps."""
    if folder.campaign.plan.count > MOST_CELLS:
        reason = f"Safe islands are not counted in maps of more than {MOST_CELLS} cells."
        return {label: [reason] for label in folder.job.problem.restitutions}
    return {label: list(safe_islands(dataset).sentences) for label, dataset in datasets(folder, MAP).items()}


def write_provenance(provenance: dict[str, Any], beside: Path) -> Path:
    """Write the provenance into a file with the name of the given file and ``.provenance.json``."""
    path = beside.with_name(f"{beside.name}.provenance.json")
    disk.write_new(path, (json.dumps(provenance, indent=1, sort_keys=True) + "\n").encode())
    return path


def attributes_of(folder: JobFolder, provenance: dict[str, Any]) -> dict[str, Any]:
    """Return the provenance as attributes of a file: the main facts separately, and all of them as JSON."""
    about = folder.job.study.attributes
    plain = {name: int(v) if isinstance(v, bool) else v for name, v in about.items() if v is not None}
    main = {name: provenance[name] for name in _MAIN}
    return {**main, **plain, "provenance": json.dumps(provenance, sort_keys=True)}


def checked(
    folder: JobFolder, path: str | os.PathLike[str], table: str | None, restitution: str | None,
    crossing_curves: Crossing | None, bootstrap: int | None = None,
) -> tuple[Path, str]:  # fmt: skip
    """Return the path and table of an export, or raise an error for an impossible export."""
    target = target_of(path)
    table = exports_of(folder)[0] if table is None else checks.one_of("table", table, ENDINGS)
    suffix = target.suffix.lower()
    if suffix not in ENDINGS[table]:
        hint = ".xml (NRML) is for the fragility" if suffix == ".xml" and table == "histories" else ""
        if suffix == ".nc" and table in {"refined", "boundary"}:
            hint = "the .nc of the histories (--output histories=FILE.nc) holds points and polylines too"
        raise InvalidValueError(
            "{content} can be written as {endings}, got {ending!r}", content=table, endings=", ".join(ENDINGS[table]),
            ending=suffix or "no ending", hint=hint,
        )  # fmt: skip
    if table not in _OF_ONE and restitution is not None:
        raise InvalidValueError(
            "restitution applies to fragility, fema-p58 and ims only; every history has its own restitution"
        )
    if table not in ANALYSES and crossing_curves is not None:
        raise InvalidValueError("crossing_curves applies to fragility and fema-p58 only")
    if table not in exports_of(folder):
        raise InvalidValueError(
            'nothing to export because a campaign of kind "{kind}" has no {content}{reason}',
            kind=folder.job.document.campaign.kind, content=table, reason=_WHY.get(table, ""),
        )  # fmt: skip
    if table in ANALYSES:
        check_crossing("keep-uplift" if crossing_curves is None else crossing_curves)
    if table in _OF_ONE:
        label_of(table, restitution, list(folder.job.problem.restitutions))
    if bootstrap is not None and table not in ANALYSES:
        raise InvalidValueError("bootstrap applies to fragility, fragility-points and fema-p58 only")
    repetitions = checks.within(
        "bootstrap", bootstrap or 0, 0, MOST_REPETITIONS, hint="how many times the study is repeated"
    )
    if 0 < repetitions < FEWEST or repetitions != int(repetitions):
        raise InvalidValueError(parameter="bootstrap", allowed=f"0 or a whole number >= {FEWEST}", value=bootstrap)
    return target, table


def _write_study(
    folder: JobFolder, path: Path, table: str, attributes: dict[str, Any], progress: Callable[[int], None] | None
) -> None:
    """Write histories, or the tables of an adaptive study; the .nc of a refined map contains both."""
    study, suffix = folder.job.study, path.suffix.lower()
    if table == "histories":

        def pieces() -> Iterator[tuple[int, int, Arrays]]:
            return pieces_of(study, folder.campaign.pieces(), progress)

        if suffix != ".csv":  # CSV files have no attributes
            attributes = {**attributes, "contact": _contact_words(folder)}
        FORMATS[suffix](Grid("histories", study.dims, study.coordinates, study.types, pieces, attributes), path)
        if suffix != ".nc" or "refined" not in study.exports:
            return
    result = answer(folder)
    tables = [*result.tables.values()] if suffix == ".nc" else [result.tables[table]]
    _write_tables(tables, path, attributes | result.attributes)


def _contact_words(folder: JobFolder) -> str:
    """Return the number of histories with a tensile contact force, as a sentence."""
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
    table: str,
    restitution: str | None,
    crossing_curves: Crossing | None,
    bootstrap: int | None,
) -> None:
    """Write the curves of a finished campaign with goodness of fit; its seed determines all random numbers."""
    from rocking.studies.fragility import export as files
    from rocking.studies.fragility.curves import model_of

    question: Any = folder.job.document
    campaign, stated = question.campaign, question.export
    by_restitution = analyses(folder)
    analysis = by_restitution[restitution] if restitution else next(iter(by_restitution.values()))
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
        files.to_csv(model, path, _CURVES[table])
    elif suffix == ".xml":
        files.to_nrml(model, path)
    else:
        about = {**model.about, "provenance": json.dumps(provenance_of(folder), sort_keys=True)}
        writers: dict[str, Any] = {".nc": files.to_netcdf, ".mat": files.to_mat, ".xlsx": files.to_excel}
        writers[suffix](replace(model, about=about), path)


def measures_table(ranking: MeasureComparison) -> Table:
    """Return a ranking of measures as a table, the most efficient first, with ``p(name)`` of each metadata column."""
    rows = [row | {"unit": "1" if row["unit"] == "-" else row["unit"]} for row in ranking.rows()]
    tested = {name: f"p-value of the residuals over {name[2:-1]}" for row in rows for name in row if name[:2] == "p("}
    return _of_rows("rank", rows, _RANKED | tested)


def comparison_table(compared: Sensitivity, table: str) -> Table:
    """Return the ``flips`` of a comparison, or its ``differences`` per cell."""
    if table == "flips":
        rows = compared.summary()
        return _of_rows("choice", rows, {name: "" for row in rows for name in row})
    # fragility analyses have another name for the peak rotation / slenderness angle
    peak_name = "peak_ratio" if "peak_ratio" in compared.datasets[compared.baseline] else "rotation"
    verdict, peak = compared.differences("verdict"), compared.differences(peak_name)
    columns = {}
    for name, index in zip(verdict.dims, np.indices(verdict.shape, sparse=True), strict=True):
        values = np.asarray(verdict[name].values)
        # each text is stored once, because repeated texts need much more space than numbers
        labels = values if values.dtype.kind in "iufb" else text_array([str(value) for value in values])
        columns[str(name)] = Column(np.broadcast_to(labels[index], verdict.shape).ravel())
    columns["verdict"] = Column(verdict.values.ravel(), meaning=str(verdict.attrs["long_name"]))
    columns["peak_ratio"] = Column(peak.values.ravel(), meaning=str(peak.attrs["long_name"]))
    return Table("difference", columns)


def _of_rows(row: str, rows: list[dict[str, Any]], meanings: Mapping[str, str]) -> Table:
    """Return records with any keys as a table. An absent key gives NaN or an empty text."""
    columns: dict[str, Column] = {}
    for name in dict.fromkeys(name for record in rows for name in record):
        values = [record.get(name) for record in rows]
        if any(isinstance(value, str) for value in values):
            array = text_array(["" if value is None else str(value) for value in values])
        else:
            array = np.array([np.nan if value is None else value for value in values])
        columns[name] = Column(array, meaning=meanings.get(name, name), variable=variable_of(name, columns))
    return Table(row, columns)


def variable_of(name: str, columns: Mapping[str, Column]) -> str:
    """Return a unique variable name for MATLAB and netCDF.

    >>> variable_of("overturned: median ratio", {})
    'overturned_median_ratio'
    """
    variable = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")
    others = {column.variable for column in columns.values()}
    count = 2
    while (unique := variable if count == 2 and variable not in others else f"{variable}_{count}") in others:
        count += 1
    return unique
