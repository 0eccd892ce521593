"""Statistics of outcomes that fail or survive at levels: counts, likelihoods, curves, intervals; no rocking in it."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
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

_HOMES = {
    "CensoredFit": "censored",
    "Counts": "counts",
    "Goodness": "goodness",
    "LognormalFit": "lognormal",
    "OrderedFit": "ordered_probit",
    "Regression": "least_squares",
    "Separation": "separation",
    "StateCounts": "counts",
    "count_outcomes": "counts",
    "count_states": "counts",
    "fit_counts": "lognormal",
    "fit_crossings": "censored",
    "fit_lognormal": "lognormal",
    "fit_ordered": "ordered_probit",
    "regression": "least_squares",
    "share_interval": "counts",
}

__getattr__, __dir__ = exports(__name__, {name: f"{__name__}.{home}" for name, home in _HOMES.items()})
