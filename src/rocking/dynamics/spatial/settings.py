"""What the engine in space is told beside the body and the motion."""

from dataclasses import dataclass

import numpy as np

from rocking import checks, conventions, plausibility
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class SpatialSettings:
    """How to integrate a body in space.

    Parameters
    ----------
    gravity : float
        Acceleration of gravity [m/s2].
    rest_speed : float
        Speed, over sqrt(g R), at which a vertex that leaves the ground and would fall back at once is taken to stay;
        its square is the energy, over that of overturning, at which a body comes to rest [-].
    most_events : int
        A history with more impacts and changes of contact is stopped, with a status that says so.
    order : int
        Highest order of the Taylor series [-].
    tolerance : float
        Bound on the last two terms of a step, for quaternions of unit length [-].
    longest_step : float
        Longest step as p times time [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    gravity: float = conventions.g
    rest_speed: float = 1e-5
    most_events: int = 100_000
    order: int = 28
    tolerance: float = 1e-17
    longest_step: float = 1.0

    def __post_init__(self) -> None:
        """Check every value."""
        made: dict[str, float] = {
            "gravity": checks.within("gravity", self.gravity, 0.0, 1e6, unit="m/s2", open_low=True),
            "rest_speed": checks.within("rest_speed", self.rest_speed, 1e-7, 0.01),
            "tolerance": checks.within("tolerance", self.tolerance, 1e-20, 1e-2),
            "longest_step": checks.within("longest_step", self.longest_step, 1e-6, 1.0),
            "most_events": _whole("most_events", self.most_events, 1, 10_000_000),
            "order": _whole("order", self.order, 2, 40),
        }
        for name, value in made.items():
            object.__setattr__(self, name, value)
        plausibility.warn(plausibility.of_gravity(self.gravity))


def _whole(name: str, value: object, low: int, high: int) -> int:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not low <= value <= high:
        raise InvalidValueError(f"{name} must be a whole number in [{low}, {high}], got {value!r:.60}")
    return int(value)
