"""Defaults of the placement of a body: level of its support, and horizontal position of its centre of mass."""

import math
from typing import Any

import numpy as np

from rocking import checks
from rocking.messages import Message

UNEVENNESS = ((0.1, 0.002), (1.0, 0.004), (4.0, 0.010), (10.0, 0.012))
"""Distance of two points of a finished floor, and the allowed deviation from level or flat between both [m]:
DIN 18202:2013, Table 3, row 3; values between are interpolated."""

SHELF, PEDESTAL, ROAD = 0.016, math.radians(1.0), 0.025
"""Largest slopes [rad]: end of a shelf with uniform load whose deflection is 1/200 of its span (3.2 x deflection over
span); a pedestal set by eye; usual crossfall of roads, 2.5 %."""

OFFSET = 0.03
"""Largest offset of the centre of mass over the half size of the body, as for its height [-]."""

OFFSET_REASON = Message(
    "horizontal position of the centre of mass: up to 3 % of the half size of the body, as for its height; smaller "
    "where the body would not remain in its pose"
)
_FLOOR = Message("slope of a finished floor over the width of the base by DIN 18202, Table 3, row 3")
_REASONS = {
    "floor": _FLOOR,
    "shelf": Message("slope at the end of a shelf that deflects by 1/200 of its span"),
    "pedestal": Message("slope of a pedestal that is set by eye: up to 1 degree"),
    "road": Message("crossfall of a road: up to 2.5 %"),
}
SUPPORTS = tuple(_REASONS)
FARTHEST = 0.9
"""Largest distance of the plumb line from its nominal position over the distance of the edge of the base [-]."""

STEEPEST = 0.5
"""Largest slope that is accepted [rad]."""


def floor_slope(width: float) -> float:
    """Return the largest slope of a finished floor over a width [m], in rad.

    >>> [round(floor_slope(width), 4) for width in (0.05, 0.1, 1.0, 4.0)]
    [0.02, 0.02, 0.004, 0.0025]
    """
    distances, deviations = zip(*UNEVENNESS, strict=True)
    length = min(max(width, distances[0]), distances[-1])
    return float(np.interp(length, distances, deviations)) / length


def level_default(stated: Any, width: float) -> tuple[tuple[float, float] | None, Message]:
    """Return the range of slopes of a named support, the floor by default, and its reason; None for a stated input."""
    name = "floor" if stated is None else stated
    if not isinstance(name, str):
        return None, _FLOOR
    checks.one_of("level", name, SUPPORTS)
    slope = {"floor": floor_slope(width), "shelf": SHELF, "pedestal": PEDESTAL, "road": ROAD}[name]
    return (-slope, slope), _REASONS[name]
