"""Settings of the integration of a 3D body without slip, for one history or many."""

from dataclasses import dataclass

from rocking.dynamics.settings import SHORTEST_STEP, Settings, counted, ranged


@dataclass(frozen=True)
class SpaceSettings(Settings):
    """Settings of the integration of one history of a 3D body without `friction`.

    Parameters
    ----------
    gravity, most_events
        See `Settings`; the same for all mechanics.
    rest_speed : float
        Speed / sqrt(g R) [-]. A vertex that opens more slowly and would close at once stays in contact. The body
        comes to rest if the ratio of its energy to the energy of overturning is below the square of this speed.
    longest_step : float
        Longest Taylor step, as the product of p and time [-].
    order : int
        Highest order of the Taylor series, from 2 to 40.
    tolerance : float
        Bound on the last two terms of a Taylor step, for quaternions of unit length [-].
    """

    most_events: int = counted(100_000, 1, 10_000_000)
    rest_speed: float = ranged(1e-5, 1e-7, 0.01)
    longest_step: float = ranged(1.0, SHORTEST_STEP, 1.0)
    order: int = counted(28, 2, 40)
    tolerance: float = ranged(1e-17, 1e-20, 1e-2)


@dataclass(frozen=True)
class SpaceBatchSettings(Settings):
    """Settings of the integration of many histories of 3D bodies without `friction`.

    Parameters
    ----------
    gravity, most_events, rest_speed
        See `SpaceSettings`; the same as for one history.
    longest_step : float
        Longest Taylor step, as the product of p + ``|angular velocity|`` and time [-].
    tolerance : float
        See `SpaceSettings`; the same as for one history [-].
    """

    most_events: int = counted(100_000, 1, 10_000_000)
    rest_speed: float = ranged(1e-5, 1e-7, 0.01)
    longest_step: float = ranged(0.6, SHORTEST_STEP, 1.0)
    tolerance: float = ranged(1e-13, 1e-20, 1e-2)
