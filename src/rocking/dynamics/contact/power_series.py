"""Power series as arrays of coefficients: derivatives, integrals, values."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.portable import convolved


def padded(series: list[float] | FloatArray, size: int) -> FloatArray:
    """Return a series with zeros after it."""
    made = np.zeros(size)
    made[: len(series)] = series[:size]
    return made


def derivative(series: FloatArray) -> FloatArray:
    """Return the derivative of a series, of the same length."""
    made = np.zeros(series.size)
    made[:-1] = series[1:] * np.arange(1, series.size)
    return made


def value(series: FloatArray, at: float) -> float:
    """Return the value of a series."""
    total = 0.0
    for c in series[::-1].tolist():
        total = total * at + c
    return total


def integral(first: FloatArray, second: FloatArray, at: float) -> float:
    """Return the integral of a product of series from 0 to an instant."""
    product = convolved(first, second)
    return at * value(product / np.arange(1, product.size + 1), at)


def twice(acceleration: FloatArray, start: float, rate: float, unit: float) -> FloatArray:
    """Return the position that follows from an acceleration.

    acceleration: coefficients over a unit of time [m/s2]; start, rate: position [m] and velocity [m/s] at the start;
    unit: the unit of time [s]. Returns coefficients of the position, as many [m].
    """
    made = np.zeros(acceleration.size)
    made[0], made[1] = start, rate * unit
    k = np.arange(2, acceleration.size)
    made[2:] = acceleration[:-2] * unit**2 / (k * (k - 1))
    return made
