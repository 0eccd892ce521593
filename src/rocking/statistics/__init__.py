"""Statistics of outcomes that fail or survive at levels: counts, likelihoods, curves, intervals; no rocking in it."""

from rocking.statistics.censored import CensoredFit, fit_crossings
from rocking.statistics.counts import Counts, StateCounts, count_outcomes, count_states, share_interval
from rocking.statistics.goodness import Goodness
from rocking.statistics.least_squares import Regression, regression
from rocking.statistics.lognormal import LognormalFit, fit_counts, fit_lognormal
from rocking.statistics.ordered_probit import OrderedFit, fit_ordered
from rocking.statistics.separation import Separation

__all__ = [
    "CensoredFit",
    "Counts",
    "Goodness",
    "LognormalFit",
    "OrderedFit",
    "Regression",
    "Separation",
    "StateCounts",
    "count_outcomes",
    "count_states",
    "fit_counts",
    "fit_crossings",
    "fit_lognormal",
    "fit_ordered",
    "regression",
    "share_interval",
]
