"""Quantiles of samples: the common definition of all summaries."""

from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.messages import Range

_ROUNDING = 9  # digits of a rank, because 0.28 * 25 is 7.000000000000001


def quantiles(values: Any, probabilities: Any, axis: int = 0) -> FloatArray:
    """Return quantiles of a sample along an axis, by definition 7 of Hyndman and Fan (the default of NumPy).

    The quantile is linear between the two neighbours in the sorted sample. The median of an even number of values is
    the mean of the two middle values. An infinite value, for example the peak rotation of an overturned body, is beyond
    all other values. A quantile between a finite and an infinite neighbour is infinite, because it exceeds the finite
    neighbour by an unknown amount.

    Parameters
    ----------
    values : array_like
        The sample. NaN is a missing value.
    probabilities : float or array_like
        Probabilities of the quantiles, from 0 to 1 [-].
    axis : int, optional
        Axis of the sample.

    Returns
    -------
    ndarray
        The quantiles, with the shape of the probabilities before the remaining axes. NaN if all values are missing, or
        if a quantile is between both infinities.

    Raises
    ------
    InvalidValueError
        If a probability is outside [0, 1].

    References
    ----------
    .. [1] Hyndman, R. J. and Fan, Y. (1996), Sample quantiles in statistical packages,
       doi:10.1080/00031305.1996.10473566.

    Examples
    --------
    >>> import math
    >>> quantiles([3.0, 1.0, 2.0, math.inf], [0.0, 0.5, 0.84]).tolist()
    [1.0, 2.5, inf]
    """
    probability = np.asarray(probabilities, dtype=np.float64)
    if not ((probability >= 0.0) & (probability <= 1.0)).all():
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {low:g} to {high:g}", parameter="probabilities",
            allowed=Range(0.0, 1.0), low=float(probability.min()), high=float(probability.max()),
        )  # fmt: skip
    ordered = np.moveaxis(np.sort(np.asarray(values, dtype=np.float64), axis=axis), axis, 0)  # NaN last
    last = (~np.isnan(ordered)).sum(axis=0) - 1
    if not len(ordered):
        return np.full(probability.shape + last.shape, np.nan)
    probability = probability.reshape(probability.shape + (1,) * last.ndim)
    rank = np.round(probability * np.maximum(last, 0), _ROUNDING)
    below, above = (
        np.take_along_axis(ordered, ends.astype(np.int64).reshape(-1, *last.shape), 0).reshape(rank.shape)
        for ends in (np.floor(rank), np.ceil(rank))
    )
    fraction = rank - np.floor(rank)
    with np.errstate(invalid="ignore"):  # infinity minus infinity, which is not selected
        between = np.where(np.isinf(below) | np.isinf(above), below + above, below + fraction * (above - below))
    return np.where(fraction == 0.0, below, between)
