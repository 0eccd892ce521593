"""Fragility: how likely a body is to rock or to overturn at a level of shaking, and how well that is known."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.studies.fragility._cloud import CloudAnalysis, cloud, cloud_plan
    from rocking.studies.fragility._incremental import IncrementalAnalysis, incremental, incremental_plan
    from rocking.studies.fragility._measures import IntensityMeasure, measure, measures, spectral_measure
    from rocking.studies.fragility.bootstrap import BootstrapSample
    from rocking.studies.fragility.capacities import CapacitySample
    from rocking.studies.fragility.comparison import MeasureComparison, MeasureScore, compare_measures
    from rocking.studies.fragility.counts import Counts, StateCounts, count_outcomes, count_states
    from rocking.studies.fragility.crossings import OverturningInterval
    from rocking.studies.fragility.curves import FragilityCurve, FragilityModel, model_of
    from rocking.studies.fragility.export import to_csv, to_excel, to_mat, to_netcdf
    from rocking.studies.fragility.goodness import Goodness
    from rocking.studies.fragility.lognormal import LognormalFit, fit_lognormal
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

__getattr__, __dir__ = exports(
    __name__,
    {
        "BootstrapSample": "rocking.studies.fragility.bootstrap",
        "CapacitySample": "rocking.studies.fragility.capacities",
        "CloudAnalysis": "rocking.studies.fragility._cloud",
        "Counts": "rocking.studies.fragility.counts",
        "FragilityCurve": "rocking.studies.fragility.curves",
        "FragilityModel": "rocking.studies.fragility.curves",
        "Goodness": "rocking.studies.fragility.goodness",
        "IncrementalAnalysis": "rocking.studies.fragility._incremental",
        "IntensityMeasure": "rocking.studies.fragility._measures",
        "LimitState": "rocking.studies.fragility.states",
        "LognormalFit": "rocking.studies.fragility.lognormal",
        "MeasureComparison": "rocking.studies.fragility.comparison",
        "MeasureScore": "rocking.studies.fragility.comparison",
        "OrderedFit": "rocking.studies.fragility.ordered",
        "OverturningInterval": "rocking.studies.fragility.crossings",
        "Separation": "rocking.studies.fragility.separation",
        "StateCounts": "rocking.studies.fragility.counts",
        "StripeAnalysis": "rocking.studies.fragility.stripes",
        "cloud": "rocking.studies.fragility._cloud",
        "cloud_plan": "rocking.studies.fragility._cloud",
        "compare_measures": "rocking.studies.fragility.comparison",
        "count_outcomes": "rocking.studies.fragility.counts",
        "count_states": "rocking.studies.fragility.counts",
        "fema_p58_table": "rocking.studies.fragility.tables",
        "fit_lognormal": "rocking.studies.fragility.lognormal",
        "fit_ordered": "rocking.studies.fragility.ordered",
        "incremental": "rocking.studies.fragility._incremental",
        "incremental_plan": "rocking.studies.fragility._incremental",
        "limit_states": "rocking.studies.fragility.states",
        "measure": "rocking.studies.fragility._measures",
        "measures": "rocking.studies.fragility._measures",
        "model_of": "rocking.studies.fragility.curves",
        "multiple_stripes": "rocking.studies.fragility.stripes",
        "spectral_measure": "rocking.studies.fragility._measures",
        "stripes_plan": "rocking.studies.fragility.stripes",
        "to_csv": "rocking.studies.fragility.export",
        "to_excel": "rocking.studies.fragility.export",
        "to_mat": "rocking.studies.fragility.export",
        "to_netcdf": "rocking.studies.fragility.export",
        "to_nrml": "rocking.studies.fragility.nrml",
    },
)
