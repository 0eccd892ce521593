"""Settings of the integration of a plane body with restraints."""

from dataclasses import dataclass

from rocking.dynamics.plane.settings import checked_linear
from rocking.dynamics.settings import Settings, checked, ranged


@dataclass(frozen=True)
class RestrainedSettings(Settings):
    """Settings of the integration of a plane body with restraints.

    Parameters
    ----------
    gravity, most_events
        As for all mechanics, `Settings`.
    linear : bool
        True for the slender-linear equations, with small rotations also in the elongations.
    rest_speed : float
        Largest speed after an impact, over p alpha, for which rest is considered [-]. Rest follows only if the next
        impacts provably decay before the next uplift.
    tolerance : float
        Bound on the last two terms of a Taylor step, over the angle alpha [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> from rocking.dynamics import RestrainedSettings
    >>> RestrainedSettings(gravity=9.81).linear
    False
    """

    linear: bool = checked(False, checked_linear)
    rest_speed: float = ranged(0.001, 0.0, 0.1, hint="the sum of impacts holds for small speeds")
    tolerance: float = ranged(1e-15, 1e-17, 1e-3)
