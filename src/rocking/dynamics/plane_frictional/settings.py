"""Settings of the integration of a plane body that may slide, hop and fly, and settings of the ground."""

from dataclasses import dataclass
from functools import partial
from typing import Any

from rocking import checks
from rocking.dynamics.settings import BOUNCE_LAWS, NEVER_SLIDES, Settings, checked, checked_friction, ranged

_GROUND = {"friction", "normal_restitution", "normal_restitution_law"}
_BOUNCE = "a ratio of velocities, impulses or, squared, of energies; at 1 bounces never end"


@dataclass(frozen=True)
class ContactSettings(Settings):
    """Settings of the integration of a plane body with `friction`, and settings of the ground.

    Parameters
    ----------
    gravity, most_events
        See `Settings`; the same for all mechanics.
    rest_speed : float
        Speed after an impact / sqrt(g R) [-]. A slower bounce or rocking motion ends at the impact, which loses the
        energy of this motion.
    tolerance : float
        Bound on the last two terms of a Taylor step, divided by the angle alpha and the size R [-].
    friction : float
        Coulomb's coefficient between body and ground, from 0 to 1e6 [-]. With 1e6, feet never slide.
    normal_restitution : float
        Coefficient of normal restitution, in [0, 1) [-].
    normal_restitution_law : {"newton", "poisson", "stronge"}
        Definition of `normal_restitution`, as for `simulate`.
    """

    rest_speed: float = ranged(1e-7, 1e-12, 0.1, hint="with zero, bounces never end")
    tolerance: float = ranged(1e-15, 1e-17, 1e-3)
    friction: float = checked(NEVER_SLIDES, checked_friction)
    normal_restitution: float = ranged(0.0, 0.0, 1.0, open_high=True, hint=_BOUNCE)
    normal_restitution_law: str = checked("newton", partial(checks.one_of, allowed=BOUNCE_LAWS))

    @property
    def integration(self) -> dict[str, Any]:
        """Values by name, without the values of the ground."""
        return {name: value for name, value in self.stated.items() if name not in _GROUND}
