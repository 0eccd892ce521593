"""Kinds of campaigns: each makes histories, and the study's result of their results."""

from collections.abc import Callable

from rocking.studies.job.kinds.fragility import fragility_study
from rocking.studies.job.kinds.histories import product_study
from rocking.studies.job.kinds.inventory import inventory_study
from rocking.studies.job.kinds.minimum import minimum_study
from rocking.studies.job.kinds.overturning_map import map_study
from rocking.studies.job.kinds.spectrum import spectrum_study
from rocking.studies.job.parts import Parts
from rocking.studies.job.study import Study

KINDS: dict[str, Callable[[Parts], Study]] = {
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
