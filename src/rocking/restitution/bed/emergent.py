"""The coefficient of restitution that emerges from an impact on the bed, by three measures that share one limit.

All three compare rigid rocking on the new foot with rigid rocking on the old one at theta = 0, r = theta_dot_after /
theta_dot_before, where the velocity after is what rigid rocking would need

- **by peak**: to reach the rotation of the next peak, ``I' w^2 / 2 = V(theta_peak)``. The foot's static depth is
  nearly the same at theta = 0 and at the peak, so it drops out; what is left is (1 - N/mg)^2 of the static energy
  (m g)^2 / 2k, a relative error of order 1/k. Energy of hops and vibration at the peak is not counted.
- **by energy**: to have the mechanical energy at the end, the static energy of the foot under the weight added back
  (``m g d - U(d)``). Hops and vibration are counted: the two differ by them.
- **by velocity**: to have the angular velocity at the end, ``w^2 = theta_dot^2 + 2 V(theta) / I'``: the measure of an
  impulsive impact, where there is no gravity and no peak.
"""

import math
from dataclasses import dataclass
from enum import Enum

from rocking.errors import InvalidValueError
from rocking.restitution.bed.rigid import settlement
from rocking.restitution.bed.setup import Results, Setup


class BedStatus(Enum):
    """How the computation of an impact ended; the value is the sentence a user reads."""

    PEAK = "the rotation reached its next peak"
    PARTED = "the bed has parted"
    TIME_OUT = "neither a peak nor the end of the impact came in the time allowed"
    TOO_MANY_STEPS = "the steps allowed did not suffice"
    FAILED = "the step fell below rounding: no result"
    TOPPLED = "the body passed its highest point: it topples"


@dataclass(frozen=True, slots=True)
class Emergent:
    """Coefficients of restitution of one impact.

    Parameters
    ----------
    by_peak, by_energy, by_velocity : float
        theta_dot_after / theta_dot_before by each measure; NaN where it does not apply [-].
    stopped : bool
        Whether the body did not step onto the new foot.
    """

    by_peak: float
    by_energy: float
    by_velocity: float
    stopped: bool

    @property
    def coefficient(self) -> float:
        """By the peak where there is one, by the velocity of an impulsive impact, else by energy [-]."""
        values = (self.by_peak, self.by_velocity, self.by_energy)
        return next((value for value in values if not math.isnan(value)), math.nan)


def emergent_of(setup: Setup, row: Results) -> Emergent:
    """Return the coefficients of restitution of an impact."""
    status = status_of(row["status"])
    if status in {BedStatus.FAILED, BedStatus.TOO_MANY_STEPS}:
        raise InvalidValueError(
            f"no coefficient of restitution of this impact: {status.value}; stiffness or damping far off?"
        )
    rigid = setup.rigid
    rotation, velocity = row["rotation"], row["angular_velocity"]
    if setup.impulsive:
        value = velocity / setup.landing_velocity
        return Emergent(math.nan, math.nan, value, stopped=value <= 1e-9)
    inertia = rigid.inertia_about(rigid.pivot(abs(rotation)))
    reached = rigid.potential(rotation) if rotation > 0.0 else 0.0

    def ratio(energy: float) -> float:
        return math.sqrt(2.0 * max(energy, 0.0) / inertia) / setup.landing_velocity  # Eq. 128

    by_peak = ratio(reached) if status is BedStatus.PEAK else math.nan
    if not rotation > 0.0:
        return Emergent(by_peak, 0.0, math.nan, stopped=True)
    weight = rigid.mass * setup.gravity
    depth, elastic = settlement(rigid, setup.law, rotation, weight)
    # above rigid standing, the static energy of the foot added back
    energy = row["energy_end"] - weight * rigid.lift(0.0) + (weight * depth - elastic)
    return Emergent(by_peak, ratio(energy), math.nan, stopped=False)


def status_of(code: float) -> BedStatus:
    """Return how a computation ended."""
    return tuple(BedStatus)[int(code)]
