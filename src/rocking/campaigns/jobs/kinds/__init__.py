"""What makes the study of a job, by the table of its document that is its own."""

from collections.abc import Callable

from rocking.campaigns.jobs.kinds.fragility import fragility_study
from rocking.campaigns.jobs.kinds.maps import map_study
from rocking.campaigns.jobs.kinds.minimum import minimum_study
from rocking.campaigns.jobs.kinds.products import inventory_study, product_study, spectrum_study
from rocking.campaigns.jobs.study import Study
from rocking.spec.document import NEEDS
from rocking.spec.study import StudyProblem

STUDIES: dict[str, Callable[[StudyProblem], Study]] = {
    "map": map_study,
    "minimum": minimum_study,
    "spectrum": spectrum_study,
    "fragility": fragility_study,
    "inventory": inventory_study,
    "histories": product_study,
}


def study_of(problem: StudyProblem) -> Study:
    """Return the study of a job."""
    return STUDIES[NEEDS[problem.document.campaign.kind]](problem)
