"""Defaults of the placement of a body: level of its support, and horizontal position of its centre of mass."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.messages import Message

UNEVENNESS = ((0.1, 0.002), (1.0, 0.004), (4.0, 0.010), (10.0, 0.012), (15.0, 0.015))
INCLINATION = ((0.5, 0.003), (1.0, 0.006), (3.0, 0.008), (6.0, 0.012), (15.0, 0.016))
"""Length and allowed deviation of a finished floor [m]: gap below a straightedge between two high points (DIN 18202,
Table 3, row 3), and deviation from level (Table 2). Two assumptions are of this project: the slope is deviation /
length, and values between the lengths are interpolated."""

SHELF, PEDESTAL, ROAD = 0.016, math.radians(1.0), 0.025
"""Largest slopes [rad], as assumptions of this project. Shelf: end slope under uniform load, 3.2 x deflection / span,
with a deflection of 1/200 of the span. Pedestal: set by eye. Straight road: crossfall of 2.5 %; curves are steeper."""

OFFSET = 0.03
"""Largest horizontal offset of the centre of mass / half size of the body, equal to the value for its height [-]."""

OFFSET_REASON = Message(
    "horizontal position of the centre of mass: up to 3 % of the half size of the body, as for its height; smaller "
    "where the body would not remain in its pose"
)
_FLOOR = Message(
    "slope of a finished floor over the width of the base, from the tolerances of level and flatness of DIN 18202"
)
_REASONS = {
    "floor": _FLOOR,
    "shelf": Message("slope at the end of a shelf that deflects by 1/200 of its span"),
    "pedestal": Message("slope of a pedestal that is set by eye: up to 1 degree"),
    "road": Message("crossfall of a straight road: up to 2.5 %"),
}
SUPPORTS = tuple(_REASONS)
FARTHEST = 0.9
"""Largest distance of the plumb line from its nominal position / distance of the edge of the base [-]."""

STEEPEST = 0.5
"""Largest slope that is accepted [rad]."""


def floor_slope(width: float) -> float:
    """Return the largest slope of a finished floor over a width [m], in rad.

    >>> [round(floor_slope(width), 4) for width in (0.05, 0.1, 1.0, 4.0)]
    [0.02, 0.02, 0.006, 0.0025]
    """
    return max(_slope(width, UNEVENNESS), _slope(width, INCLINATION))


def _slope(width: float, allowed: Sequence[tuple[float, float]]) -> float:
    lengths, deviations = zip(*allowed, strict=True)
    length = min(max(width, lengths[0]), lengths[-1])
    return float(np.interp(length, lengths, deviations) / length)


def level_default(stated: Any, width: float) -> tuple[tuple[float, float] | None, Message]:
    """Return the range of slopes of a named support (default: floor), and its reason; None for a stated input."""
    name = "floor" if stated is None else stated
    if not isinstance(name, str):
        return None, _FLOOR
    checks.one_of("level", name, SUPPORTS)
    slope = {"floor": floor_slope(width), "shelf": SHELF, "pedestal": PEDESTAL, "road": ROAD}[name]
    return (-slope, slope), _REASONS[name]
