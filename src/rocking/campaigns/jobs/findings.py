"""What the studies of finished campaigns have found, as the Python calls return it."""

from typing import TYPE_CHECKING, Any

from rocking.campaigns import CampaignIncompleteError
from rocking.campaigns.jobs.answer import AdaptiveResult
from rocking.campaigns.jobs.folder import JobFolder
from rocking.campaigns.jobs.round_status import resume, status_of_rounds
from rocking.campaigns.jobs.rounds import replayed
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from rocking.studies.inventory.assessment import Assessment

READ = ("outcome", "peak_rotation", "least_force")
"""All that analyses and assessments read of a history: 17 bytes."""


def refuse_unfinished(folder: JobFolder) -> None:
    """Refuse a campaign that is not finished."""
    path = folder.path
    if folder.job.study.search is None:
        status = folder.campaign.status(verify=False)
        complete, share = status.complete, f"{status.chunks_done} of {status.chunks} chunks of {path} are finished"
    else:
        known, begun, complete = status_of_rounds(path, verify=False)
        status = known or folder.campaign.status(verify=False)
        share = f"{path} is not finished: {status.chunks_done} of {status.chunks} chunks of {_rounds(max(begun, 1))}"
        share += " so far, and more rounds may follow"
    if not complete:
        raise CampaignIncompleteError(f"nothing to export because {share}; go on with: {resume(path)}")


def _rounds(count: int) -> str:
    return "one round" if count == 1 else f"{count} rounds"


def analyses(folder: JobFolder) -> dict[str, Any]:
    """Return the fragility analyses of a finished campaign.

    Parameters
    ----------
    folder : JobFolder
        The campaign.

    Returns
    -------
    dict
        By label of the restitution: what `multiple_stripe_analysis`, `cloud` or `incremental_dynamic_analysis` return.

    Raises
    ------
    InvalidValueError
        If the kind of the campaign has none.
    """
    study = folder.job.study
    if study.finish is None:
        raise InvalidValueError(f'a campaign of kind "{folder.job.document.campaign.kind}" has no fragility')
    return study.finish(folder.campaign.results(*READ))


def answer(folder: JobFolder) -> AdaptiveResult:
    """Return what an adaptive study has found, from its rounds on disk.

    Parameters
    ----------
    folder : JobFolder
        The campaign of a refined map, or of minimum accelerations.

    Returns
    -------
    Answer
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
        raise InvalidValueError(f'a campaign of kind "{folder.job.document.campaign.kind}" has no rounds')
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
        raise InvalidValueError(f'a campaign of kind "{folder.job.document.campaign.kind}" has no assessment')
    refuse_unfinished(folder)
    found: Assessment = assess(folder.campaign.results(*READ))
    return found
