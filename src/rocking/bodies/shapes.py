"""Outlines of common shapes on the ground, for regions."""

import math

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray


def rectangle(width: float, height: float) -> FloatArray:
    """Return the outline of a rectangle on 0 <= x <= width.

    Parameters
    ----------
    width, height : float
        Full width and height [m].

    Returns
    -------
    ndarray, shape (4, 2)
        Vertices, counter-clockwise [m].

    Examples
    --------
    >>> rectangle(1.0, 2.0).tolist()
    [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]]
    """
    w, h = checks.positive("width", width, "m"), checks.positive("height", height, "m")
    return np.array([(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)])


def trapezoid(base: float, top: float, height: float, lean: float = 0.0) -> FloatArray:
    """Return the outline of a trapezoid on 0 <= x <= base.

    Parameters
    ----------
    base, top, height : float
        Width at the ground, width at the top, height [m].
    lean : float
        Horizontal offset of the middle of the top from the middle of the base, positive to the right [m].

    Returns
    -------
    ndarray, shape (4, 2)
        Vertices, counter-clockwise [m].

    Examples
    --------
    >>> trapezoid(1.0, 0.5, 2.0).tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.75, 2.0], [0.25, 2.0]]
    """
    w, t = checks.positive("base", base, "m"), checks.positive("top", top, "m")
    h, middle = checks.positive("height", height, "m"), 0.5 * w + checks.number("lean", lean, "m")
    return np.array([(0.0, 0.0), (w, 0.0), (middle + 0.5 * t, h), (middle - 0.5 * t, h)])


def ellipse(width: float, height: float, sides: int = 64) -> FloatArray:
    """Return an ellipse as an inscribed polygon with its lowest side on the ground.

    Parameters
    ----------
    width, height : float
        Full axes of the ellipse [m].
    sides : int
        Number of sides, at least 3 [-].

    Returns
    -------
    ndarray, shape (sides, 2)
        Vertices, counter-clockwise, centred on x = 0 [m].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> float(ellipse(2.0, 4.0, sides=8)[:, 1].min())
    0.0
    """
    w, h = checks.positive("width", width, "m"), checks.positive("height", height, "m")
    sides = checks.whole("sides", sides, 3)
    angle = -0.5 * math.pi + 2.0 * math.pi / sides * (np.arange(sides) + 0.5)
    x, y = 0.5 * w * np.cos(angle), 0.5 * h * np.sin(angle)
    y = y - y.min()
    # the two lowest vertices are exact mirror images, so that rounding does not tilt the base
    y[[0, -1]] = 0.0
    return np.column_stack([x, y])


def regular_polygon(sides: int, radius: float) -> FloatArray:
    """Return a regular polygon with one side on the ground.

    Parameters
    ----------
    sides : int
        Number of sides, at least 3 [-].
    radius : float
        Radius of the circle through the vertices [m].

    Returns
    -------
    ndarray, shape (sides, 2)
        Vertices, counter-clockwise, centred on x = 0 [m].

    Examples
    --------
    >>> regular_polygon(4, 1.0).round(6).tolist()[1]
    [0.707107, 1.414214]
    """
    diameter = 2.0 * checks.positive("radius", radius, "m")
    return ellipse(diameter, diameter, sides)
