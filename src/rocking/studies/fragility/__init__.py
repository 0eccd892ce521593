"""Fragility: how likely a body is to rock or to overturn at a level of shaking, and how well that is known."""

from rocking.studies.fragility._fragility import fragility, fragility_analysis
from rocking.studies.fragility._incremental_dynamic_analysis import incremental_dynamic_analysis
from rocking.studies.fragility._multiple_stripe_analysis import multiple_stripe_analysis
from rocking.studies.fragility.cloud_analysis import cloud
from rocking.studies.fragility.curves import FragilityCurve, FragilityModel, model_of
from rocking.studies.fragility.export import fema_p58_table, to_csv, to_excel, to_mat, to_netcdf, to_nrml
from rocking.studies.fragility.measure_comparison import compare_measures

__all__ = [
    "FragilityCurve",
    "FragilityModel",
    "cloud",
    "compare_measures",
    "fema_p58_table",
    "fragility",
    "fragility_analysis",
    "incremental_dynamic_analysis",
    "model_of",
    "multiple_stripe_analysis",
    "to_csv",
    "to_excel",
    "to_mat",
    "to_netcdf",
    "to_nrml",
]
