"""Fragility: how likely a body is to rock or to overturn at a level of shaking, and how well that is known."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.motions.intensity import IntensityMeasure, measure, measures, spectral_measure
    from rocking.statistics.counts import Counts, StateCounts, count_outcomes, count_states
    from rocking.statistics.goodness import Goodness
    from rocking.statistics.lognormal import LognormalFit, fit_lognormal
    from rocking.statistics.ordered_probit import OrderedFit, fit_ordered
    from rocking.statistics.separation import Separation
    from rocking.studies.fragility._incremental_dynamic_analysis import (
        IncrementalDynamicAnalysis,
        incremental_dynamic_analysis,
        incremental_dynamic_plan,
    )
    from rocking.studies.fragility._multiple_stripe_analysis import (
        MultipleStripeAnalysis,
        multiple_stripe_analysis,
        multiple_stripe_plan,
    )
    from rocking.studies.fragility._overturning_intervals import OverturningInterval
    from rocking.studies.fragility.cloud_analysis import CloudAnalysis, cloud, cloud_plan
    from rocking.studies.fragility.curves import FragilityCurve, FragilityModel, model_of
    from rocking.studies.fragility.export import fema_p58_table, to_csv, to_excel, to_mat, to_netcdf, to_nrml
    from rocking.studies.fragility.measure_comparison import MeasureComparison, MeasureScore, compare_measures
    from rocking.studies.fragility.subject import LimitState, limit_states

__all__ = [
    "CloudAnalysis",
    "Counts",
    "FragilityCurve",
    "FragilityModel",
    "Goodness",
    "IncrementalDynamicAnalysis",
    "IntensityMeasure",
    "LimitState",
    "LognormalFit",
    "MeasureComparison",
    "MeasureScore",
    "MultipleStripeAnalysis",
    "OrderedFit",
    "OverturningInterval",
    "Separation",
    "StateCounts",
    "cloud",
    "cloud_plan",
    "compare_measures",
    "count_outcomes",
    "count_states",
    "fema_p58_table",
    "fit_lognormal",
    "fit_ordered",
    "incremental_dynamic_analysis",
    "incremental_dynamic_plan",
    "limit_states",
    "measure",
    "measures",
    "model_of",
    "multiple_stripe_analysis",
    "multiple_stripe_plan",
    "spectral_measure",
    "to_csv",
    "to_excel",
    "to_mat",
    "to_netcdf",
    "to_nrml",
]

__getattr__, __dir__ = exports(
    __name__,
    {
        "CloudAnalysis": "rocking.studies.fragility.cloud_analysis",
        "Counts": "rocking.statistics.counts",
        "FragilityCurve": "rocking.studies.fragility.curves",
        "FragilityModel": "rocking.studies.fragility.curves",
        "Goodness": "rocking.statistics.goodness",
        "IncrementalDynamicAnalysis": "rocking.studies.fragility._incremental_dynamic_analysis",
        "IntensityMeasure": "rocking.motions.intensity",
        "LimitState": "rocking.studies.fragility.subject",
        "LognormalFit": "rocking.statistics.lognormal",
        "MeasureComparison": "rocking.studies.fragility.measure_comparison",
        "MeasureScore": "rocking.studies.fragility.measure_comparison",
        "OrderedFit": "rocking.statistics.ordered_probit",
        "OverturningInterval": "rocking.studies.fragility._overturning_intervals",
        "Separation": "rocking.statistics.separation",
        "StateCounts": "rocking.statistics.counts",
        "MultipleStripeAnalysis": "rocking.studies.fragility._multiple_stripe_analysis",
        "cloud": "rocking.studies.fragility.cloud_analysis",
        "cloud_plan": "rocking.studies.fragility.cloud_analysis",
        "compare_measures": "rocking.studies.fragility.measure_comparison",
        "count_outcomes": "rocking.statistics.counts",
        "count_states": "rocking.statistics.counts",
        "fema_p58_table": "rocking.studies.fragility.export",
        "fit_lognormal": "rocking.statistics.lognormal",
        "fit_ordered": "rocking.statistics.ordered_probit",
        "incremental_dynamic_analysis": "rocking.studies.fragility._incremental_dynamic_analysis",
        "incremental_dynamic_plan": "rocking.studies.fragility._incremental_dynamic_analysis",
        "limit_states": "rocking.studies.fragility.subject",
        "measure": "rocking.motions.intensity",
        "measures": "rocking.motions.intensity",
        "model_of": "rocking.studies.fragility.curves",
        "multiple_stripe_analysis": "rocking.studies.fragility._multiple_stripe_analysis",
        "spectral_measure": "rocking.motions.intensity",
        "multiple_stripe_plan": "rocking.studies.fragility._multiple_stripe_analysis",
        "to_csv": "rocking.studies.fragility.export",
        "to_excel": "rocking.studies.fragility.export",
        "to_mat": "rocking.studies.fragility.export",
        "to_netcdf": "rocking.studies.fragility.export",
        "to_nrml": "rocking.studies.fragility.export",
    },
)
