"""What an engine is told beside the body and the motion."""

from dataclasses import dataclass

from rocking import checks, conventions
from rocking.errors import InvalidValueError

ORDERS = (4, 6, 8)
"""Orders that the fast engine has been compiled for."""

SHORTEST_STEP = 1e-6
"""Least `Settings.longest_step` [-]."""


@dataclass(frozen=True)
class Settings:
    """How to integrate.

    Parameters
    ----------
    gravity : float
        Acceleration of gravity [m/s2].
    linear : bool
        Slender-linear equations: sine and cosine of the angles replaced by angle and one.
    rest_speed : float
        Speed after an impact, over p alpha, below which the impacts to come may be summed up to rest instead of being
        resolved one by one; that is done only where they provably end before the body could rise again [-].
    most_impacts : int
        A history with more impacts is stopped, with a status that says so.
    longest_step : float
        Longest Taylor step of the fast engine as p times time [-].
    order : {4, 6, 8}
        Order of the fast engine. Orders 4 and 6 exist only for many histories at once (`simulate_many`), with the
        nonlinear equations and motions without a vertical part; elsewhere they are refused. The reference engine
        chooses its own order.
    tolerance : float
        Bound on the last two terms of a Taylor step of the reference engine, over the angle alpha [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    gravity: float = conventions.g
    linear: bool = False
    rest_speed: float = 0.001
    most_impacts: int = 100_000
    longest_step: float = 0.15
    order: int = 8
    tolerance: float = 1e-15

    def __post_init__(self) -> None:
        """Check every value."""
        checks.within("gravity", self.gravity, 0.0, 1e6, unit="m/s2", open_low=True)
        checks.within("rest_speed", self.rest_speed, 0.0, 0.1, hint="the flights must be short for the sum to hold")
        checks.within("longest_step", self.longest_step, SHORTEST_STEP, 1.0)
        checks.within("tolerance", self.tolerance, 1e-17, 1e-3)
        most: object = self.most_impacts
        if isinstance(most, bool) or not isinstance(most, int) or most < 1:
            raise InvalidValueError(f"most_impacts must be a whole number >= 1, got {self.most_impacts!r}")
        linear: object = self.linear
        if not isinstance(linear, bool):
            raise InvalidValueError(f"linear must be True or False, got {self.linear!r}")
        order: object = self.order
        if isinstance(order, bool) or not isinstance(order, int) or order not in ORDERS:
            raise InvalidValueError(f"order must be one of {ORDERS}, got {self.order!r}")
