"""What happens where the feet touch the ground."""

from dataclasses import dataclass

from rocking import checks, plausibility


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
