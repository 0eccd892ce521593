"""Signs, units and constants of this package.

Internal lengths are in m, masses in kg, angles in rad, times in s, all float64. The rotation theta is positive
**clockwise**: a body with ``theta > 0`` rocks about its **right** foot, with ``theta < 0`` about its left foot. The
coefficient of restitution is the ratio of angular velocities, ``theta_dot_after / theta_dot_before``; its square
is the energy ratio only for symmetric bodies.
"""

import math
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

Foot = Literal["left", "right"]
FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

g: Final = 9.80665
"""Standard gravity [m/s2] (exact by definition, 3rd CGPM 1901)."""

FEET: Final[tuple[Foot, Foot]] = ("left", "right")
"""The two feet of a plane body, in array order."""

NORMAL_95: Final = 1.959963984540054
"""Half-width of the 95 % interval of a normal distribution, in standard deviations [-]."""

LENGTH_UNITS: Final[dict[str, float]] = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}
"""Length of one unit in metres; units are always explicit."""

ACCELERATION_UNITS: Final[dict[str, float]] = {
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "mm/s2": 0.001,
    "gal": 0.01,
    "g": g,
    "g/10": 0.1 * g,
    "mg": 0.001 * g,
}
"""One unit of acceleration in m/s2; `g/10` is the unit of BHRC files, `mg` is 0.001 g."""


UNITS: Final[dict[str, dict[str, float]]] = {
    "m/s2": ACCELERATION_UNITS,
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001},
    "m": LENGTH_UNITS,
    "s": {"s": 1.0, "ms": 0.001},
    "rad": {"rad": 1.0, "deg": math.pi / 180.0},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180.0},
    "1": {},
}
"""Allowed input units by SI unit, with their values in SI units."""


class Assumed(float):
    """An assumed value: a float that output marks as assumed."""


DEFAULT_FRICTION: Final = Assumed(0.5)
"""Default coefficient of friction [-]."""


DEFAULT_RESTITUTION: Final = "calibrated"
"""Default restitution model of all mechanics."""

FRAME_RESTITUTION: Final = "projection of the frame"
"""Label of the default restitution of a frame, for which the default model has no measurements."""

COMPARED_RESTITUTIONS: Final = ("ked", "housner")
"""Restitution models for comparison with the default model."""


def given_or_assumed(value: float) -> str:
    """Return "assumed" for a default value, otherwise "given"."""
    return "assumed" if isinstance(value, Assumed) else "given"


def percent(fraction: float) -> str:
    """Return a fraction in percent with about three digits. The result is 100 % only for a fraction of 1.

    >>> percent(0.14), percent(0.0078), percent(0.00031), percent(1.0), percent(0.99987)
    ('14 %', '0.78 %', '0.031 %', '100 %', '99.987 %')
    """
    value = 100.0 * fraction
    remaining = 100.0 - value
    if 0.0 < remaining < 0.5:
        return f"{100.0 - float(f'{remaining:.2g}'):.10g} %"
    return f"{float(f'{value:.{3 if abs(value) >= 1.0 else 2}g}'):.10g} %"


def opposite(foot: Foot) -> Foot:
    """Return the opposite foot.

    >>> opposite("left")
    'right'
    """
    return "left" if foot == "right" else "right"
