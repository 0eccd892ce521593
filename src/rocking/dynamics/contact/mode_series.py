"""One mode over a short time as power series: motion, contact forces, and everything that may end it."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from operator import mul
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import BOTH, LEFT, RIGHT, ContactState, Mode, PlaneBase, along, away
from rocking.portable import convolved

_SMALLEST = 1e-22


class GroundSeries(NamedTuple):
    """The ground over a unit of time."""

    push: list[float]  # push, lift: coefficients of a_x and of g + a_z [m/s2]
    lift: list[float]
    unit: float  # the unit of time [s]

    def shortened(self, part: float) -> "GroundSeries":
        """Return the beginning of the same motion."""
        if part == 1.0:
            return self
        push, lift = ([c * part**k for k, c in enumerate(series)] for series in (self.push, self.lift))
        return GroundSeries(push, lift, self.unit * part)


Acceleration = Callable[[int], float]
"""The coefficient k of theta'', asked for in order while the series of spin and arm grow."""


class PivotSeries(NamedTuple):
    """Series over a unit of time."""

    rotation: list[float]  # rotation, arm_x, arm_z: coefficients of theta [rad] and of the arm [m]
    arm_x: list[float]
    arm_z: list[float]
    stiff: float  # ``j + r_x L`` at the start, over its value without friction; 1 for a foot that sticks [-]


def pivot_motion(
    inertia: float,
    arm: tuple[float, float],
    motion: tuple[float, float],
    ground: GroundSeries,
    pull: float | None,
    order: int,
) -> PivotSeries:
    """Return the series of a body that turns about one foot.

    inertia: j = I_C / m [m2]; arm: r_x and r_z at the start [m]; motion: theta [rad] and theta' [rad/s] at the start;
    pull: ``sigma mu`` where the foot slides; None where it sticks [-].

    >>> found = pivot_motion(1.0, (0.0, -1.0), (0.0, 0.0), GroundSeries([2.0], [10.0], 1.0), None, 2)
    >>> found.rotation  # theta'' = -a_x h / (j + h^2)
    [0.0, 0.0, -0.5]
    """
    unit = ground.unit
    rotation, spin = [motion[0], motion[1] * unit], [motion[1] * unit]
    x, z = [arm[0]], [arm[1]]
    if pull is None:
        stiff, acceleration = 1.0, _sticking(inertia, x, z, ground)
    else:
        stiff = (x[0] * (x[0] + pull * z[0]) + inertia) / (inertia + x[0] ** 2)
        acceleration = _sliding(inertia, x, z, spin, ground, pull)
    floor, small, least = 1e-300, 0, len(ground.push) + len(ground.lift)
    for k in range(order - 1):
        spin.append(acceleration(k) / (k + 1))
        rotation.append(spin[-1] / (k + 2))
        floor = max(floor, _SMALLEST * abs(spin[-1]), _SMALLEST * abs(spin[0]))
        x_next = sum(map(mul, spin, z[k::-1])) / (k + 1)  # Eq. 68
        z_next = -sum(map(mul, spin, x[k::-1])) / (k + 1)  # Eq. 68
        x.append(x_next)
        z.append(z_next)
        small = small + 1 if abs(spin[-1]) <= floor and k >= least else 0
        if small == 3:
            break
    return PivotSeries(rotation, x, z, stiff)


def _sticking(inertia: float, x: list[float], z: list[float], ground: GroundSeries) -> Acceleration:
    """Moments about a foot that does not move."""
    push, lift, unit = ground
    compliance = unit * unit / (inertia + x[0] ** 2 + z[0] ** 2)

    def acceleration(k: int) -> float:
        moment: float = sum(map(mul, lift, x[k::-1])) - sum(map(mul, push, z[k::-1]))
        return -moment * compliance  # Eq. 66

    return acceleration


def _sliding(
    inertia: float, x: list[float], z: list[float], spin: list[float], ground: GroundSeries, pull: float
) -> Acceleration:
    """Moments about the centre, with the friction of a foot that slides: a division of series."""
    _, lift, unit = ground
    level: list[float] = []
    stiffness: list[float] = []
    square: list[float] = []
    force: list[float] = []
    found: list[float] = []

    def acceleration(k: int) -> float:
        level.append(x[k] + pull * z[k])
        stiffness.append(sum(map(mul, x, level[k::-1])) + (inertia if k == 0 else 0.0))
        square.append(sum(map(mul, spin, spin[k::-1])))
        force.append((lift[k] * (unit * unit) if k < len(lift) else 0.0) + sum(map(mul, z, square[k::-1])))
        known = sum(map(mul, level, force[k::-1])) + sum(map(mul, stiffness[1:], found[::-1]))
        found.append(-known / stiffness[0] if stiffness[0] else math.nan)  # Eq. 67
        return found[-1]

    return acceleration


def padded(series: list[float] | FloatArray, size: int) -> FloatArray:
    """Return a series with zeros after it."""
    made = np.zeros(size)
    made[: len(series)] = series[:size]
    return made


def derivative(series: FloatArray) -> FloatArray:
    """Return the derivative of a series, of the same length."""
    made = np.zeros(series.size)
    made[:-1] = series[1:] * np.arange(1, series.size)
    return made


def value(series: FloatArray, at: float) -> float:
    """Return the value of a series."""
    total = 0.0
    for c in series[::-1].tolist():
        total = total * at + c
    return total


def integral(first: FloatArray, second: FloatArray, at: float) -> float:
    """Return the integral of a product of series from 0 to an instant."""
    product = convolved(first, second)
    return at * value(product / np.arange(1, product.size + 1), at)


def twice(acceleration: FloatArray, start: float, rate: float, unit: float) -> FloatArray:
    """Return coefficients of the position [m] from those of its acceleration over a unit of time, and how it starts."""
    made = np.zeros(acceleration.size)
    made[0], made[1] = start, rate * unit
    k = np.arange(2, acceleration.size)
    made[2:] = acceleration[:-2] * unit**2 / (k * (k - 1))
    return made


@dataclass(frozen=True)
class ModeSeries:
    """Series of a mode; the time within it runs from 0 to 1."""

    unit: float  # duration of all [s]
    rotation: FloatArray  # rotation, x, rise: theta [rad], x and rise of the centre [m]
    x: FloatArray
    rise: FloatArray
    tangential: FloatArray  # total force of the ground to the right, per unit of mass [m/s2]
    # vertical force at each foot that carries, per unit of mass [m/s2]
    normals: dict[int, FloatArray] = field(default_factory=dict)
    sliding: FloatArray | None = None  # velocity of the feet that carry along the ground; None without feet [m/s]
    # height of each foot that does not carry; over the base where one foot carries and so turned by theta [m, rad]
    gaps: dict[int, FloatArray] = field(default_factory=dict)
    stiff: float = 1.0  # below or at zero no force is possible (Painleve) [-]

    def state(self, at: float, touching: tuple[int, ...]) -> ContactState:
        x, rise, rotation = (value(c, at) for c in (self.x, self.rise, self.rotation))
        u, w, spin = (value(derivative(c), at) / self.unit for c in (self.x, self.rise, self.rotation))
        return ContactState(x, rise, rotation, u, w, spin, touching)

    def shortened(self, part: float) -> "ModeSeries":
        """Return the beginning of the series, of a shorter unit."""
        if part == 1.0:
            return self
        powers = part ** np.arange(self.rotation.size)
        return ModeSeries(
            self.unit * part,
            self.rotation * powers,
            self.x * powers,
            self.rise * powers,
            self.tangential * powers,
            {foot: c * powers for foot, c in self.normals.items()},
            None if self.sliding is None else self.sliding * powers,
            {foot: c * powers for foot, c in self.gaps.items()},
            self.stiff,
        )


def mode_series(
    base: PlaneBase, state: ContactState, mode: Mode, ground: GroundSeries, friction: float, order: int
) -> ModeSeries:
    """Return how a body moves in a mode."""
    if not mode.feet:
        return _flight(base, state, ground, order)
    if len(mode.feet) == 2:
        return _flat(base, state, mode, ground, friction)
    return _pivoting(base, state, mode, ground, friction, order)


def _flat(base: PlaneBase, state: ContactState, mode: Mode, ground: GroundSeries, friction: float) -> ModeSeries:
    """Both feet: the resultant force decides how they share it."""
    size = max(len(ground.push), len(ground.lift)) + 2
    push, weight = padded(ground.push, size), padded(ground.lift, size)
    tangential = -mode.slip * friction * weight if mode.slip else push
    x = twice(tangential - push, state.x, state.u, ground.unit) if mode.slip else padded([state.x], size)
    turn = tangential * base.height
    normals = {
        LEFT: (weight * base.right + turn) / base.width,  # Eq. 63
        RIGHT: (weight * base.left - turn) / base.width,  # Eq. 63
    }
    still = np.zeros(size)
    sliding = derivative(x) / ground.unit if mode.slip else still
    return ModeSeries(ground.unit, still, x, still, tangential, normals, sliding)


def _flight(base: PlaneBase, state: ContactState, ground: GroundSeries, order: int) -> ModeSeries:
    """No foot: parabolas above a ground that moves."""
    size = order + 1
    x = twice(-padded(ground.push, size), state.x, state.u, ground.unit)  # Eq. 64
    rise = twice(-padded(ground.lift, size), state.rise, state.w, ground.unit)  # Eq. 64
    # products, not powers: those of negative numbers need not mirror those of positive ones in the last bit
    powers = np.cumprod([1.0, *(state.spin * ground.unit / k for k in range(1, size))])
    quarter = np.arange(size) % 4
    sine, cosine = math.sin(state.rotation), math.cos(state.rotation)
    sines = powers * np.choose(quarter, [sine, cosine, -sine, -cosine])
    lowered = -powers * np.choose(quarter, [cosine, -sine, -cosine, sine])
    lowered[0] = 2.0 * math.sin(0.5 * state.rotation) ** 2  # 1 - cos(theta) without cancellation
    gaps = {}
    for foot in BOTH:
        gap = rise - base.lever(foot) * sines + base.height * lowered  # Eq. 65
        if foot in state.touching:
            gap[0], gap[1] = 0.0, away(base, state, foot) * ground.unit
        gaps[foot] = gap
    rotation = padded([state.rotation, state.spin * ground.unit], size)
    return ModeSeries(ground.unit, rotation, x, rise, np.zeros(size), gaps=gaps)


def _pivoting(
    base: PlaneBase, state: ContactState, mode: Mode, ground: GroundSeries, friction: float, order: int
) -> ModeSeries:
    """One foot carries: the other one rises as theta does."""
    (foot,) = mode.feet
    pull = mode.slip * friction if mode.slip else None
    arm = base.arm(foot, state.rotation)
    found = pivot_motion(base.inertia, arm, (state.rotation, state.spin), ground, pull, order)
    size = order + 1
    rotation, arm_x, arm_z = (padded(c, size) for c in (found.rotation, found.arm_x, found.arm_z))
    rise = -arm_z
    rise[0] = state.rise
    unit2 = ground.unit**2
    push, normal = padded(ground.push, size), padded(ground.lift, size) + derivative(derivative(rise)) / unit2
    if pull is None:
        x = -arm_x
        x[0] = state.x
        tangential = push + derivative(derivative(x)) / unit2
        sliding = np.zeros(size)
    else:
        tangential = -pull * normal
        x = twice(tangential - push, state.x, state.u, ground.unit)
        sliding = derivative(x + arm_x) / ground.unit
        sliding[0] = along(base, state, foot)
    return ModeSeries(
        ground.unit, rotation, x, rise, tangential, {foot: normal}, sliding, {-foot: foot * rotation}, found.stiff
    )
