"""Lognormal fragility by maximum likelihood: P(failure | im) = Phi(ln(im / median) / dispersion).

J. W. Baker, Efficient analytical fragility function fitting using dynamic structural analysis, Earthquake Spectra 31
(2015) 579-599, whose likelihood this maximises; inside, the curve is Phi(a + b ln im), in which it is concave.
"""

from collections.abc import Hashable, Iterable
from typing import Any, Literal

from rocking.errors import InvalidValueError
from rocking.studies.fragility.counts import Counts, count_outcomes
from rocking.studies.fragility.estimate import LogScale, find_curves, log_fractile
from rocking.studies.fragility.fit import LognormalFit
from rocking.studies.fragility.separation import Separation, separation_of

__all__ = ["LognormalFit", "fit_counts", "fit_lognormal"]

Method = Literal["auto", "maximum-likelihood", "penalised"]
METHODS: tuple[Method, ...] = ("auto", "maximum-likelihood", "penalised")
LARGEST_LOGARITHM = 690.0
"""Beyond this a median is no float64 [-]."""


def fit_lognormal(
    levels: Any,
    failures: Any,
    trials: Any = None,
    *,
    method: Method = "auto",
    clusters: Iterable[Hashable] | None = None,
) -> LognormalFit:
    """Fit a lognormal fragility curve to outcomes, or say why there is none.

    Parameters
    ----------
    levels : array_like
        Level of the intensity measure of each entry, in any order, > 0 [any unit].
    failures : array_like
        How many trials of each entry failed; 0 or 1, or booleans, without `trials` [-].
    trials : array_like, optional
        How many trials each entry holds, at least 1; 1 each by default [-].
    method : {"auto", "maximum-likelihood", "penalised"}
        "auto" maximises the likelihood where a maximum exists, and Firth's penalised one where the outcomes form a
        step.
    clusters : iterable, optional
        Name of the cluster of each entry, such as its record: outcomes of one cluster are not independent.

    Returns
    -------
    LognormalFit
        The fit; check `exists` or read `verdict`.

    Raises
    ------
    InvalidValueError
        If a value is refused, or "maximum-likelihood" is asked for where no maximum exists.

    Examples
    --------
    >>> fit = fit_lognormal([0.2, 0.4, 0.6, 0.8], failures=[1, 8, 14, 19], trials=[20, 20, 20, 20])
    >>> round(fit.median, 4), round(fit.dispersion, 4), fit.separation.name
    (0.4419, 0.4454, 'OVERLAP')
    >>> fit_lognormal([0.2, 0.4, 0.6, 0.8], [0, 0, 1, 1]).median_interval
    (0.4, 0.6)
    """
    _check_method(method)
    return fit_counts(count_outcomes(levels, failures, trials, clusters), method)


def _check_method(method: str) -> None:
    if method not in METHODS:
        raise InvalidValueError(f"method must be one of {', '.join(METHODS)}, got {method!r}")


def fit_counts(counts: Counts, method: Method = "auto") -> LognormalFit:
    """Fit a lognormal fragility curve to outcomes that are counted already, or say why there is none."""
    _check_method(method)
    separation = separation_of(counts)
    if method == "maximum-likelihood" and separation is not Separation.OVERLAP:
        raise InvalidValueError(
            f'method must not be "maximum-likelihood" for these outcomes, whose likelihood has no maximum among'
            f" lognormal curves; {separation.value}"
        )
    if separation is not Separation.OVERLAP and not separation.step:
        return LognormalFit(counts, separation, "none")
    scale = LogScale.of(counts)
    curves = find_curves(
        counts.levels, scale, counts.failures[None], counts.trials[None], penalised=method == "penalised"
    )
    if not curves.found[0] and not curves.penalised[0]:
        raise InvalidValueError(
            "outcomes must overlap by more than rounding for a maximum to be proven, got levels of failures and"
            " survivals that all but coincide; round the levels"
        )
    if not curves.found[0] or abs(float(log_fractile(curves.theta, scale, 0.0)[0])) > LARGEST_LOGARITHM:
        return LognormalFit(counts, separation, "none")
    used: str = "penalised" if curves.penalised[0] else "maximum-likelihood"
    return LognormalFit(counts, separation, used, scale, curves)
