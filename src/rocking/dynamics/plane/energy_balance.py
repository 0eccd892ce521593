"""Energy balance and contact forces of a response without friction.

Warnings report that pure rocking is not possible.
"""

from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FEET, FloatArray, Foot, opposite
from rocking.dynamics.plane import equations
from rocking.dynamics.plane.dense_output import DenseOutput
from rocking.dynamics.plane.equations import EventKind, Trajectory
from rocking.dynamics.plane.settings import PlaneSettings
from rocking.messages import Message


@dataclass(frozen=True, repr=False)
class ResponseEnergy:
    """Energy of a response at its samples."""

    time: FloatArray  # times of the samples, and the overturning time if it is later [s]
    kinetic: FloatArray  # kinetic energy, and potential energy relative to the body at rest [J]
    potential: FloatArray
    work: FloatArray  # work of the ground since the start [J]
    lost: FloatArray  # energy lost at impacts since the start [J]

    def __repr__(self) -> str:
        return f"<ResponseEnergy: {self.lost[-1]:.4g} J lost at impacts; closes to {self.closure:.1e}>"

    @property
    def gap(self) -> FloatArray:
        """Energy balance error: kinetic + potential + lost - work - initial [J]."""
        stored = self.kinetic + self.potential
        return np.asarray(stored + self.lost - self.work - stored[0], dtype=np.float64)  # Eq. 45

    @property
    def closure(self) -> float:
        """Largest energy balance error, divided by the largest stored energy or loss [-]."""
        scale = max(float(np.max(self.kinetic + self.potential)), float(np.max(np.abs(self.lost))))
        fallen = float(np.max(np.abs(self.potential)))  # the only energy far beyond the top
        return float(np.max(np.abs(self.gap))) / max(scale if scale > 1e-9 * fallen else fallen, 1e-300)


def energy_of(dense_output: DenseOutput, time: FloatArray, mass: float, settings: PlaneSettings) -> ResponseEnergy:
    """Return the energy of a response at times from zero [s]: samples, and a later overturning time."""
    index = dense_output.indices(time[1:])
    both_ends = energies(dense_output, mass, settings)
    return ResponseEnergy(time, *(np.append(values[0, 0], values[index, 1]) for values in both_ends))


