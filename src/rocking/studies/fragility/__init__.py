"""Fragility: how likely a body is to rock or to overturn at a level of shaking, and how well that is known."""

from rocking.studies.fragility.bootstrap import BootstrapSample
from rocking.studies.fragility.capacities import CapacitySample
from rocking.studies.fragility.cloud import CloudAnalysis, cloud, cloud_plan
from rocking.studies.fragility.comparison import MeasureComparison, MeasureScore, compare_measures
from rocking.studies.fragility.counts import Counts, StateCounts, count_outcomes, count_states
from rocking.studies.fragility.crossings import OverturningInterval
from rocking.studies.fragility.curves import FragilityCurve, FragilityModel, model_of
from rocking.studies.fragility.export import to_csv, to_excel, to_mat, to_netcdf
from rocking.studies.fragility.goodness import Goodness
from rocking.studies.fragility.incremental import IncrementalAnalysis, incremental, incremental_plan
from rocking.studies.fragility.lognormal import LognormalFit, fit_lognormal
from rocking.studies.fragility.measures import IntensityMeasure, measure, measures, spectral_measure
from rocking.studies.fragility.nrml import to_nrml
from rocking.studies.fragility.ordered import OrderedFit, fit_ordered
from rocking.studies.fragility.separation import Separation
from rocking.studies.fragility.states import LimitState, limit_states
from rocking.studies.fragility.stripes import StripeAnalysis, multiple_stripes, stripes_plan
from rocking.studies.fragility.tables import fema_p58_table

__all__ = [
    "BootstrapSample",
    "CapacitySample",
    "CloudAnalysis",
    "Counts",
    "FragilityCurve",
    "FragilityModel",
    "Goodness",
    "IncrementalAnalysis",
    "IntensityMeasure",
    "LimitState",
    "LognormalFit",
    "MeasureComparison",
    "MeasureScore",
    "OrderedFit",
    "OverturningInterval",
    "Separation",
    "StateCounts",
    "StripeAnalysis",
    "cloud",
    "cloud_plan",
    "compare_measures",
    "count_outcomes",
    "count_states",
    "fema_p58_table",
    "fit_lognormal",
    "fit_ordered",
    "incremental",
    "incremental_plan",
    "limit_states",
    "measure",
    "measures",
    "model_of",
    "multiple_stripes",
    "spectral_measure",
    "stripes_plan",
    "to_csv",
    "to_excel",
    "to_mat",
    "to_netcdf",
    "to_nrml",
]
