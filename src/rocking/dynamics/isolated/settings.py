"""Settings of the integration of a body on an isolated base."""

from dataclasses import dataclass

from rocking.dynamics.settings import Settings, ranged


@dataclass(frozen=True)
class IsolatedSettings(Settings):
    """Settings of the integration of a plane body on an isolated base.

    Parameters
    ----------
    gravity, most_events
        See `Settings`; the same for all mechanics.
    rest_speed : float
        Largest speed after an impact, over p alpha, at which the body comes to rest on the base, if the acceleration of
        the base does not lift the body at this time [-].
    tolerance : float
        Bound on the last two terms of a Taylor step, divided by the size of the motion [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> from rocking.dynamics import IsolatedSettings
    >>> IsolatedSettings(gravity=9.81).rest_speed
    0.0001
    """

    rest_speed: float = ranged(1e-4, 0.0, 0.1)
    tolerance: float = ranged(1e-15, 1e-17, 1e-3)