def energies(
    dense_output: DenseOutput, mass: float, settings: PlaneSettings
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return kinetic and potential energy, work and losses at both ends of the intervals [J] (shape (n, 2))."""
    unit = (mass * settings.gravity * dense_output.semi_diagonal)[:, None]
    alpha, p = dense_output.alpha[:, None], dense_output.p[:, None]
    stored = unit * equations.energy(dense_output.rotation, dense_output.velocity, alpha, p, linear=settings.linear)
    kinetic = unit * 0.5 * np.square(dense_output.velocity / p)
    # an impact loses the difference of energy between the end of an interval and the start of the next interval
    lost = np.concatenate([[0.0], np.cumsum(stored[:-1, 1] - stored[1:, 0])])
    work = np.concatenate([[0.0], np.cumsum(mass * dense_output.work(settings))])
    return kinetic, stored - kinetic, np.stack([work[:-1], work[1:]], axis=1), np.stack([lost, lost], axis=1)


LEAVES = "the body would leave the ground, which pure rocking cannot do"
_FOLLOWS = "use simulate(body, motion, friction=...)"


@dataclass(frozen=True, repr=False)
class GroundForces:
    """Contact forces at the samples, and friction demand of rocking without slip."""

    time: FloatArray  # times of the samples, and the overturning time if it is later [s]
    horizontal: FloatArray  # horizontal and vertical force on the body, to the right and upwards [N]
    vertical: FloatArray
    # smallest vertical force up to the overturning time [N]; a negative force is tensile
    least_vertical: float
    # largest |horizontal / vertical| up to the overturning time [-]; infinite if the vertical force vanishes
    friction_of_motion: float
    friction_of_impacts: float  # largest ratio of horizontal to vertical impulse at an impact [-]

    def __repr__(self) -> str:
        return f"<GroundForces: {'; '.join(self.warnings()) or f'friction {self.friction_demand:.3g} needed'}>"

    @property
    def friction_demand(self) -> float:
        """Friction demand of the response, including impacts [-]."""
        return max(self.friction_of_motion, self.friction_of_impacts)

    @property
    def loses_contact(self) -> bool:
        """True if the vertical force is tensile at these times. `Response.lost_contact` includes later times."""
        return self.least_vertical < 0.0

    def warnings(self, friction: float = 0.5) -> list[str]:
        """Return the reasons against pure rocking: loss of contact, and the reasons from `slips`; may be empty."""
        slips = self.slips(friction)
        if not self.loses_contact:
            return slips
        facts = {"leaves": Message(LEAVES), "consequence": Message(_FOLLOWS)}
        return [Message("the contact force becomes tensile: {leaves}; {consequence}", facts), *slips]

    def slips(self, friction: float = 0.5) -> list[str]:
        """Return the reasons why the feet would slip, as sentences; empty if there are none."""
        friction = checks.positive("friction", friction)
        warnings: list[str] = []
        if not self.loses_contact and self.friction_of_motion > friction:
            warnings.append(
                Message(
                    "Rocking without slip needs a coefficient of friction of {needed:.2f}. With "
                    "{friction:g} the body slides. Use simulate(body, motion, friction=...)",
                    {"needed": self.friction_of_motion, "friction": friction},
                )
            )
        if self.friction_of_impacts > friction:
            warnings.append(
                Message(
                    "Impacts without slip need a coefficient of friction of {needed:.2f}. With "
                    "{friction:g} the foot slips and loses more energy. Use "
                    "simulate(body, motion, friction=...)",
                    {"needed": self.friction_of_impacts, "friction": friction},
                )
            )
        return warnings


def contact_of(
    trajectory: Trajectory, dense_output: DenseOutput, time: FloatArray, body: Body, settings: PlaneSettings
) -> GroundForces:
    """Return the contact forces of a response at the samples, and at an overturning time after the samples [s]."""
    f_x, f_z, demand = forces(dense_output, settings.gravity)
    # friction after overturning is not relevant; the start is included, even beyond the top
    late = dense_output.start >= trajectory.overturning_time - 1e-9 * dense_output.length
    standing = np.stack([~late, ~late], axis=1)
    standing[0, 0] = True
    index = dense_output.indices(time[1:])
    mass = body.mass
    return GroundForces(
        time=time,
        horizontal=mass * np.concatenate([[f_x[0, 0]], f_x[index, 1]]),
        vertical=mass * np.concatenate([[f_z[0, 0]], f_z[index, 1]]),
        least_vertical=mass * float(f_z[standing].min()),
        friction_of_motion=float(demand[standing].max()),
        friction_of_impacts=_friction_of_impacts(trajectory, body),
    )


def forces(dense_output: DenseOutput, gravity: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return horizontal and vertical force per mass at both ends of intervals [N/kg], and the friction demand [-]."""
    # the friction demand is infinite if the force is tensile
    side = dense_output.side[:, None]
    f_x, f_z = equations.reactions(
        dense_output.rotation, dense_output.velocity, dense_output.acceleration, np.where(side == 0.0, 1.0, side),
        dense_output.alpha[:, None], dense_output.semi_diagonal[:, None],
        dense_output.push, gravity + dense_output.lift,
    )  # fmt: skip
    resting = side == 0.0
    f_x = np.where(resting, dense_output.push, f_x)
    f_z = np.where(resting, gravity + dense_output.lift, f_z)
    with np.errstate(divide="ignore", invalid="ignore"):
        demand = np.where(f_z > 0.0, np.abs(f_x) / f_z, np.where(f_x == 0.0, 0.0, np.inf))  # Eq. 35
    return f_x, f_z, demand


def _friction_of_impacts(trajectory: Trajectory, body: Body) -> float:
    sides = {foot: body.side(foot) for foot in FEET}
    largest = 0.0
    for event in trajectory.events:
        if event.kind is EventKind.IMPACT:
            foot: Foot = "right" if event.side > 0 else "left"
            new, old = sides[foot], sides[opposite(foot)]
            ratio = equations.friction_of_impact(new.centre_height, old.half_width, new.half_width, event.coefficient)
            largest = max(largest, abs(float(ratio)))
    return largest
