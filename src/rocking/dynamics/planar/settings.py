"""What the planar engine is told beside the body, the motion and the contact."""

from dataclasses import dataclass

from rocking import checks, conventions, plausibility
from rocking.errors import InvalidValueError


@dataclass(frozen=True)
class PlanarSettings:
    """How to integrate.

    Parameters
    ----------
    gravity : float
        Acceleration of gravity [m/s2].
    rest_speed : float
        Speed over sqrt(g R) below which a bounce, or a rocking motion after an impact, ends at once; its energy is
        booked as lost in that impact [-].
    most_events : int
        A history with more impacts and changes of regime is stopped, with a status that says so.
    tolerance : float
        Bound on the last two terms of a Taylor step, over the angle alpha and the size R [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    gravity: float = conventions.g
    rest_speed: float = 1e-7
    most_events: int = 100_000
    tolerance: float = 1e-15

    def __post_init__(self) -> None:
        """Check every value."""
        checks.within("gravity", self.gravity, 0.0, 1e6, unit="m/s2", open_low=True)
        checks.within("rest_speed", self.rest_speed, 1e-12, 0.1, hint="bounces accumulate: zero would never end")
        checks.within("tolerance", self.tolerance, 1e-17, 1e-3)
        most: object = self.most_events
        if isinstance(most, bool) or not isinstance(most, int) or most < 1:
            raise InvalidValueError(f"most_events must be a whole number >= 1, got {most!r:.60}")
        plausibility.warn(plausibility.of_gravity(self.gravity))


@dataclass(frozen=True)
class GroundContact:
    """What happens where the feet touch the ground.

    Parameters
    ----------
    friction : float
        Coulomb coefficient mu, the same for sticking and sliding [-].
    bounce : float
        Newton's coefficient e_N of normal restitution, 0 for plastic impacts [-].
    restitution : tuple of float, optional
        Imposed coefficients theta_dot_after / theta_dot_before for landing left and right, which replace the
        complementarity problem at rocking impacts [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    friction: float
    bounce: float = 0.0
    restitution: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        """Check every value."""
        checks.within("friction", self.friction, 0.0, 1e6, hint="1e6 for feet that never slide")
        hint = "a ratio of normal velocities; at 1 bounces never end"
        checks.within("bounce", self.bounce, 0.0, 1.0, open_high=True, hint=hint)
        plausibility.warn(plausibility.of_friction(self.friction))
