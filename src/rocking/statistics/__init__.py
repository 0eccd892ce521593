"""Statistics of outcomes that fail or survive at levels: counts, likelihoods, curves, intervals; no rocking in it."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.statistics.censored import fit_crossings as fit_crossings
    from rocking.statistics.counts import count_outcomes as count_outcomes
    from rocking.statistics.counts import count_states as count_states
    from rocking.statistics.counts import share_interval as share_interval
    from rocking.statistics.least_squares import regression as regression
    from rocking.statistics.lognormal import LognormalFit as LognormalFit
    from rocking.statistics.lognormal import fit_lognormal as fit_lognormal
    from rocking.statistics.maximum_likelihood import Separation as Separation
    from rocking.statistics.ordered_probit import fit_ordered as fit_ordered
    from rocking.statistics.scores import Forecasts as Forecasts
    from rocking.statistics.scores import logistic_left_out as logistic_left_out
else:
    __all__, __getattr__, __dir__ = exports(__name__)
