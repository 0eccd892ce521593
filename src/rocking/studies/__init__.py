"""Many histories: overturning maps, rocking spectra, minimum accelerations, fragility, inventories, sensitivity."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.studies._overturning_map import overturning_map
    from rocking.studies._rocking_spectrum import rocking_spectrum
    from rocking.studies.adaptive_grid import refined_map
    from rocking.studies.axis import axes
    from rocking.studies.boundaries import boundary
    from rocking.studies.fragility import (
        cloud,
        compare_measures,
        incremental_dynamic_analysis,
        multiple_stripe_analysis,
    )
    from rocking.studies.histories import Histories, HistoryTable, Product
    from rocking.studies.islands import safe_beyond_overturning, safe_islands
    from rocking.studies.minimum_acceleration import (
        minimum_overturning_acceleration,
        minimum_overturning_accelerations,
    )
    from rocking.studies.motion_sets import MotionList, MotionSet, SyntheticSet
    from rocking.studies.sensitivity import (
        SampledRestitution,
        Sensitivity,
        fragility_sensitivity,
        map_sensitivity,
        spectrum_sensitivity,
    )

__all__ = [
    "Histories",
    "HistoryTable",
    "MotionList",
    "MotionSet",
    "Product",
    "SampledRestitution",
    "Sensitivity",
    "SyntheticSet",
    "axes",
    "boundary",
    "cloud",
    "compare_measures",
    "fragility_sensitivity",
    "incremental_dynamic_analysis",
    "map_sensitivity",
    "minimum_overturning_acceleration",
    "minimum_overturning_accelerations",
    "multiple_stripe_analysis",
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
        "Histories": "rocking.studies.histories",
        "HistoryTable": "rocking.studies.histories",
        "MotionList": "rocking.studies.motion_sets",
        "MotionSet": "rocking.studies.motion_sets",
        "Product": "rocking.studies.histories",
        "SampledRestitution": "rocking.studies.sensitivity",
        "Sensitivity": "rocking.studies.sensitivity",
        "SyntheticSet": "rocking.studies.motion_sets",
        "axes": "rocking.studies.axis",
        "boundary": "rocking.studies.boundaries",
        "cloud": "rocking.studies.fragility",
        "compare_measures": "rocking.studies.fragility",
        "fragility_sensitivity": "rocking.studies.sensitivity",
        "incremental_dynamic_analysis": "rocking.studies.fragility",
        "map_sensitivity": "rocking.studies.sensitivity",
        "minimum_overturning_acceleration": "rocking.studies.minimum_acceleration",
        "minimum_overturning_accelerations": "rocking.studies.minimum_acceleration",
        "multiple_stripe_analysis": "rocking.studies.fragility",
        "overturning_map": "rocking.studies._overturning_map",
        "refined_map": "rocking.studies.adaptive_grid",
        "rocking_spectrum": "rocking.studies._rocking_spectrum",
        "safe_beyond_overturning": "rocking.studies.islands",
        "safe_islands": "rocking.studies.islands",
        "spectrum_sensitivity": "rocking.studies.sensitivity",
    },
)
