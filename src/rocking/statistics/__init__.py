"""Statistics of outcomes that fail or survive at levels: counts, likelihoods, curves, intervals; no rocking in it."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.statistics.censored import CensoredFit, fit_crossings
    from rocking.statistics.counts import Counts, StateCounts, count_outcomes, count_states, share_interval
    from rocking.statistics.goodness import Goodness
    from rocking.statistics.least_squares import Regression, regression
    from rocking.statistics.lognormal import LognormalFit, fit_counts, fit_lognormal
    from rocking.statistics.maximum_likelihood import Separation
    from rocking.statistics.ordered_probit import OrderedFit, fit_ordered
    from rocking.statistics.scores import Forecasts, ReliabilityBin, Score, logistic_left_out

__all__ = [
    "CensoredFit",
    "Counts",
    "Forecasts",
    "Goodness",
    "LognormalFit",
    "OrderedFit",
    "Regression",
    "ReliabilityBin",
    "Score",
    "Separation",
    "StateCounts",
    "count_outcomes",
    "count_states",
    "fit_counts",
    "fit_crossings",
    "fit_lognormal",
    "fit_ordered",
    "logistic_left_out",
    "regression",
    "share_interval",
]

_HOMES = {
    "censored": ("CensoredFit", "fit_crossings"),
    "counts": ("Counts", "StateCounts", "count_outcomes", "count_states", "share_interval"),
    "goodness": ("Goodness",),
    "least_squares": ("Regression", "regression"),
    "lognormal": ("LognormalFit", "fit_counts", "fit_lognormal"),
    "maximum_likelihood": ("Separation",),
    "ordered_probit": ("OrderedFit", "fit_ordered"),
    "scores": ("Forecasts", "ReliabilityBin", "Score", "logistic_left_out"),
}

__getattr__, __dir__ = exports(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)
