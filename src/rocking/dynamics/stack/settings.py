"""Settings of the integration of a stack."""

from dataclasses import dataclass

from rocking.dynamics.settings import Settings, ranged


@dataclass(frozen=True)
class StackSettings(Settings):
    """Settings of the integration of a stack.

    Parameters
    ----------
    gravity, most_events
        See `Settings`; the same for all mechanics.
    longest_step : float
        Longest step over sqrt(R / g) of the smallest body, with R its semi-diagonal [-]. The reference engine uses
        steps up to 40 times longer.
    rest_speed : float
        Largest speed of opening after an impact, over p alpha of the bodies above the joint, for which the joint closes
        [-].
    tolerance : float
        Tolerance of the complementarity conditions of a step, over the largest impulse [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> from rocking.dynamics import StackSettings
    >>> StackSettings(gravity=9.81).rest_speed
    0.001
    """

    longest_step: float = ranged(0.0005, 1e-6, 0.01)
    rest_speed: float = ranged(0.001, 0.0, 0.1)
    tolerance: float = ranged(1e-9, 1e-14, 1e-3)
