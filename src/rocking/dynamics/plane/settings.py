"""Settings of the integration of a plane body that neither slides nor flies."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.dynamics.settings import SHORTEST_STEP, Settings, checked, ranged
from rocking.errors import InvalidValueError

ORDERS = (4, 6, 8)  # orders of the fast engine


def checked_linear(_: str, value: object) -> bool:
    """Return a flag; an error for another value."""
    if not isinstance(value, bool):
        raise InvalidValueError(parameter="linear", allowed="True or False", value=value)
    return value


def _checked_order(_: str, value: Any) -> int:
    if not isinstance(value, (int, np.integer)) or value not in ORDERS:
        raise InvalidValueError("order must be one of {orders}, got {number}", orders=ORDERS, number=f"{value!r:.60}")
    return int(value)


@dataclass(frozen=True)
class PlaneSettings(Settings):
    """Settings of the integration of a plane body without `friction`.

    Parameters
    ----------
    gravity, most_events
        As for all mechanics, `Settings`.
    linear : bool
        Slender-linear equations: sine and cosine of the angles replaced by angle and one.
    rest_speed : float
        Speed after an impact, over p alpha. After a slower impact, the remaining impacts are summed up to rest instead
        of resolved one by one, if these impacts provably end before the body could rise again [-].
    longest_step : float
        Longest Taylor step of the fast engine as p times time [-].
    order : int
        Order of the Taylor series of the fast engine: 4, 6 or 8. With order 8, records with short time steps are
        integrated with order 6, if its truncation error is below a hundredth of that of order 8 at the longest step.
        Orders 4 and 6 apply only to many histories (`simulate_many`), the nonlinear equations, and motions without a
        vertical component. The reference engine chooses its own order.
    tolerance : float
        Bound on the last two terms of a Taylor step over the angle alpha [-].
    """

    linear: bool = checked(False, checked_linear)
    rest_speed: float = ranged(0.001, 0.0, 0.1, hint="the sum of impacts holds for small speeds")
    longest_step: float = ranged(0.15, SHORTEST_STEP, 1.0)
    order: int = checked(8, _checked_order)
    tolerance: float = ranged(1e-15, 1e-17, 1e-3)
