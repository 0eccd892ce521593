"""Many histories: overturning maps, rocking spectra, minimum accelerations, fragility, inventories, sensitivity."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.studies._overturning_map import overturning_map
    from rocking.studies._rocking_spectrum import rocking_spectrum
    from rocking.studies.adaptive_grid import refined_map
    from rocking.studies.axis import axes
    from rocking.studies.boundaries import boundary
    from rocking.studies.code_methods import compare_code_methods
    from rocking.studies.fragility import compare_measures, fragility_analysis
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
    "compare_code_methods",
    "compare_measures",
    "fragility_analysis",
    "fragility_sensitivity",
    "map_sensitivity",
    "minimum_overturning_acceleration",
    "minimum_overturning_accelerations",
    "overturning_map",
    "refined_map",
    "rocking_spectrum",
    "safe_beyond_overturning",
    "safe_islands",
    "spectrum_sensitivity",
]

_HOMES = {
    "histories": ("Histories", "HistoryTable", "Product"),
    "motion_sets": ("MotionList", "MotionSet", "SyntheticSet"),
    "sensitivity": (
        "SampledRestitution", "Sensitivity", "fragility_sensitivity", "map_sensitivity", "spectrum_sensitivity",
    ),
    "axis": ("axes",),
    "boundaries": ("boundary",),
    "code_methods": ("compare_code_methods",),
    "fragility": ("compare_measures", "fragility_analysis"),
    "minimum_acceleration": ("minimum_overturning_acceleration", "minimum_overturning_accelerations"),
    "_overturning_map": ("overturning_map",),
    "adaptive_grid": ("refined_map",),
    "_rocking_spectrum": ("rocking_spectrum",),
    "islands": ("safe_beyond_overturning", "safe_islands"),
}  # fmt: skip

__getattr__, __dir__ = exports(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)
