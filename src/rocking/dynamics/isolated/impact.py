"""Impact of a body on a base that moves: balances of momentum of the whole system, with friction of the base."""

import math
from dataclasses import dataclass

from rocking.bodies.isolated import Isolated
from rocking.dynamics.parameters import RockingSide


@dataclass(frozen=True, slots=True)
class ImpactSystem:
    """Masses and levers of an impact onto one foot. `side` is +1 for the right foot."""

    side: int
    mass: float  # mass of the body [kg]
    base_mass: float  # [kg]
    inertia: float  # moment of inertia about the centre of mass [kg m2]
    height: float  # height of the centre of mass [m]
    old: float  # old, new: distances of the feet from the plumb line of the centre of mass [m]
    new: float
    friction: float  # coefficient of friction of the base [-]

    @classmethod
    def of(cls, side: int, body: Isolated, old: RockingSide, new: RockingSide) -> "ImpactSystem":
        """Return the impact onto a foot from the parameters of both sides."""
        levers = [item.semi_diagonal * math.sin(item.slenderness_angle) for item in (old, new)]
        height = new.semi_diagonal * math.cos(new.slenderness_angle)
        inertia = body.mass * new.semi_diagonal**2 * (1.0 / new.inertia_ratio - 1.0)
        return cls(side, body.mass, body.base_mass, inertia, height, levers[0], levers[1], body.friction)

    def position(self, coefficient: float) -> float:
        """Return the distance of the impulse from the plumb line for a coefficient on fixed ground [m]."""
        base = self.inertia + self.mass * self.height**2
        return base * (1.0 - coefficient) / (self.mass * (self.old + coefficient * self.new))  # Eq. 4

    def after(self, rate: float, slip: float, coefficient: float) -> tuple[float, float]:
        """Return the angular velocity and the velocity of the base after an impact.

        `rate` is theta' [rad/s] and `slip` is the velocity of the base [m/s] before the impact. The vertical impulse
        grows until the new foot is at rest. The friction of the base opposes the slip. If the slip ends, the base
        sticks as long as friction suffices.
        """
        lever = self.position(coefficient)
        gap = self.side * rate * (self.old + self.new)  # downward velocity of the new foot
        # the free horizontal motion without friction decides the first direction of slip
        direction = _sign(slip) or _sign(self._rates(lever, 0.0)[1])
        sticks = not slip and self._demand(lever) <= self.friction
        while gap > 0.0:
            if sticks:
                turn, slide = self._stuck(lever), 0.0
            else:
                turn, slide = self._rates(lever, -direction * self.friction)
            closing = 1.0 / self.mass - self.side * self.new * turn
            impulse = gap / closing
            stops = not sticks and slip * slide < 0.0 and -slip / slide < impulse
            if stops:
                impulse = -slip / slide
            rate, slip, gap = rate + turn * impulse, slip + slide * impulse, gap - closing * impulse
            if not stops:
                return rate, slip
            slip, sticks = 0.0, self._demand(lever) <= self.friction
            direction = _sign(self._rates(lever, 0.0)[1])
        return rate, slip

    def _rates(self, lever: float, friction: float) -> tuple[float, float]:
        """Return changes of theta' and u' per unit vertical impulse, with a friction impulse per unit impulse."""
        # (m + M) du + m h dtheta' = dJ;  I dtheta' = -h dJx - s a dJz, dJx = m (du + h dtheta')
        total = self.mass + self.base_mass
        inertia = self.inertia + self.mass * self.height**2 - (self.mass * self.height) ** 2 / total
        turn = -(self.side * lever + self.mass * self.height * friction / total) / inertia  # Eq. 375
        return turn, (friction - self.mass * self.height * turn) / total

    def _stuck(self, lever: float) -> float:
        """Return the change of theta' per unit vertical impulse for a base that sticks."""
        return -self.side * lever / (self.inertia + self.mass * self.height**2)

    def _demand(self, lever: float) -> float:
        """Return the ratio of horizontal to vertical impulse for a base that sticks [-]."""
        return self.mass * self.height * abs(self._stuck(lever))  # Eq. 376


def _sign(value: float) -> int:
    return (value > 0.0) - (value < 0.0)
