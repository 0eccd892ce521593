"""Kinds of campaigns: each makes histories, and the study's result of their results."""

from collections.abc import Callable

from rocking.campaigns.jobs.kinds.fragility import fragility_study
from rocking.campaigns.jobs.kinds.histories import product_study
from rocking.campaigns.jobs.kinds.inventory import inventory_study
from rocking.campaigns.jobs.kinds.minimum import minimum_study
from rocking.campaigns.jobs.kinds.overturning_map import map_study
from rocking.campaigns.jobs.kinds.spectrum import spectrum_study
from rocking.campaigns.jobs.study import Study
from rocking.spec.study import StudyProblem

KINDS: dict[str, Callable[[StudyProblem], Study]] = {
    "overturning-map": map_study,
    "minimum-acceleration": minimum_study,
    "rocking-spectrum": spectrum_study,
    "stripes": fragility_study,
    "incremental": fragility_study,
    "cloud": fragility_study,
    "inventory": inventory_study,
    "histories": product_study,
}
"""What makes the study of a job, by its kind."""
