"""Power series of one mode over a short time: motion, contact forces, and gaps."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from operator import mul
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane_frictional.base import BOTH, LEFT, RIGHT, ContactState, Mode, PlaneBase, along, away
from rocking.portable import convolved

_SMALLEST = 1e-22


class GroundSeries(NamedTuple):
    """Ground motion over a unit of time."""

    push: list[float]  # push, lift: coefficients of a_x and g + a_z [m/s2]
    lift: list[float]
    unit: float  # the unit of time [s]

    def shortened(self, fraction: float) -> "GroundSeries":
        """Return the first part of the motion, up to a fraction of the unit."""
        if fraction == 1.0:
            return self
        push, lift = ([c * fraction**k for k, c in enumerate(series)] for series in (self.push, self.lift))
        return GroundSeries(push, lift, self.unit * fraction)


Acceleration = Callable[[int], float]
"""Function that returns coefficient k of theta''.

It is called in the order of k, as the series of spin and arm grow.
"""


class PivotSeries(NamedTuple):
    """Series of a body that turns about one foot, over a unit of time."""

    rotation: list[float]  # rotation, arm_x, arm_z: coefficients of theta [rad] and of the arm [m]
    arm_x: list[float]
    arm_z: list[float]
    stiff: float  # ``j + r_x L`` at the start, divided by its value without friction [-]; 1 for a sticking foot


def pivot_motion(
    inertia: float,
    arm: tuple[float, float],
    motion: tuple[float, float],
    ground: GroundSeries,
    pull: float | None,
    order: int,
) -> PivotSeries:
    """Return the series of a body that turns about one foot.

    `inertia` is j = I_C / m [m2]. `arm` contains r_x and r_z at the start [m]. `motion` contains theta [rad] and theta'
    [rad/s] at the start. `pull` is ``sigma mu`` for a sliding foot [-], and None for a sticking foot.

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
    floor, small, forcing_terms = 1e-300, 0, len(ground.push) + len(ground.lift)
    for k in range(order - 1):
        spin.append(acceleration(k) / (k + 1))
        rotation.append(spin[-1] / (k + 2))
        floor = max(floor, _SMALLEST * abs(spin[-1]), _SMALLEST * abs(spin[0]))
        x_next = sum(map(mul, spin, z[k::-1])) / (k + 1)  # Eq. 68
        z_next = -sum(map(mul, spin, x[k::-1])) / (k + 1)  # Eq. 68
        x.append(x_next)
        z.append(z_next)
        small = small + 1 if abs(spin[-1]) <= floor and k >= forcing_terms else 0
        if small == 3:
            break
    return PivotSeries(rotation, x, z, stiff)


def _sticking(inertia: float, x: list[float], z: list[float], ground: GroundSeries) -> Acceleration:
    """Return theta'' from the moments about a fixed foot."""
    push, lift, unit = ground
    compliance = unit * unit / (inertia + x[0] ** 2 + z[0] ** 2)

    def acceleration(k: int) -> float:
        moment: float = sum(map(mul, lift, x[k::-1])) - sum(map(mul, push, z[k::-1]))
        return -moment * compliance  # Eq. 66

    return acceleration


def _sliding(
    inertia: float, x: list[float], z: list[float], spin: list[float], ground: GroundSeries, pull: float
) -> Acceleration:
    """Return theta'' from the moments about the centre of mass with sliding friction, by a division of series."""
    _, lift, unit = ground
    level: list[float] = []
    stiffness: list[float] = []
    square: list[float] = []
    force: list[float] = []
    rates: list[float] = []

    def acceleration(k: int) -> float:
        level.append(x[k] + pull * z[k])
        stiffness.append(sum(map(mul, x, level[k::-1])) + (inertia if k == 0 else 0.0))
        square.append(sum(map(mul, spin, spin[k::-1])))
        force.append((lift[k] * (unit * unit) if k < len(lift) else 0.0) + sum(map(mul, z, square[k::-1])))
        lower_terms = sum(map(mul, level, force[k::-1])) + sum(map(mul, stiffness[1:], rates[::-1]))
        rates.append(-lower_terms / stiffness[0] if stiffness[0] else math.nan)  # Eq. 67
        return rates[-1]

    return acceleration


def padded(series: list[float] | FloatArray, size: int) -> FloatArray:
    """Return a series of a given length, padded with zeros."""
    result = np.zeros(size)
    result[: len(series)] = series[:size]
    return result


