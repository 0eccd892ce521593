"""The picture of a finished campaign: the picture of its analysis, or a comparison of restitutions."""

from typing import TYPE_CHECKING

from rocking.campaigns.jobs import JobFolder, comparison
from rocking.campaigns.jobs.findings import FinishedStudy, comparable, label_of, refuse_unfinished
from rocking.plots.sensitivity import sensitivity_picture
from rocking.spec.question import StudyQuestion
from rocking.studies.study_plan import TYPES

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def check_picture(folder: JobFolder, restitution: str | None) -> None:
    """Raise an error for a campaign without a picture, before results are read."""
    question = folder.job.document
    if type(question).plot is StudyQuestion.plot:
        question.plot(None, None)  # raises the error
    if restitution is not None or question.one_restitution:
        label_of("picture", restitution, list(folder.job.problem.restitutions))


def campaign_picture(folder: JobFolder, restitution: str | None = None) -> "Figure":
    """Draw a finished campaign with one restitution. Without a name, compare all restitutions."""
    check_picture(folder, restitution)
    refuse_unfinished(folder)
    if restitution is None and comparable(folder):
        return sensitivity_picture(comparison(folder, tuple(TYPES)))
    return folder.job.document.plot(FinishedStudy(folder), restitution)
