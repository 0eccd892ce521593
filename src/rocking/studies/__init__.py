"""Many histories: overturning maps, rocking spectra, minimum accelerations, fragility, inventories, sensitivity."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.studies._overturning_map import overturning_map as overturning_map
    from rocking.studies._rocking_spectrum import rocking_spectrum as rocking_spectrum
    from rocking.studies.adaptive_grid import refined_map as refined_map
    from rocking.studies.axis import axes as axes
    from rocking.studies.boundaries import boundary as boundary
    from rocking.studies.code_methods import compare_code_methods as compare_code_methods
    from rocking.studies.fragility import compare_measures as compare_measures
    from rocking.studies.fragility import fragility_analysis as fragility_analysis
    from rocking.studies.histories import Histories as Histories
    from rocking.studies.histories import HistoryTable as HistoryTable
    from rocking.studies.histories import Product as Product
    from rocking.studies.islands import safe_beyond_overturning as safe_beyond_overturning
    from rocking.studies.islands import safe_islands as safe_islands
    from rocking.studies.minimum_acceleration import (
        minimum_overturning_acceleration as minimum_overturning_acceleration,
    )
    from rocking.studies.minimum_acceleration import (
        minimum_overturning_accelerations as minimum_overturning_accelerations,
    )
    from rocking.studies.motion_sets import MotionList as MotionList
    from rocking.studies.motion_sets import MotionSet as MotionSet
    from rocking.studies.motion_sets import SyntheticSet as SyntheticSet
    from rocking.studies.sensitivity import SampledRestitution as SampledRestitution
    from rocking.studies.sensitivity import Sensitivity as Sensitivity
    from rocking.studies.sensitivity import fragility_sensitivity as fragility_sensitivity
    from rocking.studies.sensitivity import map_sensitivity as map_sensitivity
    from rocking.studies.sensitivity import spectrum_sensitivity as spectrum_sensitivity
else:
    __all__, __getattr__, __dir__ = exports(__name__)
