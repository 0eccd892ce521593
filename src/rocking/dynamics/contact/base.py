"""A body on its two feet as the planar equations see it: levers, height and inertia per unit of mass.

The centre of mass moves by ``x`` to the right and ``z`` upwards, the body turns by theta clockwise. A foot at the lever
``d`` from the plumb line of the centre (``-b_left`` or ``+b_right``) then lies at ``r`` from the centre,

    r_x = d cos(theta) - h sin(theta),    r_z = -d sin(theta) - h cos(theta),

and moves with ``v_t = x' + r_z theta'`` along the ground and ``v_n = z' - r_x theta'`` away from it.
"""

import math
from dataclasses import dataclass

from rocking.bodies import Body
from rocking.errors import InvalidValueError

LEFT, RIGHT = -1, 1
BOTH = (LEFT, RIGHT)


@dataclass(frozen=True)
class PlaneBase:
    """Where the feet are, seen from the centre of mass."""

    mass: float  # mass m [kg]
    inertia: float  # polar moment about the centre over the mass, I_C / m [m2]
    height: float  # height h of the centre above the ground when the body stands [m]
    left: float  # left, right: horizontal distances of the feet from the centre, both above zero [m]
    right: float

    @classmethod
    def of_body(cls, body: Body) -> "PlaneBase":
        """Return the base of a body."""
        if not isinstance(body, Body):
            raise InvalidValueError(f"body must be a Block, Section or MassPoints, got {body!r:.60}")
        left, right = body.side("left"), body.side("right")
        mass = body.mass
        return cls(mass, body.moment_of_inertia / mass, right.centre_height, left.half_width, right.half_width)

    @property
    def width(self) -> float:
        """Distance between the feet [m]."""
        return self.left + self.right

    @property
    def size(self) -> float:
        """Larger distance from a foot to the centre [m]."""
        return math.hypot(max(self.left, self.right), self.height)

    def lever(self, foot: int) -> float:
        """Return the lever d of a foot.

        Returns below zero for the left foot [m].
        """
        return self.right if foot > 0 else -self.left

    def slenderness_angle(self, foot: int) -> float:
        """Return alpha = atan(b / h) of a side.

        Returns the angle [rad].
        """
        return math.atan2(abs(self.lever(foot)), self.height)

    def arm(self, foot: int, rotation: float) -> tuple[float, float]:
        """Return where a foot is, seen from the centre.

        rotation: theta [rad]. Returns to the right and upwards [m].
        """
        d, sine, cosine = self.lever(foot), math.sin(rotation), math.cos(rotation)
        return d * cosine - self.height * sine, -d * sine - self.height * cosine  # Eq. 58

    def rise_on(self, foot: int, rotation: float) -> float:
        """Return how far the centre is above its height at rest while a foot touches the ground.

        rotation: theta [rad]. Returns ``d sin(theta) - 2 h sin(theta / 2)^2``, exactly zero at theta = 0 [m].
        """
        return self.lever(foot) * math.sin(rotation) - 2.0 * self.height * math.sin(0.5 * rotation) ** 2  # Eq. 59
