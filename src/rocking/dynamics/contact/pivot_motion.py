r"""Taylor series of a body that turns about one foot, which sticks or slides.

With the arm r from the centre to the foot, ``j = I_C / m`` and the effective weight ``G = g + a_z``,

    stick:  (j + r_x^2 + r_z^2) theta'' = -(G r_x - a_x r_z)
    slide:  (j + r_x L) theta'' = -L (G + r_z theta'^2),    L = r_x + sigma mu r_z,

where sigma is the direction of sliding: moments about the foot, and about the centre with ``F_t = -sigma mu F_n`` and
``z'' = r_x theta'' + r_z theta'^2``. Where ``j + r_x L <= 0`` the second one has no meaning (Painleve 1895).
"""

import math
from collections.abc import Callable, Sequence
from operator import mul
from typing import NamedTuple

_SMALLEST = 1e-22

Ground = tuple[Sequence[float], Sequence[float], float]
"""Coefficients of a_x and of g + a_z over the unit of time [m/s2], and that unit [s]."""

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
    ground: Ground,
    pull: float | None,
    order: int,
) -> PivotSeries:
    """Return the series of a body that turns about one foot.

    inertia: j = I_C / m [m2]; arm: r_x and r_z at the start [m]; motion: theta [rad] and theta' [rad/s] at the start;
    ground: coefficients of a_x and of g + a_z over the unit of time [m/s2], and that unit [s]; pull: ``sigma mu`` where
    the foot slides; None where it sticks [-].

    >>> found = pivot_motion(1.0, (0.0, -1.0), (0.0, 0.0), ([2.0], [10.0], 1.0), None, 2)
    >>> found.rotation  # theta'' = -a_x h / (j + h^2)
    [0.0, 0.0, -0.5]
    """
    unit = ground[2]
    rotation, spin = [motion[0], motion[1] * unit], [motion[1] * unit]
    x, z = [arm[0]], [arm[1]]
    if pull is None:
        stiff, acceleration = 1.0, _sticking(inertia, x, z, ground)
    else:
        stiff = (x[0] * (x[0] + pull * z[0]) + inertia) / (inertia + x[0] ** 2)
        acceleration = _sliding(inertia, x, z, spin, ground, pull)
    floor, small, least = 1e-300, 0, len(ground[0]) + len(ground[1])
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


def _sticking(inertia: float, x: list[float], z: list[float], ground: Ground) -> Acceleration:
    """Moments about a foot that does not move."""
    push, lift, unit = ground
    compliance = unit * unit / (inertia + x[0] ** 2 + z[0] ** 2)

    def acceleration(k: int) -> float:
        moment: float = sum(map(mul, lift, x[k::-1])) - sum(map(mul, push, z[k::-1]))
        return -moment * compliance  # Eq. 66

    return acceleration


def _sliding(
    inertia: float, x: list[float], z: list[float], spin: list[float], ground: Ground, pull: float
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