def derivative(series: FloatArray) -> FloatArray:
    """Return the derivative of a series, of the same length."""
    result = np.zeros(series.size)
    result[:-1] = series[1:] * np.arange(1, series.size)
    return result


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


def integrated_twice(acceleration: FloatArray, start: float, rate: float, unit: float) -> FloatArray:
    """Return coefficients of a position [m] from the coefficients of its acceleration [m/s2] and its initial values."""
    position = np.zeros(acceleration.size)
    position[0], position[1] = start, rate * unit
    k = np.arange(2, acceleration.size)
    position[2:] = acceleration[:-2] * unit**2 / (k * (k - 1))
    return position


@dataclass(frozen=True)
class ModeSeries:
    """Series of a mode. The time within the series is from 0 to 1."""

    unit: float  # duration [s]
    rotation: FloatArray  # rotation, x, rise: theta [rad], x and rise of the centre of mass [m]
    x: FloatArray
    rise: FloatArray
    tangential: FloatArray  # total force of the ground to the right, per unit of mass [m/s2]
    # vertical force at each foot in contact, per unit of mass [m/s2]
    normals: dict[int, FloatArray] = field(default_factory=dict)
    sliding: FloatArray | None = None  # velocity of the feet in contact along the ground [m/s]; None in flight
    # gap of every foot without contact [m]; for a body on one foot, the angle |theta| [rad]
    gaps: dict[int, FloatArray] = field(default_factory=dict)
    stiff: float = 1.0  # stiffness ratio [-]; for values <= 0, no contact force is possible (Painleve)

    def state(self, at: float, touching: tuple[int, ...]) -> ContactState:
        x, rise, rotation = (value(c, at) for c in (self.x, self.rise, self.rotation))
        u, w, spin = (value(derivative(c), at) / self.unit for c in (self.x, self.rise, self.rotation))
        return ContactState(x, rise, rotation, u, w, spin, touching)

    def shortened(self, fraction: float) -> "ModeSeries":
        """Return the first part of the series, up to a fraction, over a shorter unit of time."""
        if fraction == 1.0:
            return self
        powers = fraction ** np.arange(self.rotation.size)
        return ModeSeries(
            self.unit * fraction,
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
    """Return the series of the motion of a body in a mode."""
    if not mode.feet:
        return _flight(base, state, ground, order)
    if len(mode.feet) == 2:
        return _flat(base, state, mode, ground, friction)
    return _pivoting(base, state, mode, ground, friction, order)


def _flat(base: PlaneBase, state: ContactState, mode: Mode, ground: GroundSeries, friction: float) -> ModeSeries:
    """Return the series for contact on both feet, at rest or sliding."""
    size = max(len(ground.push), len(ground.lift)) + 2
    push, weight = padded(ground.push, size), padded(ground.lift, size)
    tangential = -mode.slip * friction * weight if mode.slip else push
    x = integrated_twice(tangential - push, state.x, state.u, ground.unit) if mode.slip else padded([state.x], size)
    turn = tangential * base.height
    normals = {
        LEFT: (weight * base.right + turn) / base.width,  # Eq. 63
        RIGHT: (weight * base.left - turn) / base.width,  # Eq. 63
    }
    still = np.zeros(size)
    sliding = derivative(x) / ground.unit if mode.slip else still
    return ModeSeries(ground.unit, still, x, still, tangential, normals, sliding)


def _flight(base: PlaneBase, state: ContactState, ground: GroundSeries, order: int) -> ModeSeries:
    """Return the series for flight, relative to the ground."""
    size = order + 1
    x = integrated_twice(-padded(ground.push, size), state.x, state.u, ground.unit)  # Eq. 64
    rise = integrated_twice(-padded(ground.lift, size), state.rise, state.w, ground.unit)  # Eq. 64
    # products replace powers, because powers of negative numbers may differ in the last bit
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
    """Return the series for contact on one foot."""
    (foot,) = mode.feet
    pull = mode.slip * friction if mode.slip else None
    arm = base.arm(foot, state.rotation)
    pivot = pivot_motion(base.inertia, arm, (state.rotation, state.spin), ground, pull, order)
    size = order + 1
    rotation, arm_x, arm_z = (padded(c, size) for c in (pivot.rotation, pivot.arm_x, pivot.arm_z))
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
        x = integrated_twice(tangential - push, state.x, state.u, ground.unit)
        sliding = derivative(x + arm_x) / ground.unit
        sliding[0] = along(base, state, foot)
    return ModeSeries(
        ground.unit, rotation, x, rise, tangential, {foot: normal}, sliding, {-foot: foot * rotation}, pivot.stiff
    )
