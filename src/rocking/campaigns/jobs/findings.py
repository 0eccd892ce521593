"""Results of the studies of finished campaigns, as the Python calls return them."""

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.campaigns import CampaignIncompleteError
from rocking.campaigns.jobs.folder import JobFolder, job_status
from rocking.campaigns.jobs.rounds import replayed, resume_hint
from rocking.campaigns.ledger import HistoryRange
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.spec.questions.fragility import MEASURES
from rocking.studies.fragility.cloud_analysis import clearly_lifted
from rocking.studies.fragility.measure_comparison import MeasureComparison, compare_measures
from rocking.studies.sensitivity.comparison import Sensitivity, drawn_in
from rocking.studies.study_plan import TYPES, AdaptiveResult, Study
from rocking.tables import PIECE

if TYPE_CHECKING:
    import xarray as xr

    from rocking.spec.study import StudyProblem
    from rocking.studies.inventory.assessment import Assessment

READ = ("outcome", "peak_rotation", "least_force")  # all that analyses and assessments read of a history: 17 bytes


def refuse_unfinished(folder: JobFolder) -> None:
    """Refuse a campaign that is not finished."""
    path, known = folder.path, job_status(folder.path, folder.job.document, verify=False)
    if known.complete:
        return
    status = known.status or folder.campaign.status(verify=False)
    text = "nothing to export because {done} of {chunks} chunks of {folder} are finished"
    if known.rounds is not None:
        text = (
            "nothing to export because {folder} is not finished: {done} of {chunks} chunks of {rounds} so far, and "
            "more rounds may follow"
        )
    rounds = "one round" if (known.rounds or 1) == 1 else f"{known.rounds} rounds"
    raise CampaignIncompleteError(
        text, done=status.chunks_done, chunks=status.chunks, folder=path, rounds=rounds, hint=resume_hint(path)
    )


def analyses(folder: JobFolder) -> dict[str, Any]:
    """Return the fragility analyses of a finished campaign.

    Parameters
    ----------
    folder : JobFolder
        The campaign.

    Returns
    -------
    dict
        By label of the restitution: what `fragility_analysis` returns.

    Raises
    ------
    InvalidValueError
        If the kind of the campaign has none.
    """
    study = folder.job.study
    if study.finish is None:
        raise InvalidValueError('a campaign of kind "{kind}" has no fragility', kind=folder.job.document.campaign.kind)
    return study.finish(folder.campaign.results(*READ))


def answer(folder: JobFolder) -> AdaptiveResult:
    """Return the result of an adaptive study, from its rounds on disk.

    Parameters
    ----------
    folder : JobFolder
        The campaign of a refined map, or of minimum accelerations.

    Returns
    -------
    AdaptiveResult
        What the Python call returns, and tables of it.

    Raises
    ------
    InvalidValueError
        If the kind of the campaign has no rounds.
    CampaignIncompleteError
        If it is not finished.
    """
    search = folder.job.study.search
    if search is None:
        raise InvalidValueError('a campaign of kind "{kind}" has no rounds', kind=folder.job.document.campaign.kind)
    return replayed(search, folder.path)


def assessment(folder: JobFolder) -> "Assessment":
    """Return the assessment of an inventory from a finished campaign.

    Parameters
    ----------
    folder : JobFolder
        The campaign.

    Returns
    -------
    Assessment
        What `rocking.studies.inventory.assess` returns.

    Raises
    ------
    InvalidValueError
        If the campaign is not of an inventory.
    """
    assess = folder.job.study.assess
    if assess is None:
        raise InvalidValueError('a campaign of kind "{kind}" has no assessment', kind=folder.job.document.campaign.kind)
    refuse_unfinished(folder)
    result: Assessment = assess(folder.campaign.results(*READ))
    return result


def comparable(folder: JobFolder) -> bool:
    """Return whether a campaign has several restitutions that `comparison` can compare."""
    study = folder.job.study
    is_alone = study.search is not None or study.assess is not None or study.types is not TYPES
    return len(folder.job.problem.restitutions) > 1 and not is_alone


