"""Fragility: probability of rocking and overturning over the intensity level, with its uncertainty."""

from rocking.studies.fragility._fragility import fragility, fragility_analysis
from rocking.studies.fragility.curves import FragilityCurve, FragilityModel, model_of
from rocking.studies.fragility.export import fema_p58_table, to_csv, to_excel, to_mat, to_netcdf, to_nrml
from rocking.studies.fragility.measure_comparison import compare_measures

__all__ = [
    "FragilityCurve",
    "FragilityModel",
    "compare_measures",
    "fema_p58_table",
    "fragility",
    "fragility_analysis",
    "model_of",
    "to_csv",
    "to_excel",
    "to_mat",
    "to_netcdf",
    "to_nrml",
]
