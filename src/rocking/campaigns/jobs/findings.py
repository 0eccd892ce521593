"""Results of finished campaigns, in the classes of the Python functions."""

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
from rocking.studies.sensitivity.comparison import Sensitivity, sampled_in
from rocking.studies.study_plan import AdaptiveResult, Study
from rocking.tables import PIECE

if TYPE_CHECKING:
    import xarray as xr

    from rocking.decision.inventory.assessment import Assessment
    from rocking.spec.study import StudyProblem

READ = ("outcome", "peak_rotation", "least_force")  # results for analyses and assessments: 17 bytes per history


def refuse_unfinished(folder: JobFolder) -> None:
    """Refuse an unfinished campaign."""
    path, status_of_job = folder.path, job_status(folder.path, folder.job.document, verify=False)
    if status_of_job.complete:
        return
    status = status_of_job.status or folder.campaign.status(verify=False)
    text = "nothing to export because {done} of {chunks} chunks of {folder} are finished"
    if status_of_job.rounds is not None:
        text = (
            "nothing to export because {folder} is not finished: {done} of {chunks} chunks of {rounds} so far, and "
            "more rounds may follow"
        )
    rounds = "one round" if (status_of_job.rounds or 1) == 1 else f"{status_of_job.rounds} rounds"
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
        Result of `fragility_analysis` by label of the restitution.

    Raises
    ------
    InvalidValueError
        If campaigns of this kind have no fragility analysis.
    """
    study = folder.job.study
    if study.finish is None:
        raise InvalidValueError('a campaign of kind "{kind}" has no fragility', kind=folder.job.document.campaign.kind)
    return study.finish(folder.campaign.results(*READ, *study.further_columns))


def answer(folder: JobFolder) -> AdaptiveResult:
    """Return the result of an adaptive study, from its rounds on disk.

    Parameters
    ----------
    folder : JobFolder
        The campaign of a refined map, or of minimum accelerations.

    Returns
    -------
    AdaptiveResult
        The result of the Python function, and its tables.

    Raises
    ------
    InvalidValueError
        If the kind of the campaign has no rounds.
    CampaignIncompleteError
        If the campaign is not finished.
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
        The result of `rocking.decision.inventory.assess`.

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
    """Return True if `comparison` can compare the restitutions of a campaign."""
    study = folder.job.study
    is_alone = study.search is not None or study.assess is not None or not study.is_of_rocking
    return len(folder.job.problem.restitutions) > 1 and not is_alone


def comparison(folder: JobFolder, names: Collection[str] = ("outcome", "peak_ratio")) -> Sensitivity:
    """Return the effect of the restitution on the results of a finished campaign.

    Parameters
    ----------
    folder : JobFolder
        The campaign of a job with several restitutions; the first one is the reference.
    names : collection of str
        Results per history in the datasets of the comparison.

    Returns
    -------
    Sensitivity
        The result of `map_sensitivity`, `spectrum_sensitivity` or `fragility_sensitivity`.

    Raises
    ------
    InvalidValueError
        If there is only one restitution, or campaigns of this kind cannot be compared.
    CampaignIncompleteError
        If the campaign is not finished.
    """
    if not comparable(folder):
        raise InvalidValueError("a comparison needs a map, spectra, fragility or histories with several restitutions")
    refuse_unfinished(folder)
    restitutions = folder.job.problem.restitutions
    results = datasets(folder, names) if folder.job.study.finish is None else analyses(folder)
    return Sensitivity(results, baseline=next(iter(restitutions)), sampled=sampled_in(restitutions))


def pieces_of(
    study: Study, ranges: Iterable[HistoryRange], progress: Callable[[int], None] | None = None
) -> Iterator[tuple[int, int, Arrays]]:
    """Yield first history, history after the last one, and the keys of `HISTORY`, piece by piece."""
    for block in ranges:
        for first in range(block.first, block.last, PIECE):
            last = min(first + PIECE, block.last)
            arrays = {name: values[first - block.first : last - block.first] for name, values in block.results.items()}
            yield first, last, study.derived(first, last, arrays)
            if progress is not None:
                progress(last - first)


def datasets(folder: JobFolder, names: Collection[str] = ()) -> "dict[str, xr.Dataset]":
    """Return results of all histories by label of the restitution, in the form of the functions of the studies."""
    study, labels = folder.job.study, list(folder.job.problem.restitutions)
    flat = {name: np.empty(study.histories.count, study.types[name]) for name in names or study.types}
    for first, last, results in pieces_of(study, folder.campaign.pieces()):
        for name, values in flat.items():
            values[first:last] = results[name]
    combined = study.dataset(flat)
    if len(labels) == 1:
        return {labels[0]: combined.assign_attrs(restitution=labels[0])}
    return {
        label: combined.isel(restitution=k, drop=True).assign_attrs(restitution=label) for k, label in enumerate(labels)
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
        Label of the restitution; required if there are several.
    progress : callable, optional
        Called with the number of histories since the last call; the sum is the total.

    Returns
    -------
    MeasureComparison
        The result of `compare_measures` for this cloud, with the measures and columns of the job.

    Raises
    ------
    InvalidValueError
        If the campaign is not a cloud, has several restitutions, or has no measure to rank.
    CampaignIncompleteError
        If the campaign is not finished.
    """
    document, study = folder.job.document, folder.job.study
    if MEASURES not in study.exports:
        raise InvalidValueError(
            "nothing to export because only a cloud analysis compares measures, and this analysis is {kind!r}",
            kind=document.campaign.kind,
        )  # fmt: skip
    refuse_unfinished(folder)
    clouds = analyses(folder)
    cloud = clouds[label_of(MEASURES, restitution, list(clouds))]
    question: Any = document
    names, columns = question.ims(), question.columns(folder.job.problem.motions)
    if question.export.columns is None:
        rocked = clearly_lifted(cloud.responses, cloud.min_rotation)
        columns = {name: values for name, values in columns.items() if np.unique(values[rocked]).size > 1}
    total, count, motions = len(folder.job.problem.motions) * len(names), folder.campaign.plan.count, 0

    def measured(more: int) -> None:
        """Report the progress as a number of histories; `more` counts each motion once per measure."""
        nonlocal motions
        before, motions = count * motions // total, motions + more
        if progress is not None:
            progress(count * motions // total - before)

    try:
        return compare_measures(cloud, names, columns, progress=measured)
    except InvalidValueError as error:
        raise InvalidValueError("nothing to export because {reason}", reason=error.sentence) from error


def label_of(table: str, restitution: str | None, labels: list[str]) -> str:
    """Return the label of the selected restitution, which is required if there are several."""
    if restitution is None and len(labels) > 1:
        own = table if table == MEASURES else f"a {table}"
        raise InvalidValueError(
            "{parameter} must be {allowed}, because every restitution has {own} of its own", parameter="restitution",
            allowed=f"one of {', '.join(labels)}", own=own,
        )  # fmt: skip
    return labels[0] if restitution is None else checks.one_of("restitution", restitution, labels)


@dataclass(frozen=True)
class FinishedStudy:
    """Results of a finished campaign for the figure of its study; the default is the first restitution."""

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
