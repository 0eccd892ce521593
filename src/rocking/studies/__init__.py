"""Many histories: overturning maps, rocking spectra, sensitivity to the restitution, fragility, campaigns."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.campaigns import Campaign
    from rocking.studies._axes import axes
    from rocking.studies._boundary import Polyline, boundary
    from rocking.studies._overturning_map import overturning_map
    from rocking.studies._rocking_spectrum import rocking_spectrum
    from rocking.studies.axis import Axis
    from rocking.studies.crossings import Crossings
    from rocking.studies.fragility import (
        LognormalFit,
        cloud,
        compare_measures,
        fit_lognormal,
        incremental,
        multiple_stripes,
    )
    from rocking.studies.histories import Histories, HistoryTable, Product
    from rocking.studies.islands import Island, Islands, safe_beyond_overturning, safe_islands
    from rocking.studies.minimum_acceleration import (
        minimum_overturning_acceleration,
        minimum_overturning_accelerations,
    )
    from rocking.studies.motion_set import MotionList, MotionSet
    from rocking.studies.record_set import SyntheticSet
    from rocking.studies.refined import Refined, refined_map
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
    "HistoryTable",
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

__getattr__, __dir__ = exports(
    __name__,
    {
        "Axis": "rocking.studies.axis",
        "Campaign": "rocking.campaigns",
        "Crossings": "rocking.studies.crossings",
        "Histories": "rocking.studies.histories",
        "Island": "rocking.studies.islands",
        "Islands": "rocking.studies.islands",
        "LognormalFit": "rocking.studies.fragility",
        "MotionList": "rocking.studies.motion_set",
        "MotionSet": "rocking.studies.motion_set",
        "Polyline": "rocking.studies._boundary",
        "Product": "rocking.studies.histories",
        "Refined": "rocking.studies.refined",
        "SampledHistories": "rocking.studies.sensitivity",
        "SampledRestitution": "rocking.studies.sensitivity",
        "Sensitivity": "rocking.studies.sensitivity",
        "SyntheticSet": "rocking.studies.record_set",
        "HistoryTable": "rocking.studies.histories",
        "axes": "rocking.studies._axes",
        "boundary": "rocking.studies._boundary",
        "cloud": "rocking.studies.fragility",
        "compare_measures": "rocking.studies.fragility",
        "fit_lognormal": "rocking.studies.fragility",
        "fragility_sensitivity": "rocking.studies.sensitivity",
        "incremental": "rocking.studies.fragility",
        "map_sensitivity": "rocking.studies.sensitivity",
        "minimum_overturning_acceleration": "rocking.studies.minimum_acceleration",
        "minimum_overturning_accelerations": "rocking.studies.minimum_acceleration",
        "multiple_stripes": "rocking.studies.fragility",
        "overturning_map": "rocking.studies._overturning_map",
        "refined_map": "rocking.studies.refined",
        "rocking_spectrum": "rocking.studies._rocking_spectrum",
        "safe_beyond_overturning": "rocking.studies.islands",
        "safe_islands": "rocking.studies.islands",
        "spectrum_sensitivity": "rocking.studies.sensitivity",
    },
)
