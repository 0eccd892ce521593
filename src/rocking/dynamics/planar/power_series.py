"""Power series as arrays of coefficients: derivatives, integrals, values."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.portable import convolved


def padded(series: list[float] | FloatArray, size: int) -> FloatArray:
    """Return a series with zeros after it.

    Parameters
    ----------
    series : list of float or ndarray
        Coefficients from the power 0.
    size : int
        How many in all.

    Returns
    -------
    ndarray
        A new array.
    """
    made = np.zeros(size)
    made[: len(series)] = series[:size]
    return made


def derivative(series: FloatArray) -> FloatArray:
    """Return the derivative of a series, of the same length.

    Parameters
    ----------
    series : ndarray
        Coefficients from the power 0.

    Returns
    -------
    ndarray
        Coefficients from the power 0.
    """
    made = np.zeros(series.size)
    made[:-1] = series[1:] * np.arange(1, series.size)
    return made


def value(series: FloatArray, at: float) -> float:
    """Return the value of a series.

    Parameters
    ----------
    series : ndarray
        Coefficients from the power 0.
    at : float
        Where.

    Returns
    -------
    float
        The value.
    """
    total = 0.0
    for c in series[::-1].tolist():
        total = total * at + c
    return total


def integral(first: FloatArray, second: FloatArray, at: float) -> float:
    """Return the integral of a product of series from 0 to an instant.

    Parameters
    ----------
    first, second : ndarray
        Coefficients from the power 0.
    at : float
        Upper end.

    Returns
    -------
    float
        The integral.
    """
    product = convolved(first, second)
    return at * value(product / np.arange(1, product.size + 1), at)


def twice(acceleration: FloatArray, start: float, rate: float, unit: float) -> FloatArray:
    """Return the position that follows from an acceleration.

    Parameters
    ----------
    acceleration : ndarray
        Coefficients over a unit of time [m/s2].
    start, rate : float
        Position [m] and velocity [m/s] at the start.
    unit : float
        The unit of time [s].

    Returns
    -------
    ndarray
        Coefficients of the position, as many [m].
    """
    made = np.zeros(acceleration.size)
    made[0], made[1] = start, rate * unit
    k = np.arange(2, acceleration.size)
    made[2:] = acceleration[:-2] * unit**2 / (k * (k - 1))
    return made
