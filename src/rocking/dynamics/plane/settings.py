"""Settings of the integration of a plane body that neither slides nor flies."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking.dynamics.settings import SHORTEST_STEP, Settings, checked, ranged
from rocking.errors import InvalidValueError

ORDERS = (4, 6, 8)  # orders of the fast engine


def checked_linear(_: str, value: object) -> bool:
    """Return True or False. Raise an error for another value."""
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
        See `Settings`; the same for all mechanics.
    linear : bool
        True for the slender-linear equations, in which the angle replaces its sine, and 1 replaces its cosine.
    rest_speed : float
        Speed after an impact / (p alpha) [-]. After a slower impact, the remaining impacts are not computed one by
        one: the engine sums them up to rest, if it is proven that they end before the body can rise again.
    longest_step : float
        Longest Taylor step of the fast engine, as the product of p and time [-].
    order : int
        Order of the Taylor series of the fast engine: 4, 6 or 8. With order 8, records with short time steps are
        integrated with order 6, if the truncation error of order 6 is below 1/100 of the error of order 8 at the
        longest step. Orders 4 and 6 apply only to many histories (`simulate_many`), to the nonlinear equations, and to
        motions without a vertical component. The reference engine chooses the order itself.
    tolerance : float
        Bound on the last two terms of a Taylor step, divided by the slenderness angle [-].
    """

    linear: bool = checked(False, checked_linear)
    rest_speed: float = ranged(0.001, 0.0, 0.1, hint="the sum of impacts holds for small speeds")
    longest_step: float = ranged(0.15, SHORTEST_STEP, 1.0)
    order: int = checked(8, _checked_order)
    tolerance: float = ranged(1e-15, 1e-17, 1e-3)
