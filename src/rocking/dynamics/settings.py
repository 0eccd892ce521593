"""What an engine is told beside the body and the motion."""

from dataclasses import dataclass

import numpy as np

from rocking import checks, conventions, plausibility
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
        Order of the fast engine. With order 8, records whose samples are so close that order 6 leaves out less than a
        hundredth of what order 8 may leave out at the longest step are followed with order 6, under many g only if they
        are closer still. Orders 4 and 6 by themselves exist only for many histories at once (`simulate_many`), with the
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
        hint = "the flights must be short for the sum to hold"
        made: dict[str, float] = {
            "gravity": checks.within("gravity", self.gravity, 0.0, 1e6, unit="m/s2", open_low=True),
            "rest_speed": checks.within("rest_speed", self.rest_speed, 0.0, 0.1, hint=hint),
            "longest_step": checks.within("longest_step", self.longest_step, SHORTEST_STEP, 1.0),
            "tolerance": checks.within("tolerance", self.tolerance, 1e-17, 1e-3),
            "most_impacts": _whole("most_impacts", self.most_impacts),
            "order": _whole("order", self.order),
        }
        linear: object = self.linear
        if not isinstance(linear, bool):
            raise InvalidValueError(f"linear must be True or False, got {self.linear!r}")
        if made["order"] not in ORDERS:
            raise InvalidValueError(f"order must be one of {ORDERS}, got {self.order!r}")
        for name, value in made.items():  # numbers of one kind: 9 and 9.0 are the same settings
            object.__setattr__(self, name, value)
        plausibility.warn(plausibility.of_gravity(self.gravity))


def _whole(name: str, value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
        allowed = f"one of {ORDERS}" if name == "order" else "a whole number >= 1"
        raise InvalidValueError(f"{name} must be {allowed}, got {value!r:.60}")
    return int(value)
