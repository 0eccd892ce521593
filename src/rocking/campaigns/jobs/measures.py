"""Which measure of intensity says most about the body of a finished cloud campaign: the ranking, and its table."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.campaigns.jobs.answer import variable_of
from rocking.campaigns.jobs.findings import analyses, refuse_unfinished
from rocking.campaigns.jobs.folder import JobFolder
from rocking.campaigns.jobs.measured import columns_of, measures_of
from rocking.errors import InvalidValueError
from rocking.studies.fragility.cloud_analysis import CloudAnalysis, clearly_lifted
from rocking.studies.fragility.measure_comparison import MeasureComparison, compare_measures
from rocking.tables import Column, Table, text_array

MEASURES = "measures"
"""What the ranking is called among the exports."""

_WORDS = {
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


def measure_comparison(
    folder: JobFolder, restitution: str | None = None, progress: Callable[[int], None] | None = None
) -> MeasureComparison:
    """Return the ranking of intensity measures over the histories of a finished cloud campaign.

    Parameters
    ----------
    folder : JobFolder
        The campaign.
    restitution : str, optional
        Label of the restitution whose histories are meant, where there are several.
    progress : callable, optional
        Called with a number of histories since the last call, all of the campaign in the end.

    Returns
    -------
    MeasureComparison
        What `compare_measures` returns for the same cloud, the measures and columns of the job.

    Raises
    ------
    InvalidValueError
        If it is no cloud, there are several restitutions, or nothing can be ranked.
    CampaignIncompleteError
        If the campaign is not finished.
    """
    document = folder.job.document
    if document.campaign.kind != "cloud":
        raise InvalidValueError(f"{_NOTHING} measures are compared over a cloud, this is {document.campaign.kind!r}")
    refuse_unfinished(folder)
    chosen = _chosen(folder, restitution)
    names, columns = measures_of(document), columns_of(document, folder.job.problem.motions)
    if document.export is None or document.export.columns is None:
        rocked = clearly_lifted(chosen.responses, chosen.least)
        columns = {name: values for name, values in columns.items() if np.unique(values[rocked]).size > 1}
    count = folder.campaign.plan.count
    told = None if progress is None else _Told(progress, len(folder.job.problem.motions) * len(names), count)
    try:
        return compare_measures(chosen, names, columns, progress=told)
    except InvalidValueError as error:
        raise InvalidValueError(f"{_NOTHING} {error}") from error


def _chosen(folder: JobFolder, restitution: str | None) -> CloudAnalysis:
    found: dict[str, CloudAnalysis] = analyses(folder)
    if restitution is None and len(found) > 1:
        raise InvalidValueError(f"restitution must be one of {', '.join(found)}: each has measures of its own")
    if restitution is not None and restitution not in found:
        raise InvalidValueError(f"restitution must be one of {', '.join(found)}, got {restitution!r:.60}")
    return next(iter(found.values())) if restitution is None else found[restitution]


_NOTHING = "nothing to export because"


class _Told:
    """Tells of all motions, measured once for each measure, as shares of the histories."""

    def __init__(self, progress: Callable[[int], None], total: int, histories: int) -> None:
        self._progress, self._total, self._histories = progress, total, histories
        self._done = self._told = 0

    def __call__(self, count: int) -> None:
        """Take note of motions that have been measured."""
        self._done += count
        share = self._histories * self._done // self._total
        self._progress(share - self._told)
        self._told = share


def measures_table(found: MeasureComparison) -> Table:
    """Return a ranking as a table.

    Returns A row a measure, the most efficient first; a column ``p(name)`` for each column of the metadata. The unit of
    what has none is 1.
    """
    rows = [row | {"unit": "1" if row["unit"] == "-" else row["unit"]} for row in found.rows()]
    columns: dict[str, Column] = {}
    for name in rows[0]:
        values = [row[name] for row in rows]
        array = text_array(values) if isinstance(values[0], str) else np.array(values)
        meaning = _WORDS.get(name, f"p-value of the residuals over {name[2:-1]}" if name.startswith("p(") else name)
        columns[name] = Column(array, meaning=meaning, variable=variable_of(name, columns))
    return Table("rank", columns)


def told_of(found: MeasureComparison) -> dict[str, Any]:
    """Return what is to be said of a ranking beside its rows.

    Returns measures that were left out with the reasons, and the rotation below which a history counts as barely
    lifted.
    """
    return {"measures_left_out": dict(found.left_out), "least_rotation_over_alpha": found.least}
