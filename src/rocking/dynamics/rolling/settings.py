"""Settings of the integration of a body in space without slip, for one history or many."""

from dataclasses import dataclass

from rocking.dynamics.settings import SHORTEST_STEP, Settings, counted, ranged


@dataclass(frozen=True)
class SpaceSettings(Settings):
    """Settings of the integration of one history of a body in space without `friction`.

    Parameters
    ----------
    gravity, most_events
        As for all mechanics, `Settings`.
    rest_speed : float
        Speed over sqrt(g R); a vertex that opens more slowly and would close at once stays in contact. Its square is
        the energy over that of overturning at which a body comes to rest [-].
    longest_step : float
        Longest Taylor step as p times time [-].
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
    """Settings of the integration of many histories of bodies in space without `friction`.

    Parameters
    ----------
    gravity, most_events, rest_speed
        As for one history, `SpaceSettings`.
    longest_step : float
        Longest Taylor step as p + ``|angular velocity|`` times time [-].
    tolerance : float
        As for one history, `SpaceSettings` [-].
    """

    most_events: int = counted(100_000, 1, 10_000_000)
    rest_speed: float = ranged(1e-5, 1e-7, 0.01)
    longest_step: float = ranged(0.6, SHORTEST_STEP, 1.0)
    tolerance: float = ranged(1e-13, 1e-20, 1e-2)
