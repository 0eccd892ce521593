"""Mechanical implications of a coefficient of restitution: impulse position, friction demand and energy loss."""

import math
from dataclasses import dataclass

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import Foot, opposite
from rocking.messages import Message

# a model exactly at a bound satisfies the bound only to rounding (Housner has k = 1)
_SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Implication:
    """Mechanical implications of one coefficient of one body.

    Parameters
    ----------
    coefficient : float
        theta_dot_after / theta_dot_before [-].
    impulse_arm : float
        Distance a of the impulse from the plumb line of the centre of mass, towards the new foot [m].
    impulse_ratio : float
        Ratio k of the arm to the lever of the new foot [-]; 1 is Housner, a value above 1 is outside the base.
    impulse_x : float
        Position of the impulse on the ground in the user's coordinates [m].
    friction_demand : float
        Friction demand of the impact [-]. With a smaller coefficient of friction, the foot slips during the impact.
    energy_loss : float
        Energy loss / kinetic energy before the impact, 1 - r^2 I_O'/I_O [-].
    largest_coefficient : float
        Energy bound sqrt(I_O / I_O') on the coefficient [-].
    within_base, within_energy : bool
        `within_base` is True if the impulse acts on the base. `within_energy` is True if the impact creates no energy.
    """

    coefficient: float
    impulse_arm: float
    impulse_ratio: float
    impulse_x: float
    friction_demand: float
    energy_loss: float
    largest_coefficient: float
    within_base: bool
    within_energy: bool

    @property
    def admissible(self) -> bool:
        """True if one impulse on the base can give the coefficient without creating energy."""
        return self.within_base and self.within_energy

    @property
    def objections(self) -> tuple[str, ...]:
        """Reasons against the coefficient, as sentences; empty if it is admissible."""
        reasons = []
        if not self.within_base:
            facts = {"ratio": self.impulse_ratio}
            reasons.append(Message("implies an impulse outside the base (k = {ratio:.3f})", facts))
        if not self.within_energy:
            facts = {"largest": self.largest_coefficient}
            reasons.append(Message("creates energy: r must not exceed {largest:.6f} for this body", facts))
        return tuple(reasons)


def energy_bound(body: Body, foot: Foot) -> float:
    """Return the largest coefficient of restitution at which an impact creates no energy.

    The bound is sqrt(I_old / I_new) with the moments of inertia about the feet [-]. If the feet differ, the bound
    exceeds 1 for one foot.

    >>> from rocking import Block
    >>> energy_bound(Block(width=1.0, height=2.0), "left")
    1.0
    """
    old, new = body.side(opposite(checks.foot("foot", foot))), body.side(foot)
    return math.sqrt(old.moment_of_inertia / new.moment_of_inertia)  # Eq. 29


def implied(body: Body, coefficient: float, *, foot: Foot = "right") -> Implication:
    """Return the implications of a coefficient for a body.

    Angular momentum is conserved about the point of action of the impulse on the ground:
    ``a = I_h (1 - r) / (m (b_old + r b_new))`` with ``I_h = I_C + m h^2``, and the ratio of horizontal to vertical
    impulse is ``h (1 - r) / (b_old + r b_new)``.

    Parameters
    ----------
    body : Body
        The body.
    coefficient : float
        theta_dot_after / theta_dot_before, at least 0 [-].
    foot : {"left", "right"}
        The foot on which the body lands.

    Returns
    -------
    Implication
        Impulse position, friction, energy, admissibility.

    Raises
    ------
    InvalidValueError
        If the coefficient is not finite or is negative.

    Examples
    --------
    >>> from rocking import Block
    >>> result = implied(Block(width=1.0, height=2.0), 0.7)
    >>> round(result.impulse_ratio, 12), round(result.energy_loss, 12)
    (1.0, 0.51)
    """
    r = checks.within("coefficient", coefficient, 0.0, math.inf, hint="a ratio of angular velocities")
    new, old = body.side(foot), body.side(opposite(checks.foot("foot", foot)))
    base_inertia = new.moment_of_inertia - new.mass * new.half_width**2
    lift = old.half_width + r * new.half_width
    arm = base_inertia * (1.0 - r) / (new.mass * lift)  # Eq. 4
    direction = 1.0 if foot == "right" else -1.0
    bound = energy_bound(body, foot)
    return Implication(
        coefficient=r,
        impulse_arm=arm,
        impulse_ratio=arm / new.half_width,
        impulse_x=body.centre[0] + direction * arm,
        friction_demand=new.centre_height * abs(1.0 - r) / lift,  # Eq. 5
        energy_loss=1.0 - (r / bound) ** 2,  # Eq. 109
        largest_coefficient=bound,
        within_base=-old.half_width * (1.0 + _SLACK) <= arm <= new.half_width * (1.0 + _SLACK),
        within_energy=r <= bound * (1.0 + _SLACK),
    )
