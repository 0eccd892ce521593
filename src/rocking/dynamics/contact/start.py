"""How a body is let go: turned, lifted, pushed."""

import math
from dataclasses import dataclass

from rocking import checks
from rocking.dynamics.contact.base import BOTH, LEFT, RIGHT, PlaneBase
from rocking.dynamics.contact.state import ContactState


@dataclass(frozen=True)
class Start:
    """Position and velocity at time zero, relative to the ground.

    Parameters
    ----------
    rotation : float
        theta, within a quarter turn; the body stands on the lower foot [rad].
    angular_velocity : float
        theta' [rad/s].
    horizontal_velocity : float
        Of the lower foot, to the right [m/s].
    height : float
        Of the lower foot above the ground [m].
    vertical_velocity : float
        Of the lower foot, upwards [m/s].

    Raises
    ------
    InvalidValueError
        If a value is not finite, the rotation is beyond a quarter turn, or the height is negative.

    Examples
    --------
    >>> Start(rotation=0.1).height
    0.0
    """

    rotation: float = 0.0
    angular_velocity: float = 0.0
    horizontal_velocity: float = 0.0
    height: float = 0.0
    vertical_velocity: float = 0.0

    def __post_init__(self) -> None:
        """Check every value."""
        half = 0.5 * math.pi
        checks.within(
            "rotation", self.rotation, -half, half, unit="rad", open_low=True, open_high=True, hint="degrees?"
        )
        checks.within("angular_velocity", self.angular_velocity, -1e4, 1e4, unit="rad/s", hint="degrees?")
        checks.within("horizontal_velocity", self.horizontal_velocity, -1e4, 1e4, unit="m/s")
        checks.within("height", self.height, 0.0, 1e4, unit="m", hint="the ground is at zero")
        checks.within("vertical_velocity", self.vertical_velocity, -1e4, 1e4, unit="m/s")

    def state(self, base: PlaneBase) -> ContactState:
        """Return the state of the centre of mass.

        Parameters
        ----------
        base : PlaneBase
            The body.

        Returns
        -------
        State
            Its state; x is zero where the body would stand upright on the same foot.
        """
        turned = self.rotation or self.angular_velocity
        foot = RIGHT if turned > 0.0 else LEFT
        r_x, r_z = base.arm(foot, self.rotation)
        touching: tuple[int, ...] = ()
        if self.height == 0.0:
            touching = BOTH if self.rotation == 0.0 else (foot,)
        spin = self.angular_velocity
        return ContactState(
            base.lever(foot) - r_x,
            base.rise_on(foot, self.rotation) + self.height,
            self.rotation,
            self.horizontal_velocity - r_z * spin,
            self.vertical_velocity + r_x * spin,
            spin,
            touching,
        )
