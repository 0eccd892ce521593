"""Restraints during one history: laws, levers about both feet, extremes, events and energy."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking.bodies.restrained import Restrained
from rocking.bodies.restraints import Wall
from rocking.conventions import FloatArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.restrained.laws import ForceLaw, law_of
from rocking.dynamics.restrained.levers import Lever
from rocking.errors import InvalidValueError

BLOCKED = 1e9
"""Moment of a rigid wall against rotation towards the wall, divided by m g R [-]."""

_ROUNDING = 1e-12  # rounding of a dissipated energy over largest force x range of elongation


@dataclass(frozen=True, slots=True)
class RestraintEvent:
    """A change of phase of a restraint."""

    time: float  # [s]
    index: int  # index of the restraint
    phase: str  # phase after the event
    rotation: float  # [rad]
    elongation: float  # [m]
    force: float  # force before the event [N]


@dataclass(slots=True)
class Device:
    """One restraint during a history."""

    law: ForceLaw
    levers: dict[int, Lever]  # levers by side
    work: float = 0.0  # work done on the restraint [J]
    elongation: float = 0.0  # elongation at the last change of state [m]
    rate: float = 0.0  # [m/s]
    largest_force: float = -math.inf  # extremes of force [N] and elongation [m]
    smallest_force: float = math.inf
    largest_elongation: float = 0.0
    smallest_elongation: float = 0.0
    start_energy: float = field(default=0.0)  # [J]

    def force(self) -> float:
        """Return the present force [N]."""
        law = self.law
        viscous = law.coefficient * abs(self.rate) ** law.exponent if law.coefficient else 0.0
        return law.phase.force(self.elongation) + math.copysign(viscous, self.rate)

    def note(self) -> None:
        """Update the extremes with the present values."""
        force, e = self.force(), self.elongation
        if self.law.phase.name == "contact":
            force = min(force, 0.0)  # without rounding at the end of the contact
        self.note_force(force)
        self.largest_elongation = max(self.largest_elongation, e)
        self.smallest_elongation = min(self.smallest_elongation, e)

    def note_force(self, force: float) -> None:
        """Update the extremes of the force."""
        self.largest_force, self.smallest_force = max(self.largest_force, force), min(self.smallest_force, force)

    def move(self, elongation: float, rate: float) -> None:
        """Move to an elongation within a phase. The viscous work is added by the step."""
        self.work += self.law.phase.work(self.elongation, elongation)
        self.elongation, self.rate = elongation, rate
        self.note()

    def load(self, elongation: float) -> None:
        """Move quasi-statically from the upright state to the state at the start of the history."""
        direction = 1 if elongation > 0.0 else -1
        if elongation:
            self.law.settle(0.0, direction)
        phase = self.law.phase
        while not phase.low <= elongation <= phase.high:
            self.law.cross(phase.high if direction > 0 else phase.low, upwards=direction > 0)
            phase = self.law.phase
        self.elongation = elongation
        self.start_energy = self.law.stored(elongation)
        self.note()

    @property
    def summary(self) -> dict[str, float]:
        """Extremes and state at the end, by the names of quantities."""
        return {
            "largest_force": self.largest_force, "smallest_force": self.smallest_force,
            "largest_elongation": self.largest_elongation, "smallest_elongation": self.smallest_elongation,
            "plastic_elongation": self.law.plastic, "yield_count": self.law.yields,
            "is_broken": int(self.law.broken), "dissipated_energy": self.dissipated,
        }  # fmt: skip

    @property
    def dissipated(self) -> float:
        """Energy dissipated up to now, without the loss by rupture [J]."""
        energy = self.start_energy + self.work - self.law.stored(self.elongation) - self.law.lost
        extremes = self.largest_force, self.smallest_force, self.largest_elongation, self.smallest_elongation
        return float(without_rounding(energy, *extremes))


def without_rounding(
    energy: ArrayLike, largest_force: ArrayLike, smallest_force: ArrayLike, longest: ArrayLike, shortest: ArrayLike
) -> FloatArray:
    """Return dissipated energies, with 0 for a value below the rounding of the work [J]."""
    force = np.maximum(np.abs(largest_force), np.abs(smallest_force))
    rounding = _ROUNDING * np.asarray(force) * np.subtract(longest, shortest)
    return np.where(np.abs(energy) <= rounding, 0.0, energy)


def devices_of(body: Restrained, *, linear: bool) -> list[Device]:
    """Return the restraints of a body before its motion."""
    devices = []
    for item in body.restraints:
        law = law_of(item)
        if isinstance(item, Wall):
            law.rebound = item.rebound(body.body)
        levers = {side: Lever.of(item, body.body, side, linear=linear) for side in (1, -1)}
        devices.append(Device(law, levers, start_energy=law.stored(0.0)))
    return devices


def parameters_of(
    body: Restrained, restitution: Any, gravity: float, *, may_be_none: bool = False
) -> RockingParameters:
    """Return the parameters of the equation of motion of a body on its floor."""
    parameters = RockingParameters.of_body(body.body, restitution, gravity, may_be_none=may_be_none)
    right, left = (  # Eq. 368: with the slope, gravity and motion keep their directions
        replace(half, slenderness_angle=half.slenderness_angle + sign * body.floor_slope)
        for sign, half in ((1, parameters.right), (-1, parameters.left))
    )
    return replace(parameters, right=right, left=left)


def check_path(body: Restrained, *directions: float) -> None:
    """Raise an error if a rigid wall prevents a rotation in one of the directions."""
    for item in body.restraints:
        if not isinstance(item, Wall) or item.law == "compliant":
            continue
        if any(direction * item.sign < 0.0 for direction in directions):
            raise InvalidValueError(
                "{name} is rigid: the body cannot rotate to the {side}", parameter="rotation", name=item.name,
                side=item.side,
            )  # fmt: skip


def blocked(devices: list[Device]) -> dict[int, float]:
    """Return the ratio of velocities after and before an impact at a rigid wall by the side that it blocks [-]."""
    return {
        side: device.law.rebound
        for device in devices
        if device.law.rebound is not None
        for side in (1, -1)
        if side * device.levers[side].at_rest < 0.0
    }


def moment_at_rest(devices: list[Device], side: int) -> float:
    """Return the moment of restraints against uplift about a foot, including static friction [N m]."""
    return sum(
        side * device.levers[side].at_rest * device.law.phase.force(0.0) * (not device.law.slip_force)
        + device.law.slip_force * abs(device.levers[side].at_rest)
        for device in devices
    )