def comparison(folder: JobFolder, names: Collection[str] = ("outcome", "peak_ratio")) -> Sensitivity:
    """Return how the restitution changes the results of a finished campaign, as the Python calls do.

    Parameters
    ----------
    folder : JobFolder
        The campaign of a job with several restitutions; the first one is what the others are compared with.
    names : collection of str
        What of every history the datasets of the comparison hold.

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
    restitutions = folder.job.problem.restitutions
    results = datasets(folder, names) if folder.job.study.finish is None else analyses(folder)
    return Sensitivity(results, baseline=next(iter(restitutions)), drawn=drawn_in(restitutions))


def pieces_of(
    study: Study, ranges: Iterable[HistoryRange], progress: Callable[[int], None] | None = None
) -> Iterator[tuple[int, int, Arrays]]:
    """Return first history, last one (not included) and the keys of `HISTORY`, a piece after another."""
    for each in ranges:
        for first in range(each.first, each.last, PIECE):
            last = min(first + PIECE, each.last)
            part = {name: values[first - each.first : last - each.first] for name, values in each.results.items()}
            yield first, last, study.derived(first, last, part)
            if progress is not None:
                progress(last - first)


def datasets(folder: JobFolder, names: Collection[str] = ()) -> "dict[str, xr.Dataset]":
    """Return results of all histories by label of the restitution, as the studies' functions return them."""
    study, labels = folder.job.study, list(folder.job.problem.restitutions)
    flat = {name: np.empty(study.histories.count, study.types[name]) for name in names or study.types}
    for first, last, results in pieces_of(study, folder.campaign.pieces()):
        for name, values in flat.items():
            values[first:last] = results[name]
    every = study.dataset(flat)
    if len(labels) == 1:
        return {labels[0]: every.assign_attrs(restitution=labels[0])}
    return {
        label: every.isel(restitution=k, drop=True).assign_attrs(restitution=label) for k, label in enumerate(labels)
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
    document, study = folder.job.document, folder.job.study
    if MEASURES not in study.exports:
        raise InvalidValueError(
            "nothing to export because measures are compared over a cloud, this is {kind!r}",
            kind=document.campaign.kind,
        )  # fmt: skip
    refuse_unfinished(folder)
    clouds = analyses(folder)
    cloud = clouds[label_of(MEASURES, restitution, list(clouds))]
    question: Any = document
    names, columns = question.ims(), question.columns(folder.job.problem.motions)
    if question.export.columns is None:
        rocked = clearly_lifted(cloud.responses, cloud.least)
        columns = {name: values for name, values in columns.items() if np.unique(values[rocked]).size > 1}
    total, count, motions = len(folder.job.problem.motions) * len(names), folder.campaign.plan.count, 0

    def measured(more: int) -> None:
        """Tell of motions, each of which is measured once for each measure, as shares of the histories."""
        nonlocal motions
        before, motions = count * motions // total, motions + more
        if progress is not None:
            progress(count * motions // total - before)

    try:
        return compare_measures(cloud, names, columns, progress=measured)
    except InvalidValueError as error:
        raise InvalidValueError("nothing to export because {reason}", reason=error.sentence) from error


def label_of(what: str, restitution: str | None, labels: list[str]) -> str:
    """Return the restitution that is meant, where each has something of its own."""
    if restitution is None and len(labels) > 1:
        own = what if what == MEASURES else f"a {what}"
        raise InvalidValueError(
            "{parameter} must be {allowed}: each has {own} of its own", parameter="restitution",
            allowed=f"one of {', '.join(labels)}", own=own,
        )  # fmt: skip
    return labels[0] if restitution is None else checks.one_of("restitution", restitution, labels)


@dataclass(frozen=True)
class FinishedStudy:
    """Results of a finished campaign, as the picture of its question takes them; without a restitution of the first."""

    folder: JobFolder

    @property
    def problem(self) -> "StudyProblem":
        """Bodies, motions, restitutions and settings."""
        return self.folder.job.problem

    @property
    def answer(self) -> AdaptiveResult:
        """Result of an adaptive study."""
        return answer(self.folder)

    @property
    def assessment(self) -> "Assessment":
        """Assessment of an inventory."""
        return assessment(self.folder)

    def analysis(self, restitution: str | None) -> Any:
        """Return the fragility analysis with a restitution."""
        return analyses(self.folder)[restitution or next(iter(self.problem.restitutions))]

    def dataset(self, restitution: str | None) -> "xr.Dataset":
        """Return the results of all histories with a restitution."""
        return datasets(self.folder)[restitution or next(iter(self.problem.restitutions))]
