"""Many histories: overturning maps, rocking spectra, sensitivity to the restitution, fragility, campaigns."""

from rocking.studies.axes import axes
from rocking.studies.axis import Axis
from rocking.studies.boundary import Polyline, boundary
from rocking.studies.campaign import Campaign
from rocking.studies.crossings import Crossings
from rocking.studies.fragility import (
    LognormalFit,
    cloud,
    compare_measures,
    fit_lognormal,
    incremental,
    multiple_stripes,
)
from rocking.studies.histories import Histories, Product, Table
from rocking.studies.islands import Island, Islands, safe_beyond_overturning, safe_islands
from rocking.studies.minimum_acceleration import (
    minimum_overturning_acceleration,
    minimum_overturning_accelerations,
)
from rocking.studies.motion_set import MotionList, MotionSet
from rocking.studies.overturning_map import overturning_map
from rocking.studies.record_set import SyntheticSet
from rocking.studies.refined import Refined, refined_map
from rocking.studies.rocking_spectrum import rocking_spectrum
from rocking.studies.sensitivity import (
    SampledHistories,
    SampledRestitution,
    Sensitivity,
    fragility_sensitivity,
    map_sensitivity,
    spectrum_sensitivity,
)

__all__ = [
    "Axis",
    "Campaign",
    "Crossings",
    "Histories",
    "Island",
    "Islands",
    "LognormalFit",
    "MotionList",
    "MotionSet",
    "Polyline",
    "Product",
    "Refined",
    "SampledHistories",
    "SampledRestitution",
    "Sensitivity",
    "SyntheticSet",
    "Table",
    "axes",
    "boundary",
    "cloud",
    "compare_measures",
    "fit_lognormal",
    "fragility_sensitivity",
    "incremental",
    "map_sensitivity",
    "minimum_overturning_acceleration",
    "minimum_overturning_accelerations",
    "multiple_stripes",
    "overturning_map",
    "refined_map",
    "rocking_spectrum",
    "safe_beyond_overturning",
    "safe_islands",
    "spectrum_sensitivity",
]
