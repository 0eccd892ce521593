"""One way a body can rock: about its left or about its right foot."""

import math
from dataclasses import dataclass

from rocking import conventions
from rocking.conventions import Foot


@dataclass(frozen=True, slots=True)
class Side:
    """A body seen from one of its feet.

    Parameters
    ----------
    foot : {"left", "right"}
        The foot it turns about.
    half_width : float
        Horizontal distance b from the foot to the centre of mass [m].
    centre_height : float
        Height h of the centre of mass above the ground [m].
    mass : float
        Mass m [kg].
    moment_of_inertia : float
        Polar moment I_O about the foot [kg m2].
    gravity : float
        Acceleration of gravity [m/s2].

    Examples
    --------
    >>> from rocking import Block
    >>> round(Block(width=1.0, height=4.0).side("left").slenderness_ratio, 12)
    4.0
    """

    foot: Foot
    half_width: float
    centre_height: float
    mass: float
    moment_of_inertia: float
    gravity: float = conventions.g

    @property
    def slenderness_ratio(self) -> float:
        """Slenderness h/b [-]."""
        return self.centre_height / self.half_width

    @property
    def slenderness_angle(self) -> float:
        """Angle alpha = atan(b/h) between the vertical and the line from foot to centre [rad]."""
        return math.atan2(self.half_width, self.centre_height)

    @property
    def semi_diagonal(self) -> float:
        """Distance R from the foot to the centre of mass [m]."""
        return math.hypot(self.half_width, self.centre_height)

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter p = sqrt(m g R / I_O) [rad/s]."""
        return math.sqrt(self.mass * self.gravity * self.semi_diagonal / self.moment_of_inertia)  # Eq. 26

    @property
    def uplift_acceleration(self) -> float:
        """Horizontal ground acceleration g b/h that starts rocking about this foot [m/s2]."""
        return self.gravity * self.half_width / self.centre_height
