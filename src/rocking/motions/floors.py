"""Motion of a floor of an elastic shear building under a record."""

import math

import numpy as np

from rocking import checks
from rocking.conventions import Assumed, given_or_assumed
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.spectrum import oscillators, states

DAMPING = Assumed(0.05)
"""Default damping ratio of every mode [-]."""


def on_floor(motion: GroundMotion, number: int, storeys: int, period: float, damping: float = DAMPING) -> GroundMotion:
    """Return the horizontal motion of a floor of an elastic building; the vertical part is unchanged.

    All storeys have equal mass and equal stiffness, and all modes have equal damping. The building carries no other
    load, and the ground is rigid. The samples are exact for a record that is linear between its samples. The floor
    motion ends with the record. To include the free vibration after the record, pad the record.

    Parameters
    ----------
    motion : GroundMotion
        Motion of the base.
    number : int
        Floor, from 1 for the first above the ground to the number of storeys for the roof.
    storeys : int
        Number of storeys, up to 100.
    period : float
        Fundamental period of the building [s].
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
    participation = shape.sum(axis=1) / (shape**2).sum(axis=1) * shape[:, number - 1]  # Eq. 316
    rates = oscillators(motion, periods, damping)[2]
    response = states(motion, rates)
    u = response.imag / rates.imag[:, None]
    v = response.real + rates.real[:, None] * u
    absolute = 2.0 * rates.real[:, None] * v - (np.abs(rates) ** 2)[:, None] * u
    stated = f"{100.0 * damping:g} % damping of every mode ({given_or_assumed(damping)})"
    support = f"floor {number} of {storeys}"
    action = f"{support} of an elastic shear building of equal storeys, fundamental period {period:g} s, {stated}"
    if motion.vertical is not None:
        action += "; vertical motion as on the ground"
    return motion.changed(
        action, acceleration=(participation[:, None] * absolute).sum(axis=0), name=f"{motion.name}, {support}",
        metadata={**motion.metadata, "support": support},
    )  # fmt: skip
