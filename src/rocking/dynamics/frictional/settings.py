"""Settings of the integration of a body on the vertices of its convex hull."""

from dataclasses import dataclass

from rocking.dynamics.settings import NEVER_SLIDES, Settings, checked, checked_friction, counted, ranged


@dataclass(frozen=True)
class HullSettings(Settings):
    """Settings of the integration of a body in space with `friction`.

    Parameters
    ----------
    gravity, most_events
        As for all mechanics, `Settings`.
    rest_speed : float
        Speed over sqrt(g size); its square is the energy over m g size at which a body comes to rest, at least 1e-11,
        since smaller gaps count as closed [-].
    tolerance : float
        Bound on the local error of a step of order 5, over size, radian and their rates [-].
    friction : float
        Coulomb's coefficient between body and ground, from 0 to 1e6; 1e6 for a body that never slides [-].
    """

    most_events: int = counted(100_000, 1, 10_000_000)
    rest_speed: float = ranged(1e-5, 1e-7, 0.01)
    tolerance: float = ranged(1e-12, 1e-15, 1e-2)
    friction: float = checked(NEVER_SLIDES, checked_friction)
