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
        See `Settings`; the same for all mechanics.
    linear : bool
        True for the slender-linear equations. The elongations then also assume small rotations.
    rest_speed : float
        Largest speed after an impact, over p alpha, for which rest is considered [-]. The body comes to rest only if it
        is proven that the next impacts decay before the next uplift.
    tolerance : float
        Bound on the last two terms of a Taylor step, divided by the angle alpha [-].

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
