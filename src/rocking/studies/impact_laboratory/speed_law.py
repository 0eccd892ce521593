"""The contact bed in histories: a coefficient that depends on the speed of each impact."""

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import Foot
from rocking.dynamics.impact_laws import SpeedRestitution
from rocking.restitution.bed_table import HARDNESS
from rocking.restitution.contact_bed import ContactBedModel


def bed_speed_law(
    body: Body,
    frequency: float,
    *,
    points: int = 41,
    damping: float = 1.0,
    onto: Foot = "right",
    gravity: float = conventions.g,
) -> SpeedRestitution:
    """Return r(speed) of a body on a bed of given stiffness, for `simulate`.

    A speed stands for a hardness, v sqrt(k/m) / g with v = 2 w theta_dot; beyond the table r keeps its last value.

    frequency: sqrt(k / m) / (2 pi) of the whole bed [Hz]; points: contact points, as `ContactBedModel` takes them [-];
    damping: damping ratio [-]; gravity: acceleration of gravity [m/s2].

    >>> from rocking import Block
    >>> law = bed_speed_law(Block(width=0.2, height=0.4), 400.0)
    >>> round(law.factor(2.0, 0, 0), 2), law.factor(0.5, 0, 0) > law.factor(4.0, 0, 0)
    (0.85, True)
    """
    rate = 2.0 * np.pi * checks.positive("frequency", frequency, "Hz") / checks.positive("gravity", gravity, "m/s2")
    left, right = body.local_feet
    hardness = np.geomspace(*HARDNESS, 41)
    hardness[[0, -1]] = HARDNESS
    r = [ContactBedModel(points, damping, each).coefficient(body, onto) for each in hardness.tolist()]
    return SpeedRestitution(hardness / (rate * (right - left)), np.minimum(r, 1.0))
