"""Settings of the integration of a body on the vertices of its convex hull."""

from dataclasses import dataclass

from rocking.dynamics.settings import NEVER_SLIDES, Settings, checked, checked_friction, counted, ranged


@dataclass(frozen=True)
class HullSettings(Settings):
    """Settings of the integration of a 3D body with `friction`.

    Parameters
    ----------
    gravity, most_events
        See `Settings`; the same for all mechanics.
    rest_speed : float
        Speed / sqrt(g size) [-]. A body comes to rest if its energy / (m g size) is below the square of this speed.
        The square is 1e-11 or more, because smaller gaps count as closed.
    tolerance : float
        Bound on the local error of a step of order 5 [-]. Errors are relative to the size of the body, to one radian,
        and to the rates of both.
    friction : float
        Coulomb's coefficient between body and ground, from 0 to 1e6 [-]. With 1e6, the body never slides.
    """

    most_events: int = counted(100_000, 1, 10_000_000)
    rest_speed: float = ranged(1e-5, 1e-7, 0.01)
    tolerance: float = ranged(1e-12, 1e-15, 1e-2)
    friction: float = checked(NEVER_SLIDES, checked_friction)
