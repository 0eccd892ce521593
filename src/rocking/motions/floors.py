"""The motion of a storey: a simple elastic building that shears, driven by a record."""

import math

import numpy as np

from rocking import checks
from rocking.conventions import Assumed, given_or_assumed
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.spectrum import oscillators, states

DAMPING = Assumed(0.05)
"""Damping ratio of every mode where nobody gave one [-]."""


def on_floor(motion: GroundMotion, number: int, storeys: int, period: float, damping: float = DAMPING) -> GroundMotion:
    """Return the horizontal motion of a floor of an elastic building; its vertical part stays as it is.

    The building has storeys of one mass and one stiffness, all modes the same damping; nothing stands on it, the ground
    does not give way, and nothing yields. It is exact at the samples for a record that is straight between them, and
    ends with the record: pad the record to keep what goes on after it.

    Parameters
    ----------
    motion : GroundMotion
        What moves the base.
    number : int
        The floor, from 1 for the first above the ground up to the number of storeys for the roof.
    storeys : int
        How many storeys the building has, up to 100.
    period : float
        Its fundamental period [s].
    damping : float
        Damping ratio of every mode [-].

    >>> push = GroundMotion([1.0] * 101, time_step=0.01)
    >>> on_floor(push, 1, storeys=1, period=1.0, damping=0.0).acceleration[[0, 50, 100]].round(6).tolist()
    [0.0, 2.0, 0.0]
    """
    motion = checked_motion(motion)
    storeys = checks.whole("storeys", storeys, 1, 100)
    number = checks.whole("number", number, 1, storeys)
    period = checks.positive("period", period, "s")
    mode = 2 * np.arange(1, storeys + 1) - 1
    angle = mode * math.pi / (2 * storeys + 1)
    periods = period * math.sin(0.5 * angle[0]) / np.sin(0.5 * angle)  # Eq. 315
    floors = np.arange(1, storeys + 1)
    shape = np.sin(np.outer(angle, floors))
    share = shape.sum(axis=1) / (shape**2).sum(axis=1) * shape[:, number - 1]  # Eq. 316
    rates = oscillators(motion, periods, damping)[2]
    found = states(motion, rates)
    u = found.imag / rates.imag[:, None]
    v = found.real + rates.real[:, None] * u
    absolute = 2.0 * rates.real[:, None] * v - (np.abs(rates) ** 2)[:, None] * u
    stated = f"{100.0 * damping:g} % damping of every mode ({given_or_assumed(damping)})"
    support = f"floor {number} of {storeys}"
    what = f"{support} of an elastic shear building of equal storeys, fundamental period {period:g} s, {stated}"
    if motion.vertical is not None:
        what += "; vertical motion as on the ground"
    return motion.changed(
        what, acceleration=(share[:, None] * absolute).sum(axis=0), name=f"{motion.name}, {support}",
        metadata={**motion.metadata, "support": support},
    )  # fmt: skip
